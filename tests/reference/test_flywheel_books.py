"""Flywheels of the textbooks: S Sarkar, K Khurmi & Gupta, J Jindal, B Bevan, N Budynas & Nisbett, U Uicker.

Figures: FOSSEE Python companions @d34b2ae7 (Sarkar ch. 6, Khurmi & Gupta ch. 16, Jindal ch. 19, Bevan ch. 12), the
solutions manual of Budynas & Nisbett ch. 16, the instructor solution P18.1 of Uicker, Pennock & Shigley. Expectations
are independent recalculations. The books take δ = ΔE/(J ω²): `delta_book` here.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from kurbel.machine import Machine
from kurbel.machine.turning import Harmonics
from kurbel.solver.case import Case
from kurbel.solver.flywheel import MachineTurning
from turning_machines import of_points, rectangles

FOOT, POUND, POUND_FORCE, INCH = 0.3048, 0.45359237, 4.4482216152605, 0.0254
EXACT = 1e-11


def wave(mean: float, *terms: tuple[int, float, float]) -> MachineTurning:
    """M = mean + Σ (a cos kφ + b sin kφ): the torques that some books give as formulas; of two, one less the other."""
    return Case(Machine((), effort=Harmonics(mean, terms))).flywheel


def test_sarkar_6_10_the_swing_over_all_lobes() -> None:
    """The book prints −1370.28, its companion 19.5 kg m² for an angle taken in degrees; 15125 N m need 1724 kg m²."""
    excess = wave(15000, (2, 0, 8000), (1, 6000, 0))
    assert excess.dE == pytest.approx(15125, rel=EXACT)
    omega = 200 * math.pi / 30
    assert excess.dE / (0.02 * omega**2) == pytest.approx(1724.04326541, rel=EXACT)
    assert excess.M_mean * omega == pytest.approx(314159.265359, rel=EXACT)


def test_sarkar_6_6() -> None:
    """The companion divides 500/300 as integers: 0.342 % for 1.33 %."""
    excess = wave(1000, (2, -500, 300))
    inertia, omega = 400 * 0.4**2, 250 * math.pi / 30
    assert 1000 * omega == pytest.approx(26179.9387799, rel=EXACT)
    assert 100 * excess.dE / (inertia * omega**2) == pytest.approx(1.32929763243, rel=EXACT)
    torque = excess.at([60.0]).M[0] - excess.M_mean
    assert torque / inertia == pytest.approx(7.96574408024, rel=EXACT)


def test_sarkar_6_4_seven_lobes_of_which_none_alone_is_the_swing() -> None:
    scale = 6000 * math.radians(30)
    areas = [area * scale for area in (0.5, -1.22, 0.9, -1.38, 0.83, -0.7, 1.07)]
    turning = of_points(rectangles(areas, 5000), 480, delta=0.03)
    assert turning.lobes == pytest.approx((*areas[1:-1], areas[-1] + areas[0]), rel=1e-9)
    assert pytest.approx(195.720054439 * 0.6**2, rel=EXACT) == turning.J


def test_khurmi_16_4() -> None:
    scale = 5 * math.pi / 180
    turning = of_points(rectangles([285 * scale, -975 * scale, 690 * scale], 100), 1800, inertia=36 * 0.15**2)
    assert turning.delta_book == pytest.approx(0.00295641040837, rel=EXACT)


def test_khurmi_16_6_a_cycle_of_three_turns() -> None:
    """750 N m, rising to 3000 over half a turn, one turn at 3000, falling over half a turn, one turn at 750.

    Drawn over one turn: angles a third, torques three times as large, works the same.
    """
    points = [(0.0, 750.0), (180.0, 3000.0), (540.0, 3000.0), (720.0, 750.0), (1080.0, 750.0)]
    excess, omega = of_points([(angle / 3, 3 * torque) for angle, torque in points]), 250 * math.pi / 30
    mean = excess.M_mean / 3
    assert mean == pytest.approx(1875, rel=EXACT)
    assert mean * omega == pytest.approx(49087.3852123, rel=EXACT)
    assert excess.dE == pytest.approx(8835.7293, rel=1e-8)
    assert excess.dE / (500 * 0.6**2 * omega**2) == pytest.approx(0.0716197243914, rel=EXACT)


def test_khurmi_16_7_two_triangles() -> None:
    """The companion truncates 18.08 % to 18 and 136.25° to 136."""
    turning = of_points([(0, 0), (80, 2000), (180, 0), (270, 1500), (360, 0)], 100, delta=0.015)
    assert 100 * turning.energy_fluctuation == pytest.approx(18.0803571429, rel=EXACT)
    assert pytest.approx(197.319648833 * 1.75**2, rel=EXACT) == turning.J
    assert turning.E_min.degrees == pytest.approx(35, rel=EXACT)
    assert turning.E_max.degrees == pytest.approx(136.25, rel=EXACT)


def test_jindal_19_5_a_solid_disc() -> None:
    energy = 2.25 * math.pi * 125 / 2
    turning = of_points(rectangles([energy, -energy], 100), 250, delta=0.1)
    radius = (2 * turning.J / (math.pi * 7800 * 0.03)) ** 0.25
    assert radius == pytest.approx(0.363902345754, rel=EXACT)


def test_bevan_12_8() -> None:
    """Printed 1.86 tons; g = 32.2 ft/s² in the book."""
    energy = 2500 * FOOT * POUND * 32.2 * FOOT
    turning = of_points(rectangles([energy, -energy], 100), 120, delta=0.01)
    assert pytest.approx(1.85777042712, rel=1e-3) == turning.J / (3.5 * FOOT) ** 2 / POUND / 2240


def test_bevan_12_9() -> None:
    energy = 1.93 * 35.8 * 33000 / 270 * FOOT * POUND * 32.2 * FOOT
    turning = of_points(rectangles([energy, -energy], 100), 270, inertia=2000 * POUND * (2.25 * FOOT) ** 2)
    assert 100 * turning.delta_book == pytest.approx(3.35943766367, rel=1e-3)


def test_bevan_12_10_a_four_stroke_engine_with_a_triangular_expansion() -> None:
    """Expansion gives 2.3 times the work that compression takes; g = 32.2 ft/s² in the book."""
    unit = FOOT * POUND * 32.2 * FOOT
    net = 25 * 33000 / 150 * unit
    expansion = net * 2.3 / 1.3
    points = [
        (0, 0),
        (90, 2 * expansion / math.pi),
        (180, 0),
        (540, 0),
        (630, -2 * (expansion - net) / math.pi),
        (720, 0),
    ]
    turning = of_points(points, 300, delta=0.02)
    assert turning.work_shaft == pytest.approx(net, rel=EXACT)
    assert pytest.approx(13709.760834, rel=1e-3) == turning.J / POUND / FOOT**2


def test_budynas_16_punch_press() -> None:
    """Speeds of 124.41 and 117.81 rad/s for 110.72 lbf in s² and a load of 1560 lbf in."""
    inertia = 110.72 * POUND_FORCE * INCH
    energy = 88501.37472 * POUND_FORCE * INCH
    rpm = 121.11 * 30 / math.pi
    turning = of_points(rectangles([energy, -energy], 1560 * POUND_FORCE * INCH), rpm, inertia=inertia)
    assert turning.delta_book == pytest.approx(0.0544959128065, rel=EXACT)
    # the recalculation has the rounded 63025 of "hp = T n/63025"
    assert turning.power_shaft / (550 * FOOT * POUND_FORCE) == pytest.approx(28.6261623606, rel=1e-5)
    swing = (turning.omega_max.value**2 - turning.omega_min.value**2) / 2
    assert swing * inertia == pytest.approx(energy, rel=1e-12)


UICKER = (
    *(0, 17, 812, 963, 1016, 937, 774, 641, 697, 849, 1031, 1027, 902, 712, 607, 594, 544, 345),
    *(0, -344, -540, -576, -570, -638, -785, -879, -814, -571, -324, -190, -203, -235, -164, -7, 150, 145),
    *(0, -145, -150, 7, 164, 235, 203, 490, 424, 571, 814, 879, 785, 638, 570, 576, 540, 344),
    *(0, -344, -540, -577, -572, -643, -793, -893, -836, -605, -379, -264, -300, -368, -334, -198, -56, -2),
)


def test_uicker_p18_1_seventy_two_ordinates() -> None:
    """The solution takes the net work for the swing: 0.154 kg m²; the diagram needs 0.33817, summed over its ordinates.

    Here straight lines join the ordinates; their mean is the plain one, where the solution's 70.88 is Simpson's,
    and the swing from crossing to crossing is a little larger than the 1961.789 N m from ordinate to ordinate.
    """
    points = [(10.0 * i, float(m)) for i, m in enumerate((*UICKER, UICKER[0]))]
    turning = of_points(points, 4600, delta=0.025)
    assert turning.M_mean == pytest.approx(5164 / 72, rel=EXACT)
    steps = [math.radians(10) * ((a + b) / 2 - 5164 / 72) for a, b in zip(UICKER, (*UICKER[1:], 0))]
    heights = np.cumsum([0.0, *steps])
    assert np.ptp(heights) == pytest.approx(1961.789, abs=5e-4)
    assert np.ptp(heights) < turning.dE < 1.001 * np.ptp(heights)
    assert pytest.approx(0.33817, rel=1e-3) == turning.J
