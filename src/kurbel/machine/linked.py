"""Cylinders with link rods, each on the master rod of another one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from kurbel.errors import Fault, RuleError, refuse, refused
from kurbel.machine.cylinder import Cylinder, names_of
from kurbel.machine.link_rod import LinkRod
from kurbel.machine.parts import ConnectingRod, Masses
from kurbel.mechanisms.link_rod import LinkedPiston
from kurbel.mechanisms.slider_crank import SliderCrank


def with_links(cylinders: Sequence[Cylinder]) -> tuple[Cylinder, ...]:
    """Return the cylinders, those with a link rod on their master: mechanism, masses, pin and place along the shaft.

    Raises RuleError for a master that cannot be one, and for what a machine with link rods does not have.
    """
    linked: list[Cylinder] = []
    earlier: dict[str, Cylinder] = {}
    faults: list[Fault] = []
    for index, name in enumerate(names_of(cylinders)):
        cylinder = cylinders[index]
        if cylinder.friction and cylinder.friction.of_pins:
            message = "friction of pins and journals is not computed in a machine with link rods"
            faults.append(Fault(("cylinders", index, "friction"), message))
        try:
            cylinder = _linked(cylinder, earlier)
        except RuleError as error:
            # the faults of all cylinders in one run
            for fault in error.faults:
                faults.append(fault._replace(path=("cylinders", index, *fault.path)))
        linked.append(cylinder)
        earlier.setdefault(name, cylinder)
    refuse(*faults)
    return tuple(linked)


def _linked(cylinder: Cylinder, earlier: Mapping[str, Cylinder]) -> Cylinder:
    """Return a cylinder, one with a link rod on its master. earlier: cylinders by name, on their masters."""
    link_rod = cylinder.link_rod
    if link_rod is None:
        return cylinder
    if not link_rod.master:
        message = "'master' is missing: the name of the cylinder with the master rod"
        refused(message, "link_rod")
    if link_rod.master not in earlier:
        names = ", ".join(earlier) or "none"
        message = f"no earlier cylinder has this name; there are {names}"
        refused(message, "link_rod", "master")
    master = earlier[link_rod.master]
    if master.link_rod is not None:
        refused(f"'{link_rod.master}' is on a link rod itself", "link_rod", "master")
    _refuse_other_crank(cylinder, master)
    _refuse_other_pin(cylinder, master)
    rod = cylinder.masses.connecting_rod if cylinder.masses else None
    if rod is not None and rod.exact and link_rod.mass is None:
        message = "a link rod has a share, and no 'center_of_gravity'; give its 'mass'"
        refused(message, "masses")
    return _on_master(cylinder, master, link_rod)


def _refuse_other_crank(cylinder: Cylinder, master: Cylinder) -> None:
    """Raise RuleError unless both are slider-cranks, with the crank and the rod of the master."""
    mechanism = cylinder.mechanism
    of_master = master.mechanism
    if type(mechanism) is not SliderCrank or type(of_master) is not SliderCrank:
        refused("both cylinders of a link rod are slider-cranks", "link_rod")
    if np.any(np.isinf(of_master.rod)):
        refused("an infinite rod carries no knuckle pin", "link_rod", "master")
    if np.any(np.not_equal(mechanism.crank, of_master.crank)):
        refused("it is that of its master; leave it out, or write 'like: MASTER'", "crank")
    if np.any(np.not_equal(mechanism.rod, of_master.rod)):
        refused("it is that of its master; the rod of its own is 'link_rod.length'", "rod")


def _refuse_other_pin(cylinder: Cylinder, master: Cylinder) -> None:
    """Raise RuleError for the stroke line of the master, and for another pin or place along the shaft."""
    between = cylinder.bank_angle - master.bank_angle
    if np.any(np.equal(between % 360.0, 0.0)):
        message = "a link rod has a stroke line of its own; this is its master's"
        refused(message, "bank_angle")
    position = cylinder.axial_position
    of_master = master.axial_position
    is_elsewhere = position is not None and of_master is None
    if position is not None and of_master is not None:
        is_elsewhere = bool(np.any(np.not_equal(position, of_master)))
    if is_elsewhere:
        refused("it is that of its master", "axial_position")
    if cylinder.crank_position not in (None, master.crank_position):
        message = "it follows from the pin of its master; leave it out"
        refused(message, "crank_position")
    if cylinder.throw_angle not in (None, master.throw_angle):
        refused("its pin is that of its master; leave it out", "throw_angle")


def _on_master(cylinder: Cylinder, master: Cylinder, link_rod: LinkRod) -> Cylinder:
    """Return a cylinder on the master rod: its mechanism, its masses, its pin and its place along the shaft."""
    mechanism = _linked_piston(cylinder, master, link_rod)
    masses, knuckle_mass = _masses_at_pins(cylinder.masses, link_rod)
    return replace(
        cylinder,
        mechanism=mechanism,
        masses=masses,
        link_rod=replace(link_rod, length=mechanism.length, knuckle_mass=knuckle_mass),
        crank_position=master.crank_position,
        throw_angle=master.throw_angle,
        axial_position=master.axial_position,
    )


def _linked_piston(cylinder: Cylinder, master: Cylinder, link_rod: LinkRod) -> LinkedPiston:
    """Return the mechanism; raises RuleError at the keys of a link rod that does not reach or turn."""
    assert isinstance(master.mechanism, SliderCrank)

    # what is not given: Γ for κ, L − k for l
    between = cylinder.bank_angle - master.bank_angle
    knuckle_angle = link_rod.knuckle_angle
    if knuckle_angle is None:
        knuckle_angle = between
    length = link_rod.length
    if length is None:
        length = master.mechanism.rod - link_rod.knuckle_radius
    try:
        return LinkedPiston(
            crank=master.mechanism.crank,
            master=master.mechanism,
            between=between,
            length=length,
            radius=link_rod.knuckle_radius,
            angle=knuckle_angle,
            own_offset=cylinder.mechanism.offset,
        )
    except RuleError as error:
        faults = []
        for fault in error.faults:
            key = str(fault.path[0])
            key = _KEYS.get(key, key)
            faults.append(fault._replace(path=("link_rod", key)))
        raise RuleError(*faults) from error


_KEYS = {"radius": "knuckle_radius"}
"""Field of the mechanism -> key of a link rod that has another name."""


def _masses_at_pins(masses: Masses | None, link_rod: LinkRod) -> tuple[Masses | None, float]:
    """Return the masses that move with the piston, and the mass in kg at the knuckle pin."""
    # those of the key, or of the connecting rod
    rod = masses.connecting_rod if masses else None
    mass = link_rod.mass
    share = link_rod.share
    if mass is None and rod is not None:
        mass = rod.mass
        share = rod.share
    if mass is None:
        return masses, 0.0
    if share is None:
        share = 0.5

    # the share at the piston pin moves to and fro, the rest with the knuckle pin
    at_piston = ConnectingRod(mass=mass * share, share=1.0)
    to_and_fro = replace(masses or Masses(), connecting_rod=at_piston)
    return to_and_fro, mass * (1 - share)
