"""Pressures over the volume of the chamber or the displacement of the piston: work, exponents and angles without angles.

Expected are the formulas of ideal compressors, and a hydrogen compressor as a program for pulsations computes it
(OpenPulse, p_v curves of its reciprocating compressor): L/R 250/33, clearances 0.158 and 0.1839, p V^1.4 = const.
"""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from command import run
from indicated import Engine, absolute, fraction
from kurbel.errors import MachineFileError
from kurbel.machine.one_cycle import of_cycle
from kurbel.machine_file import loads
from kurbel.solver.case import Case

RATIO = 250 / 33
SUCTION, DISCHARGE = 19.65e5, 37.49e5
STROKE, AREA, CRANK_AREA = 0.381, 0.4138739, 0.4014761
BORE, ROD = np.sqrt(AREA * 4 / np.pi), np.sqrt((AREA - CRANK_AREA) * 4 / np.pi)


def displaced(degrees: Any) -> Any:
    """The fraction of the stroke from the inner dead centre, by the geometry of crank and rod."""
    phi = np.radians(degrees)
    return (1 - np.cos(phi) + RATIO - np.sqrt(RATIO**2 - np.sin(phi) ** 2)) / 2


def compressed(fractions: Any, clearance: float, grows: Any) -> Any:
    """The pressure in Pa between ideal valves, with the exponent 1.4."""
    volume = fractions + clearance
    rising = SUCTION * ((1 + clearance) / volume) ** 1.4
    falling = DISCHARGE * (clearance / volume) ** 1.4
    return np.where(grows, np.maximum(falling, SUCTION), np.minimum(rising, DISCHARGE))


def head_end(count: int = 1023, begin: float = 0.0) -> tuple[Any, Any]:
    """Volumes in m³ and pressures in Pa at so many equal steps of the crank angle, with the closing row."""
    degrees = begin + np.arange(count + 1) * 360 / count
    fractions = displaced(degrees)
    grows = degrees % 360 < 180
    return (fractions + 0.158) * AREA * STROKE, compressed(fractions, 0.158, grows)


def crank_end(count: int = 1023) -> tuple[Any, Any]:
    degrees = 180 + np.arange(count + 1) * 360 / count
    fractions = 1 - displaced(degrees)
    grows = degrees % 360 >= 180
    return (fractions + 0.1839) * CRANK_AREA * STROKE, compressed(fractions, 0.1839, grows)


def trace(folder: Path, columns: Any, keys: str = "volume_unit: m3", name: str = "pv.txt") -> str:
    rows = "".join(" ".join(f"{x:.8e}" for x in row) + "\n" for row in zip(*columns))
    (folder / name).write_text(rows)
    column = "displacement" if "displacement" in keys else "volume"
    return (
        f"{{trace: {{file: '{folder / name}', delimiter: space, unit: Pa, {column}_column: 1, "
        f"{keys}}}}}"
    )


def compressor(head: str, crank: str = "") -> str:
    ends = f"head_end: {head}" + (f", crank_end: {crank}" if crank else "")
    return (
        f"speed: 360 rpm\nstroke: 381 mm\nrod_ratio: 250/33\nbore: {BORE:.12g} m\n"
        f"crank_end_rod: {ROD:.12g} m\nindicator: {{pressures: absolute, {ends}}}\n"
    )


def p_i(clearance: float) -> float:
    """∮ p dz of an ideal compressor: n/(n−1) p₁ (π^((n−1)/n) − 1) λ, λ = 1 − ε₀ (π^(1/n) − 1)."""
    ratio = DISCHARGE / SUCTION
    volumetric = 1 - clearance * (ratio ** (1 / 1.4) - 1)
    return -3.5 * SUCTION * (ratio ** (0.4 / 1.4) - 1) * volumetric


def value(forces: Any, id: str) -> float:
    return float(forces[id].value)


