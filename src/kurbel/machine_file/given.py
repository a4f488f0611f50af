"""What a machine file gives, key by key, as it was read: with what was set over it, and nothing guessed."""

from collections.abc import Iterator
from typing import Any

from kurbel.declared.reading import Reading, Tree
from kurbel.errors import Path, UsageError, path_text
from kurbel.machine.origin import Origin
from kurbel.machine_file.events import parse
from kurbel.machine_file.overrides import set_over

_MOST = 12
_LONGEST = 160


def given(origin: Origin) -> tuple[tuple[str, str], ...]:
    """Return every key of a machine file, by its dotted path, with its value in one line."""
    return tuple((path_text(path), _short(value)) for path, value in leaves(tree_of(origin)))


def tree_of(origin: Origin) -> Tree:
    """Return a file that was read without a fault as mappings, lists and texts, with what is set over it."""
    tree: Tree = parse(origin.text, Reading())
    set_over(tree, origin)
    return tree


def leaves(node: Any, path: Path = ()) -> Iterator[tuple[Path, Any]]:
    """Yield the keys of a tree below which no key stands, each by its path with its value: a text or a list."""
    if isinstance(node, dict):
        for name, below in node.items():
            yield from leaves(below, (*path, name))
    elif isinstance(node, list) and any(isinstance(one, dict) for one in node):
        for number, below in enumerate(node):
            yield from leaves(below, (*path, number))
    else:
        yield path, node


def _short(value: Any) -> str:
    """Return a value in one line; of a long list its ends, and how many there are."""
    if not isinstance(value, list):
        text = " ".join(str(value).split())
        return text if len(text) <= _LONGEST else f"{text[:_LONGEST]} …"
    shown = [_short(one) for one in value]
    if len(shown) > _MOST:
        return f"[{', '.join(shown[:3])}, …, {shown[-1]}] ({len(shown)} in all)"
    return f"[{', '.join(shown)}]"


def case_names(origin: Origin) -> tuple[str, ...]:
    """Return the names of the load cases of a file; raises UsageError where it has none."""
    cases = tree_of(origin).get("cases")
    names = [one.get("name") for one in cases if isinstance(one, dict)] if isinstance(cases, list) else []
    if not names and cases:
        raise UsageError("--cases: 'cases' of the file is no list of cases, each with a 'name'; see kurbel check")
    if not names:
        raise UsageError("--cases: the file has no 'cases'")
    return tuple(map(str, names))
