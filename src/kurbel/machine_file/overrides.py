"""Values set from outside over those of a machine file: `KEY=VALUE`, the key dotted, the value as in the file."""

import re
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, NamedTuple, NoReturn

from kurbel.declared.reading import REFUSED, Plain, Reading, Tree, is_nothing, kind_of, shown
from kurbel.errors import Fault, MachineFileError, Path, UsageError
from kurbel.machine_file.events import parse
from kurbel.machine_file.source import decode
from kurbel.near_words import did_you_mean

_NUMBER = "[0-9]{1,9}"
_FIGURE = re.compile(rf"\s*(limits|expect)\s*\.(.+?)(?:[.[]({_NUMBER})]?)?\s*", re.DOTALL)
"""A limit or an expectation, before whose key value may stand whose it is; or one of two bounds of it."""


class Override(NamedTuple):
    """One value in place of that of the file: as it was given, where it belongs, and what stands there.

    place: where in the file it is given itself, () for one from outside.
    """

    given: str
    path: Path
    value: Any
    place: Path = ()


def read_override(text: str, option: str = "--set") -> Override:
    """Return the override that a text `cylinders.0.bore=450 mm` of an option is; raises UsageError.

    >>> read_override("cylinders.0.bore=450 mm")
    Override(given='--set cylinders.0.bore=450 mm', path=('cylinders', 0, 'bore'), value='450 mm', place=())
    """
    given = f"{option} {shown(text)}"
    key, equals, value = text.partition("=")
    path = path_of(key)
    if not equals or "" in path:
        _refused(given, f"write KEY=VALUE, such as {option} cylinders.0.bore='450 mm'")
    if any(str(step).endswith(":") for step in path):
        _refused(given, "write KEY=VALUE, without the colon")
    reading = Reading()
    try:
        tree = parse(decode(option, _bytes(value)).text, reading)
    except MachineFileError as error:
        reading.faults += error.faults
    if reading.faults:
        _refused(given, reading.faults[0].message)
    return Override(given, path, tree)


def overrides_of_case(tree: Tree, name: str) -> Iterator[Override]:
    """Yield the overrides of a load case of a file; raises UsageError where there is none of this name."""
    cases: Any = tree.get("cases")
    listed = [one if isinstance(one, dict) else {} for one in (cases if isinstance(cases, list) else ())]
    named = {str(one.get("name")): index for index, one in enumerate(listed)}
    if name not in named:
        there = f"there are {', '.join(map(shown, named))}" if named else "the file has no 'cases'"
        raise UsageError(f"--case {shown(name)}: no such load case{did_you_mean(name, tuple(named))}; {there}")
    values = listed[named[name]].get("set")
    for key, value in values.items() if isinstance(values, dict) else ():
        yield Override(f"case {shown(name)}: {shown(key)}", path_of(key), value, ("cases", named[name], "set", key))


def _bytes(argument: str) -> bytes:
    """Return the bytes of an argument, which has those as surrogates that its locale does not read."""
    try:
        return argument.encode("utf-8", "surrogateescape")
    except UnicodeEncodeError:  # surrogates that stand for no byte are told by the decoder
        return argument.encode("utf-8", "surrogatepass")


def path_of(key: str) -> Path:
    """Return the path that a dotted key is, the items of lists by their numbers.

    >>> path_of("cylinders[0].bore"), path_of("limits.machine.T_max")
    (('cylinders', 0, 'bore'), ('limits', 'machine.T_max'))
    """
    if found := _FIGURE.fullmatch(key):
        steps = [one.strip() for one in found.groups() if one is not None]
    else:
        steps = [step.strip() for step in key.replace("[", ".").replace("]", "").split(".")]
    return tuple(int(step) if re.fullmatch(_NUMBER, step) else step for step in steps)


def _refused(given: str, why: str) -> NoReturn:
    raise UsageError(f"{given}: {why}")


def overridden(tree: Tree, overrides: Iterable[Override]) -> None:
    """Put the values into the tree; what leads there and is not given, is made. Raises UsageError."""
    for one in overrides:
        node: Any = tree
        for place, step in enumerate(one.path):
            if node is REFUSED:  # told already
                break
            node = _set(node, one, place, step)


def _set(node: Any, one: Override, place: int, step: str | int) -> Any:
    """Go one step down, or set the value at the last one, and return what stands there."""
    last = place == len(one.path) - 1
    if isinstance(node, list):
        if not isinstance(step, int) or step >= len(node):
            where, instead = dotted(one.path[:place]), (*one.path[:place], _near(step, node), *one.path[place + 1 :])
            items = f"its items are 0 to {len(node) - 1}: write {dotted(instead)}=…"
            _refused(one.given, f"'{where}' is a list; {items}")
        if last:
            node[step] = one.value
        return node[step]
    if not isinstance(node, dict):
        where = dotted(one.path[:place])
        _refused(one.given, f"nothing stands below '{where}', which is {kind_of(node)}")
    if last:
        node[str(step)] = one.value
    elif is_nothing(node.get(str(step), Plain())):
        if isinstance(one.path[place + 1], int):
            _refused(one.given, f"there is no list '{dotted(one.path[: place + 1])}' in the file")
        node[str(step)] = {}
    return node[str(step)]


def dotted(path: Path) -> str:
    """Return a path as a key on the command line is written."""
    return ".".join(map(str, path))


def _near(step: str | int, items: Sequence[Any]) -> int:
    """Return the item of a list that is probably meant: of that name, counted from its end, or else the last one."""
    names = [item.get("name") if isinstance(item, dict) else None for item in items]
    if step in names:
        return names.index(step)
    from_end = int(step) if re.fullmatch(f"-{_NUMBER}", str(step)) else -1
    return max(len(items) + from_end, 0)


def by_numbers(tree: Tree, key: str) -> str:
    """Return a dotted key with the numbers of the items of lists, where it calls them otherwise.

    >>> by_numbers({"cylinders": [{"name": "LP"}, {"name": "HP"}]}, "cylinders.HP.bore")
    'cylinders.1.bore'
    """
    node: Any = tree
    found: list[str | int] = []
    for step in path_of(key):
        if isinstance(node, list) and node:
            number = step if isinstance(step, int) and step < len(node) else _near(step, node)
            found.append(number)
            node = node[number]
        else:
            found.append(step)
            node = node.get(str(step)) if isinstance(node, dict) else None
    return dotted(tuple(found))


def named(faults: Iterable[Fault], overrides: Sequence[Override]) -> list[Fault]:
    """Return faults with the override that they are of; of others it is said that there are some."""
    beside = f" (with {', '.join(one.given for one in overrides)})"
    return [
        next(
            (_said_of(fault, one) for one in overrides if _is_of(fault, one)),
            fault._replace(message=fault.message + beside),
        )
        for fault in faults
    ]


def _said_of(fault: Fault, one: Override) -> Fault:
    """Return a fault of an override where that is given."""
    if one.place:
        return fault._replace(path=(*one.place, *fault.path[len(one.path) :]))
    return fault._replace(override=one.given)


def _is_of(fault: Fault, one: Override) -> bool:
    return tuple(map(str, fault.path[: len(one.path)])) == tuple(map(str, one.path))
