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
from kurbel.errors import Fault, MachineFileError, Path, Step, UsageError, path_text
from kurbel.machine.origin import Origin
from kurbel.machine_file.events import parse
from kurbel.machine_file.source import decode
from kurbel.near_words import did_you_mean

_NUMBER = "[0-9]{1,9}"
_FIGURE = re.compile(rf"\s*(limits|expect)\s*\.(.+?)(?:[.[]({_NUMBER})]?)?\s*", re.DOTALL)
"""A limit or an expectation, whose key value may have a prefix; or one of its two bounds."""


_ALONE = {"connecting_rod": "mass"}
"""Keys whose value may be a number alone -> the key that it has in a mapping."""


class Override(NamedTuple):
    """One value that replaces that of the file: its text, for messages, its path, and the value.

    path_in_file: the path of the override itself, as in a load case; () for one from an option.
    """

    text: str
    path: Path
    value: Node
    path_in_file: Path = ()


def read_override(text: str, option: str = "--set") -> Override:
    """Return the override of a text such as `cylinders.0.bore=450 mm`; raises UsageError.

    >>> override = read_override("cylinders.0.bore=450 mm")
    >>> override.text, override.path, override.value
    ('--set cylinders.0.bore=450 mm', ('cylinders', 0, 'bore'), '450 mm')
    """
    written = f"{option} {text_in_one_line(text)}"
    key, equals, value = text.partition("=")
    path = path_of(key)
    if not equals or "" in path:
        example = f"{option} bore='450 mm', of one of several cylinders cylinders.0.bore='450 mm'"
        _refuse(written, f"write KEY=VALUE, such as {example}")
    if any(str(step).endswith(":") for step in path):
        _refuse(written, "write KEY=VALUE, without the colon")
    reading = Reading()
    try:  # half of a surrogate pair is no text: let the decoder say so
        tree = parse(decode(option, value.encode("utf-8", "surrogatepass")).text, reading)
    except MachineFileError as error:
        reading.faults += error.faults
    if reading.faults:
        _refuse(written, reading.faults[0].message)
    return Override(written, path, tree)


def _read_all(texts: Sequence[str], option: str) -> list[Override]:
    """Return the overrides that texts of an option are; raises UsageError for all that are none."""
    overrides: list[Override] = []
    messages: list[str] = []
    for text in texts:
        try:
            overrides.append(read_override(text, option))
        except UsageError as error:
            messages.append(str(error))
    if messages:
        raise UsageError("; ".join(messages))
    return overrides


def _refuse(override: str, reason: str) -> NoReturn:
    """Raise UsageError for an override."""
    raise UsageError(f"{override}: {reason}")


def path_of(key: str) -> Path:
    """Return the path that a dotted key is, the items of lists by their numbers.

    >>> path_of("cylinders[0].bore"), path_of("limits.machine.T_max")
    (('cylinders', 0, 'bore'), ('limits', 'machine.T_max'))
    """
    figure = _FIGURE.fullmatch(key)
    if figure:
        names = [group for group in figure.groups() if group is not None]
    else:
        names = key.replace("[", ".").replace("]", "").split(".")
    steps: list[Step] = []
    for name in map(str.strip, names):
        is_number = re.fullmatch(_NUMBER, name)
        steps.append(int(name) if is_number else name)
    return tuple(steps)


def dotted(path: Path) -> str:
    """Return a path as a key on the command line is written."""
    return ".".join(map(str, path))


def set_over(tree: Node, origin: Origin) -> list[Override]:
    """Put into the tree of a file what is set over it, and return that; raises UsageError.

    First the values of its load case, then its overrides, then what a sweep varies.
    """
    if not isinstance(tree, dict):
        return []
    overrides: list[Override] = []
    if origin.case:
        overrides += _case_overrides(tree, origin.case)
    overrides += _read_all(origin.overrides, "--set")
    overrides += _read_all(origin.varied, "--vary")
    for override in overrides:
        node: Node = tree
        for depth in range(len(override.path)):
            if node is not REFUSED:
                node = _step(node, override, depth)
    return overrides


def _cases(tree: Tree) -> dict[str, Path]:
    """Return the paths of the load cases of a file by their names."""
    cases = tree.get("cases")
    if not isinstance(cases, list):
        return {}
    return {
        str(case.get("name")): ("cases", index)
        for index, case in enumerate(cases)
        if isinstance(case, dict)
    }


