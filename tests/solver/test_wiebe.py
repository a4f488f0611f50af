"""Cards that burn by Wiebe's function: figures over p₁V₁, another integrator, laws, batches, and traces made of them."""

import math
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import kurbel
from kurbel.notes.left_out import forces_left_out
from kurbel.notes.warnings import cylinder_warnings
from kurbel.solver.forces import CylinderForces

BORE, STROKE = 0.1, 0.1
SWEPT = math.pi / 4 * BORE**2 * STROKE
RATIO = 10
FIRST = 1e5 * SWEPT * RATIO / (RATIO - 1)
"""p₁V₁ in J of 1 bar and a ratio of 10."""


def text(card: str, rod: str = "infinite", cycle: str = "two-stroke", more: str = "") -> str:
    return (
        f"cycle: {cycle}\nspeed: 1500 rpm\nstroke: 100 mm\nrod: {rod}\nbore: 100 mm\n{more}"
        f"indicator: {{pressures: absolute, head_end: {{wiebe: {{intake: 1 bar, {card}}}}}}}\n"
    )


def forces_of(written: str) -> CylinderForces:
    return kurbel.solve(written).cylinders[0]


@pytest.mark.parametrize(
    ("start", "more", "peak", "peak_at", "work"),
    [
        (-20, "", 87.78226, 10.81, 11.840319),
        (-20, ", runs_on: true", 87.78226, 10.81, 11.914744),
        (-10, "", 70.07915, 18.62, 11.613468),
        (0, "", 53.53263, 27.69, 11.035783),
    ],
)
def test_infinite_rod_with_twenty_times_the_first_pressure_and_volume(
    start: int, more: str, peak: float, peak_at: float, work: float
) -> None:
    """r 10, γ 1.4, Q/(p₁V₁) 20, a 5, n 3, 40°: largest pressure over p₁, its angle, work over p₁V₁.

    Where the function runs on it does so up to the outer dead centre, as in Ferguson's program, in which heat is released
    at every angle after the start: 11.91474. With all of Q released within the duration it would be 11.920639.
    """
    heat = 20 * FIRST
    card = f"compression_ratio: 10, heat: {heat!r} J, start: {start} deg, duration: 40 deg{more}"
    forces = forces_of(text(card))
    assert forces["p_max"].value / 1e5 == pytest.approx(peak, abs=6e-6)
    assert forces["p_max"].degrees == pytest.approx(peak_at, abs=6e-3)
    assert forces["work"].value / FIRST == pytest.approx(work, abs=6e-7)
    assert abs(forces["energy_residual"].value) < 1e-13


# another integrator


def integrated(
    volume: Callable[[Any], Any],
    slope: Callable[[Any], Any],
    span: tuple[float, float],
    q: float,
    wiebe: tuple[float, float, float, float],
    exponents: tuple[float, float],
    pressure: float,
    runs_on: bool,
) -> tuple[list[Any], float]:
    """Return p(θ) and ∮ p dV by an explicit Runge-Kutta method of order 8, V over the stroke volume, q in Pa.

    dp = (q dx_b − n p dV)/V, from the beginning of the compression to the end of the expansion, both in span.
    """
    start, duration, a, n = wiebe
    edges = sorted({span[0], start, start + duration, 0.0, span[1]})
    edges = [edge for edge in edges if span[0] <= edge <= span[1]]
    state = np.array([pressure, 0.0])
    parts = []
    for low, high in pairwise(edges):
        middle = (low + high) / 2
        burns = middle > start and (runs_on or middle < start + duration)
        polytropic = exponents[0] if middle < 0 else exponents[1]

        def rates(
            degrees: float, y: Any, burns: bool = burns, polytropic: float = polytropic
        ) -> Any:
            rate = 0.0
            if burns:
                s = max(degrees - start, 0.0) / duration
                rate = a * n / duration * s ** (n - 1) * math.exp(-a * s**n)
            growth = slope(degrees)
            return [(q * rate - polytropic * y[0] * growth) / volume(degrees), y[0] * growth]

        part = solve_ivp(
            rates, (low, high), state, "DOP853", rtol=1e-13, atol=1e-9, dense_output=True
        )
        parts.append((low, high, part.sol))
        state = part.y[:, -1]
    return parts, float(state[1])


def crank(rod_ratio: float) -> tuple[Callable[[Any], Any], Callable[[Any], Any]]:
    """Return the fraction of the stroke and its slope by degree, of a rod so many times the crank."""
    lam = 1 / rod_ratio

    def fraction(degrees: Any) -> Any:
        phi = np.radians(degrees)
        root = np.sqrt(1 - (lam * np.sin(phi)) ** 2)
        return (1 - np.cos(phi) + (1 - root) / lam) / 2 if lam else (1 - np.cos(phi)) / 2

    def slope(degrees: Any) -> Any:
        phi = np.radians(degrees)
        root = np.sqrt(1 - (lam * np.sin(phi)) ** 2)
        return np.radians(np.sin(phi) * (1 + lam * np.cos(phi) / root) / 2)

    return fraction, slope


