"""Pressures that name their zero, such as `7 bara` and `100 psig`: each must agree with the reference of its value.

Pressures of an indicator are gauge or absolute by its `pressures`, which may be left out where every one of them names
the vacuum; an ambient pressure is absolute; a limit of `p_max` is as the indicators are; others are differences. In the tree
`bara` is replaced by `bar`, so that no other code needs to handle zeros.
"""

import re
from collections.abc import Iterator
from typing import Any

from kurbel.declared.forms.figures import scoped
from kurbel.declared.numerals import WRITTEN, familiar
from kurbel.declared.reading import Node, Reading
from kurbel.declared.units import other_zero, unit_names, zero_and_unit
from kurbel.errors import Path
from kurbel.quantity import called

_REFERENCES = {
    "ambient": "absolute",
    "vapour_pressure": "absolute",
    "suction_pipe": "absolute",
    **dict.fromkeys(("offset", "mean_pressure", "drawn"), ""),
}
"""Keys whose pressures are not relative to the reference of the indicator: '' for differences of pressure."""
_BY_QUANTITY = ("limits", "expect")
"""Keys whose figures have the reference of the key value that they are for."""
_READ_ELSEWHERE = ("cases", "uncertainty")
"""Keys whose texts are read where they are used: in the place of other values, or as differences."""
_PRESSURE = re.compile(
    rf"({WRITTEN})(\s*)([^\s±+]+(?:\s*(?:abs|absolute|gauge|\([ag]\)|\(abs\)))?)"
)


def without_zeros(tree: dict[str, Node], reading: Reading) -> dict[str, Any]:
    """Return a tree without the names of zeros; one that does not agree with its reference is a fault."""
    mapping: dict[str, Any] = {}
    for key, node in tree.items():
        if key in _READ_ELSEWHERE:
            mapping[key] = node
        elif key in _BY_QUANTITY:
            mapping[key] = _figures_without_zeros(node, reading, key, references_of(tree))
        else:
            mapping[key] = _without_zeros(node, reading, (key,), _REFERENCES.get(key, ""))
    return mapping


def zero_of_key(tree: Node, path: Path) -> str:
    """Return the zero of a pressure at a path of a tree: `absolute`, `gauge`, or '' of a difference."""
    reference = ""
    for step in path:
        if isinstance(tree, dict):
            tree = tree.get(str(step), "")
        elif isinstance(tree, list) and isinstance(step, int) and step < len(tree):
            tree = tree[step]
        if step == "indicator" and isinstance(tree, dict):
            reference = _reference(tree)
        reference = _REFERENCES.get(str(step), reference)
    return reference


def _reference(indicator: dict[str, Node]) -> str:
    """Return what the pressures of an indicator count from: `absolute` or `gauge`."""
    written = indicator.get("pressures")
    if written is None and set(_zeros(indicator)) == {"absolute"}:
        return "absolute"
    return "absolute" if written == "absolute" else "gauge"


def references_of(tree: Node) -> set[str]:
    """Return what the pressures of all indicators of a file count from."""
    references: set[str] = set()
    items: list[Node] = []
    if isinstance(tree, dict):
        for key, node in tree.items():
            if key == "indicator" and isinstance(node, dict):
                references.add(_reference(node))
            elif key not in _READ_ELSEWHERE:
                items.append(node)
    elif isinstance(tree, list):
        items = tree
    for item in items:
        references |= references_of(item)
    return references


def _has_points(items: list[Node]) -> bool:
    """Return whether a list has points, which are bare numbers."""
    return bool(items) and isinstance(items[0], list)


def _without_zeros(node: Node, reading: Reading, path: Path, reference: str) -> Any:
    """Return a part of a tree without the names of zeros; reference: of the pressures in it."""
    if isinstance(node, dict):
        mapping: dict[str, Any] = {}
        if path[-1:] == ("indicator",):
            reference = _reference(node)
            if reference == "absolute":
                mapping["pressures"] = "absolute"
        for key, inner in node.items():
            reference_of_key = _REFERENCES.get(key, reference)
            mapping[key] = _without_zeros(inner, reading, (*path, key), reference_of_key)
        return mapping
    if isinstance(node, list):
        if _has_points(node):
            return node
        items = []
        for index, inner in enumerate(node):
            items.append(_without_zeros(inner, reading, (*path, index), reference))
        return items
    return _text_without_zero(node, reading, path, reference) if isinstance(node, str) else node


