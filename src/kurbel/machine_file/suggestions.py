"""What was meant: near words, and the place in the file where a key belongs."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from kurbel.declared import keys as forms

_ROOT = forms.Record("kurbel.machine:Machine")
_INLINE_TOO = (forms.Record("kurbel.machine:Cylinder"), forms.Record("kurbel.machine.piston:Piston"))
"""Records whose keys are named where they stand inline; the lists of them need not be named as well."""


def where_it_belongs(key: str) -> str:
    """Return where in a machine file a key may stand, such as "it belongs under 'friction.rings'", or ''."""
    found = dict.fromkeys(place for place, name in _places(_ROOT, "", "at the top of the file") if name == key)
    return "it belongs " + " or ".join(list(found)[:3]) if found else ""


def _places(form: Any, path: str, words: str) -> Iterator[tuple[str, str]]:
    """Yield every key that may stand in a mapping of this form, each after the words for that mapping."""
    if isinstance(form, forms.Record):
        for name, key in forms.load(form).KEYS.items():
            yield from _places_of_key(name, key.form, path, words)
    elif isinstance(form, forms.Listing):
        yield from _places(form.item, path, words)
    elif isinstance(form, forms.OneOf):
        for each in form.forms:
            yield from _places(each, path, words)
    elif isinstance(form, forms.Keyed):
        for name, case in form.cases:
            yield from _places_of_key(name, case, path, words)
        yield from _places(form.otherwise, path, words)


def _places_of_key(name: str, form: Any, path: str, words: str) -> Iterator[tuple[str, str]]:
    if isinstance(form, forms.Inline):
        yield from _places(form.record, path, "to a cylinder" if form.unless else words)
        return
    yield words, name
    if isinstance(form, forms.Variant):
        for word, case in form.cases:
            yield from ((f"to '{form.selector}: {word}'", inner) for inner in forms.load(case).KEYS)
    elif not (isinstance(form, forms.Listing) and form.item in _INLINE_TOO):
        inner_path = f"{path}.{name}" if path else name
        yield from _places(form, inner_path, f"under '{inner_path}'")