def _case_overrides(tree: Tree, name: str) -> list[Override]:
    """Return the overrides of a load case of a file; raises UsageError where there is none of this name."""
    cases = _cases(tree)
    written_name = text_in_one_line(name)
    if name not in cases:
        if cases:
            available = f"there are {', '.join(map(text_in_one_line, cases))}"
        elif "cases" in tree:
            available = "'cases' of the file is no list of cases; see kurbel check"
        else:
            available = "the file has no 'cases'"
        hint = did_you_mean(name, tuple(cases))
        raise UsageError(f"--case {written_name}: no such load case{hint}; {available}")
    path: Path = (*cases[name], "set")
    values = value_at(tree, path)
    if not isinstance(values, dict):
        return []
    overrides = []
    for key, value in values.items():
        text = f"case {written_name}: {text_in_one_line(key)}"
        overrides.append(Override(text, path_of(key), value, (*path, key)))
    return overrides


def value_at(tree: Any, path: Path) -> Node | None:
    """Return what is at a path of a tree; None where there is nothing."""
    try:
        for step in path:
            tree = tree[step]
    except (KeyError, IndexError, TypeError):
        return None
    return tree


def _step(node: Node, override: Override, depth: int) -> Node:
    """Go one step down, or set the value at the last one, and return what is there; what leads to it is made."""
    path = override.path
    is_last = depth == len(path) - 1
    above = dotted(path[:depth])
    if isinstance(node, list):
        index = _index(node, override, depth)
        if is_last:
            node[index] = override.value
        return node[index]
    if not isinstance(node, dict):
        mapping = f"{path[depth - 1]}: {{…, {path[depth]}: …}}"
        advice = f"if it may be a mapping, write it as one in the file, '{mapping}'"
        reason = f"there is nothing below '{above}', which is {node_kind(node)}; {advice}"
        _refuse(override.text, reason)
    key = str(path[depth])
    if is_last:
        node[key] = override.value
    elif key in _ALONE and isinstance(node.get(key), str) and not is_nothing(node[key]):
        node[key] = {_ALONE[key]: node[key]}
    elif is_nothing(node.get(key, Plain())):
        is_list_needed = isinstance(path[depth + 1], int)
        if is_list_needed:
            _refuse(override.text, f"there is no list '{dotted(path[: depth + 1])}' in the file")
        node[key] = {}
    return node[key]


def _index(items: list[Node], override: Override, depth: int) -> int:
    """Return the index of an item of a list; raises UsageError for a step that is none."""
    step = override.path[depth]
    last = len(items) - 1
    if isinstance(step, int) and step <= last:
        return step
    # the item of this name was meant, or the last one
    meant = last
    for index, item in enumerate(items):
        if isinstance(item, dict) and item.get("name") == step:
            meant = index
            break
    above, below = override.path[:depth], override.path[depth + 1 :]
    written = dotted((*above, meant, *below))
    reason = f"'{dotted(above)}' is a list; its items are 0 to {last}: write {written}=…"
    _refuse(override.text, reason)


def with_override(fault: Fault, overrides: Sequence[Override]) -> Fault:
    """Return a fault with the override that caused it; any other fault with a list of all overrides."""
    for override in overrides:
        length = len(override.path)
        is_cause = [*map(str, fault.path[:length])] == [*map(str, override.path)]
        if is_cause and override.path_in_file:
            return fault._replace(path=(*override.path_in_file, *fault.path[length:]))
        if is_cause:
            return fault._replace(override=override.text)
    if not overrides:
        return fault
    texts = ", ".join(override.text for override in overrides)
    return fault._replace(message=f"{fault.message} (with {texts})")


# what a file gives, key by key, as it was read, with overrides and without defaults

_MOST = 12
_LONGEST = 160


def key_texts(origin: Origin) -> tuple[tuple[str, str], ...]:
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
        return
    has_mappings = isinstance(node, list) and any(isinstance(item, dict) for item in node)
    if isinstance(node, list) and has_mappings:
        for index, item in enumerate(node):
            yield from leaves(item, (*path, index))
        return
    yield path, node


