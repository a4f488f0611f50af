"""Recorded turning efforts: several cycles in one file, each at angles of its own, and level lines of a diagram."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from kurbel.errors import MachineFileError
from kurbel.machine_file import loads
from kurbel.notes.warnings import machine_notes
from kurbel.solver.case import Case


def torque(degrees: Any) -> Any:
    """A torque in N m that repeats after three turns."""
    phi = np.radians(degrees)
    return 100 + 50 * np.sin(phi / 3) + 20 * np.cos(2 * phi)


def swing_of(degrees: Any, torques: Any) -> float:
    """The largest less the smallest of the running work of straight lines, less their mean, by hand."""
    phi = np.radians(degrees)
    steps = np.diff(phi)
    excess = torques - (steps * (torques[1:] + torques[:-1]) / 2).sum() / (phi[-1] - phi[0])
    work = np.append(0.0, np.cumsum(steps * (excess[1:] + excess[:-1]) / 2))
    # within a line that crosses the mean the work is extreme where it does
    crosses = np.flatnonzero(excess[1:] * excess[:-1] < 0)
    share = excess[crosses] / (excess[crosses] - excess[crosses + 1])
    at_crossings = work[crosses] + steps[crosses] * share * excess[crosses] / 2
    return float(np.ptp(np.concatenate((work, at_crossings))))


def machine_text(folder: Path, degrees: Any, torques: Any, keys: str = "cycle_turns: 3") -> str:
    rows = "".join(f"{a:.10g},{m:.12g}\n" for a, m in zip(degrees, torques))
    (folder / "e.csv").write_text(rows)
    return f"speed: 400 rpm\n{keys}\neffort: {{unit: N m, file: '{folder / 'e.csv'}'}}\n"


NINE_TURNS = np.arange(0.0, 3240.0)
ONE_CYCLE = np.arange(0.0, 1081.0)
TRUE_SWING = swing_of(ONE_CYCLE, torque(ONE_CYCLE))


@pytest.mark.parametrize("restarts", [360.0, 1080.0, 3240.0])
def test_three_cycles_of_three_turns(tmp_path: Path, restarts: float) -> None:
    """Angles that begin anew with every turn, with every cycle, or never."""
    case = Case(loads(machine_text(tmp_path, NINE_TURNS % restarts, torque(NINE_TURNS))))
    assert case.flywheel.M_mean == pytest.approx(100, rel=1e-9)
    assert case.flywheel.dE == pytest.approx(TRUE_SWING, rel=1e-9)
    notes = [note.text for note in machine_notes(case)]
    assert any("the mean of 3 cycles of 1080 deg counts" in note for note in notes)


@pytest.mark.parametrize("restarts", [1080.0, 3240.0])
def test_cycles_at_angles_of_their_own(tmp_path: Path, restarts: float) -> None:
    """Rows every 1.7°, of which no turn is a multiple: laid over one cycle their swing is that of a fine diagram."""
    degrees = np.arange(0.0, 3239.5, 1.7)
    flywheel = Case(loads(machine_text(tmp_path, degrees % restarts, torque(degrees)))).flywheel
    fine = np.arange(0.0, 1080.001, 0.01)
    assert flywheel.dE == pytest.approx(swing_of(fine, torque(fine)), rel=5e-4)
    assert flywheel.M_mean == pytest.approx(100, rel=1e-5)


def test_one_cycle_in_turns(tmp_path: Path) -> None:
    degrees = np.arange(0.0, 1080.0)
    flywheel = Case(loads(machine_text(tmp_path, degrees % 360, torque(degrees)))).flywheel
    assert flywheel.dE == pytest.approx(TRUE_SWING, rel=1e-9)


def test_the_dead_centre_of_several_cycles(tmp_path: Path) -> None:
    """Angles that count from 100° before it: the torque at 0° is that at 100° of the file."""
    text = machine_text(tmp_path, NINE_TURNS, torque(NINE_TURNS - 100))
    text = text.replace("}\n", ", angle_zero: 100 deg}\n")
    flywheel = Case(loads(text)).flywheel
    read = np.asarray(flywheel.at(np.array([0.0, 90.0, 700.0])).M)
    assert read == pytest.approx(torque(np.array([0.0, 90.0, 700.0])), rel=1e-9)


def test_an_engine_that_fires_once_in_four_cycles(tmp_path: Path) -> None:
    """No rows where the torque is 0: a level line, as in `points`."""
    fired = np.arange(0.0, 721.0)
    torques = 600 * np.sin(np.radians(fired / 2)) ** 2 * np.exp(-fired / 90)
    torques[-1] = 0.0
    degrees = np.append(fired, [2880.0])
    torques = np.append(torques, 0.0)
    case = Case(loads(machine_text(tmp_path, degrees, torques, "cycle_turns: 8")))
    assert case.flywheel.dE == pytest.approx(swing_of(degrees, torques), rel=1e-10)
    notes = [note.text for note in machine_notes(case)]
    assert any("no samples from 720 to 2880 deg; a straight line" in note for note in notes)


@pytest.mark.parametrize(
    ("turns", "half", "keys", "message"),
    [
        (4, 60.0, "", "differ in pairs; write 'cycle: four-stroke' at the top"),
        (2, 600.0, "", "the 2 cycles of 360 deg in it are not alike; write 'cycle: four-stroke'"),
        (3, 60.0, "cycle_turns: 8", "has 3 laps of 360 deg, the cycle 2880 deg; write"),
    ],
)
def test_laps_that_are_no_cycles(
    tmp_path: Path, turns: int, half: float, keys: str, message: str
) -> None:
    """Turns of a four-stroke cycle without its key, and fewer turns than the cycle has."""
    degrees = np.arange(0.0, 360.0 * turns)
    phi = np.radians(degrees)
    torques = 300 + 400 * np.cos(phi) + half * np.sin(phi / 2)
    with pytest.raises(MachineFileError, match=message):
        loads(machine_text(tmp_path, degrees % 360, torques, keys))


def test_a_cycle_that_counts_on_is_not_cut_in_halves(tmp_path: Path) -> None:
    degrees = np.arange(0.0, 720.0)
    with pytest.raises(MachineFileError, match=r"runs to 720 deg.*write 'cycle: four-stroke'"):
        loads(machine_text(tmp_path, degrees, torque(degrees), ""))


def test_a_hole_is_no_level_line(tmp_path: Path) -> None:
    degrees = np.append(np.arange(0.0, 300.0), np.arange(400.0, 1080.0))
    with pytest.raises(MachineFileError, match="no samples from 299 to 400 deg"):
        loads(machine_text(tmp_path, degrees, torque(degrees)))


def test_a_turn_without_another_is_noted(tmp_path: Path) -> None:
    """Of three turns a four-stroke cycle is the first two: their mean, and a note on the third."""
    degrees = np.arange(0.0, 1080.0)
    torques = 100 + 10 * (degrees // 360) + np.sin(np.radians(2 * degrees))
    case = Case(loads(machine_text(tmp_path, degrees % 360, torques, "cycle: four-stroke")))
    assert case.flywheel.M_mean == pytest.approx(105, rel=1e-4)
    assert any("the last turn is left out" in note.text for note in machine_notes(case))
