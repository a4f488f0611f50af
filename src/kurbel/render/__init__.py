"""From a neutral report to text: the page of the book, one line per angle, CSV, JSON, Markdown, HTML and LaTeX."""

from dataclasses import dataclass

from kurbel.render.text import Charset

FORMATS = ("table", "csv", "json", "markdown", "html", "latex")
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
