"""Recordings of many turns or cycles, one below the other, cut into laps that lie over one another."""

import numpy as np

from kurbel.arrays import Array
from kurbel.machine_file.recording import Recording, refuse_large_holes, usual_step
from kurbel.traces.correct import PERIODS

_ALIKE = 1e-3
"""Of a step: what the angles of two laps may differ by and still be the same, rounded."""


_LEAST_ALIKE = 0.2
"""Likeness below which laps are none, even where a wrong speed lets them wander."""
_REST = 0.05
"""Share of a lap from which on what follows the last whole one is told."""


def lapped(recording: Recording) -> tuple[Recording, tuple[str, ...]]:
    """Return a recording of one lap as it is, of several with all laps over the angles of the first; and what to say.

    A lap is as long as the angle counts before it begins anew; of an angle that counts on and on, one turn, of which
    two make a four-stroke cycle. What follows the last whole lap is left out. Raises RuleError for laps with holes.
    """
    lap = _lap_of(recording.angles)
    if not lap:
        _refuse_other_turns(recording)
        return recording, ()
    unwrapped = _unwrapped(recording, lap)
    angles = unwrapped.angles
    step = usual_step(angles)
    laps = int((angles[-1] - angles[0] + 1.5 * min(step, lap / 20)) // lap)
    bounds = np.searchsorted(angles, angles[0] + lap * np.arange(laps + 1) - min(1e-6 * lap, step / 2))
    if laps < 2 or (np.diff(bounds) < 2).any():
        return unwrapped, ()
    refuse_large_holes(unwrapped)
    left = len(angles) - int(bounds[-1])
    told = (f"the {left} samples after lap {laps} of {lap:g} deg are left out",) if left > _REST * bounds[1] else ()
    found = _laid_over(unwrapped, bounds.tolist(), lap)
    if not (np.diff(recording.angles) < 0).any():
        _refuse_unlike(found, len(angles))
    return found, told


def _refuse_unlike(laps: Recording, samples: int) -> None:
    """Raise RuleError for turns of an angle that counts on which are no turns of an engine: it may count samples."""
    if len(laps.values) > 2 and _likeness(laps.values) < _LEAST_ALIKE:
        whole = PERIODS[-1]
        message = (
            f"the angle counts on over {len(laps.values)} turns that are not alike; if it numbers samples, write how "
            f"far apart they are, such as 'angle_step: {whole / samples:.4g} deg' for one cycle of {whole:g} deg"
        )
        laps.refuse(0, message)


def _likeness(laps: Array) -> float:
    """Return how alike every lap and the next but one are: 1 for the same again, about 0 for others."""
    swing = laps - laps.mean()
    whole = float((swing**2).mean())
    return float((swing[2:] * swing[:-2]).mean()) / whole if whole else 1.0


def _refuse_other_turns(recording: Recording) -> None:
    """Raise RuleError for an angle that begins anew after more than two turns."""
    back = np.flatnonzero(np.diff(recording.angles) < 0)
    if len(back):
        span = float(np.ptp(recording.angles))
        message = (
            f"the angle begins anew after {span:.10g} deg; a turn has 360, a four-stroke cycle 720 deg: other units?"
            f"{' Or is the first row a heading? Then skip it' if back[0] == 0 else ''}"
        )
        recording.refuse(int(back[0]) + 1, message)


def _lap_of(angles: Array) -> float:
    """Return after how many degrees the angle of a recording begins anew, 0 where it holds one cycle only."""
    if (np.diff(angles) < 0).any():
        span = float(angles.max() - angles.min())
        return next((period for period in PERIODS if span <= period * (1 + 1e-9)), 0.0)
    return PERIODS[0] if angles[-1] - angles[0] > PERIODS[-1] * (1 + 1e-9) else 0.0


def _unwrapped(recording: Recording, lap: float) -> Recording:
    """Return the recording with angles that count on; a closing sample gives way to the first of the next lap."""
    steps = np.diff(recording.angles)
    counted = recording.angles + lap * np.concatenate(([0], np.cumsum(steps < 0)))
    closing = np.append((steps < 0) & (np.diff(counted) <= 1e-9 * lap), False)
    return recording._replace(angles=counted).taken(~closing)


def _laid_over(recording: Recording, bounds: list[int], lap: float) -> Recording:
    """Return all laps over the angles of the first, straight between samples where they have not the same."""
    angles, values, *_ = recording
    lap_1, laps = recording.taken(slice(bounds[1])), len(bounds) - 1
    first, count = lap_1.angles, bounds[1]
    offsets = lap * np.arange(laps)
    if bounds == [count * number for number in range(laps + 1)]:
        each = angles[: bounds[-1]].reshape(laps, count) - offsets[:, np.newaxis]
        if np.abs(each - first).max() <= _ALIKE * lap / count:
            return lap_1._replace(values=values[:, : bounds[-1]].reshape(-1, count))
    wanted = (first + offsets[:, np.newaxis]).ravel()
    found = [np.interp(wanted, angles, column).reshape(laps, count) for column in values]
    return lap_1._replace(values=np.concatenate(found))
