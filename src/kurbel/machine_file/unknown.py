"""Keys that a mapping does not have: misspelt, or at home elsewhere in the file."""

from __future__ import annotations

from typing import Any

from kurbel.declared import keys as forms
from kurbel.errors import Path
from kurbel.machine_file.reading import Reading
from kurbel.machine_file.suggestions import where_it_belongs
from kurbel.machine_file.words import listed
from kurbel.near_words import near


def unknown_keys(
    reading: Reading, cls: Any, mapping: dict[str, Any], unknown: list[str], known: dict[str, None], path: Path
) -> list[str]:
    """Note a fault for each unknown key and return the known ones that were probably meant."""
    meant = []
    elsewhere = {} if path else _list_instead(cls, mapping)
    listed_once = False
    for name in unknown:
        suggestion = "" if name in elsewhere else near(name, tuple(known))
        message = _message(name, suggestion, elsewhere)
        if not message:
            message = "unknown key" if listed_once else f"unknown key; known here are {listed(list(known))}"
            listed_once = True
        reading.fault((*path, name), message, at_key=True)
        if suggestion and suggestion not in mapping:
            meant.append(suggestion)
    return meant


def _list_instead(cls: Any, mapping: dict[str, Any]) -> dict[str, str]:
    """Return the keys that would stand here if a list of such records did not, each with the name of that list."""
    from kurbel.machine_file.structures import all_names

    found: dict[str, str] = {}
    for key in cls.KEYS.values():
        if isinstance(key.form, forms.Inline) and key.form.unless in mapping:
            found |= dict.fromkeys(all_names(forms.load(key.form.record), mapping), key.form.unless)
    return found


def _message(name: str, suggestion: str, elsewhere: dict[str, str]) -> str:
    """Return what was probably meant by an unknown key, or an empty text where nothing is like it."""
    if name in elsewhere:
        return f"belongs to a cylinder; move it into the items of '{elsewhere[name]}'"
    if suggestion:
        return f"unknown key; did you mean '{suggestion}'?"
    if name == "<<":
        return "merging is not supported; write the keys themselves"
    home = where_it_belongs(name)
    return f"does not belong here; {home}" if home else ""


def misspelt_case(reading: Reading, form: forms.Keyed, mapping: dict[str, Any], path: Path) -> bool:
    """Note a fault where an unknown key is nearly a telling one, and return whether there was any."""
    known = forms.load(form.otherwise).KEYS if isinstance(form.otherwise, forms.Record) else {}
    cases = tuple(name for name, _ in form.cases)
    found = False
    for name in mapping:
        meant = "" if name in known or near(name, tuple(known)) else near(name, cases)
        if meant:
            reading.fault((*path, name), f"unknown key; did you mean '{meant}'?", at_key=True)
            found = True
    return found
