"""Cards as people have them: one pressure, millimetres on paper, a planimeter, a mean pressure."""

import math
import re

import pytest

from command import run
from kurbel import loads, solve
from kurbel.errors import MachineFileError
from kurbel.solver.forces import CylinderForces

ENGINE = "speed: 60 rpm\ncrank: 400 mm\nrod: 2 m\nbore: 450 mm\n"
AREA, STROKE, AT = math.pi / 4 * 0.45**2, 0.8, 98066.5
LINES = "expansion: [[0, 57], [32.2, 57], [92, 13.2]], compression: [[92, 7.2], [0, 57]]"
PAPER = "drawn: {length: 92 mm, spring: 6 mm/at}"


def forces_of(text: str) -> CylinderForces:
    (forces,) = solve(loads(ENGINE + text)).cylinders
    return forces


def check(text: str) -> str:
    return run("check", "-", text=ENGINE + text).stdout


@pytest.mark.parametrize("cycle", ["two-stroke", "four-stroke"])
@pytest.mark.parametrize("end", ["head_end", "crank_end"])
def test_one_pressure_is_on_every_stroke(end: str, cycle: str) -> None:
    forces = forces_of(f"cycle: {cycle}\nindicator: {{{end}: 10 bar}}\n")
    state = forces.at([0, 10, 170, 190, 350])
    gauge = getattr(state, end.replace("head_end", "p_head").replace("crank_end", "p_crank"))
    assert gauge.tolist() == [1e6] * 5
    assert forces.work == 0


@pytest.mark.parametrize(("cycle", "turns"), [("two-stroke", 1), ("four-stroke", 2)])
@pytest.mark.parametrize("kind", ["gauge", "absolute"])
@pytest.mark.parametrize("mean", [2.4, -2.4])
def test_a_mean_pressure_keeps_the_work(cycle: str, turns: int, kind: str, mean: float) -> None:
    """Its work is p_i A s in every cycle, by the definition of p_i."""
    indicator = f"indicator: {{pressures: {kind}, head_end: {{mean_pressure: {mean} bar}}}}\n"
    forces = forces_of(f"cycle: {cycle}\n{indicator}")
    assert forces.work == pytest.approx(mean * 1e5 * AREA * STROKE, rel=1e-13)
    assert forces.power == pytest.approx(forces.work / turns, rel=1e-15)
    loaded = 90 if mean > 0 else 360 * turns - 90
    assert forces.at([loaded]).P[0] == pytest.approx(AREA * abs(mean) * 1e5, rel=1e-13)
    assert abs(forces.energy_residual or 0) < 1e-13
    assert "rectangular card of the mean pressure" in check(f"cycle: {cycle}\n{indicator}")


def test_points_on_paper() -> None:
    """57 mm by a spring of 6 mm/at are 9.5 at; 32.2 mm of 92 mm are 0.35 of the stroke."""
    drawn = forces_of(f"indicator: {{head_end: {{{PAPER}, {LINES}}}}}\n")
    written = forces_of(
        "indicator: {head_end: {unit: at, expansion: [[0, 9.5], [0.35, 9.5], [1, 2.2]],"
        " compression: [[1, 1.2], [0, 9.5]]}}\n"
    )
    assert drawn.work == pytest.approx(written.work, rel=1e-14)
    assert drawn.work == pytest.approx(
        (9.5 * 0.35 + 11.7 / 2 * 0.65 - 10.7 / 2) * AT * AREA * STROKE, rel=1e-13
    )
    assert drawn.at([60]).p_head == pytest.approx(written.at([60]).p_head, rel=1e-14)


@pytest.mark.parametrize("planimeter", ["area: 1104 mm2", "mean_height: 12 mm", "area: 11.04 cm2"])
def test_a_planimeter_gives_the_mean_pressure(planimeter: str) -> None:
    """1104 mm² over 92 mm are 12 mm, by a spring of 6 mm/at 2 at."""
    text = f"indicator: {{head_end: {{{PAPER}, {planimeter}}}}}\n"
    assert forces_of(text).mean_pressure == pytest.approx(2 * AT, rel=1e-13)
    assert "rectangular card" in check(text)


