"""Samples on pieces of the cycle: positions, integrals, zeros and extremes, each by what it is of."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from kurbel.numerics.arithmetic import is_whole, total, unless_cancelled
from kurbel.numerics.extreme import Extreme, Extremes, largest, smallest
from kurbel.numerics.lobatto import rule
from kurbel.numerics.pieces import Angles, Pieces, common, highest, refined, resolved

NO_MACHINE = np.zeros(0, dtype=np.intp)


def pieces_at(*degrees: float, cycle: float = 360.0) -> Pieces:
    """The pieces of one machine with these breaks."""
    angles = Angles(np.zeros(len(degrees), dtype=np.intp), np.array(degrees))
    return Pieces.between(angles, 1, cycle)


def of_angle(pieces: Pieces, function: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    """Samples of a function of the angle in radians."""
    return function(np.radians(pieces.degrees))


# where pieces are


def test_an_angle_at_which_a_piece_begins_is_in_it() -> None:
    pieces = pieces_at(100.0)
    held = pieces.holding(np.zeros(3, dtype=np.intp), np.array([90.0, 100.0, 359.0]))
    assert pieces.low[held].tolist() == [90.0, 100.0, 315.0]


def test_pieces_end_exactly_where_the_next_begin() -> None:
    pieces = pieces_at(*(math.sqrt(number) * 17.0 for number in range(2, 90)))
    assert pieces.high.tolist() == [*pieces.low[1:].tolist(), 360.0]


def test_pieces_that_are_kept_have_the_same_beginning_and_width() -> None:
    pieces = pieces_at()
    halves = pieces.halved(np.arange(len(pieces.half)))
    kept, new = halves.kept_of(pieces)
    assert len(kept) == 0
    assert len(new) == len(halves.half)


def test_common_pieces_of_two_turns_are_cut_in_each() -> None:
    starts = common([(pieces_at(100.0), 0.0), (pieces_at(), 10.0)], 720.0).low.tolist()
    assert {100.0, 460.0, 55.0, 415.0} <= set(starts)
    assert 110.0 in common([(pieces_at(100.0), 10.0)], 360.0).low.tolist()


def test_samples_are_carried_over_the_end_of_the_cycle() -> None:
    """A crank that lags by 350° has passed its dead centre 350° later."""
    own = pieces_at(33.0, 200.0)
    pieces = common([(own, 350.0)], 360.0)
    carried = pieces.resampled(of_angle(own, np.sin), own, 350.0)
    exact = np.sin(np.radians(pieces.degrees - 350.0))
    assert carried == pytest.approx(exact, abs=1e-13)


def test_samples_of_few_nodes_are_carried_to_more() -> None:
    """A trace has 6 nodes on its short pieces; the common ones have 16, also where they are the same pieces."""
    breaks = Angles(np.zeros(120, dtype=np.intp), np.arange(0.0, 360.0, 3.0))
    own = Pieces.between(breaks, 1, 360.0, 6)
    pieces = common([(own, 0.0), (pieces_at(1.0), 0.0)], 360.0)
    assert pieces.degrees.shape[0] == 16
    carried = pieces.resampled(of_angle(own, np.sin), own)
    assert carried == pytest.approx(of_angle(pieces, np.sin), abs=1e-10)


def test_pieces_by_a_crank_that_lags_count_from_its_own_right_angles() -> None:
    pieces = pieces_at(12.0)
    own = pieces.by_crank(130.0)
    assert own.degrees == pytest.approx(pieces.degrees - 130.0, abs=1e-12)
    assert np.abs(own.offset + own.half).max() <= 45.0


def test_a_value_at_a_jump_is_that_of_the_side_that_is_meant() -> None:
    pieces = pieces_at(100.0)
    values = np.where(pieces.middle > 100.0, 1.0, 0.0) * np.ones((16, 1))
    zero = np.zeros(1, dtype=np.intp)
    at = np.array([100.0])
    for within, exact in ((99.0, 0.0), (101.0, 1.0), (100.0, 1.0)):
        assert pieces.at(values, zero, at, np.array([within]))[0] == pytest.approx(exact, abs=1e-14)


def test_a_right_angle_is_cut_at_45_degrees_only_where_a_piece_would_be_too_wide() -> None:
    assert pieces_at(22.5, 67.5).low[:4].tolist() == [0.0, 22.5, 67.5, 90.0]
    assert pieces_at(22.0, 67.5).low[:5].tolist() == [0.0, 22.0, 45.0, 67.5, 90.0]


def test_breaks_count_modulo_the_cycle() -> None:
    assert pieces_at(-30.0, 400.0).low.tolist() == pieces_at(330.0, 40.0).low.tolist()


def test_parts_of_a_piece_are_equal_and_one_behind_the_other() -> None:
    pieces = pieces_at()
    parts = pieces.parted(np.where(pieces.low == 45.0, 3, 1))
    assert parts.low[:5] == pytest.approx([0.0, 45.0, 60.0, 75.0, 90.0])
    assert parts.half[1:4] == pytest.approx([7.5, 7.5, 7.5])
    assert parts.low[1:] == pytest.approx(parts.low[:-1] + 2 * parts.half[:-1])


def test_a_value_beyond_the_cycle_is_that_of_the_same_angle() -> None:
    pieces = pieces_at(100.0)
    values = of_angle(pieces, np.sin)
    degrees = np.array([-10.0, 365.0, 470.0])
    at = pieces.at(values, np.zeros(3, dtype=np.intp), degrees)
    assert at == pytest.approx(np.sin(np.radians(degrees)), abs=1e-14)


def test_machines_have_nothing_to_do_with_one_another() -> None:
    """Of two machines with values of other signs: no zeros, integrals of their own from 0 on, and extremes."""
    breaks = Angles(np.array([0, 1, 1]), np.array([100.0, 50.0, 300.0]))
    pieces = Pieces.between(breaks, 2, 360.0)
    values = pieces.filled(np.where(pieces.machine == 0, 3.0, -1.0))
    assert len(pieces.zeros(values).degrees) == 0
    running = pieces.running(values)
    assert running[0, pieces.first] == pytest.approx([0.0, 0.0], abs=1e-15)
    ends = np.append(pieces.first[1:], len(pieces.half)) - 1
    assert running[-1, ends] == pytest.approx([6 * np.pi, -2 * np.pi], rel=1e-15)
    extremes = pieces.extremes([values, -2 * values])
    assert extremes.largest.tolist() == [[3.0, -1.0], [-6.0, 2.0]]
    assert extremes.smallest.tolist() == [[3.0, -1.0], [-6.0, 2.0]]


# integrals


def test_the_running_integral_of_many_pieces_is_their_sum() -> None:
    pieces = pieces_at(*np.arange(0.0, 360.0, 0.25))
    for seed in range(20):
        draw = np.random.default_rng(seed)
        values = pieces.filled(draw.uniform(1.0, 2.0, len(pieces.half)))
        inside = (pieces.rule.area @ values) * np.radians(pieces.half)
        exact = math.fsum(inside[-1].tolist())
        assert pieces.running(values)[-1, -1] == pytest.approx(exact, rel=3e-16, abs=0.0)


def test_the_running_integral_loses_nothing_over_many_pieces() -> None:
    """10¹⁵ and −10¹⁵ in turn, with 1 more: what is left is the 1, not rounding of the large sums."""
    pieces = pieces_at(*np.arange(0.0, 360.0, 0.25))
    turn = np.where(np.arange(len(pieces.half)) % 2 == 0, 1e15, -1e15)
    values = (turn + 1 / 3) * np.ones((16, 1))
    inside = (pieces.rule.area @ values) * np.radians(pieces.half)
    exact = math.fsum(inside[-1].tolist())
    assert pieces.running(values)[-1, -1] == pytest.approx(exact, abs=1e-3)


def test_the_rule_integrates_polynomials() -> None:
    """∫ tᵏ dt from −1 to a node; the nodes are each other's images about 0."""
    of = rule(16)
    assert (of.nodes == -of.nodes[::-1]).all()
    assert of.weights.sum() == pytest.approx(2.0, rel=1e-14)
    for k in range(15):
        power = (of.nodes ** (k + 1) - (-1) ** (k + 1)) / (k + 1)
        assert of.area @ of.nodes**k == pytest.approx(power, abs=1e-14)
    # twice as many places as nodes see every change of sign of a polynomial
    assert len(of.scan_positions) > 2 * len(of.nodes)


