"""What a trace is freed from before it counts: drift over the cycle, and a level that the sensor does not know."""

import numpy as np

from kurbel.arrays import Array
from kurbel.machine.trace import Pegging, Trace
from kurbel.solver.pressure import Setting

_AROUND = 2.5
"""Degrees on either side of the pegging angle over which a cycle's level is the mean: one sample is noise."""
LAST = 2.0
"""Degrees at either end of the cycle through which lines go, as far as there are three samples in them."""


def corrected(trace: Trace, setting: Setting, shift: float) -> Array:
    """Return the pressures (m, n) in Pa of all cycles, without drift, and pegged; as the trace counts them.

    shift: crank angle at the angle 0 of the trace, in degrees.
    """
    samples = trace.samples
    if trace.level:
        share = (trace.angles - trace.angles[0]) / trace.period
        samples = samples + drift_of(trace, samples)[:, np.newaxis] * share
        if trace.completed:
            samples = np.concatenate((samples[:, :-1], samples[:, :1]), axis=1)
    return samples if trace.pegging is None else samples + _lift(trace, samples, trace.pegging, setting, shift)


def drift_of(trace: Trace, samples: Array) -> Array:
    """Return by how much Pa each cycle (m,) ends too low to go on as it has begun.

    Where the closing sample is missing, straight lines through the samples at both ends tell what it would have been.
    """
    if not trace.completed:
        return np.asarray(samples[:, 0] - samples[:, -1])
    angles, end = trace.angles, trace.angles[-1]
    last = max(3, int(np.searchsorted(-angles[:-1][::-1], LAST - end)))
    first = max(3, int(np.searchsorted(angles, angles[0] + LAST, side="right")))
    before = _line_at(angles[-1 - last : -1] - end, samples[:, -1 - last : -1])
    after = _line_at(angles[:first] - angles[0], samples[:, :first])
    return np.asarray(after - before)


def _line_at(angles: Array, samples: Array) -> Array:
    """Return the values (m,) at angle 0 of the lines of least squares through samples (m, k) at angles (k,)."""
    from_mean = angles - angles.mean()
    slopes = samples @ from_mean / (from_mean @ from_mean)
    return np.asarray(samples.mean(axis=1) - slopes * angles.mean())


def _lift(trace: Trace, samples: Array, pegging: Pegging, setting: Setting, shift: float) -> Array:
    """Return what is added (m, 1) in Pa to every cycle."""
    angle, pressure = _known(pegging, setting)
    away = np.remainder(trace.angles + shift - angle + trace.period / 2, trace.period) - trace.period / 2
    near = np.abs(away) <= max(_AROUND, float(np.abs(away).min()))
    return np.asarray(pressure - samples[:, near].mean(axis=1, keepdims=True))


def _known(pegging: Pegging, setting: Setting) -> tuple[float, float]:
    """Return the crank angle in degrees and the pressure in Pa there, as the trace counts it."""
    inner, outer = setting.mechanism.dead_centres()
    if pegging.angle is not None and pegging.pressure is not None:
        return inner + pegging.angle, pegging.pressure
    begin = (outer if setting.head_end else inner) + (360.0 if setting.cycle == 720 else 0.0)
    return begin, setting.ambient if setting.absolute else 0.0
