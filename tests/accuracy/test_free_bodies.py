"""The references of `kurbel accuracy` keep the laws of mechanics, and kurbel agrees with them for every machine."""

from collections.abc import Iterator
from pathlib import Path

import mpmath
import numpy as np
import pytest

from kurbel import loads
from kurbel.accuracy.jets import Jet, turned
from kurbel.accuracy.linkages import RodMotion, motion_of
from kurbel.accuracy.methods import mp
from kurbel.accuracy.references import NEEDED, Textbook, unknown
from kurbel.accuracy.textbook import DIGITS, TextbookCylinder
from kurbel.accuracy.trials import errors, kurbel_answer
from kurbel.accuracy.valves import events_of
from kurbel.machine import Machine
from kurbel.shipped import shipped
from kurbel.solver.case import Case
from kurbel.solver.state import reduced_inertia

mpf = mpmath.mpf


@pytest.fixture(autouse=True)
def digits() -> Iterator[None]:
    with mp.workdps(DIGITS):
        yield


MECHANISMS = {
    "fork head": "mechanism: slotted-lever, crank: 300 mm, frame: 800 mm, lever: 1300 mm",
    "tilt": "mechanism: slotted-lever, crank: 300 mm, frame: 800 mm",
    "link": "mechanism: slotted-lever, crank: 300 mm, frame: 800 mm, lever: 1300 mm, link: 500 mm",
    "Whitworth": "mechanism: slotted-lever, crank: 300 mm, frame: 100 mm",
    "Whitworth with a link": (
        "mechanism: slotted-lever, crank: 300 mm, frame: 100 mm, lever: 400 mm, link: 900 mm"
    ),
    "crank-rocker": (
        "mechanism: four-bar, crank: 40 mm, coupler: 150 mm, rocker: 80 mm, frame: 150 mm"
    ),
    "drag link": (
        "mechanism: four-bar, crank: 100 mm, coupler: 120 mm, rocker: 110 mm, frame: 40 mm"
    ),
    "coupled axle": "mechanism: parallel-crank, crank: 305 mm, frame: 2100 mm",
}


@pytest.mark.parametrize("keys", MECHANISMS.values(), ids=list(MECHANISMS))
def test_statics_of_a_linkage_keep_virtual_work(keys: str) -> None:
    """M dφ = P dx: forces from the lines of the members agree with speeds by differentiation, to 35 digits."""
    motion = motion_of(loads(f"{{{keys}}}").cylinders[0].mechanism)
    assert not isinstance(motion, RodMotion)
    for degrees in (-50, 13, 100, 211, 333):
        work = 7 * motion.at(mpf(degrees)).slope
        assert abs(motion.torque_of(mpf(7), mpf(degrees)) - work) < 1e-35


def test_jets_differentiate() -> None:
    """Of √(e^(iφ) + 2) and of its bearing: as by differences of 40 digits."""

    def function(phi: mpmath.mpf) -> Jet:
        return (turned(phi) + Jet(mpf(2))).root().bearing() / Jet(mpf(3))

    step = mpf("1e-10")
    degrees = mp.degrees(step)
    before, here, after = (function(70 + sign * degrees) for sign in (-1, 0, 1))
    assert here.rate == pytest.approx((after.value - before.value) / (2 * step), rel=1e-15)
    bend = (after.value - 2 * here.value + before.value) / step**2
    assert here.bend == pytest.approx(bend, rel=1e-15)


EXACT = """
{speed: 600 rpm, crank: 60 mm, rod: 220 mm, bore: 100 mm, offset: 8 mm, inclination: 70 deg,
 indicator: {head_end: {unit: bar, expansion: [[0, 30], [1, 2]], compression: [[1, 1], [0, 30]]}},
 masses: {piston: 2 kg, connecting_rod: {mass: 3 kg, center_of_gravity: 150 mm, inertia: 0.02 kg m2}}}
"""


