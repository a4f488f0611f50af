"""The pages of docs/reference: every key, unit, column, key value, command and option, from their declarations.

`pytest --rewrite tests/project/test_documents.py` writes them.
"""

from __future__ import annotations

import html
import re
from collections.abc import Iterable, Iterator

import click

from kurbel.cli import COMMANDS, kurbel
from kurbel.cli.group import KurbelCommand
from kurbel.declared.forms.structures import Inline, Keyed, RecordForm, records
from kurbel.declared.forms.values import Form
from kurbel.declared.keys import Key, Keys, Record, absent_text
from kurbel.declared.unit_systems import SYSTEMS
from kurbel.declared.units import KINDS, MOST_ITEMS, MOST_POINTS, kinds, listed_units, range_of
from kurbel.machine import Machine
from kurbel.quantities import every_quantity
from kurbel.quantity import Quantity, by_id
from kurbel.report.balance import ELLIPSES, ORDERS, WEIGHTS
from kurbel.report.delivery import ENDS
from kurbel.report.harmonics import TORQUE_ORDERS
from kurbel.report.stress import STRESSES
from kurbel.report.torsion import CRITICAL_SPEEDS, HOLZER, MODES, PIECES, SPEEDS
from kurbel.report.zusammenstellung import FACTORS

_WRITTEN = "<!-- Written from the declarations by `pytest --rewrite tests/project/test_documents.py`; do not edit by hand. -->"


def keys() -> str:
    """Return every key of the machine file."""
    return _page("Every key of the machine file", _KEYS, *_records())


def units() -> str:
    """Return the units of every kind, and what a machine file may hold."""
    return _page("Units and sizes", *_units(), *_sizes())


def columns() -> str:
    """Return the quantities over the crank angle, of every command."""
    printed = [column for column in every_quantity().all_columns if column.commands]
    return _page("Columns", _COLUMNS, *_by_command(printed), *_others())


def key_values() -> str:
    """Return the single figures of every command."""
    return _page("Key values", _KEY_VALUES, *_by_command(every_quantity().all_key_values))


def commands() -> str:
    """Return the help of every command."""
    return _page("Every command and option", *map(_command, COMMANDS))


_KEYS = """A key that is a mapping has a table of its own. Keys of `cylinder`, its mechanism and its piston are at
the top level of a machine with one cylinder. `kurbel keys KEY` prints one in the terminal, with its dotted path."""
_COLUMNS = """Quantities over the crank angle, by the command that prints them first. The id is used in CSV, JSON,
`--columns` and `--where`, which take the symbol, too. Forces are positive toward the shaft, and so is the velocity c; φ
runs from the inner dead centre in the sense of rotation. Units are those of SI, metric, technical and imperial."""
_KEY_VALUES = """Single figures, by the command that prints them first; `limits` and `expect` in the machine file check
them. They are exact and do not depend on `--step`. `_max` is the largest signed value, `_min` the smallest, `_peak` the
largest magnitude. Units are those of SI, metric, technical and imperial."""


def _page(title: str, *parts: str) -> str:
    return "\n\n".join([f"# {title}", *(part.strip("\n") for part in parts), _WRITTEN]) + "\n"


