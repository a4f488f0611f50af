"""Link rods: cylinders whose rod is on a knuckle pin of the master rod of another one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from kurbel.declared.record import Record, Rule, field
from kurbel.errors import Fault, RuleError, refuse
from kurbel.machine.cylinder import Cylinder
from kurbel.machine.parts import ConnectingRod, Masses
from kurbel.mechanisms.link_rod import LinkedPiston
from kurbel.mechanisms.slider_crank import SliderCrank


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


def with_links(cylinders: Sequence[Cylinder]) -> tuple[Cylinder, ...]:
    """Return the cylinders, those with a link rod on their master: mechanism, masses, pin and place along the shaft.

    Raises RuleError for a master that cannot be one, and for what a machine with link rods does not have.
    """
    names = [cylinder.name or f"cylinder {index + 1}" for index, cylinder in enumerate(cylinders)]
    linked: list[Cylinder] = []
    faults: list[Fault] = []
    for index, cylinder in enumerate(cylinders):
        path = ("cylinders", index)
        if _has_pin_friction(cylinder):
            message = "friction of pins and journals is not computed in a machine with link rods"
            faults.append(Fault((*path, "friction"), message))
        if cylinder.link_rod is None:
            linked.append(cylinder)
            continue
        obstacle = _obstacle(cylinder, cylinders, names, index)
        if obstacle:
            faults.append(Fault((*path, *obstacle[0]), obstacle[1]))
            linked.append(cylinder)
            continue
        master = linked[names.index(cylinder.link_rod.master)]
        try:
            linked.append(_on_master(cylinder, master))
        except RuleError as error:
            keys = {"radius": "knuckle_radius"}
            for fault in error.faults:
                key = str(fault.path[0])
                faults.append(fault._replace(path=(*path, "link_rod", keys.get(key, key))))
            linked.append(cylinder)
    refuse(*faults)
    return tuple(linked)


def _has_pin_friction(cylinder: Cylinder) -> bool:
    friction = cylinder.friction
    if friction is None:
        return False
    coefficients = (friction.crank_pin, friction.crosshead_pin, friction.journals)
    return any(coefficient is not None for coefficient in coefficients)


def _obstacle(
    cylinder: Cylinder, cylinders: Sequence[Cylinder], names: Sequence[str], index: int
) -> tuple[tuple[str, ...], str] | None:
    """Return the key, and why a cylinder cannot have its link rod; None if it can."""
    link = cylinder.link_rod
    assert link is not None
    if not link.master:
        return ("link_rod",), "'master' is missing: the name of the cylinder with the master rod"
    if link.master not in names[:index]:
        earlier = ", ".join(names[:index]) or "none"
        return ("link_rod", "master"), f"no earlier cylinder has this name; there are {earlier}"
    master = cylinders[names.index(link.master)]
    if master.link_rod is not None:
        return ("link_rod", "master"), f"'{link.master}' is on a link rod itself"
    own = cylinder.mechanism
    of_master = master.mechanism
    if type(own) is not SliderCrank or type(of_master) is not SliderCrank:
        return ("link_rod",), "both cylinders of a link rod are slider-cranks"
    if np.any(np.isinf(of_master.rod)):
        return ("link_rod", "master"), "an infinite rod carries no knuckle pin"
    if np.any(np.not_equal(own.crank, of_master.crank)):
        return ("crank",), "it is that of its master; leave it out, or write 'like: MASTER'"
    if np.any(np.not_equal(own.rod, of_master.rod)):
        return ("rod",), "it is that of its master; the rod of its own is 'link_rod.length'"
    if np.any(np.equal((cylinder.bank_angle - master.bank_angle) % 360.0, 0.0)):
        return ("bank_angle",), "a link rod has a stroke line of its own; this is its master's"
    position = cylinder.axial_position
    of_master_rod = master.axial_position
    is_elsewhere = position is not None and of_master_rod is None
    if position is not None and of_master_rod is not None:
        is_elsewhere = bool(np.any(np.not_equal(position, of_master_rod)))
    if is_elsewhere:
        return ("axial_position",), "it is that of its master"
    if cylinder.crank_position not in (None, master.crank_position):
        return ("crank_position",), "it follows from the pin of its master; leave it out"
    if cylinder.throw_angle not in (None, master.throw_angle):
        return ("throw_angle",), "its pin is that of its master; leave it out"
    rod = cylinder.masses.connecting_rod if cylinder.masses else None
    if rod is not None and rod.exact and link.mass is None:
        return ("masses",), "a link rod has a share, and no 'center_of_gravity'; give its 'mass'"
    return None


def _on_master(cylinder: Cylinder, master: Cylinder) -> Cylinder:
    """Return a cylinder on the master rod: motion by the knuckle pin, and the masses at both pins of its link rod."""
    link = cylinder.link_rod
    assert link is not None
    assert isinstance(master.mechanism, SliderCrank)
    between = cylinder.bank_angle - master.bank_angle
    knuckle_angle = between if link.knuckle_angle is None else link.knuckle_angle
    length = link.length
    if length is None:
        length = master.mechanism.rod - link.knuckle_radius
    mechanism = LinkedPiston(
        crank=master.mechanism.crank,
        master=master.mechanism,
        between=between,
        length=length,
        radius=link.knuckle_radius,
        angle=knuckle_angle,
        own_offset=cylinder.mechanism.offset,
    )

    # the share at the piston pin moves to and fro, the rest with the knuckle pin
    masses = cylinder.masses
    rod = masses.connecting_rod if masses else None
    mass = link.mass
    share = link.share
    if mass is None and rod is not None:
        mass, share = rod.mass, rod.share
    knuckle_mass = 0.0
    if mass is not None:
        share = 0.5 if share is None else share
        knuckle_mass = mass * (1 - share)
        at_piston = ConnectingRod(mass=mass * share, share=1.0)
        masses = replace(masses or Masses(), connecting_rod=at_piston)
    return replace(
        cylinder,
        mechanism=mechanism,
        masses=masses,
        link_rod=replace(link, length=length, knuckle_mass=knuckle_mass),
        crank_position=master.crank_position,
        throw_angle=master.throw_angle,
        axial_position=master.axial_position,
    )
