"""Motion and statics of every mechanism in mpmath's numbers, from where its joints are.

The books have formulas for the slider-crank. Of the others only the joints are known here, as complex numbers: the
shaft is at 0 and the crank pin at R e^(iφ). Velocities and accelerations follow by differentiation, forces from the
members: a rod carries along its line, a block pushes square to its slot.
"""

import math
from collections.abc import Callable
from functools import cache, partial
from typing import NamedTuple, Union

import numpy as np

from kurbel.accuracy.jets import Jet, turned
from kurbel.accuracy.methods import Precise, mp, mpf, roots_inside
from kurbel.arrays import Array
from kurbel.mechanisms import Mechanism
from kurbel.mechanisms.four_bar import FourBar
from kurbel.mechanisms.link_rod import LinkedPiston
from kurbel.mechanisms.parallel_crank import ParallelCrank
from kurbel.mechanisms.slotted_lever import SlottedLever

_STEPS = 48
"""Equal steps of half a turn, at which dead centres are looked for."""


class Stance(NamedTuple):
    """A mechanism: x, dx/dφ and d²x/dφ² in m, of what only swings θ in radians; sine and cosine of a rod's angle."""

    x: Precise
    slope: Precise
    curvature: Precise
    sin_psi: Precise
    cos_psi: Precise


def stance(
    r: Precise,
    length: Precise,
    e: Precise,
    sin: Precise,
    cos: Precise,
    sqrt: Callable[[Precise], Precise],
) -> Stance:
    """Return the motion at a crank angle, R 285, 288, 291, of a crank r, a rod and an offset e in m."""
    if math.isinf(length):
        return Stance(r * (1 - cos), r * sin, r * cos, 0 * sin, 0 * sin + 1)
    aside = r * sin - e
    along = sqrt(length**2 - aside**2)
    swing = r * cos * aside / along
    x = sqrt((length + r) ** 2 - e**2) - r * cos - along
    curvature = r * cos + (r**2 * cos**2 - aside * r * sin + swing**2) / along
    return Stance(x, r * sin + swing, curvature, aside / length, along / length)


class RodMotion:
    """Motion of a slider-crank, or of a Scotch yoke, whose rod is infinite.

    ends: of the strokes of one turn in degrees; start: x at the first one; works_out: whether the stroke from there is
    the working one; never_returns: whether the output turns on.
    """

    start: Precise = mpf(0)
    works_out = True
    never_returns = False

    def __init__(self, mechanism: Mechanism) -> None:
        self.r = mpf(mechanism.crank)
        self.rod = mpf(mechanism.rod_length)
        offset = mpf(mechanism.offset)
        self.at_pin = partial(stance, self.r, self.rod, offset, sqrt=mp.sqrt)
        inner = mp.degrees(mp.asin(offset / (self.rod + self.r)))
        outer = 180 + mp.degrees(mp.asin(offset / (self.rod - self.r)))
        self.ends = np.array([inner, outer, 360 + inner])
        self.stroke = self.at(self.ends[1]).x

    def at(self, phi: Precise) -> Stance:
        """Return the motion at a crank angle."""
        return self.at_pin(sin=mp.sinpi(phi / 180), cos=mp.cospi(phi / 180))


