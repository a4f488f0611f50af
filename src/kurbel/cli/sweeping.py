"""What `kurbel sweep` and `kurbel find` do with their options: compute, choose, draw and write what is found."""

import json
import sys
from collections.abc import Iterable
from contextlib import closing

import click

from kurbel.cli.group import ProgressLine, to_stderr
from kurbel.cli.options import format_of
from kurbel.designs.answers import Design, Head
from kurbel.designs.chosen import (
    column_summaries,
    pareto_front,
    read_aim,
    read_condition,
    summary_heads,
)
from kurbel.designs.find import Solution, Solutions
from kurbel.designs.find import find_solutions as found_in
from kurbel.designs.plan import MOST_ROWS, read_axis
from kurbel.designs.plan import shard as rows_of_shard
from kurbel.designs.sweep import Spec, Sweep, computed_rows, likely_jobs
from kurbel.machine.origin import Origin
from kurbel.machine_file import source
from kurbel.machine_file.overrides import rewritten
from kurbel.render import Look
from kurbel.render.drawing import check_file, draw_output
from kurbel.render.output import refuse_overwriting, write_out
from kurbel.render.sweep_rows import (
    Kept,
    Titles,
    as_json,
    as_rows,
    kept_rows,
    picture,
    remarks,
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
    named, for_people, parquet = (
        file_name not in (None, "-"),
        written in ("table", "markdown"),
        written == "parquet",
    )
    resumable = named and written in _LINES and not (sort or pareto or summarised)
    for wrong, message in (
        (not (vary or cases), "Missing option '--vary' (the values to vary); or give --cases."),
        (cases and case_name, "--cases has every load case, --case one; leave one of them out."),
        (top and not sort, "--top N takes the first rows of --sort ID; give --sort too."),
        (
            resume and not resumable,
            "--resume goes on in csv or json lines, rows in order; give --output FILE.csv.",
        ),
        (parquet and not named, "Parquet is a file; give --output FILE.parquet."),
        (
            summarised and (shard or parquet),
            "--summary is of all rows, as text; no --shard, no parquet.",
        ),
        (dask and jobs, "give only one of --dask and --jobs."),
    ):
        if wrong:
            raise click.UsageError(message)
    refuse_overwriting(file_name, (file,))
    origin = source.read(file)._replace(case=case_name).set_over(overrides)
    axes, most = tuple(map(read_axis, vary)), None if yes else MOST_ROWS
    system = units or ("metric" if for_people else "si")
    sweep = Sweep(
        Spec(
            origin,
            axes,
            side_by_side,
            sample,
            seed,
            most,
            cases,
            columns or (),
            with_angles,
            system,
        )
    )
    rows = range(sweep.rows) if shard is None else rows_of_shard(shard, sweep.rows)
    every = (*sweep.heads, *map(Head, sweep.texts))
    kept_if = [read_condition(condition, every) for condition in conditions]
    aims = [read_aim(one, every, "--pareto") for one in pareto or ()]
    order = None if sort is None else read_aim(sort, every, "--sort")
    shown = (
        sweep.shown if for_people else [(one.id, place) for place, one in enumerate(sweep.heads)]
    )
    names = tuple((name, sweep.heads[place].unit) for name, place in shown)
    titles = Titles(names, sweep.texts, types=sweep.types() if parquet else ())
    titles = Titles(summary_heads(sweep.heads), row="column") if summarised else titles
    look = Look(written, comma=comma, digits=digits)
    headed, kept = rows.start == 0, Kept()
    if resume:
        kept, rows = kept_rows(file_name or "", sweep, titles, look, rows, kept_if)
        headed = headed and not any(kept)

    jobs = jobs or (1 if shard else likely_jobs(len(rows)))
    on_terminal = sys.stdout and sys.stdout.isatty()
    with closing(computed_rows(sweep, rows, jobs, dask, to_stderr)) as computed:
        found: Iterable[Design] = computed
        if file_name or for_people or not on_terminal:  # else the rows themselves show the progress
            found = ProgressLine("sweep").counted(found, "designs", len(rows))
        found = (row for row in found if all(one.holds(row) for one in kept_if))
        found = pareto_front(found, aims) if aims else found
        found = sorted(found, key=order.of)[:top] if order else found
        if summarised:
            found = column_summaries(found, sweep.heads)
        elif for_people:
            found = (
                row._replace(values=tuple(row.values[place] for _, place in shown)) for row in found
            )
        way_on = "; run again with --resume to continue" * resumable
        write_rows(
            found, titles, look, file_name, lambda left: to_stderr(left + way_on), headed, kept
        )
    if not (columns or named or summarised) and for_people and on_terminal:
        to_stderr(
            f"{len(names)} columns; '--columns ID,ID' prints fewer, '-o rows.csv' writes a file"
        )


# find

_SUFFIXES_OF_FOUND = {".csv": "csv", ".json": "json", ".md": "markdown"}
_DIGITS = 7
"""Significant digits of a table: values are found to be written into a file."""


def run_find(
    file: str,
    case_name: str,
    overrides: tuple[str, ...],
    equations: tuple[str, ...],
    vary: tuple[str, ...],
    least: str,
    greatest: str,
    conditions: tuple[str, ...],
    plot: bool,
    write: bool,
    take: int | None,
    units: str | None,
    format: str | None,
    file_name: str | None,
    comma: bool,
    digits: int | None,
) -> None:
    """Search, and print, draw or write what is found: the options of the command. Raises KurbelError."""
    for wrong, message in (
        (write and case_name, "--write prints FILE; leave --case out."),
        (write and format, "--write prints FILE; leave --format out."),
        (take and not write, "--take chooses the solution for --write; give --write too."),
        (plot and write, "--plot draws; leave --write out."),
        (plot and format, "--plot draws; leave --format out."),
        (plot and len(vary) > 1, "--plot draws a key value over one key, and two are varied."),
    ):
        if wrong:
            raise click.UsageError(message)
    if plot and file_name:
        check_file(file_name)
    written = "table" if write or plot else format_of(format, file_name, _SUFFIXES_OF_FOUND, comma)
    refuse_overwriting(file_name, (file,))
    origin = source.read(file)._replace(case=case_name).set_over(overrides)
    with ProgressLine("find") as progress:
        found = found_in(origin, vary, equations, least, greatest, conditions, progress)
    if write:
        write_out([_with_values(origin, found, _taken(found, take))], file_name, "utf-8")
        return
    system = units or ("si" if written in ("csv", "json") else "metric")
    if plot:
        draw_output([picture(found, system)], Look(comma=comma, digits=digits), file_name)
    elif written == "json":
        text = json.dumps(as_json(found), ensure_ascii=False, allow_nan=False, indent=1) + "\n"
        write_out([text], file_name, "utf-8")
    else:
        look = Look(written, comma=comma, digits=digits or (None if written == "csv" else _DIGITS))
        titles, rows = as_rows(found, system)
        write_rows(rows, titles, look, file_name, to_stderr)
    for remark in remarks(found):
        to_stderr(remark)


def _taken(found: Solutions, take: int | None) -> Solution:
    """Return the solution that is written. Raises click.UsageError where several are found, or none of this number."""
    count = len(found.found)
    if count > 1 and not take:
        each = "; ".join(
            ", ".join(
                f"{key.key} = {key.written(value, 9)}"
                for key, value in zip(found.varied, one.values)
            )
            for one in found.found
        )
        raise click.UsageError(f"--write: {count} solutions; choose one by --take N: {each}")
    if take and take > count:
        raise click.UsageError(f"--take {take}: there {'are' if count > 1 else 'is'} {count}.")
    return found.found[(take or 1) - 1]


def _with_values(origin: Origin, found: Solutions, one: Solution) -> str:
    """Return the text of the machine file with what was set over it, and what was found."""
    values = dict(text.split("=", 1) for text in origin.overrides)
    for key, value in zip(found.varied, one.values):
        values[key.key] = f"{key.in_unit(value)!r} {key.unit}".rstrip()
    return rewritten(origin.text, values)
