"""Machines that are bound to a file by columns of texts are those that are read one by one, and fail as these do."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from good_machines import ALL
from kurbel.declared.forms.structures import RecordForm
from kurbel.declared.unit_systems import SI
from kurbel.declared.units import parse_quantity
from kurbel.designs.binding import Binder, _every, _owner
from kurbel.errors import MachineFileError, path_text
from kurbel.machine import Machine
from kurbel.machine.batch import values_of
from kurbel.machine.origin import Origin
from kurbel.machine_file import source
from kurbel.machine_file.given import tree_of
from kurbel.machine_file.overrides import path_of
from kurbel.machine_file.reader import ROOT, read_machine, read_values, reading_of

CONFIGS = Path(__file__).parent.parent.parent / "configs"


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
    machines = {row: lot.one(place) for lot in found.lots for place, row in enumerate(lot.rows)}
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


def numbers_of(tree: Any, path: str = "") -> Iterator[tuple[str, float, str]]:
    """The dotted keys of a file under which a number stands, with it and its unit."""
    for step, node in tree.items() if isinstance(tree, dict) else enumerate(tree):
        inner = f"{path}{step}"
        if not isinstance(node, str):
            yield from numbers_of(node, f"{inner}.")
        elif found := re.fullmatch(r"(-?[0-9.]+)(| [A-Za-z].*)", node):
            yield inner, float(found[1]), found[2]


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


FURTHER = (
    """\
speed: 300 rpm
brake_torque: 100 N m
crank: 100 mm
rod: 500 mm
bore: 200 mm
masses: {piston: 20 kg, connecting_rod: 30 kg}
friction: {crosshead: 0.05, guide: {length: 300 mm, width: 200 mm}, constant: 50 N, crank_pin: 0.01,
  crank_pin_diameter: 80 mm, crosshead_pin: 0.01, crosshead_pin_diameter: 60 mm, crosshead_pin_length: 90 mm,
  journals: 0.01, journal_diameter: 90 mm}
point: {from: crank_pin, along: 200 mm, across: 20 mm}
flywheel: {mass: 500 kg, radius_of_gyration: 800 mm}
counterweights: [{mass: 10 kg, radius: 120 mm, axial_position: 0.1 m}]
balance_shafts: [{product: 0.1 kg m, order: 2, sense: with}]
indicator: {head_end: 3 bar, crank_end: 1 bar}
axial_position: 0 m
""",
    "{crank: 1 m, rod: 5 m, flywheel: {rim: {outer_diameter: 3 m, inner_diameter: 2.4 m, width: 300 mm, "
    "density: 7300 kg/m3, allowable_tension: 5 MPa}}}",
    "{crank: 1 m, rod: 5 m, flywheel: {fluctuation: 1/80, rim: {mean_diameter: 3 m, depth: 200 mm, mass: 2 t}}}",
    "{crank: 1 m, rod: 5 m, bore: 1 m, indicator: {head_end: {drawn: {length: 92 mm, spring: 6 mm/at}, "
    "mean_height: 12 mm}, crank_end: {drawn: {length: 92 mm, spring: 6 mm/at}, area: 1104 mm2}}}",
    "{crank: 1 m, rod: 5 m, bore: 1 m, indicator: {head_end: {unit: bar, interpolate: polytropic, clearance: 0.1, "
    "expansion: [[0, 5], [1, 1]], compression: [[1, 1], [0, 5]]}, "
    "crank_end: {diesel: {intake: 0 bar, cut_off: 0.08, compression_ratio: 15}}}}",
    "{crank: 1 m, rod: 5 m, bore: 1 m, indicator: {head_end: {otto: {intake: 0 bar, peak: 40 bar, clearance: 0.15}}, "
    "crank_end: {steam: {admission: 8 bar, exhaust: 0.2 bar, cut_off: 0.3, clearance: 0.05, exponent: 1.1}}}}",
    "{mechanism: scotch-yoke, crank: 1 m}",
    "{mechanism: yoke-frame, crank: 1 m, rod_ratio: 5, offset: 10 mm, counterweights: {share: 0.5}}",
    "{mechanism: slotted-lever, crank: 0.3 m, frame: 0.8 m, lever: 1.3 m, link: 0.5 m, ram_height: 1.25 m}",
    "{shaft: [{inertia: 10 kg m2}, {stiffness: 1e6 N m/rad}, {inertia: 3 kg m2}, {gear: 2}, {inertia: 1 kg m2}, "
    "{stiffness: 1e5 N m/rad}, {inertia: 5 kg m2}]}",
)
"""Machines with the numbers that no other file has."""


def kinds_of_numbers() -> set[tuple[str, str]]:
    """The record and the key of every number that a machine file may have."""
    found = set()
    seen: set[int] = set()

    def visit(form: Any) -> None:
        if id(form) in seen:
            return
        seen.add(id(form))
        if isinstance(form, RecordForm):
            name = form.record.__name__
            found.update((name, key) for key, one in form.keys.items() if one.form.number)
        for _, inner in form.parts:
            visit(inner)
        for inner in form.inline:
            visit(inner)

    visit(ROOT)
    return found


def test_every_number_of_every_record_may_be_an_array() -> None:
    """Three values of each number of the shipped machines and of those of other tests, as arrays and one by one."""
    files = [source.read(path) for path in sorted(CONFIGS.glob("*.yaml"))]
    files += [source.decode("m.yaml", text.encode()) for text in (*ALL.values(), *FURTHER)]
    met: set[tuple[str, str]] = set()
    for file in files:
        for key, number, unit in numbers_of(tree_of(file)):
            if re.search(r"\.\d+\.\d+$|^kurbel$|^expect|^limits|uncertainty", key):
                continue
            text = f"{number!r}{unit}" if number != int(number) or unit else f"{int(number)}"
            owner, name, inner = _owner(path_of(key), list(_every(read_values(file, reading_of(file)))))
            one = (owner.form.record.__name__, name)
            if inner or one in met or not owner.form.keys[name].form.number:
                continue
            met.add(one)
            kind = owner.form.keys[name].form.kind
            values = parse_quantity(text, kind) * np.array([1.0, 0.999, 1.001])
            rows = [(f"{value!r} {SI[kind]}".rstrip(),) for value in values.tolist()]
            several = bound(file, (key,), (text,), rows)
            for row in (1, 2):
                assert same(several[row], bound(file, (key,), (text,), rows[row : row + 1])[0]), (key, row)
    traces = ("Known", "Measured", "Motored", "Pegging")  # are made one by one
    assert {one for one in kinds_of_numbers() - met if one[0] not in traces} == set()
