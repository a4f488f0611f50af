"""Loads and places of the crank pin, and the lengths round it that contradict one another."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kurbel.errors import RuleError
from kurbel.machine.parts import ConnectingRod, Masses
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.solver.stress import CrankshaftStrength, places
from shafts import body, shaft, strength

forces = st.floats(-1e6, 1e6)


@given(forces, forces, forces, forces, st.floats(-0.15, 2.0), st.floats(0, 1))
def test_no_section_of_the_pin_is_strained_more_than_its_places(
    D: float, T: float, G_D: float, G_T: float, f: float, along: float
) -> None:
    found = body(D, T, (G_D, G_T), flywheel_position=f)
    u = 0.11 * along
    before, beyond = (float(np.hypot(*moments)[0]) for moments in (found.moments_at(-u), found.moments_at(u)))
    worst = max(place.normal[0] for place in places(found) if place.part == "pin")
    assert max(before, beyond) <= worst * math.pi * 0.18**3 / 32 * (1 + 1e-12) + 1e-9


class TestTurningPartOfTheRod:
    """Of 260 kg, 60 % turn with the pin of a crank of 0.3 m at 300 rpm: 156 · 0.3 · (10 π)² N, radial only."""

    PULL = 156 * 0.3 * (10 * math.pi) ** 2

    def solved(self, rod: ConnectingRod, **changed: Any) -> CrankshaftStrength:
        return strength(shaft(**changed), SliderCrank(0.3, 1.5), rpm=300, masses=Masses(200.0, rod))

    def test_free_body(self) -> None:
        solved = self.solved(ConnectingRod(260.0, share=0.4))
        phi = np.linspace(0, 360, 37)
        at = solved.at(phi)
        assert pytest.approx(solved.forces.at(phi).D, rel=1e-15) == at.D
        size = float(np.abs(at.D).max())
        assert pytest.approx(at.D - self.PULL, abs=1e-14 * size) == at.A_D + at.B_D
        assert pytest.approx(at.B_D * 0.42, abs=1e-14 * size) == at.A_D * 0.4
        assert pytest.approx(at.T, abs=1e-14 * size) == at.A_T + at.B_T
        # the dead centre of the book is taken at rest
        assert solved.sigma_dc("pin") == strength(shaft(), SliderCrank(0.3, 1.5)).sigma_dc("pin")
        assert solved.equilibrium_residual <= 1e-14


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"a": 0.2}, "200 mm puts the bearing inside the web .230 mm from the pin."),
        ({"flywheel_position": -0.3, "flywheel_mass": 1.0}, "-300 mm is not between web and bearing B"),
        ({"flywheel_position": -1.0, "flywheel_mass": 1.0}, "-1000 mm lies beyond bearing A"),
        ({"pin_length": 0.24}, "240 mm does not fit between the webs, which leave 220 mm"),
        ({"journal_length": 0.36}, "half of 360 mm does not fit .* bearing A and web A, which leave 170 mm"),
        ({"journal_length": 0.36, "a": 0.6, "b": 0.4}, "half of 360 mm .* bearing B and web B, which leave 170 mm"),
        ({"flywheel_position": 0.1, "flywheel_mass": 1.0}, "half of 300 mm .* bearing B and flywheel, which leave 100"),
        ({"flywheel_position": -0.1, "flywheel_mass": 1.0}, "half of 300 mm .* B and flywheel, which leave 100 mm"),
    ],
)
def test_lengths_that_contradict(changed: dict[str, Any], message: str) -> None:
    with pytest.raises(RuleError, match=message):
        shaft(**changed)
