"""What `kurbel sweep` does with its options: compute, choose and write the rows."""

import sys
from collections.abc import Iterable, Sequence
from contextlib import closing
from typing import NamedTuple

from kurbel.cli.group import ProgressLine, to_stderr
from kurbel.cli.options import format_of, refuse_contradictions
from kurbel.designs.answers import Design, Head
from kurbel.designs.chosen import (
    Aim,
    RowCondition,
    column_summaries,
    pareto_front,
    read_aim,
    read_condition,
    summary_heads,
)
from kurbel.designs.plan import MOST_ROWS, read_axis
from kurbel.designs.plan import shard as rows_of_shard
from kurbel.designs.sweep import Spec, Sweep, computed_rows, likely_jobs
from kurbel.machine_file import source
from kurbel.render import Look
from kurbel.render.output import refuse_overwriting
from kurbel.render.sweep_rows import (
    NOTHING_WRITTEN,
    Titles,
    rows_written_before,
    write_rows,
)

_SUFFIXES = {
    ".csv": "csv",
    ".json": "json",
    ".jsonl": "json",
    ".xlsx": "xlsx",
    ".md": "markdown",
}
_LINES = ("csv", "json")
"""Formats that can go on where they end."""


def run_sweep(
    file: str,
    case_name: str,
    overrides: tuple[str, ...],
    vary: tuple[str, ...],
    cases: bool,
    side_by_side: bool,
    sample: int | None,
    seed: int,
    columns: tuple[str, ...] | None,
    with_angles: bool,
    conditions: tuple[str, ...],
    sort: str | None,
    top: int | None,
    pareto: tuple[str, ...] | None,
    summarised: bool,
    units: str | None,
    format: str | None,
    file_name: str | None,
    comma: bool,
    digits: int | None,
    resume: bool,
    shard: str | None,
    jobs: int | None,
    dask: str | None,
    yes: bool,
) -> None:
    """Compute and write the rows: the options of the command. Raises UsageError for those that do not go together."""
    written = format_of(format, file_name, _SUFFIXES, comma)
    is_file = file_name not in (None, "-")
    is_for_people = written in ("table", "markdown", "xlsx")
    is_in_order = not (sort or pareto or summarised)
    can_resume = is_file and written in _LINES and is_in_order
    refuse_contradictions(
        (not (vary or cases), "Missing option '--vary' (the values to vary); or give --cases."),
        (cases and case_name, "--cases has every load case, --case one; leave one of them out."),
        (top and not sort, "--top N takes the first rows of --sort ID; give --sort too."),
        (
            resume and not can_resume,
            "--resume goes on in csv or json lines, rows in order; give --output FILE.csv.",
        ),
        (summarised and shard, "--summary is of all rows; no --shard."),
        (dask and jobs, "give only one of --dask and --jobs."),
    )
    refuse_overwriting(file_name, (file,))

    # the sweep, and which of its rows are wanted
    usual_system = "metric" if is_for_people else "si"
    sweep = Sweep(
        Spec(
            source.read(file)._replace(case=case_name).set_over(overrides),
            tuple(map(read_axis, vary)),
            side_by_side,
            sample,
            seed,
            None if yes else MOST_ROWS,
            cases,
            columns or (),
            with_angles,
            units or usual_system,
        )
    )
    rows = range(sweep.rows) if shard is None else rows_of_shard(shard, sweep.rows)
    selection = _selection(sweep, conditions, pareto or (), sort, top)

    # the columns that are written
    columns_shown = sweep.shown
    if not is_for_people:
        columns_shown = [(head.id, index) for index, head in enumerate(sweep.heads)]
    names = tuple((name, sweep.heads[index].unit) for name, index in columns_shown)
    titles = Titles(names, sweep.texts)
    if summarised:
        titles = Titles(summary_heads(sweep.heads), row="column")
    look = Look(written, comma=comma, digits=digits)

    # rows that an earlier run has written
    written_before = NOTHING_WRITTEN
    if resume:
        written_before, rows = rows_written_before(
            file_name or "", sweep, titles, look, rows, selection.conditions
        )
    has_titles = rows.start == 0 and written_before == NOTHING_WRITTEN

    # computed row by row while they are written
    if not jobs:
        jobs = 1 if shard else likely_jobs(len(rows))
    is_terminal = sys.stdout is not None and sys.stdout.isatty()
    rows_show_progress = is_terminal and not file_name and not is_for_people
    with closing(computed_rows(sweep, rows, jobs, dask, to_stderr)) as computed:
        designs: Iterable[Design] = computed
        if not rows_show_progress:
            designs = ProgressLine("sweep").counted(designs, "designs", len(rows))
        designs = selection.of(designs)
        if summarised:
            designs = column_summaries(designs, sweep.heads)
        elif is_for_people:
            designs = (_with_columns(row, columns_shown) for row in designs)
        advice = "; run again with --resume to continue" if can_resume else ""
        write_rows(
            designs,
            titles,
            look,
            file_name,
            lambda message: to_stderr(message + advice),
            has_titles,
            written_before,
        )
    has_all_columns = is_for_people and not (columns or is_file or summarised)
    if has_all_columns and is_terminal:
        to_stderr(
            f"{len(names)} columns; '--columns ID,ID' prints fewer, '-o rows.csv' writes a file"
        )


class _Selection(NamedTuple):
    """Which rows of a sweep are written, and in which order."""

    conditions: Sequence[RowCondition]
    aims: Sequence[Aim]
    order: Aim | None
    top: int | None

    def of(self, designs: Iterable[Design]) -> Iterable[Design]:
        """Return the selected rows."""
        designs = filter(self._is_wanted, designs)
        if self.aims:
            designs = pareto_front(designs, self.aims)
        if self.order:
            designs = sorted(designs, key=self.order.of)[: self.top]
        return designs

    def _is_wanted(self, design: Design) -> bool:
        """Return whether a row meets all conditions."""
        return all(condition.holds(design) for condition in self.conditions)


def _selection(
    sweep: Sweep,
    conditions: Iterable[str],
    pareto: Iterable[str],
    sort: str | None,
    top: int | None,
) -> _Selection:
    """Return the selection that options describe by columns of the sweep; raises UsageError."""
    heads = (*sweep.heads, *map(Head, sweep.texts))
    row_conditions = [read_condition(condition, heads) for condition in conditions]
    aims = [read_aim(aim, heads, "--pareto") for aim in pareto]
    order = None if sort is None else read_aim(sort, heads, "--sort")
    return _Selection(row_conditions, aims, order, top)


def _with_columns(row: Design, columns_shown: Sequence[tuple[str, int]]) -> Design:
    """Return a row with the values of the columns that are shown."""
    return row._replace(values=tuple(row.values[index] for _, index in columns_shown))
