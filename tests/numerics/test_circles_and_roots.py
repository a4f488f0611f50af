"""The smallest circle round a closed curve, and roots and minima of functions, where they are known."""

import math

import numpy as np
import pytest

from kurbel.numerics.enclosing import ClosedCurve, smallest_circle
from kurbel.numerics.search import bracketed_roots, common_roots, lowest, roots

# circles


def curve(**waves: complex) -> ClosedCurve:
    """A curve with these waves, by the names f1 (with the angle), b1 (against it) and c (its middle)."""
    amplitudes = np.zeros((17, 1), complex)
    for name, amplitude in waves.items():
        number = 0 if name == "c" else int(name[1:]) * (1 if name[0] == "f" else -1)
        amplitudes[number + 8] += amplitude
    return ClosedCurve(amplitudes)


def test_round_an_ellipse_the_circle_has_its_long_axis() -> None:
    centre, radius, _ = curve(f1=3.0 * np.exp(0.4j), b1=1.0, c=2 - 1j).least_circle()
    assert radius[0] == pytest.approx(4.0, rel=1e-13)
    assert centre[0] == pytest.approx(2 - 1j, abs=1e-12)


@pytest.mark.parametrize("seed", range(4))
def test_round_any_curve(seed: int) -> None:
    """None of its points is outside, and those on the circle are in no half of it: no smaller one holds them."""
    draw = np.random.default_rng(seed)
    amplitudes = (draw.normal(size=(17, 1)) + 1j * draw.normal(size=(17, 1))) / 4
    amplitudes *= 0.6 ** np.abs(np.arange(-8, 9))[:, None]
    of = ClosedCurve(amplitudes)
    centre, radius, degrees = of.least_circle()
    points = of.at(np.linspace(0.0, 360.0, 40001))[0]
    assert np.abs(points - centre).max() <= radius[0] * (1 + 1e-12)
    assert abs(of.at(degrees)[0][0] - centre[0]) == pytest.approx(radius[0], rel=1e-12)
    # two points of the curve half a turn apart, or three about the centre, carry it
    carried = points[np.abs(points - centre) > radius[0] * (1 - 1e-6)] - centre
    turns = np.sort(np.angle(carried))
    gaps = np.diff(np.append(turns, turns[0] + 2 * math.pi))
    assert gaps.max() < math.pi + 1e-2


def test_a_curve_with_one_even_wave_is_not_about_its_middle() -> None:
    centre, radius, _ = curve(f1=1.0, f2=0.3).least_circle()
    assert abs(centre[0]) > 0.01
    assert radius[0] < 1.3 - 1e-3


def test_turned_back_is_the_curve_from_a_frame_that_turns() -> None:
    of = curve(f1=1.0 - 0.2j, f3=0.3, b2=0.4j)
    degrees = np.array([0.0, 40.0, 200.0])
    back = of.turned_back().at(degrees)[0]
    assert back == pytest.approx(of.at(degrees)[0] * np.exp(-1j * np.radians(degrees)), abs=1e-14)


def test_the_farthest_point_of_a_curve_with_a_fine_wave() -> None:
    """e^{iφ} + 0.1 e^{−7iφ}: 1.1 first at 0°, then at every 45°; with another phase where both are in line."""
    distance, degrees = curve(f1=1.0, b7=0.1 * np.exp(0.8j)).farthest()
    assert distance[0] == pytest.approx(1.1, rel=1e-14)
    assert degrees[0] == pytest.approx(math.degrees(0.8) / 8, abs=1e-6)


def test_the_farthest_angle_is_where_all_waves_are_in_line() -> None:
    """1 + 0.3 e^{i(φ−α)} + 0.1 e^{3i(φ−α)} is 1.4 at α alone, of every α a little before 360°, too."""
    for angle in (0.4, 91.3, 200.0, 348.7, 359.6):
        turn = np.exp(-1j * np.radians(angle))
        distance, degrees = curve(c=1.0, f1=0.3 * turn, f3=0.1 * turn**3).farthest()
        assert distance[0] == pytest.approx(1.4, rel=1e-14)
        assert degrees[0] == pytest.approx(angle, abs=1e-6)


