"""`kurbel delivery`: flows against the books and an own quadrature, vessels, pipes, compressors, load cases."""

import json
import math
from itertools import pairwise

import numpy as np
import pytest

import kurbel as api
from command import run
from kurbel.report.delivery import delivery_left_out, delivery_warnings
from kurbel.solver.chapters.delivery import Delivery
from representative import CONFIGS

AREA, STROKE = math.pi / 4 * 0.1**2, 0.2
SINGLE, DOUBLE = (
    "head_end: {constant: {expansion: 0 bar, compression: 3 bar}}",
    ", crank_end: mirrored",
)
PUMPS = {
    "one single-acting": ((0,), ""),
    "one double-acting": ((0,), DOUBLE),
    "two double-acting": ((0, 90), DOUBLE),
    "three single-acting": ((0, 120, 240), ""),
    "five single-acting": ((0, 72, 144, 216, 288), ""),
}
BOOK = {  # formulas: fluctuating volume over A s for L/R = ∞, 5, 4; largest over mean flow for ∞, 5
    "one single-acting": (0.551102, 0.553084, 0.554255, 3.141593, 3.203900),
    "one double-acting": (0.210514, 0.258025, 0.272393, 1.570796, 1.601950),
    "two double-acting": (0.042176, 0.142999, 0.168801, 1.110721, 1.269395),
    "three single-acting": (0.009042, 0.029388, 0.035476, 1.047198, 1.067967),
    "five single-acting": (0.003197, 0.007658, 0.008854, 1.016641, 1.019489),
}


def machine(kind: str, ratio: object, more: str = "") -> str:
    angles, second = PUMPS[kind]
    one = f"stroke: 200 mm, rod_ratio: {ratio}, bore: 100 mm, indicator: {{{SINGLE}{second}}}"
    cylinders = "".join(f"  - {{{one}, crank_position: {angle} deg}}\n" for angle in angles)
    return f"speed: 60 rpm\ncylinders:\n{cylinders}{more}"


def pump_of(text: str) -> Delivery:
    pump = api.solve(api.loads(text)).delivery.pump
    assert pump
    return pump


# pumps


@pytest.mark.parametrize("kind", BOOK)
def test_fluctuating_volumes_of_the_table(kind: str) -> None:
    for ratio, printed in zip(("infinite", 5, 4), BOOK[kind]):
        pump = pump_of(machine(kind, ratio))
        assert pump["volume_fluctuation"].value / (AREA * STROKE) == pytest.approx(
            printed, abs=1e-6
        )
    for ratio, printed in zip(("infinite", 5), BOOK[kind][3:]):
        pump = pump_of(machine(kind, ratio))
        assert pump["flow_max"].value / pump["flow_mean"].value == pytest.approx(printed, abs=1e-6)


def by_quadrature(cylinders: list[tuple[float, float, float, float, float, float]]) -> float:
    """Return ΔV in m³ of cylinders (R, L, e, A_head, A_crank, crank angle) from their displacements alone.

    What a chamber has delivered is its displacement. Extremes are those of 2 million angles, near which V is flat.
    """
    phi = np.linspace(0.0, 2 * np.pi, 2_000_001)
    delivered = np.zeros_like(phi)
    for R, L, e, head, crank, late in cylinders:

        def x(angle: np.ndarray, R: float = R, L: float = L, e: float = e) -> np.ndarray:
            side = R * np.sin(angle) - e
            return R * np.cos(angle) + (np.sqrt(L * L - side * side) if math.isfinite(L) else 0.0)

        steps = np.diff(x(phi - math.radians(late)))  # outward motion shrinks the head end
        delivered[1:] += np.cumsum(np.where(steps > 0, head * steps, -crank * steps))
    swing = delivered - delivered[-1] * phi / (2 * np.pi)
    return float(np.ptp(swing))


MIXED = """\
speed: 60 rpm
cylinders:
  - {crank: 100 mm, rod: 450 mm, offset: 30 mm, bore: 100 mm, crank_end_rod: 40 mm, indicator: {H, crank_end: mirrored}}
  - {crank: 80 mm, rod: 300 mm, bore: 120 mm, crank_position: 100 deg, indicator: {H}}
  - {crank: 90 mm, rod_ratio: infinite, bore: 70 mm, crank_position: 230 deg, indicator: {H}}
""".replace("H", SINGLE)


def test_own_quadrature_of_offset_and_unequal_machines() -> None:
    head = [math.pi / 4 * bore**2 for bore in (0.1, 0.12, 0.07)]
    crank = math.pi / 4 * (0.1**2 - 0.04**2)
    pump = pump_of(MIXED)
    # the inner dead centre of the offset cylinder, from which positions count: crank and rod in one line
    idc = math.degrees(math.asin(0.03 / (0.1 + 0.45)))
    own = by_quadrature(
        [
            (0.1, 0.45, 0.03, head[0], crank, 0.0),
            (0.08, 0.3, 0.0, head[1], 0.0, 100.0 + idc),
            (0.09, math.inf, 0.0, head[2], 0.0, 230.0 + idc),
        ]
    )
    assert pump["volume_fluctuation"].value == pytest.approx(own, rel=1e-9)


