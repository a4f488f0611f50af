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

    def place_of(fault: Fault) -> TextPosition:
        exact = None if fault.at_key else parser.values.get(fault.path)
        parts = (fault.path[:length] for length in range(len(fault.path), -1, -1))
        return exact or next((parser.keys[part] for part in parts if part in parser.keys), (0, 0))

    return [fault.at(*place_of(fault)) for fault in faults]


class Parser:
    """Builds the tree of a text and reports faults; locating: also collects the places.

    keys: path -> place of keys, and of values that have no key or are no text; values: path -> place of texts.
    """

    def __init__(self, text: str, reading: Reading, locating: bool = False) -> None:
        self.text, self.reading, self.locating = text, reading, locating
        self.keys: dict[Path, TextPosition] = {}
        self.values: dict[Path, TextPosition] = {}
        self._path: list[Step] = []
        self._scalars = 0
        self._events: Iterator[yaml.Event] = yaml.parse(
            text, Loader=yaml.CSafeLoader if yaml.__with_libyaml__ else yaml.SafeLoader
        )

    def document(self) -> Node:
        """Return the tree of the only document."""
        tree: Node | None = None
        try:
            for event in self._events:
                if isinstance(event, yaml.DocumentStartEvent):
                    if tree is not None:
                        second = "a second document begins here; a file describes one machine, leave out '---'"
                        self._stop(event, second)
                    tree = self._node(next(self._events))
        except StopReading:
            return REFUSED
        except yaml.MarkedYAMLError as error:
            self.reading.faults.append(explain(error, yaml_lines(self.text)))
            return REFUSED
        return Plain() if tree is None else tree

    def _node(self, event: yaml.Event) -> Node:
        """Return what an event begins, where the path leads to; REFUSED if anything but its content is wrong."""
        found: Node = REFUSED
        if isinstance(event, yaml.ScalarEvent):
            self._scalars += 1
            if self._scalars > _MOST_SCALARS:
                what = f"more than {_MOST_SCALARS} values; put measurements into a file and name it under 'trace'"
                self._stop(event, what)
            found = event.value if event.style else Plain(event.value)
        if self.locating:
            # an empty value is pointed at by its key, as is a mapping or a list; items of a list have no key
            places = self.values if found and found is not REFUSED else self.keys
            places.setdefault(tuple(self._path), _place_of(event))
        wrong = self._guard(event)
        if isinstance(event, yaml.CollectionStartEvent):
            if len(self._path) >= DEPTH_LIMIT:
                self._stop(event, _TOO_DEEP)
            found = self._mapping() if isinstance(event, yaml.MappingStartEvent) else self._items()
        return REFUSED if wrong else found

    def _below(self, step: Step, event: yaml.Event) -> Node:
        """Return what an event begins one step further down."""
        self._path.append(step)
        found = self._node(event)
        self._path.pop()
        return found

    def _items(self) -> list[Node]:
        """Return the list that has begun."""
        items: list[Node] = []
        while not isinstance(event := next(self._events), yaml.SequenceEndEvent):
            items.append(self._below(len(items), event))
        return items

    def _mapping(self) -> Node:
        """Return the mapping that has begun; REFUSED if one of its keys is no text."""
        found: Tree = {}
        whole = True
        while not isinstance(event := next(self._events), yaml.MappingEndEvent):
            name = str(event.value) if isinstance(event, yaml.ScalarEvent) else "?"
            if isinstance(event, yaml.CollectionStartEvent):
                wrong = self._report(event, "a key must be a plain text, not a list or a mapping")
                self._below(name, event)
            else:
                wrong = self._guard(event)
                wrong = (
                    self._report(event, "a key is missing before the colon") if not name else wrong
                )
                self._scalars += 1
            if self.locating:
                self.keys.setdefault((*self._path, name), _place_of(event))
            self._path.append(name)
            twice = (
                name in found
                and name != "?"
                and self._report(event, "given twice; leave one of them out")
            )
            self._path.pop()
            value = self._below(name, next(self._events))
            found[name] = REFUSED if twice else value
            whole = whole and not wrong
        return found if whole else REFUSED

    def _guard(self, event: Any) -> bool:
        """Note a tag, an anchor or an alias, and return whether there is one."""
        if isinstance(event, yaml.AliasEvent):
            return self._report(
                event,
                f"'*{text_in_one_line(str(event.anchor))}' is not supported; write the value itself{_LIKE}",
            )
        if event.tag is not None:
            tag = event.tag.replace("tag:yaml.org,2002:", "!!")
            return self._report(
                event, f"the tag '{text_in_one_line(tag)}' is not supported; leave it out"
            )
        if event.anchor is not None:
            what = f"'&{text_in_one_line(event.anchor)}' is not supported; write the value wherever it is needed{_LIKE}"
            return self._report(event, what)
        return False

    def _report(self, event: yaml.Event, message: str) -> bool:
        self.reading.note(Fault(tuple(self._path), message).at(*_place_of(event)))
        return True

    def _stop(self, event: yaml.Event, message: str) -> NoReturn:
        self._path.clear()
        self._report(event, message)
        raise StopReading


