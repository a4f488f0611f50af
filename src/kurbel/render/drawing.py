"""Output of pictures: to the terminal, or to a file whose suffix decides the format."""

import importlib.util
import os
from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import islice
from typing import Literal

from kurbel.errors import UsageError
from kurbel.render import Look
from kurbel.render.braille import braille
from kurbel.render.output import opened, stdout_look, write_lines
from kurbel.render.svg import svg_file
from kurbel.render.text import BLANK
from kurbel.report.picture import Picture

_SHEET = """#set document(date: none)
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
    """Draw pictures to a file, or as characters to standard output where none is named."""
    if file_name is not None:
        draw_file(list(pictures), look, file_name)
        return
    look = stdout_look(look)
    lines = (line for picture in pictures for line in (BLANK, *braille(picture, look)))
    write_lines(islice(lines, 1, None), look)


def draw_file(pictures: Sequence[Picture], look: Look, file_name: str) -> None:
    """Draw pictures one below the other to a file. Raises UsageError where it cannot be written."""
    kind, look = check_file(file_name), replace(look, encoding="utf-8")
    drawn = svg_file(pictures, look, paper=kind != "svg").encode()
    if kind != "svg":
        drawn = typeset(_SHEET, file_name, svg=drawn.decode())
    with opened(file_name) as file:
        file.write(drawn)


def typeset(document: str, file_name: str, **inputs: str) -> bytes:
    """Return a document of typst as svg, png or pdf, as the name of a file ends; inputs: texts that it reads."""
    import typst

    formats: dict[str, Literal["svg", "png", "pdf"]] = {".svg": "svg", ".png": "png", ".pdf": "pdf"}
    kind = formats[os.path.splitext(file_name)[1].lower()]
    return typst.compile(document.encode(), format=kind, ppi=_DOTS_PER_INCH, sys_inputs=inputs)
