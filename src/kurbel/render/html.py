"""A page of HTML for one report, self-contained: no script, nothing from elsewhere; light, dark and print."""

from collections.abc import Iterable, Iterator
from html import escape

from kurbel.render import Look
from kurbel.render.markup import Html, document
from kurbel.render.style import page_css
from kurbel.report.tables import Report


def html(report: Report, look: Look) -> Iterator[str]:
    """Yield the report as a page of its own."""
    yield from page(look.text(report.title), document(report, look, Html()), page_css())


def page(title: str, main: Iterable[str], style: str) -> Iterator[str]:
    """Yield a self-contained page: no script, nothing from elsewhere, which the browser enforces."""
    yield (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; "
        'img-src data:">\n'
        f'<meta name="color-scheme" content="light dark">\n<title>{escape(title)}</title>\n'
        f"<style>\n{style}</style>\n</head>\n<body>\n<main>\n"
    )
    yield from main
    yield "</main>\n</body>\n</html>\n"
