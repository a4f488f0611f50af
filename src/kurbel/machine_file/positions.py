"""Line and column of what is wrong, found by reading the text a second time: a good file pays nothing for it."""

from typing import Any

from kurbel.declared.reading import Reading, StopReading
from kurbel.errors import Fault, Path
from kurbel.machine_file.events import Builder, run

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
