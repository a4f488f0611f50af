"""Places of a crankshaft at which stresses are looked at, and the stresses there (G).

Part by part:

    pin        middle          bent by A on the lever a, twisted by M_p = M_A + A_T r (G, whose M_A is 0)
               rod 1, rod 2    the same under each rod, where several are on the pin
               at web A, B     bent by A, and by A and the forces on the pin; twisted by M_p as all of the pin
    web        wide face       compressed and bent in the plane of the throw, twisted: decisive for the shape (G)
               narrow face     compressed and bent out of that plane, twisted less
               corner          compressed and bent both ways, not twisted
    journal A  at web          bent by A on the lever up to web A, twisted by M_A, what the throws before it deliver
    journal B  at web          bent by A and the pin, twisted by M_B; the shaft as far as B counts as journal
               at flywheel     the same, where the flywheel is before B
               in bearing      bent by the flywheel overhung beyond B, twisted by M_B

The flywheel is behind the last throw; of the others journal B is examined at the web alone. Along the pin and along
each journal the moments are straight lines from load to load, under the same torsion: their vector sum is largest at a
load or at an end, so that no section between these places is strained more. The forces of the bearings act in their
middles.

An overhung crank has a pin clamped at its only end, in web A, which is loaded as a web B with nothing before the pin;
journal A is bent by F and twisted by T r, at the web and in its bearing, and the shaft beyond counts as journal B.
Where cranks are at both ends of the shaft, the part between the bearings is bent by both.

A web is bent out of the plane of the throw most at one end of its arm, at the axis of the pin or at that of the shaft.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Number
from kurbel.machine.crankshaft import Crankshaft
from kurbel.numerics.arithmetic import every, magnitude, where
from kurbel.solver.shaft import FreeBody
from kurbel.solver.vector import Force

PARTS = {
    "pin": ("pin", "the crank pin"),
    "web_A": ("w,A", "web A"),
    "web_B": ("w,B", "web B"),
    "journal_A": ("j,A", "journal A"),
    "journal_B": ("j,B", "journal B"),
}
"""Parts of a crankshaft: the index of their symbols, and what they are called in a sentence."""

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
        resulting = np.hypot(self.normal, 2 * self.alpha * torsion)
        return 0.35 * magnitude(self.normal) + 0.65 * resulting

    @property
    def von_mises(self) -> Any:
        """Equivalent stress √(σ² + 3 τ²) in Pa after von Mises."""
        torsion = 0.0 if self.torsion is None else self.torsion
        return np.hypot(self.normal, math.sqrt(3) * torsion)

    def of_state(self, number: int, degrees: float) -> Place:
        """Return the place in one of several states, whose forces act at a crank angle."""
        stresses = self._asdict()
        in_state: dict[str, Any] = {
            name: float(stresses[name][number]) for name in stresses if np.ndim(stresses[name])
        }
        return self._replace(**in_state, degrees=degrees)


class Opposite(NamedTuple):
    """The other throw of a shaft with cranks at both ends; turn: e^{−i(γ₂ − γ₁)}, from its frame to the first one's."""

    body: FreeBody
    turn: Any


def places(
    body: FreeBody, is_last: bool = True, opposite: Opposite | None = None
) -> Iterator[Place]:
    """Yield the places of a throw under its forces; those of the journals only where their diameter is given.

    is_last: whether the flywheel is beyond its bearing B, or before it. α₀ is 1 for what is round (G, for the pin), and
    that of the allowable stresses for the webs.
    """
    shaft = body.shaft
    # faces of a web, from the middle of the pin
    inner = shaft.web_distance - shaft.web_thickness / 2
    outer = shaft.web_distance + shaft.web_thickness / 2
    for name, u in _sections_of_pin(body, inner).items():
        yield _round("pin", name, body.moments_at(u), body.torque_pin, shaft.pin_diameter)

    at_pin, at_B = magnitude(body.torque_pin), magnitude(body.torque_B)
    if not shaft.overhung:
        at_A: Number = 0.0 if body.torque_A is None else magnitude(body.torque_A)
        moments = body.moments_at(-shaft.web_distance)
        yield from _web("web_A", shaft, body.before_pin.real, moments, _larger(at_pin, at_A))
    last_web = "web_A" if shaft.overhung else "web_B"
    moments = body.moments_at(shaft.web_distance)
    yield from _web(last_web, shaft, body.along_web, moments, _larger(at_pin, at_B))
    if shaft.journal_diameter is not None:
        yield from _journals(body, shaft.journal_diameter, outer, is_last, opposite)


