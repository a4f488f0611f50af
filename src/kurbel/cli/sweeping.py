"""What `kurbel sweep` does with its options: plans the rows, computes, chooses and writes them."""

import sys
from collections.abc import Iterable
from contextlib import closing

import click

from kurbel.cli.group import Progress, to_stderr
from kurbel.cli.options import format_of
from kurbel.designs.chosen import pareto_front, read_aim, read_condition, summary, summary_heads
from kurbel.designs.plan import MOST_ROWS, read_axis
from kurbel.designs.plan import shard as rows_of_shard
from kurbel.designs.study import Design, Head
from kurbel.designs.sweep import Spec, Sweep
from kurbel.designs.workers import likely_jobs, rows_of
from kurbel.machine_file import source
from kurbel.render import Look
from kurbel.render.output import refuse_overwriting
from kurbel.render.sweep_rows import Kept, Titles, kept_rows, write_rows

_SUFFIXES = {".csv": "csv", ".json": "json", ".jsonl": "json", ".md": "markdown", ".parquet": "parquet"}
_LINES = ("csv", "json")
"""Formats that can go on where they end."""


def run(
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
    named, for_people = file_name not in (None, "-"), written in ("table", "markdown")
    resumable = named and written in _LINES and not (sort or pareto or summarised)
    for wrong, message in (
        (not (vary or cases), "Missing option '--vary' (the values to vary); or give --cases."),
        (cases and case_name, "--cases has every load case, --case one; leave one of them out."),
        (top and not sort, "--top N takes the first rows of --sort ID; give --sort too."),
        (resume and not resumable, "--resume goes on in csv or json lines, rows in order; give --output FILE.csv."),
        (written == "parquet" and not named, "Parquet is a file; give --output FILE.parquet."),
        (summarised and (shard or written == "parquet"), "--summary is of all rows, as text; no --shard, no parquet."),
        (dask and jobs, "give only one of --dask and --jobs."),
    ):
        if wrong:
            raise click.UsageError(message)
    refuse_overwriting(file_name, (file,))
    origin = source.read(file)._replace(case=case_name).set_over(overrides)
    axes, most = tuple(map(read_axis, vary)), None if yes else MOST_ROWS
    system = units or ("metric" if for_people else "si")
    sweep = Sweep(Spec(origin, axes, side_by_side, sample, seed, most, cases, columns or (), with_angles, system))
    rows = range(sweep.rows) if shard is None else rows_of_shard(shard, sweep.rows)
    every = (*sweep.heads, *map(Head, sweep.texts))
    kept_if = [read_condition(one, every) for one in conditions]
    aims = [read_aim(one, every, "--pareto") for one in pareto or ()]
    order = None if sort is None else read_aim(sort, every, "--sort")
    shown = sweep.shown if for_people else [(one.id, place) for place, one in enumerate(sweep.heads)]
    names = tuple((name, sweep.heads[place].unit) for name, place in shown)
    titles = Titles(names, sweep.texts, types=sweep.types() if written == "parquet" else ())
    titles = Titles(summary_heads(sweep.heads), row="column") if summarised else titles
    look = Look(written, comma=comma, digits=digits)
    headed, kept = rows.start == 0, Kept()
    if resume:
        kept, rows = kept_rows(file_name or "", sweep, titles, look, rows, kept_if)
        headed = headed and not any(kept)

    jobs = jobs or (1 if shard else likely_jobs(len(rows)))
    on_terminal = sys.stdout and sys.stdout.isatty()
    with closing(rows_of(sweep, rows, jobs, dask, to_stderr)) as computed:
        found: Iterable[Design] = computed
        if file_name or for_people or not on_terminal:  # else the rows themselves show the progress
            found = Progress("sweep").counted(found, "designs", len(rows))
        found = (row for row in found if all(one.holds(row) for one in kept_if))
        found = pareto_front(found, aims) if aims else found
        found = sorted(found, key=order.of)[:top] if order else found
        if summarised:
            found = summary(found, sweep.heads)
        elif for_people:
            found = (row._replace(values=tuple(row.values[place] for _, place in shown)) for row in found)
        way_on = "; run again with --resume to continue" * resumable
        write_rows(found, titles, look, file_name, lambda left: to_stderr(left + way_on), headed, kept)
    if not (columns or named or summarised) and for_people and on_terminal:
        to_stderr(f"{len(names)} columns; '--columns ID,ID' prints fewer, '-o rows.csv' writes a file")
