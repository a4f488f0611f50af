"""The strength of one crankshaft over the whole cycle, and where each of its parts is strained most (G)."""

import math
from collections.abc import Callable, Iterable
from functools import cached_property, partial
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.crank_angle import CrankAngle
from kurbel.declared.units import GRAVITY
from kurbel.errors import UsageError
from kurbel.machine import Machine
from kurbel.machine.crankshaft import Crankshaft
from kurbel.numerics.extreme import Extreme
from kurbel.numerics.grid import Grid, Pieces, integral
from kurbel.numerics.search import Evaluate, Extremes, Sampled, extremes, zeros
from kurbel.solver.cylinder.forces import CylinderForces
from kurbel.solver.cylinder.pins import on_pin
from kurbel.solver.cylinder.state import State
from kurbel.solver.figures import Columns, Results, passed_on
from kurbel.solver.shaft.statics import FreeBody, Vector, equilibrium_residual, flywheel_weight, norm
from kurbel.solver.strength.places import PARTS, Place, Stresses, places

Asked = Callable[[FreeBody], dict[str, Any]]
"""Jets by name that a body gives."""


class Strained(NamedTuple):
    """One place under the forces at one crank angle in degrees: its stresses, and both combinations, in Pa."""

    place: Place
    degrees: float
    stresses: Stresses
    combined: float
    von_mises: float