def test_a_vessel_saves_what_the_books_say() -> None:
    for kind, saved in (
        ("one single-acting", 1 - 3 / (2 * math.pi**2)),
        ("one double-acting", 1 - 6 / math.pi**2),
    ):
        pump = pump_of(machine(kind, "infinite"))
        assert pump["vessel_saving"].value == pytest.approx(saved, rel=1e-12)


BOTH_PIPES = """\
pump:
  suction_pipe: {length: 6 m, diameter: 80 mm, friction_factor: 0.03}
  delivery_pipe: {length: 9 m, diameter: 50 mm, friction_factor: 0.02}
"""
UNLIKE = """\
speed: 60 rpm
cylinders:
  - {stroke: 200 mm, rod_ratio: RATIO, bore: 100 mm, indicator: {H, crank_end: mirrored}}
  - {stroke: 200 mm, rod_ratio: RATIO, bore: 100 mm, crank_position: 90 deg, indicator: {H}}
""".replace("H", SINGLE)
"""A double- and a single-acting pump at 90°: what is drawn in is not what is delivered a moment later."""


def flows_of_unlike(ratio: float, samples: int = 200_000) -> tuple[np.ndarray, np.ndarray]:
    """Return what both pumps of `UNLIKE` deliver and draw in, in m³/s at 60 rpm, in the middle of equal steps."""
    phi = (np.arange(samples) + 0.5) * 2 * np.pi / samples

    def outward(angle: np.ndarray) -> np.ndarray:
        aside = np.sin(angle) / ratio
        return (
            -STROKE
            / 2
            * np.sin(angle)
            * (1 + np.cos(angle) / ratio / np.sqrt(1 - aside**2))
            * 2
            * np.pi
        )

    double, single = AREA * outward(phi), AREA * outward(phi - np.pi / 2)
    return np.abs(double) + np.maximum(single, 0), np.abs(double) + np.maximum(-single, 0)


@pytest.mark.parametrize(("ratio", "printed"), [(math.inf, 0.316), (5.0, None), (4.0, None)])
def test_vessels_save_the_work_of_both_pipes(ratio: float, printed: float | None) -> None:
    """Losses are as the cube of the flow of each pipe, suction by what is drawn in."""
    written = "infinite" if math.isinf(ratio) else ratio
    pump = pump_of(UNLIKE.replace("RATIO", str(written)) + BOTH_PIPES)
    delivered, drawn = flows_of_unlike(ratio)
    bare = steady = 0.0
    for flow, length, diameter, factor in ((drawn, 6.0, 0.08, 0.03), (delivered, 9.0, 0.05, 0.02)):
        section = math.pi / 4 * diameter**2
        scale = 1000 * factor * length / (2 * diameter * section**2)  # of a turn in one second
        bare += scale * np.mean(flow**3)
        steady += scale * np.mean(flow) ** 3
    assert pump["pipe_work_bare"].value == pytest.approx(bare, rel=1e-8)
    assert pump["pipe_work_steady"].value == pytest.approx(steady, rel=1e-8)
    assert pump["vessel_saving"].value == pytest.approx(1 - steady / bare, rel=1e-8)
    if printed is not None:
        assert pump["vessel_saving"].value == pytest.approx(printed, abs=5e-4)


def test_pipes_without_friction_leave_the_saving_of_the_flow() -> None:
    smooth = BOTH_PIPES.replace("0.03", "0").replace("0.02", "0")
    text = UNLIKE.replace("RATIO", "5")
    assert pump_of(text + smooth)["vessel_saving"].value == pump_of(text)["vessel_saving"].value


def test_each_pipe_has_the_head_of_its_own_flow() -> None:
    """Where the single-acting pump draws in, 45° after its dead centre, the delivery pipe carries the other alone."""
    pump = pump_of(UNLIKE.replace("RATIO", "infinite") + BOTH_PIPES)
    phi = 135.0  # of the double-acting pump; 45° of the single-acting one, whose head end grows
    lone = AREA * STROKE / 2 * 2 * math.pi * math.sin(math.radians(135))
    second = AREA * STROKE / 2 * 2 * math.pi * math.sin(math.radians(45))
    columns = pump.columns([phi], "friction_head", "delivery_friction_head")

    def head(flow: float, length: float, diameter: float, factor: float) -> float:
        u = flow / (math.pi / 4 * diameter**2)
        return factor * length * u**2 / (2 * 9.80665 * diameter)

    assert columns["friction_head"] == pytest.approx(
        [head(lone + second, 6, 0.08, 0.03)], rel=1e-12
    )
    assert columns["delivery_friction_head"] == pytest.approx(
        [head(lone, 9, 0.05, 0.02)], rel=1e-12
    )


def test_a_long_suction_pipe_lifts_less_by_its_acceleration_head() -> None:
    """Without friction the lift is the barometer less vapour pressure and the head l/(g a) A R ω² where it begins."""
    pipe = "pump: {suction_pipe: {length: 8 m, diameter: 80 mm}}"
    pump = pump_of(machine("one single-acting", "infinite", pipe))
    needed = 8 / (9.80665 * math.pi / 4 * 0.08**2) * AREA * STROKE / 2 * (2 * math.pi) ** 2
    assert pump["suction_lift_max"].value == pytest.approx(
        (101325 - 2339) / 9806.65 - needed, rel=1e-12
    )


