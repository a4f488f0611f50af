"""What `kurbel report` and `kurbel plot` do: a whole page, and pictures in the terminal or in a file."""

import os
import sys
import time

import click

from kurbel.cli.group import ProgressLine
from kurbel.cli.request import case_of, cases_of
from kurbel.machine_file.overrides import key_texts
from kurbel.page.summary import facts_of, subtitle_of, tiles
from kurbel.page.whole import side_by_side, whole_report
from kurbel.pictures.picture_source import PictureOptions
from kurbel.pictures.pictures import PICTURES, pictures, pictures_of
from kurbel.render import Look
from kurbel.render.drawing import check_file, check_poster, draw_output, draw_poster
from kurbel.render.output import refuse_overwriting, write_entries, write_out
from kurbel.render.report_page import report_page


def write_page(
    files: tuple[str, ...],
    case_name: str,
    overrides: tuple[str, ...],
    file_name: str | None,
    step: float,
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
    refuse_overwriting(file_name, files)

    # the machines, with the keys of their files
    system = units or "metric"
    cases = [case_of(file, case_name, overrides, file_name) for file in files]
    keys = [key_texts(case.machine.origin) if case.machine.origin else () for case in cases]

    with ProgressLine("report") as progress:
        if len(cases) == 2:
            document = side_by_side(cases, keys, system, progress)
        else:
            machine = cases[0].machine
            load_cases = cases_of(machine) if machine.cases and not case_name else []
            document = whole_report(cases[0], keys[0], system, step, progress, load_cases)
    document = document._replace(title=title or document.title)

    # SOURCE_DATE_EPOCH decides the date where a page must come out the same every time
    epoch = os.environ.get("SOURCE_DATE_EPOCH", "")
    date = time.gmtime(float(epoch)) if epoch.isdecimal() else time.localtime()
    look = Look("html", comma=comma, digits=digits)
    page = report_page(document, look, time.strftime("%Y-%m-%d", date))
    write_out(page, file_name, "utf-8")


def draw_pictures(
    file: str | None,
    case_name: str,
    overrides: tuple[str, ...],
    names: tuple[str, ...],
    listed: bool,
    file_name: str | None,
    angles: tuple[float, ...] | None,
    size: str | None,
    cylinder: str | None,
    units: str | None,
    comma: bool,
    digits: int | None,
    width: int | None,
) -> None:
    """Draw these pictures of a machine, or list them; size: that of a poster: the options of the command."""
    if listed and file_name is not None:
        raise click.UsageError("--list draws nothing; leave --output out.")
    if file is None and not listed:
        raise click.MissingParameter(param_type="argument", param_hint="'FILE'")
    if file_name == "-":
        file_name = None
    if size is not None:
        size = check_poster(size, file_name)
        has_other_pictures = set(names) - {"mechanism"}
        if has_other_pictures or listed:
            raise click.UsageError(
                "--poster draws the mechanism alone; leave other pictures and --list out."
            )
        names = ("mechanism",)
    elif file_name is not None:
        check_file(file_name)

    # the list of pictures: all, or those of the machine
    options = PictureOptions(units or "metric", cylinder, angles)
    case = None if file is None else case_of(file, case_name, overrides, file_name)
    if case is None or listed:
        kinds = PICTURES if case is None else pictures_of(case, options)
        write_entries([(kind.id, f"{kind.title}. {kind.text}") for kind in kinds])
        return

    look = Look(comma=comma, digits=digits, width=width)
    drawn = pictures(case, names, options)
    if size is not None and file_name is not None:
        facts = tiles(facts_of(case).values(), options.system)
        return draw_poster(next(drawn), subtitle_of(case.machine), facts, look, file_name, size)
    draw_output(drawn, look, file_name)
