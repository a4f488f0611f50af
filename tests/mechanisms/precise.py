"""Crank angles and textbook formulas in 50 digits, against which the floats are measured."""

from functools import cache

import mpmath as mp

from kurbel.crank_angle import CrankAngle

mp.mp.dps = 50
DEGREE = mp.pi / 180


def exact_angle(degrees):
    """A CrankAngle whose sine and cosine are mpmath numbers; `degrees` may be one, too."""
    return _exact_angle(degrees, mp.mp.prec)


@cache
def _exact_angle(degrees, prec):
    """Once for each precision: tests take the same angles of many mechanisms."""
    turn = mp.mpf(degrees) / 180
    return CrankAngle(degrees, mp.sinpi(turn), mp.cospi(turn))


def by_radian(function, degrees, order=1):
    """The derivative by φ in radians, at `degrees`, of a function of a CrankAngle."""
    return mp.diff(lambda phi: function(exact_angle(phi / DEGREE)), mp.mpf(degrees) * DEGREE, order)