def _table(heads: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    heads = list(heads)
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n".join("| " + " | ".join(_cell(cell) for cell in line) + " |" for line in lines)


def _cell(text: str) -> str:
    """Return a text as a cell; in code a bar is written as a character reference, since a backslash would be printed."""
    cell = re.sub(r"`([^`]*\|[^`]*)`", _code_with_bars, text)
    return cell.replace("|", "\\|").replace("\n", " ")


def _code_with_bars(code: re.Match[str]) -> str:
    return f"<code>{html.escape(code[1], quote=False).replace('|', '&#124;')}</code>"


def _by_command(declared: Iterable[Quantity]) -> Iterator[str]:
    """Yield a table for each command, of the quantities of which it is the first in the order of the commands."""
    given, listed = list(declared), set[str]()
    for command in COMMANDS:
        own = by_id(*(one for one in given if command in one.commands and one.id not in listed))
        listed |= set(own)
        if own:
            yield f"## kurbel {command}\n\n{_quantities(own.values())}"


def _others() -> Iterator[str]:
    yield f"## Stresses at one place of a crankshaft\n\n{_quantities(STRESSES.values())}"
    tables = (ORDERS | ELLIPSES | WEIGHTS).values()
    yield f"## Orders of unbalanced forces and moments, and counterweights\n\n{_quantities(tables)}"
    yield f"## Orders of a torque\n\n{_quantities(TORQUE_ORDERS.values())}"
    yield f"## Natural vibrations\n\n{_quantities(MODES.values())}"
    yield f"## Holzer's table\n\n{_quantities(HOLZER.values())}"
    yield f"## Critical speeds\n\n{_quantities(CRITICAL_SPEEDS.values())}"
    yield f"## A shaft segment at the working speed\n\n{_quantities(PIECES.values())}"
    yield f"## An end of a compressor\n\n{_quantities(ENDS.values())}"
    yield f"## A shaft segment over the speed\n\n{_quantities(SPEEDS.values())}"
    yield f"## Rows of Zusammenstellung 112 (kurbel table)\n\n{_quantities(FACTORS.values())}"


def _quantities(declared: Iterable[Quantity]) -> str:
    rows = ((f"`{q.id}`", q.symbol, q.text, _units_of(q.kind)) for q in declared)
    return _table(("id", "symbol", "meaning, formula, source", "units"), rows)


def _units_of(kind: str) -> str:
    """Return the units of a kind in every system, once where all of them have the same; a middle dot parts them."""
    each = [_unit(system[kind]) for system in SYSTEMS.values()]
    return " · ".join(each) if len(set(each)) > 1 else each[0]


def _unit(given: str | tuple[str, ...]) -> str:
    return given if isinstance(given, str) else ", ".join(given)


def _units() -> Iterator[str]:
    yield (
        "Every key takes units of one kind. Products and powers are written `N m` or `N*m`, `kg m2`, `kg m^2` or "
        "`kg m²`. `kg` is a mass; a force is `kgf` or `kp`. Lengths may be feet and inches, `12 ft 6 in`, `1 3/4 in`, "
        "`5' 6\"`. A pressure unit may name its zero, as `bara`, `psig`, `bar abs`, `kPa(g)`, and must then agree with "
        "`pressures`. A gallon is a `US gal` or an `imp gal`. Other products, such as `kN/in2`, are read, too."
    )
    rows = (
        (kind.replace("_", " "), ", ".join(f"`{name}`" for name in listed_units(kind)))
        for kind in kinds()
    )
    yield _table(("kind", "units"), rows)


def _sizes() -> Iterator[str]:
    yield "## Sizes\n\nA value beyond these is an error; the sign is free. [Limits of size](../size.md) has times."
    rows = [(kind.replace("_", " "), range_of(kind)) for kind in KINDS]
    rows += [
        ("points of one diagram or trace", f"up to {MOST_POINTS}"),
        ("items of one list", f"up to {MOST_ITEMS}"),
    ]
    yield _table(("kind", "size"), rows)


def _records() -> Iterator[str]:
    """Yield a table of keys for the machine and for every record that its keys lead to, each record once."""
    seen: set[type[Record]] = set()
    waiting = [("machine", RecordForm(Machine))]
    while waiting:
        name, record = waiting.pop(0)
        if record.record not in seen:
            seen.add(record.record)
            yield f"## {name}\n\n{_keys(record.keys)}"
            waiting += [one for word, key in record.keys.items() for one in records(key.form, word)]


def _keys(keys: Keys) -> str:
    rows = (
        (f"`{word}`", key.symbol, _meaning(key), _written(word, key), _absent(keys, word))
        for word, key in _with_cases(keys)
        if not isinstance(key.form, Inline)
    )
    return _table(("key", "symbol", "meaning", "written", "if absent"), rows)


def _meaning(key: Key) -> str:
    """Return what a key means, and the rule of thumb for its size."""
    return f"{key.text}; usual: {key.usual}" if key.usual else key.text


def _written(word: str, key: Key) -> str:
    """Return how a value is written: as its form says where that shows it, else by an example."""
    name = word.rpartition(".")[2]
    example = key.line(name).removeprefix(f"{name}: ")
    return key.written if "`" in key.written or not example else f"`{example}`"


def _with_cases(keys: Keys) -> Iterator[tuple[str, Key]]:
    """Yield the keys of a table, each with those keys below it that have no table of their own."""
    for word, key in keys.items():
        yield word, key
        for name, case in _cases(key.form):
            yield f"{word}.{name}", case


def _cases(form: Form) -> Iterator[tuple[str, Key]]:
    if isinstance(form, Keyed):
        yield from form.single.items()
    yield from (case for word, inner in form.parts if not word for case in _cases(inner))


def _absent(keys: Keys, word: str) -> str:
    return absent_text(keys, word) if word in keys else ""


def _command(name: str) -> str:
    command = kurbel.get_command(click.Context(kurbel), name)
    assert command
    # as the group names it: a command keeps the first help option that it is asked for
    names = kurbel.context_settings["help_option_names"]
    context = click.Context(command, info_name=f"kurbel {name}", help_option_names=names)
    usage = command.get_usage(context).removeprefix("Usage: ")
    text = _prose(command.help or "")
    # not every version of click tells arguments, which the usage names
    shown = [
        get_param
        for get_param in command.get_params(context)
        if isinstance(get_param, click.Option)
    ]
    rows = [row for one in shown if (row := one.get_help_record(context))]
    options = _table(("option", "meaning"), ((f"`{option}`", meaning) for option, meaning in rows))
    assert isinstance(command, KurbelCommand)
    end = "\n\n".join(command.end_of_help())
    usage += f"\n\nExample: {COMMANDS[name].example}"
    return f"## kurbel {name}\n\n```text\n{usage}\n```\n\n{text}\n\n{options}\n\n{end}"


def _prose(text: str) -> str:
    """Return the help of a command as Markdown: what click keeps as it is becomes a block of text."""
    parts = re.split(r"\n\n", re.sub(r"^ {4}", "", text, flags=re.M))
    return "\n\n".join(
        f"```text\n{p[2:].strip(chr(10))}\n```" if p.startswith("\b\n") else p for p in parts
    )
