"""Free forces and moments: against 40-digit sums, against the forces inside the machine, by symmetry and by law."""

import math
from typing import Any

import mpmath as mp
import numpy as np
import pytest
from numpy.testing import assert_allclose

from kurbel import loads
from kurbel.numerics.enclosing import ClosedCurve
from kurbel.solver.case import Case
from kurbel.solver.chapters.balance import MachineBalance

ANGLES = np.array([0.0, 7.3, 45.0, 90.0, 133.7, 180.0, 211.0, 299.9])
OMEGA = 20 * math.pi  # 600 rpm


def balance_of(text: str, *overrides: str) -> MachineBalance:
    return Case(loads(text, overrides=overrides)).balance


def longest(vector: ClosedCurve) -> tuple[float, float]:
    """The largest length of a vector, and the first angle in degrees with it."""
    top, degrees = vector.farthest()
    return float(top[0]), float(degrees[0])


def single(ratio: float = 4, more: str = "") -> str:
    return f"{{speed: 600 rpm, crank: 50 mm, rod_ratio: {ratio}, masses: {{reciprocating: 2 kg}}{more}}}"


def in_line(count: int, order: str, more: str = "") -> str:
    each = "{crank: 50 mm, rod_ratio: 4, masses: {reciprocating: 2 kg}}"
    several = f"{{count: {count}, firing_order: {order}, spacing: 100 mm, each: {each}}}"
    return f"{{speed: 600 rpm, cycle: four-stroke, cylinders: {several}{more}}}"


FOUR = in_line(4, "1-3-4-2")
SIX = in_line(6, "1-5-3-6-2-4")
V90 = """
speed: 600 rpm
cylinders:
  - {name: A, crank: 50 mm, rod_ratio: 4, masses: {reciprocating: 2 kg}, axial_position: 0 mm}
  - {like: A, name: B, bank_angle: 90 deg, crank_position: 90 deg, axial_position: 0 mm}
"""
TWO_CRANKS = """
speed: 600 rpm
cylinders:
  - {name: left, axial_position: -0.35 m, crank: 0.3 m, rod_ratio: 6, masses: {reciprocating: 300 kg, rotating: 120 kg}}
  - {like: left, name: right, crank_position: 90 deg, axial_position: 0.35 m}
"""


# against forty digits


def exact_force(
    lam: Any, e: Any, bank: float, late: float, masses: tuple[float, float], degrees: float
) -> Any:
    """Return F/(R ω²) in kg: minus the second derivatives of where the masses stand, by forty digits."""

    def place(phi: Any) -> Any:
        own = phi - mp.radians(mp.mpf(late))
        along = mp.cos(own) + mp.sqrt(1 / lam**2 - (mp.sin(own) - e) ** 2)
        whole = masses[0] * (along + 1j * e) + masses[1] * mp.expj(own)
        return whole * mp.expj(mp.radians(mp.mpf(bank)))

    return -mp.diff(place, mp.radians(mp.mpf(degrees)), 2)


@pytest.mark.parametrize(
    ("ratio", "offset"), [(20.0, 0.0), (4.0, 0.0), (3.0, 0.2), (1 / 0.95, 0.0), (1.25, 0.1)]
)
def test_forces_and_moments_against_forty_digits(ratio: float, offset: float) -> None:
    lines = ((0.0, 0.0, -0.1), (60.0, 17.0, 0.05), (-113.0, 240.0, 0.3))
    cylinders = [
        f"{{crank: 1 m, rod_ratio: {ratio!r}, offset: {offset} m, masses: {{other: 2 kg, rotating: 0.7 kg}}, "
        f"bank_angle: {bank} deg, crank_position: {late} deg, axial_position: {z} m}}"
        for bank, late, z in lines
    ]
    result = balance_of(f"{{speed: 600 rpm, cylinders: [{', '.join(cylinders)}]}}")
    columns = result.at(ANGLES)
    with mp.workdps(40):
        lam = 1 / mp.mpf(ratio)
        each = [
            [
                exact_force(lam, mp.mpf(offset), bank, late, (2.0, mp.mpf(0.7)), angle)
                for bank, late, _ in lines
            ]
            for angle in ANGLES
        ]
        force = np.array([complex(sum(row)) for row in each])
        moment = np.array(
            [complex(sum((z - 0.1) * one for (_, _, z), one in zip(lines, row))) for row in each]
        )
    unit = 2.0 * OMEGA**2
    assert np.abs((columns.F_x + 1j * columns.F_y) / unit - force / 2).max() < 1e-13
    assert np.abs((columns.M_x + 1j * columns.M_y) / unit - moment / 2).max() < 1e-13


