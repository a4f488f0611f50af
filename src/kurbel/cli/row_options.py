"""Options of the commands that tell of a cylinder alone: rows elsewhere than at crank angles, and approximations."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from kurbel.cli.output_options import Asked

if TYPE_CHECKING:
    from kurbel.report.frame import Rows


class AskedRows(NamedTuple):
    """What is asked of the rows: `where` a column has a value, or `over` the stroke; `compare` with the book's."""

    where: str | None
    over: str | None
    compare: bool

    def rows(self, asked: Asked) -> Rows | None:
        """Return what finds the crank angles, None for a table over the angle itself."""
        ways = [self.where and "--where", self.over and "--over", asked.angles and "--angles"]
        if len(given := [way for way in ways if way]) > 1:
            raise click.UsageError(f"{' and '.join(given)} both say at which crank angles; leave one of them out.")
        if not (self.where or self.over):
            return None
        from kurbel.report.rows import Place, over_stroke

        return Place.parsed(self.where).angles if self.where else over_stroke(asked.step)

    @property
    def columns(self) -> tuple[str, ...]:
        """The columns that are shown besides."""
        return (*(("z",) if self.over else ()), *(APPROXIMATIONS if self.compare else ()))


APPROXIMATIONS = ("x_book", "c_book", "b_book", "P_gas_book")

_options = (
    click.option(
        "--where", metavar="'COLUMN = VALUE'", help="Rows where a column has a value, such as 'b = 1/6 b_max'."
    ),
    click.option(
        "--over", type=click.Choice(["x"]), help="Rows over the stroke, both ways, every --step percent of it."
    ),
    click.option("--compare", is_flag=True, help="Approximations of the book (R 286-291, 297) beside them."),
)


def row_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Give a command these options, which reach it as one `rows: AskedRows`."""

    @wraps(command)
    def with_rows(where: str | None, over: str | None, compare: bool, **others: Any) -> Any:
        return command(rows=AskedRows(where, over, compare), **others)

    found: Callable[..., Any] = with_rows
    for option in reversed(_options):
        found = option(found)
    return found