class CrankshaftStrength(Results):
    """What `kurbel stress` answers: statics and stresses of the only crank throw of a machine.

    Raises UsageError where the machine has no crankshaft, more than one cylinder, or no pressure that loads it.
    """

    command = "stress"

    def __init__(self, machine: Machine, cylinders: tuple[CylinderForces, ...]) -> None:
        obstacle = machine.strength_obstacle
        if obstacle or machine.crankshaft is None:
            raise UsageError(f"{machine.name}: {obstacle}")
        self.machine = machine
        self.shaft: Crankshaft = machine.crankshaft
        self.forces = cylinders[0]
        self.places = places(self.shaft)

    # loads

    @property
    def weight(self) -> float | None:
        """Weight of the flywheel in N that counts; None where there is none, or its direction is not known."""
        if self.forces.drive.cylinder.inclination is None or not self.shaft.flywheel_mass:
            return None
        return self.shaft.flywheel_mass * GRAVITY

    def _body(self, pin: Vector, angle: CrankAngle) -> FreeBody:
        cylinder = self.forces.drive.cylinder
        return FreeBody(self.shaft, cylinder.mechanism.crank, pin, flywheel_weight(self.machine, cylinder, angle))

    @property
    def C_rod(self) -> float | None:
        """Centrifugal force in N of the connecting rod's turning part that D does not contain; None without one."""
        return self.forces.drive.rod_pull or None

    def _running(self, state: State) -> FreeBody:
        return self._body(on_pin(state), state.angle)

    def _columns(self, phi: Array, within: Array) -> Columns:
        """Return forces on pin (D, T: of the rod alone, R 302 and 303) and bearings, and the stresses of each part."""
        state = self.forces.drive.at(phi, within)
        body = self._running(state)
        found = dict(zip(("D", "T", "A_D", "A_T", "B_D", "B_T"), (state.D, state.T, *body.A, *body.B)))
        for part in PARTS:
            own = [(place.stresses(body), place.alpha) for place in self.places if place.part == part]
            found[f"sigma_{part}"] = _largest([one.combined(alpha) for one, alpha in own])
            found[f"mises_{part}"] = _largest([one.von_mises() for one, _ in own])
        return Columns(phi, {id: partial(found.get, id) for id in found})

    breaks = passed_on("_grid", "breaks", "The crank angles in degrees between which every quantity is smooth.")

    # the cycle

    @cached_property
    def _grid(self) -> Grid:
        """The cycle in smooth pieces, cut also where a stress changes its sign: its magnitude has a kink there."""
        grid = self.forces.grid
        found = zeros(grid, self._on(grid, _with_kinks), self._evaluated(_with_kinks))
        return grid.split_at(np.concatenate(tuple(found.values())))

    def _on(self, grid: Grid, asked: Asked) -> dict[str, Sampled]:
        """Return what is asked of the body, on a grid."""
        samples = self._sampled(asked, State(self.forces.drive, CrankAngle.at_nodes(grid).jets, grid.within))
        if not all(np.isfinite(sampled.value).all() for sampled in samples.values()):
            raise UsageError(
                f"{self.machine.name}: the stresses of the crankshaft are too large to compute with: "
                "check the numbers and units of the machine file"
            )
        return samples

    def _evaluated(self, asked: Asked) -> Evaluate:
        return lambda degrees, within: self._sampled(asked, self.forces.drive.jets_at(degrees, within))

    def _sampled(self, asked: Asked, state: State) -> dict[str, Sampled]:
        return {name: Sampled.of(jet, state.phi.shape) for name, jet in asked(self._running(state)).items()}

    def _quantities(self, body: FreeBody) -> dict[str, Any]:
        stresses = [place.stresses(body) for place in self.places]
        found = {f"combined {i}": one.combined(self.places[i].alpha) for i, one in enumerate(stresses)}
        found |= {f"von Mises {i}": one.von_mises() for i, one in enumerate(stresses)}
        return found | {"pin": norm(*body.pin), "A": norm(*body.A), "B": norm(*body.B)}

    @cached_property
    def _samples(self) -> dict[str, Sampled]:
        return self._on(self._grid, self._quantities)

    @cached_property
    def _extremes(self) -> dict[str, Extreme]:
        """The largest of every quantity over the cycle: exact roots of the slopes that the jets carry."""
        found = extremes(self._grid, self._samples, self._evaluated(self._quantities))
        return {name: both.largest for name, both in found.items()}

    def _body_beside(self, degrees: float, quantity: Any, value: float) -> FreeBody:
        """Return the body at an angle, on that side of a jump on which quantity(body) is nearest to the value."""
        middles = (self._grid.breaks[:-1] + self._grid.breaks[1:]) / 2
        reach = np.diff(self._grid.breaks) / 2 + 1e-9
        sides = middles[np.abs(middles - degrees) <= reach]
        angle = CrankAngle.of(np.full(len(sides), degrees))
        found = np.asarray(quantity(self._running(State(self.forces.drive, angle, sides))))
        chosen = sides[[int(np.abs(found - value).argmin())]]
        return self._running(State(self.forces.drive, CrankAngle.of(np.array([degrees])), chosen))

    # the two positions of the book, and the worst of the cycle

    @cached_property
    def full_force(self) -> Extreme:
        """The largest piston force without inertia in N, and the dead centre in degrees in which the throw takes it.

        Starting and slow running (R p. 608): the inner dead centre, or the outer one where pulling is stronger.
        """
        found, motion = self._force_extremes("P_start"), self.forces.motion
        assert motion.phi_idc is not None
        assert motion.phi_odc is not None
        if found.largest.value >= -found.smallest.value:
            return Extreme(found.largest.value, motion.phi_idc)
        return Extreme(found.smallest.value, motion.phi_odc)

    @cached_property
    def largest_torque(self) -> Extreme:
        """The largest T in N, or the smallest where the machine is driven harder than it drives, and its angle."""
        return max(self._force_extremes("T"), key=lambda extreme: abs(extreme.value))

    def _force_extremes(self, column: str) -> Extremes:
        _ = self._samples  # forces that are too large are refused before they are searched
        found = self.forces.extremes_of(column)
        assert found is not None
        return found

    @cached_property
    def at_dead_centre(self) -> tuple[Strained, ...]:
        """Every place in the firing dead centre under the full force of the pressure: T = 0, D = P cos(φ+ψ)/cos ψ."""
        force, degrees = self.full_force.value, self.full_force.degrees
        angle = CrankAngle.of(np.array([degrees]))
        pin = Vector(force * np.asarray(self.forces.drive.mechanism.radial(angle)), np.zeros(1))
        body = self._body(pin, angle)
        return tuple(_strained(place, degrees, body) for place in self.places)

    @cached_property
    def at_largest_torque(self) -> tuple[Strained, ...]:
        """Every place in the position of the largest torque."""
        torque, degrees = self.largest_torque.value, self.largest_torque.degrees
        body = self._body_beside(degrees, lambda body: body.pin.T, torque)
        return tuple(_strained(place, degrees, body) for place in self.places)

    @cached_property
    def at_worst(self) -> tuple[Strained, ...]:
        """Every place at the crank angle of the running machine at which its own combined stress is largest."""
        worst = []
        for index, place in enumerate(self.places):
            largest = self._extremes[f"combined {index}"]
            body = self._body_beside(largest.degrees, place.combined, largest.value)
            worst.append(_strained(place, largest.degrees, body))
        return tuple(worst)

    def sigma_dc(self, part: str) -> Extreme | None:
        """Return the largest combined stress of a part in Pa in the dead centre; None for one that is not examined."""
        return _worst(part, self.at_dead_centre)

    def sigma_max(self, part: str) -> Extreme | None:
        """Return the largest combined stress of a part in Pa over the cycle, and its crank angle."""
        return _worst(part, self.at_worst)

    def mises_max(self, part: str) -> Extreme | None:
        """Return the largest stress of a part after von Mises in Pa over the cycle, and its crank angle."""
        return _highest(self._extremes[f"von Mises {i}"] for i, place in enumerate(self.places) if place.part == part)

    def safety(self, part: str) -> Extreme | None:
        """Return k_b over the largest combined stress of a part, dead centre and cycle; None without k_b or stress."""
        allowable = self.shaft.allowable_bending
        worst = _highest(one for one in (self.sigma_dc(part), self.sigma_max(part)) if one)
        return Extreme(allowable / worst.value, worst.degrees) if allowable and worst and worst.value else None

    # bearings

    def load_max(self, bearing: str) -> Extreme:
        """Return the largest force in N on `pin`, `A` or `B` over the cycle."""
        return self._extremes[bearing]

    def pressure_max(self, bearing: str) -> Extreme | None:
        """Return the largest force over the projected area d l in Pa; None where diameter or length is not given."""
        size, load = self._size(bearing), self.load_max(bearing)
        return Extreme(load.value / size[0] / size[1], load.degrees) if size else None

    def pressure_mean(self, bearing: str) -> float | None:
        """Return p_m in Pa: the mean over time, at uniform rotation, of the force over the projected area.

        On the pin that of the rod force alone, as G has it for its bounds on p_m v.
        """
        size = self._size(bearing)
        return self._mean_loads[bearing] / size[0] / size[1] if size else None

    @cached_property
    def _mean_loads(self) -> dict[str, float]:
        """Means over time in N of the force of the rod on the pin, and of the forces on both bearings."""

        def loads(pieces: Pieces) -> Array:
            state = State(self.forces.drive, CrankAngle.at_nodes(pieces))
            body = self._running(state)
            return np.stack([np.hypot(*force) for force in ((state.D, state.T), body.A, body.B)])

        found = integral(self._grid, loads) / math.radians(self.forces.drive.cycle)
        return dict(zip(("pin", "A", "B"), found.tolist(), strict=True))

    def pressure_velocity(self, bearing: str) -> float | None:
        """Return k = p_m v in W/m² with the surface speed v = π d n (G); None without a speed of rotation."""
        pressure, speed, size = self.pressure_mean(bearing), self.machine.speed, self._size(bearing)
        return None if pressure is None or speed is None or size is None else pressure * math.pi * size[0] * speed

    def _size(self, bearing: str) -> tuple[float, float] | None:
        shaft, diameter, length = self.shaft, self.shaft.journal_diameter, self.shaft.journal_length
        if bearing == "pin":
            return shaft.pin_diameter, shaft.pin_length
        return None if diameter is None or length is None else (diameter, length)

    @cached_property
    def pin_pressure_dc(self) -> float:
        """Full force over the projected area of the pin in Pa (G: P_max/(d_z l_z))."""
        return abs(self.full_force.value) / self.shaft.pin_diameter / self.shaft.pin_length

    @cached_property
    def equilibrium_residual(self) -> float:
        """What is left of the sums of forces and moments on the shaft, over the sizes of their terms, at its worst."""
        degrees = self._grid.degrees.ravel()
        state = State(self.forces.drive, CrankAngle.of(degrees), self._grid.within.ravel())
        return equilibrium_residual(self._running(state), np.asarray(state.torque))


