"""Checks of compression and expansion: a wrong dead centre, clearance or level makes them lines of no gas."""

import math
from typing import NamedTuple

import numpy as np

from kurbel.traces.checks.doubt import Doubt, sense_key
from kurbel.traces.correct import Exponent
from kurbel.traces.lines import Best, Chamber, best_log_clearance, least
from kurbel.traces.reading import COMPRESSOR, ENGINES, FIRED, MOTORED, TraceReading, in_bar

STRANGE = 8.0
"""Misfit from which on lines are not those of a gas; of good traces it is below 3."""


# the dead centre by both lines


def shift_by_lines(reading: TraceReading, most: float = 45.0) -> Best | None:
    """Return by how many degrees a trace must be later for its lines; None where it has no clearance or no lines."""
    chamber = reading.worked
    clearance = reading.trace.clearance
    if chamber is None or not clearance:
        return None

    def misfit(later: float) -> float:
        return chamber.misfit(reading.gas, clearance, later) + peak_misfit(reading, later)

    shift = least(misfit, np.arange(-most, most + 1.0, 3.0).tolist())
    return shift if shift.misfit <= STRANGE else None


_DEVIATIONS = 2.0
"""Standard deviations of a dead centre by both lines that are reported."""


def dead_centre_error(reading: TraceReading, shift: Best) -> float:
    """Return how many degrees a dead centre by both lines may be off: by what gases differ in, and by half a step."""
    return math.hypot(_DEVIATIONS * shift.error, reading.step / 2)


_FIRED_PEAK = -3.0, 25.0
_FIRED_SPREAD = 5.0
_MOTORED_PEAK = -1.5, 0.3
_MOTORED_SPREAD = 0.5
"""Degrees after the dead centre between which peaks are usual, and what they may be off beyond."""


def peak_misfit(reading: TraceReading, later: float) -> float:
    """Return the squared distance of the peak of an engine from where it usually is."""
    if not reading.is_engine:
        return 0.0
    first, last = _FIRED_PEAK
    spread = _FIRED_SPREAD
    if reading.kind == MOTORED:
        first, last = _MOTORED_PEAK
        spread = _MOTORED_SPREAD
    half = reading.setting.cycle / 2
    peak_at = math.remainder(reading.peak_at + later, 2 * half)
    beyond = max(first - peak_at, peak_at - last, 0.0)
    return (beyond / spread) ** 2


# both lines: the dead centre, the clearance and the level

_SENSIBLE = 1.2, 1.4
"""Exponents of a compression of air or mixture; less is wet or leaks, more than that of air cannot be."""
_SLACK = 0.02
_APART = 0.08
_APART_FIRED = 0.14
"""By which the exponent of the compression is below, or above, that of the expansion, in engines as they are: the loss
angle is worth 0.03, and burnt gas that loses no heat expands with 1.26 where air is compressed with 1.38."""
_BETTER = 6.0
"""By how much the misfit falls at least with what is to be written."""
_FREE = 1.0
_FREE_CLEARANCE = 3.0
"""What a dead centre and a clearance that are found cost, against a word that is wrong: the former are off by a little
more often."""
_AS_LIKELY = 3.0
"""Misfits that differ by less leave the choice."""
_LATEST = 45.0
"""Largest error of a dead centre in degrees that is found here."""


class Cure(NamedTuple):
    """What makes both lines those of a gas: the misfit then, the words, the trace then, and how far p_i is sure."""

    misfit: float
    text: str
    cured: TraceReading
    error: float = 0.0


def _is_sensible(line: Exponent | None) -> bool:
    """Return whether there is an exponent, and one that the compression of an engine can have."""
    if line is None:
        return False
    slack = _SLACK + 2 * line.error
    return _SENSIBLE[0] - slack <= line.value <= _SENSIBLE[1] + slack


class Looks(NamedTuple):
    """How both lines look: their misfit, whether that is strange, they are parted too far, and their exponents usual."""

    misfit: float
    is_strange: bool
    are_parted: bool
    is_sensible: bool

    @property
    def are_of_gas(self) -> bool:
        """Whether nothing is wrong with them."""
        return not self.is_strange and not self.are_parted and self.is_sensible


