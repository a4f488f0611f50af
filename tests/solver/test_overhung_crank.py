"""The overhung crank: by two textbooks, by an independent free body, by brute force, and by its rules."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kurbel.errors import RuleError
from kurbel.solver.shaft import FreeBody, Vector
from kurbel.solver.stress import places
from shafts import body, place_at, shaft

OVERHUNG: dict[str, Any] = {"overhung": True, "a": 0.4, "b": 1.2, "journal_length": 0.3}
forces = st.floats(-1e6, 1e6)
PIN, JOURNAL = math.pi * 0.18**3 / 32, math.pi * 0.19**3 / 32


def test_bhandari_4_14() -> None:
    """V. B. Bhandari, Design of Machine Elements, ex. 4.14: 1 kN on a crank of 500 mm, 175 mm before the bearing.

    Maximum shear stress 0.5 · 400/2 N/mm² in a shaft of 29.9923914964 mm.
    """
    lengths = {"web_distance": 0.05, "web_thickness": 0.03, "web_width": 0.06, "pin_length": 0.05}
    crank = shaft(**OVERHUNG | lengths | {"a": 0.175, "journal_diameter": 0.0299923914964, "journal_length": None})
    pin, nothing = Vector(np.zeros(1), np.array([1000.0])), Vector(0.0, 0.0)
    at = place_at(FreeBody(crank, 0.5, pin, nothing), "journal_A", "in bearing")
    assert math.hypot(at.normal[0] / 2, at.torsion[0]) == pytest.approx(100e6, rel=1e-11)


def test_khurmi_32_5() -> None:
    """R. S. Khurmi & J. K. Gupta, A Textbook of Machine Design, ex. 32.5: bore 250 mm, stroke 300 mm, 2.1 N/mm².

    Pin 239 mm before bearing 1, 470 mm between the bearings, a flywheel of 30 kN in their middle. Printed: 103 kN,
    H_1 = 155.4 kN, V_1 = 15 kN, at the flywheel M_H = 12.3 and M_V = 3.525, together 12.8 kN m.
    """
    lengths = {"web_distance": 0.12, "web_thickness": 0.07, "pin_length": 0.11, "a": 0.239, "b": 0.709}
    own = shaft(**OVERHUNG | lengths | {"journal_length": None, "flywheel_position": -0.235})
    load = 2.1e6 * math.pi / 4 * 0.25**2
    found = FreeBody(own, 0.3, Vector(np.array([load]), np.zeros(1)), Vector(np.zeros(1), np.array([-30e3])))
    assert load == pytest.approx(103e3, rel=1e-3)
    assert found.A.D[0] == pytest.approx(155.4e3, rel=1e-3)
    assert (found.A.T[0], found.B.T[0]) == pytest.approx((-15e3, -15e3), rel=1e-14)
    moments = found.moments_at(own.b + own.flywheel_position)
    assert abs(moments.D[0]) == pytest.approx(12.3e3, rel=0.02)  # a difference of two rounded numbers in the book
    assert abs(moments.T[0]) == pytest.approx(3525, rel=1e-14)
    at = place_at(found, "journal_B", "at flywheel")
    assert at.normal[0] * JOURNAL == pytest.approx(12.8e3, rel=0.02)


@given(forces, forces, forces, forces, st.floats(-0.75, 2.0))
def test_against_a_free_body_in_space(D: float, T: float, G_D: float, G_T: float, f: float) -> None:
    """Reactions from the equations of a rigid body; every section from what lies on the side of the pin alone."""
    found = body(D, T, (G_D, G_T), **OVERHUNG, flywheel_position=f)
    a, b, e, r = 0.4, 1.2, 0.17, 0.3
    # x along T, y toward the pin, z along the shaft from the pin; unknown: A and B on the shaft (x, y)
    loads = [(np.array([T, -D, 0.0]), np.array([0.0, r, 0.0])), (np.array([G_T, -G_D, 0.0]), np.array([0, 0, b + f]))]
    rows = []
    for direction in (np.array([1.0, 0, 0]), np.array([0, 1.0, 0])):
        rows += [[*direction[:2], *np.cross([0.0, 0.0, z], direction)[:2]] for z in (a, b)]
    load = sum(np.array([*force[:2], *np.cross(point, force)[:2]]) for force, point in loads)
    A_x, B_x, A_y, B_y = np.linalg.solve(np.array(rows).T, -np.asarray(load))
    size = 1e-11 * (abs(D) + abs(T) + 3 * abs(G_D) + 3 * abs(G_T) + 1)
    bearings = [found.A.T[0], found.A.D[0], found.B.T[0], found.B.D[0]]
    assert bearings == pytest.approx([-A_x, A_y, -B_x, B_y], abs=size)

    def section(y: float, z: float, *more: tuple[Any, Any]) -> Any:
        return sum(np.cross(point - np.array([0.0, y, z]), force) for force, point in (loads[0], *more))

    bearing_A = (np.array([A_x, A_y, 0.0]), np.array([0.0, 0.0, a]))
    at = {(place.part, place.name): place for place in places(found)}
    web = section(0.0, e)
    assert at["web_A", "wide face"].compression[0] == pytest.approx(D / 0.12 / 0.22, abs=size / 0.0264)
    assert at["web_A", "wide face"].bending_in_plane[0] * 0.12**2 * 0.22 / 6 == pytest.approx(abs(web[0]), abs=size)
    assert at["web_A", "wide face"].torsion[0] * 0.12**2 * 0.22 / 4.5 == pytest.approx(abs(web[1]), abs=size)
    narrow = at["web_A", "narrow face"]
    assert narrow.bending_out_of_plane[0] * 0.12 * 0.22**2 / 6 == pytest.approx(abs(web[2]), abs=size)
    pin = section(r, 0.11)
    assert at["pin", "at web A"].normal[0] * PIN == pytest.approx(math.hypot(*pin[:2]), abs=size)
    assert at["pin", "at web A"].torsion[0] == pin[2] == 0
    journals = {("journal_A", "at web"): section(0, 0.23), ("journal_A", "in bearing"): section(0, a)}
    if b + f < b:
        journals["journal_B", "at flywheel"] = section(0, b + f, bearing_A)
    else:
        journals["journal_B", "in bearing"] = section(0, b, bearing_A)
    for key, moment in journals.items():
        assert at[key].normal[0] * JOURNAL == pytest.approx(math.hypot(*moment[:2]), abs=size), key
        assert at[key].torsion[0] * 2 * JOURNAL == pytest.approx(abs(moment[2]), abs=size), key
    assert {part for part, _ in at} == {"pin", "web_A", "journal_A", "journal_B"}


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"b": 0.4}, r"400 mm puts B before bearing A \(400 mm\); an overhung pin lies beyond A"),
        ({"a": 0.2}, "200 mm puts the bearing inside the web .230 mm from the pin."),
        ({"flywheel_position": -0.8}, "-800 mm lies beyond bearing A; A .* 800 mm from B"),
        ({"pin_length": 0.24}, "240 mm does not fit beside the web, which leaves 220 mm"),
        ({"journal_length": 0.36}, "half of 360 mm does not fit .* bearing A and web A, which leave 170 mm"),
        (
            {"a": 0.95, "flywheel_position": 0.4},
            "half of 300 mm .* bearing A and half the way to B, which leave 125 mm",
        ),
    ],
)
def test_lengths_that_contradict(changed: dict[str, Any], message: str) -> None:
    with pytest.raises(RuleError, match=message):
        shaft(**OVERHUNG | {"flywheel_position": -0.4, "flywheel_mass": 1.0, "journal_length": 0.3} | changed)