def test_at_the_farthest_point_the_distance_no_longer_rises() -> None:
    draw = np.random.default_rng(5)
    amplitudes = draw.normal(size=(17, 30)) + 1j * draw.normal(size=(17, 30))
    amplitudes *= 0.5 ** np.abs(np.arange(-8, 9))[:, None]
    of = ClosedCurve(amplitudes)
    distance, degrees = of.farthest()
    point, slope, _ = of.at(degrees, np.arange(30))
    assert np.abs(point) == pytest.approx(distance, rel=1e-14)
    rise = (point.conj() * slope).real
    assert (np.abs(rise) < 1e-12 * distance**2).all()


def test_of_two_summits_as_far_the_first_and_of_others_the_higher_one() -> None:
    """An ellipse is farthest at α and α + 180°; a middle of ∓1e-7 makes one of them higher."""
    for angle in np.linspace(1.0, 179.0, 37):
        waves = {"f1": 1.0, "b1": 0.5 * np.exp(2j * np.radians(angle))}
        _, degrees = curve(**waves).farthest()
        assert degrees[0] == pytest.approx(angle, abs=1e-6)
    for middle, farthest in ((1e-7, 0.0), (-1e-7, 180.0)):
        _, degrees = curve(f1=1.0, b1=0.5, c=middle).farthest()
        assert degrees[0] == pytest.approx(farthest, abs=1e-4)


def test_a_circle_is_as_far_at_every_angle_and_0_is_the_first() -> None:
    draw = np.random.default_rng(3)
    for number in (-3, -1, 1, 2, 5):
        amplitudes = np.zeros((17, 40), complex)
        amplitudes[number + 8] = draw.normal(size=40) + 1j * draw.normal(size=40)
        distance, degrees = ClosedCurve(amplitudes).farthest()
        assert distance == pytest.approx(np.abs(amplitudes[number + 8]), rel=1e-14)
        assert (degrees == 0).all()


def test_even_waves_alone_are_about_their_middle() -> None:
    """½ + e^{2iφ} is a circle about ½; e^{iφ} + 0.3 e^{−2iφ} is its own image by a third of a turn: about 0 exactly."""
    centre, radius, _ = curve(c=0.5, f2=1.0).least_circle()
    assert centre[0] == pytest.approx(0.5, abs=1e-12)
    assert radius[0] == pytest.approx(1.0, rel=1e-12)
    centre, radius, _ = curve(f1=np.exp(0.3j), b2=0.3 * np.exp(0.1j)).least_circle()
    assert centre[0] == 0
    assert radius[0] == pytest.approx(1.3, rel=1e-13)


def test_three_points_carry_a_circle() -> None:
    """A right angle is in the half circle over its hypotenuse; of a fourth point within nothing depends."""
    points = np.array([[0.0], [6.0], [8.0j], [1.0 + 1.0j]])
    circle = smallest_circle(points)
    assert circle.centre[0] == pytest.approx(3 + 4j)
    assert circle.square[0] == pytest.approx(25.0)
    acute = smallest_circle(np.array([[0.0], [6.0], [3 + 6j], [3 + 1j]]))
    assert acute.centre[0] == pytest.approx(3 + 2.25j)
    assert acute.square[0] == pytest.approx(3.75**2)


# roots


def test_a_change_of_sign_by_a_jump_is_marked() -> None:
    found = roots(lambda x: np.where(x[:, 0] < 0.3333, -1.0, 2.0 + x[:, 0]))
    assert found.places == pytest.approx([0.3333], abs=1e-12)
    assert found.jumps.tolist() == [True]
    smooth = roots(lambda x: x[:, 0] ** 2 - 0.2)
    assert smooth.places == pytest.approx([math.sqrt(0.2)], abs=1e-15)
    assert smooth.jumps.tolist() == [False]


