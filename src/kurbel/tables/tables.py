"""The parts of a report, independent of the output format, its rows, and what people are shown. Needs no numpy."""

import math
import re
from array import array
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from itertools import chain, groupby
from typing import NamedTuple, TypeVar, Union

from kurbel.declared.reading import text_in_one_line
from kurbel.errors import NoSolutionError, UsageError

CellValue = Union[float, int, None]


class Column(NamedTuple):
    """One quantity over the crank angle, in the unit that is shown; values are None where there is none.

    values: a tuple, or an array of doubles, which takes a quarter of the memory.
    decimals: number of decimals in print, if fixed, to keep the digits of a source.
    marked: indices of the values that have an asterisk in print.
    alone: significant digits if each value has its own scale, as errors over many powers of ten; 0 for a common scale.
    size: the largest value of the whole curve, if the values here are only rounding errors relative to it; else 0.
    minor: for programs, and for people who name it: 0 at every angle, or the same as another row.
    for_entry: see `Quantity`.
    """

    id: str
    symbol: str
    ascii_symbol: str
    unit: str
    values: Sequence[CellValue]
    text: str = ""
    decimals: int | None = None
    marked: tuple[int, ...] = ()
    alone: int = 0
    size: float = 0.0
    minor: bool = False
    for_entry: bool = False


class KeyValue(NamedTuple):
    """One key value, already in its unit; a tuple for a list of angles; `at_deg`: crank angle of an extreme.

    noise: the value is only rounding error, printed with digits in JSON only; heading: see `Quantity`; minor: for
    programs, and for people who name it, as what other rows have, too; side: `before` where the extreme is the limit
    before a jump, while tables show what is just after it; for_entry: see `Quantity`.
    """

    id: str
    symbol: str
    ascii_symbol: str
    unit: str
    value: CellValue | tuple[float, ...]
    text: str
    at_deg: float | None = None
    noise: bool = False
    heading: str = ""
    minor: bool = False
    side: str = ""
    for_entry: bool = False


class LeftOut(NamedTuple):
    """A result that was neither computed nor printed, and why."""

    what: str
    why: str


class PlaceTable(NamedTuple):
    """A table whose rows are named places instead of crank angles; `id` names it in csv and json.

    heads: titles of the names, such as (part, place), or none.
    names: of each row, one for each head; as programs have them unless headed.
    headed: the heads are printed, and the names as they are; otherwise a _ is printed as a blank.
    words: what people read for names in which more than the blanks is different.
    in_note: a note has the whole content, so that the table is not printed.
    """

    id: str
    title: str
    heads: tuple[str, ...]
    names: tuple[tuple[str, ...], ...]
    columns: tuple[Column, ...]
    headed: bool = False
    in_note: bool = False
    words: Mapping[str, str] = {}


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
    for `kurbel table`); group: `cylinders`, `bearings`, `throws`, `ratios` or `scenes`, the JSON key of `parts`; whole: the
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
        if self.whole is None:
            return self.parts
        return (*self.parts, self.whole)

    @property
    def printed_tables(self) -> Iterator[PlaceTable]:
        """The tables of places that are printed for people."""
        for part in self.all_parts:
            for table in part.place_tables:
                if not table.in_note:
                    yield table

    @property
    def is_of_one_cylinder(self) -> bool:
        """Whether it has the forces of an only cylinder, and of the whole machine the totals of its pistons."""
        return self.command == "forces" and len(self.cylinders) == len(self.parts) == 1

    def of_cylinder(self, name: str) -> "Report":
        """Return the results of one part, or of all parts of a cylinder, given by name or number.

        Raises UsageError if there are none, or if a cylinder has the number of another as its name; NoSolutionError if
        no row of it is found.
        """
        name = cylinder_meant(name, self.cylinders)
        parts = tuple(part for part in self.parts if name in (part.name, part.of))
        if not parts:
            listed = ", ".join(str(part.name) for part in self.parts) or "the whole machine only"
            raise UsageError(
                f"--cylinder: kurbel {self.command} has no results of '{text_in_one_line(name)}'; "
                f"it has those of {listed}"
            )
        if parts[0].nowhere:
            raise NoSolutionError(parts[0].nowhere)
        title = f"{self.title}: {name}" if len(self.all_parts) > 1 else self.title
        return self._replace(title=title, parts=parts, whole=None)

    def changed(self, change: Callable[[Part], Part]) -> "Report":
        """Return the report with another part in place of each."""
        return self._replace(
            parts=tuple(map(change, self.parts)), whole=self.whole and change(self.whole)
        )

    def key_values_alone(self) -> "Report":
        """Return the report without its tables."""
        return self.changed(lambda part: part._replace(columns=(), place_tables=()))


