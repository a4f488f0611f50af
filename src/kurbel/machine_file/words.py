"""How messages speak of forms: what a key expects, and what a person would write there."""

from __future__ import annotations

from typing import Any

from kurbel.declared import keys as forms
from kurbel.declared.units import example


def example_of(form: Any) -> str:
    """Return a value of this form as a person would write it, or '…' for what is longer than a line."""
    if isinstance(form, (forms.Physical, forms.UnitName)):
        text = example(form.kind)
        return text.split(" ", 1)[1] if isinstance(form, forms.UnitName) else text
    if isinstance(form, forms.Number):
        return "5" if (form.above or 0) >= 1 else "0.1"
    if isinstance(form, forms.Count):
        return str(max(form.least, 3 if form.most is None else form.least))
    if isinstance(form, forms.Choice):
        return form.words[0]
    if isinstance(form, forms.Points):
        return "[[0, 1], [1, 2]]"
    if isinstance(form, forms.OneOf):
        return example_of(form.forms[0])
    return "…"


def expected(form: Any) -> str:
    """Return what stands under a key of this form, for 'expected …'."""
    if isinstance(form, forms.Physical):
        return f"a number with its unit, such as '{example_of(form)}'" + _or_words(form.words)
    if isinstance(form, forms.Number):
        return "a number" + _or_words(form.words)
    if isinstance(form, forms.Count):
        return "a whole number"
    if isinstance(form, forms.Text):
        return "a text"
    if isinstance(form, forms.FilePath):
        return "the name of a file"
    if isinstance(form, forms.Choice):
        return " or ".join(f"'{word}'" for word in form.words)
    if isinstance(form, forms.UnitName):
        return f"a unit of {form.kind}, such as '{example_of(form)}'"
    if isinstance(form, forms.Points):
        return f"a list of pairs [[{form.x}, {form.y}], …]"
    if isinstance(form, forms.Listing):
        return "a list"
    if isinstance(form, forms.OneOf):
        return ", or ".join(expected(each) for each in form.forms)
    if isinstance(form, forms.Limits):
        return "a mapping of key values to bounds, such as 'c_max: 6 m/s'"
    if isinstance(form, forms.Keyed):
        cases = listed([name for name, _ in form.cases])
        return f"a mapping with {expected(form.otherwise).removeprefix('a mapping with ')}; or with one of {cases}"
    if isinstance(form, forms.Record):
        return f"a mapping with the keys {listed([*forms.load(form).KEYS])}"
    return "a mapping"


def _or_words(words: tuple[tuple[str, float], ...]) -> str:
    return "".join(f" or '{word}'" for word, _ in words)


def listed(names: list[str], more: str = "") -> str:
    """Write names one after the other, `a, b, c`."""
    return ", ".join([*names, more] if more else names)


def kind_of(value: Any) -> str:
    """Return what a value of the tree is, for 'got …'."""
    if isinstance(value, dict):
        return "a mapping" if value else "an empty mapping"
    if isinstance(value, list):
        return "a list" if value else "an empty list"
    from kurbel.machine_file.source import shown

    return f"'{shown(value)}'"
