"""Displacement of a cylinder instead of its bore or its stroke, and compared with both: V = π/4 d² s by hand."""

import math
import re
from typing import Any

import numpy as np
import pytest

from kurbel.designs.api import sweep
from kurbel.errors import MachineFileError
from kurbel.machine_file import loads

REST = "rod_ratio: 4\nspeed: 3000 rpm\nindicator: {head_end: {mean_pressure: 5 bar}}\n"


def cylinder_of(text: str) -> Any:
    return loads(f"{text}\n{REST}").cylinders[0]


@pytest.mark.parametrize("stroke", ["stroke: 86 mm", "crank: 43 mm"])
def test_the_bore_of_a_displacement(stroke: str) -> None:
    (piston,) = cylinder_of(f"displacement: 500 cm3\n{stroke}").pistons
    assert piston.bore == pytest.approx(math.sqrt(5e-4 / 0.086 * 4 / math.pi), rel=1e-15)


def test_the_stroke_of_a_displacement() -> None:
    mechanism = cylinder_of("displacement: 500 cm3\nbore: 86 mm").mechanism
    assert mechanism.stroke == pytest.approx(5e-4 * 4 / math.pi / 0.086**2, rel=1e-15)
    assert mechanism.rod == pytest.approx(2 * mechanism.stroke, rel=1e-15)


def test_an_offset_keeps_the_stroke() -> None:
    cylinder = cylinder_of("displacement: 500 cm3\nbore: 86 mm\noffset: 10 mm")
    assert cylinder.mechanism.stroke == pytest.approx(5e-4 * 4 / math.pi / 0.086**2, rel=1e-12)


def test_all_three_where_they_agree() -> None:
    """Figures of a data sheet, 499.6 cm³ by bore and stroke: these count."""
    cylinder = cylinder_of("displacement: 500 cm3\nbore: 86 mm\nstroke: 86 mm")
    assert cylinder.mechanism.stroke == 0.086
    assert cylinder.pistons[0].bore == 0.086


def test_pistons_on_one_rod() -> None:
    """Each by its own displacement; one by a rocker has a stroke of its own."""
    tandem = "[{displacement: 100 cm3}, {displacement: 100 cm3, lever_ratio: -0.5}]"
    text = f"displacement: 500 cm3\nstroke: 86 mm\ntandem: {tandem}"
    volumes = []
    for piston in cylinder_of(text).pistons:
        volumes.append(math.pi / 4 * piston.bore**2 * 0.086 * abs(piston.lever_ratio))
    assert volumes == pytest.approx([5e-4, 1e-4, 1e-4], rel=1e-14)


def test_a_cylinder_like_another_has_its_own_displacement() -> None:
    cylinders = loads(
        "speed: 300 rpm\ncylinders:\n"
        "  - {name: HP, stroke: 600 mm, rod_ratio: 5, bore: 200 mm}\n"
        "  - {name: LP, like: HP, displacement: 60 l, crank_position: 90 deg}\n"
    ).cylinders
    bore = cylinders[1].pistons[0].bore
    assert bore == pytest.approx(math.sqrt(0.06 / 0.6 * 4 / math.pi), rel=1e-15)


def test_a_sweep_over_the_displacement() -> None:
    """In one batch: the largest force is p_i over the bore of each."""
    table = sweep(
        loads(f"displacement: 500 cm3\nstroke: 86 mm\n{REST}"),
        {"displacement": ["400 cm3", "500 cm3", "600 cm3"]},
        ["P_max", "work"],
    )
    volumes = np.array([4e-4, 5e-4, 6e-4])
    assert np.asarray(table["P_max"]) == pytest.approx(5e5 * volumes / 0.086, rel=1e-12)
    assert np.asarray(table["work"]) == pytest.approx(5e5 * volumes, rel=1e-12)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "displacement: 510 cm3\nbore: 86 mm\nstroke: 86 mm",
            "displacement: 510 cm^3 is 2.09 % more than what bore and stroke sweep, 499.557 cm^3;",
        ),
        (
            "displacement: 2 l\nbore: 86 mm\nstroke: 86 mm",
            "is 4 times what bore and stroke sweep, 499.557 cm^3; give the displacement of one cyl",
        ),
        ("displacement: 500 cm3", "'crank' or 'stroke' is missing"),
        ("stroke: 86 mm", "indicator: 'bore' is missing as well"),
        ("displacement: 500 cm2\nstroke: 86 mm", "unknown volume unit 'cm2'"),
        ("hubraum: 500 cm3\nstroke: 86 mm", "unknown key; did you mean 'displacement'?"),
        (
            "displacement: 500 cm3\nstroke: 86 mm\ncrank_end_rod: 90 mm",
            "90 mm is no thinner than the bore (86.0381 mm)",
        ),
        (
            "bore: 86 mm\nstroke: 86 mm\ntandem: [{bore: 50 mm, displacement: 1 l}]",
            "tandem[0].displacement: 1000 cm^3 is",
        ),
    ],
)
def test_likely_mistakes(text: str, message: str) -> None:
    with pytest.raises(MachineFileError, match=re.escape(message)):
        cylinder_of(text)


@pytest.mark.parametrize(
    "text",
    [
        "displacement: 1e27 m3\nstroke: 1e-9 m",
        "displacement: 1e-27 m3\nstroke: 1e9 m",
        "displacement: 1e27 m3\nbore: 1e-9 m",
        "displacement: 1e-27 m3\nbore: 1e9 m",
    ],
)
def test_sizes_that_no_key_may_have(text: str) -> None:
    """A bore of 10¹⁸ m is refused as a value, and so where it follows from others."""
    with pytest.raises(MachineFileError, match="beyond what a machine may have"):
        cylinder_of(text)
