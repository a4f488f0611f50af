"""The speed of the shaft: its reference against laws and another method, its rivals, and kurbel in every scene."""

from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest

from kurbel import loads
from kurbel.accuracy import marching
from kurbel.accuracy.extremes import table_lines
from kurbel.accuracy.marching import Marched, Problem, rivals
from kurbel.accuracy.methods import integrals, mp
from kurbel.accuracy.references import Textbook
from kurbel.accuracy.shaft import (
    MOST,
    TextbookShaft,
    collocation,
    equation_in_floats,
    periodic_solution,
    speed_of,
    without_reference,
)
from kurbel.accuracy.stiff import examined_speed, reference_of, speed_by_kurbel
from kurbel.accuracy.textbook import DIGITS
from kurbel.solver.case import Case
from kurbel.solver.flywheel import MachineTurning

ENGINE = """
{speed: 50 rpm, crank: 400 mm, rod: 2000 mm, bore: 450 mm, masses: {piston: 500 kg},
 indicator: {head_end: {constant: {expansion: 5 bar, compression: 0 bar}}, crank_end: mirrored},
 flywheel: {inertia: 900 kg m2}, load: LOAD}
"""
COUPLED = ENGINE.replace(
    "load:", "coupling: {stiffness: 5e5 N m/rad, damping: 2e3 N m s/rad, inertia: 600 kg m2}, load:"
)
SLIP = ENGINE.replace("LOAD", "{slip: 0.2}")
SCENES = {loads(text).name: (text, columns) for _, text, *columns in table_lines("stiff.tsv")}


def shaft_of(text: str) -> TextbookShaft:
    with mp.workdps(DIGITS):
        shaft = TextbookShaft(Textbook(loads(text)))
        assert shaft.fits
        return shaft


@pytest.fixture(scope="module")
def shaft() -> TextbookShaft:
    return shaft_of(SLIP)


def problem_of(shaft: TextbookShaft) -> Callable[[], Problem]:
    return lambda: Problem(equation_in_floats(shaft.equation), shaft.fits, shaft.cycle)


@pytest.fixture(scope="module")
def runs(shaft: TextbookShaft) -> dict[tuple[str, str], Marched]:
    return {(name, points): run() for name, points, run in rivals(problem_of(shaft))}


@pytest.mark.parametrize(
    ("text", "load"),
    [(ENGINE, "{power_law: 2}"), (ENGINE, "{power_law: -0.5}"), (COUPLED, "{slip: 0.2}")],
)
def test_the_load_takes_what_the_torque_gives(text: str, load: str) -> None:
    """Over a cycle the works of torque and load are equal: the mean load is the mean torque."""
    shaft = shaft_of(text.replace("LOAD", load))
    equation = equation_in_floats(shaft.equation)
    mesh = periodic_solution(equation, shaft.fits.at, shaft.edges.astype(float), 14)
    w = np.asarray(
        equation.speed(mesh.energy, list(mesh.y[:, :, 1:])) if text == ENGINE else mesh.y[2][:, 1:]
    )
    weights = collocation(14)[1][-1].astype(float)
    means = equation.load.torque(w) @ weights
    assert means @ np.diff(mesh.edges) / 360 == pytest.approx(equation.load.mean, rel=1e-7)


@pytest.mark.slow
def test_the_reference_is_that_of_another_method(shaft: TextbookShaft) -> None:
    integrate = pytest.importorskip("scipy.integrate")
    with mp.workdps(DIGITS):
        exact = speed_of(shaft, MOST)
    problem = problem_of(shaft)()
    y = problem.start()
    angles = np.radians(np.arange(0, 361, 30))
    cuts = np.radians(shaft.edges.astype(float))
    for _ in range(25):
        before, every = y, [y]
        for low, high in pairwise(cuts):
            solved = integrate.solve_ivp(
                lambda phi, y: problem.rate(problem.torque_and_energy(np.degrees(phi)), y.tolist()),
                (low, high),
                every[-1],
                method="DOP853",
                rtol=1e-12,
                atol=1e-6,
            )
            every.append(solved.y[:, -1])
        y = every[-1]
        if np.abs(y - before).max() < 1e-10 * np.ptp(every):
            break
    at = [every[np.abs(cuts - angle).argmin()] for angle in angles[1:]]
    energy = problem.fits.at(np.degrees(angles[1:]), np.degrees(angles[1:]) - 1e-9)[1]
    omega = problem.equation.nominal * (1 + problem.equation.speed(energy, [np.concatenate(at)]))
    assert omega == pytest.approx(exact.omega.astype(float), rel=1e-9)