CASES = {
    "integer": (
        "compression_ratio: 10, heat: 1.2 kJ, start: -20 deg, duration: 40 deg",
        (1 / 9, 1200.0, (-20.0, 40.0, 5.0, 3.0), (1.4, 1.4), 1.4, False),
    ),
    "diesel": (
        "compression_ratio: 17, fuel: 0.035 g, heating_value: 42.7 MJ/kg, efficiency: 0.98, wall_loss: 0.2, start: -7.3 deg, "
        "duration: 63 deg, shape: 6.9, form_exponent: 1.7, exponent: 1.36, expansion_exponent: 1.28, heat_ratio: 1.33",
        (
            1 / 16,
            0.035e-3 * 42.7e6 * 0.98 * 0.8,
            (-7.3, 63.0, 6.9, 1.7),
            (1.36, 1.28),
            1.33,
            False,
        ),
    ),
    "at once": (
        "compression_ratio: 8, heat: 900 J, start: 3 deg, duration: 30 deg, shape: 3, form_exponent: 1, runs_on: true",
        (1 / 7, 900.0, (3.0, 30.0, 3.0, 1.0), (1.4, 1.4), 1.4, True),
    ),
}


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("rod_ratio", [4.0, math.inf])
def test_pressures_are_those_of_another_integrator(name: str, rod_ratio: float) -> None:
    card, (clearance, heat, wiebe, exponents, kappa, runs_on) = CASES[name]
    rod = "infinite" if math.isinf(rod_ratio) else f"{50 * rod_ratio} mm"
    forces = forces_of(text(card, rod))
    fraction, slope = crank(rod_ratio)
    parts, work = integrated(
        lambda degrees: fraction(degrees) + clearance,
        slope,
        (-180.0, 180.0),
        (kappa - 1) * heat / SWEPT,
        wiebe,
        exponents,
        1e5,
        runs_on,
    )
    assert forces["work"].value == pytest.approx(work * SWEPT, rel=1e-10)
    for low, high, solution in parts:
        degrees = np.linspace(low, high, 25)[1:-1]
        p_head = forces.columns(degrees, "p_head")["p_head"]
        assert p_head == pytest.approx(solution(degrees)[0], rel=1e-10)
    assert abs(forces["energy_residual"].value) < 1e-12


def test_first_law_of_the_closed_cycle() -> None:
    """With n = κ the heat is the work and what the gas still has at the end of the expansion."""
    card = "compression_ratio: 12, heat: 1 kJ, start: -12 deg, duration: 50 deg, form_exponent: 2.2"
    forces = forces_of(text(card, "180 mm"))
    last = float(forces.at([180.0], within=np.array([179.0])).p_head[0])
    volume = SWEPT * 12 / 11
    left = (last - 1e5) * volume / 0.4
    assert forces["work"].value + left == pytest.approx(forces["heat_released"].value, rel=1e-12)
    assert forces["heat_released"].value == pytest.approx(1000 * (1 - math.exp(-5)), rel=1e-14)


def test_a_short_duration_is_combustion_at_constant_volume() -> None:
    """Otto: the work is η = 1 − ε^(1−κ) of the heat, and the card is that of an `otto` with this peak."""
    card = "compression_ratio: 9, heat: 1 kJ, start: -0.05 deg, duration: 0.1 deg, shape: 40"
    wiebe = forces_of(text(card, "200 mm"))
    assert wiebe["work"].value == pytest.approx(1000 * (1 - 9**-0.4), rel=1e-6)
    peak = 1e5 * 9**1.4 + 0.4 * 1000 / (SWEPT / 8)
    otto = forces_of(
        text("", "200 mm").replace(
            "wiebe: {intake: 1 bar, ",
            f"otto: {{intake: 1 bar, peak: {peak!r} Pa, compression_ratio: 9",
        )
    )
    degrees = np.arange(5.0, 360.0, 10.0)
    p_head = wiebe.columns(degrees, "p_head")["p_head"]
    assert p_head == pytest.approx(otto.columns(degrees, "p_head")["p_head"], rel=1e-5)


FOUR_STROKE = "compression_ratio: 10, exhaust: 1.1 bar, heat: 1 kJ, start: -15 deg, duration: 50 deg, form_exponent: 2.5"


