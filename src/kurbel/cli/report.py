"""`kurbel report`: all that one machine has on one page, or two machines side by side."""

import os
import sys
import time
from typing import TYPE_CHECKING

import click

from kurbel.cli.output_options import loaded, number_options, set_option, units_option
from kurbel.cli.readings import number
from kurbel.render import Look

if TYPE_CHECKING:
    from threading import Timer

_PATIENCE = 1.0
"""Seconds after which a terminal is told what is being done."""


@click.command()
@click.argument("files", metavar="FILE [FILE]", nargs=-1, required=True, type=click.Path(allow_dash=True))
@set_option
@click.option("--output", "-o", "file_name", metavar="FILE.html", help="Write to this file, not to standard output.")
@click.option("--step", type=number, default=15.0, metavar="DEGREES", help="Step of the tables; 15 if not given.")
@units_option
@number_options
def report(
    files: tuple[str, ...],
    overrides: tuple[str, ...],
    file_name: str | None,
    step: float,
    units: str | None,
    decimal: str,
    digits: int | None,
) -> None:
    """Write all that the machine in FILE has to one page: input, pictures, tables, key values, limits, energy balance.

    The page needs no script and nothing from the net; it can be read, printed and sent. Two files are put side by side,
    with their differences. --set holds for each of them. FILE may be - for standard input.
    """
    from kurbel.machine_file.given import given
    from kurbel.render.output import refuse_overwriting, write_out
    from kurbel.render.report_page import report_page
    from kurbel.report.whole import side_by_side, whole_report
    from kurbel.solver.case import Case

    if len(files) > 2 or files.count("-") > 1:
        raise click.UsageError("a report is of one machine, or of two side by side.")
    if file_name is not None and file_name != "-" and not file_name.lower().endswith((".html", ".htm")):
        raise click.UsageError(f"--output {file_name}: the name of a report ends in .html.")
    for file in files:
        refuse_overwriting(file_name, (file,))
    with Progress("kurbel report") as progress:
        progress("reading and checking")
        cases = [Case(loaded(file, overrides, file_name)) for file in files]
        keys = [given(case.machine.origin) if case.machine.origin else () for case in cases]
        system = units or "metric"
        if len(cases) == 1:
            document = whole_report(cases[0], keys[0], system, step, progress)
        else:
            document = side_by_side(cases, keys, system, progress)
        progress("writing")
        look = Look("html", comma=decimal == "comma", digits=digits)
        write_out(report_page(document, look, _today()), file_name, "utf-8")


def _today() -> str:
    """Return the date; SOURCE_DATE_EPOCH decides it where a page must come out the same every time."""
    epoch = os.environ.get("SOURCE_DATE_EPOCH", "")
    seconds = float(epoch) if epoch.isdecimal() else time.time()
    return time.strftime("%Y-%m-%d", time.gmtime(seconds) if epoch.isdecimal() else time.localtime(seconds))


class Progress:
    """Called with what is done next; a terminal is told so from the second on, also in its midst; a pipe is not."""

    def __init__(self, command: str) -> None:
        self._command = command
        self._doing = ""
        self._late = False
        self._timer: Timer | None = None

    def __enter__(self) -> "Progress":
        if sys.stderr.isatty():
            from threading import Timer

            self._timer = Timer(_PATIENCE, self._tell)
            self._timer.daemon = True
            self._timer.start()
        return self

    def __exit__(self, *_: object) -> None:
        if self._timer:
            self._timer.cancel()

    def __call__(self, doing: str) -> None:
        self._doing = doing
        if self._late:
            self._tell()

    def _tell(self) -> None:
        self._late = True
        click.echo(f"{self._command}: {self._doing} …", err=True)
