"""Many machines at once answer as each alone: random machines of random kinds, with everything that bends or jumps."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from batches import batch
from kurbel import Machine, load, loads
from kurbel.designs.answers import Answer, Values, answered_alone, answers_of, is_slow, requested_answers
from kurbel.designs.binding import Batch
from kurbel.errors import KurbelError, RuleError
from kurbel.machine import Cylinder
from kurbel.machine.indicator import Indicator, Rectangle
from kurbel.machine.parts import Friction, Guide, Masses, Piston, RamForce
from kurbel.mechanisms.scotch_yoke import ScotchYoke
from kurbel.mechanisms.yoke_frame import YokeFrame
from kurbel.solver.case import Case
from random_cylinders import random_cylinder


def random_machine(random: np.random.Generator) -> Machine:
    """A machine with one cylinder; some lock themselves."""
    while True:
        try:
            drive = random_cylinder(random, friction=bool(random.integers(3))).drive
            return replace(drive.machine, cylinders=(varied(drive.cylinder, random),))
        except RuleError:
            continue


def varied(cylinder: Cylinder, random: np.random.Generator) -> Cylinder:
    """The cylinder, or one with another mechanism, a tandem piston, a greater friction, a ram or a shoe."""
    crank, kind = cylinder.mechanism.crank, random.integers(7)
    if kind == 0:
        yoke = ScotchYoke(crank, guide_length=3 * crank, pin_diameter=crank / 4, pin_length=crank / 3)
        return replace(cylinder, mechanism=yoke, friction=Friction(constant=50.0), masses=None)
    if kind == 1:
        frame = YokeFrame(crank, cylinder.mechanism.rod_length, 0.0, gland=crank)
        return replace(cylinder, mechanism=frame, friction=None)
    if kind == 2:
        pump = Piston(crank / 2, indicator=Indicator(Rectangle(mean=-random.uniform(1e5, 3e5))), name="pump")
        return replace(cylinder, pistons=(*cylinder.pistons, pump))
    if kind == 3:
        return replace(cylinder, friction=Friction(random.uniform(0.2, 3.0), guide=Guide(crank, crank / 2)))
    if kind == 4:
        return replace(cylinder, ram_force=RamForce(random.uniform(0, 1e3), random.uniform(0, 1e2)))
    return cylinder


def asked_of(machine: Machine) -> list[Answer]:
    known = Case(machine).cylinders[0].lists.key_values("forces").values()
    return [Answer(one, "forces", machine.cylinders[0].name) for one in known if not one.residual]


def with_angle(one: Answer) -> list[Answer]:
    """A key value, and the angle of an extreme."""
    return [one, one._replace(angle=True)] if one.quantity.id.rpartition("_")[2] in ("max", "min", "peak") else [one]


def together(machines: list[Machine], asked: list[Answer]) -> list[Values]:
    """What machines of one structure answer side by side, in their order."""
    found = answers_of([Batch(batch(machines), range(len(machines)))], asked)
    return [found[row] for row in range(len(machines))]


def alone(machine: Machine, asked: list[Answer]) -> Any:
    try:
        with np.errstate(all="ignore"):
            return answered_alone(machine, asked)
    except KurbelError as error:
        return str(error)


def farthest(asked: list[Answer], found: Any, single: Any) -> float:
    """The largest distance of what many and one answer; angles in turns, as those of lists."""
    pairs = zip(asked, found, single, strict=True)
    return max(distance((a,), (b,)) if one.angle and a is not None else distance(a, b) for one, a, b in pairs)


def distance(found: Any, single: Any) -> float:
    """By how much two values differ beside their size, inf for other kinds of values; lists of angles in turns."""
    if single is None or found is None:
        return 0.0 if single is found else math.inf
    if isinstance(single, tuple):
        if len(found) != len(single):
            return math.inf
        return max((abs(a - b) / 360 for a, b in zip(found, single)), default=0.0)
    return abs(found - single) / (abs(single) or 1)


def like(machine: Machine, by: float) -> Machine:
    """A machine whose numbers are a little larger."""

    def scaled(value: Any) -> Any:
        if isinstance(value, float):
            return value * by
        if isinstance(value, Piston):
            return replace(value, bore=value.bore * by)
        return replace(value, parts=value.parts * by) if isinstance(value, Masses) else value

    (cylinder,) = machine.cylinders
    parts = {one: scaled(getattr(cylinder, one)) for one in ("masses", "inclination")}
    other = replace(cylinder, pistons=tuple(map(scaled, cylinder.pistons)), **parts)
    return replace(machine, cylinders=(other,), speed=scaled(machine.speed), ambient=scaled(machine.ambient))


def worst(seed: int, count: int) -> tuple[float, int]:
    """Largest distance to the single answers of random machines, each with three like it, and how many of them fail."""
    random = np.random.default_rng(seed)
    largest, failures = 0.0, 0
    for first in (random_machine(random) for _ in range(count)):
        machines = [first, *(like(first, by) for by in (1.001, 1.01, 1.02))]
        asked = asked_of(first)
        for machine, values in zip(machines, together(machines, asked)):
            single = alone(machine, asked)
            if isinstance(single, str) or isinstance(values, str):
                assert values == single
                failures += 1
            else:
                largest = max(largest, farthest(asked, values, single))
    return largest, failures


def test_random_machines_answer_as_each_alone() -> None:
    largest, _ = worst(7, 8)
    assert largest <= 1e-12


CONFIGS = Path(__file__).parents[2] / "configs"
ALONE = {"coupled-axle", "crank-rocker", "diesel-trace", "punch", "shaper"}
"""Machines whose mechanism, or trace, is not for many side by side."""


@pytest.mark.parametrize("name", sorted({path.stem for path in CONFIGS.glob("*.yaml")} - ALONE))
def test_shipped_machines_answer_as_each_alone(name: str) -> None:
    """All that `forces` tells of them, which is answered side by side."""
    machines = [load(CONFIGS / f"{name}.yaml", overrides=[f"speed={speed} rpm"]) for speed in (61, 97, 149)]
    asked = [part for one in requested_answers(machines[0], ()) for part in with_angle(one)]
    assert not any(is_slow(machines[0], one) for one in asked)
    for machine, values in zip(machines, together(machines, asked)):
        assert farthest(asked, values, alone(machine, asked)) <= 1e-12


OTHER_COMMANDS = {
    "gas-engine": "dE M_max sigma_pin_max sigma_web_A_max safety_pin_min load_max load_mean unloaded_arc F_free_max",
    "four-cylinder-generator": "dE delta J omega_max alpha_max M_max E_max work_shaft",
    "four-in-line": "F_free_max F_free_best M_free_max M_roll_max",
    "locomotive-two-cylinders": "hammer_blow swaying_couple traction_variation F_free_best",
    "generator-coupling": "delta M_coupling_max amplification natural_order",
}
"""Key values of flywheel, stress, bearings and balance."""


@pytest.mark.parametrize("name", OTHER_COMMANDS)
def test_key_values_of_other_commands(name: str) -> None:
    machines = [load(CONFIGS / f"{name}.yaml", overrides=[f"speed={speed} rpm"]) for speed in (237, 251, 263)]
    asked = list(requested_answers(machines[0], OTHER_COMMANDS[name].split()))
    for machine, values in zip(machines, together(machines, asked)):
        single = alone(machine, asked)
        assert not isinstance(single, str), single
        assert farthest(asked, values, single) <= 1e-11


STEAM = """
speed: 50 rpm
stroke: 800 mm
rod_ratio: 5
bore: 450 mm
indicator:
  head_end:
    unit: at
    expansion: [[0, 9.5], [0.35, 9.5], [0.7, 4.7], [1, 2.2]]
    compression: [[1, 1.2], [0.25, 1.2], [0, 9.5]]
  crank_end: mirrored
masses: {piston: 830 kg}
friction: {crosshead: 0.1}
"""


def of_ratios(text: str, ratios: Any) -> list[Machine]:
    return [loads(text, overrides=[f"rod_ratio={ratio}"]) for ratio in ratios]


def test_one_that_locks_itself_fails_beside_others_with_the_reason_that_it_has_alone() -> None:
    text = STEAM.replace("crosshead: 0.1", "crosshead: 2") + "inclination: 0 deg\n"
    machines = of_ratios(text, [1.5, 2.2, 2.3, 3, 4, 5])
    asked = asked_of(machines[0])
    found = together(machines, asked)
    assert "locks itself near φ" in str(found[0])
    for values, machine in zip(found, machines):
        single = alone(machine, asked)
        assert values == single or farthest(asked, values, single) <= 1e-12
    assert not isinstance(found[-1], str)