def cylinder_meant(name: str, cylinders: Sequence[str]) -> str:
    """Return the name of the cylinder with this name or number from 1; any other name unchanged.

    Raises UsageError if a cylinder has the number of another as its name.
    """
    numbered = dict(zip(map(str, range(1, len(cylinders) + 1)), cylinders))
    if numbered.get(name, name) != name and name in cylinders:
        number = cylinders.index(name) + 1
        other = text_in_one_line(numbered[name])
        raise UsageError(
            f"--cylinder: '{name}' is the name of cylinder {number} and the number of '{other}'; "
            f"write '{number}' or '{other}'"
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
        repeated = f" for each of {parts}" if parts > 1 else ""
        raise UsageError(
            f"{angles:.7g} crank angles{repeated} give more than {MOST_ROWS} rows; take a larger --step or fewer --angles"
        )


def table_angles(
    step: float, angles: Sequence[float] | None, end: float, parts: int
) -> Sequence[float]:
    """Return the given angles, or 0, step, 2 step, … `end` in degrees; parts: see `check_rows`."""
    if angles is None:
        return stepped(step, end, parts)
    check_rows(len(angles), parts)
    return angles


# what people are shown: identical cylinders, pins and bearings once; on a low terminal a first selection

BEFORE = "before"
"""Side of an extreme that is the limit before a jump."""
_JUMPS = "− after an angle: just before the jump there."


def notes_for_people(report: Report) -> tuple[str, ...]:
    """Return the notes of a report, with that on extremes before a jump where it has any."""
    has_jumps = False
    for part in report.all_parts:
        shown = (key_value for key_value in part.key_values if not key_value.minor)
        has_jumps = has_jumps or any(key_value.side == BEFORE for key_value in shown)
    notes = [report.mirrored, *report.notes, _JUMPS if has_jumps else ""]
    return tuple(note for note in notes if note)


_NUMBERED = re.compile(r"(.*\D)(\d{1,9})$")
Grouped = TypeVar("Grouped")


def joined_names(names: Sequence[str]) -> str:
    """Return several names as one text; names that differ only in a number are listed by their numbers.

    >>> joined_names(["cylinder 1", "cylinder 2", "cylinder 3", "cylinder 6"]), joined_names(["HP", "LP"])
    ('cylinders 1–3, 6', 'HP, LP')
    >>> joined_names(["pin of left 1", "pin of right 1", "pin of left 2", "pin of right 2"])
    'pin of left 1, 2, right 1, 2'
    """
    texts = []
    for group in grouped(names, lambda name: _NUMBERED.sub(r"\1", name)):
        if len(group) == 1:
            texts.append(group[0])
        else:
            stem = _NUMBERED.sub(r"\1", group[0]).replace("cylinder ", "cylinders ")
            texts.append(stem + _numbers_in_runs(group))

    # what all texts begin with is said once
    head, of, _ = texts[0].rpartition(" of ")
    beginning = head + of
    if not all(text.startswith(beginning) for text in texts):
        beginning = ""
    return beginning + ", ".join(text.removeprefix(beginning) for text in texts)


def _numbers_in_runs(names: Iterable[str]) -> str:
    """Return the numbers at the ends of names, runs of three and more from the first to the last."""
    matches = (_NUMBERED.fullmatch(name) for name in names)
    numbers = [int(match.group(2)) for match in matches if match]
    texts = []
    for _, run in groupby(enumerate(numbers), lambda pair: pair[1] - pair[0]):
        span = [number for _, number in run]
        texts.append(f"{span[0]}–{span[-1]}" if len(span) > 2 else ", ".join(map(str, span)))
    return ", ".join(texts)


def grouped(items: Iterable[Grouped], key: Callable[[Grouped], Hashable]) -> list[list[Grouped]]:
    """Return the items in groups of equal key, in order of first occurrence."""
    groups: dict[Hashable, list[Grouped]] = {}
    for item in items:
        groups.setdefault(key(item), []).append(item)
    return list(groups.values())


def for_people(report: Report) -> Report:
    """Return the report without what only programs are to read, and with identical parts merged into one."""
    report = shown_once(report)
    titles = [table.title for table in report.printed_tables]

    def printed(part: Part) -> Part:
        columns = tuple(column for column in part.columns if not column.minor)
        key_values = tuple(key_value for key_value in part.key_values if not key_value.minor)
        are_angles_alone = len(columns) < 2 and len(columns) < len(part.columns)
        if are_angles_alone:
            columns = ()
        tables = tuple(named(table, part) for table in part.place_tables)
        return part._replace(columns=columns, key_values=key_values, place_tables=tables)

    def named(table: PlaceTable, part: Part) -> PlaceTable:
        if titles.count(table.title) > 1:
            return table._replace(title=f"{table.title}: {part.name}")
        return table

    return report.changed(printed)


def shown_once(report: Report) -> Report:
    """Return the report with identical parts merged into one; the title names them if no other part is left.

    Pins and bearings are identical if their key values are, at any crank angles; cylinders, if in addition their tables
    over their own crank angle are.
    """
    if len(report.parts) < 2 or report.group not in ("cylinders", "bearings"):
        return report
    are_bearings = report.group == "bearings"
    groups = grouped(report.parts, _loads if are_bearings else _content)
    if len(groups) == len(report.parts):
        return report

    parts = []
    for group in groups:
        name = joined_names([str(part.name) for part in group])
        warnings = dict.fromkeys(chain.from_iterable(part.warnings for part in group))
        parts.append(group[0]._replace(name=name, warnings=tuple(warnings)))
    is_alone = len(parts) == 1 and report.whole is None
    return report._replace(
        parts=tuple(parts),
        title=f"{report.title}: {parts[0].name}" if is_alone else report.title,
        notes=(*report.notes, _SHIFTED) if are_bearings else report.notes,
    )


def _loads(part: Part) -> Hashable:
    """Return a value that is the same for pins and bearings with equal loads."""
    return equal_loads(str(part.name), part.of, part.key_values), part.left_out


def _content(part: Part) -> Hashable:
    """Return a value that is the same for cylinders with equal tables and key values."""
    columns = list(part.columns)
    for table in part.place_tables:
        columns += table.columns
    curves = tuple((column.id, column.unit, _nine_digits(column.values)) for column in columns)
    titles = tuple((table.title, table.names) for table in part.place_tables)
    return curves, _figures(part.key_values), part.left_out, titles


def _left_out_in_short(parts: Iterable[Part]) -> tuple[str, ...]:
    """Return what parts leave out as one sentence, each reason once."""
    reasons = dict[str, list[str]]()
    all_left_out = dict.fromkeys(chain.from_iterable(part.left_out for part in parts))
    for left_out in all_left_out:
        reasons.setdefault(left_out.why, []).append(left_out.what)
    texts = [f"{', '.join(what)} ({why})" for why, what in reasons.items()]
    if not texts:
        return ()
    return (f"Left out: {'; '.join(texts)}.",)


def first_selection(report: Report, ids: Sequence[str], across: int, rows: int) -> Report:
    """Return the report with only these columns, key values and tables, what it leaves out in a sentence, and warnings.

    Key values have the order of the ids.

    across: the largest number of crank angles; rows: the largest number of rows of a table. Without ids all columns and
    key values stay, and the tables of the whole machine, if it has any.
    """
    left_out = _left_out_in_short(report.all_parts)
    report = shown_once(report)
    if ids and report.is_of_one_cylinder:
        report = report._replace(whole=None)
    order = {id: number for number, id in enumerate(ids)}
    of_whole = report.whole is not None and bool(report.whole.place_tables)

    def chosen(part: Part) -> Part:
        tables = part.place_tables
        if ids:
            tables = tuple(table for table in tables if table.id in ids)
        elif of_whole and part is not report.whole:
            tables = ()
        return part._replace(
            columns=_first_columns(part, ids, across),
            key_values=_first_key_values(part.key_values, order),
            place_tables=tuple(_first_rows(table, rows) for table in tables),
            left_out=(),
        )

    way_on = (
        f"First selection. All columns, angles and key values: kurbel {report.command} FILE --all"
    )
    selected = report.changed(chosen)._replace(notes=left_out, head=(*report.head, way_on))
    notes = " ".join(notes_for_people(selected))
    return selected._replace(notes=(notes,) if notes else ())


def _first_columns(part: Part, ids: Sequence[str], across: int) -> tuple[Column, ...]:
    """Return the angles and the columns with these ids, all without ids, at fewer angles than `across`."""
    columns = [column for column in part.columns if not column.minor]
    if ids:
        # of an id that both a column and a key value have the key value is meant
        wanted = set(ids) - {key_value.id for key_value in part.key_values}
        columns = columns[:1] + [column for column in columns[1:] if column.id in wanted]
    last = len(columns[0].values) - 1 if len(columns) > 1 else 0
    if not last:
        return ()

    # the last angle stays: the steps are a part of all
    def fits(step: int) -> bool:
        return last % step == 0 and last // step < across

    step = next(filter(fits, range(1, last)), 1)
    return tuple(column._replace(values=column.values[::step], marked=()) for column in columns)


def _first_rows(table: PlaceTable, rows: int) -> PlaceTable:
    """Return the first rows of a table of places."""
    columns = tuple(column._replace(values=column.values[:rows]) for column in table.columns)
    return table._replace(names=table.names[:rows], columns=columns)


def _first_key_values(
    key_values: Sequence[KeyValue], order: Mapping[str, int]
) -> tuple[KeyValue, ...]:
    """Return the key values that have a place in an order, in it; without any order those that people are shown."""
    shown = [key_value for key_value in key_values if not key_value.minor]
    if not order:
        return tuple(shown)
    chosen = [key_value._replace(heading="") for key_value in shown if key_value.id in order]
    return tuple(sorted(chosen, key=lambda key_value: order[key_value.id]))


_SHIFTED = "Pins and bearings named together carry equal loads, each at its own crank angles; those of the first are shown."


def equal_loads(name: str, of: str, key_values: Iterable[KeyValue]) -> Hashable:
    """Return a value that is the same for equally loaded bearings of one kind; of: the cylinder of a pin."""
    return name.removesuffix(of).rstrip("0123456789"), _figures(key_values)


def _figures(key_values: Iterable[KeyValue]) -> Hashable:
    """Return the key values without their crank angles, to nine digits of the largest one of the same unit."""
    ids = []
    by_unit = dict[str, list[CellValue]]()
    for key_value in key_values:
        ids.append(key_value.id)
        if not key_value.noise:
            value = key_value.value
            numbers = value if isinstance(value, tuple) else (value,)
            by_unit.setdefault(key_value.unit, []).extend(numbers)
    rounded = tuple((unit, _nine_digits(values)) for unit, values in by_unit.items())
    return tuple(ids), rounded


def _nine_digits(values: Sequence[CellValue]) -> Hashable:
    """Return the largest of these values, and a hash of all relative to it, both rounded to nine digits."""
    numbers = [value for value in values if value is not None]
    gaps = tuple(row for row, value in enumerate(values) if value is None)
    largest = max(map(abs, numbers), default=0.0) or 1.0
    relative = tuple(round(number / largest, 9) for number in numbers), gaps
    return f"{largest:.9g}", hash(relative)  # the values of a long table would take much memory
