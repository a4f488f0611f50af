"""The parts of a report, independent of the output format, and the crank angles of its rows. Needs no numpy."""

import math
from array import array
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple, Union

from kurbel.declared.reading import shown
from kurbel.errors import NoSolutionError, UsageError

Value = Union[float, int, None]


class Column(NamedTuple):
    """One quantity over the crank angle, in the unit that is shown; values are None where there is none.

    values: a tuple, or an array of doubles, which takes a quarter of the memory.
    decimals: number of decimals in print, if fixed, to keep the digits of a source.
    marked: indices of the values that have an asterisk in print.
    alone: significant digits if each value has its own scale, as errors over many powers of ten; 0 for a common scale.
    size: the largest value of the whole curve, if the values here are only rounding errors relative to it; else 0.
    """

    id: str
    symbol: str
    ascii_symbol: str
    unit: str
    values: Sequence[Value]
    text: str = ""
    decimals: int | None = None
    marked: tuple[int, ...] = ()
    alone: int = 0
    size: float = 0.0


class KeyValue(NamedTuple):
    """One key value, already in its unit; a tuple for a list of angles; `at_deg`: crank angle of an extreme.

    noise: the value is only rounding error, printed with digits in JSON only; heading: see `Quantity`.
    """

    id: str
    symbol: str
    ascii_symbol: str
    unit: str
    value: Value | tuple[float, ...]
    text: str
    at_deg: float | None = None
    noise: bool = False
    heading: str = ""


class LeftOut(NamedTuple):
    """A result that was neither computed nor printed, and why."""

    what: str
    why: str


class PlaceTable(NamedTuple):
    """A table whose rows are named places instead of crank angles; `id` names it in csv and json.

    heads: titles of the names, such as (part, place), or none.
    names: of each row, one for each head; a blank is _ unless headed.
    headed: the heads are printed, and the names as they are; otherwise a _ is printed as a blank.
    in_note: a note has the whole content, so that the table is not printed.
    """

    id: str
    title: str
    heads: tuple[str, ...]
    names: tuple[tuple[str, ...], ...]
    columns: tuple[Column, ...]
    headed: bool = False
    in_note: bool = False


PISTONS = "pistons"
"""The table of places that is a list of key values in JSON, and not in CSV."""


class Part(NamedTuple):
    """The results of one cylinder, L/R or scene, or of the whole machine; the first column is the crank angle.

    name: of the cylinder, or the L/R as a number; of: the cylinder that a pin belongs to. nowhere: why `--where` finds
    no row.
    """

    name: str | float
    columns: tuple[Column, ...]
    key_values: tuple[KeyValue, ...] = ()
    left_out: tuple[LeftOut, ...] = ()
    warnings: tuple[str, ...] = ()
    place_tables: tuple[PlaceTable, ...] = ()
    nowhere: str = ""
    of: str = ""


class InputFile(NamedTuple):
    """A file that was read, and its bytes; None if it no longer exists."""

    file: str
    content: bytes | None


class Provenance(NamedTuple):
    """What results depend on: files, values set over those of the machine file, and versions of libraries."""

    inputs: tuple[InputFile, ...]
    overrides: tuple[str, ...]
    versions: dict[str, str]