def test_rivals_converge_to_the_periodic_speed(
    shaft: TextbookShaft, runs: dict[tuple[str, str], Marched]
) -> None:
    truth = speed_by_kurbel(MachineTurning(Case(loads(SLIP)).effort)).omega

    def missed(*names: str) -> float:
        speed = runs[names].speed
        assert speed is not None
        return float(np.abs(speed.omega / truth - 1).max())

    assert (
        missed("RK4 marched", "36")
        > 30 * missed("RK4 marched", "360")
        > 30 * missed("RK4 marched", "1800")
    )
    assert missed("RK4 by shooting", "1800") == pytest.approx(
        missed("RK4 marched", "1800"), rel=0.1, abs=1e-12
    )
    if marching.scipy_integrate():
        for method in ("RK45", "LSODA"):
            assert (
                missed(f"{method} marched", "1e-03") > missed(f"{method} marched", "1e-09") < 1e-5
            )


CONSTANT = ENGINE.replace("LOAD", "constant")


@pytest.mark.parametrize("text", [CONSTANT, COUPLED.replace("LOAD", "constant")])
def test_the_level_under_a_constant_load_is_that_of_the_nominal_speed(text: str) -> None:
    """The reference, kurbel and the rivals agree, of which those of finer steps are nearer."""
    shaft = shaft_of(text)
    with mp.workdps(DIGITS):
        exact = speed_of(shaft, MOST)
    kurbel = speed_by_kurbel(MachineTurning(Case(loads(text)).effort))
    assert kurbel.omega == pytest.approx(exact.omega.astype(float), rel=2e-15)
    assert kurbel.delta == pytest.approx(float(exact.delta), rel=2e-14)
    runs = {(name, points): run for name, points, run in rivals(problem_of(shaft))}
    way = "over one cycle" if text == CONSTANT else "marched"
    missed = []
    for steps in ("36", "360"):
        speed = runs[f"RK4 {way}", steps]().speed
        assert speed is not None
        missed.append(np.abs(speed.omega / kurbel.omega - 1).max())
    assert missed[0] > 30 * missed[1]


def test_energy_under_a_constant_load() -> None:
    """½ J (ω² − ω_n²) rises from 30° to 210° by the work that the torque at ω_n has more than the load."""
    shaft = shaft_of(CONSTANT)
    omega = speed_by_kurbel(MachineTurning(Case(loads(CONSTANT)).effort)).omega
    edges = shaft.edges.astype(float)
    edges = edges[(edges >= 30) & (edges <= 210)]
    work = np.radians(integrals(lambda phi, at: shaft.fits.at(phi, at)[0], edges, 24).sum())
    work -= np.pi * float(shaft.equation.load.mean)
    ends = np.array([30.0, 210.0])
    squares = (omega[[0, 6]] / float(shaft.nominal)) ** 2 - 1
    energies = shaft.fits.at(ends, ends)[1] * squares
    assert energies[1] - energies[0] == pytest.approx(work, rel=1e-12)


def test_failures_are_named() -> None:
    stiff = shaft_of(ENGINE.replace("LOAD", "{slip: 1e-4}"))
    heavy = shaft_of(ENGINE.replace("LOAD", "{slip: 0.2}").replace("900 kg", "9e7 kg"))
    runs = {(name, points): run for name, points, run in rivals(problem_of(stiff))}
    assert runs["RK4 marched", "36"]().state == runs["RK4 by shooting", "36"]().state == "blow-up"
    if marching.scipy_integrate():
        assert runs["RK45 marched", "1e-03"]().state == "gave up after 6000 evaluations"
    slow = {(name, points): run for name, points, run in rivals(problem_of(heavy))}
    assert slow["RK4 marched", "36"]().state == "not periodic in 20 cycles"


@pytest.mark.parametrize("name", SCENES)
def test_kurbel_in_every_scene(name: str) -> None:
    """Against the stored references of 40 digits; δ of 3e-8 is known to 2e-17 of ω."""
    text, columns = SCENES[name]
    own, truth = speed_by_kurbel(MachineTurning(Case(loads(text)).effort)), reference_of(columns)
    assert own.omega == pytest.approx(truth.omega.astype(float), rel=4e-15)
    assert own.omega_max == pytest.approx(float(truth.omega_max), rel=2e-15)
    assert own.delta == pytest.approx(float(truth.delta), rel=2e-14, abs=1e-16)
    assert pytest.approx([float(value) for value in truth.M_K], rel=1e-13) == own.M_K


@pytest.mark.slow
def test_stored_references_are_those_of_the_collocation() -> None:
    """Of one scene; benchmarks/stiff_scenes.py computes them all."""
    text, columns = SCENES["Fan, J = 1e6 kg m²"]
    with mp.workdps(DIGITS):
        exact, stored = speed_of(TextbookShaft(Textbook(loads(text))), MOST), reference_of(columns)
        assert max(abs(exact.omega / stored.omega - 1)) < 1e-20
        assert abs(exact.delta / stored.delta - 1) < 1e-20


@pytest.mark.parametrize(
    ("text", "why"),
    [
        (SLIP.replace("speed: 50 rpm,", ""), "no speed line"),
        (SLIP.replace("load:", "efficiency: 0.9, load:"), "an efficiency"),
    ],
)
def test_a_speed_without_reference_is_left_out(text: str, why: str) -> None:
    assert why in next(without_reference(loads(text)))
    assert examined_speed(Textbook(loads(text)), (), True)[0] == []
