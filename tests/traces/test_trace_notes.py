"""Notes on measured traces: what is seen, what it changes, and a way out that leads to no further note."""

import re
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from indicated import Engine, absolute, columns_file, cycles, fraction, indicated
from kurbel.machine_file import loads
from kurbel.mechanisms.setting import Setting
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.notes.left_out import forces_left_out
from kurbel.notes.warnings import machine_notes
from kurbel.solver.case import Case
from kurbel.traces.checks import CHECKS, doubts
from kurbel.traces.correct import Trace, corrected
from kurbel.traces.reading import TraceReading
from representative import few

AMBIENT = 1.01325
ENGINE = Engine()
FINE = np.arange(0.0, 720.0, 0.4)


def written(folder: Path, angles: Any, pressures: Any) -> Path:
    """Write a file of angles and pressures (n,) or (n, m) in bar."""
    columns_file(folder / "p.csv", np.column_stack((angles, pressures)))
    return folder / "p.csv"


def machine_text(
    file: Path, keys: str = "", pressures: str = "absolute", cycle: str = "four-stroke"
) -> str:
    keys = keys if ", unit: " in keys else f", unit: bar{keys}"
    return (
        f"cycle: {cycle}\nspeed: 1500 rpm\nstroke: 100 mm\nrod_ratio: 4\nbore: 90 mm\n"
        f"indicator: {{pressures: {pressures}, head_end: {{trace: {{file: '{file}'{keys}}}}}}}\n"
    )


def notes_of(text: str) -> list[str]:
    """All notes on a machine, but for that on the rod load, which every motored engine has."""
    return [
        note.text
        for note in machine_notes(Case(loads(text)))
        if not note.text.startswith("the rod load")
    ]


@pytest.mark.parametrize("columns", few([[2, 61], [2, 22, 42]], [[2, 61]]))
def test_good_noisy_cycles_are_not_accused(tmp_path: Path, columns: list[int]) -> None:
    """Sixty cycles with 0.3 bar of noise, gauge and absolute, alone and together, with and without clearance."""
    angles, each = cycles(ENGINE, 60, 1.0, noise=0.3, spread=0.08)
    assert float(each.min()) < 0.1  # by single samples nearly every one looks like gauge
    for pressures, lift in (("absolute", 0.0), ("gauge", AMBIENT)):
        file = written(tmp_path, angles, (each - lift).T)
        for keys in ("", ", compression_ratio: 15"):
            assert notes_of(machine_text(file, f", pressure_columns: 2-61{keys}", pressures)) == []
            for column in columns:
                assert (
                    notes_of(machine_text(file, f", pressure_column: {column}{keys}", pressures))
                    == []
                )


def late(degrees: float) -> Any:
    """The engine's pressures as a file shows them whose dead centre stands at these degrees."""
    return absolute(ENGINE, FINE - degrees)


def other_end(digit: float, begin: float) -> tuple[Any, Any]:
    """From cycle to cycle 1 % at the dead centre, 0.05 bar in the gas exchange; or read by a coarse converter."""
    angles = begin + np.arange(0.0, 720.0, 0.5)
    share, other = (angles - begin) / 720, absolute(ENGINE._replace(inlet=0.97, outlet=1.1), angles)
    result = (1 - share) * absolute(ENGINE, angles) + share * other
    return angles, np.round(result / digit) * digit if digit else result


def shaken(seed: int, step: float) -> tuple[Any, Any]:
    """The largest of noisy samples about a flat motored top is anywhere: up to 1.4° late at 0.1 bar of noise."""
    angles, rng = np.arange(0.0, 720.0, step), np.random.default_rng(seed)
    smooth = absolute(MOTORED._replace(inlet=0.4, clearance=1 / 9), angles)
    return angles, smooth + 0.1 * rng.standard_normal(len(angles))


def burning(begin: float) -> tuple[Any, Any]:
    """Two strokes that burn evenly over 40° from a place near the dead centre on: (p V^n)′ ∝ the heat set free."""
    angles = np.arange(0.0, 360.1, 0.1)
    burnt = np.clip(((angles + 180) % 360 - 180 - begin) / 40, 0, 1)
    volume = 0.12 + (1 - np.cos(np.radians(angles))) / 2
    return angles, (1.12 / volume) ** 1.33 * (1 + 1.5 * burnt**2 * (3 - 2 * burnt))


def motored(off: float) -> tuple[Any, Any]:
    """A motored two-stroke chamber whose peak is so many degrees late."""
    angles = np.arange(0.0, 360.05, 0.1)
    return angles, (1.1 / (0.1 + (1 - np.cos(np.radians(angles - off))) / 2)) ** 1.35