def test_a_double_acting_compressor(tmp_path: Path) -> None:
    """Work of both ends, 1.400 in four lines, and the clearances of the file."""
    text = compressor(trace(tmp_path, head_end()), trace(tmp_path, crank_end(), name="crank.txt"))
    forces = Case(loads(text)).cylinders[0]
    for line in ("n_compression", "n_expansion", "n_compression_crank", "n_expansion_crank"):
        assert value(forces, line) == pytest.approx(1.4, abs=2e-5)
    work = STROKE * (AREA * p_i(0.158) + CRANK_AREA * p_i(0.1839))
    assert value(forces, "work") == pytest.approx(work, rel=2e-5)
    assert value(forces, "V_clearance") == pytest.approx(0.158 * AREA * STROKE, rel=1e-6)
    (gas,) = forces.drive.gas
    assert gas.head.trace.clearance == pytest.approx(0.158, rel=1e-6)
    assert gas.crank.trace.clearance == pytest.approx(0.1839, rel=1e-6)


def test_the_angles_are_those_of_the_mechanism(tmp_path: Path) -> None:
    """Pressures over the angle as the geometry has them, from rows that begin within a stroke and miss both centres."""
    columns = head_end(719, 33.3)
    state = Case(loads(compressor(trace(tmp_path, columns)))).cylinders[0].at([60.0, 250.0, 330.0])
    expected = compressed(displaced(np.array([60.0, 250, 330])), 0.158, np.array([1, 0, 0]) > 0)
    assert np.asarray(state.p_head) == pytest.approx(expected, rel=3e-5)


def test_rows_at_uneven_angles(tmp_path: Path) -> None:
    """Half of the rows of one stroke left out: the work of straight lines, and 1.40."""
    volumes, pressures = head_end(720)
    kept = np.append(np.arange(0, 360, 2), np.arange(360, 721))
    forces = Case(loads(compressor(trace(tmp_path, (volumes[kept], pressures[kept]))))).cylinders[0]
    assert value(forces, "mean_pressure") == pytest.approx(p_i(0.158), rel=2e-4)
    assert value(forces, "n_expansion") == pytest.approx(1.4, abs=2e-3)


def test_several_cycles_and_rows_against_the_time(tmp_path: Path) -> None:
    volumes, pressures = head_end(360)
    columns = (np.tile(volumes[:-1], 3)[::-1], np.tile(pressures[:-1], 3)[::-1])
    keys = "volume_unit: m3, angle_sense: against"
    forces = Case(loads(compressor(trace(tmp_path, columns, keys)))).cylinders[0]
    assert value(forces, "cycles_measured") == 3
    assert value(forces, "mean_pressure") == pytest.approx(p_i(0.158), rel=1e-4)
    second = Case(of_cycle(loads(compressor(trace(tmp_path, columns, keys))), 2)).cylinders[0]
    assert value(second, "mean_pressure") == pytest.approx(p_i(0.158), rel=1e-4)


def test_volumes_from_zero_with_a_clearance(tmp_path: Path) -> None:
    """What the piston displaces alone: the clearance of the machine file counts."""
    volumes, pressures = head_end(360)
    columns = (volumes - volumes.min(), pressures)
    keys = "volume_unit: m3, clearance: 0.158"
    forces = Case(loads(compressor(trace(tmp_path, columns, keys)))).cylinders[0]
    assert value(forces, "n_compression") == pytest.approx(1.4, abs=1e-3)
    assert value(forces, "V_clearance") == pytest.approx(0.158 * AREA * STROKE, rel=1e-12)


def test_the_same_card_at_both_ends(tmp_path: Path) -> None:
    """A mirrored crank end has the pressure of the head end over its own volume."""
    text = compressor(trace(tmp_path, head_end()), "mirrored")
    work = STROKE * (AREA + CRANK_AREA) * p_i(0.158)
    assert value(Case(loads(text)).cylinders[0], "work") == pytest.approx(work, rel=2e-5)