def _looks_of(
    reading: TraceReading, chamber: Chamber, clearance: float, later: float
) -> Looks | None:
    """Return how both lines would look if the trace were so many degrees later; None without them."""
    lines = chamber.lines(clearance, later)
    if lines is None:
        return None
    misfit = chamber.misfit(reading.gas, clearance, later) + peak_misfit(reading, later)
    error = 2 * math.hypot(lines.compression.error, lines.expansion.error)
    most = _APART_FIRED if reading.kind == FIRED else _APART
    is_beyond = not -_APART - error <= lines.difference <= most + error
    return Looks(
        misfit=misfit,
        is_strange=misfit > STRANGE,
        are_parted=reading.kind in ENGINES and is_beyond,
        is_sensible=reading.kind == COMPRESSOR or _is_sensible(lines.compression),
    )


def lines_of_no_gas(reading: TraceReading) -> Doubt | None:
    """Judge both lines: a dead centre, a clearance or a level that is wrong makes them none of a gas.

    A dead centre that is off moves their exponents apart, a clearance moves both the same way, and a wrong level that
    of the compression most.
    """
    lines = reading.lines
    clearance = reading.trace.clearance
    chamber = reading.worked
    if lines is None or chamber is None or not clearance:
        return _no_line(reading)
    if reading.kind in ENGINES and not reading.is_engine:
        return None
    looks = _looks_of(reading, chamber, clearance, 0.0)
    if looks is None or looks.are_of_gas:
        return None
    # samples so far apart show the dead centre to half a step at best
    for later in (-reading.step / 2, reading.step / 2):
        moved_looks = _looks_of(reading, chamber, clearance, later)
        if moved_looks is not None and moved_looks.are_of_gas:
            return None

    misfit = looks.misfit
    is_strange = looks.is_strange
    are_parted = looks.are_parted
    is_sensible = looks.is_sensible
    seen = (
        f"its compression goes by p V^{lines.compression.value:.3g} and its expansion by "
        f"p V^{lines.expansion.value:.3g}"
    )
    if not are_parted and not is_sensible:
        seen = (
            f"its compression goes by p V^{lines.compression.value:.3g}, where air has 1.2 to 1.4"
        )

    # the cure that leaves the least misfit, and others that are as likely
    cures = sorted(_cures_of_lines(reading), key=lambda cure: cure.misfit)
    best = cures[0] if cures else None
    needs_cure = are_parted or not is_sensible
    least_gain = _FREE if needs_cure else _BETTER
    if best is None or misfit - best.misfit < least_gain or best.misfit > STRANGE:
        if not is_strange and is_sensible:
            return None
        by_shape = reading.kind == COMPRESSOR and reading.role is None
        else_kind = ", or write what the machine is ('role')" if by_shape else ""
        return Doubt(
            f"{seen}: correct the level ('pegging', 'offset'; p_i stays), "
            f"or the clearance{else_kind}"
        )
    others = [cure.text for cure in cures[1:] if cure.misfit - best.misfit < _AS_LIKELY]
    also = "".join(f"; or {text}" for text in others)
    effect = reading.effect(best.cured, best.error)
    # where the choice is left, nothing is judged with one of them
    cured = None if others else best.cured
    return Doubt(f"{seen}: {best.text}; {effect}{also}", cured)


def _no_line(reading: TraceReading) -> Doubt | None:
    """Where absolute pressures are none at all on the compression, gauge pressures may be meant."""
    chamber = reading.worked
    clearance = reading.trace.clearance
    if chamber is None or not clearance or not reading.is_engine or not reading.setting.absolute:
        return None
    ambient = reading.setting.ambient
    if chamber.misfit(reading.gas, clearance, raised=ambient) > STRANGE:
        return None
    return Doubt(
        "its compression is not above the vacuum: these look like gauge pressures; write "
        f"'pressures: gauge'; p_i stays, P changes by {in_bar(ambient)} times the area",
        reading.with_reference(),
    )


_LEVEL_SPREAD = 0.7
"""Standard deviation of the logarithm of the low level of an engine over the ambient: throttled or supercharged."""