MOTORED = Engine(heat=0.0)
RATIO = ", compression_ratio: 15"
GOOD: dict[str, tuple[Any, Any, str]] = {
    "motored": (FINE, absolute(MOTORED, FINE), RATIO),
    "two strokes": (FINE[:900], absolute(Engine(two_stroke=True), FINE[:900]), RATIO),
    "two strokes, motored": (
        FINE[:900],
        absolute(MOTORED._replace(two_stroke=True), FINE[:900]),
        RATIO,
    ),
    **{f"a loss angle of {off}": (FINE, late(off), RATIO) for off in (-0.7, 0.7)},
    **{
        f"ends as another, {one}": (*other_end(*one), "")
        for one in ((0.0, 0.0), (0.1, -30.0), (1.0, -360.0))
    },
    **{f"shaken {one}": (*shaken(*one), "") for one in ((0, 0.1), (1, 0.5), (2, 0.1), (3, 0.5))},
    **{f"motored, {off} late": (*motored(off), "") for off in (-1.0, -0.5, 0.0)},
    **{f"burning from {begin}": (*burning(begin), "") for begin in (-23.0, -20.0, -17.0, -10.0)},
}


@pytest.mark.parametrize("name", GOOD)
def test_good_traces_are_not_accused(tmp_path: Path, name: str) -> None:
    angles, samples, keys = GOOD[name]
    cycle = "two-stroke" if np.ptp(angles) < 361 else "four-stroke"
    assert notes_of(machine_text(written(tmp_path, angles, samples), keys, cycle=cycle)) == []


def test_burnt_gas_may_expand_with_a_smaller_exponent(tmp_path: Path) -> None:
    """1.38 and 1.26, as of air and of burnt gas without any loss of heat: no dead centre is off."""
    engine = ENGINE._replace(exponent=1.38)
    phi = np.remainder(FINE + 360, 720) - 360
    volume = fraction(phi) + engine.clearance
    at_60 = float(fraction(60.0)) + engine.clearance
    expands = (phi > 60) & (phi < 150)
    pressures = absolute(engine, FINE) * np.where(expands, (volume / at_60) ** 0.12, 1.0)
    assert notes_of(machine_text(written(tmp_path, FINE, pressures), RATIO)) == []


@pytest.mark.parametrize("count", [2, 3, 4, 6])
def test_few_cycles_that_scatter_do_not_differ_in_pairs(count: int) -> None:
    """Peaks that scatter by 11 %, as of 20 % in the heat, in ten draws each."""
    chamber = Setting(SliderCrank(0.05, 0.2), 720.0, True, AMBIENT * 1e5, True)
    for seed in range(10):
        angles, laps = cycles(ENGINE, count, 1.0, noise=0.1, spread=0.2, seed=seed)
        angles = np.append(angles, 720.0)
        closed = np.concatenate((laps, laps[:, :1]), axis=1) * 1e5
        trace = Trace(angles, closed, clearance=1 / 14, completed=True)
        assert doubts(trace, chamber, closed) == []


def obeyed(note: str, keys: str, pressures: str, cycle: str) -> tuple[str, str, str]:
    """The keys, `pressures` and cycle after doing what the note says first."""
    key, value = re.findall(r"'([a-z_]+): ([^'…]+)'", note)[0]
    if key == "pressures":
        return keys, value, cycle
    return (
        (keys, pressures, value)
        if key == "cycle"
        else (f"{keys}, {key}: {value}", pressures, cycle)
    )


def wrong(
    samples: Any, said: str, keys: str = "", pressures: str = "absolute", angles: Any = FINE
) -> tuple[Any, Any, str, str, str]:
    return angles, samples, keys, pressures, said


