"""From a neutral report to text: the page of the book, one line per angle, CSV, JSON, Markdown, HTML and LaTeX."""

from collections.abc import Iterable
from dataclasses import dataclass
from importlib import import_module

from kurbel.render.charset import Charset
from kurbel.report.tables import Report

_WRITERS = {"csv": "csv_text", "json": "json_text", "markdown": "markdown", "html": "html", "latex": "latex"}
"""Format -> the function, in the file of its name, that makes its text of a report."""
FORMATS = ("table", *_WRITERS)
LAYOUTS = ("book", "rows")


@dataclass(frozen=True, eq=False)
class Look:
    """How a report is to look.

    format, layout: of FORMATS and LAYOUTS; comma: decimal comma; digits: significant digits, where None means four in
    print and all of them in csv and json; width: columns to fill, None for nine angles to a block and nothing folded;
    encoding: of the output.
    """

    format: str = "table"
    layout: str = "book"
    comma: bool = False
    digits: int | None = None
    width: int | None = None
    encoding: str = "utf-8"

    @property
    def charset(self) -> Charset:
        """What the output can show."""
        return Charset(self.encoding)


def render(report: Report, look: Look = Look()) -> str:
    """Return the report as text that ends with a newline; the same report gives the same text every time."""
    return "".join(pieces(report, look))


def pieces(report: Report, look: Look) -> Iterable[str]:
    """Return the text of the report piece by piece, each made when it is asked for: a long table is never held."""
    if look.format != "table":
        name = _WRITERS[look.format]
        text: Iterable[str] = getattr(import_module(f"kurbel.render.{name}"), name)(report, look)
        return text
    from kurbel.render.lines import plain
    from kurbel.render.page import page

    return plain(page(report, look))
