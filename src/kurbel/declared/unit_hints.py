"""What was probably meant by a unit that is none of its kind; imported only where one is refused."""

import re

from kurbel.declared.numerals import NUMBER
from kurbel.declared.units import ZEROED_UNITS, kind_name, kinds, unit_names

_SPOKEN = (
    (r"''|[\"″”]", "in"),
    (r"['′’]", "ft"),
    (r"\bpounds?\b", "lb"),
    (r"\b(lbf?|kg|in|ft|mm|cm)s\b", r"\1"),
)
"""How people write some units, and what these are here."""


def unit_hint(name: str, kind: str) -> str:
    """Return what to write instead of a unit, of which the white space is that of ours; '' where nothing is known."""
    known = unit_names(kind)
    if kind == "length" and re.fullmatch(r"(ft|['′’])[ -]*[0-9].*", name):
        return "; write feet and inches in one unit, such as '90 in' for 7 ft 6 in"
    if kind == "spring":
        return "; it is height over pressure: a spring of 60 lb per inch is '1/60 in/psi'"
    if number := NUMBER.match(name):
        return f"; write the unit alone, without {number.group()}"
    if name in (*ZEROED_UNITS, "atu"):
        return "; whether a pressure is gauge or absolute is said by the key 'pressures'"
    if name in ("ton", "tons", "tonf"):
        f = name.removeprefix("ton").removeprefix("s")
        return f"; a ton is 't{f}' (1000 kg{f}), 'long ton{f}' (2240 lb{f}) or 'short ton{f}' (2000 lb{f}): write which"
    weight = re.sub(r"\bkg\b", "kgf", name)
    if weight != name and weight in known:
        return f"; kg is a mass, write '{weight}'"
    ours = _ours(name)
    if alike := [unit for unit in known if unit.lower() == ours.lower()]:
        return f"; did you mean '{alike[0]}'?"
    of = [kind_name(other) for other in kinds() if {name, ours} & {*unit_names(other)}]
    return f"; {name} is a unit of {of[0]}" if of else ""


def _ours(name: str) -> str:
    """Return a unit as it is written here, where people write it otherwise."""
    for spoken, ours in _SPOKEN:
        name = re.sub(spoken, ours, name, flags=re.IGNORECASE)
    return name