@pytest.mark.parametrize("exponent", [1.0, 1.3])
def test_vessels_both_ways(exponent: float) -> None:
    """The wanted swing gives a volume, and that volume the swing; isothermal it is ΔV/δ."""
    pipe = "pump: {delivery_pipe: {length: 10 m, diameter: 50 mm, vessel: {%s, exponent: %s}}}"
    text = machine("three single-acting", 5, pipe % ("pressure_swing: 0.1", exponent))
    sized = pump_of(text)
    volume, swing = sized["vessel_volume"].value, sized["volume_fluctuation"].value
    ratio = (volume + swing / 2) / (volume - swing / 2)
    high, low = ratio**exponent, 1.0
    assert 2 * (high - low) / (high + low) == pytest.approx(0.1, rel=1e-12)
    if exponent == 1:
        assert volume == pytest.approx(swing / 0.1, rel=1e-12)
    text = machine("three single-acting", 5, pipe % (f"volume: {volume!r} m3", exponent))
    given = pump_of(text)
    assert given["vessel_swing"].value == pytest.approx(0.1, rel=1e-12)


def test_heads_in_a_suction_pipe() -> None:
    """With an infinite rod dq/dt = A R ω² cos φ: largest where the suction begins."""
    pipe = "pump: {slip: 10 %, suction_pipe: {length: 8 m, diameter: 80 mm, friction_factor: 0.03}}"
    pump = pump_of(machine("one single-acting", "infinite", pipe))
    omega, section = 2 * math.pi, math.pi / 4 * 0.08**2
    acceleration = 8 / (9.80665 * section) * 0.9 * AREA * 0.1 * omega**2
    assert pump["acceleration_head_max"].value == pytest.approx(acceleration, rel=1e-12)
    u = 0.9 * AREA * 0.1 * omega / section
    friction = 0.03 * 8 * u**2 / (2 * 9.80665 * 0.08)
    columns = pump.columns([90.0, 270.0], "friction_head", "flow_suction")
    assert columns["friction_head"] == pytest.approx([friction, 0.0], rel=1e-12)
    phi = np.linspace(0, np.pi, 100_001)
    most = np.max(acceleration * np.cos(phi) + friction * np.sin(phi) ** 2)
    assert pump["suction_lift_max"].value == pytest.approx(
        (101325 - 2339) / 9806.65 - most, rel=1e-9
    )
    assert pump["flow_mean"].value == pytest.approx(0.9 * AREA * STROKE, rel=1e-12)


def test_each_piston_and_chamber() -> None:
    delivery = api.solve(api.loads(MIXED)).delivery
    assert delivery.pump
    assert sum(piston["flow_mean"].value for piston in delivery.pistons) == pytest.approx(
        delivery.pump["flow_mean"].value
    )
    first = delivery.pistons[0].columns([40.0, 100.0, 200.0, 300.0])
    assert first["flow_head"] + first["flow_crank"] == pytest.approx(first["flow"])
    assert (first["flow_head"][:2] == 0).all()  # the outstroke shrinks the crank end


@pytest.mark.parametrize("ratio", [0.6, -0.6])
@pytest.mark.parametrize("second", ["", DOUBLE])
def test_a_pump_that_a_lever_drives(ratio: float, second: str) -> None:
    """Its piston moves by so many crosshead displacements; what its chambers lose, they deliver, less the slip."""
    steam = "{constant: {expansion: 9 bar, compression: 0 bar}}"
    file = (
        "speed: 60 rpm\ncrank: 150 mm\nrod: 700 mm\noffset: 40 mm\nbore: 250 mm\npump: {slip: 0.1}\n"
        f"indicator: {{head_end: {steam}, crank_end: mirrored}}\n"
        f"tandem: [{{bore: 120 mm, crank_end_rod: 50 mm, lever_ratio: {ratio}, indicator: {{{SINGLE}{second}}}}}]\n"
    )
    delivery = api.solve(api.loads(file)).delivery
    head, crank = math.pi / 4 * 0.12**2, math.pi / 4 * (0.12**2 - 0.05**2) * bool(second)

    ends = (
        (head, crank) if ratio > 0 else (crank, head)
    )  # against the crosshead the other end delivers
    swing = by_quadrature([(0.15, 0.7, 0.04, *(0.9 * abs(ratio) * end for end in ends), 0.0)])
    assert delivery.pump
    stroke = math.sqrt(0.85**2 - 0.04**2) - math.sqrt(0.55**2 - 0.04**2)
    assert delivery.pump["flow_mean"].value == pytest.approx(
        0.9 * abs(ratio) * sum(ends) * stroke, rel=1e-12
    )
    assert delivery.pump["volume_fluctuation"].value == pytest.approx(swing, rel=1e-9)
    phi = np.radians([50.0, 130.0, 240.0, 330.0])
    aside = 0.15 * np.sin(phi) - 0.04
    outward = -0.15 * np.sin(phi) - aside * 0.15 * np.cos(phi) / np.sqrt(
        0.7**2 - aside**2
    )  # dx/dφ from the shaft
    rate = (
        0.9 * abs(ratio) * np.where(outward > 0, ends[0], ends[1]) * np.abs(outward) * 2 * math.pi
    )
    assert delivery.pump.columns(np.degrees(phi), "flow")["flow"] == pytest.approx(rate, rel=1e-12)