def _zeros(node: Node, key: str = "") -> Iterator[str]:
    """Yield the zero of every pressure that has one: `absolute`, `gauge`, or '' where its unit does not name it."""
    if isinstance(node, dict):
        for name, inner in node.items():
            if name not in _REFERENCES:
                yield from _zeros(inner, name)
    elif isinstance(node, list):
        for inner in [] if _has_points(node) else node:
            yield from _zeros(inner, key)
    elif isinstance(node, str):
        _, unit = _number_and_unit(node, key)
        zero, plain = zero_and_unit(unit) if unit else ("", "")
        if plain in unit_names("pressure"):
            yield zero


def _number_and_unit(text: str, key: str) -> tuple[str, str]:
    """Return the number of a text, with the blanks after it, and its unit; '' and the text itself for key `unit`."""
    text = familiar(text).strip()
    number = re.match(rf"{WRITTEN}\s*", text)
    if number:
        return number.group(), text[number.end() :]
    return "", text if key == "unit" else ""


def _text_without_zero(text: str, reading: Reading, path: Path, reference: str) -> Node:
    """Return a text with psi in place of psia or psig, if it is a pressure of this reference."""
    key = next((str(step) for step in reversed(path) if isinstance(step, str)), "")
    number, unit = _number_and_unit(text, key)
    zero, plain = zero_and_unit(unit) if unit else ("", "")
    is_pressure = bool(zero) and plain in unit_names("pressure") and key != "name"
    if not is_pressure:
        return text
    if zero == reference:
        return type(text)(number + plain)
    what = "the ambient" if key == "ambient" else "this pressure"
    advice = other_zero(unit, reference, what)
    if reference and "indicator" in path:
        advice = (
            f"'{unit}' is {zero}, but 'pressures: {reference}' holds here; "
            f"write 'pressures: {zero}', or the {reference} pressure in {plain}"
        )
    return reading.fault(path, advice)


# limits and expectations


def _figures_without_zeros(node: Node, reading: Reading, key: str, references: set[str]) -> Any:
    """Return the figures of `limits` or `expect` without the names of zeros; references: of all indicators."""
    if not isinstance(node, dict):
        return node
    figures: dict[str, Any] = {}
    for name, figure in node.items():
        bounds = figure if isinstance(figure, list) else [figure]
        plain = []
        for index, bound in enumerate(bounds):
            path: Path = (key, name, index) if isinstance(figure, list) else (key, name)
            plain.append(_figure_without_zero(bound, reading, path, references))
        figures[name] = plain if isinstance(figure, list) else plain[0]
    return figures


def _figure_without_zero(figure: Node, reading: Reading, path: Path, references: set[str]) -> Node:
    """Return a figure, with its tolerance, without the names of zeros; a wrong one is a fault."""
    if not isinstance(figure, str):
        return figure
    for match in _PRESSURE.finditer(familiar(figure)):
        number, blanks, unit = match.groups()
        zero, plain = zero_and_unit(unit)
        if not zero or plain not in unit_names("pressure"):
            continue
        name = str(path[1])
        message = other_zero(unit, _reference_of_figure(name, reading, references), name)
        if message:
            return reading.fault(path, message)
        figure = type(figure)(figure.replace(number + blanks + unit, number + blanks + plain))
    return figure


def _reference_of_figure(name: str, reading: Reading, references: set[str]) -> str:
    """Return what a key value counts from; '' for a difference of pressures, or where cylinders differ."""
    _, id = scoped(name)
    quantities = reading.key_values()
    if id not in quantities:
        ids = called(id, quantities.values())
        id = ids[0] if ids else ""
    is_level = id in quantities and quantities[id].gauge
    return next(iter(references)) if is_level and len(references) == 1 else ""
