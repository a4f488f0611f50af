"""`pytest --rewrite` puts what is printed now where it is kept; without it a kept text stays."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest


@pytest.mark.parametrize(("switch", "text"), [(False, "old\n"), (True, "new\n")])
def test_a_kept_text_is_rewritten_by_the_switch(
    switch: bool,
    text: str,
    tmp_path: Path,
    kept: Callable[[Path, str], str],
    pytestconfig: pytest.Config,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    page = tmp_path / "page.txt"
    page.write_text("old\n", encoding="utf-8")
    monkeypatch.setattr(pytestconfig.option, "rewrite", switch)
    assert kept(page, "new\n") == text
    assert page.read_text(encoding="utf-8") == text
