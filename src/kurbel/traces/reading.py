"""A measured trace as checks see it: levels, peak, flanks and lines, and what kind of machine it comes from."""

import math
from dataclasses import replace
from functools import cached_property

import numpy as np

from kurbel.arrays import Array
from kurbel.declared.unit_systems import requested_system, show
from kurbel.mechanisms.setting import Setting
from kurbel.numerics.arithmetic import unless_cancelled
from kurbel.traces.correct import (
    COMPRESSION,
    EXPANSION,
    Exponent,
    Trace,
    exponent,
    noise_of,
    parabola_peak,
    polytrope,
    sides_of,
    work_weights,
)
from kurbel.traces.lines import (
    COMPRESSOR_GAS,
    FIRED_GAS,
    MOTORED_GAS,
    Chamber,
    Flank,
    Gas,
    Lines,
    flanks_of,
    goes_by_one_line,
)
from kurbel.traces.period import Clock

FIRED = "fired engine"
MOTORED = "motored engine"
COMPRESSOR = "compressor"
PUMP = "pump"
STEAM = "steam engine"
UNKNOWN = "unknown"
ENGINES = frozenset((FIRED, MOTORED))
EVERY = frozenset((FIRED, MOTORED, COMPRESSOR, PUMP, STEAM, UNKNOWN))
ROLES = {"engine": FIRED, "compressor": COMPRESSOR, "pump": PUMP, "steam": STEAM}
"""Word of the machine file -> kind; an engine is fired or motored as its pressure shows."""

_LOW = 0.15
"""Share of the cycle that is below the low level, so that a few noisy samples do not define it."""
_PARABOLA = 6.0
"""Degrees on either side of the top sample through which a parabola goes."""
_ENGINE_RATIO = 8.0
"""Peak over low level, absolute, from which on something is compressed, or burns, in a small space."""
_FOUR_STROKE_RATIO = 3.0
"""The same where four strokes say that it is an engine."""
_NARROW = 90.0
"""Degrees for which the upper half of such a peak lasts at most; what lasts longer is an admission or a delivery."""
_ENGINE_RISE = 35.0
"""Degrees over which the compression of an engine raises the pressure at least; an admission is quicker."""
_ENGINE_FALL = 0.6, 3.0
"""Width of the fall over that of the rise, of an engine."""
_QUICK = 30.0
"""Degrees for which a rise and a fall of a pump last at most: a liquid is not compressed."""
_SLOWER = 1.4
"""Width of the slower flank over that of the other: a compressor rises slowly, a steam engine falls slowly."""
_MOTORED_RATIO = 0.6, 1.1
"""Pressure after the peak over that before, if nothing burns: what heat loss and leakage take, and noise."""
_MOTORED_RISE = 3.0
"""Least pressure of such a peak over that at its feet; what is flat has no peak."""
_FIRED_SCATTER = 0.03
"""Standard deviation over mean of the peaks of cycles, from which on something burns."""
_ABOUT_HALF_A_TURN = 170.0
"""Degrees from which on a dead centre is taken for the other one."""
_CANCELLED = 1e-13
"""Share of the terms of a sum below which the sum is only rounding error."""
_THIN = 2000
"""Samples of a cycle above which levels and lines are judged by means of several."""


def in_bar(pressure: float) -> str:
    """Write a pressure in Pa for a note, in bar unless another system of units is requested."""
    if requested_system() in ("", "metric"):
        return f"{pressure / 1e5 + 0.0:.4g} bar"
    return show(pressure, "pressure", figures=4)