def _place_of(event: yaml.Event) -> TextPosition:
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
    last = len(lines) - 1, len(lines[-1])
    here, begin = (min((one.line, one.column), last) for one in (mark, opened))
    before, after = lines[here[0]][: here[1]], lines[here[0]][here[1] :]
    context, problem, sign = error.context or "", error.problem or "", after[:1]
    second, colon = "mapping values" in problem, "could not find expected ':'" in problem
    # a key without a space after its colon is in or just above these lines
    above = range(here[0], max(begin[0] - 2, -1), -1) if second or colon else ()
    glued, key, value = next(
        ((n, *found[0]) for n in above if (found := _GLUED.findall(lines[n]))), (-1, "", "")
    )
    lone, _, rest = lines[begin[0]].strip().partition(" ")
    bracket = "]" if "sequence" in context else "}"
    no_start = "cannot start any token" in problem or "node content" in problem
    table = (
        (
            "tab character" in problem or sign == "\t",
            here,
            "a tab in the indentation; indent with spaces",
        ),
        ("nesting depth" in problem, begin, _TOO_DEEP),
        (
            "quoted scalar" in context and "end of stream" in problem,
            begin,
            "the quotation mark that opens here is never closed",
        ),
        (
            "flow sequence" in context or "flow mapping" in context,
            here,
            f"a comma or '{bracket}' is missing; the bracket was opened at line {begin[0] + 1}, column {begin[1] + 1}",
        ),
        (sign == ":" and not before.strip(), here, "a key is missing before the colon"),
        (
            glued >= 0,
            (glued, len(lines[glued]) - len(value)),
            f"a space is missing after the colon; write '{text_in_one_line(key)}: {text_in_one_line(value.strip())}'",
        ),
        (
            colon and rest,
            begin,
            f"a colon is missing in this line; write '{text_in_one_line(lone)}: {text_in_one_line(rest.strip())}'",
        ),
        (colon, begin, "a colon is missing in this line; write 'key: value'"),
        (
            second and ":" in before,
            here,
            "a second colon in one line; put a text with a colon into quotation marks",
        ),
        (
            second,
            here,
            "this key is indented deeper than the line above it; give both the same indentation",
        ),
        (
            "block mapping" in context or "block collection" in context,
            here,
            "this line does not fit the lines above it; keys of one mapping have the same indentation",
        ),
        (
            no_start and not after.strip(),
            here,
            "a value is missing here: close the '[' or '{' that is open, or put the text into quotation marks",
        ),
        (no_start, here, f"a value cannot begin with '{sign}'; put a text into quotation marks"),
        (
            "sequence entries" in problem,
            here,
            "a list with '-' begins on a line of its own; or write it as [ …, … ]",
        ),
        (
            "escape" in problem,
            here,
            "unknown escape in a text; within double quotation marks write '\\\\' for a backslash",
        ),
        ("document start" in problem, here, f"'{sign}' after the end of the machine; remove it"),
        (True, here, f"this is no YAML: {problem or context}"),
    )
    message, place = next((message, place) for found, place, message in table if found)
    return Fault((), message).at(*place)