class Report(NamedTuple):
    """The output of one command.

    title: printed above everything; command and machine as in JSON (`machine` is None
    for `kurbel table`); group: `cylinders`, `bearings`, `ratios` or `scenes`, the JSON key of `parts`; whole: the
    results of the whole machine, if any; mirrored: what changes for the angles 360° − φ, which then have a second head
    line (empty: none); notes: sentences below the table; head: sentences right below the title; provenance: returns
    it, None where no file was read; cylinders: the names of all that the machine has.
    """

    title: str
    command: str
    machine: str | None
    group: str
    parts: tuple[Part, ...]
    whole: Part | None = None
    mirrored: str = ""
    notes: tuple[str, ...] = ()
    head: tuple[str, ...] = ()
    provenance: Callable[[], Provenance] | None = None
    cylinders: tuple[str, ...] = ()

    @property
    def all_parts(self) -> tuple[Part, ...]:
        """The parts, and the whole machine after them."""
        return self.parts if self.whole is None else (*self.parts, self.whole)

    @property
    def printed_tables(self) -> Iterator[PlaceTable]:
        """The tables of places that are printed for people."""
        return (table for part in self.all_parts for table in part.place_tables if not table.in_note)

    def of_cylinder(self, name: str) -> "Report":
        """Return the results of one part, or of all parts of a cylinder, given by name or number.

        Raises UsageError if there are none, or if a cylinder has the number of another as its name; NoSolutionError if
        no row of it is found.
        """
        name = cylinder_meant(name, self.cylinders)
        found = tuple(part for part in self.parts if name in (part.name, part.of))
        if not found:
            there = ", ".join(str(part.name) for part in self.parts) or "the whole machine only"
            raise UsageError(
                f"--cylinder: kurbel {self.command} has no results of '{shown(name)}'; it has those of {there}"
            )
        if nowhere := found[0].nowhere:
            raise NoSolutionError(nowhere)
        title = f"{self.title}: {name}" if len(self.all_parts) > 1 else self.title
        return self._replace(title=title, parts=found, whole=None)

    def changed(self, change: Callable[[Part], Part]) -> "Report":
        """Return the report with another part in place of each."""
        return self._replace(parts=tuple(map(change, self.parts)), whole=self.whole and change(self.whole))

    def key_values_alone(self) -> "Report":
        """Return the report without its tables."""
        return self.changed(lambda part: part._replace(columns=(), place_tables=()))


def cylinder_meant(name: str, cylinders: Sequence[str]) -> str:
    """Return the name of the cylinder with this name or number from 1; any other name unchanged.

    Raises UsageError if a cylinder has the number of another as its name.
    """
    numbered = dict(zip(map(str, range(1, len(cylinders) + 1)), cylinders))
    if numbered.get(name, name) != name and name in cylinders:
        own = cylinders.index(name) + 1
        raise UsageError(
            f"--cylinder: '{name}' is the name of cylinder {own} and the number of '{shown(numbered[name])}'; "
            f"write '{own}' or '{shown(numbered[name])}'"
        )
    return numbered.get(name, name)


# crank angles of the rows

MOST_ROWS = 1_500_000
"""Most rows of all cylinders together; more would need over half a gigabyte of memory."""


def stepped(step: float, end: float, parts: int = 1) -> Sequence[float]:
    """Return 0, step, 2 step, … up to `end`, and `end` itself, in degrees; parts: as for `check_rows`.

    >>> list(stepped(70, 180))
    [0.0, 70.0, 140.0, 180.0]

    Raises UsageError for a step that is not positive or gives too many rows.
    """
    if not 0 < step < math.inf:
        raise UsageError("--step must be a positive number of degrees")
    check_rows(end / step, parts)
    # steps are multiplied, not added up, and 3 · 0.1 is rounded to 0.3, so that no rounding error accumulates
    count = math.ceil(end / step * (1 - 1e-12))
    angles = array("d", (float(f"{i * step:.15g}") for i in range(count)))
    angles.append(end)
    return angles


def check_rows(angles: float, parts: int) -> None:
    """Raise UsageError for a table that is too long; parts: number of cylinders or L/R with these angles."""
    if angles * parts > MOST_ROWS:
        each = f" for each of {parts}" if parts > 1 else ""
        raise UsageError(
            f"{angles:.7g} crank angles{each} give more than {MOST_ROWS} rows; take a larger --step or fewer --angles"
        )


def crank_angles(step: float, angles: Sequence[float] | None, end: float, parts: int) -> Sequence[float]:
    """Return the given angles, or 0, step, 2 step, … `end` in degrees; parts: see `check_rows`."""
    if angles is None:
        return stepped(step, end, parts)
    check_rows(len(angles), parts)
    return angles
