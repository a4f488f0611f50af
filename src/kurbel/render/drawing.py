"""Where pictures go: to the terminal, or to a file whose suffix decides what it is."""

import importlib.util
import os
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

from kurbel.errors import UsageError
from kurbel.render import Look
from kurbel.render.braille import braille
from kurbel.render.output import replaced, stdout_look, write_coloured, write_file, write_stdout
from kurbel.render.svg import svg_file
from kurbel.render.text import BLANK, Line, plain
from kurbel.report.picture import Picture

_SHEET = b"""#set document(date: none)
#set page(width: auto, height: auto, margin: 0pt)
#image(bytes(sys.inputs.svg), format: "svg")"""
_DOTS_PER_INCH = 192.0


def check_file(file_name: str, option: str = "--output") -> None:
    """Raise UsageError where no picture can be drawn to this file, before anything is computed."""
    kind = _kind(file_name)
    if kind not in ("svg", "png", "pdf"):
        raise UsageError(f"{option} {file_name}: the name of a picture ends in .svg, .png or .pdf")
    if kind != "svg" and importlib.util.find_spec("typst") is None:
        raise UsageError(
            f"{option} {file_name}: a {kind} needs typst, which is not installed: "
            "pip install 'kurbel[plot]'; an svg needs nothing"
        )


def _kind(file_name: str) -> str:
    return os.path.splitext(file_name)[1].lower()[1:]


def draw_file(pictures: Sequence[Picture], look: Look, file_name: str) -> None:
    """Draw pictures one below the other to a file. Raises UsageError where it cannot be written."""
    check_file(file_name)
    kind, look = _kind(file_name), replace(look, encoding="utf-8")
    if kind == "svg":
        write_file(file_name, [svg_file(pictures, look)])
        return
    import typst

    drawn = {"svg": svg_file(pictures, look, paper=True)}
    page = typst.compile(_SHEET, format="png" if kind == "png" else "pdf", ppi=_DOTS_PER_INCH, sys_inputs=drawn)
    try:
        with replaced(file_name) as path, open(path, "wb") as file:
            file.write(page)
    except (OSError, ValueError) as error:
        raise UsageError(f"cannot write {file_name}: {getattr(error, 'strerror', None) or error}") from None


def draw_stdout(pictures: Iterable[Picture], look: Look) -> None:
    """Draw pictures as characters to standard output, in colour where that is a terminal that wants it."""
    look = stdout_look(look)
    lines = list(_lines(pictures, look))
    if not write_coloured(lines, look):
        write_stdout(plain(lines))


def _lines(pictures: Iterable[Picture], look: Look) -> Iterator[Line]:
    for number, picture in enumerate(pictures):
        yield from (BLANK,) * (number > 0)
        yield from braille(picture, look)