# compressors

ENDS = """\
speed: 600 rpm
stroke: 180 mm
rod: 450 mm
bore: 320 mm
crank_end_rod: 50 mm
gas: {inlet_temperature: 35 °C, molar_mass: 28.96 g/mol, isentropic_exponent: 1.4}
indicator:
  pressures: absolute
  head_end: {compressor: {suction: 1 bar, delivery: 4 bar, clearance: 10 %, exponent: 1.3}}
  crank_end: mirrored
"""
UNLOADED = ENDS.replace("1.3}}", "1.3}, unloaded: true}")


def test_figures_of_the_ideal_card() -> None:
    (stage,) = api.solve(api.loads(ENDS)).delivery.stages
    assert stage["volumetric_efficiency"].value == pytest.approx(0.809515, abs=1e-6)
    assert stage["discharge_temperature"].value == pytest.approx(424.325, abs=1e-3)
    volume = 0.18 * math.pi / 4 * (2 * 0.32**2 - 0.05**2)
    capacity = (1 - 0.1 * (4 ** (1 / 1.3) - 1)) * volume * 10
    assert stage["capacity"].value == pytest.approx(capacity, rel=1e-12)
    mass = 1e5 * capacity * 28.96e-3 / (8.31446261815324 * 308.15)
    assert stage["mass_flow"].value == pytest.approx(mass, rel=1e-12)
    assert stage["capacity_normal"].value == pytest.approx(
        capacity / 1.01325 * 273.15 / 308.15, rel=1e-12
    )
    ideal = 3.5 * 1e5 * capacity * (4 ** (0.4 / 1.4) - 1)
    taken = (
        1.3 / 0.3 * 1e5 * capacity * (4 ** (0.3 / 1.3) - 1)
    )  # of a polytropic card with equal exponents
    assert stage["isentropic_efficiency"].value == pytest.approx(ideal / taken, rel=1e-12)


def test_an_exponent_of_its_own_for_the_expansion() -> None:
    text = ENDS.replace("exponent: 1.3", "exponent: 1.3, expansion_exponent: 1.2")
    (stage,) = api.solve(api.loads(text)).delivery.stages
    assert stage["volumetric_efficiency"].value == pytest.approx(
        1 - 0.1 * (4 ** (1 / 1.2) - 1), rel=1e-12
    )
    # what is delivered was compressed; only what stays in the clearance expands
    assert stage["discharge_temperature"].value == pytest.approx(
        308.15 * 4 ** (0.3 / 1.3), rel=1e-12
    )


def test_the_gas_of_a_cylinder_precedes_that_of_the_machine() -> None:
    """Temperature, gas constant and exponent each, where the cylinder has its own; else those of the machine."""
    own = "gas: {inlet_temperature: 60 °C, gas_constant: 200 J/(kg K), isentropic_exponent: 1.25}\n"
    indented = "".join(f"    {line}\n" for line in ENDS.splitlines()[1:])
    general = next(line for line in ENDS.splitlines() if line.startswith("gas"))
    local = indented.replace(general, own.strip())
    whole = f"speed: 600 rpm\n{general}\ncylinders:\n  -\n{local}"
    (stage,) = api.solve(api.loads(whole)).delivery.stages
    (alone,) = api.solve(api.loads(ENDS.replace(general, own.strip()))).delivery.stages
    capacity = alone["capacity"].value
    assert stage["discharge_temperature"].value == pytest.approx(
        333.15 * 4 ** (0.3 / 1.3), rel=1e-12
    )
    assert stage["mass_flow"].value == pytest.approx(1e5 * capacity / (200 * 333.15), rel=1e-12)
    power = 1.25 / 0.25 * 1e5 * capacity * (4 ** (0.25 / 1.25) - 1)
    assert stage["isentropic_power"].value == pytest.approx(power, rel=1e-12)

    partly = whole.replace(own.strip(), "gas: {inlet_temperature: 60 °C}")
    (mixed,) = api.solve(api.loads(partly)).delivery.stages
    constant = 8.31446261815324 / 28.96e-3
    assert mixed["mass_flow"].value == pytest.approx(
        1e5 * capacity / (constant * 333.15), rel=1e-12
    )


@pytest.mark.parametrize("excess", [1e-14, 1e-10, 1e-6, 1e-2])
def test_isentropic_power_near_the_isothermal_one(excess: float) -> None:
    """At κ → 1 it is p_s V̇ ln(p_d/p_s); e = (κ − 1)/κ times ln(p_d/p_s)/2 is the first term beyond."""
    kappa = 1 + excess
    text = ENDS.replace("isentropic_exponent: 1.4", f"isentropic_exponent: {kappa!r}")
    (stage,) = api.solve(api.loads(text)).delivery.stages
    share = (kappa - 1) / kappa
    series = math.log(4) * sum(
        (share * math.log(4)) ** k / math.factorial(k + 1) for k in range(12)
    )
    assert stage["isentropic_power"].value == pytest.approx(
        1e5 * stage["capacity"].value * series, rel=4e-15
    )


