"""What `kurbel sweep` does with its options: compute, choose and write the rows."""

import sys
from collections.abc import Iterable, Sequence
from contextlib import closing

import click

from kurbel.cli.group import ProgressLine, to_stderr
from kurbel.cli.options import format_of
from kurbel.designs.answers import Design, Head
from kurbel.designs.chosen import (
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
    ".md": "markdown",
    ".parquet": "parquet",
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
    to_file = file_name not in (None, "-")
    for_people = written in ("table", "markdown")
    parquet = written == "parquet"
    in_order = not (sort or pareto or summarised)
    resumable = to_file and written in _LINES and in_order
    refused = (
        (not (vary or cases), "Missing option '--vary' (the values to vary); or give --cases."),
        (cases and case_name, "--cases has every load case, --case one; leave one of them out."),
        (top and not sort, "--top N takes the first rows of --sort ID; give --sort too."),
        (
            resume and not resumable,
            "--resume goes on in csv or json lines, rows in order; give --output FILE.csv.",
        ),
        (parquet and not to_file, "Parquet is a file; give --output FILE.parquet."),
        (
            summarised and (shard or parquet),
            "--summary is of all rows, as text; no --shard, no parquet.",
        ),
        (dask and jobs, "give only one of --dask and --jobs."),
    )
    for is_wrong, message in refused:
        if is_wrong:
            raise click.UsageError(message)
    refuse_overwriting(file_name, (file,))

    # the sweep, and which of its rows are wanted
    origin = source.read(file)._replace(case=case_name).set_over(overrides)
    axes = tuple(map(read_axis, vary))
    most_rows = None if yes else MOST_ROWS
    system = units or ("metric" if for_people else "si")
    sweep = Sweep(
        Spec(
            origin,
            axes,
            side_by_side,
            sample,
            seed,
            most_rows,
            cases,
            columns or (),
            with_angles,
            system,
        )
    )
    rows = range(sweep.rows) if shard is None else rows_of_shard(shard, sweep.rows)
    columns_to_choose_by = (*sweep.heads, *map(Head, sweep.texts))
    row_conditions = [read_condition(condition, columns_to_choose_by) for condition in conditions]
    aims = [read_aim(aim, columns_to_choose_by, "--pareto") for aim in pareto or ()]
    order = None if sort is None else read_aim(sort, columns_to_choose_by, "--sort")

    # the columns that are written
    if for_people:
        shown = sweep.shown
    else:
        shown = [(head.id, place) for place, head in enumerate(sweep.heads)]
    names = tuple((name, sweep.heads[index].unit) for name, index in shown)
    titles = Titles(names, sweep.texts, types=sweep.types() if parquet else ())
    if summarised:
        titles = Titles(summary_heads(sweep.heads), row="column")
    look = Look(written, comma=comma, digits=digits)

    # rows that an earlier run has written
    written_before = NOTHING_WRITTEN
    if resume:
        written_before, rows = rows_written_before(
            file_name or "", sweep, titles, look, rows, row_conditions
        )
    headed = rows.start == 0 and written_before == NOTHING_WRITTEN

    jobs = jobs or (1 if shard else likely_jobs(len(rows)))
    on_terminal = sys.stdout is not None and sys.stdout.isatty()
    rows_show_progress = on_terminal and not file_name and not for_people
    with closing(computed_rows(sweep, rows, jobs, dask, to_stderr)) as computed:
        designs: Iterable[Design] = computed
        if not rows_show_progress:
            designs = ProgressLine("sweep").counted(designs, "designs", len(rows))
        designs = (row for row in designs if _holds_all(row, row_conditions))
        if aims:
            designs = pareto_front(designs, aims)
        if order:
            designs = sorted(designs, key=order.of)[:top]
        if summarised:
            designs = column_summaries(designs, sweep.heads)
        elif for_people:
            designs = (_with_columns(row, shown) for row in designs)
        advice = "; run again with --resume to continue" if resumable else ""
        write_rows(
            designs,
            titles,
            look,
            file_name,
            lambda what_is_left: to_stderr(what_is_left + advice),
            headed,
            written_before,
        )
    all_columns = not (columns or to_file or summarised)
    if all_columns and for_people and on_terminal:
        to_stderr(
            f"{len(names)} columns; '--columns ID,ID' prints fewer, '-o rows.csv' writes a file"
        )


def _holds_all(row: Design, conditions: Sequence[RowCondition]) -> bool:
    return all(condition.holds(row) for condition in conditions)


def _with_columns(row: Design, shown: Sequence[tuple[str, int]]) -> Design:
    """Return a row with the values of the columns that are shown."""
    return row._replace(values=tuple(row.values[index] for _, index in shown))
