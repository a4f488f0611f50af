"""Friction in the pins of the rod and in the journals: closed forms, the free rod, and the balance of energy."""

import math
import textwrap
from typing import Any

import numpy as np
import pytest
from mpmath import atanh, ellipk

from kurbel.machine_file import loads
from kurbel.solver.case import Case
from kurbel.solver.forces import CylinderForces
from kurbel.solver.state import crank_pin_force, crosshead_pin_force
from representative import CONFIGS, few

ENGINE = (
    CONFIGS["gas-engine"]
    .read_text("utf-8")
    .replace("clearance: 0.06 mm, diameter: 120 mm", "clearance: 0.06 mm")
)
"""Friction gives the diameter of the crosshead pin."""
RUBS = """friction: {crosshead: 0.05, crank_pin: 0.05, crosshead_pin: 0.06, crosshead_pin_diameter: 180 mm,
           journals: 0.04}
"""
STRONGLY = (
    RUBS.replace("0.05", "0.2").replace("crosshead: 0.2", "crosshead: 0.3").replace("0.06", "0.2")
)
EXACT = ENGINE.replace("share: 0.4", "center_of_gravity: 900 mm, inertia: 60 kg m2")
PLAIN = """crank: 100 mm
rod: 250 mm
bore: 100 mm
indicator: {head_end: {constant: {expansion: 1 bar, compression: -1 bar}}}
friction: {crank_pin: 0.05, crank_pin_diameter: 60 mm, crosshead_pin: 0.06, crosshead_pin_diameter: 40 mm,
           journals: 0.03, journal_diameter: 70 mm}
"""
FORCE = 1e5 * math.pi / 400


def solved(text: str) -> CylinderForces:
    return Case(loads(text)).cylinders[0]


def test_constant_piston_force_against_elliptic_integrals() -> None:
    """S = P/cos ψ: ∮ dφ/cos ψ = 4 K(λ²) on crank pin and journals, ∮ |dψ|/cos ψ = 4 artanh λ on the crosshead pin."""
    forces = solved(PLAIN)
    turned, swung = float(4 * ellipk(0.16)), float(4 * atanh(0.4))
    assert forces.friction_works.get("crank_pin") == pytest.approx(
        0.05 * 0.030 * FORCE * turned, rel=1e-13
    )
    assert forces.friction_works.get("crosshead_pin") == pytest.approx(
        0.06 * 0.020 * FORCE * swung, rel=1e-13
    )
    assert forces.friction_works.get("journals") == pytest.approx(
        0.03 * 0.035 * FORCE * turned, rel=1e-13
    )


def test_shares_are_of_the_work_that_drives() -> None:
    forces = solved(PLAIN)
    work = 2 * FORCE * 0.2
    for name in ("crank_pin", "crosshead_pin", "journals"):
        assert forces[f"loss_{name}"].value == pytest.approx(
            forces[f"work_{name}"].value / work, rel=1e-13
        )
    lost = math.fsum(map(forces.friction_works.get, ("crank_pin", "crosshead_pin", "journals")))
    assert forces.friction_work == pytest.approx(lost, rel=1e-14)
    assert pytest.approx((work - lost) / (0.2 * math.pi), rel=1e-13) == forces.W


@pytest.mark.parametrize("degrees", [20.0, 130.0, 200.0, 340.0])
def test_a_rod_without_mass_is_in_equilibrium_with_friction_at_both_its_ends(
    degrees: float,
) -> None:
    """Forces of both pins and both moments, drawn in the plane, the crank pin at R e^{iφ}."""
    state = solved(PLAIN).at([degrees])
    (along,), (across,) = crosshead_pin_force(state)
    (radial,), (tangential,) = crank_pin_force(state)
    turned = np.exp(1j * np.radians(degrees))
    pin = 0.1 * turned
    crosshead = pin.real + math.sqrt(0.25**2 - pin.imag**2)
    at_crosshead = -along - 1j * (
        -across
    )  # of the crosshead on the rod; N > 0 lies on the guide away from +i
    at_crank = -(-radial + 1j * tangential) * turned  # of the pin on the rod
    assert abs(at_crosshead + at_crank) <= 1e-12 * FORCE
    frictionless = state.without_pin_friction
    assert state.rubbing is not None
    slope = (
        0.4
        * math.cos(math.radians(degrees))
        / math.sqrt(1 - (0.4 * math.sin(math.radians(degrees))) ** 2)
    )
    crank = 0.05 * 0.030 * math.hypot(*(float(one[0]) for one in crank_pin_force(frictionless)))
    crosshead_pin = (
        0.06 * 0.020 * math.hypot(*(float(one[0]) for one in crosshead_pin_force(frictionless)))
    )
    couple = crank + math.copysign(crosshead_pin, slope)
    moment = ((crosshead - pin).conjugate() * at_crosshead).imag + couple
    assert abs(moment) <= 1e-12 * FORCE
    journals = 0.03 * 0.035 * math.hypot(*(float(one[0]) for one in crank_pin_force(frictionless)))
    assert state.M[0] == pytest.approx(0.1 * tangential - crank - journals, rel=1e-12)


ENGINES = {
    "share": ENGINE,
    "exact": EXACT,
    "leaning": EXACT.replace("inclination: 0", "inclination: 70"),
    "infinite": ENGINE.replace("rod_ratio: 5", "rod_ratio: infinite"),
    "offset": ENGINE.replace("rod_ratio: 5", "rod_ratio: 3\noffset: 100 mm"),
}
RUBBING = [(engine, rubs) for rubs in (RUBS, STRONGLY) for engine in ENGINES.values()]


