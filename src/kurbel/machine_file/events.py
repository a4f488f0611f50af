"""From YAML text to dictionaries, lists and texts, event by event; and from a path back to its place in the text.

The loader of libyaml is not used, since it crashes on deep nesting and is slow on long lists. What a machine file does
not need (anchors, aliases, tags, further documents) is rejected at its event, before anything is built. Numbers stay
text, since their key decides what a text means.
"""

import re
from collections.abc import Iterator
from typing import Any, NoReturn

import yaml

from kurbel.declared.reading import (
    REFUSED,
    Node,
    Plain,
    Reading,
    StopReading,
    Tree,
    text_in_one_line,
)
from kurbel.declared.units import MOST_POINTS
from kurbel.errors import Fault, Path, Step
from kurbel.machine.origin import yaml_lines

DEPTH_LIMIT = 32
_TOO_DEEP = f"nested deeper than {DEPTH_LIMIT} levels; no machine needs that"
_LIKE = "; a cylinder may be 'like: NAME' of another"
_MOST_SCALARS = 3 * MOST_POINTS
TextPosition = tuple[int, int]
"""Line and column, both counted from 0."""


def parse(text: str, reading: Reading) -> Node:
    """Return the tree of a YAML text, after reporting faults of its YAML.

    The tree has REFUSED instead of faulty values; it is REFUSED as a whole if the text could not be read to its end.
    """
    return Parser(text, reading).document()


def located(text: str, faults: list[Fault]) -> list[Fault]:
    """Return faults with the places of their paths; the text has been read without a syntax error before.

    The place of a text or number is its own unless its key is meant; that of a mapping or list is its key. For a path
    that does not exist it is that of the part that does.
    """
    if not faults:
        return []
    parser = Parser(text, Reading(), locating=True)
    parser.document()

    return [fault.at(*parser.position(fault.path, fault.at_key)) for fault in faults]


class Parser:
    """Builds the tree of a text and reports faults; locating: also collects the places.

    keys: path -> place of keys, and of values that have no key or are no text; values: path -> place of texts.
    """

    def __init__(self, text: str, reading: Reading, locating: bool = False) -> None:
        self.text = text
        self.reading = reading
        self.locating = locating
        self.keys: dict[Path, TextPosition] = {}
        self.values: dict[Path, TextPosition] = {}
        self._path: list[Step] = []
        self._scalars = 0
        loader = yaml.CSafeLoader if yaml.__with_libyaml__ else yaml.SafeLoader
        self._events: Iterator[yaml.Event] = yaml.parse(text, Loader=loader)

    def document(self) -> Node:
        """Return the tree of the only document."""
        tree: Node | None = None
        try:
            for event in self._events:
                if isinstance(event, yaml.DocumentStartEvent):
                    if tree is not None:
                        self._stop(
                            event,
                            "a second document begins here; "
                            "a file describes one machine, leave out '---'",
                        )
                    tree = self._node(next(self._events))
        except StopReading:
            return REFUSED
        except yaml.MarkedYAMLError as error:
            self.reading.faults.append(explain(error, yaml_lines(self.text)))
            return REFUSED
        if tree is not None:
            return tree
        return Plain()

    def position(self, path: Path, at_key: bool) -> TextPosition:
        """Return where in the text a path is, or the part of it that exists; at_key: its key, not its value."""
        if path in self.values and not at_key:
            return self.values[path]
        for length in range(len(path), -1, -1):
            if path[:length] in self.keys:
                return self.keys[path[:length]]
        return 0, 0

    def _node(self, event: yaml.Event) -> Node:
        """Return what an event begins, where the path leads to; REFUSED if anything but its content is wrong."""
        node: Node = REFUSED
        if isinstance(event, yaml.ScalarEvent):
            self._scalars += 1
            if self._scalars > _MOST_SCALARS:
                self._stop(
                    event,
                    f"more than {_MOST_SCALARS} values; "
                    "put measurements into a file and name it under 'trace'",
                )
            node = event.value if event.style else Plain(event.value)
        if self.locating:
            # an empty value is pointed at by its key, as is a mapping or a list; items of a list have no key
            is_text = node is not REFUSED and node != ""
            positions = self.values if is_text else self.keys
            positions.setdefault(tuple(self._path), _position(event))
        is_unsupported = self._reports_unsupported(event)
        if isinstance(event, yaml.CollectionStartEvent):
            if len(self._path) >= DEPTH_LIMIT:
                self._stop(event, _TOO_DEEP)
            is_mapping = isinstance(event, yaml.MappingStartEvent)
            node = self._mapping() if is_mapping else self._items()
        return REFUSED if is_unsupported else node

    def _below(self, step: Step, event: yaml.Event) -> Node:
        """Return what an event begins one step further down."""
        self._path.append(step)
        node = self._node(event)
        self._path.pop()
        return node

    def _items(self) -> list[Node]:
        """Return the list that has begun."""
        items: list[Node] = []
        while not isinstance(event := next(self._events), yaml.SequenceEndEvent):
            items.append(self._below(len(items), event))
        return items

    def _mapping(self) -> Node:
        """Return the mapping that has begun; REFUSED if one of its keys is no text."""
        mapping: Tree = {}
        has_valid_keys = True
        while not isinstance(event := next(self._events), yaml.MappingEndEvent):
            # the key
            name = str(event.value) if isinstance(event, yaml.ScalarEvent) else "?"
            if isinstance(event, yaml.CollectionStartEvent):
                self._report(event, "a key must be a plain text, not a list or a mapping")
                has_valid_keys = False
                self._below(name, event)
            else:
                is_unsupported = self._reports_unsupported(event)
                if not name:
                    self._report(event, "a key is missing before the colon")
                has_valid_keys = has_valid_keys and bool(name) and not is_unsupported
                self._scalars += 1
            if self.locating:
                self.keys.setdefault((*self._path, name), _position(event))
            is_repeated = name in mapping and name != "?"
            if is_repeated:
                self._path.append(name)
                self._report(event, "given twice; leave one of them out")
                self._path.pop()
            # its value
            value = self._below(name, next(self._events))
            mapping[name] = REFUSED if is_repeated else value
        return mapping if has_valid_keys else REFUSED

    def _reports_unsupported(self, event: Any) -> bool:
        """Report a tag, an anchor or an alias, and return whether there is one."""
        if isinstance(event, yaml.AliasEvent):
            alias = text_in_one_line(str(event.anchor))
            message = f"'*{alias}' is not supported; write the value itself{_LIKE}"
        elif event.tag is not None:
            tag = text_in_one_line(event.tag.replace("tag:yaml.org,2002:", "!!"))
            message = f"the tag '{tag}' is not supported; leave it out"
        elif event.anchor is not None:
            anchor = text_in_one_line(event.anchor)
            message = f"'&{anchor}' is not supported; write the value wherever it is needed{_LIKE}"
        else:
            return False
        self._report(event, message)
        return True

    def _report(self, event: yaml.Event, message: str) -> None:
        """Note a fault at an event."""
        self.reading.note(Fault(tuple(self._path), message).at(*_position(event)))

    def _stop(self, event: yaml.Event, message: str) -> NoReturn:
        """Note a fault after which the rest cannot be read."""
        self._path.clear()
        self._report(event, message)
        raise StopReading


