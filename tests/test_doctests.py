"""Every example in a docstring gives what stands below it.

Not `--doctest-modules`, which looks through every object of every module in every worker: a third of the collection.
"""

from __future__ import annotations

import doctest
from importlib import import_module
from pathlib import Path

from representative import law_of_each

SOURCE = Path(__file__).parent.parent / "src"
MODULES = [
    ".".join(file.relative_to(SOURCE).with_suffix("").parts).removesuffix(".__init__")
    for file in sorted(SOURCE.rglob("*.py"))
    if ">>> " in file.read_text(encoding="utf-8")
]


@law_of_each(MODULES)
def test_examples_in_docstrings(module: str) -> None:
    found = doctest.testmod(import_module(module))
    assert found.attempted
    assert found.failed == 0
