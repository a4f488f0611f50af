"""Crankshafts: equilibrium, an independent free body, brute force over the cycle, and rules."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kurbel.crank_angle import CrankAngle, unit_vector
from kurbel.machine.indicator import Card
from kurbel.machine.parts import ConnectingRod, Masses
from kurbel.machine_file import loads
from kurbel.mechanisms.scotch_yoke import ScotchYoke
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.solver.chapters.stress import CrankshaftStrength
from kurbel.solver.chapters.stress_places import PARTS, places
from kurbel.solver.shaft import flywheel_weight, weight_in_throw
from machines import STEAM_CARD, constant_pressure
from representative import few
from shafts import body, place_at, shaft, strength

HEAVY = {"flywheel_mass": 5000.0, "flywheel_position": 0.5}
ENGINE_CARD = Card.from_keys(
    unit=(1e5, 1),
    expansion=[
        (0, 16),
        (0.03, 25),
        (0.1, 17.5),
        (0.2, 11.2),
        (0.35, 6.9),
        (0.82, 2.9),
        (0.92, 0.7),
        (1, 0.2),
    ],
    compression=[
        (1, 0.2),
        (0.78, 0.3),
        (0.55, 0.9),
        (0.35, 2.2),
        (0.2, 4.5),
        (0.1, 8),
        (0.04, 12.6),
        (0, 16),
    ],
)
ENGINES: dict[str, dict[str, Any]] = {
    "lying": {
        "crankshaft": shaft(**HEAVY),
        "card": ENGINE_CARD,
        "inclination": 0.0,
        "masses": Masses(400),
        "rpm": 200,
    },
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
    result = body(D, T, (G_D, G_T), flywheel_position=f, flywheel_mass=1.0, journal_length=None)
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
    bearings = [result.A.imag[0], result.A.real[0], result.B.imag[0], result.B.real[0]]
    assert bearings == pytest.approx([-A_x, A_y, -B_x, B_y], abs=4 * size)
    assert result.torque_B[0] == pytest.approx(couple, abs=size)
    # what web B carries at its middle, beside the axis of the shaft: all that stands beyond it
    beyond = [(np.array([B_x, B_y, 0.0]), np.array([0.0, 0.0, a + b])), loads[1]]
    section = np.array([0.0, 0.0, a + e])
    moment = sum(
        (np.cross(point - section, force) for force, point in beyond), np.array([0.0, 0.0, couple])
    )
    moments = result.moments_at(e)
    in_plane, twist = moments.real, moments.imag
    assert abs(in_plane[0]) == pytest.approx(abs(moment[0]), abs=4 * size)
    assert abs(twist[0]) == pytest.approx(abs(moment[1]), abs=4 * size)
    assert abs(result.torque_B[0]) == pytest.approx(abs(moment[2]), abs=size)
    # and the pin at web B, whose axis lies r higher
    section, sized = np.array([0.0, r, a + 0.11]), math.pi * 0.18**3 / 32
    moment = sum(
        (np.cross(point - section, force) for force, point in beyond), np.array([0.0, 0.0, couple])
    )
    pin_end = place_at(result, "pin", "at web B")
    assert pin_end.normal[0] * sized == pytest.approx(math.hypot(*moment[:2]), abs=4 * size)
    assert pin_end.torsion[0] * 2 * sized == pytest.approx(abs(moment[2]), abs=4 * size)
    along = sum(force[1] for force, _ in beyond)
    assert result.along_web[0] == pytest.approx(along, abs=4 * size)


@pytest.mark.parametrize("name", ENGINES)
def test_equilibrium(name: str) -> None:
    assert strength(**ENGINES[name]).equilibrium_residual <= 1e-14


@pytest.mark.parametrize("name", few(ENGINES, ["steam"]))
def test_largest_stresses_are_those_of_the_whole_cycle(name: str) -> None:
    """Brute force over 0.005° never finds more, and comes as near as its step allows beside a bend of the card."""
    solved = strength(**ENGINES[name])
    at = solved.at(np.linspace(0, 360, 72001))
    for part in PARTS:
        for column, largest in (
            (f"sigma_{part}", solved.sigma_max(part)),
            (f"mises_{part}", solved.mises_max(part)),
        ):
            brute = getattr(at, column).max()
            assert brute <= largest.value * (1 + 1e-13)
            assert brute == pytest.approx(largest.value, rel=1e-4)


SHAFT_LINES = """crankshaft: {a: 60 mm, b: 50 mm, web_distance: 30 mm, web_thickness: 15 mm, web_width: 60 mm,
  pin_diameter: 50 mm, pin_length: 40 mm, journal_diameter: 55 mm, flywheel_mass: 500 kg, flywheel_position: 200 mm}