def test_functions_with_kinks_are_cut_there() -> None:
    """The mean of |sin(φ − 20°)| is 2/π, and the cuts are at its two zeros."""
    pieces = pieces_at()
    wave = of_angle(pieces, lambda phi: np.sin(phi - math.radians(20.0)))[None]
    cut, values, _ = resolved(
        pieces, wave, wave, pieces.largest(wave), lambda _, parts: [np.abs(parts[0])]
    )
    assert cut.mean(values[0])[0] == pytest.approx(2 / math.pi, rel=1e-14)
    assert len(cut.half) == len(pieces.half) + 2


def test_noise_is_not_halved_for_ever() -> None:
    draw = np.random.default_rng(1)
    pieces, _ = refined(
        pieces_at(*np.arange(0.0, 360.0, 1.0)),
        lambda some: (1 + 1e-9 * draw.standard_normal(some.degrees.shape))[None],
    )
    assert len(pieces.half) < 1000


# zeros


def test_a_zero_that_is_passed_and_passed_back_at_a_break_is_none() -> None:
    pieces = pieces_at()
    values = np.ones((16, len(pieces.half)))
    values[:, 0] = 0.5 - 0.5 * pieces.rule.nodes - 1e-12 * (pieces.rule.nodes + 1)
    assert len(pieces.zeros(values).degrees) == 0


