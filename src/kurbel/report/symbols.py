"""The page of symbols, written from the declarations: `python -m kurbel.report.symbols > docs/symbols.md`."""

from __future__ import annotations

from collections.abc import Iterable

from kurbel.declared.bounds import MOST_ITEMS, MOST_POINTS, SIZES, range_of
from kurbel.declared.keys import (
    Choice,
    Count,
    Form,
    Inline,
    Key,
    Keyed,
    Listing,
    Number,
    OneOf,
    Physical,
    Points,
    Record,
    Variant,
    load,
)
from kurbel.declared.quantities import FACTORS
from kurbel.declared.quantity import Quantity, by_id
from kurbel.declared.shaft import STRESSES
from kurbel.declared.units import SI, TECHNICAL, example
from kurbel.mechanisms import every_quantity

_HEAD = """# Symbols, quantities and keys

Written from the declarations in the code by `python -m kurbel.report.symbols`; do not edit by hand.
"""


def symbols_page() -> str:
    """Return the whole page as Markdown."""
    every = every_quantity()
    parts = [
        _HEAD,
        _quantities("Columns over the crank angle", by_id(one for one in every.all_columns if one.commands)),
        _quantities("Key values", by_id(every.all_key_values)),
        _quantities("Stresses at one place of a crankshaft", STRESSES),
        _quantities("Rows of Zusammenstellung 112", FACTORS),
        _sizes(),
        "## Keys of the machine file\n",
        *_records(),
    ]
    return "\n".join(parts).rstrip() + "\n"


def _quantities(title: str, declared: dict[str, Quantity]) -> str:
    rows = [
        f"| `{q.id}` | {_cell(q.symbol)} | {_cell(SI[q.kind])} | {_cell(TECHNICAL[q.kind])} | {_cell(q.text)} |"
        for q in declared.values()
    ]
    head = ["| id | symbol | SI | technical | meaning |", "|---|---|---|---|---|"]
    return "\n".join([f"## {title}\n", *head, *rows, ""])


def _sizes() -> str:
    head = "## What a machine file may hold\n\nWhatever is smaller or larger is refused; the sign is free.\n"
    rows = [f"| {kind.replace('_', ' ')} | {_cell(range_of(kind))} |" for kind in SIZES]
    rows += [f"| points of one diagram or trace | up to {MOST_POINTS} |", f"| items of one list | up to {MOST_ITEMS} |"]
    return "\n".join([head, "| kind | size |", "|---|---|", *rows, ""])


def _records() -> Iterable[str]:
    """Yield a table of keys for the machine and for every record that its keys lead to, each record once."""
    from kurbel.machine import Machine

    seen: set[str] = set()
    waiting: list[tuple[str, type]] = [("machine", Machine)]
    while waiting:
        name, record = waiting.pop(0)
        if record.__qualname__ in seen:
            continue
        seen.add(record.__qualname__)
        keys: dict[str, Key] = record.KEYS  # type: ignore[attr-defined]
        yield _keys(name, keys)
        waiting += [(word, load(inner)) for key in keys for word, inner in _inner(key, keys[key].form)]


def _keys(name: str, keys: dict[str, Key]) -> str:
    rows = [
        f"| `{word}` | {_cell(key.symbol)} | {_cell(_form(key.form))} | {_cell(key.text)} | {_absent(key)} |"
        for word, key in keys.items()
        if not isinstance(key.form, Inline)
    ]
    head = ["| key | symbol | form | meaning | absent |", "|---|---|---|---|---|"]
    return "\n".join([f"### {name}\n", *head, *rows, ""])


def _absent(key: Key) -> str:
    return "must be given" if key.required else _cell(key.absent)


def _inner(word: str, form: Form) -> Iterable[tuple[str, Record]]:
    """Yield the records that a key leads to, with the word that names them."""
    if isinstance(form, Record):
        yield word, form
    elif isinstance(form, Inline):
        yield word, form.record
    elif isinstance(form, Listing):
        yield from _inner(word, form.item)
    elif isinstance(form, OneOf):
        for one in form.forms:
            yield from _inner(word, one)
    elif isinstance(form, Keyed):
        for case, one in (*form.cases, ("card", form.otherwise)):
            yield from _inner(case, one)
    elif isinstance(form, Variant):
        for case, record in form.cases:
            yield f"{word}: {case}", record


def _form(form: Form) -> str:
    """Return in a few words what is written for a key."""
    if isinstance(form, Physical):
        words = "".join(f", or `{word}`" for word, _ in form.words)
        return f"`{example(form.kind)}`{words}"
    if isinstance(form, (Number, Count)):
        return "a number" if isinstance(form, Number) else "a whole number"
    if isinstance(form, Choice):
        return ", ".join(f"`{word}`" for word in form.words)
    if isinstance(form, Points):
        return f"`[[{form.x}, {form.y}], …]`"
    if isinstance(form, Listing):
        return f"a list; each {_form(form.item)}"
    if isinstance(form, OneOf):
        return " or ".join(_form(one) for one in form.forms)
    if isinstance(form, Variant):
        return ", ".join(f"`{word}`" for word, _ in form.cases)
    return {"Text": "text", "UnitName": "a unit", "FilePath": "a path", "Limits": "`{key value: bound}`"}.get(
        type(form).__name__, "a mapping"
    )


def _cell(text: str) -> str:
    return text.replace("|", "\\|")


if __name__ == "__main__":
    import sys

    sys.stdout.buffer.write(symbols_page().encode())
