"""The pages show every picture as it is drawn now; `pytest --rewrite` on this file draws them anew."""

import re
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree

import pytest

import gallery  # tools/gallery.py
from kurbel.mechanisms.kinds import MECHANISMS
from kurbel.pictures.pictures import PICTURES

ROOT = Path(__file__).parent.parent.parent
DOCS = ROOT / "docs"


def test_the_page_is_current_and_complete(kept: Callable[[Path, str], str]) -> None:
    assert kept(DOCS / "gallery.md", gallery.page()) == gallery.page()
    assert {id for id, _ in gallery.shown()} == {picture.id for picture in PICTURES}
    assert sum(id == "mechanism" for id, _ in gallery.shown()) == len(MECHANISMS)


def test_each_file_is_shown_and_small() -> None:
    files = sorted((DOCS / "gallery").iterdir())
    shown = {name for page in ("gallery", "machines") for name in pictures_on(DOCS / f"{page}.md")}
    assert shown == {path.relative_to(DOCS).as_posix() for path in files}
    assert all(path.stat().st_size <= 60_000 for path in files)
    assert sum(path.stat().st_size for path in files) <= 1_000_000


def pictures_on(page: Path) -> list[str]:
    return re.findall(r"!\[[^]]+\]\((gallery/[^)]*)\)", page.read_text(encoding="utf-8"))


def words_in(svg: str) -> list[str]:
    results = (
        one for one in ElementTree.fromstring(svg).iter() if one.tag.endswith(("text", "title"))
    )
    return ["".join(result.itertext()) for result in results]


@pytest.mark.slow
@pytest.mark.parametrize("name", gallery.every_file())
def test_every_file_shows_what_is_drawn_now(name: str, kept: Callable[[Path, str], str]) -> None:
    drawn = gallery.svg_of(*gallery.every_file()[name])
    assert words_in(kept(DOCS / name, drawn)) == words_in(drawn)
