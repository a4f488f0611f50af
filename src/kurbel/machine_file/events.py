"""From YAML text to dictionaries, lists and texts, event by event, with a guard at every event; and back to places.

No recursion and no nodes: libyaml's own loader crashes on deep nesting and is slow on long lists. What a machine file
has no use for (anchors, aliases, tags, further documents) is refused when its event comes by, before anything is built
from it. Numbers stay text: what a scalar means is decided by the key that it stands under.
"""

import re
from typing import Any

import yaml

from kurbel.declared.reading import REFUSED, Plain, Reading, StopReading, shown
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
    builder = Builder(reading)
    if not run(text, builder):
        return REFUSED
    root = builder.root
    # outer ones first: what lies inside a refused value may have been overwritten by a key given twice
    for path in sorted((fault.path for fault in reading.faults), key=len):
        root = _refused_at(root, path)
    return root


def run(text: str, builder: "Builder") -> bool:
    """Send all events of a text to the builder and return whether the text could be read to its end."""
    loader: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    handlers = {
        yaml.ScalarEvent: builder.scalar,
        yaml.MappingStartEvent: lambda event: builder.begin({}, event),
        yaml.SequenceStartEvent: lambda event: builder.begin([], event),
        yaml.MappingEndEvent: builder.end,
        yaml.SequenceEndEvent: builder.end,
        yaml.AliasEvent: builder.alias,
        yaml.DocumentStartEvent: builder.document,
    }
    try:
        for event in yaml.parse(text, Loader=loader):
            handler = handlers.get(type(event))
            if handler is not None:
                handler(event)
    except StopReading:
        return False
    except yaml.MarkedYAMLError as error:
        builder.reading.faults.append(explain(error, text))
        return False
    return True


def _refused_at(root: Any, path: Path) -> Any:
    """Return the tree with REFUSED at a path."""
    if not path or root is REFUSED:
        return REFUSED
    node = root
    for step in path[:-1]:
        node = node[step]
        if node is REFUSED:
            return root
    node[path[-1]] = REFUSED
    return root


class _OddKey(str):
    """Stands for a key that is no text."""

    __slots__ = ()


_ODD_KEY = _OddKey("?")


class Builder:
    """Builds the tree from the events and notes what is wrong.

    A mapping or list is put into its parent when it begins, so that the way down from the root is known at every event.
    """

    def __init__(self, reading: Reading) -> None:
        self.root: Any = Plain("")
        self.reading = reading
        self._open: list[dict[str, Any] | list[Any]] = []
        self._steps: list[Step] = []  # under which each of them stands; that of the root counts for nothing
        self._key: str | None = None  # of the innermost mapping, while its value is due
        self._documents = 0
        self._scalars = 0

    def scalar(self, event: Any) -> None:
        """Take a scalar: a key or a value."""
        self._scalars += 1
        if self._scalars > _MOST_SCALARS:
            what = f"more than {_MOST_SCALARS} values; put measurements into a file and name it under 'trace'"
            self._report(event, (), what)
            raise StopReading
        if event.tag is not None or event.anchor is not None:
            self._guard(event)
        self._place(event.value if event.style else Plain(event.value), event)

    def alias(self, event: Any) -> None:
        """Refuse an alias."""
        self._report(event, self._here(), f"'*{shown(event.anchor)}' is not supported; write the value itself{_LIKE}")
        if self._key is None and self._open and isinstance(self._open[-1], dict):
            self._key = _ODD_KEY
        else:
            self._place(REFUSED, event)

    def end(self, event: Any) -> None:
        """End the innermost mapping or list."""
        self._open.pop()
        if isinstance(self._steps.pop(), _OddKey):
            self._key = _ODD_KEY

    def document(self, event: Any) -> None:
        """Begin a document, the only one."""
        self._documents += 1
        if self._documents > 1:
            self._report(event, (), "a second document begins here; a file describes one machine, leave out '---'")
            raise StopReading

    def begin(self, container: dict[str, Any] | list[Any], event: Any) -> None:
        """Begin a mapping or list."""
        if event.tag is not None or event.anchor is not None:
            self._guard(event)
        if len(self._open) >= DEPTH_LIMIT:
            self._report(event, (), f"nested deeper than {DEPTH_LIMIT} levels; no machine needs that")
            raise StopReading
        step: Step = ""
        if self._open:
            step = self._step()
            if step is _ODD_KEY:
                self._report(event, self._here(), "a key must be a plain text, not a list or a mapping")
                self._key = _ODD_KEY
        self._place(container, event)
        self._open.append(container)
        self._steps.append(step)

    def _place(self, value: Any, event: Any) -> None:
        """Put a value into the innermost mapping or list, or take it as the next key."""
        if not self._open:
            self.root = value
            return
        top = self._open[-1]
        if isinstance(top, list):
            top.append(value)
        elif self._key is not None:
            top[self._key] = value
            self._key = None
        else:
            self._name(top, str(value), event)

    def _name(self, top: dict[str, Any], key: str, event: Any) -> None:
        if key in top:
            self._report(event, (*self._steps[1:], key), "given twice; leave one of them out")
        elif not key:
            self._report(event, self._here(), "a key is missing before the colon")
        self._key = key

    def _step(self) -> Step:
        """Return the step from the innermost mapping or list to the node of this event."""
        top = self._open[-1]
        if isinstance(top, list):
            return len(top)
        return _ODD_KEY if self._key is None else self._key

    def _here(self) -> Path:
        """Return the path of the node of this event; for a key, that of its mapping."""
        if not self._open:
            return ()
        step = self._step()
        return tuple(self._steps[1:]) if step is _ODD_KEY else (*self._steps[1:], step)

    def _guard(self, event: Any) -> None:
        if event.tag is not None:
            tag = event.tag.replace("tag:yaml.org,2002:", "!!")
            self._report(event, self._here(), f"the tag '{shown(tag)}' is not supported; leave it out")
        else:
            what = f"'&{shown(event.anchor)}' is not supported; write the value wherever it is needed{_LIKE}"
            self._report(event, self._here(), what)

    def _report(self, event: Any, path: Path, message: str) -> None:
        mark = event.start_mark
        self.reading.note(Fault(path, message).at(mark.line, mark.column))