def text_at(tree: Tree, key: str) -> str:
    """Return the text of a dotted key; raises UsageError where it has no value, with the key probably meant."""
    text = value_at(tree, path_of(key))
    if isinstance(text, str):
        return text
    # a key that was probably meant: the first that ends as this one, or one of nearly the same letters
    paths = []
    for path, value in leaves(tree):
        if isinstance(value, str) and path[0] != "uncertainty":
            paths.append(path)
    hint = did_you_mean(key, tuple(map(dotted, paths)))
    for path in reversed(paths):
        names = ".".join(step for step in path if isinstance(step, str))
        if f".{names}".endswith(f".{key}"):
            hint = f"; did you mean '{dotted(path)}'?"
    raise UsageError(f"the file has no value for this key{hint}")


def texts_at(origin: Origin, keys: Sequence[str]) -> list[str]:
    """Return the texts that a file has for these dotted keys; raises UsageError for a key without a value."""
    tree = tree_of(origin)
    texts = []
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
        if len(text) <= _LONGEST:
            return text
        return f"{text[:_LONGEST]} …"
    texts = [_short(item) for item in value]
    if len(texts) > _MOST:
        return f"[{', '.join(texts[:3])}, …, {texts[-1]}] ({len(texts)} in all)"
    return f"[{', '.join(texts)}]"


def case_names(origin: Origin) -> tuple[str, ...]:
    """Return the names of the load cases of a file; raises UsageError where it has none."""
    tree = tree_of(origin)
    names = tuple(_cases(tree))
    if names:
        return names
    if "cases" not in tree:
        raise UsageError("--cases: the file has no 'cases'")
    raise UsageError(
        "--cases: 'cases' of the file is no list of cases, each with a 'name'; see kurbel check"
    )


# the text of a file with other values under some of its keys; all else, comments too, stays as it is written


def rewritten(text: str, values: Mapping[str, str]) -> str:
    """Return the text of a machine file in which the values of these dotted keys are replaced.

    A new key is added at the end of the file, or at the beginning of its mapping. Raises UsageError for a key whose
    value is a list or a mapping.

    >>> rewritten("crank: 400 mm  # of 1905\\nrod: 2 m\\n", {"crank": "410 mm", "flywheel.inertia": "9 kg m2"})
    'crank: 410 mm  # of 1905\\nrod: 2 m\\nflywheel: {inertia: 9 kg m2}\\n'
    """
    for key, value in values.items():
        start, end, replacement = _edit(text, path_of(key), value)
        text = text[:start] + replacement + text[end:]
    return text


def _edit(text: str, path: Path, value: str) -> tuple[int, int, str]:
    """Return start and end of the text to be replaced, and the new text."""
    node = yaml.compose(text, Loader=yaml.SafeLoader)
    for depth, step in enumerate(path):
        # an item of a list
        items = node.value if isinstance(node, yaml.SequenceNode) else []
        if isinstance(step, int) and step < len(items):
            node = items[step]
            continue
        # a key of a mapping
        if not isinstance(node, yaml.MappingNode):
            raise UsageError(
                f"--write: '{dotted(path)}' is not written out in the file; write it there first"
            )
        values = [inner for key, inner in node.value if key.value == str(step)]
        if not values:
            return _new_key(text, node, path, depth, value)
        node = values[0]
    if not isinstance(node, yaml.ScalarNode):
        raise UsageError(f"--write: '{dotted(path)}' is no single value in the file")
    return node.start_mark.index, node.end_mark.index, value


def _new_key(
    text: str, mapping: yaml.MappingNode, path: Path, depth: int, value: str
) -> tuple[int, int, str]:
    """Return where in the text a key that its mapping does not have is added, and what.

    depth: number of steps of the path that lead to the mapping.
    """
    for step in reversed(path[depth + 1 :]):
        value = f"{{{step}: {value}}}"
    line = f"{path[depth]}: {value}"
    start = mapping.start_mark.index
    if mapping.flow_style:
        return start + 1, start + 1, f"{line}, "
    if depth == 0:
        break_before = "" if text.endswith("\n") else "\n"
        return len(text), len(text), f"{break_before}{line}\n"
    indent = " " * mapping.start_mark.column
    return start, start, f"{line}\n{indent}"
