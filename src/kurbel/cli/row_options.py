"""Options of the commands that tell of a cylinder alone: rows elsewhere than at crank angles, and approximations."""

from collections.abc import Callable
from functools import wraps
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from kurbel.cli.output_options import Asked, stacked

if TYPE_CHECKING:
    from kurbel.report.frame import Rows


class AskedRows(NamedTuple):
    """What is asked of the rows: `where` a column has a value, or `over` the stroke; `compare` with the book's."""

    where: str | None
    over: str | None = None
    compare: bool = False

    def rows(self, asked: Asked, command: str = "forces") -> "Rows | None":
        """Return what finds the crank angles, None for a table over the angle itself; command: whose columns."""
        ways = {"--where": self.where, "--over": self.over, "--angles": asked.angles or None}
        if len(given := [way for way, said in ways.items() if said is not None]) > 1:
            raise click.UsageError(f"{' and '.join(given)} both say at which crank angles; leave one of them out.")
        if self.where is None and not self.over:
            return None
        from kurbel.report.rows import Place, over_stroke

        return over_stroke(asked.step) if self.where is None else Place.parsed(self.where, command).angles

    @property
    def columns(self) -> tuple[str, ...]:
        """The columns that are shown besides."""
        from kurbel.report.frame import APPROXIMATIONS

        return (*(("z",) if self.over else ()), *(APPROXIMATIONS if self.compare else ()))


where_option = click.option(
    "--where", metavar="'COLUMN = VALUE'", help="Rows where a column has a value, such as 'b = 1/6 b_max'."
)
_options = stacked(
    where_option,
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

    return _options(with_rows)