def test_zeros_of_two_machines_are_each_their_own() -> None:
    pieces = Pieces.between(Angles(np.array([0, 1]), np.array([33.0, 77.0])), 2, 360.0)
    zeros = pieces.zeros(np.sin(np.radians(pieces.degrees - 10.0)))
    assert zeros.machine.tolist() == [0, 0, 1, 1]
    assert zeros.degrees == pytest.approx([10.0, 190.0, 10.0, 190.0], abs=1e-11)


def test_a_jump_at_the_end_of_the_cycle_is_at_0() -> None:
    pieces = pieces_at()
    zeros = pieces.zeros(pieces.degrees - 180.0)
    assert zeros.degrees == pytest.approx([0.0, 180.0], abs=1e-11)


def test_rounding_about_zero_is_no_change_of_sign() -> None:
    pieces = pieces_at()
    values = np.maximum(of_angle(pieces, np.sin), 0.0)
    values[:, pieces.middle > 180.0] = -1e-17
    assert len(pieces.zeros(values).degrees) == 0


def test_zeros_close_together_are_both_found() -> None:
    """(φ − 70°)² − d² has two, 2 d apart, wherever the samples are."""
    pieces = pieces_at()
    for apart in (1.0, 0.1, 1e-3):
        values = ((pieces.degrees - 70.0) ** 2 - apart**2) / 360.0**2
        values = np.where(pieces.middle < 180.0, values, 1.0)
        zeros = pieces.zeros(values).degrees
        assert zeros == pytest.approx([70.0 - apart, 70.0 + apart], abs=1e-7)


# extremes


def test_a_straight_line_is_highest_at_its_end() -> None:
    """By nothing beyond, though the sum of its series rounds."""
    pieces = pieces_at()
    for share in (0.1, 1 / 3, 0.7):
        ramp = (pieces.degrees / 360.0 * share)[None]
        ends = pieces.extremes(ramp)
        assert ends.largest[0, 0] == ramp.max()
        assert ends.largest_at[0, 0] == 360.0
        assert (ends.smallest[0, 0], ends.smallest_at[0, 0]) == (0.0, 0.0)


def test_what_is_rounding_of_the_terms_is_zero() -> None:
    pieces = pieces_at()
    values = (np.abs(of_angle(pieces, np.sin)) - 1e-16)[None]
    assert pieces.extremes(values).smallest[0, 0] == 0.0
    negative = pieces.extremes(-values)
    assert negative.largest[0, 0] == 0.0


def test_of_equal_summits_the_first_counts() -> None:
    """cos 2φ is as high at 0° as at 180°, where rounding may be higher; of a plateau its beginning."""
    pieces = pieces_at()
    twice = of_angle(pieces, lambda phi: np.cos(2 * (phi - 1.0)))
    twice[:, pieces.middle > 200.0] *= 1 + 4e-16
    ends = pieces.extremes(twice[None])
    assert ends.largest_at[0, 0] == pytest.approx(math.degrees(1.0), abs=1e-6)
    plateau = np.where((pieces.middle > 90.0) & (pieces.middle < 180.0), 1.0, 0.0)
    ends = pieces.extremes((plateau * np.ones((16, 1)))[None])
    assert ends.largest_at[0, 0] == 90.0


