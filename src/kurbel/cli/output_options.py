"""Options shared by the commands that print a table, and what they mean."""

from collections.abc import Callable, Mapping, Sequence
from functools import wraps
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

import click

from kurbel.cli.completion import complete_columns, complete_cylinder, complete_override
from kurbel.render import FORMATS, LAYOUTS, Look
from kurbel.report.tables import Report

if TYPE_CHECKING:
    from kurbel.declared.quantity import Quantity
    from kurbel.machine import Machine
    from kurbel.solver.case import Case

    _NumberType = click.ParamType[float]
    _NumbersType = click.ParamType[tuple[float, ...]]
    _WordsType = click.ParamType[tuple[str, ...]]
else:  # before click 8.4 a ParamType has no parameter
    _NumberType = _NumbersType = _WordsType = click.ParamType

Command = TypeVar("Command", bound=Callable[..., Any])


class Number(_NumberType):
    """A finite number with a decimal point, also 10/3 or 75 %; `words` are texts allowed instead, with their values."""

    name = "number"

    def __init__(self, **words: float) -> None:
        self.words = words

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """Return the number, or end with a usage error that says what to write."""
        if not isinstance(value, str):
            return float(value)
        if value in self.words:
            return self.words[value]
        from kurbel.declared.numerals import parse_ratio
        from kurbel.errors import UnitError

        try:
            return parse_ratio(value)
        except UnitError as error:
            self.fail(str(error), param, ctx)


class Numbers(_NumbersType):
    """Numbers, separated by commas."""

    name = "numbers"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[float, ...]:
        """Return the numbers in the order given."""
        if not isinstance(value, str):
            return tuple(value)
        return tuple(Number().convert(text, param, ctx) for text in value.split(","))


class Words(_WordsType):
    """Words, separated by commas."""

    name = "words"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[str, ...]:
        """Return the words in the order given, without those that are empty."""
        words = value.split(",") if isinstance(value, str) else value
        return tuple(word.strip() for word in words if word.strip())