def _level_misfit(low: float, ambient: float) -> float:
    """Return the squared distance of the low level of an engine, absolute, from the ambient."""
    if ambient <= 0:
        return 0.0
    share = max(low / ambient, 1e-3)
    return (math.log(share) / _LEVEL_SPREAD) ** 2


def _cures_of_lines(reading: TraceReading) -> list[Cure]:
    """Return what would make both lines those of a gas: each fault alone."""
    chamber = reading.worked
    clearance = reading.trace.clearance
    if chamber is None or not clearance:
        return []
    cures = [
        _with_reference(reading, chamber, clearance),
        _with_other_sense(reading, clearance),
        _with_dead_centre(reading),
        _with_clearance(reading, chamber, clearance),
    ]
    return [cure for cure in cures if cure]


def _misfit_about(
    reading: TraceReading, chamber: Chamber, clearance: float, raised: float = 0.0
) -> float:
    """Return the least misfit where the dead centre is or half a step beside it, raised by Pa."""
    misfits = []
    for later in (0.0, -reading.step / 2, reading.step / 2):
        misfit = chamber.misfit(reading.gas, clearance, later, raised)
        misfits.append(misfit + peak_misfit(reading, later))
    return min(misfits)


def _with_reference(reading: TraceReading, chamber: Chamber, clearance: float) -> Cure:
    """Return the cure of gauge pressures called absolute, or the other way round."""
    ambient = reading.setting.ambient
    is_absolute = reading.setting.absolute
    raised = ambient if is_absolute else -ambient
    reference = "gauge" if is_absolute else "absolute"
    misfit = _misfit_about(reading, chamber, clearance, raised)
    if reading.kind in ENGINES:
        low = reading.low + reading.setting.lift
        misfit += _level_misfit(low + raised, ambient) - _level_misfit(low, ambient)
    return Cure(misfit, f"write 'pressures: {reference}'", reading.with_reference())


def _with_other_sense(reading: TraceReading, clearance: float) -> Cure | None:
    """Return the cure of an angle against the rotation; None of what does work as it is."""
    if reading.kind != FIRED or reading.p_i >= 0:
        return None
    turned = reading.turned()
    if turned.worked is None or turned.p_i <= 0:
        return None
    misfit = _misfit_about(turned, turned.worked, clearance)
    text = f"does its angle count against the rotation? write '{sense_key(reading)}'"
    return Cure(misfit, text, turned)


def _with_dead_centre(reading: TraceReading) -> Cure | None:
    """Return the cure of a wrong dead centre, which never makes a fired engine take work."""
    shift = shift_by_lines(reading, _LATEST)
    if shift is None:
        return None
    later = round(-shift.value, 1)
    moved = reading.put_later(later)
    if reading.kind == FIRED and reading.p_i > 0 > moved.p_i:
        return None
    sure = dead_centre_error(reading, shift)
    error = abs(reading.put_later(later + sure).p_i - moved.p_i)
    text = (
        f"a dead centre {abs(later):.2g} ± {sure:.2g} deg off does that; "
        f"{reading.dead_centre_later(later)}"
    )
    return Cure(shift.misfit + _FREE, text, moved, error)


def _with_clearance(reading: TraceReading, chamber: Chamber, clearance: float) -> Cure:
    """Return the cure of a wrong clearance."""
    best = best_log_clearance(chamber, reading.gas)
    likely = math.exp(best.value)
    key = f"compression_ratio: {1 + 1 / likely:.3g}"
    if reading.kind == COMPRESSOR:
        key = f"clearance: {likely:.3g}"
    misfit = best.misfit + _FREE_CLEARANCE + peak_misfit(reading, 0.0)
    placed = reading.trace.placed
    if placed is not None and placed.kind == "volume":
        text = f"check its volumes: their clearance is {clearance:.3g} of the stroke, {likely:.3g} would do"
        return Cure(misfit, text, reading.with_clearance(likely))
    text = f"write '{key}' instead of the clearance of {clearance:.3g}"
    return Cure(misfit, text, reading.with_clearance(likely))