def test_a_flat_summit_is_found_where_it_is_highest() -> None:
    """A summit of a few degrees: not where it comes near its height, but at it."""
    pieces = pieces_at()
    ends = pieces.extremes(of_angle(pieces, lambda phi: np.cos(phi - 1.0))[None])
    assert ends.largest_at[0, 0] == pytest.approx(math.degrees(1.0), abs=1e-5)


def test_the_highest_magnitude_of_a_vector() -> None:
    """√(x² + y²) of an ellipse that is turned: its long half axis, on pieces whose samples are lower."""
    pieces = pieces_at()
    along = of_angle(pieces, lambda phi: np.cos(phi - 0.3))
    across = of_angle(pieces, lambda phi: np.sin(phi - 0.3)) * 0.999
    value, at = highest(
        pieces, np.stack((along, across)), lambda _, parts: [np.hypot(parts[0], parts[1])]
    )
    assert value[0, 0] == pytest.approx(1.0, rel=1e-14)
    assert at[0, 0] == pytest.approx(math.degrees(0.3), abs=1e-4)


def test_a_summit_between_nodes_may_be_higher_than_all_samples() -> None:
    """1 everywhere but on one piece, where a parabola of 1.0001 is lower than 1 at every node."""
    pieces = pieces_at()
    nodes = pieces.rule.nodes
    between = (nodes[7] + nodes[8]) / 2
    parabola = 1.0001 - 0.1 * (nodes - between) ** 2
    assert parabola.max() < 1
    values = np.where(pieces.low == 180.0, parabola[:, None], 1.0)
    extremes = pieces.extremes([values])
    assert extremes.largest[0, 0] == pytest.approx(1.0001, rel=1e-14)
    assert extremes.largest_at[0, 0] == pytest.approx(202.5 + 22.5 * between, abs=1e-6)


def test_extremes_of_two_quantities_and_two_machines_are_each_their_own() -> None:
    pieces = Pieces.between(Angles(np.array([0, 1]), np.array([33.0, 77.0])), 2, 360.0)
    phi = np.radians(pieces.degrees)
    ahead = np.where(pieces.machine == 0, 0.0, np.radians(30.0))
    values = [np.sin(phi - ahead), 2 * np.cos(phi - ahead)]
    extremes = pieces.extremes(values)
    assert extremes.largest_at == pytest.approx(np.array([[90.0, 120.0], [0.0, 30.0]]), abs=1e-6)
    assert extremes.smallest_at == pytest.approx(
        np.array([[270.0, 300.0], [180.0, 210.0]]), abs=1e-6
    )
    assert extremes.largest == pytest.approx(np.array([[1.0, 1.0], [2.0, 2.0]]), rel=1e-14)


def test_a_size_smaller_than_the_values_changes_no_extreme() -> None:
    pieces = pieces_at(100.0)
    for angle in np.linspace(1.0, 179.0, 30):
        values = [np.cos(2 * np.radians(pieces.degrees - angle))]
        extremes = pieces.extremes(values, np.zeros((1, 1)))
        assert extremes.largest_at[0, 0] == pytest.approx(angle, abs=1e-5)


def test_of_equal_extremes_the_first_one() -> None:
    first, second = Extreme(2.0, 30.0), Extreme(2.0, 10.0)
    assert largest(first, second) is first or largest(first, second) == first
    assert smallest(first, second) == first
    assert Extremes(Extreme(3.0, 90.0), Extreme(-3.0 * (1 + 1e-15), 80.0)).peak.degrees == 80.0
    assert Extremes(Extreme(3.0, 70.0), Extreme(-3.0 * (1 + 1e-15), 80.0)).peak.degrees == 70.0


# arithmetic


def test_sums_of_arrays_lose_nothing() -> None:
    assert total(np.array([1e16]), np.array([1.0]), np.array([-1e16])).tolist() == [1.0]


def test_whole_numbers_are_whole_but_for_rounding() -> None:
    assert is_whole(3.0 + 1e-12)
    assert not is_whole(3.0 + 1e-6)


def test_either_part_of_a_complex_sum_may_cancel() -> None:
    rounded = unless_cancelled(np.array([1e-17 + 1.0j, 1.0 - 1e-17j]), 1.0)
    assert rounded.tolist() == [1j, 1.0]