HALVES, SUNK = np.arange(0.0, 720.0, 0.5), late(0) - AMBIENT
UNIT = "times too small? correct 'unit' (unit: bar fits)"
CLEARED = ", clearance: 1/14"
WRONG = {
    "90 deg late": wrong(late(90), "the peak is 103.6 deg after the firing dead centre"),
    "180 deg late": wrong(late(180), "in the gas exchange: write 'angle_zero: 180 deg'"),
    "one turn late": wrong(late(360), "write 'angle_zero: 360 deg'; p_i stays"),
    "by no quarter": wrong(late(61.2), "the peak is 74.8 deg after the firing dead centre"),
    "gauge as absolute": wrong(SUNK, "these look like gauge pressures"),
    "absolute as gauge": wrong(late(0), "about the ambient: absolute?", pressures="gauge"),
    "ten times": wrong(late(0) * 10, "pressures 10 times too large? correct 'unit', or write"),
    "hundred times": wrong(late(0) * 100, "100 times too large", CLEARED),
    "a tenth": wrong(late(0) / 10, "10 times too small"),
    "a tenth, pegged": wrong(late(0) / 10, "10 times too small", ", pegging: ambient"),
    "no engine in any unit": wrong(
        late(0) * 10 + 600, "where cylinders peak at 1 to 300 bar: pressures"
    ),
    "a tenth, gauge": wrong(SUNK / 10, "10 times too small", pressures="gauge"),
    "backward": wrong(absolute(ENGINE, -FINE), "does its angle count against the rotation?"),
    "on its head": wrong(-SUNK, "is it inverted? write 'scale: -1'", pressures="gauge"),
    "no level": wrong(late(0) - 7.3, "the perfect vacuum being at 0 bar; write 'pegging: ambient'"),
    "drift": wrong(late(0) + 3 * FINE / 720, "the pressure jumps by -2.9"),
    "drift of 1 bar": wrong(late(360) + FINE / 720, "the pressure jumps by -1", angles=FINE - 360),
    "drift in noise": wrong(
        cycles(ENGINE, 1, 0.4, noise=0.1)[1][0] + FINE / 240, "does the sensor drift?", CLEARED
    ),
    "half degrees on whole ones": wrong(
        absolute(ENGINE, HALVES),
        "samples have the angle of the one before: rounded angles? write 'angle_step: 0.5 deg'",
        angles=np.floor(HALVES),
    ),
    "dead centre": wrong(late(-6), "its compression goes by p V^1.", CLEARED),
    "level": wrong(late(0) - 0.5, "its compression goes by p V^1.5", CLEARED),
    "marks of one turn as degrees": wrong(
        cycles(ENGINE, 4, 0.5, noise=0.05)[1].ravel(),
        "does the angle number the samples of one turn? write 'angle_step: 0.5 deg'",
        angles=np.tile(np.arange(720), 8),
    ),
    "closing sample": wrong(
        np.append(late(0), late(0)[0] + 3),
        "where the cycle closes: does the sensor drift? write 'drift: linear', or leave the closing sample out",
        angles=np.append(FINE, 720.0),
    ),
    "pegged at its peak": wrong(
        late(0),
        "the perfect vacuum being at 0 bar; correct 'pegging'; p_i stays",
        ", pegging: {angle: 10 deg, pressure: 0.95 bar}",
    ),
    **{
        f"{unit} meant as bar, absolute": wrong(late(0), UNIT, f"{RATIO}, unit: {unit}")
        for unit in ("Pa", "psi")
    },
    **{
        f"{unit} meant as bar, gauge": wrong(SUNK, UNIT, f"{RATIO}, unit: {unit}", "gauge")
        for unit in ("Pa", "psi")
    },
}
NO_KEY = "level", "closing sample", "pegged at its peak", "no engine in any unit"
"""Faults whose way out is no key with a value that the note could name."""
SEEN = [
    *(
        "90 deg late",
        "one turn late",
        "gauge as absolute",
        "ten times",
        "a tenth, gauge",
        "backward",
        "on its head",
    ),
    *(
        "no level",
        "drift in noise",
        "half degrees on whole ones",
        "dead centre",
        "marks of one turn as degrees",
    ),
    *(
        "closing sample",
        "pegged at its peak",
        "Pa meant as bar, gauge",
        "psi meant as bar, absolute",
    ),
    *("a tenth, pegged", "no engine in any unit"),
]


@pytest.mark.parametrize("name", few(WRONG, SEEN))
def test_what_is_wrong_is_seen_and_its_way_out_is_one(tmp_path: Path, name: str) -> None:
    angles, samples, keys, pressures, said = WRONG[name]
    file = written(tmp_path, angles, samples)
    (note,) = notes_of(machine_text(file, keys, pressures))
    assert said in note
    assert "p_i" in note
    if name in NO_KEY:
        return
    keys, pressures, cycle = obeyed(note, keys, pressures, "four-stroke")
    assert notes_of(machine_text(file, keys, pressures, cycle)) == []