def test_energy_of_an_exact_rod() -> None:
    """What the gas and gravity put in and the torque takes out is the change of the kinetic energy, ½ J ω²."""
    machine = loads(EXACT)
    cylinder = TextbookCylinder(machine, machine.cylinders[0])
    low, high = mpf(20), mpf(80)
    within = mpf(50)

    # heights: the piston moves down by x sin i, the rod's centre of gravity with it and by its swing
    def heights(phi: mpmath.mpf) -> mpmath.mpf:
        pose, lean = cylinder.motion.at(phi), mp.radians(70)
        piston = -pose.x * mp.sin(lean)
        along = pose.x + mpf("0.15") * pose.cos_psi
        rod = -along * mp.sin(lean) + mpf("0.15") * pose.sin_psi * mp.cos(lean)
        return 2 * piston + 3 * rod

    def power(phi: mpmath.mpf) -> mpmath.mpf:
        forces = cylinder.at(mp.degrees(phi), within)
        return forces.P_gas * forces.slope - forces.M

    work = mp.quad(power, [mp.radians(low), mp.radians(high)])
    work -= mpf("9.80665") * (heights(high) - heights(low))
    energy = cylinder.omega**2 / 2 * (cylinder.inertia(high) - cylinder.inertia(low))
    assert work == pytest.approx(energy, rel=1e-14)


def test_events_of_a_valve_without_rod_by_zeuner() -> None:
    """sin(φ + δ) = ±S/r and −E/r: S = r sin δ closes at 180° − 2δ, and so on."""
    text = (
        "{stroke: 600 mm, rod: 1500 mm, bore: 350 mm, valve: {travel: 90 mm, steam_lap: 22.5 mm, "
        "angle_of_advance: 45 deg}, indicator: {head_end: {steam: {admission: 9 at, exhaust: 0.1 at, "
        "clearance: 0.06}}, crank_end: mirrored}}"
    )
    valve = loads(text).cylinders[0].valve
    assert valve is not None
    # 150° − 45°, 180° − 45°, 360° − 45°, 390° − 45°
    expected = [105, 135, 315, 345]
    assert [float(angle) for angle in events_of(valve, "head_end")] == pytest.approx(expected)
    turned_half = [float(angle) - 180 for angle in events_of(valve, "crank_end")]
    assert turned_half == pytest.approx(expected)


RUBBING = """
{speed: 90 rpm, crank: 300 mm, rod: 1200 mm, bore: 350 mm, inclination: 0 deg,
 indicator: {head_end: {unit: bar, expansion: [[0, 8], [0.4, 8], [1, 2]], compression: [[1, 0.2], [0, 1]]}},
 masses: {piston: 120 kg, connecting_rod: 80 kg}, friction: {crosshead: 0.05, crank_pin: 0.04,
 crank_pin_diameter: 120 mm, crosshead_pin: 0.06, crosshead_pin_diameter: 90 mm, journals: 0.03,
 journal_diameter: 150 mm, rings: {count: 3, height: 12 mm, pressure: gas, coefficient: 0.1}}}
"""
YOKE = """
{speed: 80 rpm, mechanism: scotch-yoke, stroke: 120 mm, guide_length: 260 mm, bore: 90 mm,
 indicator: {head_end: {constant: {expansion: -0.4 bar, compression: 3 bar}}}, masses: {piston: 30 kg},
 friction: {block: 0.1, guides: 0.1}}
"""
LOSSES = """
{speed: 60 rpm, crank: 400 mm, rod: 2 m, bore: 450 mm, efficiency: 0.9,
 indicator: {head_end: {unit: bar, expansion: [[0, 8], [0.4, 8], [1, 2]], compression: [[1, 0.2], [0, 1]]}},
 tandem: [{bore: 200 mm, indicator: {head_end: {constant: {expansion: -0.4 bar, compression: 8 bar, clearance: 0.3}}}}],
 pump: {liquid: {bulk_modulus: 9 MPa}},
 force: {unit: kN, points: [[0, 6, 0.5], [0.3, 4, 0.5], [0.3, 7, 1], [1, 7, 1]]}, ram_force: {return: -300 N},
 flywheel: {inertia: 900 kg m2}}
"""
DRIVEN = """
{mechanism: four-bar, crank: 40 mm, coupler: 150 mm, rocker: 80 mm, frame: 150 mm, speed: 120 rpm,
 moment: {work: 40 N m, return: -5 N m}, efficiency: 0.8,
 force: {lever: 0.2 m, constant: -30 N, spring: 400 N/m, preload: 9 N, unit: N, points: [[0, 20, 90], [1, 50, 40]]},
 load: {unit: N m, mean: -8, harmonics: [[2, 3, 4]]}}
"""


@pytest.mark.parametrize(
    "text",
    [
        pytest.param(EXACT, id="exact rod"),
        pytest.param(RUBBING, id="pins and rings by gas"),
        pytest.param(YOKE, id="yoke"),
        pytest.param(LOSSES, id="efficiency, a load that helps and a soft liquid"),
        pytest.param(DRIVEN, id="driven rocker with forces and a load by harmonics"),
    ],
)
def test_kurbel_agrees_with_free_bodies(text: str) -> None:
    """To 1e-13; where friction turns round the solver finds the angle itself."""
    assert max(agreement(loads(text)).values()) < 1e-13


