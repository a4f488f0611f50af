"""Options shared by the commands: how their texts are read, what a shell completes, what they mean."""

import os
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial, wraps
from typing import TYPE_CHECKING, Any, TypeVar

import click

from kurbel.declared.numerals import parse_ratio
from kurbel.declared.unit_systems import told_in
from kurbel.declared.units import kinds, parse_quantity, written_unit
from kurbel.errors import KurbelError, UnitError
from kurbel.render import FORMATS, LAYOUTS, Look
from kurbel.report.tables import Report

if TYPE_CHECKING:
    from kurbel.machine import Machine
    from kurbel.report.frame import Frame
    from kurbel.solver.case import Case

# --- how the text behind an option is read; what cannot be read is reported with the option

Command = TypeVar("Command", bound=Callable[..., Any])
Item = TypeVar("Item")
Value = TypeVar("Value")
_MOST_STEPS = 10_000


def _told(read: Callable[[str], Value], text: str) -> Value:
    """Return what is read; what the units refuse is told as click tells it."""
    try:
        return read(text)
    except UnitError as error:
        raise click.BadParameter(str(error)) from None


def number(text: str | float) -> float:
    """Return a finite number with a decimal point, also 10/3 or 75 %."""
    if not isinstance(text, str):  # what stands for it where it is not given
        return text
    return _told(parse_ratio, text)


def numbers(text: str) -> tuple[float, ...]:
    """Return numbers separated by commas, in the order given; or from, to, by steps: `0.5:12:0.5`."""
    found = tuple(map(number, text.replace(":", ",").split(",")))
    if ":" not in text:
        return found
    # 3 · 0.1 is written 0.3
    return tuple(float(f"{one:.15g}") for one in _stepped(found, text, "0.5:12:0.5"))


def words(text: str) -> tuple[str, ...]:
    """Return words separated by commas, in the order given, without those that are empty, one at least."""
    found = tuple(word.strip() for word in text.split(",") if word.strip())
    if not found:
        raise click.BadParameter(f"'{text}' names no column; leave the option out, or name one")
    return found


def columns(text: str) -> tuple[str, ...]:
    """Return the ids of columns by id or printed symbol, separated by commas, in the order given."""
    from kurbel.quantities import every_quantity
    from kurbel.quantity import ambiguity, called, joined

    named = words(text)
    known = [column for column in every_quantity().all_columns if column.commands]

    def only(name: str) -> str:
        found = called(name, known)
        if wrong := ambiguity(name, found):
            raise click.BadParameter(wrong)
        return found[0] if found else name  # the report knows what this machine has

    return tuple(map(only, joined(named, known)))


def speeds(text: str) -> tuple[float, ...]:
    """Return speeds in revolutions per second, in the order given.

    They have one unit or each its own: `300, 350 rpm`; or they go from, to, by steps: `300:1500:10 rpm`.
    """
    each = text.replace(":", ",").split(",")
    unit = written_unit(each[-1])
    found = tuple(
        _told(lambda one: parse_quantity(one, "speed"), one if written_unit(one) else f"{one} {unit}".strip())
        for one in each
    )
    if ":" in text:
        found = _stepped(found, text, "300:1500:10 rpm")
    if not all(speed > 0 for speed in found):
        raise click.BadParameter(f"'{text}': a speed is more than 0")
    return found


def _stepped(found: tuple[float, ...], text: str, sample: str) -> tuple[float, ...]:
    if len(found) != 3 or "," in text or not found[2] > 0 or found[1] < found[0]:
        raise click.BadParameter(f"'{text}': write from, to and step as '{sample}'")
    low, high, step = found
    count = (high - low) / step
    if count > _MOST_STEPS:
        raise click.BadParameter(f"'{text}': more than {_MOST_STEPS} steps; take larger ones")
    return tuple(low + step * index for index in range(int(count + 1e-9) + 1))


def spread(text: str) -> tuple[str, str]:
    """Return a dotted key with its standard uncertainty as a text."""
    from kurbel.declared.forms.values import spread_text

    key, _, size = text.partition("=")
    if not (key.strip() and spread_text(size)):
        raise click.UsageError(f"--uncertainty {text}: write KEY=SPREAD, above 0, such as bore='0.2 mm'.")
    return key.strip(), spread_text(size)


# --- what a shell completes, looked up when TAB is pressed

_PACKAGE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
# a wheel carries the machines inside the package; in a checkout they lie beside src, where people look for them
_PLACES = (os.path.join(_PACKAGE, "configs"), os.path.join(_PACKAGE, os.pardir, os.pardir, "configs"))