@pytest.mark.parametrize(
    ("ratio", "series"),
    [
        (4, {2: 0.254025042307, 4: -0.004098111172, 6: 7.437903e-5, 8: -1.33329150483e-6}),
        (3, {2: 0.343108577285, 4: -0.010099079152, 6: 3.344321533e-4}),
    ],
)
def test_orders_of_one_cylinder(ratio: float, series: dict[int, float]) -> None:
    """b/(R ω²) = cos φ + A₂ cos 2φ + …: forward and backward circle are half of each."""
    force = balance_of(single(ratio)).free.force
    assert abs(force.of(1)[0] / 0.1 - 0.5) < 1e-16
    for order, figure in series.items():
        assert force.of(order)[0] == force.of(-order)[0].conjugate()
        assert force.of(order)[0].real / 0.05 == pytest.approx(
            figure, rel=1e-7 if order == 6 else 1e-11
        )
    assert not force.waves[(force.numbers > 1) & (force.numbers % 2 == 1)].any()


# against the forces inside

INSIDE = """
speed: 600 rpm
cylinders:
  - crank: 50 mm
    rod: 170 mm
    offset: 12 mm
    bore: 80 mm
    indicator: {head_end: {constant: {expansion: 8 bar, compression: 1 bar}}}
    masses: {piston: 2 kg, rotating: 0.9 kg, connecting_rod: ROD}
"""


@pytest.mark.parametrize(
    "rod", ["{mass: 1.5 kg, center_of_gravity: 60 mm, inertia: 0.008 kg m2}", "{mass: 1.5 kg}"]
)
def test_bearing_guide_and_gas_make_up_the_free_force_and_the_rolling_moment(rod: str) -> None:
    case = Case(loads(INSIDE.replace("ROD", rod)))
    (forces,), result = case.cylinders, case.balance.at(ANGLES)
    inside = forces.at(ANGLES)
    throw = np.exp(1j * np.radians(ANGLES))
    drive = forces.drive
    rotating = 0.9 if drive.rod else 0.9 + 0.75  # D of an exact rod has its pull already
    bearing = (-inside.D + 1j * inside.T) * throw + rotating * 0.05 * OMEGA**2 * throw
    force = bearing - 1j * inside.N + inside.P_gas
    assert_allclose(
        result.F_x + 1j * result.F_y, force, rtol=0, atol=1e-13 * np.abs(inside.P_gas).max()
    )
    # N presses on the guide where the crosshead is, the gas on the cover beside the axis of the shaft
    far = 0.05 * np.cos(np.radians(ANGLES)) + np.sqrt(
        0.17**2 - (0.05 * np.sin(np.radians(ANGLES)) - 0.012) ** 2
    )
    roll = -inside.N * far - 0.012 * inside.P_gas
    assert_allclose(result.M_roll, roll, rtol=0, atol=1e-12 * np.abs(roll).max())
    assert case.balance.M_roll_max.value >= roll.max()


# by symmetry


def test_what_cancels_is_exactly_zero() -> None:
    six = balance_of(SIX)
    assert six.free.orders == (1, 2, 4, 6, 8, 10)
    for circles, left in ((six.free.force, {6, 12, 18}), (six.free.moment, set())):
        assert {abs(n) for n, c in zip(circles.numbers, circles.waves) if c.any()} == left
    assert abs(six.free.force.of(6)[0]) == pytest.approx(6 * 0.05 * 7.437903e-5, rel=1e-6)
    assert (six.M_free_max.value, six.M_free_max.degrees) == (0.0, 0.0)
    assert not six.at(ANGLES).M_x.any()