class TraceReading:
    """A trace in its chamber: what checks judge it by, pressures in Pa, angles in degrees.

    each: pressures (m, n) of every cycle, corrected; p (n,): their mean; angles (n,): crank angles; after (n,): degrees
    after the chamber's own (firing) dead centre, within ± half a cycle; low: level below which the cycle lies for 15 %
    of it; peak: highest pressure; peak_at: degrees after the dead centre of the parabola through it; ratio: of the peak
    over the low level, absolute; kind: of the machine.
    """

    def __init__(
        self, trace: Trace, setting: Setting, each: Array, role: str | None = None
    ) -> None:
        self.trace = trace
        self.setting = setting
        self.each = each
        self.role = role
        self.p: Array = each.mean(axis=0)
        self.angles: Array = trace.angles + trace.shift(setting)
        self.after = trace.from_dead_centre(setting)
        self.step = trace.period / (len(self.p) - 1)

        # the low level, by the share of the cycle and not of the samples
        self.widths = np.convolve(np.diff(trace.angles), [1.0, 1.0]) / 2
        order = np.argsort(self.p)
        share = np.cumsum(self.widths[order]) / trace.period
        self.low = float(self.p[order[np.searchsorted(share, _LOW)]])

        # a single top sample may be noise; the closing one would count twice
        top = int(np.argmax(self.p))
        self.peak = float(self.p[top])
        self.top_at = float(self.after[top])
        self.vertex = parabola_peak(self.after[:-1], self.p[:-1], self.top_at, _PARABOLA)
        self.peak_at = self.vertex.place if self.vertex else self.top_at

        # of a trace that goes down to the vacuum, the ratio as over a good vacuum
        lowest = max(self.low + setting.lift, 0.2 * setting.ambient, 1.0)
        self.ratio = (self.peak + setting.lift) / lowest
        self.kind = self._kind()

    # what kind of machine

    def _kind(self) -> str:
        """Return the kind: by its role, its cycle, or the shape of its pressure, which no wrong angle changes."""
        kind = ROLES.get(self.role or "", UNKNOWN)
        if kind == UNKNOWN:
            kind = self._kind_by_shape()
        if kind in ENGINES:
            return MOTORED if self.motored else FIRED
        return kind

    def _kind_by_shape(self) -> str:
        """Return the kind of machine whose pressure rises and falls so."""
        if self.setting.cycle == 720:
            return FIRED
        if self.flanks is None:
            return FIRED if self.has_peak else UNKNOWN
        rise, fall = self.flanks
        ratio = fall.width / max(rise.width, self.step)
        rises_by_compression = rise.width >= _ENGINE_RISE
        falls_by_expansion = _ENGINE_FALL[0] <= ratio <= _ENGINE_FALL[1]
        if self.has_peak and rises_by_compression and falls_by_expansion:
            return FIRED
        if max(rise.width, fall.width) <= _QUICK:
            return PUMP
        if ratio > _SLOWER:
            return STEAM
        return COMPRESSOR if ratio < 1 / _SLOWER else UNKNOWN

    @cached_property
    def has_peak(self) -> bool:
        """Whether something is compressed, or burns, in a small space."""
        is_high = self.p > (self.peak + self.low) / 2
        is_narrow = float(self.widths[is_high].sum()) <= _NARROW
        least = _FOUR_STROKE_RATIO if self.setting.cycle == 720 else _ENGINE_RATIO
        return is_narrow and self.ratio > least

    @property
    def is_engine(self) -> bool:
        """Whether it is an engine, fired or motored, with a peak as such have it."""
        return self.kind in ENGINES and self.has_peak

    @cached_property
    def motored(self) -> bool:
        """Whether nothing burns: both sides of the peak are alike, and one line p V^n = const.

        The sign of the work does not show that: a motored trace that is too late does work. Where peaks scatter from
        cycle to cycle something burns.
        """
        trace = self.trace
        lift = self.setting.lift
        top = float(trace.angles[int(np.argmax(self.p))])
        before, after = sides_of(top, trace.angles, self.p + lift, trace.period)
        least, most = _MOTORED_RATIO
        are_alike = bool(((least * before <= after) & (after <= most * before)).all())
        is_high = self.peak + lift > _MOTORED_RISE * max(before[-1], after[-1])
        if not are_alike or not is_high:
            return False
        if len(self.each) > 2:
            peaks = self.each.max(axis=1) + lift
            if peaks.std(ddof=1) > _FIRED_SCATTER * peaks.mean():
                return False
        return goes_by_one_line(self.chamber, self.trace.clearance, self.peak_at)

    # its lines

    @cached_property
    def noise(self) -> float:
        """Standard deviation in Pa of the noise of a cycle."""
        return noise_of(self.p[:-1]) if self.trace.even else 0.0

    @cached_property
    def chamber(self) -> Chamber:
        """The trace as its lines are computed from it: not many more samples than they need."""
        after = self.after[:-1]
        absolute = self.p[:-1] + self.setting.lift
        noise = self.noise
        count = math.ceil(len(after) / _THIN)
        if count > 1:
            # means of so many samples, but not over the end of the cycle
            order = np.argsort(after)
            starts = np.arange(0, len(after), count)
            sizes = np.diff(np.append(starts, len(after)))
            after = np.add.reduceat(after[order], starts) / sizes
            absolute = np.add.reduceat(absolute[order], starts) / sizes
            noise /= math.sqrt(count)
        order = np.argsort(after)
        return Chamber(self.setting, after[order], absolute[order], None, noise)

    @cached_property
    def flanks(self) -> tuple[Flank, Flank] | None:
        """The only rise and fall of the pressure in a cycle, if it has no more."""
        return flanks_of(self.chamber.after, self.chamber.absolute, self.setting.cycle)

    @cached_property
    def worked(self) -> Chamber | None:
        """The chamber with lines where its kind has them: an engine, or a compressor between its valves."""
        if self.kind in ENGINES:
            return self.chamber
        if self.kind == COMPRESSOR and self.flanks:
            return self.chamber._replace(flanks=self.flanks)
        return None

    @property
    def gas(self) -> Gas:
        """The exponents that its gas may have."""
        gases = {FIRED: FIRED_GAS, MOTORED: MOTORED_GAS}
        return gases.get(self.kind, COMPRESSOR_GAS)

    @cached_property
    def lines(self) -> Lines | None:
        """Compression and expansion; None without a clearance, or where they cannot be found."""
        if self.worked is None or not self.trace.clearance:
            return None
        return self.worked.lines(self.trace.clearance)

    def stroke_lines(self) -> tuple[Exponent | None, Exponent | None]:
        """Return the exponents of compression and expansion of all its samples: of a compressor between its valves.

        None without a clearance, of an end that has no such lines, and of too few samples.
        """
        after = self.after
        absolute = self.p + self.setting.lift
        clearance = self.trace.clearance
        if self.kind in (PUMP, STEAM) or clearance is None:
            return None, None
        if self.kind != COMPRESSOR or self.flanks is None:
            compression = exponent(self.setting, clearance, after, absolute, COMPRESSION)
            expansion = exponent(self.setting, clearance, after, absolute, EXPANSION)
            return compression, expansion
        lines = []
        for flank in self.flanks:
            since = np.remainder(after - flank.begin, self.setting.cycle)
            inside = since <= flank.width
            lines.append(polytrope(self.setting, clearance, after[inside], absolute[inside]))
        compression, expansion = lines
        return compression, expansion

    # its work

    @cached_property
    def p_i(self) -> float:
        """∮ p dz in Pa, of the mean cycle."""
        terms = work_weights(self.setting, self.angles) * self.p
        return float(unless_cancelled(terms.sum(), np.abs(terms).sum(), _CANCELLED))

    # the trace with another key

    def put_later(self, degrees: float) -> "TraceReading":
        """Return it with the dead centre so many degrees later in the file."""
        trace = replace(self.trace, angle_zero=self.trace.angle_zero + degrees)
        return TraceReading(trace, self.setting, self.each, self.role)

    def turned(self) -> "TraceReading":
        """Return it with the angle counted in the other sense."""
        trace = replace(
            self.trace,
            angles=-self.trace.angles[::-1],
            samples=self.trace.samples[:, ::-1],
            angle_zero=-self.trace.angle_zero,
            against=not self.trace.against,
        )
        return TraceReading(trace, self.setting, self.each[:, ::-1], self.role)

    def with_reference(self) -> "TraceReading":
        """Return it with absolute pressures for gauge pressures, or the other way round."""
        setting = self.setting._replace(absolute=not self.setting.absolute)
        return TraceReading(self.trace, setting, self.each, self.role)

    def with_clearance(self, clearance: float) -> "TraceReading":
        """Return it with another clearance."""
        trace = replace(self.trace, clearance=clearance)
        return TraceReading(trace, self.setting, self.each, self.role)

    def with_clock(self, clock: Clock) -> "TraceReading":
        """Return it with another recorded speed."""
        trace = replace(self.trace, clock=clock)
        return TraceReading(trace, self.setting, self.each, self.role)

    def with_pressures(self, each: Array) -> "TraceReading":
        """Return it with other pressures (m, n)."""
        return TraceReading(self.trace, self.setting, each, self.role)

    def over(self, angles: Array, each: Array) -> "TraceReading":
        """Return it with other angles (k,) in degrees, as the trace counts them, and pressures (m, k)."""
        trace = replace(self.trace, angles=angles, samples=each)
        return TraceReading(trace, self.setting, each, self.role)

    def effect(self, cured: "TraceReading", error: float = 0.0, times: float = 1.0) -> str:
        """Return p_i of another reading, multiplied, with its uncertainty in Pa, and as it is."""
        now = in_bar(self.p_i)
        then = in_bar(times * cured.p_i)
        if now == then:
            return f"p_i stays {now}"
        if error >= 0.005 * abs(cured.p_i):
            then = f"{then.removesuffix(' bar')} ± {error / 1e5:.2g} bar"
        return f"p_i is then {then} instead of {now}"

    def dead_centre_later(self, degrees: float) -> str:
        """Return what to do so that the dead centre is so many degrees later: the key, or what to change in the file.

        Of rows over volumes or displacements no key moves the angles.
        """
        placed = self.trace.placed
        if placed is None:
            return f"write {self.zero_later(degrees)}"
        off = math.remainder(degrees, 360)
        if abs(off) < _ABOUT_HALF_A_TURN:
            side = "earlier" if off > 0 else "later"
            return f"put its pressures {abs(off):.3g} deg {side} against its {placed.kind}s in the file"
        if placed.kind == "volume":
            return "are its volumes those of the other end?"
        return "write its displacements with the other sign, growing from the inner dead centre"

    def zero_later(self, degrees: float) -> str:
        """Return the key that puts the dead centre so many degrees later."""
        zero = self.trace.as_written(self.trace.angle_zero + degrees)
        period = self.trace.period
        shown = round((zero + 180) % period - 180, 3)
        return f"'angle_zero: {shown:g} deg'"
