"""What `kurbel report` and `kurbel plot` do: a whole page, and pictures in the terminal or in a file."""

import os
import time
from collections.abc import Sequence

import click

from kurbel.cli.group import Progress
from kurbel.cli.request import case_of, cases_of
from kurbel.machine_file.overrides import given
from kurbel.render import Look
from kurbel.render.drawing import check_file, check_poster, draw, draw_poster
from kurbel.render.output import write_out
from kurbel.render.page import write_entries
from kurbel.render.report_page import report_page
from kurbel.report.picture_source import PictureOptions
from kurbel.report.pictures import PICTURES, pictures, pictures_of
from kurbel.report.summary import facts_of, subtitle_of, tiles
from kurbel.report.whole import side_by_side, whole_report


def write_page(
    files: Sequence[str],
    case_name: str,
    overrides: Sequence[str],
    file_name: str | None,
    step: float,
    title: str | None,
    system: str,
    look: Look,
) -> None:
    """Write the report on one machine, or on two side by side; step: of its tables in degrees; system: of units."""
    cases = [case_of(file, case_name, overrides, file_name) for file in files]
    keys = [given(case.machine.origin) if case.machine.origin else () for case in cases]
    with Progress("report") as progress:
        if len(cases) == 1:
            load_cases = cases_of(cases[0].machine) if cases[0].machine.cases and not case_name else []
            document = whole_report(cases[0], keys[0], system, step, progress, load_cases)
        else:
            document = side_by_side(cases, keys, system, progress)
    document = document._replace(title=title or document.title)
    # SOURCE_DATE_EPOCH decides the date where a page must come out the same every time
    epoch = os.environ.get("SOURCE_DATE_EPOCH", "")
    today = time.strftime("%Y-%m-%d", time.gmtime(float(epoch)) if epoch.isdecimal() else time.localtime())
    write_out(report_page(document, look, today), file_name, "utf-8")


def draw_pictures(
    file: str | None,
    case_name: str,
    overrides: Sequence[str],
    names: Sequence[str],
    listed: bool,
    file_name: str | None,
    size: str | None,
    options: PictureOptions,
    look: Look,
) -> None:
    """Draw these pictures of a machine; listed: list its pictures, or all without a file; size: that of a poster."""
    if size is not None:
        size = check_poster(size, file_name)
        if set(names) - {"mechanism"} or listed:
            raise click.UsageError("--poster draws the mechanism alone; leave other pictures and --list out.")
        names = ("mechanism",)
    elif file_name is not None:
        check_file(file_name)
    case = None if file is None else case_of(file, case_name, overrides, file_name)
    if case is None or listed:
        kinds = PICTURES if case is None else pictures_of(case, options)
        write_entries([(kind.id, f"{kind.title}. {kind.text}") for kind in kinds])
        return
    drawn = pictures(case, names, options)
    if size is not None and file_name is not None:
        facts = tiles(facts_of(case).values(), options.system)
        return draw_poster(next(drawn), subtitle_of(case.machine), facts, look, file_name, size)
    draw(drawn, look, file_name)