@pytest.mark.parametrize(
    ("banks", "late"),
    [
        ((0, 180), (0, 0)),  # boxer: pins at 180°
        ((0, 120, 240), (0, 120, 240)),  # radial: order 1 forward is left, and order 2 backward
        ((0, 72, 144, 216, 288), (0, 72, 144, 216, 288)),
    ],
)
def test_forces_by_symmetry(banks: tuple[int, ...], late: tuple[int, ...]) -> None:
    """A radial engine of k cylinders keeps k/2 m R ω² of order 1, turning with the crank, none against it."""
    cylinder = "{name: %s, crank: 50 mm, rod_ratio: 4, masses: {other: 2 kg}, bank_angle: %s deg, crank_position: %s deg}"
    several = ", ".join(cylinder % (k, bank, one) for k, (bank, one) in enumerate(zip(banks, late)))
    force = balance_of(f"{{speed: 600 rpm, cylinders: [{several}]}}").free.force
    if len(banks) == 2:
        assert not force.waves.any()
    else:
        assert abs(force.of(1)[0] / 0.1 - len(banks) / 2) < 1e-14
        assert force.of(-1)[0] == 0
        assert (force.of(-2)[0] == 0) == (len(banks) != 3)


def test_ninety_degrees_with_a_counterweight_of_one_mass() -> None:
    """First order 0; of second order √2 A₂ m R ω² is left across the middle of the V."""
    result = balance_of(V90, "counterweights=[{product: 0.1 kg m}]")
    force = result.free.force
    assert (force.of(1)[0], force.of(-1)[0]) == (0, 0)
    assert abs(force.of(2)[0]) + abs(force.of(-2)[0]) == pytest.approx(
        math.sqrt(2) * 0.1 * 0.254025042307, rel=1e-11
    )
    assert result.F_free_max.value == pytest.approx(result.F_free_best.value, rel=1e-13)


# counterweights


def test_the_best_share_of_one_cylinder() -> None:
    """λ = ¼: what the dead centre leaves, 1 + λ − c, is as large as the largest beside 100°, by thirty digits."""
    result = balance_of(single())
    unit = 0.1 * OMEGA**2

    def beside(c: Any) -> Any:
        def square(phi: Any) -> Any:
            b = -mp.diff(lambda p: mp.cos(p) + mp.sqrt(16 - mp.sin(p) ** 2), phi, 2)
            return (b - c * mp.cos(phi)) ** 2 + (c * mp.sin(phi)) ** 2

        return mp.sqrt(square(mp.findroot(lambda phi: mp.diff(square, phi), mp.mpf("1.76"))))

    with mp.workdps(30):
        share = mp.findroot(
            lambda c: beside(c) - (mp.mpf("1.25") - c), (0.589, 0.591), solver="secant"
        )
    assert result.share_best == pytest.approx(float(share), abs=1e-12)
    assert result.F_free_best.value / unit == pytest.approx(1.25 - float(share), abs=1e-12)
    assert (result.counterweight_least, result.counterweight_least_angle) == pytest.approx(
        (0.1 * float(share), 180.0)
    )


def three_throws(of_first: str, of_machine: str = "") -> str:
    """Three throws; the masses are on the second, and the weights of the first cylinder and of the machine as given."""
    return f"""
speed: 600 rpm
{of_machine}
cylinders:
  - {{name: c, crank: 100 mm, rod: 400 mm, axial_position: 0 m{of_first}}}
  - {{name: b, crank: 100 mm, rod: 400 mm, axial_position: 0.2 m, crank_position: 90 deg, masses: {{piston: 1 kg}}}}
  - {{name: a, crank: 100 mm, rod: 400 mm, axial_position: 0.4 m, crank_position: 180 deg}}
"""


@pytest.mark.parametrize(
    ("of_first", "of_machine", "place"),
    [
        (", counterweights: [{product: 0.1 kg m, angle: 30 deg}]", "", 0.0),
        ("", "counterweights: [{product: 0.1 kg m, angle: 30 deg, axial_position: 0.3 m}]", 0.3),
    ],
)
def test_weights_belong_to_throws_whether_or_not_these_have_masses(
    of_first: str, of_machine: str, place: float
) -> None:
    with_weight, bare = (
        balance_of(three_throws(*texts)) for texts in ((of_first, of_machine), ("", ""))
    )
    added = 0.1 * OMEGA**2 * np.exp(1j * np.radians(ANGLES + 30))  # u ω² from throw 1
    columns, without = with_weight.at(ANGLES), bare.at(ANGLES)
    assert_allclose(columns.F_x - without.F_x, added.real, atol=1e-12 * OMEGA**2)
    assert_allclose(columns.F_y - without.F_y, added.imag, atol=1e-12 * OMEGA**2)
    assert_allclose(columns.M_x - without.M_x, added.real * (place - 0.2), atol=1e-12 * OMEGA**2)
    # the direction of the best weight counts from throw 1, 90° ahead of the only mass
    assert bare.counterweight_best_angle == pytest.approx(90, abs=1e-12)


