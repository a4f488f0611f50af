"""What `kurbel plot` does: pictures in the terminal or in a file."""

import click

from kurbel.cli.request import case_of
from kurbel.pictures.picture_source import PictureOptions
from kurbel.pictures.pictures import PICTURES, pictures, pictures_of
from kurbel.render import Look
from kurbel.render.drawing import check_file, check_poster, draw_output, draw_poster
from kurbel.render.output import write_entries
from kurbel.render.paper import A4


def draw_pictures(
    file: str | None,
    case_name: str,
    overrides: tuple[str, ...],
    names: tuple[str, ...],
    listed: bool,
    file_name: str | None,
    angles: tuple[float, ...] | None,
    size: str | None,
    paper: str | None,
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
    is_pdf = file_name is not None and file_name.lower().endswith(".pdf")
    if paper is not None and (size is not None or not is_pdf):
        raise click.UsageError(
            f"--paper {paper} is for pictures in a pdf; give --output NAME.pdf, and no --poster."
        )

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
        from kurbel.page.summary import facts_of, subtitle_of, tiles  # which opens checks

        facts = tiles(facts_of(case).values(), options.system)
        return draw_poster(next(drawn), subtitle_of(case.machine), facts, look, file_name, size)
    draw_output(drawn, look, file_name, paper or A4)