class LeverMotion:
    """A crank pin in a slotted lever, whose pivot is to the left of the shaft; a ram moves upward at its end.

    Without `lever` the output is the tilt of the lever. ends … never_returns: as of a `RodMotion`.
    """

    works_out = True

    def __init__(self, mechanism: SlottedLever) -> None:
        self.r = mpf(mechanism.crank)
        self._frame = mpf(mechanism.frame)
        self._lever = None if mechanism.lever is None else mpf(mechanism.lever)
        self._link = mpf(mechanism.link)
        is_full = self._frame < self.r
        self.never_returns = is_full and self._lever is None
        self._is_full = is_full

        # the line of the ram, half-way between the highest and the lowest point of the lever's end
        self._height = mpf(0)
        if mechanism.ram_height is not None:
            self._height = mpf(mechanism.ram_height)
        elif self._lever is not None and not is_full:
            lowest = self._lever * mp.sqrt(1 - (self.r / self._frame) ** 2)
            self._height = (self._lever + lowest) / 2

        # x counts from the middle of the stroke
        self._middle = mpf(0)
        self.ends = dead_centres(self)
        inner = self.at(self.ends[0]).x
        outer = self.at(self.ends[1]).x
        if self._lever is not None:
            self._middle = (inner + outer) / 2
        self.start = self.at(self.ends[0]).x
        self.stroke = outer - inner

    def _direction(self, turn: Jet) -> tuple[Jet, Jet]:
        """Return the unit vector of the lever, and how far the pin is from its pivot."""
        arm = Jet(self.r) * turn + Jet(self._frame)
        reach = arm.size()
        return arm / reach, reach

    def at(self, phi: Precise) -> Stance:
        """Return the motion at a crank angle."""
        turn = turned(phi)
        lever, _ = self._direction(turn)
        if self._lever is None:
            tilt = lever.bearing()
            if self._is_full:
                tilt = (lever / turn).bearing() + Jet(mp.radians(phi), 1)
            return Stance(tilt.value, tilt.rate, tilt.bend, mpf(0), mpf(1))
        end = Jet(self._lever) * lever
        ram = end.imaginary()
        if not mp.isinf(self._link):
            aside = Jet(self._height) - end.real()
            ram = ram + (Jet(self._link**2) - aside * aside).root()
        return Stance(ram.value - self._middle, ram.rate, ram.bend, mpf(0), mpf(1))

    def torque_of(self, load: Precise, phi: Precise) -> Precise:
        """Return the torque on the shaft of a force on the ram, or of a moment on the lever."""
        turn = turned(phi)
        lever, reach = self._direction(turn)
        square = 1j * lever.value
        if self._lever is None:
            return moment(self.r * turn.value, load / reach.value * square)
        end = self._lever * lever.value
        push = 1j * load
        if not mp.isinf(self._link):
            aside = self._height - mp.re(end)
            link = (aside + 1j * mp.sqrt(self._link**2 - aside**2)) / self._link
            push = load / mp.im(link) * link
        on_pin = moment(end, push) / reach.value
        return moment(self.r * turn.value, on_pin * square)


class LinkageMotion:
    """Four bars: the output is the angle of the rocker. ends … never_returns: as of a `RodMotion`."""

    def __init__(self, mechanism: FourBar) -> None:
        self.r = mpf(mechanism.crank)
        self._frame = mpf(mechanism.frame)
        self._coupler = mpf(mechanism.coupler)
        self._rocker = mpf(mechanism.rocker)
        self.never_returns = self._frame < self.r
        self.ends = dead_centres(self)
        self.start = self.at(self.ends[0]).x
        self.stroke = self.at(self.ends[1]).x - self.start
        # the slower swing is the working one
        self.works_out = self.never_returns or bool(self.ends[1] - self.ends[0] >= 180)

    def _members(self, turn: Jet) -> tuple[Jet, Jet]:
        """Return coupler and rocker: their joint is on the left of the way from the pin to the rocker's pivot."""
        pin = Jet(self.r) * turn
        diagonal = Jet(self._frame) - pin
        length = diagonal.size()
        squares = Jet(self._coupler**2 - self._rocker**2)
        foot = (length * length + squares) / (Jet(2) * length)
        height = (Jet(self._coupler**2) - foot * foot).root()
        coupler = diagonal / length * (foot + Jet(1j) * height)
        return coupler, coupler - diagonal

    def at(self, phi: Precise) -> Stance:
        """Return the motion at a crank angle."""
        turn = turned(phi)
        _, rocker = self._members(turn)
        swing = rocker.bearing()
        if self.never_returns:
            swing = (rocker / turn).bearing() + Jet(mp.radians(phi), 1)
        return Stance(swing.value, swing.rate, swing.bend, mpf(0), mpf(1))

    def torque_of(self, load: Precise, phi: Precise) -> Precise:
        """Return the torque on the shaft of a moment on the rocker, which the coupler balances."""
        turn = turned(phi)
        coupler, rocker = self._members(turn)
        thrust = load / moment(rocker.value, coupler.value)
        return moment(self.r * turn.value, thrust * coupler.value)


class ParallelMotion:
    """Two cranks that turn alike, with elastic couplers on two pairs at 90°. Names as of a `RodMotion`."""

    works_out = True
    never_returns = True
    start: Precise = mpf(0)

    def __init__(self, mechanism: ParallelCrank) -> None:
        self.r = mpf(mechanism.crank)
        self.ends = np.array([mpf(0), mpf(180), mpf(360)])
        self.stroke = 2 * mp.pi

    def at(self, phi: Precise) -> Stance:
        """Return the motion at a crank angle."""
        return Stance(mp.radians(phi), mpf(1), mpf(0), mpf(0), mpf(1))

    def torque_of(self, load: Precise, phi: Precise) -> Precise:
        """Return the torque on the shaft of a moment on the second crank: each coupler takes as it is strained."""
        pin = self.r * turned(phi).value
        strains = [moment(arm, mpf(1)) for arm in (pin, 1j * pin)]
        stiffness = load / sum(strain**2 for strain in strains)
        thrusts = [stiffness * strain for strain in strains]
        return moment(pin, thrusts[0]) + moment(1j * pin, thrusts[1])


