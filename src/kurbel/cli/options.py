"""Options shared by the commands: how their texts are read, what a shell completes, what they mean."""

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import wraps
from typing import TYPE_CHECKING, Any, TypeVar

import click

from kurbel.cli.group import KurbelCommand
from kurbel.declared.numerals import parse_ratio
from kurbel.declared.unit_systems import messages_in
from kurbel.declared.units import parse_quantity, written_unit
from kurbel.errors import KurbelError, UnitError
from kurbel.quantity import Lists, ambiguity
from kurbel.render import FORMATS, LAYOUTS, Look
from kurbel.render.formats import Output

if TYPE_CHECKING:
    from kurbel.machine import Machine

# --- how the text behind an option is read; what cannot be read is reported with the option

Command = TypeVar("Command", bound=Callable[..., object])
_MOST_STEPS = 10_000


def _read(parse: Callable[..., float], *arguments: str) -> float:
    """Return the parsed value; raises BadParameter for a text that cannot be parsed."""
    try:
        return parse(*arguments)
    except UnitError as error:
        raise click.BadParameter(str(error)) from None


def number(text: str) -> float:
    """Return a finite number with a decimal point, also 10/3 or 75 %."""
    return _read(parse_ratio, text)


def numbers(text: str) -> tuple[float, ...]:
    """Return numbers separated by commas, in the order given; or from, to, by steps: `0.5:12:0.5`."""
    return _number_list(text, number, "0.5:12:0.5")


def speeds(text: str) -> tuple[float, ...]:
    """Return speeds in revolutions per second, in the order given.

    They have one unit or each its own: `300, 350 rpm`; or they go from, to, by steps: `300:1500:10 rpm`.
    """
    unit = written_unit(text.replace(":", ",").rpartition(",")[2])

    def read_speed(item: str) -> float:
        if not written_unit(item):
            item = f"{item} {unit}".strip()
        speed = _read(parse_quantity, item, "speed")
        if not speed > 0:
            raise click.BadParameter(f"'{text}': it must be more than 0")
        return speed

    return _number_list(text, read_speed, "300:1500:10 rpm")


def frequency(text: str) -> float:
    """Return a frequency in Hz, written as `30 Hz`, `1800 1/min` or `188 rad/s`."""
    first, *others = speeds(text)
    if others:
        raise click.BadParameter(f"'{text}' is more than one frequency")
    return first


def _number_list(text: str, read: Callable[[str], float], sample: str) -> tuple[float, ...]:
    """Return what is read between commas, or the numbers from, to, by steps."""
    numbers = tuple(map(read, text.replace(":", ",").split(",")))
    if ":" not in text:
        return numbers
    message = f"'{text}': write from, to and step as '{sample}'"
    if len(numbers) != 3 or "," in text:
        raise click.BadParameter(message)
    low, high, step = numbers
    if not step > 0 or high < low:
        raise click.BadParameter(message)
    if (high - low) / step > _MOST_STEPS:
        raise click.BadParameter(f"'{text}': more than {_MOST_STEPS} steps; take larger ones")
    count = int((high - low) / step + 1e-9) + 1
    # 15 digits, so that 3 · 0.1 is 0.3
    return tuple(float(f"{low + step * index:.15g}") for index in range(count))


def words(text: str) -> tuple[str, ...]:
    """Return words separated by commas, in the order given, at least one; empty ones are skipped."""
    names = tuple(filter(None, map(str.strip, text.split(","))))
    if not names:
        raise click.BadParameter(f"'{text}' names nothing; leave the option out, or name one")
    return names


def columns(text: str) -> tuple[str, ...]:
    """Return the ids of columns by id or printed symbol, separated by commas, in the order given."""
    from kurbel.quantities import COLUMNS

    chosen_ids = []
    for name in COLUMNS.names_of(words(text)):
        ids = COLUMNS.ids_of(name)
        message = ambiguity(name, ids)
        if message:
            raise click.BadParameter(message)
        # the report checks whether this machine has it
        chosen_ids.append(ids[0] if ids else name)
    return tuple(chosen_ids)


