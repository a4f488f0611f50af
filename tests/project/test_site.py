"""The site as its readers have it: built strictly, complete, asking for nothing elsewhere, readable on a telephone."""

import html
import json
import re
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import click
import pytest

from browser import CHROMIUM, dumped, served
from kurbel.cli import COMMANDS, kurbel
from kurbel.declared.units import kinds, listed_units
from kurbel.quantities import every_quantity
from kurbel.report.keys import every_place

ROOT = Path(__file__).parents[2]
WIDTHS = (360, 1400)
HARNESS = Path(__file__).with_name("site_harness.html").read_text("utf-8")

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(find_spec("material") is None, reason="the site needs the extra 'docs'"),
]


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Build the site; --strict makes an error of every link and anchor that leads nowhere."""
    folder = tmp_path_factory.mktemp("site")
    built = [
        sys.executable,
        "-m",
        "mkdocs",
        "build",
        "--strict",
        "--quiet",
        "--site-dir",
        str(folder),
    ]
    subprocess.run(built, cwd=ROOT, check=True)
    return folder


def words(site: Path, page: str) -> str:
    return html.unescape(re.sub(r"<[^>]+>", " ", (site / page).read_text(encoding="utf-8")))


def test_every_key_unit_column_key_value_and_option_is_on_the_site(site: Path) -> None:
    quantities = every_quantity()
    units = [unit for kind in kinds() for unit in listed_units(kind)]
    options = [
        option
        for name in COMMANDS
        for param in kurbel.get_command(click.Context(kurbel), name).params
        for option in param.opts
        if isinstance(param, click.Option)
    ]
    there = {
        "reference/keys.html": [path.rpartition(".")[2] for path in every_place()],
        "reference/units.html": units,
        "reference/columns.html": [
            column.id for column in quantities.all_columns if column.commands
        ],
        "reference/key-values.html": [key_value.id for key_value in quantities.all_key_values],
        "reference/commands.html": [*COMMANDS, *options],
    }
    missing = {
        page: [name for name in names if name not in words(site, page)]
        for page, names in there.items()
    }
    assert {page: names for page, names in missing.items() if names} == {}


@pytest.mark.skipif(CHROMIUM is None, reason="needs Chromium")
def test_pages_fit_a_telephone(site: Path, tmp_path: Path) -> None:
    pages = [
        path.relative_to(site).as_posix()
        for path in site.rglob("*.html")
        if path.name != "404.html"
    ]
    text = HARNESS.replace("PAGES", json.dumps(pages)).replace("WIDTHS", json.dumps(WIDTHS), 1)
    (site / "harness.html").write_text(text, encoding="utf-8")
    with served(site) as address:
        dom, _ = dumped(f"{address}/harness.html", tmp_path)
    result = re.search(r'<pre id="found">(.*?)</pre>', dom, re.DOTALL)
    assert result
    assert json.loads(html.unescape(result[1])) == []


def test_no_page_loads_anything_from_elsewhere(site: Path) -> None:
    loading = re.compile(r'<(?:script|img|iframe|link)\b[^>]*(?:src|href)="?(?:https?:)?//[^>]*>')
    loaded = {
        page.relative_to(site).as_posix(): loading.findall(page.read_text(encoding="utf-8"))
        for page in site.rglob("*.html")
    }
    assert {page: tags for page, tags in loaded.items() if tags} == {}


@pytest.mark.skipif(CHROMIUM is None, reason="needs Chromium")
def test_a_page_has_no_message_and_needs_nothing_from_elsewhere(site: Path, tmp_path: Path) -> None:
    with served(site) as address:
        dom, console = dumped(f"{address}/theory.html", tmp_path)
    assert "</html>" in dom
    assert console == []


@pytest.mark.skipif(CHROMIUM is None, reason="needs Chromium")
def test_search_works_without_a_server(site: Path, tmp_path: Path) -> None:
    dom, console = dumped(f"{(site / 'index.html').as_uri()}?q=Druckwechsel", tmp_path)
    assert console == []
    assert re.search(r'<a[^>]*class="md-search-result__link"', dom)