def _sections_of_pin(body: FreeBody, inner: Number) -> dict[str, Number]:
    """Return the sections of the pin with their distances from its middle; inner: that of the faces of the webs."""
    overhung = body.shaft.overhung
    sections: dict[str, Number] = {}
    if len(body.rods) > 1:
        for number, (_, u) in enumerate(body.rods, 1):
            sections[f"rod {number}"] = u
    elif not overhung:
        # in the middle of the pin M_b = a √(A_T² + A_D²) and M_d = A_T r (G)
        sections["middle"] = 0.0
    if overhung:
        sections["at web A"] = inner
    else:
        sections["at web A"] = -inner
        sections["at web B"] = inner
    return sections


def _journals(
    body: FreeBody, diameter: Number, outer: Number, is_last: bool, opposite: Opposite | None
) -> Iterator[Place]:
    """Yield the places of the journals; outer: from the middle of the pin to the outer face of a web."""
    shaft, f = body.shaft, body.shaft.flywheel_position
    if shaft.overhung:
        yield _round("journal_A", "at web", body.moments_at(outer), body.torque_B, diameter)
        yield _round("journal_A", "in bearing", body.moments_at(shaft.a), body.torque_B, diameter)
    else:
        yield _round("journal_A", "at web", body.moments_at(-outer), body.torque_A, diameter)
        yield _round("journal_B", "at web", body.moments_at(outer), body.torque_B, diameter)
    if not is_last:
        return
    if opposite is not None:
        # at the flywheel between the bearings, or at bearing B, by what acts on either side
        before_B = where(f < 0, f, 0.0)
        by_opposite = opposite.body.moments_at(shaft.a - before_B) * opposite.turn
        bending = body.moments_at(shaft.b + before_B) + by_opposite
        torsion = _larger(magnitude(body.torque_B), magnitude(opposite.body.torque_B))
        yield _round("journal_B", "at flywheel", bending, torsion, diameter)
        return
    is_beyond = f >= 0  # of bearing B, in whose middle the bending is G f
    bending = np.where(is_beyond, body.weight * f, body.moments_at(shaft.b + f))
    name = "in bearing" if every(is_beyond) else "at flywheel"
    yield _round("journal_B", name, bending, body.torque_B, diameter)


def _larger(first: Number, second: Number) -> Number:
    return where(first >= second, first, second)


def _round(part: str, name: str, moments: Force, torque: Number | None, diameter: Number) -> Place:
    """Stresses at the surface of a round section, whose bendings add up as vectors (G).

    Bending σ = 32 M/(π d³), torsion τ = 16 M/(π d³).
    """
    d = diameter
    in_plane = magnitude(32 / math.pi * moments.real / d / d / d)
    out_of_plane = magnitude(32 / math.pi * moments.imag / d / d / d)
    torsion = None if torque is None else magnitude(16 / math.pi * torque / d / d / d)
    normal = np.hypot(in_plane, out_of_plane)
    return Place(part, name, 1.0, None, in_plane, out_of_plane, torsion, normal)


def _web(
    part: str, shaft: Crankshaft, force: Number, moments: Force, out_of_plane: Number
) -> Iterator[Place]:
    """Stresses of a web, a rectangle t × w: σ = S/(t w) + 6 M/(b h²) across h (G, webs, "auf Druck", "auf Biegung").

    force: along it; moments: in-plane bending and twist. α₀ = k_b/(1.3 k_d), or 1 where one of the allowable stresses
    is not known (G): with it a part under torsion alone is fully used just where τ reaches k_d.

    Its torsion is τ = (9/2) M_d/(t² w) in the middle of the wide faces and (9/2) M_d/(t w²) in that of the narrow ones
    (G, webs, "auf Drehung"): Bach's rounded factor; de Saint-Venant's own is 4.81 for a square and 3 for a strip.
    """
    t, w = shaft.web_thickness, shaft.web_width
    k_b, k_d = shaft.allowable_bending, shaft.allowable_torsion
    alpha = 1.0 if k_b is None or k_d is None else k_b / (1.3 * k_d)

    direct = force / t / w
    size = magnitude(direct)
    wide = magnitude(6 * moments.real / w / t / t)
    narrow = 6 * out_of_plane / t / w / w
    twist = 4.5 * magnitude(moments.imag)
    at_wide, at_narrow = twist / t / t / w, twist / w / w / t
    yield Place(part, "wide face", alpha, direct, wide, None, at_wide, size + wide)
    yield Place(part, "narrow face", alpha, direct, None, narrow, at_narrow, size + narrow)
    yield Place(part, "corner", alpha, direct, wide, narrow, None, size + wide + narrow)
