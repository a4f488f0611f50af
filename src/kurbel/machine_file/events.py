"""From YAML text to dictionaries, lists and texts, event by event, with a guard at every event; and back to places.

No nodes of YAML's own: libyaml's loader crashes on deep nesting and is slow on long lists. What a machine file has no
use for (anchors, aliases, tags, further documents) is refused when its event comes by, before anything is built of it.
Numbers stay text: what a scalar means is decided by the key that it stands under.
"""

import re
from collections.abc import Iterator, Set
from typing import Any

import yaml

from kurbel.declared.reading import REFUSED, Plain, Reading, StopReading, Tree, shown
from kurbel.declared.units import MOST_POINTS
from kurbel.errors import Fault, Path, Step
from kurbel.machine.origin import lines_of

DEPTH_LIMIT = 32
_LIKE = "; a cylinder may be 'like: NAME' of another"
_MOST_SCALARS = 3 * MOST_POINTS


def parse(text: str, reading: Reading) -> Any:
    """Return the tree of a YAML text; what is wrong with it as YAML is noted.

    The tree has REFUSED in place of what was noted; it is REFUSED as a whole when the text could not be read to its
    end.
    """
    return Parser(text, reading).document()


def located(text: str, faults: list[Fault]) -> list[Fault]:
    """Return faults that have a path each with its place; the text has been read without a syntax error before.

    Where the key is not meant, a text or number is pointed at itself, a mapping or list by its key. Of a path that does
    not exist, the part that does is pointed at.
    """
    parser = Parser(text, Reading(), {fault.path[:length] for fault in faults for length in range(len(fault.path) + 1)})
    parser.document()

    def place_of(fault: Fault) -> tuple[int, int]:
        exact = None if fault.at_key else parser.values.get(fault.path)
        parts = (fault.path[:length] for length in range(len(fault.path), -1, -1))
        return exact or next((parser.keys[part] for part in parts if part in parser.keys), (0, 0))

    return [fault.at(*place_of(fault)) for fault in faults]


class Parser:
    """Builds the tree of a text and notes what is wrong, and where the wanted paths are.

    keys: places of keys, and of what has no key or no text of its own; values: those of texts; both counted from 0.
    """

    def __init__(self, text: str, reading: Reading, wanted: Set[Path] = frozenset()) -> None:
        self.text, self.reading, self.wanted = text, reading, set(wanted)
        self.keys: dict[Path, tuple[int, int]] = {}
        self.values: dict[Path, tuple[int, int]] = {}
        self._path: list[Step] = []
        self._scalars = 0
        self._events: Iterator[Any] = yaml.parse(text, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))

    def document(self) -> Any:
        """Return the tree of the only document."""
        tree: Any = None
        try:
            for event in self._events:
                if isinstance(event, yaml.DocumentStartEvent):
                    if tree is not None:
                        self._stop(
                            event, "a second document begins here; a file describes one machine, leave out '---'"
                        )
                    tree = self._node(next(self._events))
        except StopReading:
            return REFUSED
        except yaml.MarkedYAMLError as error:
            self.reading.faults.append(explain(error, self.text))
            return REFUSED
        return Plain("") if tree is None else tree

    def _node(self, event: Any) -> Any:
        """Return what an event begins, where the path leads to; REFUSED if anything but its content is wrong."""
        if isinstance(event, yaml.ScalarEvent):
            self._scalars += 1
            if self._scalars > _MOST_SCALARS:
                what = f"more than {_MOST_SCALARS} values; put measurements into a file and name it under 'trace'"
                self._stop(event, what)
        if self.wanted:
            self._locate(event)
        wrong = self._guard(event)
        if isinstance(event, yaml.AliasEvent):
            return REFUSED
        if isinstance(event, yaml.ScalarEvent):
            return REFUSED if wrong else event.value if event.style else Plain(event.value)
        if len(self._path) >= DEPTH_LIMIT:
            self._stop(event, f"nested deeper than {DEPTH_LIMIT} levels; no machine needs that")
        if isinstance(event, yaml.MappingStartEvent):
            mapping = self._mapping()
            return REFUSED if wrong else mapping
        items: list[Any] = []
        while not isinstance(inner := next(self._events), yaml.SequenceEndEvent):
            self._path.append(len(items))
            items.append(self._node(inner))
            self._path.pop()
        return REFUSED if wrong else items

    def _mapping(self) -> Any:
        """Return the mapping that has begun; REFUSED if one of its keys is no text."""
        found: Tree = {}
        whole = True
        while not isinstance(event := next(self._events), yaml.MappingEndEvent):
            if isinstance(event, yaml.ScalarEvent):
                name = str(event.value)
                self._scalars += 1
                wrong = self._guard(event)
                if not name:
                    wrong = self._report(event, "a key is missing before the colon")
                place: Path = (*self._path, name)
                if place in self.wanted:
                    self.keys.setdefault(place, _place_of(event))
            elif isinstance(event, yaml.AliasEvent):
                name, wrong = "?", self._guard(event)
            else:
                name, wrong = "?", self._report(event, "a key must be a plain text, not a list or a mapping")
                self._path.append(name)
                self._node(event)
                self._path.pop()
            self._path.append(name)
            twice = name in found and name != "?" and self._report(event, "given twice; leave one of them out")
            value = self._node(next(self._events))
            self._path.pop()
            found[name] = REFUSED if twice else value
            whole = whole and not wrong
        return found if whole else REFUSED

    def _guard(self, event: Any) -> bool:
        """Note a tag, an anchor or an alias, and return whether there is one."""
        if isinstance(event, yaml.AliasEvent):
            return self._report(event, f"'*{shown(str(event.anchor))}' is not supported; write the value itself{_LIKE}")
        if event.tag is not None:
            tag = event.tag.replace("tag:yaml.org,2002:", "!!")
            return self._report(event, f"the tag '{shown(tag)}' is not supported; leave it out")
        if event.anchor is not None:
            what = f"'&{shown(event.anchor)}' is not supported; write the value wherever it is needed{_LIKE}"
            return self._report(event, what)
        return False

    def _locate(self, event: Any) -> None:
        """Keep the place of a node that is wanted, and stop after the last of them."""
        path = tuple(self._path)
        if path in self.wanted:
            # an empty value is pointed at by its key, as is a mapping or a list; items of a list have no key
            text = isinstance(event, yaml.ScalarEvent) and event.value
            places = self.values if text else self.keys
            places.setdefault(path, _place_of(event))
            self.wanted.discard(path)
        if not self.wanted:
            raise StopReading

    def _report(self, event: Any, message: str) -> bool:
        self.reading.note(Fault(tuple(self._path), message).at(*_place_of(event)))
        return True

    def _stop(self, event: Any, message: str) -> None:
        self._path.clear()
        self._report(event, message)
        raise StopReading