def test_four_strokes_have_exhaust_and_intake() -> None:
    """The two strokes that change the gas take the difference of their pressures; the others are those of two strokes."""
    four = forces_of(text(FOUR_STROKE, "200 mm", "four-stroke"))
    two = forces_of(text(FOUR_STROKE.replace("exhaust: 1.1 bar, ", ""), "200 mm"))
    assert four["work"].value == pytest.approx(two["work"].value - 0.1e5 * SWEPT, rel=1e-12)
    degrees = np.arange(3.0, 720.0, 6.0)
    columns = four.columns(degrees, "p_head", "x_b", "dQ")
    is_closed = (degrees < 180) | (degrees > 540)
    assert columns["p_head"][(degrees > 180) & (degrees < 360)] == pytest.approx(1.1e5, rel=1e-14)
    assert columns["p_head"][(degrees > 360) & (degrees < 540)] == pytest.approx(1e5, rel=1e-14)
    closed = two.columns(degrees[is_closed] % 360, "p_head", "x_b", "dQ")
    for id, values in closed.items():
        if id != "phi":
            assert columns[id][is_closed] == pytest.approx(values, rel=1e-11, abs=1e-9)
    assert abs(four["energy_residual"].value) < 1e-12
    lowered = forces_of(text(f"{FOUR_STROKE}, diagram_factor: 0.9", "200 mm", "four-stroke"))
    assert lowered["work"].value == pytest.approx(0.9 * four["work"].value, rel=1e-12)


@pytest.mark.parametrize(("cycle", "falls"), [("two-stroke", 180.0), ("four-stroke", 360.0)])
def test_the_burnt_share_falls_back_at_the_end_of_its_cycle(cycle: str, falls: float) -> None:
    """It passes ½ where a s^2.5 = ln(2/(1 + e^−5)), and in its fall; nowhere beside that."""
    keys = FOUR_STROKE if cycle == "four-stroke" else FOUR_STROKE.replace("exhaust: 1.1 bar, ", "")
    where = forces_of(text(keys, "200 mm", cycle)).angles_where("x_b", 0.5)
    half = -15 + 50 * (math.log(2 / (1 + math.exp(-5))) / 5) ** 0.4
    assert where is not None
    assert where.angles == pytest.approx((half, falls), abs=1e-9)


def test_heat_of_an_offset_crank_is_released_to_the_end_of_its_expansion() -> None:
    """The outstroke takes more than 180°: the share goes on rising there, by the function itself."""
    keys = "compression_ratio: 10, heat: 0.8 kJ, start: 120 deg, duration: 60 deg"
    forces = forces_of(text(keys, "130 mm", more="offset: 15 mm\n"))
    inner, outer = forces.mechanism.dead_centres()
    assert outer - inner > 183
    keys = f"{keys.replace('60', str(outer - inner - 121))}"
    forces = forces_of(text(keys, "130 mm", more="offset: 15 mm\n"))
    after = np.array([175.0, 180.5, outer - inner - 1.5])
    share = (after - 120) / (outer - inner - 121)
    expected = (1 - np.exp(-5 * share**3)) / (1 - math.exp(-5))
    columns = forces.columns(inner + after, "x_b", "dQ")
    assert columns["x_b"] == pytest.approx(expected, rel=1e-12)
    # over one degree, of 0.8 kJ less what the duration leaves
    edges = (np.array([180.0, 181.0]) - 120) / (outer - inner - 121)
    released = 800 * float(np.diff(-np.exp(-5 * edges**3))[0])
    assert columns["dQ"][1] == pytest.approx(released, rel=1e-10)


def test_work_that_is_not_of_the_fuel_is_doubted() -> None:
    """By hand: an expansion with an exponent of less than κ takes up heat, whatever burns."""
    keys = "compression_ratio: 10, start: 0 deg, duration: 50 deg, exponent: 1.4, expansion_exponent: 1.2, heat: %s"
    doubts = [cylinder_warnings(forces_of(text(keys % heat))) for heat in ("1 J", "1 kJ")]
    of_little, of_much = [[line for line in lines if "efficiency" in line] for lines in doubts]
    # p V^n from 10^1.4 bar on over a volume of 1/9 to 10/9 of the stroke, less what the compression takes
    peak = 1e5 * 10**1.4
    gained = peak / 9 * (1 - 10**-0.2) / 0.2 - 1e5 * (10 / 9) * (10**0.4 - 1) / 0.4
    assert gained * SWEPT > 1
    assert len(of_little) == 1
    assert not of_much
    machine = kurbel.loads(text(keys % "0 J"))
    lines = forces_left_out(machine, kurbel.solve(machine).cylinders[0])
    assert ("indicated efficiency", "the fuel has no heat") in [
        (item.what, item.why) for item in lines
    ]


