"""The answers of every command for many machines, written to a file and compared with those of another one:

    python tests/freeze.py write OUT
    python tests/freeze.py compare OLD NEW [--tight]

What is frozen stands in `frozen_runs`.
"""

from __future__ import annotations

import json
import lzma
import math
import os
import re
import sys
from collections import defaultdict
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from frozen_runs import (
    NO_MACHINE,
    Answer,
    among_traces,
    answer_of,
    hash_of,
    machine_lines,
    machine_text,
    names,
    plain_lines,
)

KEPT = Path(__file__).parent / "frozen.json.xz"
DRAWN = 110
"""Random machines that can be read; those that cannot on the way are frozen with their messages."""
Record = dict[str, Any]
"""By the name of a machine: a hash of its text, and its answers by command line."""

FIGURES, ANGLE = 1e-11, 1e-7
"""Of the largest value of a quantity, and in degrees; --tight: 1e-12 and 1e-9, but 1e-9 and 1e-7 of a coupling."""
TERMS = 1e-13
"""Of the largest value of one unit in an answer: what a sum may lose where its terms cancel."""


def write(path: Path) -> None:
    """Write the answers of all runs; of random machines until enough could be read."""
    plain = {line: answer_of(NO_MACHINE, line) for line in plain_lines()}
    texts, left, every = [_written(NO_MACHINE, plain)], DRAWN, names()
    with among_traces():
        while left:
            machine, answers = next(every), dict[str, Answer]()
            for line in machine_lines(machine, answers):
                answers[line] = answer_of(machine, line)
            texts.append(_written(machine, answers))
            left -= machine.startswith("random") and len(answers) > 1
    path.write_bytes(lzma.compress(f"{{{','.join(texts)}}}".encode()))


def _written(machine: str, answers: dict[str, Answer]) -> str:
    record = {"hash": hash_of(machine), "answers": answers}
    return f"{json.dumps(machine)}:{json.dumps(record, ensure_ascii=False, separators=(',', ':'))}"


def read(path: Path) -> Record:
    return dict(json.loads(lzma.decompress(path.read_bytes())))


# comparing


class Figures(NamedTuple):
    """The values of a column or key value; group: where quantities stand that share its size."""

    id: str
    unit: str
    group: tuple[str, ...]
    values: list[float]

    @property
    def family(self) -> tuple[object, ...]:
        """What the largest value is taken of: T_min counts with T_max, and in a table what has the same unit."""
        if "place_tables" in str(self.group) and self.unit:
            return (self.group, self.unit)
        return (self.group, re.sub(r"_(max|min|peak|mean|high|dc|best|least|book)(?=_|$)", "", self.id))


class Difference(NamedTuple):
    """Where two answers differ, and by how many times what is allowed."""

    excess: float
    command: str
    id: str
    machine: str
    text: str


def leaves(node: Any, path: tuple[str, ...] = (), group: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], Any]]:
    """Yield what an answer holds, by place: figures, and all else as it is."""
    if isinstance(node, dict) and ("values" in node or "value" in node):
        values, at = node.get("values", node.get("value")), node.get("at_deg")
        yield path, Figures(node["id"], node.get("unit", ""), group, list(_numbers(values)))
        yield (*path, "form"), [node.get("symbol"), node.get("unit"), _form(values), at is None]
        if at is not None:
            yield (*path, "at"), Figures(f"{node['id']} at", "deg", group, [at])
    elif isinstance(node, dict):
        for key, one in node.items():
            yield from leaves(one, (*path, key), path)
    elif (
        isinstance(node, list) and node and all(isinstance(one, dict) and {"id", "columns"} & set(one) for one in node)
    ):
        for index, one in enumerate(node):
            yield from leaves(one, (*path, one.get("id") or f"{index} {one.get('name', '')}".strip()), group)
    else:
        yield path, node


def _numbers(node: Any) -> Iterator[float]:
    if isinstance(node, list):
        for one in node:
            yield from _numbers(one)
    elif isinstance(node, (int, float)) and not isinstance(node, bool):
        yield float(node)


def _form(node: Any) -> Any:
    """Return values with their numbers blotted out: how many there are, what is missing, words."""
    if isinstance(node, list):
        return [_form(one) for one in node]
    return 0 if isinstance(node, (int, float)) and not isinstance(node, bool) else node


