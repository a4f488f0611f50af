"""Output of pictures: to the terminal, or to a file whose suffix decides the format."""

import importlib.util
import json
import os
from collections.abc import Iterable, Iterator, Sequence
from typing import Literal

import numpy as np

from kurbel.errors import UsageError
from kurbel.pictures.picture import Fact, Facts, Picture
from kurbel.render import Look
from kurbel.render.braille import braille
from kurbel.render.output import look_at, opened, write_lines
from kurbel.render.paper import A4, FIT, PAPERS, Sheet, sheets
from kurbel.render.svg import poster_svg, svg_file
from kurbel.render.text import BLANK, DIGITS, Line, subscripts

_PAGE = """#set document(date: none)
#set page(width: auto, height: auto, margin: 0pt)
#image(bytes(sys.inputs.svg), format: "svg")"""
_SHEETS = """
#let sheets = json(bytes(sys.inputs.sheets))
#set document(title: sheets.at(0).title, date: none)
#set text(font: ("Libertinus Serif", "DejaVu Serif"), size: 10pt, fill: rgb("#1f2a33"))
#for (number, sheet) in sheets.enumerate() {
  set page(
    paper: sys.inputs.paper, flipped: sheet.lies, margin: (x: 14mm, top: 14mm, bottom: 16mm),
    footer: align(right, text(size: 8pt, fill: rgb("#66727c"))[#sheet.title #h(1em) #(number + 1)/#sheets.len()]),
  )
  grid(
    rows: (1fr, auto), row-gutter: 3mm, columns: 100%,
    layout(room => image(
      bytes(sheet.svg), format: "svg", height: calc.min(room.height, room.width * sheet.tall),
    )),
    for (index, part) in sheet.text.enumerate() { if calc.odd(index) { sub(part) } else { part } },
  )
}
"""
"""Pages of a picture each, with its caption below it."""
_DOTS_PER_INCH = 192.0


def check_file(file_name: str, option: str = "--output", poster: bool = False) -> str:
    """Return svg, png or pdf; raises UsageError where none can be drawn to this file, before anything is computed.

    option: that names the file, "" in Python; poster: as a sheet of paper, for which svg needs typst, too.
    """
    named = f"{option} {file_name}".strip()
    kind = os.path.splitext(file_name)[1].lower()[1:]
    if kind not in ("svg", "png", "pdf"):
        raise UsageError(f"{named}: the name of a picture ends in .svg, .png or .pdf")
    needs_typst = kind != "svg" or poster
    if needs_typst and importlib.util.find_spec("typst") is None:
        what = "poster" if poster else kind
        remedy = "" if poster else "; svg needs no package"
        raise UsageError(
            f"{named}: a {what} needs typst, which is not installed: pip install typst{remedy}"
        )
    return kind


def draw_output(
    pictures: Iterable[Picture], look: Look, file_name: str | None, paper: str = A4
) -> None:
    """Draw pictures to a file, or as characters to standard output where none is named; paper: see `draw_file`."""
    if file_name is not None:
        draw_file(list(pictures), look, file_name, paper)
        return
    look = look_at(None, look)
    write_lines(_below_one_another(pictures, look), look)


def _below_one_another(pictures: Iterable[Picture], look: Look) -> Iterator[Line]:
    """Yield the lines of pictures, with a blank line between two."""
    for number, picture in enumerate(pictures):
        if number:
            yield BLANK
        yield from braille(picture, look)


def draw_file(pictures: Sequence[Picture], look: Look, file_name: str, paper: str = A4) -> None:
    """Draw pictures to a file, of a pdf on sheets of paper of this size, else one below the other.

    Raises UsageError where it cannot be written.
    """
    kind = check_file(file_name, "")
    if paper not in (*PAPERS, FIT):
        raise UsageError(f"paper '{paper}': there are {', '.join(PAPERS)}, {FIT}")
    if kind == "pdf" and paper != FIT:
        drawn = typeset(
            _SHEETS,
            file_name,
            paper=PAPERS[paper].word,
            sheets=json.dumps(
                [_words(sheet, look) for sheet in sheets(pictures, PAPERS[paper], look)]
            ),
        )
    else:
        drawn = svg_file(pictures, look, paper=kind != "svg").encode()
        if kind != "svg":
            drawn = typeset(_PAGE, file_name, svg=drawn.decode())
    with opened(file_name) as file:
        file.write(drawn)


def _words(sheet: Sheet, look: Look) -> dict[str, object]:
    """Return what a sheet has, for typst."""
    return {
        "title": look.text(sheet.picture.machine or sheet.picture.title),
        "lies": sheet.lies,
        "tall": sheet.tall,
        "svg": sheet.svg,
        "text": subscripts(look.sentence(sheet.picture.text)),
    }


