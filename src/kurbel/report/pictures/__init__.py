"""Pictures of a machine. One more is one declaration here, with what makes its panels from the results."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from kurbel.declared.reading import shown
from kurbel.declared.shaft import SHAFT_PARTS
from kurbel.errors import NoSolutionError, UsageError
from kurbel.machine.alike import gathered, work_alike
from kurbel.near_words import did_you_mean
from kurbel.report.alike import together
from kurbel.report.pictures import cylinder, mechanism, vectors, whole_machine
from kurbel.report.pictures.picture import Panel, Picture
from kurbel.report.pictures.source import Source, Wish
from kurbel.report.tables import cylinder_meant

if TYPE_CHECKING:
    from kurbel.solver.case import Case


@dataclass(frozen=True, eq=False)
class Declared:
    """A picture: its word, its German title, and a sentence; command: whose results it shows.

    panels: the function that yields its panels from a source. rows: instead of that, columns over `over`, one panel for
    each group of those that the machine has. across: how many panels stand side by side.
    """

    id: str
    title: str
    text: str
    command: str
    panels: Callable[[Source], Iterable[Panel]] | None = None
    rows: tuple[tuple[str, ...], ...] = ()
    over: str = "phi"
    across: int = 1

    def drawn(self, source: Source) -> Iterable[Panel]:
        """Return the panels; none where the machine does not have what they show."""
        if self.panels:
            return self.panels(source)
        if not source.having((self.over,)) and self.over != "phi":
            return ()
        return (source.panel(ids, self.over) for row in self.rows if (ids := source.having(row)))


PICTURES = (
    Declared(
        "piston-force",
        "Kolbenüberdrucklinie",
        "Force P_0 of gas, weight and resistance against the line of the inertia forces over the crank angle; what "
        "lies between is the piston force P, below alone. It turns over where both lines cross (Druckwechsel).",
        "forces",
        cylinder.piston_force,
    ),
    Declared(
        "piston-force-way",
        "Kolbenüberdrucklinie über dem Weg",
        "The same over the way of the piston, stroke by stroke (R Abb. 1055).",
        "forces",
        cylinder.piston_force_over_way,
    ),
    Declared(
        "card",
        "Indikatordiagramm",
        "Pressure at both ends of the pistons over the way from the inner dead centre (R Abb. 1051).",
        "forces",
        cylinder.cards,
    ),
    Declared(
        "card-volume",
        "Indikatordiagramm über dem Raum",
        "Pressure over the volume swept in each chamber, with the clearance where that is known.",
        "forces",
        cylinder.cards_over_volume,
    ),
    Declared(
        "forces",
        "Kräfte im Kurbeltrieb",
        "Forces in the rod, on the guide and at the crank pin over the crank angle (R Abb. 1061, 1062).",
        "forces",
        cylinder.forces,
    ),
    Declared(
        "effort-polar",
        "Tangentialdruck in polarer Darstellung",
        "Tangential force T drawn outward from the circle of the crank pin (R Abb. 1063).",
        "forces",
        cylinder.polar_effort,
    ),
    Declared(
        "effort",
        "Drehkraftlinie",
        "Turning effort of the whole machine and the resistance, its lobes numbered with their work; below the excess "
        "work and the speed (R Abb. 1064 to 1067).",
        "flywheel",
        whole_machine.effort,
    ),
    Declared(
        "throw-stress",
        "Beanspruchung der Kurbelwelle",
        "Largest combined stress of each part of the crank throw over the cycle.",
        "stress",
        rows=(tuple(f"sigma_{part}" for part in SHAFT_PARTS),),
    ),
    Declared(
        "bearing-loads",
        "Lagerkräfte in polarer Darstellung",
        "The way of the tip of the load on every pin and main bearing, in the frames of throw, engine and rod.",
        "bearings",
        vectors.polar_loads,
        across=2,
    ),
    Declared(
        "orders",
        "Drehkraft nach Ordnungen",
        "Amplitudes of the turning effort by order, periods per turn of the shaft.",
        "harmonics",
        whole_machine.torque_orders,
    ),
    Declared(
        "modes",
        "Eigenschwingungen der Welle",
        "How far the masses of the shaft line turn in its first natural vibrations.",
        "torsion",
        whole_machine.shaft_modes,
    ),
    Declared(
        "free-vectors",
        "Massenausgleich: freie Kräfte und Momente",
        "The way that the tip of the free force, and of the free moment, runs over a turn.",
        "balance",
        vectors.free_vectors,
    ),
    Declared(
        "free-angle",
        "Freie Kräfte und Momente über dem Kurbelwinkel",
        "Free force, free moment and rolling moment on the frame over the crank angle.",
        "balance",
        rows=(("F_x", "F_y"), ("M_x", "M_y"), ("M_roll",)),
    ),
    Declared(
        "free-orders",
        "Ordnungen der freien Kräfte und Momente",
        "The circles of each order, with the rotation and against it.",
        "balance",
        whole_machine.free_orders,
    ),
    Declared(
        "motion",
        "Kolbenweg, Geschwindigkeit, Beschleunigung",
        "Way, velocity and acceleration over the crank angle (R Abb. 1047 to 1050).",
        "motion",
        rows=(("x",), ("c",), ("b",), ("theta",), ("theta_dot",), ("theta_ddot",)),
    ),
    Declared(
        "motion-way",
        "Geschwindigkeit und Beschleunigung über dem Weg",
        "Velocity and acceleration over the way (R Abb. 1049, 1050).",
        "motion",
        rows=(("c",), ("b",)),
        over="x",
    ),
    Declared(
        "mechanism",
        "Getriebe",
        "The mechanism to scale, with the forces on it.",
        "motion",
        mechanism.mechanism,
        across=2,
    ),
)
"""The pictures, the one that says most of a machine first."""


def pictures(case: "Case", names: Sequence[str], wish: Wish) -> Iterator[Picture]:
    """Yield these pictures of a machine; without names the first that it has, `all` for every one.

    Raises UsageError for a picture that there is not, or that this machine does not have, NoSolutionError where the
    machine locks itself or stalls.
    """
    wish = replace(wish, cylinder=wish.cylinder and cylinder_meant(wish.cylinder, _names(case)))
    if not names:
        yield from _first(case, wish)
    elif "all" in names:
        for declared in PICTURES:
            yield from pictures_if_any(case, declared, wish)
    else:
        for declared in [_named(case, name, wish) for name in names]:
            if not (found := _drawn(case, declared, wish)):
                raise UsageError(_missing(case, declared, wish))
            yield from found


def pictures_of(case: "Case", wish: Wish) -> tuple[Declared, ...]:
    """Return the pictures that a machine has; one that is without a solution is drawn of it, too, and then says so."""
    return tuple(one for one in PICTURES if _has(case, one, wish))


def _has(case: "Case", declared: Declared, wish: Wish) -> bool:
    with np.errstate(all="ignore"):
        try:
            return any(True for source, _ in _sources(case, declared, wish) for _ in declared.drawn(source))
        except UsageError:
            return False
        except NoSolutionError:
            return True


def pictures_if_any(case: "Case", declared: Declared, wish: Wish) -> list[Picture]:
    """Return one picture of a machine, as often as it has it, or none; raises NoSolutionError as `pictures` does."""
    with suppress(UsageError):
        return _drawn(case, declared, wish)
    return []


def _first(case: "Case", wish: Wish) -> list[Picture]:
    """Return the first picture that there is; none is drawn only to see whether there is one."""
    found = filter(None, (pictures_if_any(case, declared, wish) for declared in PICTURES))
    if first := next(found, None):
        return first
    raise UsageError(f"{case.machine.name}: there is nothing to draw; kurbel check says what is missing")


def _named(case: "Case", name: str, wish: Wish) -> Declared:
    known = {one.id: one for one in PICTURES}
    if name not in known:
        hint = did_you_mean(name, tuple(known))
        raise UsageError(f"no picture '{shown(name)}'{hint} ({case.machine.name} has {_having(case, wish)})")
    return known[name]


def _having(case: "Case", wish: Wish) -> str:
    return ", ".join(one.id for one in pictures_of(case, wish))


def _missing(case: "Case", declared: Declared, wish: Wish) -> str:
    names, has = _names(case), _having(case, wish)
    if wish.cylinder is not None and wish.cylinder not in names:
        return f"--cylinder: there is no '{shown(wish.cylinder)}'; there are {', '.join(names)}"
    return f"{case.machine.name} has no picture '{declared.id}': what it shows is left out; it has {has}"


def _names(case: "Case") -> tuple[str, ...]:
    return tuple(one.drive.name for one in case.cylinders)


def _drawn(case: "Case", declared: Declared, wish: Wish) -> list[Picture]:
    found = []
    with np.errstate(all="ignore"):
        for source, name in _sources(case, declared, wish):
            if panels := tuple(declared.drawn(source)):
                across = min(declared.across, len(panels))
                words = declared.id, declared.title, declared.text
                found.append(Picture(*words, panels, case.machine.name, name, across))
    return found


def _sources(case: "Case", declared: Declared, wish: Wish) -> Iterator[tuple[Source, str]]:
    """Yield what a picture is drawn from, each with the name of its cylinder; equal ones are drawn once."""
    if declared.command in _OF_MACHINE:
        yield Source(_OF_MACHINE[declared.command](case), wish), ""
    elif declared.command == "bearings":
        for part in case.bearings.parts:
            yield Source(part, wish), part.name
    else:
        wanted = [one for one in case.cylinders if wish.cylinder in (None, one.drive.name)]
        for equal in gathered(wanted, lambda one, other: work_alike(one.drive.cylinder, other.drive.cylinder)):
            if declared.command == "forces":
                equal[0].refuse_locking()
            names = together([one.drive.name for one in equal]) if len(case.cylinders) > 1 else ""
            yield Source(equal[0], wish), names


_OF_MACHINE: "dict[str, Callable[[Case], Any]]" = {
    "flywheel": lambda case: case.flywheel,
    "stress": lambda case: case.stress,
    "balance": lambda case: case.balance,
    "harmonics": lambda case: case.harmonics(),
    "torsion": lambda case: case.torsion,
}
"""Command -> the result of a case that its pictures are drawn from; those of others are drawn of each cylinder."""
