"""What is wrong with a text that is no YAML, in words that say what to write instead."""

import re
from typing import Any

from kurbel.declared.reading import shown
from kurbel.errors import Fault
from kurbel.machine.origin import lines_of

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