class Columns(Words):
    """Columns by id or printed symbol, separated by commas."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[str, ...]:
        """Return the ids in the order given."""
        from kurbel.declared.quantities import COLUMNS

        words = super().convert(value, param, ctx)
        if all(word in COLUMNS for word in words):
            return words
        from kurbel.declared.quantity import called, joined
        from kurbel.mechanisms import every_quantity

        known = [column for column in every_quantity().all_columns if column.commands]
        return tuple(self._only(name, called(name, known), known, param, ctx) for name in joined(words, known))

    def _only(self, name: str, found: tuple[str, ...], known: "list[Quantity]", *place: Any) -> str:
        from kurbel.declared.quantity import ambiguity

        if wrong := ambiguity(name, found):
            self.fail(wrong, *place)
        return found[0] if found else name  # the report knows what this machine has


class Output(NamedTuple):
    """Where a report goes and how it looks."""

    look: Look
    file_name: str | None

    def write(self, report: Report) -> None:
        """Write the report."""
        from kurbel.render.output import write_report

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
        "--step", type=Number(), default=10.0, metavar="DEGREES", help="Step of the crank angle; 10 if not given."
    ),
    click.option(
        "--angles", type=Numbers(), metavar="A,B,...", help="These crank angles in degrees instead of a step."
    ),
)
"""`--step` and `--angles`: see `crank_angles`."""

columns_option = click.option(
    "--columns",
    type=Columns(),
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
    click.option("--output", "-o", "file_name", metavar="FILE", help="Write to this file instead of standard output."),
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


_SUFFIXES = {
    ".csv": "csv",
    ".json": "json",
    ".md": "markdown",
    ".markdown": "markdown",
    ".html": "html",
    ".tex": "latex",
}


def format_of(asked: str | None, file_name: str | None, suffixes: Mapping[str, str] = _SUFFIXES) -> str:
    """Return the format that is asked for, or that of the suffix of the file; UsageError where the two contradict."""
    dot = (file_name or "").rfind(".")
    of_suffix = suffixes.get(file_name[dot:].lower()) if file_name else None
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


class Asked(NamedTuple):
    """What is asked of a command that prints a table for a machine."""

    file: str
    overrides: tuple[str, ...]
    step: float
    angles: tuple[float, ...] | None
    columns: tuple[str, ...] | None
    units: str
    cylinder: str | None
    key_values_only: bool
    output: Output

    def case(self) -> "Case":
        """Read the machine and return it with its results, none of which is computed yet."""
        from kurbel.solver.case import Case

        return Case(loaded(self.file, self.overrides, self.output.file_name))

    def crank_angles(self, end: float, parts: int = 1) -> Sequence[float]:
        """Return the crank angles in degrees to print for each part, from 0 to `end` where none are named."""
        return crank_angles(self.step, self.angles, end, parts)

    def write(self, report: Report, case: "Case | None" = None, spreads: Sequence[tuple[str, str]] = ()) -> None:
        """Write what is asked of the report; with these uncertainties of inputs, and those that its file gives."""
        if self.key_values_only and self.columns:
            raise click.UsageError("--columns names columns of the table that --key-values leaves out.")
        if self.cylinder is not None:
            report = report.of_cylinder(self.cylinder)
        report = report.key_values_alone() if self.key_values_only else report
        if case and (spreads or case.machine.uncertainty):
            from kurbel.designs.uncertainty import with_uncertainty

            report = with_uncertainty(report, case, spreads, self.units)
        self.output.write(report)


Spreads = tuple[tuple[str, str], ...]
"""Dotted keys, each with its standard uncertainty as a text."""


def uncertainty_option(command: Callable[..., Any]) -> Callable[..., Any]:
    """Give a command standard uncertainties of inputs, which reach it as pairs of key and text."""
    option = click.option(
        "--uncertainty",
        "spreads",
        multiple=True,
        metavar="KEY=SPREAD",
        help="Standard uncertainty of a value of FILE, such as bore='0.2 mm' or '2 %'; may be repeated.",
    )

    @wraps(command)
    def with_spreads(spreads: tuple[str, ...], **others: Any) -> Any:
        return command(spreads=tuple(_spread(one) for one in spreads), **others)

    return option(with_spreads)


def _spread(text: str) -> tuple[str, str]:
    from kurbel.declared.forms.uncertainties import spread_text

    key, _, spread = text.partition("=")
    if not (key.strip() and spread_text(spread)):
        raise click.UsageError(f"--uncertainty {text}: write KEY=SPREAD, above 0, such as bore='0.2 mm'.")
    return key.strip(), spread_text(spread)


def machine_places(command: Callable[..., None]) -> Callable[..., Any]:
    """Give a command FILE and the options of one that tells nothing over the crank angle; see `machine_table`."""
    return stacked(machine_file, _part_options, units_option)(output_options(_with_asked(command)))


def machine_table(command: Callable[..., None]) -> Callable[..., Any]:
    """Give a command FILE and all options of a table, which reach it as one `asked: Asked`."""
    return stacked(machine_file, angle_options, columns_option, _part_options, units_option)(
        output_options(_with_asked(command))
    )


def _with_asked(command: Callable[..., None]) -> Callable[..., Any]:

    @wraps(command)
    def with_asked(
        file: str,
        overrides: tuple[str, ...],
        units: str | None,
        cylinder: str | None,
        key_values_only: bool,
        output: Output,
        step: float = 10.0,
        angles: tuple[float, ...] | None = None,
        columns: tuple[str, ...] | None = None,
        **others: Any,
    ) -> None:
        system = units or ("si" if output.look.format in ("csv", "json") else "metric")
        asked = Asked(file, overrides, step, angles, columns, system, cylinder, key_values_only, output)
        from kurbel.declared.unit_systems import told_in

        with told_in(units or "metric"):
            command(asked=asked, **others)

    return with_asked