@pytest.mark.parametrize(
    "samples", [late(90), late(0) * 10, absolute(ENGINE, -FINE)], ids=["late", "unit", "backward"]
)
def test_what_it_would_change_is_the_true_figure(tmp_path: Path, samples: Any) -> None:
    """p_i as found and as it is, against the trapezoid rule by hand."""
    true, result = indicated(FINE, late(0)), indicated(FINE, samples)
    (note,) = notes_of(machine_text(written(tmp_path, FINE, samples)))
    assert f"p_i is then {true:.4g} bar instead of {result:.4g} bar" in note


@pytest.mark.parametrize("off", [-5.0, -2.0, 0.5, 2.0, 5.0])
def test_motored_traces_are_known_by_their_shape(tmp_path: Path, off: float) -> None:
    """Too late, a motored trace does positive work; its two sides are alike all the same."""
    (note,) = notes_of(machine_text(written(tmp_path, *motored(off)), cycle="two-stroke"))
    side = f"{abs(off):.2g} deg {'after' if off > 0 else 'before'} the dead centre"
    assert (
        f"no combustion shows, and the peak is {side}; that of a motored engine is at it or just before"
        in note
    )


def test_four_strokes_reported_as_two(tmp_path: Path) -> None:
    """The angle begins anew in every turn and 'cycle: four-stroke' is forgotten: the turns differ in pairs."""
    _, each = cycles(ENGINE, 3, 0.5, noise=0.05)
    file = written(tmp_path, np.tile(np.arange(0.0, 360.0, 0.5), 6), each.ravel())
    (note,) = notes_of(machine_text(file, cycle="two-stroke"))
    assert "its turns differ in pairs" in note
    assert notes_of(machine_text(file, cycle=obeyed(note, "", "", "")[2])) == []


def test_cycles_known_by_a_wrong_speed(tmp_path: Path) -> None:
    """At 1500 rpm, given as 1515: the pressure shows the speed; with that nothing is left to say."""
    _, each = cycles(ENGINE, 12, 0.5, noise=0.05)
    file = written(tmp_path, np.arange(12 * 1440) * 0.5 / 9000, each.ravel())
    keys = ", angle_unit: s, recorded_speed: {:.7g} rpm"
    (note,) = [
        one for one in notes_of(machine_text(file, keys.format(1515))) if "left out" not in one
    ]
    assert "1.00% higher" in note
    speed = float(re.findall(r"'recorded_speed: ([0-9.]+) rpm'", note)[0])
    assert speed == pytest.approx(1500, rel=1e-5)
    assert notes_of(machine_text(file, keys.format(speed))) == []


def test_the_brake_of_an_engine_of_four(tmp_path: Path) -> None:
    """One cylinder is given: a note says so, and asks for the others; with four of them all is well."""
    power = 0.8 * 4 * indicated(FINE, late(0)) * 1e5 * np.pi / 4 * 0.09**2 * 0.1 * 25 / 2
    file = written(tmp_path, FINE, late(0))
    brake = f"brake_power: {power / 1e3:.5g} kW\n"
    (note,) = notes_of(brake + machine_text(file))
    assert "is below the brake power" in note
    assert "'cylinders: {count: 4, each: …}'" in note
    head, body = machine_text(file).split("stroke: 100 mm")
    each = "  " + f"stroke: 100 mm{body}".replace("\n", "\n    ")
    four = f"{brake}{head}cylinders:\n  count: 4\n  firing_order: 1-3-4-2\n  each:\n  {each}"
    assert notes_of(four) == []
    (note,) = notes_of(
        "brake_power: 500 kW\n"
        + machine_text(written(tmp_path, *motored(-0.5)), cycle="two-stroke")
    )
    assert "far below what the driven shaft takes, 500 kW" in note


def drawn_trace(random: np.random.Generator) -> tuple[Trace, Setting]:
    """Any trace in any chamber: few samples or many, even or not, of noise, pulses, nothing or an engine."""
    cycle, count = float(random.choice([360, 720])), int(random.choice([3, 4, 8, 37, 400]))
    inside = (
        np.sort(random.uniform(0, cycle, count))
        if random.random() < 0.5
        else np.arange(1, count + 1) * 1.0
    )
    angles = np.concatenate(
        ([0.0], inside * (1 if random.random() < 0.5 else cycle / (inside[-1] + 1)), [cycle])
    )
    angles = np.sort(np.clip(angles, 0, cycle))
    shapes = [
        0 * angles,
        random.standard_normal(len(angles)),
        absolute(ENGINE, angles),
        1.0 * (angles > cycle / 2),
    ]
    pressures = shapes[random.integers(len(shapes))] * 10 ** random.uniform(-8, 14)
    laps = pressures * (1 + 0.1 * random.standard_normal((int(random.integers(1, 5)), 1)))
    clearance = random.choice([None, 0.07, 1e-6, 1e6])
    trace = Trace(
        angles, laps, clearance=clearance, completed=bool(random.random() < 0.5), unit=1e5
    )
    ambient, gauge = random.choice([0.0, 101325.0]), bool(random.random() < 0.5)
    return trace, Setting(
        SliderCrank(0.05, 0.2), cycle, bool(random.random() < 0.5), float(ambient), not gauge
    )


