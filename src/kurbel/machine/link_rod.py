"""Link rods: cylinders whose rod is on a knuckle pin of the master rod of another one."""

from __future__ import annotations

from collections.abc import Iterator

from kurbel.declared.record import Record, Rule, field


class LinkRod(Record):
    """A rod on the knuckle pin of a master rod.

    master: the name of an earlier cylinder, '' where equal cylinders name none; length: None for that of the master
    rod less the knuckle radius; knuckle_angle: degrees, None for the angle between the stroke lines; mass, share: None
    for those of `masses.connecting_rod`; share at the piston pin, the rest is at the knuckle pin.
    """

    master: str = field(
        str,
        "Name of the earlier cylinder that has the master rod",
        default="",
        example="main",
        absent="required in a list; of equal cylinders the first of every throw",
    )
    knuckle_radius: float = field(
        "length", "Distance of the knuckle pin from the crank pin", "k", above=0, example="58 mm"
    )
    length: float | None = field(
        "length",
        "Length of the link rod, knuckle pin to piston pin",
        "l",
        above=0,
        absent="that of the master rod less the knuckle radius",
    )
    knuckle_angle: float | None = field(
        "angle",
        "Angle at the crank pin from the axis of the master rod, toward its piston, to the knuckle pin, in the sense of "
        "rotation",
        "κ",
        least=-360,
        most=360,
        absent="the angle between the stroke lines",
    )
    mass: float | None = field(
        "mass", "Mass of the link rod", least=0, absent="that of masses.connecting_rod"
    )
    share: float | None = field(
        "ratio",
        "Share of its mass at the piston pin; the rest is at the knuckle pin",
        least=0,
        most=1,
        absent="that of masses.connecting_rod, else 1/2",
    )
    knuckle_mass: float = 0.0

    def rules(self) -> Iterator[Rule]:
        lonely = self.share is not None and self.mass is None
        yield Rule("share", lonely, "'share' needs 'mass' beside it")
