"""The gallery shows every picture as it is drawn now."""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree

import pytest

import gallery  # docs/gallery.py
from kurbel.mechanisms import MECHANISMS
from kurbel.report.pictures import PICTURES

FOLDER = Path(__file__).parent.parent.parent / "docs"


def test_the_page_is_current_and_complete() -> None:
    assert (FOLDER / "gallery.md").read_text(encoding="utf-8") == gallery.page()
    assert {id for id, _ in gallery.shown()} == {one.id for one in PICTURES}
    assert sum(id == "mechanism" for id, _ in gallery.shown()) == len(MECHANISMS)


def test_it_shows_each_file_and_each_file_is_shown() -> None:
    named = re.findall(r"\(gallery/([^)]*)\)", gallery.page())
    assert sorted(named) == sorted(path.name for path in (FOLDER / "gallery").iterdir())
    assert all((FOLDER / "gallery" / name).stat().st_size <= 60_000 for name in named)


def words_in(svg: str) -> list[str | None]:
    return [one.text for one in ElementTree.fromstring(svg).iter() if one.tag.endswith(("text", "title"))]


@pytest.mark.slow
@pytest.mark.parametrize(("id", "machine"), gallery.shown())
def test_every_file_says_what_is_drawn_now(id: str, machine: str) -> None:
    kept = (FOLDER / "gallery" / f"{machine}-{id}.svg").read_text(encoding="utf-8")
    assert words_in(kept) == words_in(gallery.svg_of(id, machine))
