"""HTML: a page of its own for one report, and the tables that longer pages and notebooks are made of."""

from collections.abc import Collection, Iterable, Iterator, Sequence
from html import escape
from itertools import chain, repeat
from typing import NamedTuple

from kurbel.render import Look
from kurbel.render.document import ON_PAPER, Table, document, key_value_table
from kurbel.render.sheet import MARK, Row
from kurbel.render.text import measures
from kurbel.report.tables import KeyValue, Report

INK, PAPER, FAINT, RULE, SHADE = (
    ("#1a1a1a", "#e8e8e8"),
    ("#ffffff", "#15181b"),
    ("#555555", "#adadad"),
    ("#c4c4c4", "#41474d"),
    ("#f3f4f5", "#1f2428"),
)
GOOD, BAD, LINK = ("#1d6b34", "#7fd49a"), ("#a31515", "#ff9d94"), ("#0b5394", "#8cc4f5")
"""Each in light and in dark, of a contrast of 4.5 to the paper and to the shade."""


def html(report: Report, look: Look) -> Iterator[str]:
    """Yield the report as a page of its own."""
    yield from page(look.charset.text(report.title), chain(("<main>\n",), tables(report, look, 1), ("</main>\n",)))


def page(title: str, body: Iterable[str], more_style: str = "") -> Iterator[str]:
    """Yield a self-contained page: no script, nothing from elsewhere, and the browser is told so."""
    yield (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; "
        'img-src data:">\n'
        f'<meta name="color-scheme" content="light dark">\n<title>{escape(title)}</title>\n'
        f"<style>\n{style()}{more_style}</style>\n</head>\n<body>\n"
    )
    yield from body
    yield "</body>\n</html>\n"


def style() -> str:
    """Return the style sheet of pages: light, dark, and print."""
    names = {"ink": INK, "paper": PAPER, "faint": FAINT, "rule": RULE, "shade": SHADE}
    names |= {"good": GOOD, "bad": BAD, "link": LINK}
    light, dark = (";".join(f"--{name}:{colours[mode]}" for name, colours in names.items()) for mode in (0, 1))
    return (
        f":root{{{light}}}\n@media screen and (prefers-color-scheme:dark){{:root{{{dark}}}}}\n"
        "body{margin:0;background:var(--paper);color:var(--ink);"
        'font:15px/1.45 system-ui,"DejaVu Sans",sans-serif}\n'
        "main{max-width:60rem;margin:0 auto;padding:1rem;overflow-wrap:anywhere}\n"
        "h1{font-size:1.5rem}h2{font-size:1.25rem;border-bottom:1px solid var(--rule)}h3{font-size:1.05rem}"
        "h4{font-size:1rem;margin-bottom:.3rem}a{color:var(--link)}\n"
        ".wide{overflow-x:auto;margin:.6rem 0}.wide:focus-visible{outline:2px solid var(--link)}\n"
        "table{border-collapse:collapse;font-variant-numeric:tabular-nums}"
        "caption{text-align:left;font-weight:600;padding:.3rem 0}\n"
        "th,td{padding:.12rem .5rem;text-align:left;vertical-align:top;overflow-wrap:normal}"
        "td.r,th.r{text-align:right}td.r,tbody th.r,thead small,.n{white-space:nowrap}\n"
        "thead th{border-top:2px solid var(--ink);border-bottom:1px solid var(--ink);vertical-align:bottom}"
        "tbody tr:last-child>*{border-bottom:2px solid var(--ink)}tbody th{font-weight:400}\n"
        "@media screen and (max-width:40rem){.wide td:not(.r):last-child{min-width:12rem}}\n"
        "tbody tr:nth-child(even){background:var(--shade)}small{color:var(--faint)}"
        ".good{color:var(--good)}.bad{color:var(--bad);font-weight:600}\n"
        "@page{margin:14mm}@media print{body{font-size:9pt}main{max-width:none;padding:0}"
        ".wide{overflow:visible}table{font-size:7.5pt}th,td{padding:.05rem .3rem}"
        "tr,figure,h2,h3,h4,caption{break-inside:avoid}h2,h3,h4,caption{break-after:avoid}"
        "thead{display:table-header-group}}\n"
    )