def _place_of(event: Any) -> tuple[int, int]:
    return event.start_mark.line, event.start_mark.column


_GLUED = re.compile(r"^[\s-]*([A-Za-z_]\w*):(?=[^\s/:])(.*)$")


def explain(error: Any, text: str) -> Fault:
    """Return the fault that an error of the YAML scanner or parser stands for."""
    lines = lines_of(text)
    mark = error.problem_mark or error.context_mark
    begin = error.context_mark or mark
    # the end of the text lies below the last line when that one is complete
    line, column = (mark.line, mark.column) if mark.line < len(lines) else (len(lines) - 1, len(lines[-1]))
    context, problem, sign = error.context or "", error.problem or "", lines[line][column : column + 1]
    at_begin = "quoted scalar" in context and "end of stream" in problem
    if "tab character" in problem or sign == "\t":
        message = "a tab in the indentation; indent with spaces"
    elif at_begin:
        message = "the quotation mark that opens here is never closed"
    elif "flow sequence" in context or "flow mapping" in context:
        bracket, opened = "]" if "sequence" in context else "}", f"line {begin.line + 1}, column {begin.column + 1}"
        message = f"a comma or '{bracket}' is missing; the bracket was opened at {opened}"
    elif sign == ":" and not lines[line][:column].strip():
        message = "a key is missing before the colon"
    elif ("mapping values" in problem or "':'" in problem) and (glued := _glued(lines, begin.line, line)):
        return glued
    elif at_begin := "could not find expected ':'" in problem:
        key, _, value = lines[begin.line].strip().partition(" ")
        written = f"{shown(key)}: {shown(value.strip())}" if value else "key: value"
        message = f"a colon is missing in this line; write '{written}'"
    else:
        message = _words(context, problem, lines[line], column)
    return Fault((), message).at(*((begin.line, begin.column) if at_begin else (line, column)))


def _glued(lines: list[str], first: int, last: int) -> Fault | None:
    """Return the fault of a key without a space after its colon, in or just above these lines."""
    for number in range(last, max(first - 2, -1), -1):
        found = _GLUED.match(lines[number])
        if found:
            key, value = found.groups()
            message = f"a space is missing after the colon; write '{shown(key)}: {shown(value.strip())}'"
            return Fault((), message).at(number, found.start(2))
    return None


def _words(context: str, problem: str, line: str, column: int) -> str:
    if "mapping values" in problem:
        if ":" in line[:column]:
            return "a second colon in one line; put a text with a colon into quotation marks"
        return "this key is indented deeper than the line above it; give both the same indentation"
    if "block mapping" in context or "block collection" in context:
        return "this line does not fit the lines above it; keys of one mapping have the same indentation"
    if "cannot start any token" in problem or "node content" in problem:
        if not line[column:].strip():
            return "a value is missing here: close the '[' or '{' that is open, or put the text into quotation marks"
        return f"a value cannot begin with '{line[column : column + 1]}'; put a text into quotation marks"
    if "sequence entries" in problem:
        return "a list with '-' begins on a line of its own; or write it as [ …, … ]"
    if "escape" in problem:
        return "unknown escape in a text; within double quotation marks write '\\\\' for a backslash"
    if "document start" in problem:
        return f"'{line[column : column + 1]}' after the end of the machine; remove it"
    return f"this is no YAML: {problem or context}"
