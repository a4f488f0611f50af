"""Where pictures go: to the terminal, or to a file whose suffix says what it is."""

import os
from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import chain

from kurbel.errors import UsageError
from kurbel.render import Look
from kurbel.render.output import replaced, stdout_look, write_coloured, write_file, write_stdout
from kurbel.render.text import BLANK, Line, plain
from kurbel.report.pictures.picture import Picture

SUFFIXES = (".svg", ".png", ".pdf")


def check_file(file_name: str, option: str = "--output") -> None:
    """Raise UsageError where no picture can be drawn to this file, before anything is computed."""
    kind = _kind(file_name)
    if kind not in SUFFIXES:
        raise UsageError(
            f"{option} {file_name}: the name of a picture ends in {', '.join(SUFFIXES[:-1])} or {SUFFIXES[-1]}"
        )
    if kind != ".svg":
        from importlib.util import find_spec

        if find_spec("matplotlib") is None:
            raise UsageError(
                f"{option} {file_name}: a {kind[1:]} needs matplotlib, which is not installed: "
                "pip install 'kurbel[plot]'; an svg needs nothing"
            )


def _kind(file_name: str) -> str:
    return os.path.splitext(file_name)[1].lower()


def draw_file(pictures: list[Picture], look: Look, file_name: str) -> None:
    """Draw pictures one below the other to a file. Raises UsageError where it cannot be written."""
    check_file(file_name)
    look = replace(look, encoding="utf-8")
    if _kind(file_name) == ".svg":
        from kurbel.render.pictures.svg import svg_file

        write_file(file_name, svg_file(pictures, look))
        return
    from kurbel.render.pictures.paper import save

    try:
        with replaced(file_name) as path:
            save(pictures, look, path, _kind(file_name)[1:])
    except (OSError, ValueError) as error:
        raise UsageError(f"cannot write {file_name}: {getattr(error, 'strerror', None) or error}") from None


def draw_stdout(pictures: Iterable[Picture], look: Look) -> None:
    """Draw pictures as characters to standard output, in colour where that is a terminal that wants it."""
    look = stdout_look(look)
    lines = list(_lines(pictures, look))
    if not write_coloured(lines, look):
        write_stdout(plain(lines))


def _lines(pictures: Iterable[Picture], look: Look) -> Iterator[Line]:
    from kurbel.render.pictures.letters import letters

    for number, picture in enumerate(pictures):
        yield from chain((BLANK,) * (number > 0), letters(picture, look))