def typeset(document: str, file_name: str, **inputs: str) -> bytes:
    """Return a document of typst as svg, png or pdf, as the name of a file ends; inputs: texts that it reads."""
    import typst

    formats: dict[str, Literal["svg", "png", "pdf"]] = {".svg": "svg", ".png": "png", ".pdf": "pdf"}
    kind = formats[os.path.splitext(file_name)[1].lower()]
    return typst.compile(document.encode(), format=kind, ppi=_DOTS_PER_INCH, sys_inputs=inputs)


# a machine in section as a sheet to hang: its picture, its name, one line of sizes, and a few key values

SIZES = ("A0", "A1", "A2", "A3", "A4", "A5")
_MOST_FACTS = 6
_SHEET = """
#let of = json(bytes(sys.inputs.words))
#set document(title: of.title, date: none)
#set page(paper: lower(of.size), flipped: of.wide, margin: 0pt)
#set text(font: ("Libertinus Serif", "DejaVu Serif"), fill: rgb("#1f2a33"))
#layout(sheet => {
  let u = calc.min(sheet.width, sheet.height) / 100
  set par(leading: 0.5em)
  pad(x: 7 * u, y: 7 * u, grid(
    rows: (auto, 1fr, auto), row-gutter: 3 * u, columns: 100%,
    align(center, [
      #text(size: of.large * u, of.title)
      #v(-1.2 * u)
      #text(size: 1.75 * u, fill: rgb("#66727c"), of.line)
    ]),
    align(center + horizon, image(bytes(sys.inputs.svg), format: "svg", width: 100%, height: 100%, fit: "contain")),
    if of.facts.len() > 0 {
      line(length: 100%, stroke: 0.08 * u + rgb("#9aa5ae"))
      v(0.6 * u)
      let faint(of) = text(size: 1.4 * u, fill: rgb("#66727c"), of)
      grid(
        columns: (1fr,) * of.facts.len(), column-gutter: 2 * u, row-gutter: 1.1 * u,
        ..of.facts.map(one => grid.cell(align: center + bottom, faint(one.title))),
        ..of.facts.map(one => align(center)[#text(size: 2.9 * u, one.value) #text(size: 1.6 * u, one.unit)]),
        ..of.facts.map(one => align(center, faint[
          #emph(one.symbol.at(0))#sub(one.symbol.at(1, default: ""))#one.where
        ])),
      )
    },
  ))
})
"""


def check_poster(size: str, file_name: str | None) -> str:
    """Return the size of a sheet as it is named; raises UsageError where none can be drawn to this file."""
    named = next((name for name in SIZES if name.lower() == size.lower()), None)
    if named is None:
        raise UsageError(f"--poster {size}: there are {', '.join(SIZES)}")
    if file_name is None or not file_name.lower().endswith((".pdf", ".svg")):
        raise UsageError(
            f"--poster {named}: a poster is a file; give --output NAME.pdf or NAME.svg"
        )
    check_file(file_name, poster=True)
    return named


def draw_poster(
    picture: Picture, line: str, facts: Facts, look: Look, file_name: str, size: str
) -> None:
    """Draw the first panel of a picture as a sheet of this size to a file; line: what is below its name."""
    panel = picture.panels[0]
    # no room for forces, which are left out
    x = panel.x._replace(low=None, high=None)
    y = panel.y._replace(low=None, high=None)
    panel = panel._replace(x=x, y=y, curves=(), title="")
    across, up = (np.concatenate(arrays) for arrays in panel.places)
    wide = bool(np.ptp(across) > 0.95 * np.ptp(up))
    title = look.text(picture.machine)
    words = {
        "title": title,
        "line": line,
        "size": size,
        "wide": wide,
        "large": min(5.2, 150.0 * (1.4 if wide else 1.0) / max(len(title), 1)),
        "facts": [_fact(fact, look) for fact in facts.facts[:_MOST_FACTS]],
    }
    drawn = typeset(_SHEET, file_name, words=json.dumps(words), svg=poster_svg(panel, look, wide))
    with opened(file_name) as file:
        file.write(drawn)


def _fact(fact: Fact, look: Look) -> dict[str, object]:
    """Return what the sheet says of a key value."""
    value, unit = look.measured(fact.value, fact.unit, DIGITS)
    return {
        "title": look.text(fact.title),
        "value": look.fine(value),
        "unit": unit,
        "symbol": subscripts(look.text(fact.symbol)),
        "where": f" {look.text(fact.where)}",
    }
