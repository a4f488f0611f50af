"""A pin or main bearing over the cycle: its loads in every frame, their extremes and means, and the arc that no load reaches."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Sequence
from functools import cached_property, lru_cache
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from kurbel.arrays import Array, ComplexArray, Number
from kurbel.numerics.extreme import Extreme
from kurbel.numerics.lobatto import chebyshev, rule
from kurbel.numerics.pieces import Pieces, common, resolved
from kurbel.quantity import ValuesById, value, values_for
from kurbel.solver.effort import position
from kurbel.solver.figures import AtAngles, Results, part, result
from kurbel.solver.forces import CylinderForces
from kurbel.solver.throw_loads import real_parts

if TYPE_CHECKING:
    from kurbel.solver.chapters.oil_film import FilmAtAngles, OilFilm


HALF_CONTACT = 60.0
"""Degrees to either side of a load over which pin and shell are taken to touch."""
_NO_LOAD = 1e-12
"""Of the largest load: a smaller one is rounding and has no direction."""
_ON_AXIS = 1e-12
"""Degrees by which rounding may turn a load off the axis of its frame; a rod without mass is loaded along its axis."""
_EQUAL = 1e-6
"""Degrees by which rounding may move the ends of an arc that nearly vanishing loads determine."""
FRAMES = {
    "throw": ("K", "its throw outward, of a main bearing from that of crank 1"),
    "engine": ("M", "the stroke line of cylinder 1 outward"),
    "rod": ("S", "the line of the rod, crank pin to crosshead"),
    "master": ("H", "the line of the master rod, crank pin to its piston"),
}
"""In which loads are seen: the index of the symbol of their direction, and from where it counts."""


Size = tuple[float | None, float | None]
"""Diameter and length in m; None where they are not given."""


Frames = dict[str, ComplexArray]
"""A load in N in each of its frames."""


def _oil_film() -> type[OilFilm]:
    from kurbel.solver.chapters.oil_film import OilFilm

    return OilFilm


class BearingColumns(AtAngles):
    """The load of one bearing at crank angles φ (n,) in degrees; frames: (n,) each."""

    commands = ("bearings",)
    load = value(
        "F_L",
        "force",
        "Load of a rod on its pin, or of the shaft on a main bearing",
        lambda columns: columns.size,
    )
    load_direction = values_for(
        FRAMES,
        "load_*",
        "ε_*",
        "angle",
        "Direction of the load from *",
        of=lambda columns, frame: columns.direction(frame),
    )
    eccentricity = value(
        "e_r",
        "ratio",
        "Eccentricity of the journal over the radial clearance",
        lambda columns: columns.film and columns.film.eccentricity,
    )
    film_thickness = value(
        "h_0",
        "film",
        "Thickness of the oil film where it is thinnest",
        lambda columns: columns.film and columns.film.thickness,
    )
    film_direction = value(
        "ε_h",
        "angle",
        "Direction of the thinnest film, seen from the shell: from the line of the rod, or of a main bearing from "
        "the stroke line of cylinder 1",
        lambda columns: columns.film and columns.film.direction,
    )
    film_pressure = value(
        "p_F",
        "pressure",
        "Largest pressure in the oil film",
        lambda columns: columns.film and columns.film.pressure,
    )

    def __init__(
        self, phi: Array, frames: Frames, largest: float, film: FilmAtAngles | None
    ) -> None:
        self.phi, self.frames, self.size = phi, frames, np.abs(next(iter(frames.values())))
        self.largest, self.film = largest, film

    def direction(self, frame: str) -> Array | None:
        """Return the direction of the load in degrees in a frame, None in one in which it is not known.

        That of a load which is only rounding is 0°, as of none.
        """
        load = self.frames.get(frame)
        if load is None:
            return None
        presses = self.size > _NO_LOAD * self.largest
        return _axial(np.degrees(np.angle(np.where(presses, load, 0.0))), _ON_AXIS)


class Bearing(Results):
    """A pin or a main bearing at the angles of crank 1. Attributes are named by the ids of the key values, in SI.

    name: as it is printed; key: of its entry in `oil_film`, which is `oil`; cylinders: those that load it; size:
    diameter and length in m, None where they are not given; journal, shell: the frames in which its two surfaces are at
    rest; contact: where they touch, in degrees from the direction of the load: a load to the right presses the left
    side of a crank pin (180°), but the right side of the shell of a main bearing (0°); of_rod: whether a rod turns on
    it. Of many machines all key values are arrays (machines,).
    """

    command = "bearings"
    state = BearingColumns
    contact = 180.0
    of_rod = False

    load_max = value("F_L,max", "force", "Largest load")
    load_min = value("F_L,min", "force", "Smallest load")
    load_mean = value("F_L,m", "force", "Mean load over time")
    load_high = value(
        "F_L,m,½", "force", "Mean load over the time in which it exceeds half the largest"
    )
    unloaded_arc = value("Δε_Z", "angle", "Arc of the pin or journal that is never loaded")
    unloaded_middle = value("ε_Z", "angle", "Middle of its widest part, in the frame of the pin")
    unloaded_arc_shell = value("Δε_L", "angle", "Arc of the shell that is never loaded")
    unloaded_middle_shell = value(
        "ε_L", "angle", "Middle of its widest part, in the frame of the shell"
    )
    pressure_max = value("p_L,max", "pressure", "Largest pressure, load over d l")
    pressure_mean = value("p_L,m", "pressure", "Mean pressure over time")
    rubbing_speed_max = value("v_L,max", "velocity", "Largest sliding speed of the surfaces")
    rubbing_speed_mean = value("v_L,m", "velocity", "Mean sliding speed of the surfaces")
    pressure_velocity = value("k_L", "pressure_velocity", "Mean pressure times mean speed, p v")
    work_rubbing = value(
        "A_f,L", "energy", "Friction work per cycle", lambda bearing: bearing.friction_work()
    )

    def __init__(
        self,
        name: str,
        key: str,
        cylinders: Sequence[CylinderForces],
        size: Size,
        surfaces: tuple[str, str],
    ) -> None:
        self.name, self.key, self.cylinders = name, key, tuple(cylinders)
        self.journal, self.shell = surfaces
        drive = cylinders[0].drive
        self.machine, self.count, self.omega = drive.machine, drive.count, drive.omega
        films = self.machine.oil_film
        self.oil = films.bearings.get(key) if films else None
        diameter, length = size
        if self.oil:
            diameter = self.oil.diameter if diameter is None else diameter
            length = self.oil.length if length is None else length
        self.size = diameter, length
        cycle = 360.0 * self.machine.revolutions
        parts = [(cylinder.pieces, position(cylinder)) for cylinder in cylinders]
        self._common = common(parts, cycle)

    @abstractmethod
    def _frames(self, degrees: Array, within: Array) -> Frames:
        """Return the load of the only machine at angles (n,) in degrees."""

    @abstractmethod
    def _samples(self) -> Sequence[ComplexArray]:
        """Return the load in the frames of both surfaces on the common pieces, (nodes, pieces) each."""

    def _turning(self) -> Array:
        """Return the speed at which the journal turns in the shell on the common pieces, as a multiple of ω."""
        return np.ones_like(self._common.degrees)

    def turning(self) -> tuple[Extreme, Number]:
        """Return the largest and the mean speed at which the surfaces turn on each other, as a multiple of ω."""
        return Extreme(1.0, self._result(np.zeros(self.count or 1))), 1.0

    @abstractmethod
    def friction_work(self) -> Number | None:
        """Return the friction work in J per cycle of the machine, None without a coefficient of friction."""

    def _columns(self, phi: Array, within: Array) -> BearingColumns:
        largest = float(np.abs(self._samples()[0]).max())
        frames = self._frames(phi, within)
        pressed = self._pressing(frames[self.shell])
        film = self.film.at_angles(phi, pressed) if self.film else None
        return BearingColumns(phi, frames, largest, film)

    # its oil film

    def _pressing(self, load: ComplexArray) -> ComplexArray:
        """Return a load seen from the shell, turned to where it presses pin and shell together."""
        return load * math.cos(math.radians(self.contact))

    @part(_oil_film, there=lambda bearing: bearing.oil is not None)
    def film(self) -> OilFilm | None:
        """Its oil film; None where it has none, or something that it needs is not given."""
        films = self.machine.oil_film
        if films is None or self.oil is None or self._film_lacks:
            return None
        shape = _oil_film().shape_of(films, self.key, *self.size)
        pieces, _, loads = self._cycle
        turning = pieces.resampled(self._turning(), self._common)
        pressed = self._pressing(loads[1])
        return _oil_film()(shape, pieces, pressed, turning, self.omega, self.count)

    @property
    def _film_lacks(self) -> str:
        """What an oil film needs and is not given, or an empty text."""
        if self.omega is None:
            return "no speed given"
        if self.count is None and self.omega == 0:
            return "not defined at rest"
        missing = [name for name, size in zip(("diameter", "length"), self.size) if size is None]
        if not missing:
            return ""
        return f"no {' and '.join(missing)} given"

    @property
    def film_obstacle(self) -> str:
        """Why the only machine has no film in a bearing that `oil_film` describes, or an empty text."""
        if self.oil is None:
            return ""
        if self.film:
            return self.film.obstacle
        return self._film_lacks

    @cached_property
    def _cycle(self) -> tuple[Pieces, Array, ComplexArray]:
        """Pieces on which the magnitude of the load is a polynomial, the magnitude, and the load of both surfaces."""
        return with_magnitude(self._common, self._samples())

    @property
    def breaks(self) -> Array:
        """The crank angles in degrees of the only machine between which every quantity is smooth."""
        return self._cycle[0].ends

    def _result(self, values: Array) -> Any:
        return result(values, self.count)

    @cached_property
    def answers(self) -> ValuesById:
        """The key values by id in SI; those that need sizes or speed only if these are given."""
        pieces, load, surfaces = self._cycle
        extremes = pieces.extremes(load[None]).each(self._result)[0]
        most = extremes.largest
        mean = self._result(pieces.mean(load))
        high = mean_of_high(pieces, load, np.atleast_1d(most.value))
        answers: ValuesById = {
            "load_max": most,
            "load_min": extremes.smallest,
            "load_mean": mean,
            "load_high": self._result(high),
        }
        for surface, ending in zip(surfaces, ("", "_shell")):
            arc_and_middle = unloaded(pieces, surface, self.contact)
            for id, degrees in zip(("unloaded_arc", "unloaded_middle"), arc_and_middle):
                is_absent = self.count is None and math.isnan(degrees[0])
                answers[id + ending] = None if is_absent else self._result(degrees)

        diameter, length = self.size
        if diameter is not None and length is not None:
            area = diameter * length
            answers["pressure_max"] = Extreme(most.value / area, most.degrees)
            answers["pressure_mean"] = mean / area
        if diameter is not None and self.omega is not None:
            surface_speed = self.omega * diameter / 2
            fastest, rate = self.turning()
            answers["rubbing_speed_max"] = Extreme(fastest.value * surface_speed, fastest.degrees)
            answers["rubbing_speed_mean"] = rate * surface_speed
            if length is not None:
                answers["pressure_velocity"] = (
                    answers["pressure_mean"] * answers["rubbing_speed_mean"]
                )
        return answers


def with_magnitude(
    pieces: Pieces, loads: Sequence[ComplexArray]
) -> tuple[Pieces, Array, ComplexArray]:
    """Return pieces on which the magnitude of a load is a polynomial, with that in N and the loads there.

    loads: one load as it is seen in several frames, each (nodes, pieces).
    """
    parts = real_parts(loads, pieces.degrees.shape)
    largest = pieces.largest(np.abs(loads[0]))
    fine, load, parts = resolved(
        pieces,
        parts,
        parts[:2],
        np.stack((largest, largest)),
        lambda _, components: np.hypot(*components[:2])[None],
    )
    return fine, load[0], parts[::2] + 1j * parts[1::2]


def mean_of_high(pieces: Pieces, load: Array, largest: Array) -> Array:
    """Return the mean load in N over the time in which it exceeds half the largest, (machines,)."""
    cut = pieces.split(pieces.zeros(load - pieces.of(largest / 2), largest))
    load = cut.resampled(load, pieces)
    # a piece is above as a whole, which its mean decides; the weights of a mean sum to 2
    above = cut.rule.weights @ load > cut.of(largest)
    time, sums = cut.integral(np.stack((np.ones_like(load), load)) * above)
    return np.where(largest == 0, 0.0, sums / np.where(time > 0, time, 1.0))


def unloaded(pieces: Pieces, load: ComplexArray, contact: float) -> Array:
    """Return the arc in degrees of a surface that a load never presses, and the middle of its widest stretch.

    load: in N, complex in the frame of the surface, (nodes, pieces), which turns by less than half a turn from node to
    node; contact: degrees from the direction of the load to where it presses. (2, machines), nan where nothing presses,
    or all of it is pressed.
    """
    size = np.abs(load)
    largest = pieces.largest(size)[pieces.machine]
    pressed = size.max(axis=0) > _NO_LOAD * largest
    pieces, towards, size = pieces.taken(pressed), load[:, pressed], size[:, pressed]
    # where the load vanishes at an end of a piece, its direction is that to which the inner nodes lead
    vanishing = size[[0, -1]] <= _NO_LOAD * largest[pressed]
    towards = towards / np.where(size > 0, size, 1.0)
    towards[[0, -1]] = np.where(vanishing, _outward(len(load)) @ towards[1:-1], towards[[0, -1]])

    low, high = pieces.ranges(np.degrees(np.unwrap(np.angle(towards), axis=0)))
    begins, ends = low + contact - HALF_CONTACT, high + contact + HALF_CONTACT
    turns = np.mod(-begins, 360.0) - 360.0 + begins  # they begin above 0° and up to 360°
    begins, ends = begins - turns, ends - turns
    bounds = np.searchsorted(pieces.machine, np.arange(pieces.count + 1)).tolist()
    gaps = [unreached(begins[first:last], ends[first:last]) for first, last in pairwise(bounds)]
    return np.transpose(gaps)


@lru_cache
def _outward(count: int) -> Array:
    """Return the matrix (2, count − 2) that extrapolates from the inner ones of `count` nodes to both ends."""
    inner = rule(count).nodes[1:-1]
    return chebyshev(np.array([-1.0, 1.0]), count - 2) @ np.linalg.inv(chebyshev(inner, count - 2))


def unreached(begins: Array, ends: Array) -> tuple[float, float]:
    """Return how many degrees of a circle no arc covers, and the middle of the widest gap, of equal ones the first.

    begins (n,): of the arcs, above 0° and up to 360°; ends (n,). nan without a gap, or without an arc.

    >>> unreached(np.array([190.0, 10.0]), np.array([360.0, 100.0]))
    (100.0, 145.0)
    """
    if not len(begins):
        return math.nan, math.nan
    # how far the circle is covered before each arc: by the arcs before it, the first by those of the turn before
    order = np.argsort(begins)
    begin = begins[order]
    covered = np.maximum.accumulate(np.append(ends.max() - 360.0, ends[order]))
    gaps = begin - covered[:-1]

    uncovered, widest, middle = 0.0, 0.0, math.nan
    for number in np.flatnonzero(gaps > 0).tolist():
        gap = float(gaps[number])
        uncovered += gap
        if gap > widest + _EQUAL:
            widest = gap
            middle = float(begin[number]) - gap / 2
    return uncovered, float(_axial(np.asarray(middle - 360.0 * np.rint(middle / 360.0)), _EQUAL))


def _axial(directions: Array, rounding: float) -> Array:
    """Return directions in degrees; those within `rounding` of the axis are exactly 0 or 180."""
    along = np.rint(directions / 180.0) * 180.0
    return np.where(np.abs(directions - along) <= rounding, np.abs(along), directions)
