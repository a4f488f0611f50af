"""Equal cylinders are shown once to people and each to programs; where the cranks of a firing order are."""

import pytest

from command import printed
from representative import CONFIGS, few

FOUR = str(CONFIGS["four-cylinder-generator"])
EQUAL = """
speed: 600 rpm
cycle: four-stroke
cylinders: {count: 4, firing_order: 1-3-4-2, each: {crank: 50 mm, rod: 200 mm, masses: {piston: 1 kg}}}
"""
V8 = """
speed: 1500 rpm
cycle: four-stroke
cylinders:
  count: 8
  firing_order: 1-5-4-2-6-3-7-8
  bank_angles: [0 deg, {bank} deg]
  each: {{stroke: 90 mm, rod: 150 mm, masses: {{piston: 0.5 kg}}}}
"""


FORMS = [[], ["--key-values"], ["-f", "markdown"], ["--layout", "rows"]]


@pytest.mark.parametrize("form", few(FORMS, FORMS[1:3]))
def test_four_equal_cylinders_stand_once_on_a_page(form: list[str]) -> None:
    page = printed("forces", "-", *form, text=EQUAL).replace("\\", "")
    one = printed("forces", "-", *form, "--cylinder", "cylinder 3", text=EQUAL).replace("\\", "")
    assert page.replace("cylinders 1–4", "cylinder 3") == one
    assert page.splitlines()[0].endswith("Forces in the crank train: cylinders 1–4")


def test_check_reports_equal_ones_once_and_each_of_their_cranks() -> None:
    page = printed("check", FOUR)
    assert page.count("left out   weight: no inclination given") == 1
    assert "\ncylinders 1–4\n" in page
    lines = page.split("\nCranks\n")[1].split("\n\n")[0].splitlines()
    assert lines == [
        f"  cylinder {n}  {at} deg after the first, crank pin {pin} deg behind the first"
        for n, at, pin in ((1, 0, 0), (2, 540, 180), (3, 180, 180), (4, 360, 0))
    ]
    assert "Cranks" not in printed("check", str(CONFIGS["waterworks"]))


def test_one_that_differs_is_alone() -> None:
    """The third has no bore: the others are shown together, their limits too."""
    each = "{crank: 50 mm, rod: 200 mm, masses: {piston: 1 kg}}"
    text = f"speed: 600 rpm\ncylinders: [{each}, {each}, {each.replace('1 kg', '2 kg')}, {each}]\n"
    text += "limits: {b_max: 1 km/s2}\n"
    page = printed("forces", "-", "--key-values", text=text)
    heads = [line for line in page.splitlines() if line.startswith("Key values")]
    assert heads == ["Key values: cylinders 1, 2, 4", "Key values: cylinder 3"]
    (limit,) = (line for line in printed("check", "-", text=text).splitlines() if "PASS" in line)
    assert limit.endswith("(cylinders 1–4)")


def pins(bank: int) -> dict[str, int]:
    page = printed("check", "-", text=V8.format(bank=bank)).split("\nCranks\n")[1].split("\n\n")[0]
    return {
        line[2:12]: int(line.rpartition(": crank pin ")[2].split()[0]) for line in page.splitlines()
    }


def test_check_reports_where_a_firing_order_puts_the_pins() -> None:
    """Firing intervals of 90°: cylinder 5 at 90°, 4 at 180°, ...; a pin stands γ − β behind that of cylinder 1."""
    fires = {number: 90 * place for place, number in enumerate((1, 5, 4, 2, 6, 3, 7, 8))}
    for bank in (90, -90):
        expected = {f"cylinder {n}": (fires[n] - (0 if n % 2 else bank)) % 360 for n in range(1, 9)}
        assert pins(bank) == expected
    assert pins(90) != pins(-90)
