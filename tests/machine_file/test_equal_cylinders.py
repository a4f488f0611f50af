"""Equal cylinders: one `like` another, or several at once, and what a firing order makes of their cranks."""

import itertools
import random

import pytest

from kurbel.machine import Cylinder
from kurbel.machine.several import intervals
from kurbel.machine_file import loads

EACH = "each: {stroke: 80 mm, rod_ratio: 4}"


def equal(keys: str, cycle: str = "four-stroke") -> tuple[Cylinder, ...]:
    return loads(f"cycle: {cycle}\ncylinders: {{{keys}, {EACH}}}").cylinders


def throws(cylinders: tuple[Cylinder, ...]) -> list[float]:
    """Where the throws stand in space when crank 1 is at its inner dead centre: γ − β (formulas of the free forces)."""
    return [(cylinder.bank_angle - cylinder.crank_position) % 360 for cylinder in cylinders]


def test_the_cross_plane_v8_has_two_rods_on_each_pin() -> None:
    """Chevrolet small block, firing order 1-8-4-3-6-5-7-2, odd numbers on one bank: throws at 0, 90, 270, 180."""
    cylinders = equal(
        "count: 8, firing_order: 1-8-4-3-6-5-7-2, spacing: 112 mm, bank_angles: [0 deg, -90 deg]"
    )
    assert throws(cylinders) == [0, 0, 90, 90, 270, 270, 180, 180]
    assert [cylinder.axial_position for cylinder in cylinders][::2] == pytest.approx(
        [0, 0.112, 0.224, 0.336]
    )


def test_the_boxer_has_opposite_throws_for_opposite_cylinders() -> None:
    """Volkswagen, 1-4-3-2, cylinders 1 and 2 on the right, 3 and 4 on the left."""
    banks = "bank_angles: [0 deg, 0 deg, 180 deg, 180 deg]"
    assert throws(equal(f"count: 4, firing_order: 1-4-3-2, {banks}")) == [0, 180, 180, 0]


@pytest.mark.parametrize("order", ["firing_order: 1-3-5-2-4, ", ""])
def test_the_radial_engine_has_one_pin(order: str) -> None:
    banks = "[0 deg, 72 deg, 144 deg, 216 deg, 288 deg]"
    cylinders = equal(f"count: 5, {order}spacing: 1 m, bank_angles: {banks}")
    assert throws(cylinders) == [0] * 5
    assert {cylinder.axial_position for cylinder in cylinders} == {0}


def test_banks_lean_in_the_sense_of_rotation() -> None:
    """N and its weight point down where the cylinder lies to the left of a shaft that turns over: angles add."""
    text = "cylinders: {count: 2, bank_angles: [0 deg, 90 deg], each: {inclination: 135 deg, crank: 1 m, rod: 4 m}}"
    assert [cylinder.inclination for cylinder in loads(text).cylinders] == [135, -135]


def test_a_firing_order_with_a_list_needs_not_begin_with_1() -> None:
    rows = "\n".join("  - {stroke: 80 mm, rod_ratio: 4}" for _ in range(3))
    machine = loads(f"firing_order: 2-3-1\ncylinders:\n{rows}\n")
    assert [cylinder.crank_position for cylinder in machine.cylinders] == [0, 120, 240]


def test_a_cylinder_is_like_another_but_for_what_is_there() -> None:
    machine = loads(
        "cylinders:\n"
        "  - {name: HP, crank: 400 mm, rod: 2 m, bore: 450 mm, masses: {piston: 100 kg}}\n"
        "  - {like: HP, stroke: 600 mm, crank_position: 90 deg}\n"
        "  - {name: LP, like: cylinder 2, rod_ratio: 5, bore: 700 mm}\n"
    )
    _, second, low = machine.cylinders
    assert [cylinder.name for cylinder in machine.cylinders] == ["HP", "cylinder 2", "LP"]
    assert (second.mechanism.crank, second.mechanism.rod, second.pistons[0].bore) == (0.3, 2, 0.45)
    assert (low.mechanism.rod, low.pistons[0].bore, low.crank_position) == (1.5, 0.7, 90)
    assert low.masses.parts == 100


# turns of a four-stroke cycle


def positions(keys: str, cycle: str = "four-stroke") -> list[float]:
    return [one.crank_position for one in equal(keys, cycle)]


