"""Strength of a crankshaft with one throw, between two bearings or overhung: stresses over the whole cycle (G).

Stresses are looked at in these places, part by part:

    pin        middle          bent by A on the lever a, twisted by A_T r (G)
               at web A, B     bent by A, and by A and the force on the pin; twisted by A_T r as all of the pin
    web        wide face       compressed and bent in the plane of the throw, twisted: decisive for the shape (G)
               narrow face     compressed and bent out of that plane, twisted less
               corner          compressed and bent both ways, not twisted
    journal A  at web          bent by A on the lever up to web A
    journal B  at web          bent by A and the pin, twisted by T r; the shaft as far as B counts as journal
               at flywheel     the same, where the flywheel is before B
               in bearing      bent by the flywheel overhung beyond B, twisted by T r

Along the pin and along each journal the moments are straight lines from load to load, under the same torsion: their
vector sum is largest at a load or at an end, so that no section between these places is strained more. The force on the
pin acts in its middle, the forces of the bearings in theirs.

An overhung crank has a pin clamped at its only end, in web A, which is loaded as a web B with nothing before the pin;
journal A is bent by F and twisted by T r, at the web and in its bearing, and the shaft beyond counts as journal B.

A web is bent out of the plane of the throw most at one end of its arm, at the axis of the pin or at that of the shaft.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, Number
from kurbel.crank_angle import CrankAngle
from kurbel.errors import UsageError
from kurbel.machine import Machine
from kurbel.machine.batch import taken
from kurbel.machine.crankshaft import Crankshaft
from kurbel.numerics.arithmetic import every, magnitude, some, where
from kurbel.numerics.extreme import Extreme, Extremes, chosen, largest
from kurbel.numerics.pieces import Pieces, highest, resolved
from kurbel.quantity import Heading, ValuesById, value, values_for
from kurbel.solver.figures import AtAngles, Results
from kurbel.solver.forces import CylinderForces
from kurbel.solver.shaft import FreeBody, flywheel_weight
from kurbel.solver.state import State, on_pin
from kurbel.solver.vector import Force

PARTS = {
    "pin": ("pin", "the crank pin"),
    "web_A": ("w,A", "web A"),
    "web_B": ("w,B", "web B"),
    "journal_A": ("j,A", "journal A"),
    "journal_B": ("j,B", "journal B"),
}
"""Parts of a crankshaft: the index of their symbols, and what they are called in a sentence."""
_BEARINGS = {part: PARTS[part] for part in ("pin", "journal_A", "journal_B")}
"""Parts that are pressed: by the rod, and by bearings A and B."""

# Stresses in a section: numbers or arrays in N, N m and m give Pa. They divide by one length at a time: the product of
# three tiny ones would be zero.


class Place(NamedTuple):
    """The stresses in Pa at one place of a part; None for what there cannot be there.

    compression is positive, and negative where the web is pulled; bendings and torsion are magnitudes. normal: all
    normal stress together, a magnitude. alpha: α₀ of Bach's combination. degrees: crank angle of the forces, if one.
    """

    part: str
    name: str
    alpha: Number
    compression: Number | None
    bending_in_plane: Number | None
    bending_out_of_plane: Number | None
    torsion: Number | None
    normal: Number
    degrees: Any = None

    @property
    def combined(self) -> Any:
        """Combined stress 0.35 σ + 0.65 √(σ² + 4 (α₀ τ)²) in Pa after Bach (G, "Resultierende Beanspruchung")."""
        torsion = 0.0 if self.torsion is None else self.torsion
        return 0.35 * magnitude(self.normal) + 0.65 * np.hypot(
            self.normal, 2 * self.alpha * torsion
        )

    @property
    def von_mises(self) -> Any:
        """Equivalent stress √(σ² + 3 τ²) in Pa after von Mises."""
        return np.hypot(self.normal, 0.0 if self.torsion is None else math.sqrt(3) * self.torsion)

    def one_of(self, number: int, degrees: float) -> Place:
        """Return the place at a crank angle in one of several states."""
        own: dict[str, Any] = {
            name: float(each[number]) for name, each in self._asdict().items() if np.ndim(each)
        }
        return self._replace(**own, degrees=degrees)


def places(body: FreeBody) -> Iterator[Place]:
    """Yield the places of a crankshaft under its forces; those of the journals only where their diameter is given.

    α₀ is 1 for what is round (G, for the pin), and that of the allowable stresses for the webs.
    """
    shaft, f, diameter = body.shaft, body.shaft.flywheel_position, body.shaft.journal_diameter
    inner, outer = (
        shaft.web_distance + side * shaft.web_thickness / 2 for side in (-1, 1)
    )  # faces of a web
    before = body.before_pin.imag * body.crank
    # in the middle of the pin M_b = a √(A_T² + A_D²) and M_d = A_T r (G)
    sections = (
        {"at web A": inner}
        if shaft.overhung
        else {"middle": 0.0, "at web A": -inner, "at web B": inner}
    )
    for name, u in sections.items():
        yield _round("pin", name, body.moments_at(u), before, shaft.pin_diameter)

    at_pin, at_shaft = magnitude(before), magnitude(body.torque)
    worse = where(
        at_pin >= at_shaft, at_pin, at_shaft
    )  # of the ends of the web between pin and shaft
    if not shaft.overhung:
        yield from _web(
            "web_A", shaft, body.before_pin.real, body.moments_at(-shaft.web_distance), at_pin
        )
    last_web = "web_A" if shaft.overhung else "web_B"
    yield from _web(last_web, shaft, body.along_web, body.moments_at(shaft.web_distance), worse)

    if diameter is None:
        return
    if shaft.overhung:
        yield _round("journal_A", "at web", body.moments_at(outer), body.torque, diameter)
        yield _round("journal_A", "in bearing", body.moments_at(shaft.a), body.torque, diameter)
    else:
        yield _round("journal_A", "at web", body.moments_at(-outer), None, diameter)
        yield _round("journal_B", "at web", body.moments_at(outer), body.torque, diameter)
    beyond = f >= 0  # of bearing B, in whose middle the bending is G f
    bending = np.where(beyond, body.weight * f, body.moments_at(shaft.b + f))
    name = "in bearing" if every(beyond) else "at flywheel"
    yield _round("journal_B", name, bending, body.torque, diameter)


def _round(part: str, name: str, moments: Force, torque: Number | None, diameter: Number) -> Place:
    """Stresses at the surface of a round section, whose bendings add up as vectors (G).

    Bending σ = 32 M/(π d³), torsion τ = 16 M/(π d³).
    """
    bendings = (
        magnitude(32 / math.pi * one / diameter / diameter / diameter)
        for one in (moments.real, moments.imag)
    )
    in_plane, out_of_plane = bendings
    torsion = (
        None
        if torque is None
        else magnitude(16 / math.pi * torque / diameter / diameter / diameter)
    )
    return Place(
        part, name, 1.0, None, in_plane, out_of_plane, torsion, np.hypot(in_plane, out_of_plane)
    )


def _web(
    part: str, shaft: Crankshaft, force: Number, moments: Force, out_of_plane: Number
) -> Iterator[Place]:
    """Stresses of a web, a rectangle t × w: σ = S/(t w) + 6 M/(b h²) across h (G, webs, "auf Druck", "auf Biegung").

    force: along it; moments: in-plane bending and twist. α₀ = k_b/(1.3 k_d), or 1 where one of the allowable stresses
    is not known (G): with it a part under torsion alone is fully used just where τ reaches k_d.

    Its torsion is τ = (9/2) M_d/(t² w) in the middle of the wide faces and (9/2) M_d/(t w²) in that of the narrow ones
    (G, webs, "auf Drehung"): Bach's rounded factor; de Saint-Venant's own is 4.81 for a square and 3 for a strip.
    """
    t, w, allowed, twisting = (
        shaft.web_thickness,
        shaft.web_width,
        shaft.allowable_bending,
        shaft.allowable_torsion,
    )
    alpha = 1.0 if allowed is None or twisting is None else allowed / (1.3 * twisting)
    direct, twist = force / t / w, 4.5 * magnitude(moments.imag)
    wide, narrow = magnitude(6 * moments.real / w / t / t), 6 * out_of_plane / t / w / w
    yield Place(
        part, "wide face", alpha, direct, wide, None, twist / t / t / w, magnitude(direct) + wide
    )
    yield Place(
        part,
        "narrow face",
        alpha,
        direct,
        None,
        narrow,
        twist / w / w / t,
        magnitude(direct) + narrow,
    )
    yield Place(
        part, "corner", alpha, direct, wide, narrow, None, magnitude(direct) + wide + narrow
    )


class StressColumns(AtAngles):
    """Forces and stresses of one machine at crank angles φ (n,) in degrees; state: of its cylinder there."""

    commands = ("stress",)
    D = value("D", "force", "Radial force at the crank pin, positive toward the shaft")
    T = value("T", "force", "Tangential force M/R: the torque on the shaft over the crank radius")
    T_pin = value(
        "T_Z",
        "force",
        "Tangential force of the rod on the crank pin, where its friction makes it another",
    )
    A_D = value("A_D", "force", "Force on bearing A along D, in the frame rotating with the throw")
    A_T = value("A_T", "force", "Force on bearing A along T")
    B_D = value("B_D", "force", "Force on bearing B, next to the flywheel, along D")
    B_T = value("B_T", "force", "Force on bearing B along T")
    sigma = values_for(PARTS, "sigma_*", "σ_*", "stress", "Largest combined stress of * (Bach)")
    mises = values_for(
        PARTS, "mises_*", "σ_v,*", "stress", "Largest equivalent stress of * (von Mises)"
    )

    def __init__(self, phi: Array, state: State, body: FreeBody) -> None:
        self.phi, self._state, self._body = phi, state, body

    @cached_property
    def answers(self) -> ValuesById:
        """The columns by id; of the stresses those of the parts that are examined."""
        A, B = self._body.A, self._body.B
        state = self._state
        found = {
            "D": state.D,
            "T": state.T,
            "A_D": A.real,
            "A_T": A.imag,
            "B_D": B.real,
            "B_T": B.imag,
        }
        if state.T_pin is not None:
            found["T_pin"] = state.T_pin
        for place in places(self._body):
            for id, stress in (
                (f"sigma_{place.part}", place.combined),
                (f"mises_{place.part}", place.von_mises),
            ):
                found[id] = np.maximum(found.get(id, 0.0), stress)
        return found


class CrankshaftStrength(Results):
    """What `kurbel stress` computes: statics and stresses of the only crank throw of a machine.

    Raises UsageError where the machine has no crankshaft, more than one cylinder, or no pressure that loads it. Of many
    machines the key values are arrays (machines,).
    """

    command = "stress"
    state = StressColumns

    _loads = Heading("Loads")
    P_dc = value(
        "P_dc",
        "force",
        "Full piston force, without inertia, applied at the dead centre",
        lambda one: one.full_force,
    )
    C_rod = value(
        "C_r",
        "force",
        "Centrifugal force of the rotating part of the connecting rod, not included in D",
    )
    _stresses = Heading("Stresses")
    sigma_dc = values_for(
        PARTS,
        "sigma_*_dc",
        "σ_*,dc",
        "stress",
        "Combined stress of * in the dead centre under full force (Bach)",
        group=str,
    )
    sigma_max = values_for(
        PARTS,
        "sigma_*_max",
        "σ_*,max",
        "stress",
        "Largest combined stress of * over the cycle (Bach)",
        group=str,
    )
    mises_max = values_for(
        PARTS,
        "mises_*_max",
        "σ_v,*,max",
        "stress",
        "Largest equivalent stress of * over the cycle (von Mises)",
        group=str,
    )
    safety = values_for(
        PARTS,
        "safety_*_min",
        "S_*",
        "ratio",
        "Smallest safety of *: k_b over its combined stress, dead centre and cycle",
        group=str,
    )
    _bearings = Heading("Bearings")
    A_max = value("A_max", "force", "Largest force on bearing A")
    B_max = value("B_max", "force", "Largest force on bearing B, next to the flywheel")
    p_pin_dc = value("p_pin,dc", "pressure", "Pressure on the crank pin under full force, P/(d l)")
    pressure_max = values_for(
        _BEARINGS,
        "p_*_max",
        "p_*,max",
        "pressure",
        "Largest pressure on * over the cycle, force over d l",
        group=str,
    )
    pressure_mean = values_for(
        _BEARINGS,
        "p_*_mean",
        "p_*,m",
        "pressure",
        "Mean pressure on * over the time of a cycle",
        after="p_*_max",
        group=str,
    )
    pressure_velocity = values_for(
        _BEARINGS,
        "k_*",
        "k_*",
        "pressure_velocity",
        "Mean pressure times surface speed, p_m v, of *",
        after="p_*_mean",
        group=str,
    )
    _checks = Heading("Checks")
    equilibrium_residual = value(
        "ΣF, ΣM",
        "ratio",
        "Residual of the equilibrium of forces and moments on the crankshaft",
        lambda one: one.unbalanced(),
        plain="sum F, M",
        residual=True,
    )

    def __init__(self, machine: Machine, cylinders: Sequence[CylinderForces]) -> None:
        obstacle = machine.strength_obstacle
        if obstacle or machine.crankshaft is None:
            raise UsageError(f"{machine.name}: {obstacle}")
        self.machine = machine
        self.shaft: Crankshaft = machine.crankshaft
        self.forces = cylinders[0]
        self.count = self.forces.drive.count

    def _body(self, pin: Force, angle: CrankAngle, pieces: Pieces | None = None) -> FreeBody:
        """Return the throw under a force on its pin at crank angles: of the nodes of pieces, or one of each machine."""
        several = pieces is not None and self.count is not None
        machine = (
            taken(self.machine, pieces.machine) if pieces is not None and several else self.machine
        )
        (cylinder,), shaft = machine.cylinders, machine.crankshaft
        assert shaft is not None
        return FreeBody(
            shaft, cylinder.mechanism.crank, pin, flywheel_weight(machine, cylinder, angle)
        )

    def _columns(self, phi: Array, within: Array) -> StressColumns:
        state = State.at(self.forces.drive, phi, within)
        return StressColumns(phi, state, self._body(on_pin(state).complex, state.angle))

    # the cycle

    @cached_property
    def _cycle(self) -> tuple[Pieces, Array, Array]:
        """The cycle on pieces on which the loads are polynomials and no stress has a kink, cut where one is zero.

        Besides the pieces D and T of the whole force on the pin in N, and what the rod itself adds to D; magnitudes in
        N of the forces on pin, A and B, and of the rod force. Each (…, nodes, pieces). Raises UsageError where the
        stresses of the only machine are no finite numbers.
        """
        pieces, state = self.forces.pieces, self.forces.samples
        pin = on_pin(state)
        body = self._body(pin.complex, state.angle, pieces)
        if self.count is None and not all(
            np.isfinite(one.combined + one.von_mises).all() for one in places(body)
        ):
            raise UsageError(
                f"{self.machine.name}: the stresses of the crankshaft are too large to compute with: "
                "check the numbers and units of the machine file"
            )
        bends, at_pin, at_shaft = (
            body.moments_at(body.shaft.web_distance),
            body.before_pin.imag,
            body.pin.imag,
        )
        both = [part for one in (body.pin, body.A, bends) for part in (one.real, one.imag)]
        # the web beyond the pin is bent out of plane as much at the pin as at the shaft
        kinked = (*both, body.along_web, at_pin - at_shaft, at_pin + at_shaft, state.D)
        kinks = np.stack([*map(pieces.filled, kinked)])
        parts = np.stack([*map(pieces.filled, (*pin, state.D - pin.D))])

        def magnitudes(some: Pieces, found: Array) -> Array:
            D, T, own = found
            body = self._body(D + 1j * T, CrankAngle.at_nodes(some), some)
            return np.abs(np.stack((body.pin, body.A, body.B, D + own + 1j * T)))

        fine, loads, found = resolved(pieces, parts, kinks, pieces.largest(kinks), magnitudes)
        return fine, found, np.asarray(loads)

    @property
    def breaks(self) -> Array:
        """The crank angles in degrees of the only machine between which every quantity is smooth."""
        return self._cycle[0].ends

    @cached_property
    def _largest(self) -> list[Extreme]:
        """The largest of Bach's stresses over the cycle, then of von Mises', of every place."""

        def stresses(some: Pieces, pin: Array) -> list[Array]:
            found = [*places(self._body(pin[0] + 1j * pin[1], CrankAngle.at_nodes(some), some))]
            return [*(one.combined for one in found), *(one.von_mises for one in found)]

        return [
            Extreme(*map(self.forces.result, pair))
            for pair in zip(*highest(*self._cycle[:2], stresses))
        ]

    @cached_property
    def answers(self) -> ValuesById:
        """The key values by id; stresses of the parts that are examined, the safety where k_b is given."""
        shaft, pull, allowable = (
            self.shaft,
            self.forces.drive.rod_centrifugal_force,
            self.shaft.allowable_bending,
        )
        found = self._of_loads()
        found["C_rod"] = pull if some(pull != 0) else None
        found["p_pin_dc"] = (
            abs(self.full_force.value) / shaft.pin_diameter / shaft.pin_length
        )  # G: P_max/(d_z l_z)
        at = self.at_dead_centre
        rows = [*zip(at, self._largest[: len(at)], self._largest[len(at) :])]
        for part in dict.fromkeys(place.part for place in at):
            own = [row for row in rows if row[0].part == part]
            resting = largest(*(Extreme(place.combined, place.degrees) for place, _, _ in own))
            turning = largest(*(bach for _, bach, _ in own))
            found[f"sigma_{part}_dc"], found[f"sigma_{part}_max"] = resting.value, turning
            found[f"mises_{part}_max"] = largest(*(mises for _, _, mises in own))
            worst = largest(resting, turning)
            if allowable is not None and not every(worst.value == 0):
                safety = allowable / where(worst.value == 0, math.nan, worst.value)
                found[f"safety_{part}_min"] = Extreme(safety, worst.degrees)
        return found

    def _of_loads(self) -> ValuesById:
        """The key values of the loads by id, pressures of what has a diameter and length, p_m v where a speed is given.

        The mean on the pin is that of the rod force alone, as G has it for its bounds on p_m v, v = π d n.
        """
        (pieces, _, loads), shaft, speed = self._cycle, self.shaft, self.machine.speed
        extremes = pieces.extremes(loads[:3])
        most = [
            Extreme(*map(self.forces.result, pair))
            for pair in zip(extremes.largest, extremes.largest_at)
        ]
        mean_A, mean_B, of_rod = map(self.forces.result, pieces.mean(loads[1:]))
        found: ValuesById = {"A_max": most[1], "B_max": most[2]}
        for part, load, mean in zip(_BEARINGS, most, (of_rod, mean_A, mean_B)):
            diameter, length = shaft.journal_diameter, shaft.journal_length
            if part == "pin":
                diameter, length = shaft.pin_diameter, shaft.pin_length
            if diameter is not None and length is not None:
                found[f"p_{part}_max"] = Extreme(load.value / diameter / length, load.degrees)
                found[f"p_{part}_mean"] = pressure = mean / diameter / length
                found[f"k_{part}"] = (
                    None if speed is None else pressure * math.pi * diameter * speed
                )
        return found

    def unbalanced(self) -> Number:
        """Return what is left of the sums of forces and moments, over the sizes of their terms, at its worst."""
        pieces, state = self.forces.pieces, self.forces.samples
        body = self._body(on_pin(state).complex, state.angle, pieces)
        return self.forces.result(
            pieces.largest(
                body.equilibrium_residual(state.tangential_at_pin * state.mechanism.crank)
            )
        )

    # the two positions of the book, and the worst of the cycle

    def _force_extremes(self, column: str) -> Extremes:
        _ = self._cycle  # forces that are too large are refused before they are searched
        found = self.forces.extremes_of(column)
        assert found is not None
        return found

    @cached_property
    def full_force(self) -> Extreme:
        """The largest piston force without inertia in N, and the dead centre in degrees in which the throw takes it.

        Starting and slow running (R p. 608): the inner dead centre, or the outer one where pulling is stronger.
        """
        found, motion = self._force_extremes("P_start"), self.forces.motion
        pushes = found.largest.value >= -found.smallest.value
        inner, outer = (
            Extreme(found.largest.value, motion.phi_idc),
            Extreme(found.smallest.value, motion.phi_odc),
        )
        return chosen(pushes, inner, outer)

    @cached_property
    def at_dead_centre(self) -> tuple[Place, ...]:
        """Every place in the firing dead centre under the full force of the pressure: T = 0, D = P cos(φ+ψ)/cos ψ."""
        force, degrees = self.full_force
        angle = CrankAngle.of(degrees)
        radial: Any = self.forces.drive.mechanism.radial(angle)
        body = self._body(force * radial + 0j, angle)
        return tuple(place._replace(degrees=degrees) for place in places(body))

    @property
    def at_largest_torque(self) -> tuple[Place, ...]:
        """Every place in the position of the largest torque, driving or driven, of the only machine."""
        degrees = self._force_extremes("T").peak.degrees
        body = self._beside([degrees])
        side = int(np.abs(body.pin.imag).argmax())
        return tuple(place.one_of(side, degrees) for place in places(body))

    @property
    def at_worst(self) -> tuple[Place, ...]:
        """Every place at the crank angle of the running machine at which its own combined stress is largest."""
        angles = [worst.degrees for worst in self._largest[: len(self.at_dead_centre)]]
        found = []
        for number, (place, degrees) in enumerate(zip(places(self._beside(angles)), angles)):
            side = 2 * number + int(place.combined[2 * number : 2 * number + 2].argmax())
            found.append(place.one_of(side, degrees))
        return tuple(found)

    def _beside(self, degrees: Sequence[float]) -> FreeBody:
        """Return the throw just before and just after each angle in degrees of the only machine, since T may jump."""
        each = np.repeat(np.asarray(degrees), 2)
        state = State.at(self.forces.drive, each, each + np.tile((-1e-9, 1e-9), len(degrees)))
        return self._body(on_pin(state).complex, state.angle)