STORED = Path(__file__).parent / "free_bodies.tsv"
"""References of the shipped machines, which benchmarks/free_bodies.py computes and writes."""
ANEW = ["crank-rocker", "gas-engine", "mill-engine", "punch", "scotch-yoke-pump"]
"""Machines whose references are computed again; benchmarks/free_bodies.py computes them all."""


def stored() -> dict[tuple[str, str], list[mpmath.mpf]]:
    """Return the stored values by machine and quantity."""
    values = {}
    for line in STORED.read_text(encoding="utf-8").splitlines()[1:]:
        name, quantity, numbers = line.split("\t")
        values[name, quantity] = [mpf(number) for number in numbers.split()]
    return values


def test_kurbel_agrees_with_free_bodies_of_every_shipped_machine() -> None:
    """To 3e-15; of a ΔE in which the cylinders cancel, relative to the torque of one of them."""
    references = stored()
    missed = {}
    for name, text in shipped().items():
        machine = loads(text)
        textbook = Textbook(machine)
        for quantity in NEEDED:
            answer = kurbel_answer(machine, quantity)
            if answer is None or list(unknown(machine, quantity)):
                continue
            if (name, quantity) not in references:  # a new machine of configs/
                anew = np.atleast_1d(textbook.reference(quantity))
                references[name, quantity] = anew.tolist()
            truth = np.array(references[name, quantity], dtype=object)
            torque = 0.0
            if quantity == "ΔE" and machine.cylinders:
                forces = references[name, "T_max, T_min"]
                torque = float(max(map(abs, forces))) * machine.cylinders[0].mechanism.crank
            error = error_of(answer, truth, torque)
            if error > 3e-15:
                missed[name, quantity] = error
    assert missed == {}, "or has a machine of configs/ changed?"


def test_only_cards_by_wiebe_have_no_free_bodies() -> None:
    left_out = {}
    for name, text in shipped().items():
        machine = loads(text)
        obstacles = {what for quantity in NEEDED for what in unknown(machine, quantity)}
        if obstacles:
            left_out[name] = obstacles
    assert left_out == {"petrol-engine": {"a card by Wiebe"}}


RADIAL = """
{speed: 1500 rpm, cycle: four-stroke, cylinders: [
  {name: main, crank: 60 mm, rod: 240 mm, bore: 100 mm, offset: 5 mm, inclination: 50 deg,
   friction: {crosshead: 0.08, constant: 20 N},
   masses: {piston: 1.4 kg, rotating: 0.3 kg,
     connecting_rod: {mass: 1.5 kg, center_of_gravity: 170 mm, inertia: 0.02 kg m2}},
   indicator: {head_end: {unit: bar, clearance: 0.2, interpolate: polytropic,
     intake: [[0, -0.05], [1, -0.05]], compression: [[1, -0.05], [0, 8.8]],
     expansion: [[0, 26], [0.03, 25], [1, 2.6]], exhaust: [[1, 0.1], [0, 0.1]]}}},
  {name: side, like: main, offset: -3 mm, masses: {piston: 1.3 kg, rotating: 0.1 kg}, bank_angle: 72 deg,
   link_rod: {master: main, length: 185 mm, knuckle_radius: 52 mm, knuckle_angle: 75 deg, mass: 0.7 kg,
     share: 0.45}}]}
"""


def test_kurbel_agrees_with_free_bodies_of_link_rods() -> None:
    """Gas, gravity, friction and an exact master rod: each cylinder at angles of both turns, to 1e-14."""
    machine = loads(RADIAL)
    textbook = Textbook(machine)
    degrees = np.array([47.0, 163.0, 222.0, 355.0, 431.0, 580.0])
    for cylinder, forces in zip(machine.cylinders, Case(machine).cylinders):
        book = textbook.cylinder(cylinder)
        state = forces.at(degrees)
        by_book = [book.at(mpf(angle), mpf(angle)) for angle in degrees]
        expected = {
            "T": [exact.T for exact in by_book],
            "P_gas": [exact.P_gas for exact in by_book],
            "slope": [exact.slope for exact in by_book],
            "F_friction": [exact.F_friction for exact in by_book],
        }
        if cylinder.link_rod:
            expected["moment_on_master"] = [exact.on_master for exact in by_book]
        for name, values in expected.items():
            size = float(max(map(abs, values)))
            missed = np.array(values, dtype=float) - getattr(state, name)
            assert np.abs(missed).max() < 1e-14 * size, (cylinder.name, name)
        inertia = [float(book.inertia(mpf(angle))) for angle in degrees]
        assert reduced_inertia(state) == pytest.approx(inertia, rel=1e-14)