def test_an_unloaded_end_is_not_copied_and_does_no_work() -> None:
    case, whole = api.solve(api.loads(UNLOADED)), api.solve(api.loads(ENDS))
    head, crank = case.cylinders[0].drive.gas[0].works
    assert head == 0
    assert crank == pytest.approx(whole.cylinders[0].drive.gas[0].works[1], rel=1e-15)
    (stage,) = case.delivery.stages
    share = (0.32**2 - 0.05**2) / (2 * 0.32**2 - 0.05**2)
    assert stage["capacity"].value == pytest.approx(
        share * whole.delivery.stages[0]["capacity"].value, rel=1e-12
    )
    assert case.cylinders[0].at([10.0, 200.0]).p_head == pytest.approx([1e5, 1e5])


# load cases


@pytest.mark.parametrize("command", ["forces", "delivery"])
def test_a_row_for_each_load_case(command: str) -> None:
    file = CONFIGS["compressor-two-stage"]
    ids = {"forces": "rod_compression_max", "delivery": "capacity"}[command]
    result = json.loads(run(command, file, "--cases", "--columns", ids, "-f", "json").stdout)
    tables = {part["name"]: part["place_tables"][0] for part in result["cylinders"]}
    assert len(tables) == 2
    for place, case in enumerate(("both ends", "one end unloaded", "relief pressure")):
        alone = json.loads(run(command, file, "--case", case, "--key-values", "-f", "json").stdout)
        for part in alone["cylinders"]:
            table = tables[part["name"]]
            assert table["rows"][place] == {"case": case}
            value = next(
                key_value["value"] for key_value in part["key_values"] if key_value["id"] == ids
            )
            assert table["columns"][0]["values"][place] == value


# many machines, limits, bad input


@pytest.mark.parametrize("written", ["35 °C", "308.15 K", "95 °F", "35 degC"])
def test_temperatures(written: str) -> None:
    gas = api.loads(ENDS.replace("35 °C", written)).gas
    assert gas
    assert gas.inlet_temperature == pytest.approx(308.15, abs=1e-9)


# chambers that are always open to a pipe

ROD = 100 / math.sqrt(2)
"""Diameter in mm of the trunk of a plunger of 100 mm whose annulus is half of it."""
DIFFERENTIAL = f"""speed: 60 rpm
stroke: 200 mm
rod: 1000 mm
bore: 100 mm
crank_end_rod: {ROD!r} mm
indicator:
  head_end: {{constant: {{expansion: -0.3 bar, compression: 5 bar}}}}
  crank_end: 5 bar
pump: {{suction_pipe: {{length: 5 m, diameter: 80 mm}}, delivery_pipe: {{length: 20 m, diameter: 60 mm, friction_factor: 0.02}}}}
"""
CRANK = 0.1
FACTOR = 5.0


def largest_slope() -> float:
    """The largest (dx/dφ)/R of L/R = 5, by a dense search."""
    phi = np.linspace(0.0, np.pi, 2_000_001)
    lam = 1 / FACTOR
    slope = np.sin(phi) * (1 + lam * np.cos(phi) / np.sqrt(1 - (lam * np.sin(phi)) ** 2))
    return float(slope.max())


def test_a_differential_pump_delivers_on_both_strokes() -> None:
    """The plunger gives A and the annulus takes A/2 on the return; on the outstroke the annulus gives A/2 (FA35)."""
    pump = pump_of(DIFFERENTIAL.replace("rod: 1000", "rod: 500"))
    half = AREA / 2 * CRANK * 2 * math.pi
    assert pump["flow_mean"].value == pytest.approx(AREA * STROKE, rel=1e-12)
    assert pump["flow_max"].value == pytest.approx(half * largest_slope(), rel=1e-9)
    assert pump["flow_min"].value == 0
    # own calculation with L/R = 10: numpy, no code of kurbel
    ten = pump_of(DIFFERENTIAL)
    assert ten["flow_max"].value == pytest.approx(0.0024797086203723687, rel=1e-12)
    assert ten["volume_fluctuation"].value == pytest.approx(0.00018254962921158318, abs=1e-13)


def test_it_is_a_double_acting_pump_of_half_the_area() -> None:
    """On the side of delivery; on that of suction it stays single-acting."""
    pump = pump_of(DIFFERENTIAL).at([30.0, 200.0, 300.0])
    double = pump_of(
        DIFFERENTIAL.replace("crank_end: 5 bar", "crank_end: mirrored")
        .replace(f"crank_end_rod: {ROD!r} mm\n", "")
        .replace("bore: 100 mm", f"bore: {ROD!r} mm")
    ).at([30.0, 200.0, 300.0])
    assert pump.flow == pytest.approx(double.flow, rel=1e-12)
    assert pump.flow_suction[1:] == pytest.approx(0, abs=0)
    assert pump.flow_suction[0] == pytest.approx(2 * double.flow_suction[0], rel=1e-12)


def test_a_chamber_open_to_the_suction_pipe_evens_what_is_drawn_in() -> None:
    """The annulus gives half of what the plunger draws in, and takes it again on the return."""
    text = DIFFERENTIAL.replace("crank_end: 5 bar", "crank_end: -0.3 bar")
    state = pump_of(text).at([60.0, 300.0])
    plain = pump_of(DIFFERENTIAL.replace("  crank_end: 5 bar\n", "")).at([60.0, 300.0])
    assert state.flow == pytest.approx(plain.flow, rel=1e-12)
    assert state.flow_suction == pytest.approx([plain.flow_suction[0] / 2] * 2, rel=1e-12)


