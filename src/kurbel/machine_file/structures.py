"""Readers of mappings and lists: a mapping becomes a record once all of its keys could be read."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from kurbel.declared import keys as forms
from kurbel.declared.bounds import MOST_ITEMS
from kurbel.errors import Fault, Path, RuleError
from kurbel.machine_file import points, scalars
from kurbel.machine_file.events import REFUSED, Plain
from kurbel.machine_file.reading import Reading
from kurbel.machine_file.words import example_of, expected, kind_of

Tree = dict[str, Any]


def read(reading: Reading, form: Any, value: Any, path: Path) -> Any:
    """Return what a value of the tree becomes under a key of this form, or REFUSED after noting every fault."""
    if value is REFUSED:
        return REFUSED
    return _READERS[type(form)](reading, form, value, path)


def record(reading: Reading, form: forms.Record, value: Any, path: Path) -> Any:
    """Read a mapping into a record."""
    if not isinstance(value, dict):
        return _not_a_mapping(reading, form, value, path)
    return read_record(reading, forms.load(form), value, path)


def read_record(reading: Reading, cls: Any, mapping: Tree, path: Path, **defaults: Any) -> Any:
    """Read a mapping into a record of this class; defaults hold for keys that are absent."""
    known = all_names(cls, mapping)
    unknown = [name for name in mapping if name not in known]
    if unknown:
        from kurbel.machine_file.unknown import unknown_keys

        # a misspelt key counts as given but unreadable, so that nobody is told that it is missing as well
        mapping = mapping | dict.fromkeys(unknown_keys(reading, cls, mapping, unknown, known, path), REFUSED)
    return _build(reading, cls, mapping, path, frozenset(), defaults)


def own_names(cls: Any) -> list[str]:
    """Return the names of the keys that stand in the mapping itself."""
    return [name for name, key in cls.KEYS.items() if not isinstance(key.form, forms.Inline)]


def all_names(cls: Any, mapping: Tree) -> dict[str, None]:
    """Return the names of all keys that this mapping may have: its own, inline ones, those of the chosen variant."""
    names = dict.fromkeys(own_names(cls))
    for key in cls.KEYS.values():
        if isinstance(key.form, forms.Inline) and key.form.unless not in mapping:
            names |= all_names(forms.load(key.form.record), mapping)
        elif isinstance(key.form, forms.Variant):
            for case in _cases(key.form, mapping):
                names |= all_names(forms.load(case), mapping)
    return names


def _cases(form: forms.Variant, mapping: Tree) -> list[forms.Record]:
    """Return the chosen variant; all of them where the word that chooses is unknown."""
    word = mapping.get(form.selector, form.default)
    return [case for name, case in form.cases if name == word] or [case for _, case in form.cases]


def _build(reading: Reading, cls: Any, mapping: Tree, path: Path, taken: frozenset[str], defaults: Tree) -> Any:
    """Read the keys of one record out of a mapping that may hold those of others; `taken` belong to an outer one."""
    values = dict(defaults)
    inner_taken = taken.union(own_names(cls))
    for name, key in cls.KEYS.items():
        form = key.form
        if isinstance(form, forms.Inline):
            inner = forms.load(form.record)
            if (
                not (form.unless and form.unless in mapping)
                and (all_names(inner, mapping).keys() - inner_taken) & mapping.keys()
            ):
                values[name] = _build(reading, inner, mapping, path, inner_taken, {})
        elif isinstance(form, forms.Variant):
            values[name] = _variant(reading, form, mapping, path, inner_taken)
        elif name in taken:
            continue
        elif name in mapping:
            values[name] = read(reading, form, mapping[name], (*path, name))
        elif key.required:
            # of an inline record, point at what is there of it
            beside = next((given for given in own_names(cls) if given in mapping), "") if taken else ""
            where = (*path, beside) if beside else path
            values[name] = reading.fault(where, _missing(name, key, beside), bool(beside))
    if any(value is REFUSED for value in values.values()):
        _check_alone(reading, cls, values, path)
        return REFUSED
    return _born(reading, cls, values, mapping, path)


def _check_alone(reading: Reading, cls: Any, values: Tree, path: Path) -> None:
    """Note what a record has to say of single keys, though it cannot be made because of others."""
    for name, value in values.items():
        for fault in getattr(cls, "faults_of_key", lambda *_: ())(name, value):
            reading.fault((*path, *fault.path), fault.message)


def _missing(name: str, key: forms.Key, beside: str) -> str:
    meaning = key.text[:1].lower() + key.text[1:]
    missing = f"'{name}' is missing{' beside it' if beside else ''}: {meaning}"
    return f"{missing}; write for instance '{name}: {example_of(key.form)}'"


def _variant(reading: Reading, form: forms.Variant, mapping: Tree, path: Path, taken: frozenset[str]) -> Any:
    if form.selector in mapping:
        words = forms.Choice(tuple(word for word, _ in form.cases))
        if read(reading, words, mapping[form.selector], (*path, form.selector)) is REFUSED:
            return REFUSED
    return _build(reading, forms.load(_cases(form, mapping)[0]), mapping, path, taken, {})


def _born(reading: Reading, cls: Any, values: Tree, mapping: Tree, path: Path) -> Any:
    """Make the record; what its rules say comes with the path of the mapping before it."""
    try:
        born = getattr(cls, "from_keys", cls)(**values)
    except RuleError as error:
        for fault in error.faults:
            reading.fault((*path, *_flat(cls, mapping, fault)), fault.message)
        return REFUSED
    except ArithmeticError:
        return reading.fault(path, "these numbers are too large or too small to compute with")
    if _finite(born, values):
        return born
    return reading.fault(path, "these numbers are too large or too small to compute with")


def _flat(cls: Any, mapping: Tree, fault: Fault) -> Path:
    """Return the path of a fault; the keys of the only cylinder stand in the mapping itself."""
    for key in cls.KEYS.values():
        unless = getattr(key.form, "unless", "")
        if unless and unless not in mapping and fault.path[:2] == (unless, 0):
            return fault.path[2:]
    return fault.path


def _finite(born: Any, values: Tree) -> bool:
    """Return whether every number of a record is finite, or infinite by a word of the file or by default."""
    meant = any(value == math.inf for value in values.values() if isinstance(value, float))
    numbers = [(name, value) for name, value in getattr(born, "__dict__", {}).items() if isinstance(value, float)]
    return all(
        math.isfinite(value) or (value == math.inf and (meant or getattr(type(born), name, 0) == math.inf))
        for name, value in numbers
    )


def keyed(reading: Reading, form: forms.Keyed, value: Any, path: Path) -> Any:
    """Read a mapping whose telling key decides what it is."""
    if not isinstance(value, dict):
        return _not_a_mapping(reading, form, value, path)
    cases = dict(form.cases)
    telling = [name for name in value if name in cases]
    if not telling:
        return _otherwise(reading, form, value, path)
    first = telling[0]
    for name in value:
        if name != first:
            reading.fault((*path, name), f"cannot stand beside '{first}'{_home(form, name)}", at_key=True)
    inner = read(reading, cases[first], value[first], (*path, first))
    return inner if len(value) == 1 else REFUSED


def _home(form: forms.Keyed, name: str) -> str:
    """Return where a key belongs that stands beside a telling one, or that one of both is too many."""
    card = forms.load(form.otherwise).KEYS if isinstance(form.otherwise, forms.Record) else {}
    if name in card or name in dict(form.cases):
        return "; leave one of them out"
    from kurbel.machine_file.suggestions import where_it_belongs

    return f"; {where_it_belongs(name) or 'leave it out'}"


def _otherwise(reading: Reading, form: forms.Keyed, value: Tree, path: Path) -> Any:
    if isinstance(form.otherwise, forms.Record):
        from kurbel.machine_file.unknown import misspelt_case

        if misspelt_case(reading, form, value, path):
            return REFUSED
    return read(reading, form.otherwise, value, path)


def _not_a_mapping(reading: Reading, form: Any, value: Any, path: Path) -> Any:
    if isinstance(value, Plain) and not value:
        return reading.fault(path, f"nothing stands here; write below it, indented, {expected(form)}")
    hint = scalars.glued_hint(value) if isinstance(value, str) else ""
    return reading.fault(path, f"expected {expected(form)}, got {kind_of(value)}{hint}")


def listing(reading: Reading, form: forms.Listing, value: Any, path: Path) -> Any:
    """Read a list into a tuple."""
    if isinstance(value, Plain) and not value:
        return reading.fault(path, "nothing stands here; write a list below it, each item after '- '")
    if not isinstance(value, list):
        return reading.fault(path, f"expected a list, each item after '- ', got {kind_of(value)}")
    if not value:
        return reading.fault(path, "the list is empty; give at least one item or leave the key out")
    if len(value) > MOST_ITEMS:
        return reading.fault(path, f"{len(value)} items; no machine has more than {MOST_ITEMS} of them")
    items = tuple(read(reading, form.item, item, (*path, index)) for index, item in enumerate(value))
    return REFUSED if any(item is REFUSED for item in items) else items


def one_of(reading: Reading, form: forms.OneOf, value: Any, path: Path) -> Any:
    """Read a value by the first form that has its shape."""
    for each in form.forms:
        if _shape(each) is (type(value) if isinstance(value, (dict, list)) else str):
            return read(reading, each, value, path)
    return reading.fault(path, f"expected {expected(form)}, got {kind_of(value)}")


def _shape(form: Any) -> type:
    if isinstance(form, (forms.Record, forms.Keyed, forms.Limits)):
        return dict
    return list if isinstance(form, (forms.Listing, forms.Points)) else str


_READERS: dict[type, Callable[[Reading, Any, Any, Path], Any]] = {
    forms.Physical: scalars.physical,
    forms.Number: scalars.number,
    forms.Count: scalars.count,
    forms.Text: scalars.text,
    forms.Choice: scalars.choice,
    forms.FilePath: scalars.file_path,
    forms.UnitName: scalars.unit_name,
    forms.Points: points.points,
    forms.Limits: scalars.limits,
    forms.Record: record,
    forms.Keyed: keyed,
    forms.Listing: listing,
    forms.OneOf: one_of,
}
"""Form -> its reader. Inline and Variant are read with the record whose mapping they share."""