def test_displacements_of_both_ends(tmp_path: Path) -> None:
    """One column of displacements in mm about the middle of the stroke, for both ends."""
    degrees = np.arange(721) / 2
    x = displaced(degrees)
    outward = degrees < 180
    mirrored = compressed(1 - x, 0.1839, ~outward)
    keys = "displacement_unit: mm"
    head = trace(tmp_path, ((x - 0.5) * 381, compressed(x, 0.158, outward)), keys)
    crank = trace(tmp_path, ((x - 0.5) * 381, mirrored), keys, "crank.txt")
    forces = Case(loads(compressor(head, crank))).cylinders[0]
    work = STROKE * (AREA * p_i(0.158) + CRANK_AREA * p_i(0.1839))
    assert value(forces, "work") == pytest.approx(work, rel=1e-4)


@pytest.mark.parametrize("begin", [0.0, 360.0, 500.0])
def test_a_four_stroke_engine_fires_where_the_pressure_is_higher(
    tmp_path: Path, begin: float
) -> None:
    degrees = begin + np.arange(0.0, 1440.5, 0.5)
    pressures = absolute(Engine(), degrees)
    volumes = (fraction(degrees) + 1 / 14) * np.pi / 4 * 0.09**2 * 0.1 * 1e6
    keys = "volume_unit: cm3"
    head = trace(tmp_path, (volumes, pressures * 1e5), keys)
    text = (
        "cycle: four-stroke\nspeed: 1500 rpm\nstroke: 100 mm\nrod_ratio: 4\nbore: 90 mm\n"
        f"indicator: {{pressures: absolute, head_end: {head}}}\n"
    )
    forces = Case(loads(text)).cylinders[0]
    places = np.array([0.0, 20.0, 300.0, 400.0, 700.0])
    read = np.asarray(forces.at(places).p_head) / 1e5
    assert read == pytest.approx(absolute(Engine(), places), rel=2e-3)
    assert value(forces, "n_compression") == pytest.approx(1.33, abs=5e-3)


SWEPT = AREA * STROKE


@pytest.mark.parametrize("digits", [3e-4, 3e-3])
@pytest.mark.parametrize("begin", [0.0, 100.0, 201.0])
def test_volumes_of_few_digits(tmp_path: Path, digits: float, begin: float) -> None:
    """Rounding takes degrees about a dead centre, where the volume hardly changes, and next to nothing of the work."""
    volumes, pressures = head_end(360, begin)
    unit = digits * SWEPT
    columns = (np.round(volumes[:-1] / unit) * unit, pressures[:-1])
    (cylinder,) = Case(loads(compressor(trace(tmp_path, columns)))).cylinders
    assert value(cylinder, "mean_pressure") == pytest.approx(p_i(0.158), rel=2e-4 + digits)
    assert value(cylinder, "n_compression") == pytest.approx(1.4, abs=5e-3)


def test_noisy_volumes_of_three_cycles(tmp_path: Path) -> None:
    """A volume that trembles by 0.1 % of the stroke turns rows before or after the dead centre."""
    volumes, pressures = head_end(360)
    noise = np.random.default_rng(7).normal(scale=1e-3 * SWEPT, size=1080)
    columns = (np.tile(volumes[:-1], 3) + noise, np.tile(pressures[:-1], 3))
    (cylinder,) = Case(loads(compressor(trace(tmp_path, columns)))).cylinders
    assert value(cylinder, "cycles_measured") == 3
    assert value(cylinder, "mean_pressure") == pytest.approx(p_i(0.158), rel=5e-3)


ENGINE = (
    "cycle: four-stroke\nspeed: 1500 rpm\nstroke: 100 mm\nrod_ratio: 4\nbore: 90 mm\n"
    "indicator: {{pressures: absolute, head_end: {}}}\n"
)