def test_an_open_chamber_has_no_slip() -> None:
    """Only what passes valves is lost: 0.9 A − A/2 on the return, A/2 on the outstroke."""
    slip = pump_of(DIFFERENTIAL.replace("pump: {", "pump: {slip: 10 %, ")).at([60.0, 300.0])
    plain = pump_of(DIFFERENTIAL).at([60.0, 300.0])
    assert slip.flow[0] == pytest.approx(plain.flow[0], rel=1e-12)
    assert slip.flow[1] == pytest.approx(plain.flow[1] * 0.8, rel=1e-12)


@pytest.mark.parametrize("end", ["0 bar", "2 bar"])
def test_another_pressure_leaves_the_chamber_alone(end: str) -> None:
    """The ambient one is open to the air; any other one is said to count for nothing."""
    text = DIFFERENTIAL.replace("crank_end: 5 bar", f"crank_end: {end}")
    plain = pump_of(DIFFERENTIAL.replace("  crank_end: 5 bar\n", ""))
    assert pump_of(text)["flow_max"].value == pytest.approx(plain["flow_max"].value, rel=1e-14)
    said = run("delivery", "-", "--key-values", text=text).stdout
    assert ("that of neither pipe" in said) == (end == "2 bar")


def test_absolute_pressures_join_the_same_pipe() -> None:
    absolute = DIFFERENTIAL.replace("indicator:", "indicator:\n  pressures: absolute")
    absolute = absolute.replace("-0.3 bar", "0.7 bar")
    assert pump_of(absolute)["flow_max"].value == pump_of(DIFFERENTIAL)["flow_max"].value


def test_a_small_annulus_gives_and_takes_its_own_area() -> None:
    """Of 0.19 A, open to the suction pipe: 0.81 A on the outstroke, 0.19 A on the return."""
    text = DIFFERENTIAL.replace(f"crank_end_rod: {ROD!r}", "crank_end_rod: 90")
    text = text.replace("crank_end: 5 bar", "crank_end: -0.3 bar")
    state = pump_of(text).at([60.0, 300.0])
    annulus, slopes = 0.19 * AREA, pump_of(DIFFERENTIAL).at([60.0, 300.0]).flow_suction[0] / AREA
    assert state.flow_suction == pytest.approx([(AREA - annulus) * slopes, annulus * slopes])


def test_a_sweep_over_the_bore_of_a_differential_pump() -> None:
    rows = api.sweep(DIFFERENTIAL, {"bore": ["100 mm", "110 mm", "120 mm"]}, ["flow_max"])
    alone = [
        pump_of(DIFFERENTIAL.replace("bore: 100", f"bore: {bore}"))["flow_max"].value
        for bore in (100, 110, 120)
    ]
    assert list(rows["flow_max"]) == pytest.approx(alone, rel=1e-13)


SOFT = """\
speed: 300 rpm
stroke: 60 mm
rod_ratio: 4
bore: 40 mm
crank_end_rod: 15 mm
indicator: {head_end: {constant: {expansion: -0.2 bar, compression: 322 bar, clearance: 0.8}}, crank_end: mirrored}
pump: {slip: 3 %, liquid: {bulk_modulus: 2.15 GPa}}
"""


def test_a_compressible_liquid_by_the_formula_of_the_handbooks() -> None:
    """Power pumps: η_v = (1 − Δp β (1 + c/d))/(1 − Δp β), β = 1/K, c/d the clearance; of water 1.5 % at 322 bar."""
    lost = 322.2e5 / 2.15e9
    soft = pump_of(SOFT)
    efficiency = (1 - lost * 1.8) / (1 - lost)
    assert soft["volumetric_efficiency"].value == pytest.approx(0.97 * efficiency, rel=1e-12)
    swept = math.pi / 4 * (2 * 0.04**2 - 0.015**2) * 0.06
    assert soft["stroke_volume"].value == pytest.approx(swept, rel=1e-12)
    # what is delivered has lost the share at its higher pressure
    assert soft["flow_mean"].value == pytest.approx(5 * swept * 0.97 * (1 - 1.8 * lost), rel=1e-12)
    # without clearance the pressure alone takes its share
    tight = pump_of(SOFT.replace("0.8", "0"))
    assert tight["volumetric_efficiency"].value == pytest.approx(0.97, rel=1e-12)
    assert tight["flow_mean"].value == pytest.approx(5 * swept * 0.97 * (1 - lost), rel=1e-12)
    assert lost == pytest.approx(0.015, abs=1e-4)