def degrees(*numbers: float) -> str:
    return f"[{', '.join(f'{number!r} deg' for number in numbers)}]"


@pytest.mark.parametrize(
    ("keys", "expected"),
    [
        (
            "count: 2, bank_angles: [0 deg, 90 deg]",
            [0, 450],
        ),  # Ducati and Moto Guzzi fire 450 and 270 deg apart
        ("count: 2, bank_angles: [0 deg, 45 deg]", [0, 405]),  # Harley-Davidson: 405 and 315 deg
        ("count: 2, spacing: 0 mm, bank_angles: [0 deg, 60 deg]", [0, 420]),
        (
            "count: 2, crank_positions: [0 deg, 0 deg]",
            [0, 360],
        ),  # a parallel twin with level pistons
        ("count: 2, crank_positions: [0 deg, 180 deg]", [0, 180]),  # 180 and 540 deg either way
        ("count: 2, bank_angles: [0 deg, 90 deg], crank_positions: [0 deg, 270 deg]", [0, 270]),
        ("count: 3, crank_positions: [0 deg, 120 deg, 240 deg]", [0, 480, 240]),
        (
            "count: 4, crank_positions: [0 deg, 180 deg, 180 deg, 0 deg]",
            [0, 180, 540, 360],
        ),  # 1-2-4-3 and 1-3-4-2
        # the cross-plane crank of the Yamaha R1, 270-180-90-180
        ("count: 4, crank_positions: [0 deg, 450 deg, 270 deg, 540 deg]", [0, 450, 270, 540]),
    ],
)
def test_each_cylinder_fires_in_the_turn_that_is_most_even(
    keys: str, expected: list[float]
) -> None:
    assert positions(keys) == expected


@pytest.mark.parametrize("count", [3, 5, 7, 9, 11])
def test_a_radial_engine_fires_every_other_cylinder(count: int) -> None:
    """1-3-5-…-2-4-…, which needs an odd number of cylinders: every textbook of aircraft engines."""
    fired = positions(
        f"count: {count}, bank_angles: {degrees(*(360 / count * i for i in range(count)))}"
    )
    order = sorted(range(1, count + 1), key=lambda number: fired[number - 1])
    assert order == [*range(1, count + 1, 2), *range(2, count + 1, 2)]


def test_as_in_an_exhaustive_search() -> None:
    """Every combination of turns written out, with its sum of squares and its order as the rule says them."""
    draw = random.Random(25)
    for _ in range(40):
        pins = [0, *(draw.choice(range(0, 360, 30)) for _ in range(draw.randrange(1, 6)))]
        every = [
            [0, *turned] for turned in itertools.product(*((pin, pin + 360) for pin in pins[1:]))
        ]
        assert positions(f"count: {len(pins)}, crank_positions: {degrees(*pins)}") == min(
            every, key=_reads
        )


def _reads(angles: list[int]) -> tuple[int, list[int], list[int]]:
    order = sorted(range(len(angles)), key=lambda place: (angles[place], place))
    at = [*(angles[place] for place in order), 720]
    return sum((after - one) ** 2 for one, after in itertools.pairwise(at)), order, angles


def test_intervals_end_where_the_first_fires_again() -> None:
    assert intervals([450.3, 90.1, 270.2], 720) == [180.1, 180.1, 359.8]


def test_what_is_written_of_the_turn_holds() -> None:
    """A crank position of a listed cylinder, a firing order, and positions that reach into the second turn."""
    row = "{stroke: 80 mm, rod_ratio: 4, bank_angle: 90 deg"
    for said, expected in (
        ("", 360),
        (", crank_position: 90 deg", 90),
        (", crank_position: 0 deg", 0),
    ):
        listed = loads(
            f"cycle: four-stroke\ncylinders:\n- {{stroke: 80 mm, rod_ratio: 4}}\n- {row}{said}}}\n"
        )
        assert [cylinder.crank_position for cylinder in listed.cylinders] == [0, expected]
    assert positions("count: 2, firing_order: 1-2, bank_angles: [0 deg, 90 deg]") == [0, 360]
    assert positions("count: 4, crank_positions: [0 deg, 540 deg, 180 deg, 360 deg]") == [
        0,
        540,
        180,
        360,
    ]
