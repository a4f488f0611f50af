"""What a start of kurbel does not pay for."""

from __future__ import annotations

import ast
from pathlib import Path

from representative import law_of_each

HOUSE = Path(__file__).parent.parent / "src" / "kurbel"
DECLARING = [path for path in sorted(HOUSE.rglob("*.py")) if "(NamedTuple)" in path.read_text(encoding="utf-8")]


@law_of_each(DECLARING)
def test_where_named_tuples_are_declared_annotations_are_taken_as_they_stand(module: Path) -> None:
    """NamedTuple compiles each postponed one at every start."""
    imported = (node for node in ast.parse(module.read_text(encoding="utf-8")).body if isinstance(node, ast.ImportFrom))
    assert "__future__" not in [node.module for node in imported]
