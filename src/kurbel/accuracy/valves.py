"""Events of a slide valve in mpmath's numbers: where its edges pass those of the ports, found by searching roots.

The valve is off the middle of its ports by w = r sin a + σ (l − √(l² − r² cos² a)) + ε with a = φ + δ, in the sense
that opens the head end to steam. An end is open to steam by w − S, to the exhaust by −w − E; the crank end has −w.
"""

from typing import NamedTuple

import numpy as np

from kurbel.accuracy.methods import Precise, mp, mpf, roots_inside
from kurbel.machine.valve import EachEnd, Length, Valve

_STEPS = 48
"""Equal steps of a stroke, at which events are looked for."""


class ValveEvents(NamedTuple):
    """Crank angles in degrees from the inner dead centre through one turn, at one end of the cylinder."""

    cut_off: Precise
    release: Precise
    compression: Precise
    admission: Precise


def events_of(valve: Valve, end: str) -> ValveEvents:
    """Return the events at `head_end` or `crank_end`, in a turn from the dead centre of this end."""
    ahead, square, slope, shift = _drive(valve)
    number = ("head_end", "crank_end").index(end)
    opens = 1 - 2 * number
    laps = [mpf(_at_ends(length)[number]) for length in (valve.steam_lap, valve.exhaust_lap)]

    def displacement(phi: Precise) -> Precise:
        sin = mp.sinpi(phi / 180)
        cos = mp.cospi(phi / 180)
        across = square * cos - ahead * sin
        return ahead * cos + square * sin + valve.sense * _nearer(across, slope) + shift

    begin = 180 * number
    late = begin + 180

    def passed(lap: Precise, sense: int, beyond: int, otherwise: int) -> Precise:
        """Return where an edge passes that of the port on the stroke that begins at an angle."""
        uncovered = np.frompyfunc(lambda phi, _: sense * displacement(phi) - lap, 2, 1)
        roots, _ = roots_inside(
            uncovered, np.array([mpf(beyond)]), np.array([mpf(beyond + 180)]), _STEPS
        )
        return roots[0] if len(roots) else mpf(otherwise)

    steam, exhaust = laps
    return ValveEvents(
        cut_off=passed(steam, opens, begin, begin),
        release=passed(exhaust, -opens, begin, late),
        compression=passed(exhaust, -opens, late, late + 180),
        admission=passed(steam, opens, late, late + 180),
    )


def _at_ends(length: Length) -> tuple[float, float]:
    """Return a length at both ends."""
    if isinstance(length, EachEnd):
        return length.head_end, length.crank_end
    return length, length


def _nearer(across: Precise, slope: Precise) -> Precise:
    """Return l − √(l² − r² cos² a) of the eccentric rod; slope: 1/l."""
    if slope == 0:
        return mpf(0)
    return (1 - mp.sqrt(1 - (slope * across) ** 2)) / slope


def _drive(valve: Valve) -> tuple[Precise, Precise, Precise, Precise]:
    """Return r sin δ, r cos δ, 1/l and ε of the one eccentric that moves the valve."""
    r = mpf(valve.travel) / 2
    rod = mpf(valve.eccentric_rod)

    # each end has its own lead, and the same rod at both dead centres
    if valve.lead is not None:
        head, crank = (
            mpf(lap) + mpf(lead)
            for lap, lead in zip(_at_ends(valve.steam_lap), _at_ends(valve.lead))
        )
        ahead = (head + crank) / 2
        square = mp.sqrt(r**2 - ahead**2)
        shift = (head - crank) / 2 - valve.sense * _nearer(square, 1 / rod)
        return ahead, square, 1 / rod, shift

    delta = mp.radians(mpf(valve.angle_of_advance or 0.0))
    if valve.link is None:
        return r * mp.sin(delta), r * mp.cos(delta), 1 / rod, mpf(0)

    # Zeuner: two eccentrics and a link move the valve as one with an infinite rod
    raised = mpf(valve.link.position)
    length = mpf(valve.link.half_length)
    side = 1 if valve.link.rods == "open" else -1
    ahead = r * (mp.sin(delta) + side * (1 - raised**2) * length / rod * mp.cos(delta))
    return ahead, r * raised * mp.cos(delta), mpf(0), mpf(0)