def tables(report: Report, look: Look, level: int = 2) -> Iterator[str]:
    """Yield title, tables, key values and notes of a report, under a heading of this level."""
    return document(report, look, _Html(look, level))


class _Html(NamedTuple):
    """Writes what stands in the body of a page; level: of the heading of the report."""

    look: Look
    level: int
    across: int | None = ON_PAPER

    def title(self, text: str) -> Iterator[str]:
        yield f"<h{self.level}>{escape(text)}</h{self.level}>\n"

    def paragraph(self, text: str) -> Iterator[str]:
        yield f"<p>{_prose(text)}</p>\n"

    def table(self, table: Table) -> Iterator[str]:
        return grid(table)

    def key_values(self, title: str, found: Collection[KeyValue]) -> Iterator[str]:
        return key_values(title, found, self.look)

    def items(self, title: str, lines: Sequence[str]) -> Iterator[str]:
        yield item_list(title, lines, self.level + 1)


def grid(table: Table, verdicts: Sequence[str] = ()) -> Iterator[str]:
    """Yield a table row by row; verdicts: a class of each row, `good` or `bad`, where they have one."""
    numbers = [k for k, column in enumerate(table.columns) if not column.words]
    classes = (f' class="{one}"' for one in verdicts) if verdicts else repeat("")
    return _scrolled(table, (f"<tr{own}>{_cells(row, table.of_row, numbers)}" for own, row in zip(classes, table.rows)))


def key_values(title: str, found: Collection[KeyValue], look: Look) -> Iterator[str]:
    """Yield a table of key values: symbol, value, unit, where it stands, what it is."""
    table = key_value_table(title, found, look)
    # a list of values may be folded
    numbers = ((3,) if isinstance(one.value, tuple) and one.value else (1, 3) for one in found)
    return _scrolled(table, (f"<tr>{_cells(row, 1, right)}" for row, right in zip(table.rows, numbers)))


def _scrolled(table: Table, rows: Iterable[str]) -> Iterator[str]:
    """Yield a table that a narrow window scrolls: heads of columns with their units, and these rows."""
    said = f"<caption>{escape(table.caption)}</caption>" if table.caption else ""
    label = escape(table.caption or "values over the crank angle", quote=True)
    yield f'<div class="wide" tabindex="0" role="region" aria-label="{label}"><table>{said}\n'
    yield f"<thead><tr>{''.join(map(_head, table.columns))}</tr></thead>\n<tbody>\n"
    yield from (f"{row}</tr>\n" for row in rows)
    yield "</tbody></table></div>\n"


_RIGHT = ' class="r"'


def _head(column: Row) -> str:
    unit = f"<br><small>{escape(column.unit)}</small>" if column.unit else ""
    return f'<th scope="col"{"" if column.words else _RIGHT}>{escape(column.symbol)}{unit}</th>'


def _cells(row: Sequence[str], of_row: int, numbers: Collection[int]) -> str:
    """Return the cells of a row; of_row: how many are its heads; numbers: which are numbers."""
    cells = []
    for k, text in enumerate(row):
        text = text.strip()
        right = _RIGHT if k in numbers else ""
        shown = f"<b>{escape(text[:-1])}</b>" if text.endswith(MARK) else escape(text) if right else _prose(text)
        if k < of_row:
            shown = shown if right else shown.replace(".", ".<wbr>")  # long keys fold
            cells.append(f'<th scope="row"{right}>{shown}</th>')
        else:
            cells.append(f"<td{right}>{shown}</td>")
    return "".join(cells)


def _prose(text: str) -> str:
    """Return a text of which no unit leaves its number."""
    return measures().sub(r'<span class="n">\g<0></span>', escape(text))


def item_list(title: str, lines: Iterable[str], level: int) -> str:
    """Return a list of sentences under its title, a heading of this level."""
    items = "".join(f"<li>{_prose(one)}</li>\n" for one in lines)
    return f"<h{level}>{escape(title)}</h{level}>\n<ul>\n{items}</ul>\n"
