"""Machines and their pictures, for the tests of this folder."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from kurbel.machine_file import loads
from kurbel.report.pictures import pictures, pictures_of
from kurbel.report.pictures.picture import Picture
from kurbel.report.pictures.source import FILE, Wish
from kurbel.solver.case import Case
from representative import case_of

BAD_NAME = "<script>alert(1)</script> \x1b[31m & \"'"
"""Markup, an escape sequence (which a machine file refuses, but Python does not), and quotation marks."""


@cache
def named() -> Case:
    """A machine whose name is an attack."""
    machine = loads("{speed: 50 rpm, stroke: 800 mm, rod_ratio: 5, masses: {piston: 100 kg}}")
    return Case(replace(machine, name=BAD_NAME))


@cache
def drawn(name: str, id: str, fineness: float = FILE) -> tuple[Picture, ...]:
    """A picture of a shipped machine; of its first cylinder, where it shows one."""
    case = case_of(name)
    first = case.cylinders[0].drive.name if case.cylinders else None
    return tuple(pictures(case, (id,), Wish(fineness=fineness, cylinder=first)))


def ids_of(name: str) -> tuple[str, ...]:
    """The pictures of a shipped machine."""
    return tuple(one.id for one in pictures_of(case_of(name), Wish()))