def test_no_trace_stops_a_check() -> None:
    """Every check ends with a sentence or none, and what numpy warns of is a fault."""
    random = np.random.default_rng(11)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for _ in range(400):
            drawn = drawn_trace(random)
            reading = TraceReading(*drawn, corrected(*drawn))
            for check in CHECKS:
                doubt = check.judge(reading)
                assert doubt is None or isinstance(doubt.text, str)


# what is judged wrongly, or not at all

SUPERCHARGED = ENGINE._replace(exponent=1.38, inlet=1.5, outlet=1.6)
MISPLACED = [(ENGINE, 2.0), (ENGINE, -3.5), (SUPERCHARGED, -2.0)]


@pytest.mark.parametrize(("engine", "degrees"), MISPLACED)
def test_a_dead_centre_two_degrees_off_is_seen_by_both_exponents(
    tmp_path: Path, engine: Engine, degrees: float
) -> None:
    """The gas of this engine has one exponent: late, n_c falls and n_d rises, early the other way, by 0.02 a degree.

    The dead centre is found within 1 deg, the loss angle that no pressure alone can tell.
    """
    true = indicated(FINE, absolute(engine, FINE))
    error = abs(indicated(FINE, absolute(engine, FINE - degrees)) / true - 1)
    assert error == pytest.approx(0.07 * abs(degrees), abs=0.01)
    notes = notes_of(
        machine_text(
            written(tmp_path, FINE, absolute(engine, FINE - degrees)), ", compression_ratio: 15"
        )
    )
    assert len(notes) == 1
    assert "gauge" not in notes[0]
    keys, _, _ = obeyed(notes[0], "", "absolute", "four-stroke")
    assert "angle_zero" in keys
    assert float(re.findall(r"-?[0-9.]+", keys)[0]) == pytest.approx(degrees, abs=1.0)


@pytest.mark.parametrize("zero", [-4.0, 4.0])
def test_samples_far_apart_show_the_dead_centre_to_half_a_step(tmp_path: Path, zero: float) -> None:
    """4° off is nothing that samples 10° apart could show; samples 0.4° apart do."""
    keys = f", compression_ratio: 15, angle_zero: {zero:g} deg"
    angles = np.arange(0.0, 720.0, 10.0)
    coarse = written(tmp_path, angles, absolute(ENGINE, angles))
    assert notes_of(machine_text(coarse, keys)) == []
    (note,) = notes_of(machine_text(written(tmp_path, FINE, absolute(ENGINE, FINE)), keys))
    assert re.search(r"a dead centre [0-9.]+ ± [0-9.]+ deg off does that", note)


def test_a_coarse_trace_against_the_rotation(tmp_path: Path) -> None:
    """Samples 10° apart, the peak one of them before the dead centre, and a fired engine that takes work."""
    angles = np.arange(0.0, 720.0, 10.0)
    file = written(tmp_path, angles, absolute(ENGINE, -angles))
    for keys in ("", ", compression_ratio: 15"):
        assert "'angle_sense: against'" in notes_of(machine_text(file, keys))[0]


def test_cycles_that_wander_have_no_scatter_of_p_i(tmp_path: Path) -> None:
    """Fifteen equal cycles, each 1° later than the one before: what p_i scatters by is the encoder's."""
    angles = np.arange(0.0, 720.0, 1.0)
    columns = np.stack([absolute(ENGINE, angles - number) for number in range(15)])
    text = machine_text(written(tmp_path, angles, columns.T), ", pressure_columns: 2-16")
    case = Case(loads(text))
    assert any("the cycles wander 14 deg later" in note.text for note in machine_notes(case))
    forces = case.cylinders[0]
    assert forces["cycles_measured"].value == 15
    key_values = forces.rows.key_values
    for id in ("mean_pressure_cov", "mean_pressure_std", "cycle_worst"):
        assert key_values[id].of(forces) is None
    reasons = [left_out.why for left_out in forces_left_out(case.machine, forces)]
    assert "the measured cycles wander against each other" in reasons
