"""What a machine file gives, key by key, as it was read: with what was set over it, and nothing guessed."""

from collections.abc import Iterator
from typing import Any

from kurbel.declared.reading import Reading
from kurbel.errors import Path, path_text
from kurbel.machine.origin import Origin
from kurbel.machine_file.events import parse
from kurbel.machine_file.source import decode

_MOST = 12
_LONGEST = 160


def given(origin: Origin) -> tuple[tuple[str, str], ...]:
    """Return every key of a machine file that was read without a fault, by its dotted path, with its value."""
    tree = parse(decode(origin.name, origin.content).text, Reading())
    if origin.overrides:
        from kurbel.machine_file.overrides import overridden, read_override

        overridden(tree, [read_override(one) for one in origin.overrides])
    return tuple((path_text(path), value) for path, value in _leaves(tree, ()))


def _leaves(node: Any, path: Path) -> Iterator[tuple[Path, str]]:
    if isinstance(node, dict):
        for name, below in node.items():
            yield from _leaves(below, (*path, name))
    elif isinstance(node, list) and any(isinstance(one, dict) for one in node):
        for number, below in enumerate(node):
            yield from _leaves(below, (*path, number))
    else:
        yield path, _short(node)


def _short(value: Any) -> str:
    """Return a value in one line; of a long list its ends, and how many there are."""
    if not isinstance(value, list):
        text = " ".join(str(value).split())
        return text if len(text) <= _LONGEST else f"{text[:_LONGEST]} …"
    shown = [_short(one) for one in value]
    if len(shown) > _MOST:
        return f"[{', '.join(shown[:3])}, …, {shown[-1]}] ({len(shown)} in all)"
    return f"[{', '.join(shown)}]"