def shipped() -> dict[str, str]:
    """Return the machines that come with kurbel: the path of each file by its name."""
    folder = next(filter(os.path.isdir, _PLACES))
    names = sorted(name.removesuffix(".yaml") for name in os.listdir(folder) if name.endswith(".yaml"))
    return {name: os.path.join(folder, f"{name}.yaml") for name in names}


def _beginning(words: Iterable[str], begun: str, before: str = "") -> list[str]:
    return [before + word for word in words if word.startswith(begun)]


def complete_key(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
    """Return the keys of the machine file that begin like this."""
    from kurbel.report.keys import every_place

    return _beginning(every_place(), incomplete)


def complete_kind(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
    """Return the kinds of quantities that begin like this."""
    return _beginning(kinds(), incomplete)


def complete_override(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
    """Return the keys for `KEY=VALUE`, each with its equals sign; of a value nothing."""
    return [] if "=" in incomplete else [f"{key}=" for key in complete_key(ctx, param, incomplete)]


def complete_columns(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
    """Return the columns of the command that may follow those named already."""
    from kurbel.quantities import every_quantity

    named, comma, begun = incomplete.rpartition(",")
    known = [one for one in every_quantity().columns(ctx.info_name or "") if one not in named.split(",")]
    return _beginning(known, begun, named + comma)


def complete_example(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
    """Return the shipped machines that begin like this."""
    return _beginning(shipped(), incomplete)


def complete_cylinder(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
    """Return the cylinders of the machine file on the line; none where it cannot be read."""
    machine = _machine_of(ctx)
    return _beginning((one.name for one in machine.cylinders), incomplete) if machine else []


def complete_case(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
    """Return the load cases of the machine file on the line; none where it cannot be read."""
    machine = _machine_of(ctx)
    return _beginning((one.name for one in machine.cases), incomplete) if machine else []


def _machine_of(ctx: click.Context) -> "Machine | None":
    from kurbel.machine_file import load

    file = next(iter(ctx.args), "")  # a line that ends in an option is not read to its end
    try:
        return load(file) if file and file != "-" else None
    except KurbelError:
        return None


def complete_picture(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
    """Return the pictures that begin like this."""
    from kurbel.report.pictures import PICTURES

    return _beginning((*(one.id for one in PICTURES), "all"), incomplete)


# --- the options


@dataclass(frozen=True, eq=False)
class Output:
    """Where a report goes and how it looks."""

    look: Look
    file_name: str | None

    def write(self, report: Report) -> None:
        """Write the report."""
        from kurbel.render.formats import write_report

        write_report(report, self.look, self.file_name)


def stacked(*options: Callable[[Command], Command]) -> Callable[[Command], Command]:
    """Return what gives a command these options, in this order of its help."""

    def decorate(command: Command) -> Command:
        for option in reversed(options):
            command = option(command)
        return command

    return decorate


case_option = click.option(
    "--case",
    "case_name",
    default="",
    metavar="NAME",
    shell_complete=complete_case,
    help="This load case of FILE; --set sets values over those of the case.",
)
set_option = click.option(
    "--set",
    "overrides",
    multiple=True,
    metavar="KEY=VALUE",
    shell_complete=complete_override,
    help="This value instead of that of FILE, such as cylinders.0.bore='450 mm'; may be repeated.",
)
set_options = stacked(case_option, set_option)
"""Values over those of a file: those of a load case of it, and others over these."""
machine_file = stacked(click.argument("file", metavar="FILE", type=click.Path(allow_dash=True)), set_options)
"""The machine file, or - for standard input, and values over those in it."""

angle_options = stacked(
    click.option(
        "--step",
        type=number,
        default=10.0,
        metavar="DEGREES",
        help="Step of the crank angle; 10 if not given.",
    ),
    click.option(
        "--angles",
        type=numbers,
        metavar="A,B,...",
        help="These crank angles in degrees instead of a step; or FROM:TO:STEP.",
    ),
)
"""`--step` and `--angles`: see `crank_angles`."""

columns_option = click.option(
    "--columns",
    type=columns,
    metavar="ID,ID,...",
    help="Only these columns, by id or symbol, in this order.",
    shell_complete=complete_columns,
)
_part_options = stacked(
    click.option(
        "--cylinder", metavar="NAME", help="Only this cylinder, by name or number.", shell_complete=complete_cylinder
    ),
    click.option("--key-values", "key_values_only", is_flag=True, help="Only the key values, no table."),
)
units_option = click.option(
    "--units",
    type=click.Choice(["si", "metric", "technical", "imperial"]),
    help="metric: mm, bar, kN, the default of tables and markdown; technical: mm, kgf, at, as the old books; "
    "imperial: in, lbf, psi; si: the default of csv and json.",
)
width_option = click.option(
    "--width", type=click.IntRange(20, 100_000), metavar="N", help="Columns to fill; a terminal's own if not given."
)
output_option = click.option(
    "--output", "-o", "file_name", metavar="FILE", help="Write to this file instead of standard output."
)
number_options = stacked(
    click.option("--decimal", type=click.Choice(["point", "comma"]), default="point", help="Decimal sign."),
    click.option("--digits", type=click.IntRange(1, 17), help="Significant digits; 4 if not given."),
)
_look_options = stacked(
    click.option(
        "--layout", type=click.Choice(LAYOUTS), default="book", help="book: angles across; rows: one line per angle."
    ),
    click.option(
        "--format",
        "-f",
        "format",
        type=click.Choice(FORMATS),
        help="By the suffix of --output, or table, if not given.",
    ),
    output_option,
    click.option(
        "--decimal",
        type=click.Choice(["point", "comma"]),
        default="point",
        help="Decimal sign; a comma makes csv use ';'.",
    ),
    click.option(
        "--digits", type=click.IntRange(1, 17), help="Significant digits; if not given 4, and all in csv and json."
    ),
    width_option,
)

orders_option = click.option(
    "--orders",
    type=numbers,
    metavar="A,B,...",
    help="Only these orders, periods per turn of the shaft, or FROM:TO:STEP; all up to 24 if not given.",
)
speeds_option = click.option(
    "--speeds", type=speeds, metavar="'A,B,... rpm'", help="Also at these speeds; or 'FROM:TO:STEP rpm'."
)
where_option = click.option(
    "--where", metavar="'COLUMN = VALUE'", help="Rows where a column has a value, such as 'b = 1/6 b_max'."
)
row_options = stacked(
    where_option,
    click.option(
        "--over", type=click.Choice(["x"]), help="Rows over the stroke, both ways, every --step percent of it."
    ),
    click.option("--compare", is_flag=True, help="Approximations of the book (R 286-291, 297) beside them."),
)
uncertainty_option = click.option(
    "--uncertainty",
    "spreads",
    type=spread,
    multiple=True,
    metavar="KEY=SPREAD",
    help="Standard uncertainty of a value of FILE, such as bore='0.2 mm' or '2 %'; may be repeated.",
)

_SUFFIXES = {
    ".csv": "csv",
    ".json": "json",
    ".md": "markdown",
    ".markdown": "markdown",
    ".html": "html",
    ".tex": "latex",
}
_OF_NO_FORMAT = ("", ".txt", ".yaml", ".yml")
"""Suffixes that a table may have, and those of machine files, which are refused where they are read."""


def format_of(asked: str | None, file_name: str | None, suffixes: Mapping[str, str] = _SUFFIXES) -> str:
    """Return the format that is asked for, or that of the suffix of the file; UsageError where the two contradict."""
    suffix = os.path.splitext(file_name or "")[1].lower()
    of_suffix = suffixes.get(suffix)
    if not (asked or of_suffix or suffix in _OF_NO_FORMAT):
        known = ", ".join(suffixes)
        raise click.UsageError(f"--output {file_name}: no format has this suffix; write {known}, .txt, or --format.")
    if asked and of_suffix and asked != of_suffix:
        raise click.UsageError(
            f"--format {asked} contradicts the name {file_name}, which says {of_suffix}; change one of them."
        )
    return asked or of_suffix or "table"


def output_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Give a command the options of what it prints, which reach it as one `output: Output`."""

    @wraps(command)
    def with_output(
        layout: str,
        format: str | None,
        file_name: str | None,
        decimal: str,
        digits: int | None,
        width: int | None,
        **others: Any,
    ) -> Any:
        written = format_of(format, file_name)
        if decimal == "comma" and written == "json":
            raise click.UsageError("--decimal comma: JSON has the decimal point only.")
        return command(output=Output(Look(written, layout, decimal == "comma", digits, width), file_name), **others)

    return _look_options(with_output)


def crank_angles(step: float, angles: Sequence[float] | None, end: float, parts: int) -> Sequence[float]:
    """Return the angles given, or 0, step, 2 step, … `end` in degrees; parts: cylinders or L/R that have them each."""
    from kurbel.report.tables import check_rows, stepped

    if angles is None:
        return stepped(step, end, parts)
    check_rows(len(angles), parts)
    return angles


def loaded(file: str, case_name: str, overrides: Sequence[str], *outputs: str | None) -> "Machine":
    """Read the machine, with the values of a load case of its file, '' for none, and these values over them.

    Raises UsageError where an output would overwrite its file, or a trace that it names.
    """
    from kurbel.machine_file import load
    from kurbel.render.output import refuse_overwriting

    machine = load(file, overrides, case_name)
    for output in outputs:
        refuse_overwriting(output, (file, *machine.trace_files))
    return machine


Spreads = tuple[tuple[str, str], ...]
"""Dotted keys, each with its standard uncertainty as a text."""


@dataclass(frozen=True, eq=False)
class Asked:
    """What is asked of a command that prints a table for a machine, by the names of the options.

    units: of the figures; where, over: what has a value, or the stroke, over which the rows stand instead of the angle.
    """

    file: str
    case_name: str
    overrides: tuple[str, ...]
    units: str
    cylinder: str | None
    key_values_only: bool
    output: Output
    step: float = 10.0
    angles: tuple[float, ...] | None = None
    columns: tuple[str, ...] | None = None
    where: str | None = None
    over: str | None = None
    compare: bool = False

    def case(self) -> "Case":
        """Read the machine and return it with its results, none of which is computed yet."""
        from kurbel.solver.case import Case

        return Case(loaded(self.file, self.case_name, self.overrides, self.output.file_name))

    def frame(self, command: str, end: float, parts: int = 1) -> "Frame":
        """Return the frame of the report: rows from 0 to `end` degrees, for each of so many parts, or where wanted."""
        from kurbel.report.frame import Frame

        if self.key_values_only and self.columns:
            raise click.UsageError(
                "--columns names columns of the table that --key-values leaves out; a key value is a line, grep 'p_i '"
            )
        angles = self._rows(command, end) or crank_angles(self.step, self.angles, end, parts)
        prose = self.output.look.format != "csv" or self.key_values_only
        return Frame(command, angles, self.columns, self.units, "z" if self.over else "", self.compare, prose)

    def _rows(self, command: str, end: float) -> Any:
        """Return what finds the crank angles of a subject, None for a table over the angle itself."""
        ways = {"--where": self.where, "--over": self.over, "--angles": self.angles or None}
        given = [way for way, said in ways.items() if said is not None]
        if len(given) > 1:
            raise click.UsageError(f"{' and '.join(given)} both say at which crank angles; leave one of them out.")
        if not self.over and self.where is None:
            return None
        from kurbel.report.rows import over_stroke, rows_where

        if self.where is None:
            return over_stroke(self.step, end)
        # where a force has a value there is a motion to tell, too
        return rows_where(self.where, "forces" if command == "motion" else command, end)

    def write(self, report: Report, case: "Case | None" = None, spreads: Spreads = ()) -> None:
        """Write what is asked of the report; with these uncertainties of inputs, and those that its file gives."""
        if self.cylinder is not None:
            report = report.of_cylinder(self.cylinder)
        report = report.key_values_alone() if self.key_values_only else report
        if case and (spreads or case.machine.uncertainty):
            from kurbel.designs.uncertainty import with_uncertainty

            bar = partial(with_bar, label="drawn machines")
            report = with_uncertainty(report, case, spreads, self.units, bar)
        self.output.write(report)


def with_bar(items: Iterable[Item], label: str, **how: Any) -> Iterator[Item]:
    """Yield what is computed one by one, with a bar on the terminal; how: it looks, see `click.progressbar`."""
    if not sys.stderr.isatty():
        yield from items
        return
    with click.progressbar(items, file=sys.stderr, label=label, **how) as bar:
        yield from bar


def _with_asked(command: Callable[..., None]) -> Callable[..., None]:
    @wraps(command)
    def with_asked(units: str | None, output: Output, **options: Any) -> None:
        system = units or ("si" if output.look.format in ("csv", "json") else "metric")
        own = {name: options.pop(name) for name in Asked.__annotations__ if name in options}
        with told_in(units or "metric"):
            command(asked=Asked(units=system, output=output, **own), **options)

    return with_asked


machine_places = stacked(machine_file, _part_options, units_option, output_options, _with_asked)
"""Gives a command FILE and the options of one that tells nothing over the crank angle; see `machine_table`."""
machine_table = stacked(
    machine_file, angle_options, columns_option, _part_options, units_option, output_options, _with_asked
)
"""Gives a command FILE and all options of a table, which reach it as one `asked: Asked`."""
