"""Commands that need no machine: tables of the books, shipped machines, and what a machine file may hold."""

import math
from pathlib import Path
from typing import NamedTuple

import click

from kurbel.cli.group import kurbel
from kurbel.cli.options import (
    angle_options,
    complete_key,
    completing,
    number,
    output_option,
    output_options,
    units_option,
    words,
)
from kurbel.declared.units import kinds, listed_units
from kurbel.errors import UsageError
from kurbel.near_words import did_you_mean
from kurbel.render.formats import Output
from kurbel.render.output import write_entries, write_out
from kurbel.shipped import MODELINE, shipped
from kurbel.tables.tables import table_angles


class _Ratio(NamedTuple):
    """An L/R, and the note for one that was written as R/L."""

    value: float
    note: str = ""


def _ratio(text: str) -> _Ratio:
    """Return L/R; a fraction below 1, as 1/5, can only be R/L."""
    if text in ("inf", "infinite"):
        return _Ratio(math.inf)
    value = number(text)
    numerator, slash, denominator = text.partition("/")
    is_inverse = slash and 0 < value < 1
    if not is_inverse:
        return _Ratio(value)
    inverse = number(f"{denominator}/{numerator}")
    return _Ratio(inverse, f"--ratio {text} is below 1 and was read as R/L: L/R = {inverse:g}.")


@kurbel.command(context_settings={"allow_extra_args": True})
@click.option(
    "--ratio",
    "ratios",
    type=_ratio,
    multiple=True,
    metavar="L/R",
    help="Rod length over crank radius, such as 5, or inf; R/L as a fraction, such as 1/5. May be repeated; 5, 4.5 "
    "and 4 if not given.",
)
@click.option(
    "--rows",
    "--columns",
    "rows",
    type=words,
    default="b,c",
    metavar="ROW,ROW,...",
    help="Of b, c, x, psi, S, N, D, T_b, x/s; b,c if not given.",
)
@click.option(
    "--formula",
    type=click.Choice(["book", "exact", "first-order"]),
    default="book",
    help="book: acceleration of first order, all else exact. first-order: b, c and x, the others exact.",
)
@click.option(
    "--compare",
    is_flag=True,
    help="Print the figures of the book below the computed ones, misprints marked.",
)
@angle_options
@units_option
@output_options
def table(
    ratios: tuple[_Ratio, ...],
    rows: tuple[str, ...],
    formula: str,
    compare: bool,
    step: float,
    angles: tuple[float, ...] | None,
    units: str | None,  # factors and degrees are the same in all of them
    output: Output,
) -> None:
    """Print Zusammenstellung 112: factors of the straight slider-crank over the crank angle.

    \b
      b    b over v^2/R         cos phi + R/L cos 2phi
      c    c over v, T over P   sin(phi+psi)/cos psi
      x    x over R
      psi  angle between connecting rod and stroke line
      S    rod force over piston force    1/cos psi
      N    guide force over piston force  tan psi
      D    radial force over piston force cos(phi+psi)/cos psi
      T_b  tangential inertia force over m R omega^2  -b c
      x/s  share of the stroke

    v is the crank-pin speed, R the crank radius, L the rod length. Below b and c: where b is zero and c largest,
    exactly, by first order, and by the rule that the rod is square to the crank (R p. 604).
    """
    from kurbel.report.zusammenstellung import RATIOS, zusammenstellung

    extra_words = click.get_current_context().args
    if extra_words:
        word = extra_words[0]
        raise click.UsageError(
            f"'{word}' is no option; write 'kurbel table --ratio {word}' for this L/R"
        )
    values = tuple(ratio.value for ratio in ratios) or RATIOS
    printed = table_angles(step, angles, 180, len(values))
    report = zusammenstellung(values, rows, printed, formula, compare)
    notes = tuple(ratio.note for ratio in ratios if ratio.note)
    output.write(report._replace(notes=(*notes, *report.notes)))


