"""Pressure units that name their zero, such as psia and barg: they must agree with what a value counts from.

In the tree of a machine file they are replaced by the units without, so that nothing else needs to have them.
"""

import re
from typing import Any

from kurbel.declared.numerals import WRITTEN, familiar
from kurbel.declared.reading import Reading
from kurbel.declared.units import ZEROED_UNITS
from kurbel.errors import Path

_COUNTED = {
    "ambient": "absolute",
    "vapour_pressure": "absolute",
    **dict.fromkeys(("offset", "mean_pressure", "drawn"), ""),
}
"""Keys whose pressures do not count as the indicator around them says: '' where they are differences."""
_VALUE = re.compile(rf"((?:{WRITTEN})?\s*)({'|'.join(ZEROED_UNITS)})")


def without_zeros(tree: Any, reading: Reading, path: Path = (), counted: str = "") -> Any:
    """Return a tree without such units; one that does not agree with `counted`, gauge or absolute, is a fault.

    Pressures of an indicator count as its `pressures` say, the ambient is absolute, and no others have a zero.
    """
    if isinstance(tree, dict):
        if path[-1:] == ("indicator",):
            counted = "absolute" if tree.get("pressures") == "absolute" else "gauge"
        return {key: without_zeros(one, reading, (*path, key), _COUNTED.get(key, counted)) for key, one in tree.items()}
    if isinstance(tree, list):
        points = tree and isinstance(tree[0], list)  # of bare numbers
        return tree if points else [without_zeros(one, reading, (*path, i), counted) for i, one in enumerate(tree)]
    found = _VALUE.fullmatch(familiar(tree).strip()) if isinstance(tree, str) else None
    if not found or (path[-1] != "unit" and not found[1].strip()):
        return tree
    zero, plain = ZEROED_UNITS[found[2]]
    if not counted:
        return reading.fault(path, f"'{found[2]}' is {zero}, but this pressure has no zero; write the unit {plain}")
    if zero != counted:
        here = "the ambient is absolute; write" if path[-1] == "ambient" else f"'pressures: {counted}' holds here; "
        other = "" if path[-1] == "ambient" else f"write 'pressures: {zero}', or"
        return reading.fault(path, f"'{found[2]}' is {zero}, but {here}{other} the {counted} pressure in {plain}")
    return type(tree)(found[1] + plain)
