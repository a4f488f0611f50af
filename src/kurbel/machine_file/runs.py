"""Long runs of pairs, `[0, 1.2], [0.1, 1.3], …`, taken out of a text before YAML reads it.

YAML costs four events for every point, each with a dozen objects: 1e5 points took seconds, nearly all of them there. So
the pairs of a run are found by one pattern, and all but the first are blanked out, every line and column staying where
it is; where the event of that first pair comes by, the others follow it into its list.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from typing import NamedTuple

from kurbel.declared.bounds import MOST_POINTS
from kurbel.declared.numerals import NUMBER

_SHORTEST = 100  # pairs worth the trouble
_PAIR = re.compile(rf"\[ *({NUMBER.pattern}) *, *({NUMBER.pattern}) *\]")
_DASH = re.compile(r" *\r?\n *- +")
_BLANK = str.maketrans("0123456789+-.,eE[]", " " * 18)


class Run(NamedTuple):
    """Pairs that follow one in its list: in a list in brackets, or in one with dashes."""

    in_brackets: bool
    pairs: list[list[str]]


def without_runs(text: str, scalar: Callable[[str], str]) -> tuple[str, dict[int, Run]]:
    """Return a text with its long runs blanked out, and the runs by the index of the bracket of the pair before them.

    scalar: makes a number of the tree from its text. A run may also stand in a comment or a quotation: it counts only
    where YAML finds a list at that index.
    """
    pieces: list[str] = []
    runs: dict[int, Run] = {}
    done = 0
    if len(text) < 10 * _SHORTEST or text.count("[") > 2 * MOST_POINTS:
        return text, runs
    for first, run, end in _found(text, scalar):
        if len(run.pairs) >= _SHORTEST:
            begin = text.index("]", first) + 1
            pieces += [text[done:begin], text[begin:end].translate(_BLANK)]
            runs[first], done = run, end
    return "".join([*pieces, text[done:]]), runs


def _found(text: str, scalar: Callable[[str], str]) -> Iterator[tuple[int, Run, int]]:
    """Yield every run after the index of the pair before it, and before the index at which it ends."""
    first, end, gap = 0, 0, ""
    pairs: list[list[str]] = []
    for pair in _PAIR.finditer(text):
        start = pair.start()
        between = text[end:start]
        if not pairs:
            dashes = _DASH.fullmatch(between) and text.startswith(between, first - len(between))
            gap = between if dashes else ","
        if between == gap or (gap == "," and between.strip(" \r\n") == ","):
            pairs.append([scalar(pair[1]), scalar(pair[2])])
        else:
            yield first, Run(gap == ",", pairs), end
            first, pairs = start, []
        end = pair.end()
    yield first, Run(gap == ",", pairs), end
