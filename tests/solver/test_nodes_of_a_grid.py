"""What is found at the nodes of a grid: columns with their slopes, and integrals."""

import math

import numpy as np
import pytest

from kurbel.mechanisms import Mechanism
from kurbel.mechanisms.scotch_yoke import ScotchYoke
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.mechanisms.slotted_lever import SlottedLever
from kurbel.numerics.grid import Grid
from machines import one_cylinder
from representative import case_of


@pytest.mark.parametrize("name", ["P", "N", "S", "T", "crosshead_power"])
def test_pieces_that_are_not_cut_keep_what_was_found_before(name: str) -> None:
    """The guide force changes sides twice in a turn, so that two pieces of the waterworks engine are cut."""
    (forces,) = case_of("waterworks").cylinders
    anew = getattr(forces.drive.on(forces.grid), name)
    kept = getattr(forces.samples, name)
    assert len(forces.grid.low) == len(forces.drive.pieces.low) + 2
    np.testing.assert_array_equal(kept, anew)


@pytest.mark.parametrize(
    "mechanism", [SliderCrank(0.4, 1.5, 0.2), ScotchYoke(0.3), SlottedLever(0.3, 0.8, 1.3)], ids=lambda one: one.name
)
def test_slopes_of_way_and_velocity_are_their_derivatives(mechanism: Mechanism) -> None:
    drive = one_cylinder(mechanism).drive
    angles, step = np.arange(3.0, 360.0, 7.0), 1e-4
    jets = drive.jets_at(angles, angles)
    for name in ("x", "slope"):
        ahead, behind = (getattr(drive.at(angles + way), name) for way in (step, -step))
        difference = (ahead - behind) / math.radians(2 * step)
        assert getattr(jets, name).slope == pytest.approx(difference, rel=1e-7, abs=1e-9), name


def test_an_integral_does_not_hang_on_how_its_values_lie_in_memory() -> None:
    grid = Grid(np.linspace(0.0, 360.0, 25))
    values = np.exp(np.sin(np.radians(grid.degrees)))
    assert grid.integral(np.ascontiguousarray(values)) == grid.integral(np.asfortranarray(values))
    assert grid.integral(values) == pytest.approx(2 * math.pi * float(np.i0(1.0)), rel=1e-15)  # a Bessel function
