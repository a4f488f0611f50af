"""Output of pictures: to the terminal, or to a file whose suffix decides the format."""

import importlib.util
import os
from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Literal

from kurbel.errors import UsageError
from kurbel.render import Look
from kurbel.render.braille import braille
from kurbel.render.output import opened, stdout_look, write_coloured, write_out
from kurbel.render.svg import svg_file
from kurbel.render.text import BLANK, plain
from kurbel.report.picture import Picture

_SHEET = b"""#set document(date: none)
#set page(width: auto, height: auto, margin: 0pt)
#image(bytes(sys.inputs.svg), format: "svg")"""
_DOTS_PER_INCH = 192.0


def check_file(file_name: str, option: str = "--output", poster: bool = False) -> str:
    """Return svg, png or pdf; raises UsageError where none can be drawn to this file, before anything is computed.

    poster: as a sheet of paper, for which svg needs typst, too.
    """
    kind = os.path.splitext(file_name)[1].lower()[1:]
    if kind not in ("svg", "png", "pdf"):
        raise UsageError(f"{option} {file_name}: the name of a picture ends in .svg, .png or .pdf")
    if (kind != "svg" or poster) and importlib.util.find_spec("typst") is None:
        raise UsageError(
            f"{option} {file_name}: a {'poster' if poster else kind} needs typst, which is not installed: "
            f"pip install 'kurbel[plot]'{'' if poster else '; svg needs no package'}"
        )
    return kind


def draw(pictures: Iterable[Picture], look: Look, file_name: str | None) -> None:
    """Draw pictures to a file, or to standard output where none is named."""
    if file_name is None:
        draw_stdout(pictures, look)
    else:
        draw_file(list(pictures), look, file_name)


def draw_file(pictures: Sequence[Picture], look: Look, file_name: str) -> None:
    """Draw pictures one below the other to a file. Raises UsageError where it cannot be written."""
    kind, look = check_file(file_name), replace(look, encoding="utf-8")
    drawn = svg_file(pictures, look, paper=kind != "svg").encode()
    if kind != "svg":
        import typst

        kind_of_page: Literal["png", "pdf"] = "png" if kind == "png" else "pdf"
        drawn = typst.compile(_SHEET, format=kind_of_page, ppi=_DOTS_PER_INCH, sys_inputs={"svg": drawn.decode()})
    with opened(file_name) as file:
        file.write(drawn)


def draw_stdout(pictures: Iterable[Picture], look: Look) -> None:
    """Draw pictures as characters to standard output, in colour on a terminal unless colours are not wanted."""
    look = stdout_look(look)
    lines = [line for picture in pictures for line in (BLANK, *braille(picture, look))][1:]
    if not write_coloured(lines, look):
        write_out(plain(lines), None)
