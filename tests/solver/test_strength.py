"""The strength of a crankshaft: by equilibrium, by an independent free body, by limits, and by brute force."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kurbel.crank_angle import CrankAngle
from kurbel.errors import UsageError
from kurbel.machine import Cylinder, Machine
from kurbel.machine.indicator import Card
from kurbel.machine.parts import Masses
from kurbel.mechanisms.scotch_yoke import ScotchYoke
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.solver.case import Case
from kurbel.solver.shaft import weight_in_throw
from kurbel.solver.stress import PARTS
from machines import STEAM_CARD, constant_pressure
from representative import few
from shafts import body, place_at, shaft, strength

HEAVY = {"flywheel_mass": 5000.0, "flywheel_position": 0.5}
ENGINE_CARD = Card.from_keys(
    unit=(1e5, 1),
    expansion=[(0, 16), (0.03, 25), (0.1, 17.5), (0.2, 11.2), (0.35, 6.9), (0.82, 2.9), (0.92, 0.7), (1, 0.2)],
    compression=[(1, 0.2), (0.78, 0.3), (0.55, 0.9), (0.35, 2.2), (0.2, 4.5), (0.1, 8), (0.04, 12.6), (0, 16)],
)
ENGINES: dict[str, dict[str, Any]] = {
    "lying": {"crankshaft": shaft(**HEAVY), "card": ENGINE_CARD, "inclination": 0.0, "masses": Masses(400), "rpm": 200},
    "standing": {"crankshaft": shaft(**HEAVY), "card": ENGINE_CARD, "inclination": 90.0},
    "inclined": {
        "crankshaft": shaft(flywheel_mass=3000.0, flywheel_position=-0.1, journal_length=0.19),
        "inclination": 30.0,
    },
    "steam": {"crankshaft": shaft(), "card": STEAM_CARD},
}


forces = st.floats(-1e6, 1e6)


@given(forces, forces, forces, forces, st.floats(-0.15, 2.0))
def test_against_a_free_body_in_space(D: float, T: float, G_D: float, G_T: float, f: float) -> None:
    """Reactions from six equations of a rigid body, web B from what hangs on it on the side of the flywheel."""
    found = body(D, T, (G_D, G_T), flywheel_position=f)
    a, b, e, r = 0.4, 0.42, 0.17, 0.3
    # x along T, y toward the pin, z along the shaft; unknown: A and B on the shaft (x, y), the couple about z
    pin = np.array([T, -D, 0.0]), np.array([0.0, r, a])
    loads = [pin, (np.array([G_T, -G_D, 0.0]), np.array([0.0, 0.0, a + b + f]))]
    rows = []
    for direction in (np.array([1.0, 0, 0]), np.array([0, 1.0, 0])):
        for z in (0.0, a + b):
            rows.append([*direction[:2], *np.cross([0.0, 0.0, z], direction)])
    matrix = np.array([*rows, [0.0, 0.0, 0.0, 0.0, 1.0]]).T
    load = sum(np.array([*force[:2], *np.cross(point, force)]) for force, point in loads)
    A_x, B_x, A_y, B_y, couple = np.linalg.solve(matrix, -np.asarray(load))
    size = 1e-12 * (abs(D) + abs(T) + 3 * abs(G_D) + 3 * abs(G_T) + 1)
    bearings = [found.A.T[0], found.A.D[0], found.B.T[0], found.B.D[0]]
    assert bearings == pytest.approx([-A_x, A_y, -B_x, B_y], abs=4 * size)
    assert found.torque[0] == pytest.approx(couple, abs=size)
    # what web B carries at its middle, beside the axis of the shaft: all that stands beyond it
    beyond = [(np.array([B_x, B_y, 0.0]), np.array([0.0, 0.0, a + b])), loads[1]]
    section = np.array([0.0, 0.0, a + e])
    moment = sum((np.cross(point - section, force) for force, point in beyond), np.array([0.0, 0.0, couple]))
    in_plane, twist = found.moments_at(e)
    assert abs(in_plane[0]) == pytest.approx(abs(moment[0]), abs=4 * size)
    assert abs(twist[0]) == pytest.approx(abs(moment[1]), abs=4 * size)
    assert abs(found.torque[0]) == pytest.approx(abs(moment[2]), abs=size)
    # and the pin at web B, whose axis lies r higher
    section, sized = np.array([0.0, r, a + 0.11]), math.pi * 0.18**3 / 32
    moment = sum((np.cross(point - section, force) for force, point in beyond), np.array([0.0, 0.0, couple]))
    pin_end = place_at(found, "pin", "at web B")
    assert pin_end.normal[0] * sized == pytest.approx(math.hypot(*moment[:2]), abs=4 * size)
    assert pin_end.torsion[0] * 2 * sized == pytest.approx(abs(moment[2]), abs=4 * size)
    along = sum(force[1] for force, _ in beyond)
    assert found.along_web[0] == pytest.approx(along, abs=4 * size)


@pytest.mark.parametrize("name", ENGINES)
def test_equilibrium(name: str) -> None:
    assert strength(**ENGINES[name]).equilibrium_residual <= 1e-14


@pytest.mark.parametrize("name", few(ENGINES, ["steam"]))
def test_largest_stresses_are_those_of_the_whole_cycle(name: str) -> None:
    """Brute force over 0.005° never finds more, and comes as near as its step allows beside a bend of the card."""
    solved = strength(**ENGINES[name])
    at = solved.at(np.linspace(0, 360, 72001))
    for part in PARTS:
        for column, largest in ((f"sigma_{part}", solved.sigma_max(part)), (f"mises_{part}", solved.mises_max(part))):
            brute = getattr(at, column).max()
            assert brute <= largest.value * (1 + 1e-13)
            assert brute == pytest.approx(largest.value, rel=1e-4)


@pytest.mark.parametrize(
    ("inclination", "degrees", "D", "T"),
    [(0, 0, 0, -1), (0, 90, 1, 0), (0, 180, 0, 1), (90, 0, 1, 0), (90, 90, 0, 1), (90, 180, -1, 0), (-90, 0, -1, 0)],
)
def test_direction_of_the_weight(inclination: float, degrees: float, D: float, T: float) -> None:
    """Lying, the pin stands above the shaft at 90° and the weight points from it to the shaft."""
    assert weight_in_throw(1.0, CrankAngle.of(float(degrees)), float(inclination)) == (D, T)


def test_largest_torque_at_a_jump_is_taken_before_it() -> None:
    """Release at 40 % of the stroke, before T has its natural top: the pin is strained by the pressure before it."""
    card = Card.from_keys(unit=(1e5, 1), expansion=[(0, 10), (0.4, 10), (0.4, 0), (1, 0)], compression=[(1, 0), (0, 0)])
    mechanism = SliderCrank(0.3, 1.5)
    solved = strength(shaft(), mechanism, card)
    degrees = solved.largest_torque.degrees
    assert degrees == pytest.approx(float(mechanism.crank_angles_at(np.array([0.24]), True)[0]), abs=1e-9)
    pin = solved.at_largest_torque[0]
    force = 1e6 * math.pi / 4 * 0.4**2
    T = force * mechanism.slope(CrankAngle.of(degrees)) / 0.3
    assert pin.torsion == pytest.approx(16 * T * 0.42 / 0.82 * 0.3 / (math.pi * 0.18**3), rel=1e-9)


class TestDeadCentre:
    def test_inertia_gives_no_relief(self) -> None:
        """Starting and slow running (R p. 608): the same stresses at any speed, though the running machine has less."""
        at_rest, running = (
            strength(shaft(), mechanism=SliderCrank(0.3, 1.5), rpm=rpm, masses=Masses(500.0)) for rpm in (0, 300)
        )
        assert [one.combined for one in running.at_dead_centre] == [one.combined for one in at_rest.at_dead_centre]
        assert running.at([0]).sigma_pin[0] < at_rest.at([0]).sigma_pin[0]

    def test_offset_crank(self) -> None:
        """In the dead centre crank and rod are in one line: the pin carries P/cos ψ, all of it radial."""
        mechanism = SliderCrank(0.3, 1.5, offset=0.1)
        solved = strength(shaft(), mechanism)
        _, cos_psi = mechanism.rod_angle(CrankAngle.of(mechanism.dead_centres()[0]))
        A_D = 1e6 * math.pi / 4 * 0.4**2 / cos_psi * 0.42 / 0.82
        pin = solved.at_dead_centre[0]
        assert pin.bending_in_plane == pytest.approx(32 * A_D * 0.4 / (math.pi * 0.18**3), rel=1e-12)
        assert (pin.bending_out_of_plane, pin.torsion) == (0, 0)

    def test_pulling_engine_stands_in_the_outer_one(self) -> None:
        force, degrees = strength(shaft(), card=constant_pressure(-5e4)).full_force
        assert force == pytest.approx(-5e4 * math.pi / 4 * 0.4**2, rel=1e-14)
        assert degrees == 180


class TestBearings:
    def test_infinite_rod_under_constant_pressure(self) -> None:
        """|S| = P all the time: p_m = P/(d l), and k = p_m π d n."""
        solved = strength(shaft(), ScotchYoke(0.3), rpm=200)
        pressure = 1e6 * math.pi / 4 * 0.4**2 / (0.18 * 0.2)
        largest = solved.pressure_max("pin")
        assert largest is not None
        assert largest.value == pytest.approx(pressure, rel=1e-14)
        assert solved.pressure_mean("pin") == pytest.approx(pressure, rel=1e-14)
        assert solved.pressure_velocity("pin") == pytest.approx(pressure * math.pi * 0.18 * 200 / 60, rel=1e-14)
        mean_A = solved.pressure_mean("journal_A")
        assert mean_A == pytest.approx(pressure * 0.18 * 0.2 * 0.42 / 0.82 / (0.19 * 0.3), rel=1e-14)


def test_safety_counts_dead_centre_and_cycle() -> None:
    solved = strength(**ENGINES["lying"] | {"crankshaft": shaft(**HEAVY, allowable_bending=60e6)})
    for part in PARTS:
        worst = max(solved.sigma_dc(part), solved.sigma_max(part).value)
        safety = solved.safety(part)
        assert safety is not None
        assert safety.value == pytest.approx(60e6 / worst, rel=1e-15)


def test_allowable_ratio_weighs_torsion_of_the_webs() -> None:
    """α₀ = 90/(1.3 · 30) > 1 lets torsion count for more in the webs, and nowhere else."""
    given = {"allowable_bending": 90e6, "allowable_torsion": 30e6}
    plain, weighed = (strength(shaft(**allowed)).at_largest_torque for allowed in ({}, given))
    for one, other in zip(plain, weighed, strict=True):
        assert other._replace(alpha=one.alpha) == one
        twisted_web = one.part.startswith("web") and one.torsion is not None
        assert (other.combined > one.combined) if twisted_web else (other.combined == one.combined)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"crankshaft": None}, "no 'crankshaft' is given"),
        ({"cylinders": 2}, "2 cylinders; the crankshaft that is examined has one throw"),
        ({"pistons": ()}, "no pressure loads the crankshaft; give 'bore' and 'indicator'"),
    ],
)
def test_refused(changed: dict[str, Any], message: str) -> None:
    own = strength(shaft()).forces.drive.cylinder
    cylinder = Cylinder(own.mechanism, pistons=changed.get("pistons", own.pistons))
    both = tuple(Cylinder(own.mechanism, f"cylinder {i}", own.pistons) for i in range(changed.get("cylinders", 0)))
    machine = Machine(both or (cylinder,), crankshaft=changed.get("crankshaft", shaft()))
    with pytest.raises(UsageError, match=message):
        _ = Case(machine).stress
