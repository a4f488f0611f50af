"""A machine file by its dotted keys: what it gives, values set over it from outside, and its text with other values."""

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple, NoReturn

import yaml

from kurbel.declared.reading import (
    REFUSED,
    Node,
    Plain,
    Reading,
    Tree,
    is_nothing,
    node_kind,
    text_in_one_line,
)
from kurbel.errors import Fault, MachineFileError, Path, UsageError, path_text
from kurbel.machine.origin import Origin
from kurbel.machine_file.events import parse
from kurbel.machine_file.source import decode
from kurbel.near_words import did_you_mean

_NUMBER = "[0-9]{1,9}"
_FIGURE = re.compile(rf"\s*(limits|expect)\s*\.(.+?)(?:[.[]({_NUMBER})]?)?\s*", re.DOTALL)
"""A limit or an expectation, whose key value may have a prefix; or one of its two bounds."""


class Override(NamedTuple):
    """One value that replaces that of the file: as it was given, its path, and the value.

    place: its own path in the file, as in a load case; () for one from an option.
    """

    given: str
    path: Path
    value: Node
    place: Path = ()


def read_override(text: str, option: str = "--set") -> Override:
    """Return the override of a text such as `cylinders.0.bore=450 mm`; raises UsageError.

    >>> read_override("cylinders.0.bore=450 mm")
    Override(given='--set cylinders.0.bore=450 mm', path=('cylinders', 0, 'bore'), value='450 mm', place=())
    """
    given = f"{option} {text_in_one_line(text)}"
    key, equals, value = text.partition("=")
    path = path_of(key)
    if not equals or "" in path:
        one = f"{option} bore='450 mm'"
        _refused(
            given,
            f"write KEY=VALUE, such as {one}, of one of several cylinders cylinders.0.bore='450 mm'",
        )
    if any(str(step).endswith(":") for step in path):
        _refused(given, "write KEY=VALUE, without the colon")
    reading = Reading()
    try:  # half of a surrogate pair is no text: let the decoder say so
        tree = parse(decode(option, value.encode("utf-8", "surrogatepass")).text, reading)
    except MachineFileError as error:
        reading.faults += error.faults
    if reading.faults:
        _refused(given, reading.faults[0].message)
    return Override(given, path, tree)


def _read_all(texts: Sequence[str], option: str) -> list[Override]:
    """Return the overrides that texts of an option are; raises UsageError for all that are none."""
    found, wrong = [], list[str]()
    for text in texts:
        try:
            found.append(read_override(text, option))
        except UsageError as error:
            wrong.append(str(error))
    if wrong:
        raise UsageError("; ".join(wrong))
    return found


def _refused(given: str, why: str) -> NoReturn:
    raise UsageError(f"{given}: {why}")


def path_of(key: str) -> Path:
    """Return the path that a dotted key is, the items of lists by their numbers.

    >>> path_of("cylinders[0].bore"), path_of("limits.machine.T_max")
    (('cylinders', 0, 'bore'), ('limits', 'machine.T_max'))
    """
    if found := _FIGURE.fullmatch(key):
        steps = [group.strip() for group in found.groups() if group is not None]
    else:
        steps = [step.strip() for step in key.replace("[", ".").replace("]", "").split(".")]
    return tuple(int(step) if re.fullmatch(_NUMBER, step) else step for step in steps)


def dotted(path: Path) -> str:
    """Return a path as a key on the command line is written."""
    return ".".join(map(str, path))


def set_over(tree: Node, origin: Origin) -> list[Override]:
    """Put into the tree of a file what is set over it, and return that; raises UsageError.

    First the values of its load case, then its overrides, then what a sweep varies.
    """
    if not isinstance(tree, dict):
        return []
    overrides = [
        *(_of_case(tree, origin.case) if origin.case else ()),
        *_read_all(origin.overrides, "--set"),
        *_read_all(origin.varied, "--vary"),
    ]
    for override in overrides:
        node: Node = tree
        for place in range(len(override.path)):
            if node is not REFUSED:
                node = _step(node, override, place)
    return overrides