_Place = tuple[int, int]


def located(text: str, faults: list[Fault]) -> list[Fault]:
    """Return faults that have a path each with its place; the text has been read without a syntax error before.

    Where the key is not meant, a text or number is pointed at itself, a mapping or list by its key. Of a path that does
    not exist, the part that does is pointed at.
    """
    locator = _Locator({fault.path[:length] for fault in faults for length in range(len(fault.path) + 1)})
    run(text, locator)
    return [fault.at(*locator.place_of(fault)) for fault in faults]


class _Locator(Builder):
    """Builds the tree once more and notes where the nodes on the way to the wanted paths begin."""

    def __init__(self, wanted: set[Path]) -> None:
        super().__init__(Reading())
        self._wanted = wanted
        self._keys: dict[Path, _Place] = {}
        self._values: dict[Path, _Place] = {}

    def place_of(self, fault: Fault) -> _Place:
        """Return the place, from 0, of the longest part of a path that the text has."""
        for length in range(len(fault.path), 0, -1):
            part = fault.path[:length]
            exact = part == fault.path and not fault.at_key
            place = (self._values.get(part) if exact else None) or self._keys.get(part)
            if place:
                return place
        return self._keys.get((), (0, 0))

    def _place(self, value: Any, event: Any) -> None:
        is_key = bool(self._open) and self._key is None and isinstance(self._open[-1], dict)
        path = (*self._steps[1:], str(value)) if is_key else self._here()
        if path in self._wanted:
            # an empty value is pointed at by its key, as is a mapping or a list; items of a list have no key
            noted = self._values if not is_key and isinstance(value, str) and value else self._keys
            noted.setdefault(path, (event.start_mark.line, event.start_mark.column))
            if not is_key:
                self._wanted.discard(path)
        if not self._wanted:
            raise StopReading
        super()._place(value, event)


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
        message = "a tab stands where the indentation belongs; indent with spaces"
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
        message = _without_colon(lines[begin.line])
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


def _without_colon(line: str) -> str:
    key, _, value = line.strip().partition(" ")
    written = f"{shown(key)}: {shown(value.strip())}" if value else "key: value"
    return f"a colon is missing in this line; write '{written}'"


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
        return f"'{line[column : column + 1]}' stands after the end of the machine; remove it"
    return f"this is no YAML: {problem or context}"
