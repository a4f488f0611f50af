"""HTML: a page of its own for one report, and the tables that longer pages and notebooks are made of."""

from collections.abc import Collection, Iterable, Iterator, Sequence
from html import escape
from itertools import chain, cycle, repeat
from typing import NamedTuple

from kurbel.render import Look
from kurbel.render.document import KEY_VALUE_HEADS, ON_PAPER, Table, document, key_value_cells
from kurbel.render.sheet import MARK
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
        "td.r,th.r{text-align:right}td.r,tbody th.r,thead small{white-space:nowrap}\n"
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
        yield f"<p>{escape(text)}</p>\n"

    def table(self, table: Table) -> Iterator[str]:
        numbers = range(table.names, len(table.heads))
        return grid(table.heads, table.rows, table.caption, table.of_row, numbers)

    def key_values(self, title: str, found: Iterable[KeyValue]) -> Iterator[str]:
        yield key_values(found, title, self.look)

    def items(self, title: str, lines: Sequence[str]) -> Iterator[str]:
        yield item_list(title, lines, self.level + 1)


def grid(
    heads: Sequence[tuple[str, str]],
    rows: Iterable[Sequence[str]],
    caption: str,
    of_row: int,
    numbers: Collection[int],
    verdicts: Sequence[str] = (),
) -> Iterator[str]:
    """Yield a table that a narrow window scrolls, row by row: heads of columns with their units, rows of texts.

    of_row: how many columns are the heads of their rows; numbers: which columns are numbers; verdicts: a class of each
    row, `good` or `bad`, where they have one.
    """
    said = f"<caption>{escape(caption)}</caption>" if caption else ""
    below = [f"<br><small>{escape(unit)}</small>" if unit else "" for _, unit in heads]
    over = "".join(
        f'<th scope="col"{_RIGHT if k in numbers else ""}>{escape(symbol)}{unit}</th>'
        for k, ((symbol, _), unit) in enumerate(zip(heads, below))
    )
    label = escape(caption or "values over the crank angle", quote=True)
    yield f'<div class="wide" tabindex="0" role="region" aria-label="{label}"><table>{said}\n'
    yield f"<thead><tr>{over}</tr></thead>\n<tbody>\n"
    classes = (f' class="{one}"' for one in verdicts) if verdicts else repeat("")
    for own, row in zip(classes, rows):
        yield f"<tr{own}>{''.join(_cells(row, of_row, numbers))}</tr>\n"
    yield "</tbody></table></div>\n"


_RIGHT = ' class="r"'


def _cells(row: Sequence[str], of_row: int, numbers: Collection[int]) -> Iterator[str]:
    for k, text in enumerate(row):
        text = text.strip()
        shown = f"<b>{escape(text[:-1])}</b>" if text.endswith(MARK) else escape(text)
        right = _RIGHT if k in numbers else ""
        if k < of_row:
            yield f'<th scope="row"{right}>{shown if right else shown.replace(".", ".<wbr>")}</th>'  # long keys fold
        else:
            yield f"<td{right}>{shown}</td>"


def item_list(title: str, lines: Iterable[str], level: int) -> str:
    """Return a list of sentences under its title, a heading of this level."""
    items = "".join(f"<li>{escape(one)}</li>\n" for one in lines)
    return f"<h{level}>{escape(title)}</h{level}>\n<ul>\n{items}</ul>\n"


def key_values(found: Iterable[KeyValue], caption: str, look: Look) -> str:
    """Return a table of key values: symbol, value, unit, where it stands, what it is."""
    rows = "".join(f"<tr>{_key_value(one, look)}</tr>\n" for one in found)
    over = "".join(f'<th scope="col"{right}>{head}</th>' for head, right in zip(KEY_VALUE_HEADS, cycle(("", _RIGHT))))
    return (
        f'<div class="wide" tabindex="0" role="region" aria-label="{escape(caption, quote=True)}"><table>'
        f"<caption>{escape(caption)}</caption>\n<thead><tr>{over}</tr></thead>\n<tbody>\n{rows}</tbody></table></div>\n"
    )


def _key_value(one: KeyValue, look: Look) -> str:
    symbol, number, unit, at, meaning = map(escape, key_value_cells(one, look))
    right = "" if isinstance(one.value, tuple) and one.value else _RIGHT  # a list may be folded
    return (
        f'<th scope="row">{symbol}</th><td{right}>{number}</td><td>{unit}</td><td{_RIGHT}>{at}</td><td>{meaning}</td>'
    )