@kurbel.command()
@click.option(
    "--incline", type=number, required=True, metavar="DEGREES", help="Plane against the horizontal."
)
@click.option(
    "--coefficient",
    type=number,
    required=True,
    metavar="F",
    help="Coefficient of friction, such as 0.1.",
)
@click.option(
    "--direction",
    type=number,
    default="0",
    metavar="DEGREES",
    help="Direction of the force above the plane; along the plane if not given.",
)
@output_options
def friction(incline: float, coefficient: float, direction: float, output: Output) -> None:
    """Print the forces P, relative to the weight Q, that move a body up an inclined plane and that hold it there.

    After Redtenbacher 1862: in the requested direction, and horizontally, where P = Q tan(alpha +- rho) with
    tan rho = f. A negative holding force is one that must push the body down: it rests by its friction alone.
    """
    from kurbel.report.friction import inclined_plane

    output.write(inclined_plane(incline, coefficient, direction))


@kurbel.command()
@click.argument("name", required=False, shell_complete=completing(lambda ctx, _: shipped()))
@click.option(
    "--check",
    "compare",
    is_flag=True,
    help="Compute the expected figures of every machine, or of NAME: a test of this installation.",
)
@output_option
def example(name: str | None, compare: bool, file_name: str | None) -> int | None:
    """List the machines that come with kurbel, or print the file of the machine NAME.

    \b
      kurbel example waterworks > engine.yaml
      kurbel example waterworks | kurbel forces -
      kurbel example --check
    """
    files = shipped()
    if compare and name is None:
        from kurbel.cli.checking import check_shipped

        return check_shipped(tuple(files), file_name)
    if name is None:
        entries = []
        for machine, text in files.items():
            first_line, _, _ = text.partition("\n")
            entries.append((machine, first_line.lstrip("# ")))
        write_entries(entries, file_name)
        return None
    bare = name.removesuffix(".yaml")
    if bare not in files:
        raise UsageError(
            f"no example '{name}'{did_you_mean(bare, tuple(files))} (known: {', '.join(files)})"
        )
    if compare:
        from kurbel.cli.checking import check_shipped

        return check_shipped((bare,), file_name)
    write_out((MODELINE, files[bare]), file_name, "utf-8")
    return None


@kurbel.command()
@click.argument("key", required=False, shell_complete=complete_key)
def keys(key: str | None) -> None:
    """List the keys of a machine file with form, meaning and default; or KEY in full.

    \b
      kurbel keys
      kurbel keys masses.connecting_rod.share
    """
    from kurbel.report.keys import described, every_place

    if key is not None:
        write_entries(described(key))
        return
    write_entries([(path, alternatives[0].line) for path, alternatives in every_place().items()])


@kurbel.command()
@click.argument("kind", required=False, shell_complete=completing(lambda ctx, _: kinds()))
def units(kind: str | None) -> None:
    """List the units that a machine file may use, a line for each kind of quantity; or only those of KIND.

    Products and powers are written as people write them: N m or N*m, kg m2 or kg m^2; lengths also as 12 ft 6 in or
    1 3/4 in. Products that are seldom written, such as kN/in2, are read, too.
    """
    lines = {name.replace("_", " "): ", ".join(listed_units(name)) for name in kinds()}
    if kind is None:
        write_entries(list(lines.items()))
        return
    name = kind.replace("_", " ")
    if name not in lines:
        hint = did_you_mean(kind, tuple(lines)) or f"; there are {', '.join(lines)}"
        raise UsageError(f"no kind of quantity '{kind}'{hint}")
    write_entries([(name, lines[name])])


@kurbel.command()
@click.option(
    "--answers", is_flag=True, help="The schema of the output of -f json instead, for programs."
)
@output_option
def schema(answers: bool, file_name: str | None) -> None:
    """Print the JSON Schema (draft-07) of the machine file; editors complete and check with it.

    \b
      kurbel schema > kurbel.schema.json
      first line of a machine file:
      # yaml-language-server: $schema=./kurbel.schema.json
    """
    from kurbel.machine_file.schema import json_schema
    from kurbel.render.json_text import answer_schema, indented

    document = answer_schema() if answers else json_schema()
    write_out((indented(document),), file_name, "utf-8")


@kurbel.command()
@output_option
def skill(file_name: str | None) -> None:
    """Print a page for agents and newcomers: which command for which question, JSON, exit statuses, units, traps."""
    page = Path(__file__).with_name("skill.md")
    write_out((page.read_text(encoding="utf-8"),), file_name, "utf-8")
