"""What one pin or main bearing carries over the cycle: directions in every frame, means, pressures, friction."""

import math
from abc import abstractmethod
from collections.abc import Sequence
from functools import cached_property, partial
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.numerics.extreme import Extreme
from kurbel.numerics.grid import Cuts, Grid, Pieces, integral
from kurbel.numerics.search import Curve, Extremes, Sampled, curves, extremes_of, sign_changes, zeros
from kurbel.solver.bearings.directions import Plane, Unloaded, axial, unloaded
from kurbel.solver.cylinder.following import Following
from kurbel.solver.cylinder.pins import bends_of_size
from kurbel.solver.figures import Columns, Results, passed_on
from kurbel.solver.shaft.statics import norm

FRAMES = ("throw", "engine", "rod")
_NO_LOAD = 1e-12
"""A load no larger than this beside the largest one is rounding and has no direction."""
_ON_AXIS = 1e-12
"""Degrees by which rounding turns a load aside that is along the axis of a frame, as that of a rod without mass."""


class Loads(NamedTuple):
    """A load in the frames that it has, and by how much its surfaces turn on one another, over that of the crank."""

    frames: dict[str, Plane]
    rate: Any = 1.0


class Size(NamedTuple):
    """Diameter and length in m, None where they are not given."""

    diameter: float | None
    length: float | None


