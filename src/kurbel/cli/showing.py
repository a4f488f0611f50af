"""What `kurbel report` does: a whole page."""

import os
import sys
import time

import click

from kurbel.cli.group import ProgressLine
from kurbel.cli.request import case_of, cases_of
from kurbel.machine_file.overrides import key_texts
from kurbel.page.contents import SHORT, Contents
from kurbel.page.whole import side_by_side, whole_report
from kurbel.render import Look
from kurbel.render.output import refuse_overwriting, write_out
from kurbel.render.paper import A4
from kurbel.render.report_page import report_page


def write_page(
    files: tuple[str, ...],
    case_name: str,
    overrides: tuple[str, ...],
    file_name: str | None,
    step: float,
    section_words: tuple[str, ...] | None,
    short: bool,
    paper: str | None,
    title: str | None,
    units: str | None,
    comma: bool,
    digits: int | None,
) -> None:
    """Write the report on one machine, or on two side by side: the options of the command."""
    if len(files) > 2 or files.count("-") > 1:
        raise click.UsageError("a report is of one machine, or of two side by side.")
    if file_name is None:
        # a page of HTML is nothing to read in a terminal
        if sys.stdout and sys.stdout.isatty():
            raise click.UsageError(
                "a report is a page for the browser; "
                "give --output NAME.html, or - for this terminal."
            )
    elif file_name != "-" and not file_name.lower().endswith((".html", ".htm")):
        raise click.UsageError(f"--output {file_name}: the name of a report ends in .html.")
    if short and section_words is not None:
        raise click.UsageError("--short is --sections answers,input; give one of them.")
    contents = Contents.of(SHORT if short else section_words or ())
    refuse_overwriting(file_name, files)

    # the machines, with the keys of their files
    system = units or "metric"
    cases = [case_of(file, case_name, overrides, file_name) for file in files]
    keys = [key_texts(case.machine.origin) if case.machine.origin else () for case in cases]

    with ProgressLine("report") as progress:
        if len(cases) == 2:
            document = side_by_side(cases, keys, system, progress, contents)
        else:
            machine = cases[0].machine
            load_cases = cases_of(machine) if machine.cases and not case_name else []
            document = whole_report(cases[0], keys[0], system, step, progress, load_cases, contents)
    document = document._replace(title=title or document.title)

    # SOURCE_DATE_EPOCH decides the date where a page must come out the same every time
    epoch = os.environ.get("SOURCE_DATE_EPOCH", "")
    date = time.gmtime(float(epoch)) if epoch.isdecimal() else time.localtime()
    look = Look("html", comma=comma, digits=digits)
    page = report_page(document, look, paper or A4, time.strftime("%Y-%m-%d", date))
    write_out(page, file_name, "utf-8")