class Knuckle(NamedTuple):
    """The big end of a master rod, complex in the frame of a link's own stroke line, in m.

    pin: the crank pin; rod: from it to the master's piston; across: the unit vector across the master's stroke line;
    arm: from it to the knuckle pin; place: of the knuckle pin, with its derivatives.
    """

    pin: Precise
    rod: Precise
    across: Precise
    arm: Precise
    place: Jet


class LinkMotion:
    """A piston on a link rod: its knuckle pin turns with the master rod. start … never_returns: as of a `RodMotion`."""

    start: Precise = mpf(0)
    works_out = True
    never_returns = False

    def __init__(self, mechanism: LinkedPiston) -> None:
        self.r = mpf(mechanism.crank)
        self.between = mpf(mechanism.between)
        self._master_rod = mpf(mechanism.master.rod)
        self._master_offset = mpf(mechanism.master.offset)
        self._radius = mpf(mechanism.radius)
        self._angle = mpf(mechanism.angle)
        self._length = mpf(mechanism.length)
        self._offset = mpf(mechanism.own_offset)
        # x is from the shaft until the dead centres are known
        self._top = mpf(0)
        self.knuckle_at = cache(self._knuckle_at)
        self.ends = dead_centres(self)
        # from here on it is from the inner one
        self._top = -self.at(self.ends[0]).x
        self.stroke = self.at(self.ends[1]).x

    def _knuckle_at(self, phi: Precise) -> Knuckle:
        """Return crank pin, master rod and knuckle pin at the link's own crank angle."""
        # in the frame of the master's stroke line
        pin = Jet(self.r) * turned(phi + self.between)
        aside = Jet(self._master_offset) - pin.imaginary()
        along = (Jet(self._master_rod**2) - aside * aside).root()
        rod = along + Jet(1j) * aside
        turned_arm = self._radius / self._master_rod * turned(self._angle).value
        arm = rod * Jet(turned_arm)

        # in that of its own
        line = turned(-self.between).value
        place = (pin + arm) * Jet(line)
        return Knuckle(pin.value * line, rod.value * line, 1j * line, arm.value * line, place)

    def at(self, phi: Precise) -> Stance:
        """Return the motion at the link's own crank angle."""
        place = self.knuckle_at(phi).place
        aside = place.imaginary() - Jet(self._offset)
        along = (Jet(self._length**2) - aside * aside).root()
        x = Jet(self._top) - place.real() - along
        sin_psi = aside.value / self._length
        return Stance(x.value, x.rate, x.bend, sin_psi, along.value / self._length)


OtherMotion = Union[LeverMotion, LinkageMotion, ParallelMotion]
"""A mechanism of which only the joints are known."""
TextbookMotion = Union[RodMotion, LinkMotion, OtherMotion]


def motion_of(mechanism: Mechanism) -> TextbookMotion:
    """Return the motion of a mechanism."""
    if isinstance(mechanism, SlottedLever):
        return LeverMotion(mechanism)
    if isinstance(mechanism, FourBar):
        return LinkageMotion(mechanism)
    if isinstance(mechanism, LinkedPiston):
        return LinkMotion(mechanism)
    if isinstance(mechanism, ParallelCrank):
        return ParallelMotion(mechanism)
    return RodMotion(mechanism)


def moment(arm: Precise, force: Precise) -> Precise:
    """Return the moment of a force on an arm, positive in the sense of rotation."""
    return mp.im(mp.conj(arm) * force)


def dead_centres(motion: LeverMotion | LinkageMotion | LinkMotion) -> Array:
    """Return where the output turns back in one turn: its smallest and its largest place, and the smallest again."""
    halves = np.array([mpf(0), mpf(180), mpf(360)])
    if motion.never_returns:
        return halves
    slopes = np.frompyfunc(lambda phi, _: motion.at(phi).slope, 2, 1)
    roots, _ = roots_inside(slopes, halves[:-1] - 180, halves[1:] - 180, _STEPS)
    inner = next(angle for angle in roots if motion.at(angle).curvature > 0)
    outer = next(angle for angle in roots if motion.at(angle).curvature < 0)
    if outer < inner:
        outer += 360
    return np.array([inner, outer, 360 + inner])