def key_values(text: str) -> tuple[str, ...]:
    """Return names of key values separated by commas or blanks, in the order given; a name may have blanks itself."""
    from kurbel.quantities import KEY_VALUES

    names: list[str] = []
    for item in words(text):
        parts = item.split()
        # are all parts names, without their scopes?
        are_names = all(KEY_VALUES.ids_of(part.rpartition(".")[2]) for part in parts)
        if are_names:
            names += parts
        else:
            names.append(item)
    return tuple(names)


def _quantities() -> Lists:
    from kurbel.quantities import every_quantity

    return every_quantity()


def read_uncertainty(text: str) -> tuple[str, str]:
    """Return a dotted key with its standard uncertainty as a text."""
    from kurbel.declared.forms.figures import spread_text

    key, _, size = text.partition("=")
    key = key.strip()
    spread = spread_text(size)
    if not key or not spread:
        raise click.UsageError(
            f"--uncertainty {text}: write KEY=SPREAD, above 0, such as bore='0.2 mm'."
        )
    return key, spread


# --- what a shell completes, looked up when TAB is pressed


def completing(words: Callable[[click.Context, str], Iterable[str]]) -> Callable[..., list[str]]:
    """Return the completion of an option from words, which are looked up when TAB is pressed."""

    def complete(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
        try:
            return [word for word in words(ctx, incomplete) if word.startswith(incomplete)]
        except KurbelError:  # the machine file on the line cannot be read
            return []

    return complete


def _ids(ctx: click.Context, begun: str) -> Iterable[str]:
    """Return the columns of a command, or if it has none all key values, that are not in the list yet."""
    quantities = _quantities()
    ids: Iterable[str] = quantities.columns(ctx.info_name or "")
    if not ids:
        ids = [key_value.id for key_value in quantities.all_key_values]
    return _not_listed_yet(ids, begun)


def _key_values(ctx: click.Context, begun: str) -> Iterable[str]:
    """Return the key values of a command that are not in the list yet."""
    return _not_listed_yet(_quantities().key_values(ctx.info_name or ""), begun)


def _not_listed_yet(ids: Iterable[str], begun: str) -> list[str]:
    """Return a list of ids that is being written, with each further id that may follow."""
    before, comma, _ = begun.rpartition(",")
    listed = before.split(",")
    return [before + comma + id for id in dict.fromkeys(ids) if id not in listed]


def _keys(ctx: click.Context, begun: str) -> Iterable[str]:
    """Return the keys of a machine file."""
    from kurbel.report.keys import every_place

    return every_place()


def _machine(ctx: click.Context) -> "Machine":
    """Return the machine of the file on the line, which is not read to its end if it ends in an option."""
    from kurbel.machine_file import load

    files = [word for word in ctx.args if word != "-"]
    return load(files[0] if files else "")


def _pictures(ctx: click.Context, begun: str) -> Iterable[str]:
    """Return the ids of all pictures."""
    from kurbel.pictures.pictures import PICTURES

    return [*(picture.id for picture in PICTURES), "all"]


def _sections(ctx: click.Context, begun: str) -> Iterable[str]:
    """Return the sections of a report that are not in the list yet."""
    from kurbel.page.contents import SECTIONS

    return _not_listed_yet(SECTIONS, begun)


complete_ids = completing(_ids)
complete_key_values = completing(_key_values)
complete_key = completing(_keys)
complete_override = completing(
    lambda ctx, text: () if "=" in text else [f"{key}=" for key in _keys(ctx, text)]
)
complete_cylinder = completing(
    lambda ctx, _: [cylinder.name for cylinder in _machine(ctx).cylinders]
)
complete_case = completing(lambda ctx, _: [case.name for case in _machine(ctx).cases])
complete_picture = completing(_pictures)
complete_section = completing(_sections)


# --- the options

KEY_VALUES = "--key-values"
_FILES = (".yaml", ".yml", ".json")
"""Suffixes of machine files."""


class CommandWithKeyValues(KurbelCommand):
    """A command with `--key-values [NAMES]`: names may follow it, as one word or as several, or none."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Parse the words of the command line, those behind the option as its value."""
        return super().parse_args(ctx, list(_with_names(args)))


def _with_names(words: Sequence[str]) -> Iterator[str]:
    """Yield the words of a command line, names behind `--key-values` as the value of the option.

    The names end where another option or the machine file begins.

    >>> list(_with_names(["--key-values", "c_max", "b_max", "engine.yaml", "--case", "full"]))
    ['--key-values=c_max b_max', 'engine.yaml', '--case', 'full']
    """
    index = 0
    while index < len(words):
        word = words[index]
        index += 1
        if word == "--":
            yield from words[index - 1 :]
            return
        if word != KEY_VALUES:
            yield word
            continue
        first = index
        while index < len(words) and not _ends_names(words[index]):
            index += 1
        yield f"{KEY_VALUES}={' '.join(words[first:index])}"


def _ends_names(word: str) -> bool:
    """Return whether a word is another option, or a machine file."""
    return word.startswith("-") or word.lower().endswith(_FILES) or os.path.isfile(word)


def stacked(*options: Callable[[Command], Command]) -> Callable[[Command], Command]:
    """Return what gives a command these options, in this order of its help."""

    def decorate(command: Command) -> Command:
        for option in reversed(options):
            command = option(command)
        return command

    return decorate


def key_value_option(*names: str, **how: Any) -> Callable[[Command], Command]:
    """Return an option that is completed by ids of key values."""
    return click.option(*names, shell_complete=complete_ids, **how)


def format_option(*formats: str, said: str = "") -> Callable[[Command], Command]:
    """Return the option of the output format; said: what its help begins with."""
    listed = said or f"{', '.join(formats)}; "
    text = f"{listed}if not given, by the suffix of --output, or table."
    return click.option(
        "--format", "-f", "format", type=click.Choice(formats), metavar="FORMAT", help=text
    )


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
machine_file = stacked(
    click.argument("file", metavar="FILE", type=click.Path(allow_dash=True)), set_options
)
"""The machine file, or - for standard input, and values over those in it."""

angle_options = stacked(
    click.option(
        "--step",
        type=number,
        default="10",
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
    shell_complete=complete_ids,
)
cylinder_option = click.option(
    "--cylinder",
    metavar="NAME",
    help="Only this cylinder, by name or number.",
    shell_complete=complete_cylinder,
)
part_options = stacked(
    cylinder_option,
    click.option(
        KEY_VALUES,
        "names",
        metavar="[NAMES]",
        help="Only the key values, no table; of these names only, such as 'c_max N_i' or LP.T_max, in this order.",
        shell_complete=complete_key_values,
    ),
    click.option(
        "--all",
        "everything",
        is_flag=True,
        expose_value=False,
        help="Print everything, also on a terminal with too few lines for it.",
    ),
)


def _write_messages_in(
    context: click.Context, parameter: click.Parameter, system: str | None
) -> str | None:
    """Write the messages of a command in the unit system that is requested, and return it."""
    if system:
        context.with_resource(messages_in(system))
    return system


units_option = click.option(
    "--units",
    type=click.Choice(["si", "metric", "technical", "imperial"]),
    callback=_write_messages_in,
    is_eager=True,  # the other options have messages, too
    metavar="SYSTEM",
    help="metric (mm, bar, kN), technical (mm, kgf, at), imperial (in, lbf, psi, deg F) or si; if not given, si in "
    "csv and json, else metric.",
)


def paper_option(*sizes: str, text: str) -> Callable[[Command], Command]:
    """Return the option of the size of paper, None if not given."""
    return click.option("--paper", type=click.Choice(sizes, case_sensitive=False), help=text)


width_option = click.option(
    "--width",
    type=click.IntRange(20, 100_000),
    metavar="N",
    help="Columns to fill; a terminal's own if not given.",
)
output_option = click.option(
    "--output",
    "-o",
    "file_name",
    metavar="FILE",
    help="Write to FILE, not to standard output.",
)
number_options = stacked(
    click.option(
        "--decimal",
        "comma",
        type=click.Choice(["point", "comma"]),
        default="point",
        callback=lambda ctx, param, value: value == "comma",
        help="Decimal sign; a comma makes csv use ';'.",
    ),
    click.option(
        "--digits",
        type=click.IntRange(1, 17),
        help="Significant digits; if not given 4, and all in csv, json and xlsx.",
    ),
)
_look_options = stacked(
    click.option(
        "--layout",
        type=click.Choice(LAYOUTS),
        default="book",
        help="book: angles across; rows: a line for each.",
    ),
    format_option(*FORMATS),
    output_option,
    number_options,
    width_option,
)

orders_option = click.option(
    "--orders",
    type=numbers,
    metavar="A,B,...",
    help="Only these orders, periods per turn of the shaft, or FROM:TO:STEP; all up to 24 if not given.",
)
speeds_option = click.option(
    "--speeds",
    type=speeds,
    metavar="'A,B,... rpm'",
    help="Also at these speeds; or 'FROM:TO:STEP rpm'.",
)
where_option = click.option(
    "--where",
    metavar="'COLUMN = VALUE'",
    help="Rows where a column has a value, such as 'b = 1/6 b_max'.",
)
row_options = stacked(
    where_option,
    click.option(
        "--over",
        type=click.Choice(["x"]),
        help="Rows over the stroke, out and back, every --step percent of it.",
    ),
    click.option(
        "--compare", is_flag=True, help="Also the textbook approximations (R 286-291, 297)."
    ),
)
uncertainty_option = click.option(
    "--uncertainty",
    "spreads",
    type=read_uncertainty,
    multiple=True,
    metavar="KEY=SPREAD",
    help="Standard uncertainty of a value of FILE, such as bore='0.2 mm' or '2 %'; may be repeated.",
)

_SUFFIXES = {
    ".csv": "csv",
    ".json": "json",
    ".xlsx": "xlsx",
    ".md": "markdown",
    ".markdown": "markdown",
    ".html": "html",
    ".tex": "latex",
}
_OF_NO_FORMAT = ("", ".txt", ".yaml", ".yml")
"""Suffixes that a table may have, and those of machine files, which are refused where they are read."""


def format_of(
    requested: str | None,
    file_name: str | None,
    suffixes: Mapping[str, str] = _SUFFIXES,
    comma: bool = False,
) -> str:
    """Return the requested format, or that of the suffix of the file.

    Raises UsageError if they contradict each other, or the decimal comma.
    """
    suffix = os.path.splitext(file_name or "")[1].lower()
    of_suffix = suffixes.get(suffix)
    is_unknown = not of_suffix and suffix not in _OF_NO_FORMAT
    if is_unknown and not requested:
        raise click.UsageError(
            f"--output {file_name}: no format has this suffix; "
            f"write {', '.join(suffixes)}, .txt, or --format."
        )
    if requested and of_suffix and requested != of_suffix:
        raise click.UsageError(
            f"--format {requested} contradicts the name {file_name}, "
            f"which means {of_suffix}; change one of them."
        )
    written = requested or of_suffix or "table"
    if comma and written == "json":
        raise click.UsageError("--decimal comma: json has the decimal point only.")
    if written == "xlsx":
        refuse_contradictions(
            (comma, "--decimal comma: Excel shows the decimal sign that it is set to."),
            (file_name in (None, "-"), "A workbook is a file; give --output FILE.xlsx."),
        )
    return written


def refuse_contradictions(*rules: tuple[object, str]) -> None:
    """Raise UsageError for the first of these rules whose condition holds, with its message."""
    for is_broken, message in rules:
        if is_broken:
            raise click.UsageError(message)


def output_options(command: Callable[..., object]) -> Callable[..., object]:
    """Add the options of the output to a command, which gets them as one `output: Output`."""

    @wraps(command)
    def with_output(
        layout: str,
        format: str | None,
        file_name: str | None,
        comma: bool,
        digits: int | None,
        width: int | None,
        **others: object,
    ) -> object:
        look = Look(format_of(format, file_name, comma=comma), layout, comma, digits, width)
        return command(output=Output(look, file_name), **others)

    return _look_options(with_output)


UncertaintyTexts = tuple[tuple[str, str], ...]
"""Dotted keys, each with its standard uncertainty as a text."""