class Judge:
    """Two answers of one run, and what their figures may differ by."""

    def __init__(self, machine: str, line: str, old: Answer, new: Answer, tight: bool) -> None:
        self.machine, self.line, self.command = machine, line, line.split()[0]
        self.old, self.new = dict(leaves(old)), dict(leaves(new))
        coupled = self.command in ("flywheel", "sweep") and "coupling:" in machine_text(machine)
        self.share, self.angle = (FIGURES, ANGLE) if not tight else (1e-9, 1e-7) if coupled else (1e-12, 1e-9)
        self.sizes: dict[object, float] = defaultdict(float)
        for one in (*self.old.values(), *self.new.values()):
            if isinstance(one, Figures):
                for key in (one.family, one.unit):
                    self.sizes[key] = max(map(abs, (self.sizes[key], *one.values)))

    def differences(self) -> Iterator[Difference]:
        """Yield what differs by more than is allowed."""
        for path in dict.fromkeys([*self.old, *self.new]):
            one, other = self.old.get(path, "nothing"), self.new.get(path, "nothing")
            if one == other:
                continue
            if not (isinstance(one, Figures) and isinstance(other, Figures) and len(one.values) == len(other.values)):
                id = path[-2] if path[-1] in ("form", "at") else path[-1]
                yield self._difference(math.inf, id, path, _contrast(one, other))
                continue
            pairs = [*zip(one.values, other.values)]
            each = [abs(b - a) / max(self.allowed(one, index), 1e-300) for index, (a, b) in enumerate(pairs)]
            excess, (value, found) = max(zip(each, pairs))
            if excess > 1 and not (path[-1] == "at" and self.is_flat(one, value, found)):
                yield self._difference(excess, one.id, path, f"{value:.14g} -> {found:.14g} {one.unit}")

    def _difference(self, excess: float, id: str, path: tuple[str, ...], values: str) -> Difference:
        id = id.rpartition(".")[2]  # in a sweep, without its cylinder
        line = self.line if len(self.line) < 80 else f"{self.line[:80]} …"
        return Difference(excess, self.command, id, self.machine, f"{'.'.join(path)}: {values}   ({line})")

    def allowed(self, figures: Figures, index: int) -> float:
        """Return what a value may differ by; the direction of a small vector differs by more."""
        if figures.unit != "deg":
            terms = TERMS * self.sizes[figures.unit] if figures.unit else 0.0
            return self.share * self.sizes[figures.family] + terms
        vector = VECTORS.get(figures.id)
        for one in self.old.values():
            if isinstance(one, Figures) and (one.id, one.group) == (vector, figures.group) and one.values[index]:
                ratio = self.share * self.sizes[one.family] / abs(one.values[index])
                return max(self.angle, math.degrees(ratio))
        return self.angle

    def is_flat(self, figures: Figures, *angles: float) -> bool:
        """Whether the column of an extreme has the same size at both angles."""
        column = re.sub(r"_(max|min|peak) at$", "", figures.id)
        line = f"{self.command} - -f json --columns {column} --angles {angles[0]!r},{angles[1]!r}"
        for one in dict(leaves(answer_of(self.machine, line))).values():
            if isinstance(one, Figures) and (one.id, one.group, len(one.values)) == (column, figures.group, 2):
                return abs(abs(one.values[0]) - abs(one.values[1])) <= self.allowed(one, 0)
        return False


VECTORS = {"load_throw": "load", "load_engine": "load", "load_rod": "load", "M_phase": "M_amplitude"}
"""Columns that are directions, and those of their magnitudes."""


def _contrast(one: object, other: object) -> str:
    """Return two texts, or of two lists what only one of them has."""
    if isinstance(one, list) and isinstance(other, list) and one != other:
        one, other = (
            [each for each in one if each not in other] or one,
            [each for each in other if each not in one] or other,
        )
    short = [text if len(text) < 400 else f"{text[:400]} …" for text in (str(one), str(other))]
    return " -> ".join(short)


def compare(old: Record, new: Record, tight: bool = False) -> list[Difference]:
    """Return all differences of two records, the worst first."""
    found = []
    for machine in dict.fromkeys([*old, *new]):
        one, other = old.get(machine, {}), new.get(machine, {})
        if one.get("hash") != other.get("hash"):
            found.append(Difference(math.inf, "", "", machine, "is another machine, or stands in one record only"))
            continue
        for line in dict.fromkeys([*one["answers"], *other["answers"]]):
            if line in one["answers"] and line in other["answers"]:
                found += Judge(machine, line, one["answers"][line], other["answers"][line], tight).differences()
            else:
                found.append(Difference(math.inf, line.split()[0], "", machine, f"{line}: in one record only"))
    return sorted(found, key=lambda one: -one.excess)


def report(found: Iterable[Difference], shown: int = 4) -> str:
    """Return the differences by command and quantity, the worst first."""
    groups: dict[tuple[str, str], list[Difference]] = defaultdict(list)
    for one in found:
        groups[one.command, one.id].append(one)
    lines = []
    for (command, id), each in groups.items():
        lines.append(f"{command} {id}: {len(each)} differ, the worst by {each[0].excess:.3g} times what is allowed")
        lines += [f"    {one.excess:.3g}  {one.machine}  {one.text}" for one in each[:shown]]
    return "\n".join(lines)


def main(arguments: list[str]) -> int:
    if len(arguments) == 2 and arguments[0] == "write":
        write(Path(arguments[1]).absolute())
        return 0
    if len(arguments) in (3, 4) and arguments[0] == "compare" and arguments[3:] in ([], ["--tight"]):
        old, new = read(Path(arguments[1])), read(Path(arguments[2]))
        with among_traces():
            found = compare(old, new, bool(arguments[3:]))
        print(report(found) or "no differences")
        return 1 if found else 0
    print(__doc__)
    return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