def test_a_stretch_of_zeros_is_one_root_with_its_ends() -> None:
    found = roots(lambda x: np.maximum(x[:, 0] - 0.61803, 0.0) + np.minimum(x[:, 0] - 0.3141, 0.0))
    assert found.places == pytest.approx([0.3141], abs=1e-8)
    assert found.until == pytest.approx([0.61803], abs=1e-8)


def test_an_end_of_a_stretch_of_rounding_is_no_second_root() -> None:
    """−1e-14 where it is flat, a line beyond: of terms of size 1 that is zero on the flat half."""
    falling = roots(lambda places: np.maximum(0.5 - places[:, 0], 0.0) - 1e-14, 1.0)
    assert falling.places == pytest.approx([0.5], abs=1e-6)
    assert falling.until.tolist() == [1.0]
    rising = roots(lambda places: np.maximum(places[:, 0] - 0.5, 0.0) - 1e-14, 1.0)
    assert rising.places.tolist() == [0.0]
    assert rising.until == pytest.approx([0.5], abs=1e-6)


def test_rounding_at_either_end_is_a_root_unless_one_is_next_to_it() -> None:
    assert roots(lambda places: places[:, 0] + 1e-15, 1.0).places.tolist() == [0.0]
    assert roots(lambda places: 1 - places[:, 0] + 1e-15, 1.0).places.tolist() == [1.0]
    beside = roots(lambda places: places[:, 0] - 1e-13, 1.0)
    assert beside.places == pytest.approx([1e-13], rel=1e-9, abs=0.0)


