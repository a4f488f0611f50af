"""The places of a crankshaft at which stresses are looked at, part by part.

    pin        middle          bent by A on the lever a, twisted by A_T r (G)
               at web A, B     bent by A, and by A and the force on the pin; twisted by A_T r as all of the pin
    web        wide face       compressed and bent in the plane of the throw, twisted: decisive for the shape (G)
               narrow face     compressed and bent out of that plane, twisted less
               corner          compressed and bent both ways, not twisted
    journal A  at web          bent by A on the lever up to web A
    journal B  at web          bent by A and the pin, twisted by T r; the shaft as far as B counts as journal
               at flywheel     the same, where the flywheel stands before B
               in bearing      bent by the flywheel overhung beyond B, twisted by T r

Along the pin and along each journal the moments run straight from load to load, under the same torsion: their vector
sum is largest at a load or at an end, so that no section between these places is strained more. The force on the pin
stands in its middle, the forces of the bearings in theirs.

An overhung crank has a pin clamped at its only end, in web A, which is loaded as a web B with nothing before the pin;
journal A is bent by F and twisted by T r, at the web and in its bearing, and the shaft beyond counts as journal B.

A web is bent out of the plane of the throw most at one end of its arm, at the axis of the pin or at that of the shaft.
"""

from collections.abc import Callable
from operator import attrgetter
from typing import Any, NamedTuple

from kurbel.machine.crankshaft import Crankshaft
from kurbel.solver.shaft.statics import FreeBody, Vector, WebLoads, norm
from kurbel.solver.strength.sections import (
    bach,
    bach_factor,
    direct_stress,
    face_torsion,
    rectangle_bending,
    round_bending,
    round_torsion,
    von_mises,
)

PARTS = ("pin", "web_A", "web_B", "journal_A", "journal_B")


class Stresses(NamedTuple):
    """The stresses at one place in Pa, each (n,) or a jet; None for what there cannot be at this place.

    compression is positive, and negative where the web is pulled; bendings and torsion are magnitudes. normal: all
    normal stress together, a magnitude.
    """

    compression: Any
    bending_in_plane: Any
    bending_out_of_plane: Any
    torsion: Any
    normal: Any

    def combined(self, alpha: float) -> Any:
        """Return the stress in Pa combined after Bach."""
        return bach(self.normal, _or_zero(self.torsion), alpha)

    def von_mises(self) -> Any:
        """Return the equivalent stress in Pa after von Mises."""
        return von_mises(self.normal, _or_zero(self.torsion))


class Place(NamedTuple):
    """One place of a part: its stresses under the forces on the free body, and α₀ of Bach's combination."""

    part: str
    name: str
    alpha: float
    stresses: Callable[[FreeBody], Stresses]

    def combined(self, body: FreeBody) -> Any:
        """Return the stress in Pa combined after Bach."""
        return self.stresses(body).combined(self.alpha)


def places(shaft: Crankshaft) -> tuple[Place, ...]:
    """Return the places of a crankshaft; the journals only where their diameter is given.

    α₀ is 1 for what is round (G, for the pin), and that of the allowable stresses for the webs.
    """
    alpha = bach_factor(shaft.allowable_bending, shaft.allowable_torsion)
    return (
        *(Place("pin", name, 1.0, stresses) for name, stresses in _pin_places(shaft).items()),
        *(place for part, loads_of in _webs(shaft).items() for place in _web_places(part, alpha, loads_of)),
        *(_journal_places(shaft) if shaft.journal_diameter else ()),
    )


def _pin_places(shaft: Crankshaft) -> dict[str, Callable[[FreeBody], Stresses]]:
    """Return the places of the pin; in its middle M_b = a √(A_T² + A_D²) and M_d = A_T r (G), overhung none."""
    end = shaft.web_distance - shaft.web_thickness / 2  # inner face of a web, from the middle of the pin

    def bent(u: float) -> Callable[[FreeBody], Stresses]:
        return lambda body: _round(body.moments_at(u), body.before_pin.T * body.crank, shaft.pin_diameter)

    return (
        {"at web A": bent(end)}
        if shaft.overhung
        else {"middle": bent(0), "at web A": bent(-end), "at web B": bent(end)}
    )


def _round(moments: Vector, torque: Any, diameter: float) -> Stresses:
    """Stresses at the surface of a round section, whose bendings add up as vectors."""
    in_plane, out_of_plane = (round_bending(moment, diameter) for moment in moments)
    torsion = None if torque is None else abs(round_torsion(torque, diameter))
    return Stresses(None, abs(in_plane), abs(out_of_plane), torsion, norm(in_plane, out_of_plane))


def _webs(shaft: Crankshaft) -> dict[str, Callable[[FreeBody], WebLoads]]:
    """Return the webs with what loads them; that of an overhung crank lies beyond the pin, toward both bearings."""
    before, beyond = attrgetter("web_before_pin"), attrgetter("web_beyond_pin")
    return {"web_A": beyond} if shaft.overhung else {"web_A": before, "web_B": beyond}


def _web_places(part: str, alpha: float, loads_of: Callable[[FreeBody], WebLoads]) -> tuple[Place, ...]:
    def wide(body: FreeBody) -> Stresses:
        t, w, loads = body.shaft.web_thickness, body.shaft.web_width, loads_of(body)
        direct = direct_stress(loads.force, t, w)
        bending = abs(rectangle_bending(loads.in_plane, t, w))
        return Stresses(direct, bending, None, abs(face_torsion(loads.twist, t, w)), abs(direct) + bending)

    def narrow(body: FreeBody) -> Stresses:
        t, w, loads = body.shaft.web_thickness, body.shaft.web_width, loads_of(body)
        direct = direct_stress(loads.force, t, w)
        bending = rectangle_bending(loads.out_of_plane, w, t)
        return Stresses(direct, None, bending, abs(face_torsion(loads.twist, w, t)), abs(direct) + bending)

    def corner(body: FreeBody) -> Stresses:
        face, side = wide(body), narrow(body)
        normal = face.normal + side.bending_out_of_plane
        return Stresses(face.compression, face.bending_in_plane, side.bending_out_of_plane, None, normal)

    named = {"wide face": wide, "narrow face": narrow, "corner": corner}
    return tuple(Place(part, name, alpha, stresses) for name, stresses in named.items())


def _journal_places(shaft: Crankshaft) -> tuple[Place, ...]:
    diameter = shaft.journal_diameter
    assert diameter is not None
    face = shaft.web_distance + shaft.web_thickness / 2  # outer face of a web, from the middle of the pin

    def before(body: FreeBody) -> Stresses:
        return _round(body.moments_at(-face), None, diameter)

    def beyond(place: float) -> Callable[[FreeBody], Stresses]:
        return lambda body: _round(body.moments_at(place), body.torque, diameter)

    def in_bearing(body: FreeBody) -> Stresses:
        return _round(body.overhung_moments, body.torque, diameter)

    flywheel = shaft.b + shaft.flywheel_position
    outer = {"in bearing": in_bearing} if flywheel >= shaft.b else {"at flywheel": beyond(flywheel)}
    if shaft.overhung:
        journals = {"journal_A": {"at web": beyond(face), "in bearing": beyond(shaft.a)}, "journal_B": outer}
    else:
        journals = {"journal_A": {"at web": before}, "journal_B": {"at web": beyond(face)} | outer}
    return tuple(Place(part, name, 1.0, found) for part, own in journals.items() for name, found in own.items())


def _or_zero(value: Any) -> Any:
    return 0.0 if value is None else value
