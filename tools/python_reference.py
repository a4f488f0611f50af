"""The reference of kurbel in Python: what `kurbel` exports, and what results have, from signatures and docstrings.

`pytest --rewrite tests/project/test_documents.py` writes it.
"""

from __future__ import annotations

import inspect
import re
from functools import cached_property
from typing import Any

import kurbel
from kurbel.solver.case import Case
from kurbel.solver.figures import Figure
from kurbel.solver.forces import CylinderForces

_HEAD = """# Python reference

All that `kurbel` exports, and what its results have. Values are in SI, as floats and arrays; crank angles are in
degrees, speeds in revolutions per second. Ids are those of [columns](columns.md) and [key values](key-values.md).
[From Python](../python.md) shows them in use."""

_FUNCTIONS = ("load", "loads", "solve", "sweep", "find", "draw")
_OF_A_CYLINDER = (
    "motion",
    "at",
    "columns",
    "angles_where",
    "extremes_of",
    "sampled",
    "pieces",
    "pistons",
    "friction_works",
    "key_values",
)
"""What a cylinder has beside its key values, in the order of use."""


def page() -> str:
    """Return the page."""
    classes = [name for name in kurbel.__all__ if name not in _FUNCTIONS]
    blocks = [
        _HEAD,
        "## Functions",
        *(_entry(name) for name in _FUNCTIONS),
        "## Results: `kurbel.Case`",
        'What `solve` returns. `case["T_max"]` is a key value by id or printed symbol, of the only cylinder or of the '
        "whole machine. At the end of a notebook's cell a case is shown as tables.",
        _members(Case, [name for name in vars(Case) if not name.startswith("_")]),
        "## Results of a cylinder: `case.cylinders[0]`",
        "Every key value of `kurbel motion` and `kurbel forces` is an attribute by its id, an extreme with `.value` "
        "and `.degrees`, and is found by id or symbol in brackets. The other results (`case.flywheel`, `case.balance`, "
        "…) have brackets and `key_values()`, too.",
        _members(CylinderForces, _OF_A_CYLINDER),
        '## A key value: `case["T_max"]`',
        _prose(inspect.getdoc(Figure) or ""),
        "`.value`, `.unit`, `.degrees` and `.quantity` (with `.id`, `.symbol`, `.text`); `str()` prints metric units.",
        "## Classes",
        *(_entry(name) for name in classes if name != "Case"),
    ]
    return "\n\n".join(blocks) + "\n"


def _entry(name: str) -> str:
    """Return the heading, the signature and the docstring of something that kurbel exports."""
    thing: Any = getattr(kurbel, name)
    return f"### `kurbel.{name}`\n\n{_signature(name, thing)}{_prose(inspect.getdoc(thing) or '')}"


def _signature(name: str, thing: Any) -> str:
    """Return the call, one argument a line where it is long; '' where nothing is called."""
    try:
        found = inspect.signature(thing)
    except ValueError:
        return ""
    arguments = [_argument(parameter) for parameter in found.parameters.values()]
    if not arguments:
        return ""
    returned = found.return_annotation
    end = (
        ""
        if returned in (inspect.Signature.empty, None, "None")
        else f" -> {_short(inspect.formatannotation(returned))}"
    )
    line = f"{name}({', '.join(arguments)}){end}"
    if len(line) > 76:
        line = f"{name}(\n" + "".join(f"    {argument},\n" for argument in arguments) + f"){end}"
    return f"```text\n{line}\n```\n\n"


def _argument(given: inspect.Parameter) -> str:
    star = "*" if given.kind is inspect.Parameter.VAR_POSITIONAL else ""
    default = "" if given.default is inspect.Parameter.empty else f" = {given.default!r}"
    return f"{star}{given.name}: {_short(inspect.formatannotation(given.annotation))}{default}"


def _short(annotation: str) -> str:
    """Return an annotation without quotes and modules."""
    return re.sub(r"\b(?:[a-z_]+\.)+(?=[A-Z])", "", annotation.replace("'", ""))


def _prose(text: str) -> str:
    """Return a docstring as Markdown, without its examples, which need names of their module."""
    return "\n\n".join(_escaped(part) for part in text.split("\n\n") if not part.startswith(">>>"))


def _escaped(text: str) -> str:
    return re.sub(r"(?<!`)<(?!`)", "&lt;", text)


def _members(of: type, names: Any) -> str:
    """Return a table of attributes and methods, with the first paragraph of each docstring."""
    rows = (
        f"| `{_call(name, inspect.getattr_static(of, name))}` | {_first(of, name)} |"
        for name in names
    )
    return "\n".join(["| | |", "| --- | --- |", *rows])


def _call(name: str, member: Any) -> str:
    if not inspect.isfunction(member):
        return f".{name}"
    parameters = [
        parameter
        for parameter in inspect.signature(member).parameters.values()
        if parameter.name != "self"
    ]
    arguments = [
        ("*" if parameter.kind is inspect.Parameter.VAR_POSITIONAL else "") + parameter.name
        for parameter in parameters
    ]
    return f".{name}({', '.join(arguments)})"


def _first(of: type, name: str) -> str:
    member: Any = inspect.getattr_static(of, name)
    text = inspect.getdoc(member.func if isinstance(member, cached_property) else member) or ""
    return _escaped(text.split("\n\n")[0].replace("\n", " ")).replace("|", "\\|")