def test_heat_in_the_units_of_heat() -> None:
    """1 kcal is 4186.8 J (International Table); 1 Btu heats 1 lb by 1 °F, 4186.8 · 0.45359237/1.8 J = 1055.05585262 J."""
    keys = "compression_ratio: 10, start: 0 deg, duration: 50 deg, heat: "
    for heat, joules in (("0.25 kcal", 1046.7), ("1 Btu", 1055.05585262)):
        released = forces_of(text(keys + heat))["heat_released"].value
        assert released == pytest.approx(joules * (1 - math.exp(-5)), rel=1e-13)


def test_both_ends_and_an_offset_crank() -> None:
    """Each end from its own dead centre, with its own heat, volume and strokes: the first law holds in both."""
    head = (
        "compression_ratio: 10, heat: 0.8 kJ, start: -15 deg, duration: 50 deg, form_exponent: 2.5"
    )
    crank = "intake: 1 bar, compression_ratio: 10, heat: 0.6 kJ, start: -170 deg, duration: 300 deg"
    machine = text(
        f"{head}}}}}, crank_end: {{wiebe: {{{crank}",
        "130 mm",
        more="offset: 15 mm\ncrank_end_rod: 30 mm\n",
    )
    forces = forces_of(machine)
    inner, outer = forces.mechanism.dead_centres()
    assert abs(outer - inner - 180) > 3
    state = forces.at([outer, inner], within=np.array([outer - 1, inner - 1]))
    gas = forces.drive.own_gas
    assert gas is not None
    lasts = state.p_head[0], state.p_crank[1]
    for last, (_, area), work, heat in zip(lasts, gas.ends, gas.works, (800.0, 600.0)):
        left = (last - 1e5) * area * forces.mechanism.stroke * (10 / 9) / 0.4
        assert work + left == pytest.approx(heat * (1 - math.exp(-5)), rel=1e-12)
    assert abs(forces["energy_residual"].value) < 1e-12


def test_many_machines_are_their_single_ones() -> None:
    written = text(FOUR_STROKE, "200 mm", "four-stroke", "offset: 1 mm\nmasses: {piston: 2 kg}\n")
    values = [
        "work",
        "p_max",
        "T_max",
        "p_rise_max",
        "heat_rate_max",
        "phi_burnt_50",
        "heat_released",
    ]
    keys = {
        "indicator.head_end.wiebe.start": ["-25 deg", "-15 deg", "-7 deg", "2 deg"],
        "indicator.head_end.wiebe.form_exponent": ["1", "2.5", "3", "1.7"],
        "offset": ["0 mm", "10 mm", "5 mm", "0 mm"],
    }
    many = kurbel.sweep(written, keys, values)
    for row in range(4):
        changes = [f"{key}={texts[row]}" for key, texts in keys.items()]
        single = kurbel.solve(kurbel.loads(written, overrides=changes)).cylinders[0]
        for id in values:
            assert many[id][row] == pytest.approx(single[id].value, rel=1e-11), id


def test_the_heat_release_of_a_trace_of_the_card_is_its_function(tmp_path: Path) -> None:
    """Samples every 0.1°: x_b to 1e-7 at these, to 6e-6 on the straight lines between, the heat to 1e-6."""
    card = "compression_ratio: 10, heat: 1.2 kJ, start: -10 deg, duration: 40 deg"
    of_card = forces_of(text(card, "200 mm"))
    degrees = np.arange(3600) / 10
    samples = of_card.columns(degrees, "p_head")["p_head"]
    np.savetxt(tmp_path / "p.csv", np.column_stack((degrees, samples)), "%.17g", ",")
    trace = f"trace: {{file: '{tmp_path / 'p.csv'}', unit: Pa, compression_ratio: 10, heat: {{exponent: 1.4}}"
    of_trace = forces_of(text(card, "200 mm").replace(f"wiebe: {{intake: 1 bar, {card}", trace))
    for id in ("heat_released", "p_rise_max", "phi_burnt_50"):
        assert of_trace[id].value == pytest.approx(of_card[id].value, rel=1e-6)
    for id, tolerance in (("phi_burnt_05", 3e-4), ("phi_burnt_90", 2e-4), ("heat_rate_max", 6e-4)):
        assert of_trace[id].value == pytest.approx(of_card[id].value, abs=tolerance)

    # at samples, and between them
    for step, tolerance in ((0.3, 1e-7), (0.35, 6e-6)):
        angles = np.arange(-60.0, 99.0, step)
        measured = of_trace.columns(angles, "x_b", "dQ")
        exact = of_card.columns(angles, "x_b", "dQ")
        shares = np.clip((angles + 10) / 40, 0, 1)
        function = -np.expm1(-5 * shares**3) / (1 - math.exp(-5))
        assert exact["x_b"] == pytest.approx(function, abs=1e-13)
        assert measured["x_b"] == pytest.approx(function, abs=tolerance)
        assert measured["dQ"] == pytest.approx(exact["dQ"], abs=300 * tolerance)