def by_steps(K: float, clearance: float, count: int = 150_000) -> tuple[float, float, float]:
    """Return volume delivered and drawn in, in m³, and the work in J of one end of `SOFT` per turn, step by step.

    The mass in the chamber is kept in m³ at suction pressure; valves are open as long as the pressure is that of a pipe.
    """
    low, high, area, R, L = -0.2e5, 322e5, math.pi / 4 * 0.04**2, 0.03, 0.12
    phi = np.linspace(0.0, 2 * np.pi, count + 1)
    x = R * (1 - np.cos(phi)) + L - np.sqrt(L**2 - (R * np.sin(phi)) ** 2)
    volumes = (area * (x + clearance * 2 * R)).tolist()
    mass = volumes[0] / (1 - (high - low) / K)
    pressure = high
    delivered = drawn = work = 0.0
    for before, volume in pairwise(volumes):
        wanted = low + K * (1 - volume / mass)
        next_pressure = min(max(wanted, low), high)
        mass_then = volume / (1 - (next_pressure - low) / K)
        if wanted > high:
            delivered += (mass - mass_then) * (1 - (high - low) / K)
        elif wanted < low:
            drawn += mass_then - mass
        work += (pressure + next_pressure) / 2 * (volume - before)
        mass, pressure = mass_then, next_pressure
    return delivered, drawn, work


def test_a_compressible_liquid_step_by_step() -> None:
    """A chamber followed over a turn by its mass: what it gives, draws in, and the work on it."""
    for modulus, clearance in (("2.15 GPa", 0.8), ("0.3 GPa", 0.4)):
        text = SOFT.replace("2.15 GPa", modulus).replace("0.8", str(clearance))
        text = text.replace(", crank_end: mirrored", "").replace("slip: 3 %, ", "")
        case = api.solve(api.loads(text))
        pump = case.delivery.pump
        assert pump is not None
        K = float(modulus.split()[0]) * 1e9
        delivered, drawn, work = by_steps(K, clearance)
        assert pump["flow_mean"].value / 5 == pytest.approx(delivered, rel=3e-5)
        share = drawn / pump["stroke_volume"].value
        assert pump["volumetric_efficiency"].value == pytest.approx(share, rel=3e-5)
        assert case.cylinders[0].work == pytest.approx(work, rel=3e-5)
        # nothing flows before the valves open, where x is z s
        lost = 322.2e5 / K
        mechanism = case.cylinders[0].mechanism
        fractions = np.array([clearance * lost / (1 - lost), 1 - (1 + clearance) * lost])
        suction = mechanism.crank_angles_at(fractions[:1] * 0.06, True)[0]
        delivery = mechanism.crank_angles_at(fractions[1:] * 0.06, False)[0]
        angles = [suction - 0.01, suction + 0.01, delivery - 0.01, delivery + 0.01]
        columns = pump.columns(angles, "flow", "flow_suction")
        assert (columns["flow"] > 0).tolist() == [False, False, False, True]
        assert (columns["flow_suction"] > 0).tolist() == [False, True, False, False]


def test_valves_of_the_crank_end_and_of_a_turned_piston_open_late() -> None:
    """With an infinite rod the crank end, and a piston that a lever turns round, do half a turn later what the head end does."""
    text = SOFT.replace("rod_ratio: 4", "rod_ratio: infinite").replace("crank_end_rod: 15 mm\n", "")
    angles = np.arange(3.0, 360.0, 6.0)
    later = np.mod(angles + 180.0, 360.0)
    double = pump_of(text)
    head = double.columns(angles, "flow_head")["flow_head"]
    crank = double.columns(later, "flow_crank")["flow_crank"]
    assert crank == pytest.approx(head, rel=1e-9)
    assert 0 < np.count_nonzero(head) < 30

    # the same piston in tandem, beside one that idles
    end = "{constant: {expansion: -0.2 bar, compression: 322 bar, clearance: 0.8}}"
    flows = {}
    for ratio in (1, -1):
        tandem = f"[{{bore: 40 mm, lever_ratio: {ratio}, indicator: {{head_end: {end}}}}}]"
        keys = "speed: 300 rpm\nstroke: 60 mm\nrod_ratio: infinite\nbore: 40 mm\n"
        liquid = "pump: {slip: 3 %, liquid: {bulk_modulus: 2.15 GPa}}\n"
        pump = pump_of(f"{keys}tandem: {tandem}\n{liquid}")
        flows[ratio] = pump.columns(angles if ratio > 0 else later, "flow", "flow_suction")
    for id in ("flow", "flow_suction"):
        assert flows[-1][id] == pytest.approx(flows[1][id], rel=1e-9)
    assert flows[1]["flow"] == pytest.approx(head, rel=1e-9)


def test_many_compressible_pumps_are_those_of_each() -> None:
    text = SOFT.replace("slip: 3 %, ", "")
    varied = {
        "pump.liquid.bulk_modulus": ["2.15 GPa", "1.4 GPa", "0.8 GPa", "0.5 GPa"],
        "indicator.head_end.constant.clearance": ["0.8", "0", "0.4", "1.2"],
        "indicator.head_end.constant.compression": ["322 bar", "300 bar", "80 bar", "200 bar"],
    }
    asked = ["flow_mean", "volumetric_efficiency", "volume_fluctuation", "work", "T_max", "dE"]
    rows = api.sweep(api.loads(text), varied, asked)
    for row in range(4):
        keys = [f"{key}={values[row]}" for key, values in varied.items()]
        single = api.solve(api.loads(text, overrides=keys))
        for id in asked:
            assert rows[id][row] == pytest.approx(single[id].value, rel=1e-11), (row, id)