def _position(event: yaml.Event) -> TextPosition:
    """Return where an event begins in the text."""
    assert event.start_mark
    return event.start_mark.line, event.start_mark.column


_GLUED = re.compile(r"^[\s-]*([A-Za-z_]\w*):(?=[^\s/:])(.*)$")
"""A key without a space after its colon."""


def explain(error: yaml.MarkedYAMLError, lines: list[str]) -> Fault:
    """Return the fault for an error of the YAML scanner or parser, in a text of these lines."""
    mark = error.problem_mark or error.context_mark
    assert mark
    opened = error.context_mark or mark
    # the end of the text lies below the last line when that one is complete
    end = len(lines) - 1, len(lines[-1])
    here = min((mark.line, mark.column), end)
    begin = min((opened.line, opened.column), end)
    message, position = _explanation(error.context or "", error.problem or "", lines, here, begin)
    return Fault((), message).at(*position)


def _explanation(
    context: str, problem: str, lines: list[str], here: TextPosition, begin: TextPosition
) -> tuple[str, TextPosition]:
    """Return the message on an error of YAML, and where it is; begin: where the part of the text began that has it."""
    line, column = here
    before, after = lines[line][:column], lines[line][column:]
    sign = after[:1]
    # what holds wherever it occurs
    if "tab character" in problem or sign == "\t":
        return "a tab in the indentation; indent with spaces", here
    if "nesting depth" in problem:
        return _TOO_DEEP, begin
    if "quoted scalar" in context and "end of stream" in problem:
        return "the quotation mark that opens here is never closed", begin
    if "flow sequence" in context or "flow mapping" in context:
        bracket = "]" if "sequence" in context else "}"
        opening = f"line {begin[0] + 1}, column {begin[1] + 1}"
        return f"a comma or '{bracket}' is missing; the bracket was opened at {opening}", here
    # colons: one is missing, or a second one is in the line
    if sign == ":" and not before.strip():
        return "a key is missing before the colon", here
    has_second_key = "mapping values" in problem
    has_no_colon = "could not find expected ':'" in problem
    if has_second_key or has_no_colon:
        # a key without a space after its colon is in or just above these lines
        for number in range(line, max(begin[0] - 2, -1), -1):
            glued = _GLUED.search(lines[number])
            if glued:
                key = text_in_one_line(glued[1])
                value = text_in_one_line(glued[2].strip())
                message = f"a space is missing after the colon; write '{key}: {value}'"
                return message, (number, glued.start(2))
    if has_no_colon:
        key, _, value = lines[begin[0]].strip().partition(" ")
        written = "key: value"
        if value:
            written = f"{text_in_one_line(key)}: {text_in_one_line(value.strip())}"
        return f"a colon is missing in this line; write '{written}'", begin
    if has_second_key and ":" in before:
        return "a second colon in one line; put a text with a colon into quotation marks", here
    # lines that do not fit together
    if has_second_key:
        return (
            "this key is indented deeper than the line above it; give both the same indentation"
        ), here
    if "block mapping" in context or "block collection" in context:
        return (
            "this line does not fit the lines above it; "
            "keys of one mapping have the same indentation"
        ), here
    # values
    cannot_begin = "cannot start any token" in problem or "node content" in problem
    if cannot_begin and not after.strip():
        return (
            "a value is missing here: close the '[' or '{' that is open, "
            "or put the text into quotation marks"
        ), here
    if cannot_begin:
        return f"a value cannot begin with '{sign}'; put a text into quotation marks", here
    if "sequence entries" in problem:
        return "a list with '-' begins on a line of its own; or write it as [ …, … ]", here
    if "escape" in problem:
        return (
            "unknown escape in a text; within double quotation marks write '\\\\' for a backslash"
        ), here
    if "document start" in problem:
        return f"'{sign}' after the end of the machine; remove it", here
    return f"this is no YAML: {problem or context}", here
