"""What is wrong with a text that is no YAML, in words that say what to write instead."""

from __future__ import annotations

import re
from typing import Any

from kurbel.machine_file.events import Mistake
from kurbel.machine_file.source import Place, Source, shown

_GLUED = re.compile(r"^[\s-]*([A-Za-z_]\w*):(?=[^\s/:])(.*)$")


def explain(error: Any, text: str) -> Mistake:
    """Return the mistake that an error of the YAML scanner or parser stands for."""
    lines = Source("", text).lines()
    mark = error.problem_mark or error.context_mark
    begin = error.context_mark or mark
    # the end of the text lies below the last line when that one is complete
    place = Place(mark.line, mark.column) if mark.line < len(lines) else Place(len(lines) - 1, len(lines[-1]))
    context, problem = error.context or "", error.problem or ""
    if "tab character" in problem or _at(lines, place) == "\t":
        return Mistake(place, (), "a tab stands where the indentation belongs; indent with spaces")
    opened = f"line {begin.line + 1}, column {begin.column + 1}"
    if "quoted scalar" in context and "end of stream" in problem:
        return Mistake(Place(begin.line, begin.column), (), "the quotation mark that opens here is never closed")
    if "flow sequence" in context or "flow mapping" in context:
        bracket = "]" if "sequence" in context else "}"
        return Mistake(place, (), f"a comma or '{bracket}' is missing; the bracket was opened at {opened}")
    if _at(lines, place) == ":" and not lines[place.line][: place.column].strip():
        return Mistake(place, (), "a key is missing before the colon")
    glued = _glued(lines, begin.line, place.line)
    if glued and ("mapping values" in problem or "':'" in problem):
        return glued
    if "could not find expected ':'" in problem:
        return Mistake(Place(begin.line, begin.column), (), _without_colon(lines[begin.line]))
    return Mistake(place, (), _words(context, problem, lines, place))


def _at(lines: list[str], place: Place) -> str:
    return lines[place.line][place.column : place.column + 1]


def _glued(lines: list[str], first: int, last: int) -> Mistake | None:
    """Return the mistake of a key without a space after its colon, in or just above these lines."""
    for number in range(last, max(first - 2, -1), -1):
        found = _GLUED.match(lines[number])
        if found:
            key, value = found.groups()
            message = f"a space is missing after the colon; write '{shown(key)}: {shown(value.strip())}'"
            return Mistake(Place(number, found.start(2)), (), message)
    return None


def _without_colon(line: str) -> str:
    key, _, value = line.strip().partition(" ")
    written = f"{shown(key)}: {shown(value.strip())}" if value else "key: value"
    return f"a colon is missing in this line; write '{written}'"


def _words(context: str, problem: str, lines: list[str], place: Place) -> str:
    if "mapping values" in problem:
        if lines[place.line][: place.column].count(":"):
            return "a second colon in one line; put a text with a colon into quotation marks"
        return "this key is indented deeper than the line above it; give both the same indentation"
    if "block mapping" in context or "block collection" in context:
        return "this line does not fit the lines above it; keys of one mapping have the same indentation"
    if "cannot start any token" in problem or "node content" in problem:
        return f"a value cannot begin with '{_at(lines, place)}'; put a text into quotation marks"
    if "sequence entries" in problem:
        return "a list with '-' begins on a line of its own; or write it as [ …, … ]"
    if "escape" in problem:
        return "unknown escape in a text; within double quotation marks write '\\\\' for a backslash"
    if "document start" in problem:
        return f"'{_at(lines, place)}' stands after the end of the machine; remove it"
    return f"this is no YAML: {problem or context}"
