"""Answers beside the columns of the book: magnitudes, the rod at its pins, points of the rod, places of a value."""

from __future__ import annotations

import pytest

from kurbel.declared.quantities import COMMON
from kurbel.declared.quantity import by_id
from kurbel.machine_file import loads
from kurbel.solver.case import Case
from kurbel.solver.cylinder.forces import CylinderForces

COMPRESSOR = """
speed: 600 rpm
crank: 50 mm
rod: 200 mm
bore: 100 mm
crank_end_rod: 25 mm
masses: {piston: 4 kg}
indicator:
  head_end: {constant: {expansion: 0.5 bar, compression: 7 bar}}
  crank_end: {constant: {expansion: 0 bar, compression: 9 bar}}
"""


def cylinder(text: str) -> CylinderForces:
    return Case(loads(text)).cylinders[0]


class TestPeaks:
    forces = cylinder(COMPRESSOR)

    @pytest.mark.parametrize("name", ["P", "S", "N", "T"])
    def test_a_peak_is_the_extreme_of_larger_magnitude(self, name: str) -> None:
        found = self.forces.extremes_of(name)
        assert found is not None
        larger = max(found.largest, found.smallest, key=lambda one: abs(one.value))
        assert found.peak == (abs(larger.value), larger.degrees)
        declared = by_id(COMMON.all_key_values)[f"{name}_peak"]
        assert declared.asks == ("extremes_of", name, "peak")

    def test_the_largest_pressure_stands_at_either_end(self) -> None:
        """9 bar at the crank end, on the return stroke of the head end; 7 bar at the other one."""
        assert self.forces.p_max is not None
        assert self.forces.p_max.value == pytest.approx(9e5, rel=1e-15)
        assert self.forces.p_max.degrees <= 180.0

    def test_without_a_card_there_is_none(self) -> None:
        assert cylinder("speed: 60 rpm\ncrank: 1 m\nrod: 5 m\nmasses: {piston: 1 kg}").p_max is None