def _cases(tree: Tree) -> dict[str, Path]:
    """Return the paths of the load cases of a file by their names."""
    cases = tree.get("cases")
    listed = cases if isinstance(cases, list) else ()
    return {
        str(one.get("name")): ("cases", index)
        for index, one in enumerate(listed)
        if isinstance(one, dict)
    }


def _of_case(tree: Tree, name: str) -> Iterator[Override]:
    """Yield the overrides of a load case of a file; raises UsageError where there is none of this name."""
    named = _cases(tree)
    if name not in named:
        none = (
            "'cases' of the file is no list of cases; see kurbel check" if "cases" in tree else ""
        )
        there = (
            f"there are {', '.join(map(text_in_one_line, named))}"
            if named
            else none or "the file has no 'cases'"
        )
        raise UsageError(
            f"--case {text_in_one_line(name)}: no such load case{did_you_mean(name, tuple(named))}; {there}"
        )
    place: Path = (*named[name], "set")
    values = value_at(tree, place)
    for key, value in values.items() if isinstance(values, dict) else ():
        yield Override(
            f"case {text_in_one_line(name)}: {text_in_one_line(key)}",
            path_of(key),
            value,
            (*place, key),
        )


def value_at(tree: Any, path: Path) -> Node | None:
    """Return what is at a path of a tree; None where there is nothing."""
    try:
        for step in path:
            tree = tree[step]
    except (KeyError, IndexError, TypeError):
        return None
    return tree


def _step(node: Node, one: Override, place: int) -> Node:
    """Go one step down, or set the value at the last one, and return what is there; what leads to it is made."""
    step, last = one.path[place], place == len(one.path) - 1
    above = dotted(one.path[:place])
    if isinstance(node, list):
        if not isinstance(step, int) or step >= len(node):
            names = [item.get("name") if isinstance(item, dict) else None for item in node]
            meant = names.index(step) if step in names else len(node) - 1
            instead = dotted((*one.path[:place], meant, *one.path[place + 1 :]))
            _refused(
                one.given,
                f"'{above}' is a list; its items are 0 to {len(node) - 1}: write {instead}=…",
            )
        if last:
            node[step] = one.value
        return node[step]
    if not isinstance(node, dict):
        mapping = f"{one.path[place - 1]}: {{…, {step}: …}}"
        advice = f"if it may be a mapping, write it as one in the file, '{mapping}'"
        _refused(
            one.given, f"there is nothing below '{above}', which is {node_kind(node)}; {advice}"
        )
    if last:
        node[str(step)] = one.value
    elif is_nothing(node.get(str(step), Plain())):
        if isinstance(one.path[place + 1], int):
            _refused(one.given, f"there is no list '{dotted(one.path[: place + 1])}' in the file")
        node[str(step)] = {}
    return node[str(step)]


def named(fault: Fault, overrides: Sequence[Override]) -> Fault:
    """Return a fault with the override that caused it; any other fault with a list of all overrides."""
    for one in overrides:
        length = len(one.path)
        if [*map(str, fault.path[:length])] == [*map(str, one.path)]:
            return (
                fault._replace(path=(*one.place, *fault.path[length:]))
                if one.place
                else fault._replace(override=one.given)
            )
    listed = f" (with {', '.join(override.given for override in overrides)})" if overrides else ""
    return fault._replace(message=fault.message + listed)


# what a file gives, key by key, as it was read, with overrides and without defaults

_MOST = 12
_LONGEST = 160


def given(origin: Origin) -> tuple[tuple[str, str], ...]:
    """Return every key of a machine file, by its dotted path, with its value in one line."""
    return tuple((path_text(path), _short(value)) for path, value in leaves(tree_of(origin)))


def tree_of(origin: Origin) -> Tree:
    """Return the tree of a file that has been read without a fault, with its overrides."""
    tree = parse(origin.text, Reading())
    assert isinstance(tree, dict)
    set_over(tree, origin)
    return tree


def leaves(node: Node, path: Path = ()) -> Iterator[tuple[Path, Node]]:
    """Yield (path, value) of the keys of a tree that have no keys below them; a value is a text or a list."""
    if isinstance(node, dict):
        for name, below in node.items():
            yield from leaves(below, (*path, name))
    elif isinstance(node, list) and any(isinstance(one, dict) for one in node):
        for number, below in enumerate(node):
            yield from leaves(below, (*path, number))
    else:
        yield path, node