def test_weights_alone_turn_as_well() -> None:
    lonely = balance_of(
        "{speed: 600 rpm, crank: 50 mm, rod: 200 mm, counterweights: [{product: 0.1 kg m}]}"
    )
    assert lonely.F_free_max.value == pytest.approx(0.1 * OMEGA**2, rel=1e-14)
    assert lonely.counterweight_best == 0


def test_planes_of_a_share_need_no_place_of_a_throw_without_masses() -> None:
    text = three_throws("", "counterweights: {share: 0.5, planes: [0 m, 0.4 m]}").replace(
        "axial_position: 0.4 m, ", ""
    )
    weights = balance_of(text).counterweights
    assert [weight.place for weight in weights] == [0.0, 0.4]


def test_no_counterweight_has_no_direction() -> None:
    """The largest forces, at 90 and 270 deg, are opposite in the frame of the crank: no weight lessens both."""
    opposite = V90.replace("bank_angle: 90", "bank_angle: -45").replace(
        "position: 90", "position: 180"
    )
    result = balance_of(opposite.replace("rod_ratio: 4", "rod_ratio: 1.55"))
    assert (result.counterweight_least, result.counterweight_least_angle) == (0, None)


@pytest.mark.parametrize(("share", "left"), [("0", 1.25), ("0.5", 0.75), ("2/3", 0.722784)])
def test_what_a_share_leaves(share: str, left: float) -> None:
    result = balance_of(single(4, f", counterweights: {{share: {share}}}"))
    assert result.F_free_max.value / (0.1 * OMEGA**2) == pytest.approx(left, abs=5e-6)
    assert result.counterweight_given == pytest.approx(0.1 * eval(share))


def test_weights_in_two_planes_take_away_all_that_turns_with_the_crank() -> None:
    result = balance_of(TWO_CRANKS)
    weights = ", ".join(
        f"{{product: {abs(best_in_plane.product)!r} kg m, angle: {math.degrees(np.angle(best_in_plane.product))!r} deg, "
        f"axial_position: {best_in_plane.place} m}}"
        for best_in_plane in result.best_in_planes
    )
    free = balance_of(TWO_CRANKS, f"counterweights=[{weights}]").free
    assert abs(free.force.of(1)[0]) < 1e-12 * abs(result.bare.force.of(1)[0])
    assert abs(free.moment.of(1)[0]) < 1e-12 * abs(result.bare.moment.of(1)[0])


def test_lanchester_shafts() -> None:
    """Four in line: two shafts at twice the speed in the middle, one each way, leave order 4."""
    result = balance_of(FOUR)
    assert [(best_shaft.order, best_shaft.place) for best_shaft in result.best_shafts] == [
        (2, pytest.approx(0.15)),
        (-2, pytest.approx(0.15)),
    ]
    product = abs(result.best_shafts[0].product)
    assert product == pytest.approx(4 * 0.1 * 0.254025042307 / 2 / 4, rel=1e-11)
    shafts = ", ".join(
        f"{{order: 2, sense: {sense}, product: {product!r} kg m, axial_position: 150 mm}}"
        for sense in ("with", "against")
    )
    free = balance_of(FOUR, f"balance_shafts=[{shafts}]").free
    assert free.force.of(2)[0] == free.force.of(-2)[0] == 0
    assert free.force.of(4)[0].real == pytest.approx(-4 * 0.05 * 0.004098111172, rel=1e-9)
    assert not free.moment.waves.any()


def first_order_left(text: str, weights: list[str], shafts: list[str]) -> list[float]:
    """What these counterweights and shafts leave of order 1, with the crank and against it: forces and moments."""
    free = balance_of(
        text, f"counterweights=[{', '.join(weights)}]", f"balance_shafts=[{', '.join(shafts)}]"
    ).free
    curves = [free.force] if free.moment is None else [free.force, free.moment]
    return [abs(complex(curve.of(order)[0])) for curve in curves for order in (1, -1)]


