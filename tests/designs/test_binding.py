"""Machines that are bound to a file by columns of texts are those that are read one by one, and fail as these do."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest

from kurbel.designs.binding import Binder
from kurbel.errors import MachineFileError, path_text
from kurbel.machine import Machine
from kurbel.machine.batch import values_of
from kurbel.machine.origin import Origin
from kurbel.machine_file import source
from kurbel.machine_file.reader import read_machine


def described(value: Any) -> Any:
    """Everything that a record is made of, bit by bit, but for the file that it comes from."""
    if isinstance(value, np.ndarray):
        return value.tobytes()
    if isinstance(value, tuple):
        return tuple(map(described, value))
    if dataclasses.is_dataclass(value):
        return type(value), [(name, described(one)) for name, one in values_of(value).items() if name != "origin"]
    return repr(value)


def bound(file: Origin, keys: Sequence[str], start: Sequence[str], rows: Sequence[Sequence[str]]) -> dict[int, Any]:
    """What becomes of every row: a machine, or why there is none."""
    found = Binder(file, keys, start).bound(rows)
    machines = {row: batch.one(place) for batch in found.batches for place, row in enumerate(batch.rows)}
    return machines | found.failures


def read(file: Origin, keys: Sequence[str], texts: Sequence[str]) -> Machine | str:
    """The machine of a file with these values, or what is wrong with it."""
    try:
        return read_machine(file.set_over(f"{key}={text}" for key, text in zip(keys, texts)))
    except MachineFileError as error:
        faults = [f"{path_text(one.path)}: {one.message}" if one.path else one.message for one in error.faults]
        return "; ".join(re.sub(r" \(with --set .*\)$", "", one) for one in faults)


def same(found: Any, wanted: Any) -> bool:
    """Whether two machines are made of the same, or two failures tell the same, in whatever order."""
    if isinstance(found, str) and isinstance(wanted, str):
        return sorted(found.split("; ")) == sorted(wanted.split("; "))
    return bool(described(found) == described(wanted))


TWIN = """\
cycle: four-stroke
cylinders: {count: 3, bank_angles: [0 deg, 60 deg, 90 deg], each: {stroke: 80 mm, rod_ratio: 4}}
"""
PINS = TWIN.replace("bank_angles", "crank_positions")
LISTED = "cycle: four-stroke\ncylinders: [{stroke: 8 m, rod_ratio: 4}, {like: cylinder 1, crank_position: 9 deg}]\n"


@pytest.mark.parametrize(
    ("text", "key", "values"),
    [
        (TWIN, "cylinders.bank_angles.1", ("60 deg", "120 deg", "-60 deg", "359 deg", "0 deg", "90 deg")),
        (TWIN, "cycle", ("two-stroke", "four-stroke")),
        (TWIN, "cylinders.each.stroke", ("80 mm", "90 mm")),
        (PINS, "cylinders.crank_positions.2", ("90 deg", "240 deg", "450 deg", "360 deg", "-30 deg")),
        (LISTED, "cylinders.1.crank_position", ("0 deg", "90 deg", "450 deg")),
    ],
)
def test_each_row_fires_in_its_own_turns(text: str, key: str, values: Sequence[str]) -> None:
    file, rows = source.decode("m.yaml", text.encode()), [(value,) for value in values]
    found = bound(file, (key,), rows[0], rows)
    for row, texts in enumerate(rows):
        assert same(found[row], read(file, (key,), texts)), texts


LIKE = """
cylinders:
  - {name: a, crank: 1 m, rod: 5 m, bore: 1 m, masses: {piston: 3 kg}}
  - {name: b, like: a, crank_position: 90 deg, masses: {piston: 4 kg}}
  - {name: c, like: b, bore: 2 m, crank_position: 180 deg}
"""


def test_a_cylinder_that_is_like_another_varies_with_it() -> None:
    file = source.decode("m.yaml", LIKE.encode())
    rows = [("2 m", "5 kg"), ("3 m", "6 kg"), ("4 m", "-6 kg")]
    found = bound(file, ("cylinders.0.bore", "cylinders.1.masses.piston"), ("1 m", "4 kg"), rows)
    for row in (0, 1):
        assert same(found[row], read(file, ("cylinders.0.bore", "cylinders.1.masses.piston"), rows[row]))
    assert [one.pistons[0].bore for one in found[1].cylinders] == [3.0, 3.0, 2.0]
    assert [one.masses.parts for one in found[1].cylinders] == [3.0, 6.0, 6.0]
    assert found[2].startswith("cylinders[1].masses.piston: -6 kg is too small")
