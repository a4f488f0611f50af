"""`kurbel table`: Zusammenstellung 112."""

import math

import click

from kurbel.cli.output_options import Output, angle_options, crank_angles, output_options, units_option
from kurbel.cli.readings import number, words


def _ratio(text: str) -> float:
    return math.inf if text in ("inf", "infinite") else number(text)


@click.command()
@click.option(
    "--ratio",
    "ratios",
    type=_ratio,
    multiple=True,
    metavar="L/R",
    help="Rod length over crank radius, such as 5, or inf; may be repeated. 5, 4.5 and 4 if not given.",
)
@click.option(
    "--rows",
    "--columns",
    "rows",
    type=words,
    default="b,c",
    metavar="ROW,ROW,...",
    help="Of b, c, x, psi, S, N, D; b,c if not given.",
)
@click.option(
    "--formula",
    type=click.Choice(["book", "exact", "first-order"]),
    default="book",
    help="book: acceleration of first order, all else exact. first-order: b, c and x, the others exact.",
)
@click.option(
    "--compare", is_flag=True, help="Set the figures that the book prints below the computed ones; mark misprints."
)
@angle_options
@units_option
@output_options
def table(
    ratios: tuple[float, ...],
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

    v is the crank-pin speed, R the crank radius, L the rod length.
    """
    from kurbel.report.zusammenstellung import RATIOS, zusammenstellung

    ratios = ratios or RATIOS
    printed = crank_angles(step, angles, 180, len(ratios))
    output.write(zusammenstellung(ratios, rows, printed, formula, compare))
