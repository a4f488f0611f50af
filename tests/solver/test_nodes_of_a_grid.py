"""What is found at the nodes of a grid: columns with their slopes, and integrals."""

import math

import mpmath
import numpy as np
import pytest

from kurbel.crank_angle import CrankAngle
from kurbel.mechanisms import Mechanism
from kurbel.mechanisms.scotch_yoke import ScotchYoke
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.mechanisms.slotted_lever import SlottedLever
from kurbel.numerics.cycles import Flat, cycles_of_turns, located
from kurbel.numerics.gauss import GAUSS, LOBATTO_4, LOBATTO_9, Rule
from kurbel.numerics.grid import Cuts, Grid
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


@pytest.mark.parametrize("ratio", [1.0001, 1.01, 1.1, 1.3, 1.8, 2.0, 2.6, 3.0, 6.0])
def test_ten_nodes_integrate_what_has_a_pole_beside_90_degrees(ratio: float) -> None:
    """∮ cos ψ dφ = 4 E(λ) and ∮ dφ/cos ψ = 4 K(λ), complete elliptic integrals of λ = R/L."""
    rod = SliderCrank(1.0, ratio)
    grid = Cuts.of_turns(rod.cuts(), 360.0).grid(LOBATTO_9)
    assert np.diff(grid.breaks).max() <= 36 + 1e-9
    _, cos_psi = rod.rod_angle(CrankAngle.at_nodes(grid))
    with mpmath.workdps(30):
        square = 1 / mpmath.mpf(ratio) ** 2
        exact = [4 * float(one(square)) for one in (mpmath.ellipe, mpmath.ellipk)]
    assert [grid.integral(one) for one in (cos_psi, 1 / cos_psi)] == pytest.approx(exact, rel=1e-15)


def test_a_cycle_is_cut_only_where_no_corner_is_near() -> None:
    """Corners each 30° need no other cut; from 90° to 180° three equal pieces are narrow enough."""
    corners = np.array([30.0, 60.0, 90.0])
    breaks = [0, 30, 60, 90, 120, 150, 180, 216, 252, 288, 324]
    assert Cuts.of_turns((0.0, 180.0), 360.0, [corners]).grid().breaks.tolist() == pytest.approx([*breaks, 360])
    many = cycles_of_turns((0.0, np.array([180.0, 180.0])), 360.0, [Flat.alike(corners, 2)], 2)
    assert many.low.tolist() == pytest.approx(breaks * 2)


def test_places_among_variants_are_those_of_each_alone() -> None:
    """Before the first number of a variant stands its last one, as numbers do that repeat after a cycle."""
    table = Flat(np.array([0, 0, 1, 2, 2]), np.array([10.0, 20.0, 5.0, 0.0, 300.0]))
    asked = [(0, 9.0, 1), (0, 10.0, 0), (0, 350.0, 1), (1, 4.0, 2), (1, 5.0, 2), (2, 0.0, 3), (2, 299.9, 3)]
    variant, values, places = map(np.array, zip(*asked))
    assert located(table, variant, values).tolist() == places.tolist()


@pytest.mark.parametrize("rule", [LOBATTO_4, LOBATTO_9, GAUSS])
def test_no_polynomial_passes_its_values_at_the_nodes_by_more_than_is_told(rule: Rule) -> None:
    """Values 0 and 1, of which those are 0 whose share is negative at the worst of many places."""
    grid = Grid(np.array([0.0, 36.0]), rule)
    nodes, places = np.array(rule[0]), np.linspace(-1, 1, 5001)
    shares = np.array([np.polyval(np.polyfit(nodes, one, len(nodes) - 1), places) for one in np.eye(len(nodes))])
    worst = np.where(shares[:, np.minimum(shares, 0).sum(axis=0).argmin()] < 0, 0.0, 1.0)
    beyond = (worst @ shares).max() - 1
    assert beyond <= grid.overshoot <= 1.002 * beyond