@pytest.mark.parametrize(
    ("lag", "sign", "advice"),
    [
        (24, 1, r"put its pressures \d+(\.\d)? deg earlier against its displacements in the file"),
        (0, -1, "write its displacements with the other sign"),
    ],
)
def test_advice_names_no_key_that_is_refused(
    tmp_path: Path, lag: int, sign: int, advice: str
) -> None:
    """Pressures that lag behind, or displacements from the outer dead centre: no key moves such rows."""
    degrees = np.arange(0.0, 720.0, 0.5)
    pressures = np.roll(absolute(Engine(), degrees), lag)
    columns = (sign * fraction(degrees) * 100, pressures * 1e5)
    head = trace(tmp_path, columns, "displacement_unit: mm, compression_ratio: 15")
    machine = tmp_path / "machine.yaml"
    machine.write_text(ENGINE.format(head))
    output = run("check", machine).output
    assert re.search(advice, output), output
    assert "angle_zero" not in output
    assert "angle_step" not in output


def test_an_unknown_unit_is_the_only_fault(tmp_path: Path) -> None:
    for keys in ("volume_unit: furlong3", "displacement_unit: furlong"):
        with pytest.raises(MachineFileError) as raised:
            loads(compressor(trace(tmp_path, GOOD, keys)))
        assert "furlong" in str(raised.value)
        assert "nan" not in str(raised.value)


GOOD = head_end(360)


@pytest.mark.parametrize(
    ("columns", "keys", "message"),
    [
        (
            GOOD,
            "volume_unit: l",
            "the volumes run over 157.686 cm^3, the piston sweeps 157686 cm^3: is 'v",
        ),
        ((GOOD[0] * 1.05, GOOD[1]), "volume_unit: m3", ": 5 %; correct bore, rod or stroke"),
        (
            tuple(column[:181] for column in GOOD),
            "volume_unit: m3",
            "the volumes make no cycle: both strokes are needed, with the rows in the order of",
        ),
        (
            tuple(column[np.argsort(GOOD[0], kind="stable")] for column in GOOD),
            "volume_unit: m3",
            "the volumes make no cycle",
        ),
        (
            tuple(np.append(column[:60], column[120:]) for column in GOOD),
            "volume_unit: m3",
            "line 61: no rows over 51 % of the stroke before it",
        ),
        (
            (np.where(np.arange(361) == 80, GOOD[0] - 0.02, GOOD[0]), GOOD[1]),
            "volume_unit: m3",
            "line 81: the volume goes back by",
        ),
        ((GOOD[0] * 0 + 1, GOOD[1]), "volume_unit: m3", "the volume is the same in all rows"),
        (GOOD, "volume_unit: m3, angle_zero: 5 deg", "follow from the order of the rows; leave"),
        (GOOD, "volume_unit: m3, pressure_column: 1", "column 1 is that of the volumes"),
        (
            GOOD,
            "volume_unit: m3, clearance: 0.0158",
            "the smallest volume is 0.158 of the stroke volume, the clearance 0.0158; leave 'clea",
        ),
        (GOOD, "displacement_unit: m", "the displacements run over 157.686 mm, the piston sweeps"),
    ],
)
def test_likely_mistakes(tmp_path: Path, columns: Any, keys: str, message: str) -> None:
    with pytest.raises(MachineFileError, match=re.escape(message)):
        loads(compressor(trace(tmp_path, columns, keys)))


def test_a_volume_without_a_unit(tmp_path: Path) -> None:
    head = trace(tmp_path, GOOD).replace(", volume_unit: m3", "")
    with pytest.raises(MachineFileError, match="'volume_column' needs 'volume_unit'"):
        loads(compressor(head))


def test_a_turn_in_a_four_stroke_cycle(tmp_path: Path) -> None:
    with pytest.raises(MachineFileError, match="the trace covers 360 deg, a four-stroke cycle"):
        loads("cycle: four-stroke\n" + compressor(trace(tmp_path, GOOD)))
