"""A page of HTML for one report, self-contained: no script, nothing from elsewhere; light, dark and print."""

from collections.abc import Iterable, Iterator
from html import escape

from kurbel.render import Look
from kurbel.render.markup import Html, document
from kurbel.report.tables import Report

INK, PAPER, FAINT, RULE, SHADE = (
    ("#1a1a1a", "#e8e8e8"),
    ("#ffffff", "#15181b"),
    ("#555555", "#adadad"),
    ("#c4c4c4", "#41474d"),
    ("#f3f4f5", "#1f2428"),
)
GOOD, BAD, LINK = ("#1d6b34", "#7fd49a"), ("#a31515", "#ff9d94"), ("#0b5394", "#8cc4f5")
WARN, WARNED = ("#d9a514", "#b98a10"), ("#fdf3d8", "#33291a")
"""Each in light and in dark, of a contrast of 4.5 to the paper and to the shade."""


def html(report: Report, look: Look) -> Iterator[str]:
    """Yield the report as a page of its own."""
    yield from page(look.text(report.title), document(report, look, Html()))


def page(title: str, main: Iterable[str], more_style: str = "") -> Iterator[str]:
    """Yield a self-contained page: no script, nothing from elsewhere, which the browser enforces."""
    yield (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; "
        'img-src data:">\n'
        f'<meta name="color-scheme" content="light dark">\n<title>{escape(title)}</title>\n'
        f"<style>\n{style()}{more_style}</style>\n</head>\n<body>\n<main>\n"
    )
    yield from main
    yield "</main>\n</body>\n</html>\n"


def style() -> str:
    """Return the style sheet of pages: light, dark, and print."""
    names = {"ink": INK, "paper": PAPER, "faint": FAINT, "rule": RULE, "shade": SHADE}
    names |= {"good": GOOD, "bad": BAD, "link": LINK, "warn": WARN, "warned": WARNED}
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
        "thead th{border-bottom:1px solid var(--ink);vertical-align:bottom}"
        "tbody tr>*{border-bottom:1px solid var(--rule)}tbody th{font-weight:400}td.l{max-width:14rem}\n"
        "@media screen and (max-width:40rem){.wide td:not(.r):last-child{min-width:12rem}}\n"
        "small{color:var(--faint)}"
        ".good{color:var(--good)}.bad{color:var(--bad);font-weight:600}\n"
        "@page{margin:14mm}@media print{body{font-size:9pt}main{max-width:none;padding:0}"
        ".wide{overflow:visible}table{font-size:7.5pt}th,td{padding:.05rem .3rem}"
        "tr,figure,h2,h3,h4,caption{break-inside:avoid}h2,h3,h4,caption{break-after:avoid}"
        "thead{display:table-header-group}}\n"
    )