def text_at(tree: Tree, key: str) -> str:
    """Return the text of a dotted key; raises UsageError where it has no value, with the key probably meant."""
    text = value_at(tree, path_of(key))
    if isinstance(text, str):
        return text
    paths = [
        path for path, value in leaves(tree) if isinstance(value, str) and path[0] != "uncertainty"
    ]
    meant = did_you_mean(key, tuple(map(dotted, paths)))
    for path in reversed(paths):
        names = ".".join(step for step in path if isinstance(step, str))
        if f".{names}".endswith(f".{key}"):
            meant = f"; did you mean '{dotted(path)}'?"
    raise UsageError(f"the file has no value for this key{meant}")


def texts_at(origin: Origin, keys: Sequence[str]) -> list[str]:
    """Return the texts that a file has for these dotted keys; raises UsageError for a key without a value."""
    tree, texts = tree_of(origin), []
    for key in keys:
        try:
            texts.append(text_at(tree, key))
        except UsageError as error:
            raise UsageError(f"{text_in_one_line(key)}: {error}") from None
    return texts


def _short(value: Node) -> str:
    """Return a value in one line; a long list is shortened to its ends and its length."""
    if not isinstance(value, list):
        text = " ".join(str(value).split())
        return text if len(text) <= _LONGEST else f"{text[:_LONGEST]} …"
    shown = [_short(one) for one in value]
    if len(shown) > _MOST:
        return f"[{', '.join(shown[:3])}, …, {shown[-1]}] ({len(shown)} in all)"
    return f"[{', '.join(shown)}]"


def case_names(origin: Origin) -> tuple[str, ...]:
    """Return the names of the load cases of a file; raises UsageError where it has none."""
    tree = tree_of(origin)
    if names := tuple(_cases(tree)):
        return names
    none = "'cases' of the file is no list of cases, each with a 'name'; see kurbel check"
    wrong = none if "cases" in tree else "the file has no 'cases'"
    raise UsageError(f"--cases: {wrong}")


# the text of a file with other values under some of its keys; all else, comments too, stays as it is written


def rewritten(text: str, values: Mapping[str, str]) -> str:
    """Return the text of a machine file in which the values of these dotted keys are replaced.

    A new key is added at the end of the file, or at the beginning of its mapping. Raises UsageError for a key whose
    value is a list or a mapping.

    >>> rewritten("crank: 400 mm  # of 1905\\nrod: 2 m\\n", {"crank": "410 mm", "flywheel.inertia": "9 kg m2"})
    'crank: 410 mm  # of 1905\\nrod: 2 m\\nflywheel: {inertia: 9 kg m2}\\n'
    """
    for key, value in values.items():
        start, end, written = _edit(text, path_of(key), value)
        text = text[:start] + written + text[end:]
    return text


def _edit(text: str, path: Path, value: str) -> tuple[int, int, str]:
    """Return start and end of the text to be replaced, and the new text."""
    node = yaml.compose(text, Loader=yaml.SafeLoader)
    for place, step in enumerate(path):
        if isinstance(node, yaml.SequenceNode) and isinstance(step, int) and step < len(node.value):
            node = node.value[step]
            continue
        if not isinstance(node, yaml.MappingNode):
            raise UsageError(
                f"--write: '{dotted(path)}' is not written out in the file; write it there first"
            )
        inner = next((value for key, value in node.value if key.value == str(step)), None)
        if inner is not None:
            node = inner
            continue
        for missing in reversed(path[place + 1 :]):
            value = f"{{{missing}: {value}}}"
        if node.flow_style:
            start = node.start_mark.index + 1
            return start, start, f"{step}: {value}, "
        if not place:
            return len(text), len(text), "\n" * (not text.endswith("\n")) + f"{step}: {value}\n"
        start, indent = node.start_mark.index, " " * node.start_mark.column
        return start, start, f"{step}: {value}\n{indent}"
    if not isinstance(node, yaml.ScalarNode):
        raise UsageError(f"--write: '{dotted(path)}' is no single value in the file")
    return node.start_mark.index, node.end_mark.index, value