def written(one: Any, more: str = "") -> str:
    """A weight as a file has it."""
    place = "" if one.place is None else f", axial_position: {one.place!r} m"
    angle = math.degrees(np.angle(one.product))
    return f"{{product: {abs(one.product)!r} kg m, angle: {angle!r} deg{place}{more}}}"


AGAINST = ", order: 1, sense: against"


def test_half_a_counterweight_and_a_shaft_against_the_crank_leave_no_first_order_of_one_cylinder() -> (
    None
):
    """m R cos φ is ½ m R with the crank and ½ m R against it: each is taken away by a weight that turns as it does."""
    result = balance_of(single())
    (shaft,) = (best_shaft for best_shaft in result.best_shafts if best_shaft.order == -1)
    assert (abs(shaft.product), shaft.product.real < 0) == (pytest.approx(0.5 * 2 * 0.05), True)
    left = first_order_left(single(), ["{product: 0.05 kg m}"], [written(shaft, AGAINST)])
    assert left == pytest.approx([0, 0], abs=1e-16)


@pytest.mark.parametrize(
    ("text", "behind"),
    [(in_line(3, "1-3-2"), [0, 240, 120]), (in_line(5, "1-2-4-5-3"), [0, 144, 216, 288, 72])],
    ids=["three", "five"],
)
def test_a_shaft_with_a_couple_takes_away_the_first_order_moment_of_odd_engines(
    text: str, behind: list[int]
) -> None:
    """Each cylinder has ½ m R with its crank and ½ m R against it, whose moments about the middle are added up."""
    result, half = balance_of(text), 0.5 * 2 * 0.05
    span = 0.1 * (len(behind) - 1)
    places = [0.1 * k - span / 2 for k in range(len(behind))]
    couple = half * abs(
        sum(z * np.exp(1j * math.radians(angle)) for z, angle in zip(places, behind))
    )
    shaft = [best_shaft for best_shaft in result.best_shafts if best_shaft.order == -1]
    assert [one.place for one in shaft] == pytest.approx([0, span])
    assert [abs(one.product) for one in shaft] == pytest.approx([couple / span] * 2, rel=1e-12)
    assert abs(sum(one.product for one in shaft)) < 1e-14
    if len(behind) == 3:  # √3 m R D of Bloch & Hoefner p. 91, half of it each way, on an arm of 2 D
        assert couple / span == pytest.approx(math.sqrt(3) / 4 * 2 * 0.05)

    left = first_order_left(
        text, [*map(written, result.best_in_planes)], [written(one, AGAINST) for one in shaft]
    )
    assert left == pytest.approx([0] * 4, abs=1e-12 * couple)


def test_a_locomotive() -> None:
    """Infinite rod: √2 (1 − c) m R ω² and (1 − c) m R ω² a/√2 of the books, and the blow as by a lever."""
    result = balance_of(
        TWO_CRANKS.replace("rod_ratio: 6", "rod: infinite"),
        "counterweights={share: 0.6}",
        "locomotive={wheel_distance: 1.6 m, wheel_diameter: 1.7 m, wheel_load: 80 kN, hammer_limit: 40 kN}",
    )
    unit = 300 * 0.3 * OMEGA**2
    assert result.traction_variation.value == pytest.approx(math.sqrt(2) * 0.4 * unit)
    assert result.swaying_couple.value == pytest.approx(0.4 * unit * 0.7 / math.sqrt(2))
    blow = math.hypot(1.6 + 0.7, 1.6 - 0.7) / (2 * 1.6) * unit
    assert result.hammer_blow == pytest.approx(0.6 * blow)
    assert result.share_allowed == pytest.approx(40e3 / blow)
    assert result.hammer_speed == pytest.approx(10 * math.sqrt(80e3 / (0.6 * blow)))
    assert result.hammer_train_speed == pytest.approx(result.hammer_speed * math.pi * 1.7)
    assert result.train_speed == pytest.approx(10 * math.pi * 1.7)


