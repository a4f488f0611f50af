"""The page of symbols, written from the declarations into docs/symbols.md by `pytest --rewrite`."""

from __future__ import annotations

from collections.abc import Iterable

from kurbel.declared.bounds import MOST_ITEMS, MOST_POINTS, SIZES, range_of
from kurbel.declared.forms import Record
from kurbel.declared.keys import Keys, required
from kurbel.declared.quantities import FACTORS
from kurbel.declared.quantity import Quantity, by_id
from kurbel.declared.shaft import STRESSES
from kurbel.declared.torsion import CRITICAL_SPEEDS, HOLZER, MODES, ORDERS, PIECES, SPEEDS
from kurbel.declared.unit_systems import SI, TECHNICAL
from kurbel.mechanisms import every_quantity

_HEAD = """# Symbols, quantities and keys

Written from the declarations in the code by `pytest --rewrite`; do not edit by hand.
"""


def symbols_page() -> str:
    """Return the whole page as Markdown."""
    every = every_quantity()
    parts = [
        _HEAD,
        _quantities("Columns over the crank angle", by_id(one for one in every.all_columns if one.commands)),
        _quantities("Key values", by_id(every.all_key_values)),
        _quantities("Stresses at one place of a crankshaft", STRESSES),
        _quantities("Orders of a torque", ORDERS),
        _quantities("Natural vibrations", MODES),
        _quantities("Critical speeds", CRITICAL_SPEEDS),
        _quantities("Holzer's table", HOLZER),
        _quantities("A piece of shaft at the working speed", PIECES),
        _quantities("A piece of shaft over the speed", SPEEDS),
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
    seen: set[str] = set()
    waiting = [("machine", Record("kurbel.machine:Machine"))]
    while waiting:
        name, record = waiting.pop(0)
        if record.target not in seen:
            seen.add(record.target)
            yield _keys(name, record.keys)
            waiting += [one for word, key in record.keys.items() for one in key.form.records(word)]


def _keys(name: str, keys: Keys) -> str:
    needed = required(keys)
    rows = [
        f"| `{word}` | {_cell(key.symbol)} | {_cell(key.form.written())} | {_cell(key.text)} | "
        f"{'must be given' if word in needed else _cell(key.absent)} |"
        for word, key in keys.items()
        if not key.form.shared
    ]
    head = ["| key | symbol | form | meaning | absent |", "|---|---|---|---|---|"]
    return "\n".join([f"### {name}\n", *head, *rows, ""])


def _cell(text: str) -> str:
    return text.replace("|", "\\|")