TRACED = """
{speed: 300 rpm, crank: 100 mm, rod: 400 mm, bore: 120 mm, indicator: {pressures: absolute, head_end: {trace:
 {unit: bar, angle_zero: 12 deg, points: [POINTS]}}, crank_end: mirrored}}
"""


def traced(angles: list[float]) -> Machine:
    """Return a machine with a trace on both ends, p = 5 + 4 cos φ + sin 3φ."""
    points = []
    for angle in angles:
        phi = np.radians(angle)
        points.append(f"[{angle}, {5 + 4 * np.cos(phi) + np.sin(3 * phi):.17g}]")
    return loads(TRACED.replace("POINTS", ", ".join(points)))


def test_kurbel_agrees_with_straight_lines_between_the_samples_of_a_trace() -> None:
    """At angles of both strokes, at both ends; integrals and extremes: see `diesel-trace` in the stored references."""
    machine = traced([0.0, 7.0, 31.0, 90.0, 133.0, 202.0, 290.0, 360.0])
    book = Textbook(machine).cylinder(machine.cylinders[0])
    degrees = np.array([1.0, 40.0, 100.0, 179.0, 230.0, 300.0, 359.0])
    state = Case(machine).cylinders[0].at(degrees)
    by_book = [book.at(mpf(angle), mpf(angle)) for angle in degrees]
    assert state.P_gas == pytest.approx([float(exact.P_gas) for exact in by_book], rel=1e-13)
    assert pytest.approx([float(exact.T) for exact in by_book], rel=1e-12) == state.T


def test_the_work_of_a_trace_at_equal_angles_is_a_sum_over_its_samples() -> None:
    """∮ p dx by the trapezium rule with exact dx/dφ, in 40 digits; that of the lines between them is another one."""
    angles = [float(angle) for angle in range(0, 361, 15)]
    machine = traced(angles)
    assert next(unknown(machine, "A_i")).startswith("the work of a trace at equal angles")
    motion = motion_of(machine.cylinders[0].mechanism)
    area = mp.pi / 4 * mpf("0.12") ** 2
    work = mpf(0)
    for angle in angles[:-1]:
        phi = np.radians(angle)
        pressure = mpf(float(5 + 4 * np.cos(phi) + np.sin(3 * phi))) * 100_000
        at_head = motion.at(mpf(angle) - 12).slope
        at_crank = motion.at(mpf(angle) - 12 + 180).slope
        work += pressure * area * (at_head - at_crank) * mp.radians(15)
    answer = kurbel_answer(machine, "A_i")
    assert answer == pytest.approx(float(work), rel=1e-14)


def test_a_trace_of_many_samples_is_left_out_by_name() -> None:
    machine = traced(np.linspace(0.0, 360.0, 501).tolist())
    assert "a trace of more than 400 samples" in unknown(machine, "ΔE")


@pytest.mark.slow
@pytest.mark.parametrize("name", ANEW)
def test_stored_figures_are_those_of_free_bodies(name: str) -> None:
    textbook = Textbook(loads(shipped()[name]))
    for (machine, quantity), values in stored().items():
        if machine == name:
            anew = np.atleast_1d(np.array(textbook.reference(quantity), dtype=object))
            assert max(abs(anew / np.array(values) - 1)) < 1e-23


def agreement(machine: Machine) -> dict[str, float]:
    """Return the errors of kurbel by the references, of every quantity that has one."""
    textbook = Textbook(machine)
    missed: dict[str, float] = {}
    for quantity in NEEDED:
        answer = kurbel_answer(machine, quantity)
        if answer is None or list(unknown(machine, quantity)):
            continue
        truth = np.atleast_1d(np.array(textbook.reference(quantity), dtype=object))
        missed[quantity] = error_of(answer, truth)
    return missed


def error_of(answer: object, truth: np.ndarray, size: float = 0.0) -> float:
    """Return the error of kurbel, relative to the truth or to a larger size, or as it is where both are zero."""
    values = np.atleast_1d(np.asarray(answer, dtype=float))
    if size > np.abs(truth).max():
        return float(np.abs(values - truth).max()) / size
    if np.abs(truth).max() < 1e-30:
        return float(np.abs(values).max())
    error, _ = errors(values, truth)
    assert error is not None
    return error