@pytest.mark.parametrize(
    ("engine", "rubs"),
    few(
        RUBBING,
        [(ENGINES["leaning"], STRONGLY), (ENGINES["offset"], RUBS)],
        [f"{rubs}-{name}" for rubs in ("rubs", "strongly") for name in ENGINES],
    ),
)
def test_energy_balance_closes(engine: str, rubs: str) -> None:
    """Also by the pieces of the cycle that all quadratures share: each is cut just where N changes sides."""
    case = Case(loads(engine + rubs))
    forces = case.cylinders[0]
    assert abs(forces.energy_residual or 0.0) <= 1e-14
    assert pytest.approx(forces.W, rel=1e-13) == case.flywheel.W
    assert case.stress.equilibrium_residual <= 1e-14


@pytest.mark.parametrize("name", ["crank_pin", "crosshead_pin", "journals"])
def test_energy_balance_sees_a_fault(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    right = CylinderForces.friction_works.func

    def wrong(forces: CylinderForces) -> dict[str, Any]:
        works = right(forces)
        return {**works, name: works[name] * (1 + 1e-6)}

    monkeypatch.setattr(CylinderForces, "friction_works", property(wrong))
    assert abs(solved(ENGINE + RUBS).energy_residual or 0.0) > 1e-10


def test_journals_bear_the_flywheel_too() -> None:
    without = ENGINE.replace("  flywheel_mass: 4 t\n", "").replace(
        "  flywheel_position: 450 mm", "#"
    )
    heavy, light = solved(ENGINE + RUBS), solved(without + RUBS)
    assert heavy.friction_works.get("journals") > 1.2 * light.friction_works.get("journals")
    assert heavy.friction_works.get("crank_pin") == pytest.approx(
        light.friction_works.get("crank_pin"), rel=1e-13
    )


def test_each_throw_takes_its_own_friction_of_journals() -> None:
    """The mean torque is what both cylinders leave, though only the journals of the last throw carry the flywheel."""
    head, shaft = (
        f"{ENGINE}\n{RUBS}".split("crankshaft:")[0],
        ENGINE.split("crankshaft:")[1].split("expect:")[0],
    )
    cycle, own = "cycle: four-stroke\nspeed: 200 rpm\n", head.split("speed: 200 rpm\n")[1] + RUBS
    first = "cylinders:\n- axial_position: 0 mm\n  name: one\n" + textwrap.indent(own, "  ")
    second = "- {like: one, name: two, crank_position: 360 deg, axial_position: 800 mm}\n"
    case = Case(loads(f"{cycle}{first}{second}crankshaft:{shaft}"))
    works = [cylinder.friction_works["journals"] for cylinder in case.cylinders]
    assert works[1] > 1.2 * works[0]
    left = math.fsum(cylinder.work_left for cylinder in case.cylinders)
    assert case.flywheel.M_mean * 4 * math.pi == pytest.approx(left, rel=1e-13)


@pytest.mark.parametrize("degrees", [90.0, 270.0])
def test_the_rod_turns_back_from_exactly_there_on(degrees: float) -> None:
    """dψ/dφ changes its sign there, and with it the moment in the crosshead pin: N jumps, and is that just after."""
    before, at, after = solved(PLAIN).at([degrees - 1e-7, degrees, degrees + 1e-7]).N
    assert at == pytest.approx(after, rel=1e-6)
    assert abs(after - before) > 1e-3 * FORCE


@pytest.mark.parametrize(("spacing", "apart"), [("", 20.0), ("rod_spacing: 0 mm, ", 0.0)])
def test_rods_of_one_throw_share_what_its_counterweight_loads_the_journals_with(
    spacing: str, apart: float
) -> None:
    """Each rod with both its bearings, from its own place on the pin, ± half of what the two are apart.

    In the middle f r |F + u ω²/2|, a = b.
    """
    gas = "indicator: {head_end: {constant: {expansion: 9 bar, compression: 2 bar}}}"
    shape = f"crank: 45 mm, rod: 150 mm, bore: 90 mm, {gas}"
    each = f"{{{shape}, friction: {{journals: 0.04}}, masses: {{piston: 1.2 kg}}}}"
    shaft = (
        f"crankshaft: {{{spacing}a: 55 mm, b: 55 mm, web_distance: 30 mm, web_thickness: 15 mm, web_width: 60 mm,\n"
        "  pin_diameter: 50 mm, pin_length: 40 mm, journal_diameter: 60 mm, journal_length: 24 mm}\n"
    )
    vee = f"cylinders:\n  count: 2\n  bank_angles: [0 deg, 90 deg]\n  each: {each}\n"
    weight = "counterweights: [{product: 0.06 kg m, angle: 180 deg}]\n"
    case = Case(loads("speed: 1500 rpm\n" + shaft + vee + weight))
    pull = 0.06 * (50 * math.pi) ** 2 / 2
    for cylinder, place in zip(case.cylinders, (-apart / 2, apart / 2)):
        state = cylinder.at([15.0, 80.0, 200.0, 310.0])
        assert state.rubbing is not None
        radial, tangential = crank_pin_force(state.without_pin_friction)
        loads_of_journals = 0.0
        for share in ((55 - place) / 55, (55 + place) / 55):
            loads_of_journals += np.hypot(radial * share + pull, tangential * share) / 2
        assert state.rubbing.journals == pytest.approx(0.04 * 0.030 * loads_of_journals, rel=1e-12)
