"""Options shared by the commands that print a table, and what they mean."""

import os
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial, wraps
from typing import TYPE_CHECKING, Any, TypeVar

import click

from kurbel.cli import readings
from kurbel.cli.completion import complete_columns, complete_cylinder, complete_override
from kurbel.render import FORMATS, LAYOUTS, Look
from kurbel.report.tables import Report

if TYPE_CHECKING:
    from kurbel.machine import Machine
    from kurbel.report.frame import Frame
    from kurbel.solver.case import Case

Command = TypeVar("Command", bound=Callable[..., Any])
Item = TypeVar("Item")


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


set_option = click.option(
    "--set",
    "overrides",
    multiple=True,
    metavar="KEY=VALUE",
    shell_complete=complete_override,
    help="This value instead of that of FILE, such as cylinders.0.bore='450 mm'; may be repeated.",
)
machine_file = stacked(click.argument("file", metavar="FILE", type=click.Path(allow_dash=True)), set_option)
"""The machine file, or - for standard input, and values over those in it."""

angle_options = stacked(
    click.option(
        "--step",
        type=readings.number,
        default=10.0,
        metavar="DEGREES",
        help="Step of the crank angle; 10 if not given.",
    ),
    click.option(
        "--angles",
        type=readings.numbers,
        metavar="A,B,...",
        help="These crank angles in degrees instead of a step; or FROM:TO:STEP.",
    ),
)
"""`--step` and `--angles`: see `crank_angles`."""

columns_option = click.option(
    "--columns",
    type=readings.columns,
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
    type=readings.numbers,
    metavar="A,B,...",
    help="Only these orders, periods per turn of the shaft, or FROM:TO:STEP; all up to 24 if not given.",
)
speeds_option = click.option(
    "--speeds", type=readings.speeds, metavar="'A,B,... rpm'", help="Also at these speeds; or 'FROM:TO:STEP rpm'."
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
    type=readings.spread,
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
    from kurbel.report.angles import check_rows, stepped

    if angles is None:
        return stepped(step, end, parts)
    check_rows(len(angles), parts)
    return angles


def loaded(file: str, overrides: Sequence[str], *outputs: str | None) -> "Machine":
    """Read the machine, with these values over those of its file.

    Raises UsageError where an output would overwrite its file, or a trace that it names.
    """
    from kurbel.machine_file import load
    from kurbel.render.output import refuse_overwriting

    machine = load(file, overrides)
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

        return Case(loaded(self.file, self.overrides, self.output.file_name))

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
        from kurbel.declared.unit_systems import told_in

        with told_in(units or "metric"):
            command(asked=Asked(units=system, output=output, **own), **options)

    return with_asked


machine_places = stacked(machine_file, _part_options, units_option, output_options, _with_asked)
"""Gives a command FILE and the options of one that tells nothing over the crank angle; see `machine_table`."""
machine_table = stacked(
    machine_file, angle_options, columns_option, _part_options, units_option, output_options, _with_asked
)
"""Gives a command FILE and all options of a table, which reach it as one `asked: Asked`."""