def test_newton_stays_in_its_bracket() -> None:
    """tanh 5(x − a), rising and falling: its chord and its tangents far from a lead out of the bracket."""
    roots_at = np.array([0.3, 0.3, 7.9, -3.5])
    signs = np.array([1.0, -1.0, 1.0, -1.0])
    low = np.full(4, -4.0)
    high = np.full(4, 8.0)

    def function(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        values = np.tanh(5 * (x - roots_at))
        return signs * values, signs * 5 * (1 - values**2)

    found = bracketed_roots(function, low, high, function(low)[0], function(high)[0])
    assert found == pytest.approx(roots_at, rel=1e-15)


def test_a_dip_of_which_samples_see_the_foot_alone() -> None:
    """½ − e^{−u²} with u = (x − 0.5078)/0.004: zero at u = ±√ln 2; at x = 1/2 it is 0.478, elsewhere ½."""
    found = roots(lambda places: 0.5 - np.exp(-(((places[:, 0] - 0.5078) / 0.004) ** 2)))
    half = 0.004 * math.sqrt(math.log(2))
    assert found.places == pytest.approx([0.5078 - half, 0.5078 + half], abs=1e-12)


def test_roots_close_together_where_the_function_nearly_touches_zero() -> None:
    found = roots(lambda x: (x[:, 0] - 0.503) ** 2 - 1e-8)
    assert found.places == pytest.approx([0.5029, 0.5031], abs=1e-12)


def test_a_root_next_to_where_the_function_ends() -> None:
    """√(x − 0.37) − 10⁻⁴ has no value before 0.37, and its root 10⁻⁸ behind it."""

    def ended(x: np.ndarray) -> np.ndarray:
        with np.errstate(invalid="ignore"):
            return np.sqrt(x[:, 0] - 0.37) - 1e-4

    assert roots(ended).places == pytest.approx([0.37 + 1e-8], abs=1e-14)


def test_an_end_that_is_zero_but_for_rounding_is_a_root() -> None:
    found = roots(lambda x: 7 * (x[:, 0] - 1.0) - 1e-16, 7.0)
    assert found.places.tolist() == [1.0]


def test_a_steep_function_has_its_root_to_the_last_digit() -> None:
    found = roots(lambda x: np.expm1(60 * (x[:, 0] - 0.9)))
    assert found.places == pytest.approx([0.9], abs=2e-16)


def test_common_roots_are_found_once_each() -> None:
    """A circle and a parabola that meet twice; a saddle between them sends long steps astray."""

    def both(x: np.ndarray) -> np.ndarray:
        u, v = 4 * x[:, 0] - 2, 4 * x[:, 1] - 2
        return np.stack((u * u + v * v - 2, v - u * u), axis=1)

    assert common_roots(both) == pytest.approx(np.array([[0.25, 0.75], [0.75, 0.75]]), abs=1e-12)


def test_common_roots_between_the_corners_of_one_cell() -> None:
    """Both are positive at all corners of the cell: two circles that touch inside of it from both sides."""

    def both(x: np.ndarray) -> np.ndarray:
        u, v = x[:, 0] - 0.531, x[:, 1] - 0.469
        return np.stack((u * u + v * v - 1e-4, u - v), axis=1)

    apart = 1e-2 / math.sqrt(2)
    exact = np.array([[0.531 - apart, 0.469 - apart], [0.531 + apart, 0.469 + apart]])
    assert common_roots(both) == pytest.approx(exact, abs=1e-12)


def test_what_is_only_small_is_no_root() -> None:
    assert len(common_roots(lambda x: np.stack((x[:, 0] - 0.3, x[:, 1] ** 2 + 1e-6), axis=1))) == 0


def test_a_zero_at_one_sample_is_no_stretch() -> None:
    found = roots(lambda x: x[:, 0] - 0.5)
    assert found.places.tolist() == [0.5]
    assert np.isnan(found.until).all()


# minima


def test_the_end_of_a_narrow_valley() -> None:
    """Rosenbrock's function, whose valley is bent: 0 at (1, 1)."""

    def valley(x: np.ndarray) -> np.ndarray:
        u, v = 4 * x[:, 0] - 2, 4 * x[:, 1] - 2
        return (1 - u) ** 2 + 100 * (v - u * u) ** 2

    place, value = lowest(valley, 2)
    assert place == pytest.approx([0.75, 0.75], abs=1e-5)
    assert value < 1e-9


def test_a_minimum_far_along_a_slope() -> None:
    place, value = lowest(lambda x: np.abs(x[:, 0] - 0.123456789), 1)
    assert place == pytest.approx([0.123456789], abs=1e-10)
    assert value < 1e-10


@pytest.mark.parametrize(("steep", "fall"), [(1e4, 1e-2), (1e6, 1.0)])
def test_along_a_bent_valley_to_the_edge(steep: float, fall: float) -> None:
    """A valley v = 0.5 + 0.3 sin 6u that falls toward u = 1 by far less than its sides rise."""

    def valley(x: np.ndarray) -> np.ndarray:
        u, v = x[:, 0], x[:, 1]
        return steep * (v - 0.5 - 0.3 * np.sin(6 * u)) ** 2 + (1 - u) * fall

    place, value = lowest(valley, 2)
    assert place == pytest.approx([1.0, 0.5 + 0.3 * math.sin(6.0)], abs=1e-9)
    assert value < 1e-12


def test_round_many_curves_with_fine_waves() -> None:
    """Sixty curves at once, whose farthest points are anywhere: each is within its circle, and touches it all round."""
    draw = np.random.default_rng(7)
    waves = draw.normal(size=(17, 60)) + 1j * draw.normal(size=(17, 60))
    waves *= 0.95 ** np.abs(np.arange(-8, 9))[:, None]
    of = ClosedCurve(waves)
    centre, radius, _ = of.least_circle()
    angles = np.linspace(0.0, 360.0, 1801)[:, None] * np.ones(60)
    arms = of.at(angles, np.arange(60)[None])[0] - centre
    assert (np.abs(arms) / radius).max() <= 1 + 1e-12
    for machine in range(60):
        touching = arms[np.abs(arms[:, machine]) > radius[machine] * (1 - 2e-4), machine]
        turns = np.sort(np.angle(touching))
        gaps = np.diff(np.append(turns, turns[0] + 2 * math.pi))
        assert gaps.max() < math.pi + 0.05