"""


@pytest.mark.parametrize(
    ("inclination", "degrees", "D", "T"),
    [
        (0, 0, 0, -1),
        (0, 90, 1, 0),
        (0, 180, 0, 1),
        (90, 0, 1, 0),
        (90, 90, 0, 1),
        (90, 180, -1, 0),
        (-90, 0, -1, 0),
    ],
)
def test_direction_of_the_weight(inclination: float, degrees: float, D: float, T: float) -> None:
    """Lying, the pin stands above the shaft at 90° and the weight points from it to the shaft."""
    assert weight_in_throw(1.0, CrankAngle.of(float(degrees)), float(inclination)) == complex(D, T)


def test_the_flywheel_hangs_downward_whichever_throw_is_next_to_it() -> None:
    """In the frame of the engine its weight is one vector at every angle, seen from the throws of both banks."""
    each = "{crank: 45 mm, rod: 150 mm, bore: 90 mm, inclination: 45 deg}"
    banks = "bank_angles: [0 deg, 60 deg]\n  spacing: 110 mm\n  crank_positions: [0 deg, 90 deg]"
    machine = loads(f"{SHAFT_LINES}cylinders:\n  count: 2\n  {banks}\n  each: {each}\n")
    phi = np.arange(0.0, 360.0, 15.0)
    for cylinder in machine.cylinders:
        own = phi - cylinder.crank_position
        seen = flywheel_weight(machine, cylinder, CrankAngle.of(own))
        in_engine = -np.conj(seen) * unit_vector(own + cylinder.bank_angle)
        # 45° below the horizontal on the other side of the stroke line of cylinder 1, the shaft turning upward
        downward = 500 * 9.80665 * unit_vector(-135.0)
        assert np.abs(in_engine - downward).max() <= 1e-12 * 500 * 9.80665


def test_largest_torque_at_a_jump_is_taken_before_it() -> None:
    """Release at 40 % of the stroke, before T has its natural top: the pin is strained by the pressure before it."""
    card = Card.from_keys(
        unit=(1e5, 1),
        expansion=[(0, 10), (0.4, 10), (0.4, 0), (1, 0)],
        compression=[(1, 0), (0, 0)],
    )
    mechanism = SliderCrank(0.3, 1.5)
    solved = strength(shaft(), mechanism, card)
    degrees = solved.at_largest_torque[0].degrees
    assert degrees == pytest.approx(
        float(mechanism.crank_angles_at(np.array([0.24]), True)[0]), abs=1e-9
    )
    pin = solved.at_largest_torque[0]
    force = 1e6 * math.pi / 4 * 0.4**2
    T = force * mechanism.slope(CrankAngle.of(degrees)) / 0.3
    assert pin.torsion == pytest.approx(16 * T * 0.42 / 0.82 * 0.3 / (math.pi * 0.18**3), rel=1e-9)


class TestDeadCentre:
    def test_inertia_gives_no_relief(self) -> None:
        """Starting and slow running (R p. 608): the same stresses at any speed, though the running machine has less."""
        at_rest, running = (
            strength(shaft(), mechanism=SliderCrank(0.3, 1.5), rpm=rpm, masses=Masses(500.0))
            for rpm in (0, 300)
        )
        assert [one.combined for one in running.at_dead_centre] == [
            one.combined for one in at_rest.at_dead_centre
        ]
        assert running.at([0]).sigma_pin[0] < at_rest.at([0]).sigma_pin[0]

    def test_offset_crank(self) -> None:
        """In the dead centre crank and rod are in one line: the pin carries P/cos ψ, all of it radial."""
        mechanism = SliderCrank(0.3, 1.5, offset=0.1)
        solved = strength(shaft(), mechanism)
        _, cos_psi = mechanism.rod_angle(CrankAngle.of(mechanism.dead_centres()[0]))
        A_D = 1e6 * math.pi / 4 * 0.4**2 / cos_psi * 0.42 / 0.82
        pin = solved.at_dead_centre[0]
        assert pin.bending_in_plane == pytest.approx(
            32 * A_D * 0.4 / (math.pi * 0.18**3), rel=1e-12
        )
        assert (pin.bending_out_of_plane, pin.torsion) == (0, 0)

    def test_pulling_engine_is_in_the_outer_one(self) -> None:
        force, degrees = strength(shaft(), card=constant_pressure(-5e4)).full_force
        assert force == pytest.approx(-5e4 * math.pi / 4 * 0.4**2, rel=1e-14)
        assert degrees == 180


class TestBearings:
    def test_infinite_rod_under_constant_pressure(self) -> None:
        """|S| = P all the time: p_m = P/(d l), and k = p_m π d n."""
        solved = strength(shaft(), ScotchYoke(0.3), rpm=200)
        pressure = 1e6 * math.pi / 4 * 0.4**2 / (0.18 * 0.2)
        largest = solved.pressure_max("pin")
        assert largest.value == pytest.approx(pressure, rel=1e-14)
        assert solved.pressure_mean("pin") == pytest.approx(pressure, rel=1e-14)
        assert solved.pressure_velocity("pin") == pytest.approx(
            pressure * math.pi * 0.18 * 200 / 60, rel=1e-14
        )
        mean_A = solved.pressure_mean("journal_A")
        assert mean_A == pytest.approx(
            pressure * 0.18 * 0.2 * 0.42 / 0.82 / (0.19 * 0.3), rel=1e-14
        )


def test_in_the_corner_of_a_web_all_normal_stresses_add_up() -> None:
    """A rectangle of 120 × 220 mm: thrust, and bendings across both its sides, by the handbook."""
    D, T = 1e5, 4e4
    corner = place_at(body(D, T), "web_A", "corner")
    radial, tangential = (force * 0.42 / 0.82 for force in (D, T))
    thrust = radial / (0.12 * 0.22)
    across_thickness = 6 * radial * (0.4 - 0.17) / (0.22 * 0.12**2)
    across_width = 6 * tangential * 0.3 / (0.12 * 0.22**2)
    assert corner.normal == pytest.approx([thrust + across_thickness + across_width], rel=1e-12)


def test_a_web_under_torsion_alone_is_fully_used_at_its_allowable_torsion() -> None:
    """G: α₀ = k_b/(1.3 k_d)."""
    allowed = {"allowable_bending": 60e6, "allowable_torsion": 40e6}
    web = place_at(body(1e5, 4e4, **allowed), "web_A", "wide face")
    twisted = web._replace(normal=0.0, torsion=40e6)
    assert twisted.combined == pytest.approx(60e6, rel=1e-14)


def test_safety_counts_dead_centre_and_cycle() -> None:
    solved = strength(**ENGINES["lying"] | {"crankshaft": shaft(**HEAVY, allowable_bending=60e6)})
    for part in PARTS:
        worst = max(solved.sigma_dc(part), solved.sigma_max(part).value)
        safety = solved.safety(part)
        assert safety.value == pytest.approx(60e6 / worst, rel=1e-15)


# loads and places of the crank pin, and the lengths round it that contradict one another


@given(forces, forces, forces, forces, st.floats(-0.15, 2.0), st.floats(0, 1))
def test_no_section_of_the_pin_is_strained_more_than_its_places(
    D: float, T: float, G_D: float, G_T: float, f: float, along: float
) -> None:
    result = body(D, T, (G_D, G_T), flywheel_position=f, flywheel_mass=1.0, journal_length=None)
    u = 0.11 * along
    before, beyond = (
        float(np.abs(moments)[0]) for moments in (result.moments_at(-u), result.moments_at(u))
    )
    worst = max(place.normal[0] for place in places(result) if place.part == "pin")
    assert max(before, beyond) <= worst * math.pi * 0.18**3 / 32 * (1 + 1e-12) + 1e-9


class TestTurningPartOfTheRod:
    """Of 260 kg, 60 % turn with the pin of a crank of 0.3 m at 300 rpm: 156 · 0.3 · (10 π)² N, radial only."""

    PULL = 156 * 0.3 * (10 * math.pi) ** 2

    def solved(self, rod: ConnectingRod, **changed: Any) -> CrankshaftStrength:
        return strength(shaft(**changed), SliderCrank(0.3, 1.5), rpm=300, masses=Masses(200.0, rod))

    def test_free_body(self) -> None:
        solved = self.solved(ConnectingRod(260.0, share=0.4))
        phi = np.linspace(0, 360, 37)
        at = solved.at(phi)
        assert pytest.approx(solved.rods[0].at(phi).D, rel=1e-15) == at.D
        size = float(np.abs(at.D).max())
        assert pytest.approx(at.D - self.PULL, abs=1e-14 * size) == at.A_D + at.B_D
        assert pytest.approx(at.B_D * 0.42, abs=1e-14 * size) == at.A_D * 0.4
        assert pytest.approx(at.T, abs=1e-14 * size) == at.A_T + at.B_T
        # the dead centre of the book is taken at rest
        assert solved.sigma_dc("pin") == strength(shaft(), SliderCrank(0.3, 1.5)).sigma_dc("pin")
        assert solved.equilibrium_residual <= 1e-14


# the overhung crank: by an independent free body, by brute force, and by its rules

OVERHUNG: dict[str, Any] = {"overhung": True, "a": 0.4, "b": 1.2, "journal_length": 0.3}

PIN, JOURNAL = math.pi * 0.18**3 / 32, math.pi * 0.19**3 / 32


@given(forces, forces, forces, forces, st.floats(-0.75, 2.0))
def test_overhung_against_a_free_body_in_space(
    D: float, T: float, G_D: float, G_T: float, f: float
) -> None:
    """Reactions from the equations of a rigid body; every section from what lies on the side of the pin alone."""
    result = body(
        D,
        T,
        (G_D, G_T),
        **OVERHUNG | {"flywheel_position": f, "flywheel_mass": 1.0, "journal_length": None},
    )
    a, b, e, r = 0.4, 1.2, 0.17, 0.3
    # x along T, y toward the pin, z along the shaft from the pin; unknown: A and B on the shaft (x, y)
    loads = [
        (np.array([T, -D, 0.0]), np.array([0.0, r, 0.0])),
        (np.array([G_T, -G_D, 0.0]), np.array([0, 0, b + f])),
    ]
    rows = []
    for direction in (np.array([1.0, 0, 0]), np.array([0, 1.0, 0])):
        rows += [[*direction[:2], *np.cross([0.0, 0.0, z], direction)[:2]] for z in (a, b)]
    load = sum(np.array([*force[:2], *np.cross(point, force)[:2]]) for force, point in loads)
    A_x, B_x, A_y, B_y = np.linalg.solve(np.array(rows).T, -np.asarray(load))
    size = 1e-11 * (abs(D) + abs(T) + 3 * abs(G_D) + 3 * abs(G_T) + 1)
    bearings = [result.A.imag[0], result.A.real[0], result.B.imag[0], result.B.real[0]]
    assert bearings == pytest.approx([-A_x, A_y, -B_x, B_y], abs=size)

    def section(y: float, z: float, *more: tuple[Any, Any]) -> Any:
        return sum(
            np.cross(point - np.array([0.0, y, z]), force) for force, point in (loads[0], *more)
        )

    bearing_A = (np.array([A_x, A_y, 0.0]), np.array([0.0, 0.0, a]))
    at = {(place.part, place.name): place for place in places(result)}
    web = section(0.0, e)
    assert at["web_A", "wide face"].compression[0] == pytest.approx(
        D / 0.12 / 0.22, abs=size / 0.0264
    )
    assert at["web_A", "wide face"].bending_in_plane[0] * 0.12**2 * 0.22 / 6 == pytest.approx(
        abs(web[0]), abs=size
    )
    assert at["web_A", "wide face"].torsion[0] * 0.12**2 * 0.22 / 4.5 == pytest.approx(
        abs(web[1]), abs=size
    )
    narrow = at["web_A", "narrow face"]
    assert narrow.bending_out_of_plane[0] * 0.12 * 0.22**2 / 6 == pytest.approx(
        abs(web[2]), abs=size
    )
    pin = section(r, 0.11)
    assert at["pin", "at web A"].normal[0] * PIN == pytest.approx(math.hypot(*pin[:2]), abs=size)
    assert at["pin", "at web A"].torsion[0] == pin[2] == 0
    journals = {
        ("journal_A", "at web"): section(0, 0.23),
        ("journal_A", "in bearing"): section(0, a),
    }
    if f < 0:
        journals["journal_B", "at flywheel"] = section(0, b + f, bearing_A)
    else:
        journals["journal_B", "in bearing"] = section(0, b, bearing_A)
    for key, moment in journals.items():
        assert at[key].normal[0] * JOURNAL == pytest.approx(math.hypot(*moment[:2]), abs=size), key
        assert at[key].torsion[0] * 2 * JOURNAL == pytest.approx(abs(moment[2]), abs=size), key
    assert {part for part, _ in at} == {"pin", "web_A", "journal_A", "journal_B"}