def test_mid_ordinates_give_the_mean_pressure() -> None:
    """Ten strips with heights of 18.7 mm on the mean; by a spring of 6 mm/at that is 3.1167 at."""
    ordinates = "[22, 31, 30, 26, 21, 17, 14, 11, 9, 6]"
    text = f"indicator: {{head_end: {{{PAPER}, ordinates: {ordinates}}}}}\n"
    assert forces_of(text).mean_pressure == pytest.approx(18.7 / 6 * AT, rel=1e-13)
    assert "rectangular card" in check(text)
    in_inches = "drawn: {length: 4 in, spring: 0.02 in/psi}, ordinates: [0.9, 1.2, 0.8, -0.1]"
    text = f"indicator: {{head_end: {{{in_inches}}}}}\n"
    assert forces_of(text).mean_pressure == pytest.approx(35 * 6894.757293168, rel=1e-9)


def test_ordinates_at_the_ends_of_a_card() -> None:
    text = f"indicator: {{head_end: {{{PAPER}, ordinates: [0, 31, 30, 26, 0]}}}}\n"
    assert "the first and the last ordinate are 0: are they at the ends" in check(text)


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ("ordinates: [22, 131, 30]", "131 mm is more than the card is long (92 mm)"),
        ("ordinates: [22, 31 mm, 30]", "expected a number, got '31 mm'; it has no unit, write 31"),
        ("ordinates: [22, 31]", "2 numbers; from 3 to 1000 are taken"),
        ("ordinates: 22", "expected a list of numbers, such as"),
        ("ordinates: [22, 31, 30], area: 9 cm2", "'area' and 'ordinates' mean the same"),
        ("ordinates: [22, 31, 30], mean_height: 9 mm", "'mean_height' and 'ordinates' mean the"),
        ("ordinates: [22, 31, 30], expansion: [[0, 1], [92, 2]]", "leave out the ordinates"),
    ],
)
def test_ordinates_that_cannot_be(keys: str, message: str) -> None:
    with pytest.raises(MachineFileError, match=re.escape(message)):
        forces_of(f"indicator: {{head_end: {{{PAPER}, {keys}}}}}\n")


# no clearance, ratios


@pytest.mark.parametrize("exponent", [1, 1.3])
def test_a_steam_card_without_clearance(exponent: float) -> None:
    """Full pressure p over x, then p x^n/z^n to the end, against the exhaust q: the integral of the books."""
    steam = (
        f"{{admission: 8 bar, exhaust: 1 bar, cut_off: 30 %, clearance: 0, exponent: {exponent}}}"
    )
    forces = forces_of(f"indicator: {{pressures: absolute, head_end: {{steam: {steam}}}}}\n")
    log = math.log(1 / 0.3)
    expanded = log if exponent == 1 else (1 - math.exp(-(exponent - 1) * log)) / (exponent - 1)
    assert forces.mean_pressure == pytest.approx(1e5 * (8 * 0.3 * (1 + expanded) - 1), rel=1e-12)
    assert abs(forces.energy_residual or 0) < 1e-12


def test_a_compressor_without_clearance() -> None:
    """W = n/(n−1) p₁ V ((p₂/p₁)^((n−1)/n) − 1), and the volume drawn in is the stroke."""
    card = "{suction: 1 bar, delivery: 7 bar, clearance: 0, exponent: 1.3}"
    forces = forces_of(f"indicator: {{pressures: absolute, head_end: {{compressor: {card}}}}}\n")
    work = 1.3 / 0.3 * 1e5 * AREA * STROKE * (7 ** (0.3 / 1.3) - 1)
    assert forces.work == pytest.approx(-work, rel=1e-12)
    assert abs(forces.energy_residual or 0) < 1e-12
    assert forces.at([0.001]).p_head == pytest.approx(1e5, rel=1e-9)
