"""Hooks of the site: formulas become MathML, so that a page needs no script for them; shipped machines are files of the site."""

from __future__ import annotations

import html
import re
from pathlib import Path
from typing import Any

from latex2mathml.converter import convert
from mkdocs.structure.files import File, Files

_CONFIGS = Path(__file__).parent.parent / "configs"
_FORMULA = re.compile(
    r'<(span|div) class="arithmatex">(?:\\\((.*?)\\\)|\\\[(.*?)\\\])</\1>', re.DOTALL
)


def on_files(files: Files, config: Any) -> Files:
    """Add the machine files, which a link of a page may lead to."""
    for path in sorted(_CONFIGS.iterdir()):
        file = File.generated(config, f"configs/{path.name}", abs_src_path=str(path))
        files.append(file)
    return files


def on_page_markdown(markdown: str, **_: Any) -> str:
    """Return the page with its links to machine files as they are on the site."""
    return markdown.replace("](../configs/", "](configs/")


def on_page_content(content: str, **_: Any) -> str:
    """Return the page with every formula in MathML."""
    return _FORMULA.sub(_mathml, content)


def _mathml(found: re.Match[str]) -> str:
    line, block = found[2], found[3]
    return convert(html.unescape((line or block).strip()), display="inline" if line else "block")