class Bearing(Results):
    """A pin or a main bearing at the angles of crank 1. Attributes are named by the ids of the key values, in SI.

    name: as it is printed; followed: the cylinders that load it; size; journal, shell: the frames in which its two
    surfaces stand still; contact: degrees from the direction of the load to where they touch; of_rod: whether a rod
    of a cylinder turns on it.
    """

    command = "bearings"
    journal: str
    shell: str
    contact = 180.0
    of_rod = False

    def __init__(self, name: str, followed: Sequence[Following], size: Size) -> None:
        self.name = name
        self.followed = tuple(followed)
        self.size = size
        self.omega = followed[0].drive.omega

    @abstractmethod
    def loads(self, degrees: Array, within: Array) -> Loads:
        """Return the load, as jets, at angles (n,) of crank 1 in degrees, on the sides of jumps that hold `within`."""

    @property
    @abstractmethod
    def work_rubbing(self) -> float | None:
        """Work of its friction in J per cycle of the machine; None without a coefficient."""

    def _columns(self, phi: Array, within: Array) -> Columns:
        """Return the load in N, and its direction in degrees in each frame; None without it."""
        found = self._evaluate(phi, within)

        def direction(frame: str) -> Array | None:
            return axial(found[frame].value, _ON_AXIS) if frame in found else None

        directions = {f"load_{frame}": partial(direction, frame) for frame in FRAMES}
        return Columns(phi, {"load": lambda: found["load"].value, **directions})

    # the cycle

    breaks = passed_on("_grid", "breaks", "The crank angles in degrees between which every quantity is smooth.")

    def _evaluate(self, degrees: Array, within: Array) -> dict[str, Sampled]:
        """Return size and directions of the load, and the rate at which its surfaces rub."""
        with np.errstate(all="ignore"):  # a load of 0 has no direction
            loads = self.loads(degrees, within)
            found = {name: plane.direction for name, plane in loads.frames.items()}
            found |= {"load": norm(*next(iter(loads.frames.values()))), "rate": loads.rate}
        return {name: Sampled.of(one, degrees.shape) for name, one in found.items()}

    @cached_property
    def _grid(self) -> Grid:
        """The cycle in smooth pieces, cut also where a component of the load is zero and where its size bends."""
        grid = Cuts.joined([one.cuts for one in self.followed]).grid()

        def load(degrees: Array, within: Array) -> list[tuple[Sampled, Sampled]]:
            along, across = next(iter(self.loads(degrees, within).frames.values()))
            return [(Sampled.of(along, degrees.shape), Sampled.of(across, degrees.shape))]

        def components(degrees: Array, within: Array) -> dict[str, Sampled]:
            return dict(zip(("along", "across"), *load(degrees, within)))

        found = zeros(grid, components(grid.degrees, grid.within), components)
        return grid.split_at(np.concatenate((*found.values(), bends_of_size(grid, load))))

    @cached_property
    def _curves(self) -> dict[str, Curve]:
        return curves(self._grid, self._evaluate(self._grid.degrees, self._grid.within), self._evaluate)

    @cached_property
    def _load(self) -> Extremes:
        return extremes_of(self._curves["load"])

    load_max = passed_on("_load", "largest", "Largest load in N.")
    load_min = passed_on("_load", "smallest", "Smallest load in N.")

    @cached_property
    def _means(self) -> tuple[float, float]:
        """Means over time of the load in N, and of the rate."""

        def both(pieces: Pieces) -> Array:
            found = self._evaluate(pieces.degrees, pieces.within)
            return np.stack([found["load"].value, np.abs(found["rate"].value)])

        load, rate = integral(self._grid, both) / math.radians(self._grid.breaks[-1])
        return float(load), float(rate)

    @property
    def load_mean(self) -> float:
        """Mean load in N over the time of a cycle."""
        return self._means[0]

    @cached_property
    def load_high(self) -> float:
        """Mean load in N over the time in which it exceeds half its largest."""
        half, whole = self.load_max.value / 2, self._curves["load"]
        if not half:
            return 0.0

        def beyond(degrees: Array, within: Array) -> dict[str, Sampled]:
            found = self._evaluate(degrees, within)["load"]
            return {"load": Sampled(found.value - half, found.slope)}

        passed = sign_changes(self._grid, {"load": whole.less(half)}, beyond, 2 * half)["load"]

        def high(pieces: Pieces) -> Array:
            middle = pieces.within[:, :1]
            above = np.where(beyond(middle, middle)["load"].value > 0, 1.0, 0.0)
            return np.stack(
                [self._evaluate(pieces.degrees, pieces.within)["load"].value * above, above + pieces.degrees * 0]
            )

        load, time = integral(self._grid.split_at(passed), high)
        return float(load / time)

    # the surfaces

    def _unloaded(self, frame: str) -> Unloaded | None:
        """Return the arc of the surface that stands still in a frame; None where it is loaded nowhere."""
        curve = self._curves[frame]
        load, setting_out = self._load_and_slope(frame, curve)
        loaded = load.size > _NO_LOAD * self.load_max.value
        if not loaded.any():
            return None
        end = np.diff(curve.row, prepend=-1).astype(bool) | np.diff(curve.row, append=-1).astype(bool)
        vanishing = end & (setting_out.size > 0) & np.isin(curve.row, curve.row[loaded])
        told = np.flatnonzero(loaded | vanishing)
        direction = np.where(loaded, curve.value, setting_out.direction)[told]
        joined = (np.diff(told) == 1) & (np.diff(curve.row[told]) == 0)
        return unloaded(direction + self.contact, joined)

    def _load_and_slope(self, frame: str, curve: Curve) -> tuple[Plane, Plane]:
        """Return the load at the points of a curve, and its slope per degree into the piece.

        Where a load passes zero it turns by half, and its pieces begin and end in the direction of that slope.
        """
        loads = self.loads(curve.degrees, curve.within).frames[frame]
        along, across = (Sampled.of(one, curve.degrees.shape) for one in loads)
        inward = np.sign(curve.within - curve.degrees)
        return Plane(along.value, across.value), Plane(along.slope * inward, across.slope * inward)

    @cached_property
    def _of_journal(self) -> Unloaded | None:
        return self._unloaded(self.journal)

    @cached_property
    def _of_shell(self) -> Unloaded | None:
        return self._unloaded(self.shell)

    unloaded_arc = passed_on("_of_journal", "arc", "Degrees of the surface of pin or journal that are never loaded.")
    unloaded_middle = passed_on("_of_journal", "middle", "Direction in degrees of the middle of its widest piece.")
    unloaded_arc_shell = passed_on("_of_shell", "arc", "Degrees of the surface of the shell that are never loaded.")
    unloaded_middle_shell = passed_on("_of_shell", "middle", "Direction in degrees of the middle of its widest piece.")

    # pressures and rubbing

    @property
    def _area(self) -> float | None:
        diameter, length = self.size
        return diameter * length if diameter and length else None

    @property
    def pressure_max(self) -> Extreme | None:
        """Largest load over d l in Pa."""
        return None if self._area is None else Extreme(self.load_max.value / self._area, self.load_max.degrees)

    @property
    def pressure_mean(self) -> float | None:
        """Mean load over d l in Pa."""
        return None if self._area is None else self.load_mean / self._area

    @property
    def _surface_speed(self) -> float | None:
        """ω d/2 in m/s."""
        diameter = self.size.diameter
        return None if self.omega is None or not diameter else self.omega * diameter / 2

    @property
    def rubbing_speed_max(self) -> Extreme | None:
        """Largest speed in m/s of one surface on the other."""
        if self._surface_speed is None:
            return None
        rate = extremes_of(self._curves["rate"]).peak
        return Extreme(rate.value * self._surface_speed, rate.degrees)

    @property
    def rubbing_speed_mean(self) -> float | None:
        """Mean speed in m/s of one surface on the other."""
        return None if self._surface_speed is None else self._means[1] * self._surface_speed

    @property
    def pressure_velocity(self) -> float | None:
        """Mean pressure times mean speed, p_m v in W/m²."""
        pressure, speed = self.pressure_mean, self.rubbing_speed_mean
        return None if pressure is None or speed is None else pressure * speed
