"""What `kurbel sweep` does with its options: plans the rows, computes, chooses and writes them."""

import sys
from collections.abc import Iterable
from contextlib import closing
from typing import NamedTuple

import click

from kurbel.cli.group import Progress, to_stderr
from kurbel.cli.options import format_of
from kurbel.designs.chosen import pareto_front, read_aim, read_condition, summary, summary_heads
from kurbel.designs.plan import MOST_ROWS, read_axis, shard
from kurbel.designs.sweep import Design, Head, Spec, Sweep
from kurbel.designs.workers import likely_jobs, rows_of
from kurbel.machine_file import source
from kurbel.render import Look
from kurbel.render.output import refuse_overwriting
from kurbel.render.sweep_rows import Kept, Titles, kept_rows, write_rows

_SUFFIXES = {".csv": "csv", ".json": "json", ".jsonl": "json", ".md": "markdown", ".parquet": "parquet"}


_LINES = ("csv", "json")
"""Formats that can go on where they end."""


class SweepOptions(NamedTuple):
    """The options of the command, by their names."""

    file: str
    case_name: str
    overrides: tuple[str, ...]
    vary: tuple[str, ...]
    cases: bool
    side_by_side: bool
    sample: int | None
    seed: int
    columns: tuple[str, ...] | None
    with_angles: bool
    conditions: tuple[str, ...]
    sort: str | None
    top: int | None
    pareto: tuple[str, ...] | None
    summary: bool
    units: str | None
    format: str | None
    file_name: str | None
    decimal: str
    digits: int | None
    resume: bool
    shard: str | None
    jobs: int | None
    dask: str | None
    yes: bool


def run(wanted: SweepOptions) -> None:
    """Compute and write the rows. Raises UsageError for options that do not go together."""
    written = format_of(wanted.format, wanted.file_name, _SUFFIXES)
    named = wanted.file_name not in (None, "-")
    in_order = not (wanted.sort or wanted.pareto or wanted.summary)
    _refuse_contradictions(wanted, written, named, in_order)
    refuse_overwriting(wanted.file_name, (wanted.file,))
    origin = source.read(wanted.file)._replace(case=wanted.case_name).set_over(wanted.overrides)
    spec = Spec(
        origin,
        tuple(map(read_axis, wanted.vary)),
        wanted.side_by_side,
        wanted.sample,
        wanted.seed,
        None if wanted.yes else MOST_ROWS,
        wanted.cases,
        wanted.columns or (),
        wanted.with_angles,
        wanted.units or ("si" if written in (*_LINES, "parquet") else "metric"),
    )
    sweep = Sweep(spec)
    rows = shard(wanted.shard, sweep.rows) if wanted.shard else range(sweep.rows)
    every = (*sweep.heads, *map(Head, sweep.texts))
    conditions = [read_condition(one, every) for one in wanted.conditions]
    aims = [read_aim(one, sweep.heads, "--pareto") for one in wanted.pareto or ()]
    order = read_aim(wanted.sort, sweep.heads, "--sort") if wanted.sort else None
    for_people = written in ("table", "markdown")
    if wanted.summary:
        titles = Titles(summary_heads(sweep.heads), row="column")
    else:
        types = sweep.types() if written == "parquet" else ()
        heads = sweep.shown if for_people else [(one.id, place) for place, one in enumerate(sweep.heads)]
        titles = Titles(tuple((name, sweep.heads[place].unit) for name, place in heads), sweep.texts, types=types)
    look = Look(written, comma=wanted.decimal == "comma", digits=wanted.digits)
    headed, kept = rows.start == 0, Kept()
    if wanted.resume:
        kept, rows = kept_rows(wanted.file_name or "", sweep, titles, look, rows, conditions)
        headed = headed and not any(kept)

    jobs = wanted.jobs or (1 if wanted.shard else likely_jobs(len(rows)))
    with closing(rows_of(sweep, rows, jobs, wanted.dask or "", to_stderr)) as computed:
        found: Iterable[Design] = computed
        # else the rows themselves go to the terminal
        if wanted.file_name or not (sys.stdout and sys.stdout.isatty()):
            found = Progress("sweep").counted(found, "designs", len(rows))
        chosen: Iterable[Design] = (row for row in found if all(one.holds(row) for one in conditions))
        chosen = pareto_front(chosen, aims) if aims else chosen
        chosen = sorted(chosen, key=order.of)[: wanted.top] if order else chosen
        if wanted.summary:
            chosen = summary(chosen, sweep.heads)
        elif for_people:
            chosen = (row._replace(values=tuple(row.values[place] for _, place in sweep.shown)) for row in chosen)

        def early(left: str) -> None:
            resumable = named and written in _LINES and in_order
            to_stderr(left + "; run again with --resume to continue" * resumable)

        write_rows(chosen, titles, look, wanted.file_name, early, headed, kept)
    if not (wanted.columns or named or wanted.summary) and for_people and sys.stdout and sys.stdout.isatty():
        to_stderr(f"{len(heads)} columns; '--columns ID,ID' prints fewer, '-o rows.csv' writes a file")


def _refuse_contradictions(wanted: SweepOptions, written: str, named: bool, in_order: bool) -> None:
    """Raise click.UsageError for options that do not go together."""
    for wrong, message in (
        (not (wanted.vary or wanted.cases), "Missing option '--vary' (the values to vary); or give --cases."),
        (wanted.cases and wanted.case_name, "--cases has every load case, --case one; leave one of them out."),
        (wanted.top and not wanted.sort, "--top N takes the first rows of --sort ID; give --sort too."),
        (wanted.resume and not named, "--resume goes on in a file; give --output FILE."),
        (wanted.resume and written not in _LINES, "--resume goes on in csv or json lines."),
        (wanted.resume and not in_order, "--resume cannot go on where rows are sorted, chosen or summed up."),
        (written == "parquet" and not named, "Parquet is a file; give --output FILE.parquet."),
        (wanted.summary and written == "parquet", "--summary is a table, csv, json or markdown."),
        (wanted.summary and wanted.shard, "--summary is of all rows; leave --shard out."),
        (wanted.sort == "", "--sort names no column; leave it out, or name one."),
        (wanted.shard == "", "--shard has no number; write K/N, such as 2/8, K from 1 to N."),
        (wanted.dask == "", "--dask has no address; give that of a scheduler, such as tcp://node:8786."),
        (wanted.dask and wanted.jobs, "give only one of --dask and --jobs."),
        (wanted.decimal == "comma" and written in ("json", "parquet"), "--decimal comma: not in this format."),
    ):
        if wrong:
            raise click.UsageError(message)
