"""What the text of the code and of the docs points to is there: files of the repository, and names of the package."""

from __future__ import annotations

import ast
import pkgutil
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
CODE = [file for folder in ("src", "tests", "docs", "benchmarks") for file in (ROOT / folder).rglob("*.py")]
PAGES = [*(ROOT / "docs").rglob("*.md"), *ROOT.glob("*.md")]
FILE = re.compile(r"(?<![\w/.])[\w./-]*\w\.(?:md|py|yaml|svg|csv|json|toml|txt|expected)\b")
NAME = re.compile(r"\bkurbel(?:\.[A-Za-z_]\w*)+")
SHOWN = re.compile(r'(?:title="|-o )([\w./-]+)')
"""Files that a page shows, or that its commands write."""
READERS = {
    "engine.yaml",
    "MACHINE.yaml",
    "m.yaml",
    "machines/mill-engine.yaml",
    "run7.csv",
    "effort.csv",
    "indicator.csv",
}
READERS |= {"forces.md", "FILE.svg", "kurbel.schema.json"}
READERS |= {"k.csv", *(f"part-{number}.csv" for number in (1, 2, 3, 4))}
READERS |= {"run8.csv", "motored.csv", "many.yaml", "diagram.csv", "p.csv", "before.yaml", "after.yaml", "effort.svg"}
ELSEWHERE = READERS | {"examples/ICE_example.py", "kurbel.mechanisms.harmonic_cam", "docs/symbols.md"}
"""Files of the reader's own, one of opentorsion, the mechanism that the pages add as an example, and a page of old."""


def docstrings(file: Path) -> Iterator[str]:
    """Yield the text of a module that is there to be read: docstrings, also those of constants."""
    statements: list[ast.AST] = [ast.parse(file.read_text(encoding="utf-8"))]
    while statements:  # a walk through every expression would take most of the time
        node = statements.pop()
        statements += getattr(node, "body", []) if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef)) else []
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            yield node.value.value


def is_there(word: str, beside: Path) -> bool:
    return word.removeprefix("./") in ELSEWHERE or any(
        (folder / word).is_file() for folder in (ROOT, beside.parent, ROOT / "src" / "kurbel")
    )


def can_be_had(name: str) -> bool:
    """Whether a dotted name is a module of the package, or something in one."""
    try:
        pkgutil.resolve_name(name)
    except (ImportError, AttributeError):
        return name in ELSEWHERE
    return True


def astray(text: str, beside: Path) -> list[str]:
    """Return the files and names that a text speaks of and that are not there."""
    shown = SHOWN.findall(text)
    files = [word for word in FILE.findall(text) if word not in shown and not is_there(word, beside)]
    return files + [name for name in NAME.findall(text) if not can_be_had(name)]


@pytest.mark.slow
def test_docstrings_and_pages_point_to_what_is_there() -> None:
    texts = {file: "\n".join(docstrings(file)) for file in CODE}
    texts |= {page: page.read_text(encoding="utf-8") for page in PAGES}
    found = {str(file.relative_to(ROOT)): astray(text, file) for file, text in texts.items()}
    assert {file: words for file, words in found.items() if words} == {}


def test_what_is_not_there_is_found() -> None:
    text = "see formulas.md 3.7, docs/limits.md, kurbel.solver.case.Case and kurbel.solver.driver"
    assert astray(text, ROOT / "README.md") == ["formulas.md", "kurbel.solver.driver"]
