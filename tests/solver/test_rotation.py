"""Sense of rotation: which guide carries the crosshead of a lying machine (R p. 602), and what the throw feels."""

import numpy as np
import pytest

from kurbel.machine_file import loads
from kurbel.solver.case import Case

ENGINE = """
crank: 300 mm
rod: 1500 mm
bore: 400 mm
speed: 60 rpm
inclination: 0 deg
masses: {piston: 100 kg}
indicator: {head_end: {constant: {expansion: EXPANSION, compression: COMPRESSION}}}
"""
WEIGHT = 100 * 9.80665


def case(rotation: str = "", out: str = "3 bar", back: str = "0 bar", **changed: str) -> Case:
    text = ENGINE.replace("EXPANSION", out).replace("COMPRESSION", back)
    for old, new in changed.items():
        text = "\n".join(
            f"{old}: {new}" if line.startswith(f"{old}:") else line for line in text.splitlines()
        )
    return Case(loads(f"{text}\nrotation: {rotation}" if rotation else text))


@pytest.mark.parametrize("inclination", [0.0, 30.0, 90.0])
def test_under_is_the_mirror_image(inclination: float) -> None:
    """The weight leaves the side on which an engine presses: N less twice its share; P, T and M stay."""
    phi = np.arange(0.0, 360.0, 5.0)
    over, under = (
        case(rotation, inclination=f"{inclination} deg").cylinders[0].at(phi)
        for rotation in ("over", "under")
    )
    share = WEIGHT * np.cos(np.radians(inclination))
    assert pytest.approx(np.full(72, 2 * share), abs=1e-9) == over.N - under.N
    for column in ("P", "T", "M", "S"):
        assert getattr(under, column) == pytest.approx(
            getattr(over, column), rel=1e-13, abs=1e-9
        ), column


def test_where_it_lifts() -> None:
    """Without inertia N = P tan ψ − G: it lifts where tan ψ = G/P, from there to its mirror image about 90°."""
    solved = case("under", speed="0 rpm")
    load = 3e5 * np.pi / 4 * 0.4**2
    psi = np.arctan(WEIGHT / load)
    start = np.degrees(np.arcsin(np.sin(psi) * 5))
    # on the return stroke the pressure is zero and the weight alone stands on the guide
    ((result, end),) = solved.cylinders[0].lifted
    assert (result, end) == pytest.approx((start, 180 - start), abs=1e-9)


def test_guide_pressure_and_wear() -> None:
    """A shoe of 400 by 200 mm: |N|/(l w); the wear line f |N c| sums up to the work of friction at the crosshead."""
    text = ENGINE.replace("EXPANSION", "3 bar").replace("COMPRESSION", "0 bar")
    guide = "friction: {crosshead: 0.1, guide: {length: 400 mm, width: 200 mm}}"
    forces = Case(loads(f"{text}\n{guide}")).cylinders[0]
    phi = (np.arange(36000) + 0.5) / 100
    at = forces.at(phi)
    np.testing.assert_allclose(at.p_guide, abs(at.N) / 0.08, rtol=1e-15)
    np.testing.assert_allclose(at.wear, 0.1 * abs(at.N * at.c), rtol=1e-12)
    assert at.wear.mean() * 1.0 == pytest.approx(
        forces.friction_works["crosshead"], rel=1e-5
    )  # one turn a second
    assert at.p_guide.max() == pytest.approx(forces.p_guide_max.value, rel=1e-6)
    assert forces.wear_max.value == pytest.approx(at.wear.max(), rel=1e-7)
    assert forces.wear_max.degrees == pytest.approx(phi[at.wear.argmax()], abs=0.1)
    assert forces.wear_mean == pytest.approx(at.wear.mean(), rel=1e-5)
    mean_over_way = (at.p_guide * abs(at.slope)).sum() / abs(at.slope).sum()
    assert forces.p_guide_mean == pytest.approx(mean_over_way, rel=1e-5)
    assert case().cylinders[0].at([0.0]).p_guide is None
