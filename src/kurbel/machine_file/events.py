"""From YAML text to dictionaries, lists and texts, event by event, with a guard at every event.

No recursion and no nodes: libyaml's own loader crashes on deep nesting and is slow on long lists. What a machine file
has no use for (anchors, aliases, tags, further documents) is refused when its event comes by, before anything is built
from it. Numbers stay text: what a scalar means is decided by the key that it stands under.
"""

from typing import Any

import yaml

from kurbel.declared.kinds import MOST_POINTS
from kurbel.declared.reading import REFUSED, Plain, Reading, StopReading, shown
from kurbel.errors import Fault, Path, Step

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
        from kurbel.machine_file.syntax import explain

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
