"""Answers beside the columns of the book: magnitudes, the rod at its pins, points of the rod, places of a value."""

from typing import Any

import numpy as np
import pytest
from mpmath import mp

from command import answer
from kurbel.machine_file import loads
from kurbel.solver.case import Case
from kurbel.solver.forces import CylinderForces

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

    def test_the_largest_pressure_is_at_either_end(self) -> None:
        """9 bar at the crank end, on the return stroke of the head end; 7 bar at the other one."""
        assert self.forces.p_max.value == pytest.approx(9e5, rel=1e-15)
        assert self.forces.p_max.degrees <= 180.0


STRAIGHT = "speed: 60 rpm\ncrank: 400 mm\nrod_ratio: 5\n"


def json_of(*words: str, text: str = STRAIGHT) -> dict[str, Any]:
    (part,) = answer(*words, "-", text=text)["cylinders"]
    return {column["id"]: column["values"] for column in part["columns"]}


class TestWhere:
    def test_blau_34_and_35(self) -> None:
        """λ = 1/5: where b has fallen to a sixth of b(0), with x, c and b there."""
        found = json_of("motion", "--where", "b = 1/6 b_max")
        with mp.workdps(30):

            def x(phi: Any) -> Any:
                return (1 - mp.cos(phi) + 5 * (1 - mp.sqrt(1 - mp.sin(phi) ** 2 / 25))) * mp.mpf(
                    "0.4"
                )

            phi = mp.findroot(lambda p: mp.diff(x, p, 2) - mp.mpf("0.4") * 6 / 5 / 6, 1.2)
            omega = 2 * mp.pi
            expected = {
                "x": x(phi),
                "c": mp.diff(x, phi) * omega,
                "b": mp.diff(x, phi, 2) * omega**2,
            }
            degrees = float(mp.degrees(phi))
        assert found["phi"] == pytest.approx([degrees, 360 - degrees], rel=1e-14)
        for name, value in expected.items():
            assert found[name][0] == pytest.approx(float(value), rel=1e-13), name

    def test_a_force_of_a_whole_cycle_and_a_jump(self) -> None:
        """P turns over at the jumps of a constant card too, and the table says what stands just after."""
        found = json_of("forces", "--where", "P = 0", text=COMPRESSOR)
        assert found["phi"] == list(cylinder(COMPRESSOR).phi_reversal or ())


class TestOverTheStroke:
    @pytest.mark.parametrize("more", ["", "offset: 100 mm\n", "mechanism: yoke-frame\n"])
    def test_both_strokes_by_fractions(self, more: str) -> None:
        found = json_of("motion", "--over", "x", "--step", "25", text=STRAIGHT + more)
        assert found["z"] == pytest.approx([0, 0.25, 0.5, 0.75, 1, 0.75, 0.5, 0.25, 0], abs=1e-15)
        stroke = cylinder(STRAIGHT + more).motion.stroke
        assert found["x"] == pytest.approx([z * stroke for z in found["z"]], abs=1e-15)
        assert np.all(np.diff(found["phi"]) > 0)

    def test_a_cycle_of_two_turns_has_four_strokes(self) -> None:
        found = json_of(
            "forces", "--over", "x", "--step", "50", text=STRAIGHT + "cycle: four-stroke\n"
        )
        assert found["z"] == pytest.approx([0, 0.5, 1, 0.5, 0, 0.5, 1, 0.5, 0], abs=1e-15)
        assert found["phi"][-1] == 720.0


class TestCompare:
    def test_the_books_approximations_next_to_the_exact_columns(self) -> None:
        """R 286, B 25, R 291 at 60° for λ = 1/5: x = 0.575 R, c = 0.9526 v, b = 0.4 v²/R."""
        found = json_of("motion", "--compare", "--angles", "60")
        R, v = 0.4, 0.4 * 2 * np.pi
        assert found["x_book"] == pytest.approx([0.575 * R], rel=1e-14)
        assert found["c_book"] == pytest.approx(
            [v * (np.sqrt(0.75) + 0.1 * np.sqrt(0.75))], rel=1e-14
        )
        assert found["b_book"] == pytest.approx([0.4 * v**2 / R], rel=1e-14)
        assert list(found)[1:4] == ["psi", "x", "x_book"]

    def test_both_areas_alike(self) -> None:
        """R 297 with 7 bar at the head and 0 bar at the crank end: ½ (A_H + A_C) · 7 bar, on the return stroke."""
        found = json_of("forces", "--compare", "--angles", "270", text=COMPRESSOR)
        area = np.pi / 4 * (0.1**2 + (0.1**2 - 0.025**2)) / 2
        assert found["P_gas_book"] == pytest.approx([area * 7e5], rel=1e-14)


class TestReversalsInTheNoise:
    @staticmethod
    def traced(noise: float, mean: float, swing: float) -> CylinderForces:
        """Gauge pressure `swing` · cos φ + mean in bar, a sample every half degree, with normal noise of this size."""
        angles = np.arange(0.0, 360.5, 0.5)
        pressures = mean + swing * np.cos(np.radians(angles)) ** 5
        pressures[:-1] += noise * np.random.default_rng(7).standard_normal(len(angles) - 1)
        pressures[-1] = pressures[0]
        points = ", ".join(f"[{a}, {p!r}]" for a, p in zip(angles.tolist(), pressures.tolist()))
        trace = f"indicator: {{head_end: {{trace: {{unit: bar, points: [{points}]}}}}}}"
        return cylinder(f"crank: 100 mm\nrod: 500 mm\nbore: 100 mm\n{trace}\n")

    def test_a_noisy_trace_has_the_reversals_of_the_clean_one(self) -> None:
        """cos⁵ lies flat round its zeros at 90° and 270°: noise of 0.02 bar crosses there many times."""
        noisy = self.traced(0.02, 0.0, 5.0)
        assert noisy.changes_of_force[1] > 10
        assert noisy.phi_reversal == pytest.approx([90.0, 270.0], abs=20.0)
        assert len(noisy.phi_reversal or ()) == 2
