"""Results in a notebook: the tables of the reports, and pictures, which are imported when they are shown."""

import os
import warnings
from html import escape
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kurbel.declared.unit_systems import SYSTEMS, messages_in
from kurbel.errors import KurbelError, UsageError
from kurbel.machine import Machine
from kurbel.machine_file.reader import machine_of
from kurbel.numerics.extreme import Extreme
from kurbel.quantity import Quantity
from kurbel.solver import case as solved
from kurbel.solver.figures import NotebookView, Results

if TYPE_CHECKING:
    from kurbel.pictures.picture import Picture


class ShownCase(solved.Case):
    """A machine with its results; machine: given itself, or as the path or the text of a machine file."""

    def __init__(self, machine: Machine | str | os.PathLike[str], count: int | None = None) -> None:
        described = machine_of(machine)
        super().__init__(described, count)
        if described.origin is None:
            _warn_of_numbers(described)


def _warn_of_numbers(machine: Machine) -> None:
    """Warn of a machine that was made in Python with numbers that are not in SI: mm for m, say."""
    from kurbel.notes.plausible import doubts_of

    for doubt in doubts_of(machine):
        warnings.warn(f"numbers are in SI: {doubt}", stacklevel=4)
        return


Case = ShownCase
"""Its name in Python: `kurbel.Case`."""


class Drawing(NamedTuple):
    """Pictures of a machine, one below the other; a notebook shows them."""

    pictures: "tuple[Picture, ...]"

    def __repr__(self) -> str:
        names = ", ".join(picture.id for picture in self.pictures)
        return f"<kurbel drawing of {names}: .save('NAME.svg'), .pictures>"

    def _repr_svg_(self) -> str:
        from kurbel.render import Look
        from kurbel.render.svg import svg_file

        return svg_file(self.pictures, Look())

    def save(self, file_name: str, paper: str = "a4") -> None:
        """Draw to a file that ends in .svg, .png or .pdf; paper: of a pdf, see `kurbel plot --paper`.

        Raises UsageError where it cannot be written.
        """
        from kurbel.render import Look
        from kurbel.render.drawing import draw_file

        draw_file(self.pictures, Look(), file_name, paper)


def draw(
    case: ShownCase, *names: str, units: str = "metric", angles: tuple[float, ...] | None = None
) -> Drawing:
    """Return pictures of a machine, by the words of `kurbel plot --list`; without names the most informative picture.

    units: `si`, `metric`, `technical` or `imperial`; angles: crank angles in degrees at which a mechanism is drawn.
    Raises UsageError for a picture or a system of units that does not exist.
    """
    from kurbel.pictures.picture_source import PictureOptions
    from kurbel.pictures.pictures import pictures

    if units not in SYSTEMS:
        raise UsageError(f"units: there is no '{units}'; there are {', '.join(SYSTEMS)}")
    with messages_in(units):
        return Drawing(tuple(pictures(case, names, PictureOptions(units, None, angles))))


def as_html(shown: solved.Case | Results) -> str:
    """Return the key values of results, or of every part of a machine, as HTML."""
    if isinstance(shown, Results):
        return _key_values(shown, "Key values")
    machine = shown.machine
    parts: list[tuple[str, Results]] = [
        (cylinder.drive.name, cylinder) for cylinder in shown.cylinders
    ]
    if len(parts) != 1 or machine.flywheel:
        parts.append(("whole machine", shown.flywheel))
    tables = "".join(_key_values(results, name) for name, results in parts)
    return f"<h3>{escape(machine.name)}</h3>\n{tables}"


def _key_values(results: Results, caption: str) -> str:
    """Return a table, or the reason why there is none."""
    from kurbel.render import Look
    from kurbel.render.markup import Html, written
    from kurbel.render.text_tables import key_value_table
    from kurbel.tables.shown import shown_key_values

    with np.errstate(all="ignore"):
        try:
            in_si = list[tuple[Quantity, object]]()
            for figure in results.key_values().values():
                value: object = figure.value
                if figure.degrees is not None:
                    value = Extreme(figure.value, figure.degrees)
                in_si.append((figure.quantity, value))
            key_values = shown_key_values(in_si, "metric")
        except KurbelError as error:
            return f"<p>{escape(str(error))}</p>"
    out = Html(Look("html"))
    return "".join(written([key_value_table(caption, key_values, out.look)], out))


NotebookView.as_html = as_html
