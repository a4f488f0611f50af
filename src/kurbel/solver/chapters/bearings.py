"""Loads of every pin and main bearing over the cycle, and the arcs of their surfaces that are never loaded.

A load is a complex number: its real part is along the axis of a frame, outward, its imaginary part 90° further in
the sense of rotation. The frames:

    throw    turns with the crank:   F = −D + iT, of a main bearing as crank 1 turns
    engine   the stroke line of cylinder 1 outward:   F e^{iφ} e^{iγ}, γ from there to the stroke line
    rod      the line of the rod, crank pin to crosshead:   F e^{iφ} e^{iψ}

Crank pin and journal are at rest in the frame of the throw, crosshead pin and main shell in that of the engine, the
shells of the rod in that of the rod. Pin and shell are taken to touch over 60° to either side of the load.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property, lru_cache
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from kurbel import crank_formulas as formulas
from kurbel.arrays import Array, ComplexArray, Number
from kurbel.crank_angle import CrankAngle, unit_vector
from kurbel.errors import UsageError
from kurbel.machine import Machine
from kurbel.machine.batch import taken
from kurbel.machine.cylinder import crank_lag
from kurbel.numerics.extreme import Extreme
from kurbel.numerics.lobatto import chebyshev, rule
from kurbel.numerics.pieces import Pieces, common, resolved
from kurbel.quantity import ValuesById, value, values_for
from kurbel.solver.effort import position
from kurbel.solver.figures import AtAngles, Results, part, result
from kurbel.solver.forces import CylinderForces
from kurbel.solver.shaft import SupportedShaft, shaft_obstacle
from kurbel.solver.state import State, on_crosshead_pin, on_pin
from kurbel.solver.throw_loads import pin_load, real_parts, resampled, state_at
from kurbel.solver.vector import Force

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
        turning = pieces.carried(self._turning(), self._common)
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


class RodPin(Bearing):
    """A pin of a connecting rod; the load is that of the rod on the pin.

    pin: `crank_pin`, or `crosshead_pin`, which moves with the crosshead and so in the frame of the engine.
    """

    of_rod = True

    def __init__(self, name: str, forces: CylinderForces, size: Size, pin: str) -> None:
        surfaces = ("throw" if pin == "crank_pin" else "engine", "rod")
        super().__init__(name, pin, (forces,), size, surfaces)
        self._forces = forces
        self._pin = pin
        # its stroke line, from that of cylinder 1
        first = forces.drive.machine.cylinders[0]
        self._bank = unit_vector(forces.drive.cylinder.bank_angle - first.bank_angle)

    def _seen(self, state: State, bank: Any) -> Frames:
        """Return the load in each frame; bank: e^{iγ} of its stroke line. N > 0 presses toward −i."""
        sin_psi, cos_psi = state.rod_angle or (0.0, 1.0)
        frames: dict[str, Any] = {}
        line: Any
        if self._pin == "crank_pin":
            D, T = on_pin(state)
            frames["throw"] = -D + 1j * T
            line = frames["throw"] * (state.angle.cos + 1j * state.angle.sin)
        else:
            along, across = on_crosshead_pin(state)
            line = along - 1j * across
        frames["engine"] = line * bank
        frames["rod"] = line * (cos_psi + 1j * sin_psi)
        return frames

    def _frames(self, degrees: Array, within: Array) -> Frames:
        return self._seen(state_at(self._forces, degrees, within), self._bank)

    def _samples(self) -> Sequence[ComplexArray]:
        frames = self._seen(self._forces.samples, self._forces.pieces.of(self._bank))
        return [*resampled(self._common, self._forces, frames[self.journal], frames[self.shell])]

    def _turning(self) -> Array:
        """The rod turns on the crank pin with 1 + dψ/dφ, on the crosshead pin with dψ/dφ; see `Bearing`."""
        state, pieces = self._forces.samples, self._common
        _, cos_psi = state.rod_angle or (0.0, 1.0)
        mechanism = state.drive.mechanism
        slope = formulas.rod_slope(state.angle.cos, cos_psi, mechanism.lam)
        if state.drive.cylinder.link_rod is not None:
            # ψ_l does not follow from the crank pin, and τ = −ψ_l
            slope = -state.linked_piston.coupler_at(state.angle).slope
        rate = 1 + slope if self._pin == "crank_pin" else slope
        return resampled(pieces, self._forces, rate).real[0]

    def turning(self) -> tuple[Extreme, Number]:
        """Of a rod that swings; see `Bearing`."""
        pieces = self._common
        rate = self._turning()
        fastest = pieces.extremes(rate[None]).each(self._result)[0].peak
        return fastest, self._result(pieces.mean(np.abs(rate)))

    def friction_work(self) -> Number | None:
        """That of `kurbel forces`, over the cycle of the machine; see `Bearing`."""
        work = self._forces.friction_works.get(self._pin)
        if work is None:
            return None
        return work * (self.machine.revolutions // self._forces.drive.revolutions)


class MasterPin(RodPin):
    """The crank pin of a master rod, which carries the forces of its link rods, too."""

    def __init__(
        self, name: str, forces: CylinderForces, links: Sequence[CylinderForces], size: Size
    ) -> None:
        super().__init__(name, forces, size, "crank_pin")
        self._links = tuple(links)
        cycle = 360.0 * self.machine.revolutions
        parts = [(cylinder.pieces, position(cylinder)) for cylinder in (forces, *links)]
        self._common = common(parts, cycle)

    def _seen_from(self, throw: ComplexArray, degrees: Array) -> Frames:
        """Return a load in N from the frame of the throw in every frame; degrees: of the own crank."""
        angle = CrankAngle.of(degrees)
        rod_angle = self._forces.mechanism.rod_angle(angle)
        assert rod_angle is not None
        sin_psi, cos_psi = rod_angle
        line = throw * (angle.cos + 1j * angle.sin)
        return {
            "throw": throw,
            "engine": line * self._bank,
            "rod": line * (cos_psi + 1j * sin_psi),
        }

    def _frames(self, degrees: Array, within: Array) -> Frames:
        load: Force = 0j
        for cylinder in (self._forces, *self._links):
            load = load - np.conj(pin_load(state_at(cylinder, degrees, within)))
        return self._seen_from(load, degrees - position(self._forces))

    def _samples(self) -> Sequence[ComplexArray]:
        load: Force = 0j
        for cylinder in (self._forces, *self._links):
            (on_pin_of_rod,) = resampled(self._common, cylinder, pin_load(cylinder.samples))
            load = load - np.conj(on_pin_of_rod)
        frames = self._seen_from(load, self._common.degrees - position(self._forces))
        return [frames[self.journal], frames[self.shell]]


class KnucklePin(RodPin):
    """The knuckle pin of a link rod, at rest in the master rod; the load is that of the link rod on it."""

    def __init__(self, name: str, forces: CylinderForces) -> None:
        super().__init__(name, forces, (None, None), "knuckle_pin")
        self.journal = "master"

    def _seen(self, state: State, bank: Any) -> Frames:
        """Return the load in each frame; see `RodPin`."""
        sin_psi, cos_psi = state.rod_angle or (0.0, 1.0)
        force = state.knuckle_force
        master = state.linked_piston.master_direction(state.angle)
        return {
            "engine": force * bank,
            "rod": force * (cos_psi + 1j * sin_psi),
            "master": force * np.conj(master),
        }

    def _turning(self) -> Array:
        """The link rod turns on its knuckle pin with ψ_l′ − ψ′; see `Bearing`."""
        state = self._forces.samples
        rate = state.linked_piston.turning_on_master(state.angle)
        return resampled(self._common, self._forces, rate).real[0]


class MainBearing(Bearing):
    """A main bearing under one throw, or under the two that it is between; the load is that of the shaft on it.

    number: along the shaft, from 0; every: all cylinders of the machine. Its throw frame is that of crank 1.
    """

    contact = 0.0

    def __init__(
        self,
        name: str,
        number: int,
        line: SupportedShaft,
        all_cylinders: Sequence[CylinderForces],
        size: Size,
    ) -> None:
        throws = [throw for throw in line.throws if number in (throw.A, throw.B)]
        self._members = dict[int, CylinderForces]()
        for throw in throws:
            for index in throw.cylinders:
                self._members[index] = all_cylinders[index]
        cylinders = tuple(self._members.values())
        super().__init__(name, "journals", cylinders, size, ("throw", "engine"))
        self._number, self._line = number, line

    def _force(
        self, line: SupportedShaft, pins: Mapping[int, Force], degrees: Array
    ) -> ComplexArray:
        """Return the force in N in the frame of crank 1, whose angles in degrees these are.

        line: with the numbers of the machines whose angles they are; pins: D + iT on the crank pin of each cylinder.
        """
        force = np.zeros(degrees.shape, complex)
        for throw in line.throws:
            if self._number in (throw.A, throw.B):
                cylinder = line.machine.cylinders[throw.cylinders[0]]
                rods = [pins[index] for index in throw.cylinders]
                # whole turns are taken off, which is exact: next to a large angle another would lose its digits
                lag = np.fmod(crank_lag(cylinder, line.machine.cylinders[0]), 360.0)
                angle = CrankAngle.of(degrees - lag)
                on_A, on_B = line.reactions(throw, rods, cylinder, angle)
                on_bearing = on_A if self._number == throw.A else on_B
                force -= np.conj(on_bearing) * unit_vector(throw.angle)
        return force

    def _frames(self, degrees: Array, within: Array) -> Frames:
        pins = {}
        for number, forces in self._members.items():
            pins[number] = pin_load(state_at(forces, degrees, within))
        throw = self._force(self._line, pins, degrees)
        return {"throw": throw, "engine": throw * unit_vector(degrees)}

    def _sampled(self, rubbed: bool) -> ComplexArray:
        """Return the force in N on the common pieces; rubbed: with the friction of the pins."""
        pieces, pins = self._common, {}
        for number, forces in self._members.items():
            state = forces.samples if rubbed else forces.samples.without_pin_friction
            (pins[number],) = resampled(pieces, forces, pin_load(state))
        line = self._line
        if self.count is not None:
            line = SupportedShaft(taken(self.machine, pieces.machine))
        return self._force(line, pins, pieces.degrees)

    def _samples(self) -> Sequence[ComplexArray]:
        force = self._sampled(rubbed=True)
        return force, force * unit_vector(self._common.degrees)

    def friction_work(self) -> Number | None:
        """∮ f |F| d/2 dφ with the force F without the friction of the pins; see `Bearing`."""
        coefficients = []
        for forces in self.cylinders:
            friction = forces.drive.cylinder.friction
            if friction and friction.journals is not None:
                coefficients.append(friction.journals)
        if not coefficients or self.size[0] is None:
            return None
        pieces, load, _ = with_magnitude(self._common, [self._sampled(rubbed=False)])
        return self._result(pieces.integral(load)) * coefficients[0] * self.size[0] / 2


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
    load = cut.carried(load, pieces)
    # a piece is above as a whole, which its mean decides; the weights of a mean sum to 2
    above = cut.rule.weights @ load > cut.of(largest)
    time, sums = cut.integral(np.stack((np.ones_like(load), load)) * above)
    return np.where(largest == 0, 0.0, sums / np.where(time > 0, time, 1.0))


# the arc of a surface that no load reaches


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
    arcs = [*zip(begins.tolist(), ends.tolist())]
    return np.transpose([unreached(arcs[first:last]) for first, last in pairwise(bounds)])


@lru_cache
def _outward(count: int) -> Array:
    """Return the matrix (2, count − 2) that extrapolates from the inner ones of `count` nodes to both ends."""
    inner = rule(count).nodes[1:-1]
    return chebyshev(np.array([-1.0, 1.0]), count - 2) @ np.linalg.inv(chebyshev(inner, count - 2))


def unreached(arcs: Sequence[tuple[float, float]]) -> tuple[float, float]:
    """Return how many degrees of a circle no arc covers, and the middle of the widest gap, of equal ones the first.

    arcs: their beginnings, above 0° and up to 360°, and ends. nan without a gap, or without an arc.

    >>> unreached([(10.0, 100.0), (190.0, 360.0)])
    (100.0, 145.0)
    """
    if not arcs:
        return math.nan, math.nan
    reached = max(end for _, end in arcs) - 360.0
    uncovered, widest, middle = 0.0, 0.0, math.nan
    for begin, end in sorted(arcs):
        gap = begin - reached
        if gap > 0:
            uncovered += gap
        if gap > widest + _EQUAL:
            widest, middle = gap, begin - gap / 2
        reached = max(reached, end)
    return uncovered, float(_axial(np.asarray(middle - 360.0 * np.rint(middle / 360.0)), _EQUAL))


def _axial(directions: Array, rounding: float) -> Array:
    """Return directions in degrees; those within `rounding` of the axis are exactly 0 or 180."""
    along = np.rint(directions / 180.0) * 180.0
    return np.where(np.abs(directions - along) <= rounding, np.abs(along), directions)


# all of them


class ShaftBearings:
    """What `kurbel bearings` computes. Raises UsageError where no cylinder has a force and a connecting rod.

    obstacle: why there are no loads of main bearings, or an empty text; line: the throws on their bearings, None where
    that is not known.
    """

    def __init__(self, machine: Machine, cylinders: Sequence[CylinderForces]) -> None:
        self.machine, self._cylinders = machine, cylinders
        if not any(map(_loads_pins, cylinders)):
            raise UsageError(
                f"{machine.name}: no load on any bearing: give a cylinder with a connecting rod, and a pressure or "
                "masses and a speed"
            )
        self.obstacle = shaft_obstacle(machine)
        self.line = None if self.obstacle else SupportedShaft(machine)

    @cached_property
    def parts(self) -> tuple[Bearing, ...]:
        """Crank pin and crosshead pin of every cylinder, then the main bearings along the shaft."""
        pins = list[Bearing]()
        for number, forces in enumerate(self._cylinders):
            if _loads_pins(forces):
                pins += self._pins(number, forces)
        return (*pins, *self._main_bearings())

    def _pins(self, number: int, forces: CylinderForces) -> Iterator[RodPin]:
        """Yield the pins of a rod: that on the crank, or on its master rod, and that in the crosshead."""
        cylinder, shaft = forces.drive.cylinder, self.machine.crankshaft
        friction = cylinder.friction
        of = f" of {forces.drive.name}" if len(self._cylinders) > 1 else ""
        links = [other for other in self._cylinders if other.drive.cylinder.hangs_on(cylinder.name)]
        pin: Size = friction.crank_pin_diameter if friction else None, None
        if cylinder.link_rod is not None:
            yield KnucklePin(f"knuckle pin{of}", forces)
        elif links:
            if shaft:
                pin = shaft.pin_diameter, shaft.pin_length
            yield MasterPin(f"crank pin{of}", forces, links, pin)
        else:
            if shaft:  # rods on one pin have equal parts of its length
                rods = len(self.line.throw_of(number).cylinders) if self.line else 1
                pin = shaft.pin_diameter, shaft.pin_length / rods
            yield RodPin(f"crank pin{of}", forces, pin, "crank_pin")
        crosshead: Size = None, None
        if friction:
            crosshead = friction.crosshead_pin_diameter, friction.crosshead_pin_length
        yield RodPin(f"crosshead pin{of}", forces, crosshead, "crosshead_pin")

    def _main_bearings(self) -> Iterator[MainBearing]:
        """Yield the main bearings along the shaft, two of them A and B, more of them numbered."""
        if self.line is None:
            return
        shaft = self.line.shaft
        diameters = [shaft.journal_diameter]
        for cylinder in self.machine.cylinders:
            if cylinder.friction:
                diameters.append(cylinder.friction.journal_diameter)
        stated = [diameter for diameter in diameters if diameter is not None]
        size = stated[0] if stated else None, shaft.journal_length
        count = self.line.bearings
        names = "AB" if count == 2 else range(1, count + 1)
        for number, name in enumerate(names):
            yield MainBearing(f"bearing {name}", number, self.line, self._cylinders, size)


def _loads_pins(forces: CylinderForces) -> bool:
    """Return whether a force acts in a cylinder that has a connecting rod."""
    return forces.drive.has_force and bool(forces.drive.mechanism.has_rod)
