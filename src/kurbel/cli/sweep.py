"""`kurbel sweep`: key values over a grid, a list or a sample of machines."""

import sys
from collections.abc import Iterable
from contextlib import closing
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from kurbel.cli.group import to_stderr
from kurbel.cli.options import (
    complete_override,
    format_of,
    machine_file,
    output_option,
    stacked,
    units_option,
    with_bar,
    words,
)
from kurbel.render import Look

if TYPE_CHECKING:
    from kurbel.designs.sweep import Row, Spec

_SUFFIXES = {".csv": "csv", ".json": "json", ".jsonl": "json", ".md": "markdown", ".parquet": "parquet"}
_LINES = ("csv", "json")
"""Formats that can go on where they end."""
_FORMATS = ("table", "csv", "json", "markdown", "parquet")

_what_varies = stacked(
    click.option(
        "--vary",
        multiple=True,
        metavar="KEY=VALUES",
        shell_complete=complete_override,
        help="rod_ratio=3:6:0.25, speed=40,50,60 rpm, bore=normal(450 mm, 0.2 mm) or uniform(...); may be repeated, "
        "for all combinations; in one, 'bore=400,450 mm; head_end_rod=70,80 mm' go together.",
    ),
    click.option("--cases", is_flag=True, help="Every load case of FILE, by itself or with every --vary."),
    click.option("--zip", "side_by_side", is_flag=True, help="First values with first values; else all combinations."),
    click.option(
        "--sample", type=click.IntRange(1, 10**8), metavar="N", help="Points of a Latin hypercube of distributions."
    ),
    click.option("--seed", type=click.IntRange(0), default=0, help="Of the sample; 0 if not given."),
)
_what_is_told = stacked(
    click.option("--columns", type=words, metavar="ID,ID,...", help="Key values of any command, by id or symbol."),
    click.option("--angles", "with_angles", is_flag=True, help="Beside every extreme the crank angle where it stands."),
    click.option(
        "--where",
        "conditions",
        multiple=True,
        metavar="CONDITION",
        help="Only rows with 'c_max < 5 m/s' or 'keeps = yes'.",
    ),
    click.option("--sort", metavar="ID", help="The smallest of this column first; -ID: the largest."),
    click.option("--top", type=click.IntRange(1), metavar="N", help="Only the first N rows of --sort."),
    click.option("--pareto", type=words, metavar="ID,ID", help="Only rows that no other betters; -ID: more is better."),
    click.option("--summary", is_flag=True, help="Quantiles, and rank correlation with every input, instead of rows."),
)
_where_it_goes = stacked(
    click.option("--format", "-f", "format", type=click.Choice(_FORMATS), help="By the suffix of --output, or table."),
    output_option,
    click.option("--decimal", type=click.Choice(["point", "comma"]), default="point", help="Decimal sign."),
    click.option("--digits", type=click.IntRange(1, 17), help="Significant digits; 4, and all in csv and json."),
    click.option(
        "--resume", is_flag=True, help="Continue from the FILE.part of a run of --output FILE that ended early."
    ),
)
_who_computes = stacked(
    click.option(
        "--shard", metavar="K/N", help="Only this part of the rows; all parts one after another are the whole."
    ),
    click.option(
        "--jobs",
        "-j",
        type=click.IntRange(1),
        metavar="N",
        help="Processes; if not given, of many rows one for each of up to 4 cores.",
    ),
    click.option(
        "--dask", metavar="ADDRESS", help="Scheduler of a Dask cluster that computes, such as tcp://node:8786."
    ),
    click.option("--yes", is_flag=True, help="Compute more than ten million rows."),
)


@click.command()
@machine_file
@_what_varies
@_what_is_told
@units_option
@_where_it_goes
@_who_computes
def sweep(**options: Any) -> None:
    """Compute key values for many designs of the machine in FILE: one row each, inputs and answers.

    Any dotted key of the file that holds a value may vary. A design that fails stays, with its reason; where the file
    gives 'limits', each row says whether it keeps them, and which is the first that it breaks.
    """
    asked = _Asked(**options)
    asked.refuse_contradictions()
    asked.run()


