"""The page of the notebook: its cells, run as a script, with what each shows.

`pytest --rewrite tests/project/test_documents.py` writes it from docs/notebook.ipynb, which has no outputs of its own.
"""

from __future__ import annotations

import ast
import json
import os
from collections.abc import Iterator
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path
from typing import Any

_NOTEBOOK = Path(__file__).parent.parent / "docs" / "notebook.ipynb"


def page() -> str:
    """Return the page. Raises what a cell raises."""
    before = Path.cwd()
    os.chdir(_NOTEBOOK.parent)  # as Jupyter does; the cells read ../configs/
    try:
        return "\n\n".join(_blocks()) + "\n"
    finally:
        os.chdir(before)


def _blocks() -> Iterator[str]:
    names: dict[str, Any] = {}
    for cell in json.loads(_NOTEBOOK.read_text(encoding="utf-8"))["cells"]:
        text = "".join(cell["source"])
        if cell["cell_type"] == "markdown":
            yield text
            continue
        yield f"```python\n{text}\n```"
        printed, shown = _run(text, names)
        if printed:
            yield f"```text\n{printed}```"
        if shown is not None:
            yield _output(shown, cell["metadata"].get("picture", ""))


def _run(text: str, names: dict[str, Any]) -> tuple[str, Any]:
    """Run a cell; return what it prints, and the value of its last line where that is an expression."""
    code = ast.parse(text)
    end = code.body[-1]
    last = ast.Expression(end.value) if isinstance(end, ast.Expr) else None
    code.body = code.body[:-1] if last else code.body
    with redirect_stdout(StringIO()) as printed:
        exec(compile(code, "cell", "exec"), names)
        shown = eval(compile(last, "cell", "eval"), names) if last else None
    return printed.getvalue(), shown


def _output(shown: Any, picture: str) -> str:
    """Return what a notebook shows of a value; a picture is that of the gallery, which has it as a file."""
    if picture:
        assert shown._repr_svg_().startswith("<svg")
        return f"![The picture that the cell shows]({picture})"
    if hasattr(shown, "_repr_html_"):
        return str(shown._repr_html_()).strip()
    return f"```text\n{shown!r}\n```"