def test_net_positive_suction_head() -> None:
    """(p_0 − p_v)/(ρ g) less lift, friction and acceleration, by hand where suction begins: dq/dt = A R ω²."""
    pipe = "{length: 3 m, diameter: 100 mm, lift: LIFT}"
    text = machine("one single-acting", "infinite", f"pump: {{suction_pipe: {pipe}}}")
    h_a = 3 / (9.80665 * math.pi / 4 * 0.1**2) * AREA * STROKE / 2 * (2 * math.pi) ** 2
    barometer = (101325 - 2339) / 9806.65
    lifted = pump_of(text.replace("LIFT", "2.5 m"))
    assert lifted["npsh_available"].value == pytest.approx(barometer - 2.5 - h_a, rel=1e-12)
    assert lifted["suction_lift_max"].value == pytest.approx(barometer - h_a, rel=1e-12)
    # flooded by 4 m from a closed tank of hot water
    hot = "4 m, pressure: 2.2 bara}, liquid: {density: 958 kg/m3, vapour_pressure: 1.014 bar}"
    flooded = pump_of(text.replace("LIFT}", f"-{hot}"))
    head = (2.2e5 - 1.014e5) / (958 * 9.80665)
    assert flooded["npsh_available"].value == pytest.approx(head + 4 - h_a, rel=1e-12)
    # over the angle: where the flow is largest only friction would be left, here nothing
    columns = flooded.columns([90.0], "npsh")
    assert columns["npsh"] == pytest.approx([head + 4], rel=1e-12)


def test_late_valves_do_not_spare_the_suction_pipe() -> None:
    """What the pipe takes to accelerate the liquid in the dead centre is not saved by a valve that opens after it."""
    pipe = "suction_pipe: {length: 3 m, diameter: 50 mm, lift: -1 m}, liquid: {%s}"
    answers = []
    for liquid in ("density: 998 kg/m3", "density: 998 kg/m3, bulk_modulus: 2 GPa"):
        text = SOFT.replace("liquid: {bulk_modulus: 2.15 GPa}", pipe % liquid)
        pump = pump_of(text)
        answers.append([pump[id].value for id in ("npsh_available", "acceleration_head_max")])
    assert answers[1] == pytest.approx(answers[0], rel=1e-12)


@pytest.mark.parametrize(
    ("lift", "height"),
    [(1.5, "the pump is 1500 mm above the liquid"), (-2, "the liquid is 2000 mm above the pump")],
)
def test_a_liquid_that_boils_where_the_pipe_begins_needs_a_height(lift: float, height: str) -> None:
    """By hand: 0.5 bar below its vapour pressure; behind a vessel, without friction, (0.5 bar)/(ρ g) = 5.1088 m."""
    pipe = f"{{length: 2 m, diameter: 50 mm, lift: {lift} m, pressure: 0.5 bar, vessel: {{volume: 9 l}}}}"
    liquid = "{density: 998 kg/m3, vapour_pressure: 1 bar}"
    text = machine("one single-acting", 5, f"pump: {{liquid: {liquid}, suction_pipe: {pipe}}}")
    delivery = api.solve(api.loads(text)).delivery
    head = -0.5e5 / (998 * 9.80665)
    assert delivery.pump is not None
    assert delivery.pump["npsh_available"].value == pytest.approx(head - lift, rel=1e-12)
    (warning,) = delivery_warnings(delivery)
    assert warning.startswith(f"{height}, but must be 5108.8 mm above it")


def test_what_is_assumed_of_a_pump_is_listed() -> None:
    vessel = "delivery_pipe: {length: 9 m, diameter: 50 mm, vessel: {volume: 9 l}}"
    suction = "suction_pipe: {length: 3 m, diameter: 80 mm}"
    text = machine("one single-acting", 5, f"pump: {{{suction}, {vessel}}}")
    delivery = api.solve(api.loads(text)).delivery
    listed = {item.what: item.why for item in delivery_left_out(delivery)}
    assert listed == {
        "exponent of the air in the delivery vessel": "no exponent given, 1 (isothermal air) is taken",
        "vapour pressure of the liquid": (
            "no vapour_pressure given, that of water at 20 °C, 0.02339 bar, is taken"
        ),
        "NPSH available": "no lift of the suction pipe given",
    }
    drawn = "{unit: bar, expansion: [[0, 3], [0.1, -0.2], [1, -0.2]], compression: [[1, -0.2], [0.9, 3], [0, 3]]}"
    keys = f"speed: 60 rpm\nstroke: 200 mm\nrod_ratio: 5\nbore: 100 mm\nindicator: {{head_end: {drawn}}}\n"
    for more, what in (
        ("pump: {liquid: {bulk_modulus: 2 GPa}}", "compression of the liquid"),
        ("pump: {slip: 2 %}", "pipes, vessels, suction lift"),
    ):
        delivery = api.solve(api.loads(f"{keys}{more}")).delivery
        assert what in {item.what for item in delivery_left_out(delivery)}
        assert delivery.pump is not None
        assert "volumetric_efficiency" not in delivery.pump.answers
    compressor = "{compressor: {suction: 0 bar, delivery: 5 bar, clearance: 0.05}}"
    text = f"{keys.replace(drawn, compressor)}pump: {{liquid: {{bulk_modulus: 2 GPa}}}}\n"
    delivery = api.solve(api.loads(text)).delivery
    assert "what is given under pump" in {item.what for item in delivery_left_out(delivery)}
