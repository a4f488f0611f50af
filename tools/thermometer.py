"""How the source reads: a report, never a gate. python tools/thermometer.py [FOLDER]

Prints each measure with the figure that the project aims at. Code lines leave out comments, docstrings, imports and blank lines.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

AIMS = {
    "characters a code line": 36.0,
    "comprehensions per 100 code lines": 3.5,
    "nested comprehensions": 12.0,
    "conditional expressions per 100 code lines": 2.5,
    "assignments to tuples, %": 9.0,
    "lines of more than 100 columns, %": 1.0,
    "pronouns as names": 300.0,
    "bodies of one line, %": 24.0,
}
PRONOUNS = frozenset(
    [
        "one",
        "ones",
        "found",
        "own",
        "each",
        "every",
        "given",
        "known",
        "whole",
        "place",
        "places",
        "these",
        "those",
        "both",
        "some",
    ]
)
WIDTH = 100
FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)
COMPREHENSIONS = (ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp)


class Chapter(NamedTuple):
    """A file of the source: its text and its syntax tree."""

    text: str
    tree: ast.Module

    @property
    def nodes(self) -> Iterator[ast.AST]:
        return ast.walk(self.tree)


def without_docstring(body: list[ast.stmt]) -> list[ast.stmt]:
    """Return the statements of a body that are no docstring."""
    first = body[0]
    is_docstring = isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant)
    return body[1:] if is_docstring else body


def code_lines(chapter: Chapter) -> list[str]:
    """Return the lines that are code, without their indentation."""
    left_out: set[int] = set()
    for node in chapter.nodes:
        is_import = isinstance(node, (ast.Import, ast.ImportFrom))
        is_docstring = isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
        if is_import or is_docstring:
            left_out.update(range(node.lineno, (node.end_lineno or node.lineno) + 1))
    lines = []
    for number, line in enumerate(chapter.text.splitlines(), 1):
        code = line.strip()
        if code and not code.startswith("#") and number not in left_out:
            lines.append(code)
    return lines


def names(node: ast.AST) -> list[str]:
    """Return the names that a node uses: of a variable, a parameter, an attribute."""
    if isinstance(node, ast.Name):
        return [node.id]
    if isinstance(node, ast.arg):
        return [node.arg]
    if isinstance(node, ast.Attribute):
        return [node.attr]
    return []


def is_nested(comprehension: ast.AST) -> bool:
    """Return whether another comprehension is inside this one."""
    return any(
        isinstance(node, COMPREHENSIONS)
        for node in ast.walk(comprehension)
        if node is not comprehension
    )


def is_one_line(function: ast.AST) -> bool:
    """Return whether the body of a function, without its docstring, has one line."""
    if not isinstance(function, FUNCTIONS):
        return False
    statements = without_docstring(function.body)
    if not statements:
        return True
    last_line = statements[-1].end_lineno
    return last_line == statements[0].lineno


def measures(chapters: list[Chapter]) -> dict[str, float]:
    """Return the figures of a list of files by the names in AIMS."""
    lines = [line for chapter in chapters for line in code_lines(chapter)]
    nodes = [node for chapter in chapters for node in chapter.nodes]
    all_lines = [line for chapter in chapters for line in chapter.text.splitlines()]
    comprehensions = [node for node in nodes if isinstance(node, COMPREHENSIONS)]
    conditionals = [node for node in nodes if isinstance(node, ast.IfExp)]
    assignments = [node for node in nodes if isinstance(node, ast.Assign)]
    to_tuples = [node for node in assignments if isinstance(node.targets[0], ast.Tuple)]
    functions = [node for node in nodes if isinstance(node, FUNCTIONS)]
    wide = [line for line in all_lines if len(line) > WIDTH]
    pronouns = [name for node in nodes for name in names(node) if name.strip("_") in PRONOUNS]
    return {
        "characters a code line": sum(map(len, lines)) / len(lines),
        "comprehensions per 100 code lines": 100 * len(comprehensions) / len(lines),
        "nested comprehensions": sum(map(is_nested, comprehensions)),
        "conditional expressions per 100 code lines": 100 * len(conditionals) / len(lines),
        "assignments to tuples, %": 100 * len(to_tuples) / len(assignments),
        "lines of more than 100 columns, %": 100 * len(wide) / len(all_lines),
        "pronouns as names": len(pronouns),
        "bodies of one line, %": 100 * sum(map(is_one_line, functions)) / len(functions),
    }


def main() -> None:
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "src/kurbel")
    texts = [file.read_text(encoding="utf-8") for file in sorted(folder.rglob("*.py"))]
    chapters = [Chapter(text, ast.parse(text)) for text in texts]
    for name, figure in measures(chapters).items():
        remark = "above the aim" if figure > AIMS[name] else ""
        print(f"{name:45} {figure:8,.1f}  aim {AIMS[name]:6,.1f}  {remark}".rstrip())


if __name__ == "__main__":
    main()