class _Asked(NamedTuple):
    """The options, by the names above."""

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

    @property
    def _look(self) -> Look:
        return Look(self._written, comma=self.decimal == "comma", digits=self.digits)

    @property
    def _written(self) -> str:
        """The format of the output."""
        return format_of(self.format, self.file_name, _SUFFIXES)

    @property
    def _in_order(self) -> bool:
        """Whether rows are told as they come."""
        return not (self.sort or self.pareto or self.summary)

    @property
    def _resumable(self) -> bool:
        return bool(self.file_name and self.file_name != "-" and self._written in _LINES and self._in_order)

    def refuse_contradictions(self) -> None:
        """Raise click.UsageError for options that do not go together."""
        named = self.file_name not in (None, "-")
        for wrong, message in (
            (not (self.vary or self.cases), "Missing option '--vary', which says what varies; or give --cases."),
            (self.cases and self.case_name, "--cases has every load case, --case one; leave one of them out."),
            (self.top and not self.sort, "--top N takes the first rows of --sort ID; give --sort too."),
            (self.resume and not named, "--resume goes on in a file; give --output FILE."),
            (self.resume and self._written not in _LINES, "--resume goes on in csv or json lines."),
            (self.resume and not self._in_order, "--resume cannot go on where rows are sorted, chosen or summed up."),
            (self._written == "parquet" and not named, "Parquet is a file; give --output FILE.parquet."),
            (self.summary and self._written == "parquet", "--summary is a table, csv, json or markdown."),
            (self.summary and self.shard, "--summary is of all rows; leave --shard out."),
            (self.sort == "", "--sort names no column; leave it out, or name one."),
            (self.shard == "", "--shard has no number; write K/N, such as 2/8, K from 1 to N."),
            (self.dask == "", "--dask has no address; give that of a scheduler, such as tcp://node:8786."),
            (self.dask and self.jobs, "--dask and --jobs both say who computes; leave one of them out."),
            (self.decimal == "comma" and self._written in ("json", "parquet"), "--decimal comma: not in this format."),
        ):
            if wrong:
                raise click.UsageError(message)

    def run(self) -> None:
        """Compute and write the rows."""
        from kurbel.designs.chosen import read_aim, read_condition, summary, summary_heads, unbettered
        from kurbel.designs.plan import shard
        from kurbel.designs.sweep import Sweep
        from kurbel.designs.workers import likely_jobs, rows_of
        from kurbel.render.sweep_rows import Kept, Titles, kept_rows, write_rows

        found = Sweep(self._spec())
        rows = shard(self.shard, found.rows) if self.shard else range(found.rows)
        conditions = [read_condition(one, found.heads, found.texts) for one in self.conditions]
        aims = [read_aim(one, found.heads, "--pareto") for one in self.pareto or ()]
        order = read_aim(self.sort, found.heads, "--sort") if self.sort else None
        titles = Titles(tuple((one.id, one.unit) for one in found.heads), found.texts)
        if self.summary:
            titles = Titles(summary_heads(found.heads), row="column")
        elif self._written == "parquet":
            titles = titles._replace(types=found.types())
        headed, kept = rows.start == 0, Kept()
        if self.resume:
            kept, rows = kept_rows(self.file_name or "", found, titles, self._look, rows, conditions)
            headed = headed and not any(kept)
        jobs = self.jobs or (1 if self.shard else likely_jobs(len(rows)))
        with closing(rows_of(found, rows, jobs, self.dask or "", to_stderr)) as computed:
            wanted: Iterable[Row] = computed
            if self.file_name or not sys.stdout.isatty():  # else the rows themselves go to the terminal
                wanted = with_bar(wanted, "designs", length=len(rows), update_min_steps=100)
            chosen: Iterable[Any] = (row for row in wanted if all(one.holds(row) for one in conditions))
            chosen = unbettered(chosen, aims) if aims else chosen
            chosen = sorted(chosen, key=order.of)[: self.top] if order else chosen
            chosen = summary(chosen, found.heads) if self.summary else chosen

            def early(left: str) -> None:
                to_stderr(left + "; run again with --resume to continue" * self._resumable)

            write_rows(chosen, titles, self._look, self.file_name, early, headed, kept)

    def _spec(self) -> "Spec":
        from kurbel.designs.plan import MOST_ROWS
        from kurbel.designs.sweep import Spec
        from kurbel.machine_file import source
        from kurbel.render.output import refuse_overwriting

        refuse_overwriting(self.file_name, (self.file,))
        system = self.units or ("si" if self._written in ("csv", "json", "parquet") else "metric")
        plan = self.vary, self.side_by_side, self.sample, self.seed
        origin = source.read(self.file)._replace(case=self.case_name).set_over(self.overrides)
        most = None if self.yes else MOST_ROWS
        return Spec(origin, *plan, self.columns or (), self.with_angles, system, most=most, cases=self.cases)