def test_the_whole_counterweight_in_each_wheel() -> None:
    """Khurmi & Gupta, Theory of Machines, 22.1: 105 kg at 0.6 m in each wheel, 20° from opposite the crank."""
    result = balance_of(
        "{speed: 300 rpm, cylinders: [{name: B, crank: 300 mm, rod: infinite, axial_position: -350 mm, masses: "
        "{reciprocating: 180 kg, rotating: 150 kg}}, {like: B, axial_position: 350 mm, crank_position: 90 deg}]}",
        "counterweights={share: 2/3}",
        "locomotive={wheel_distance: 1.5 m}",
    )
    weights = np.array(result.in_wheels("counterweights"))
    product = 270 * 0.3 * math.hypot(1.1, 0.4) / 1.5
    assert_allclose(np.abs(weights), product)
    assert result.counterweight_wheel == pytest.approx(product)
    assert round(product / 0.6) == 105
    aside = math.degrees(math.atan(0.4 / 1.1))  # crank B leads here, in the book it follows
    assert_allclose(sorted(np.degrees(np.angle(weights)) % 360), [90 + aside, 180 - aside])


@pytest.mark.parametrize("place", [300, -300])
def test_the_larger_counterweight_of_both_wheels_is_the_one_shown(place: int) -> None:
    """By the lever: of 10 kg m at 300 mm from the middle the nearer of two wheels 1.5 m apart carries 7 kg m."""
    result = balance_of(
        "{speed: 300 rpm, cylinders: [{name: B, crank: 300 mm, rod: infinite, axial_position: -350 mm, masses: "
        "{reciprocating: 180 kg}}, {like: B, axial_position: 350 mm, crank_position: 90 deg}]}",
        f"counterweights=[{{product: 10 kg m, angle: 180 deg, axial_position: {place} mm}}]",
        "locomotive={wheel_distance: 1.5 m}",
    )
    assert result.counterweight_wheel == pytest.approx(7.0, rel=1e-12)


def test_the_book_next_to_the_exact() -> None:
    result = balance_of(FOUR)
    assert longest(result.book.force)[0] == pytest.approx(4 * 0.1 * 0.25, rel=1e-14)
    assert_allclose(
        result.at(ANGLES).F_x_book, 0.1 * OMEGA**2 * np.cos(np.radians(2 * ANGLES)), atol=1e-10
    )
    assert balance_of(single(4, ", offset: 10 mm")).book is None
    yoke = balance_of(
        "{speed: 600 rpm, mechanism: scotch-yoke, crank: 50 mm, masses: {reciprocating: 2 kg}}"
    )
    assert_allclose(yoke.book.force.of(1), yoke.free.force.of(1))


def test_moments_about_another_place() -> None:
    """M changes by the free force times the way."""
    near, far = balance_of(FOUR).at(ANGLES), balance_of(FOUR, "moment_reference=0 mm").at(ANGLES)
    assert_allclose(far.M_x - near.M_x, 0.15 * near.F_x, atol=1e-9)


@pytest.mark.parametrize("odd", [0.0, 1e-3])
def test_the_smallest_circle_round_a_curve_of_even_waves(odd: float) -> None:
    """An ellipse of the half-axes 1.5 and 0.5 about 1 + 2i, drawn twice; a small odd wave widens it by its size."""
    waves = np.zeros((5, 1), complex)
    waves[:, 0] = [0.5, 0.0, 1 + 2j, odd, 1.0]
    centre, radius, _ = ClosedCurve(waves).least_circle()
    assert centre[0] == pytest.approx(1 + 2j, abs=1.01 * odd + 1e-12)
    assert radius[0] == pytest.approx(1.5, abs=1.01 * odd + 1e-12)


def test_the_smallest_circle_round_a_curve_of_odd_waves_is_about_0() -> None:
    """c(φ + 180°) = −c(φ): the farthest point and its image carry the circle."""
    waves = np.zeros((7, 1), complex)
    waves[:, 0] = [0.2j, 0.0, 0.1, 0.0, 1.0, 0.0, 0.3]
    centre, radius, _ = ClosedCurve(waves).least_circle()
    phi = np.linspace(0.0, 2 * np.pi, 100_001)
    curve = sum(wave * np.exp(1j * number * phi) for number, wave in zip(range(-3, 4), waves[:, 0]))
    assert centre[0] == 0
    assert radius[0] == pytest.approx(np.abs(curve).max(), rel=1e-8)