def _with_kinks(body: FreeBody) -> dict[str, Any]:
    """Return the forces and moments whose magnitudes make stresses: where one passes zero, its magnitude has a kink."""
    in_plane, twist = body.moments_at(body.shaft.web_distance)
    # the web beyond the pin is bent out of plane as much at the pin as at the shaft
    ends = (body.before_pin.T - body.pin.T, body.before_pin.T + body.pin.T)
    found = (*body.pin, *body.A, body.force_beyond_pin, in_plane, twist, *ends)
    return {str(number): force for number, force in enumerate(found)}


def _largest(values: list[Any]) -> Any:
    return np.max(values, axis=0) if values else None


def _strained(place: Place, degrees: float, body: FreeBody) -> Strained:
    found = place.stresses(body)
    stresses = Stresses(*(None if value is None else _number(value) for value in found))
    return Strained(place, degrees, stresses, _number(found.combined(place.alpha)), _number(found.von_mises()))


def _number(value: Any) -> float:
    return float(np.asarray(value).ravel()[0])


def _worst(part: str, strained: tuple[Strained, ...]) -> Extreme | None:
    return _highest(Extreme(one.combined, one.degrees) for one in strained if one.place.part == part)


def _highest(found: Iterable[Extreme]) -> Extreme | None:
    return max(found, key=lambda extreme: extreme.value, default=None)
