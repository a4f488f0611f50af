"""Keys on which others hang vary with them: each row of a sweep is the machine that is read with its values."""

from collections.abc import Sequence

import numpy as np
import pytest

from kurbel import sweep

EACH = "{stroke: 80 mm, rod_ratio: 4, bore: 70 mm, masses: {piston: 1 kg}, indicator: {head_end: {otto: %s}}}"
EACH %= "{intake: 0 bar, exhaust: 0 bar, compression_ratio: 8, peak: 40 bar}"
TWIN = "{speed: 600 rpm, cycle: %s, cylinders: {count: 3, %s: [0 deg, 60 deg, 90 deg], each: %s}}"
BANKS, PINS = (TWIN % ("four-stroke", key, EACH) for key in ("bank_angles", "crank_positions"))
LISTED = f"{{speed: 600 rpm, cycle: four-stroke, cylinders: [{EACH}, {{like: cylinder 1, crank_position: 9 deg}}]}}"
LIKE = """
speed: 60 rpm
cylinders:
  - {name: a, crank: 1 m, rod: 5 m, bore: 1 m, indicator: {head_end: 3 bar}, masses: {piston: 3 kg}}
  - {name: b, like: a, crank_position: 90 deg, masses: {piston: 4 kg}}
  - {name: c, like: b, bore: 2 m, crank_position: 180 deg}
"""


@pytest.mark.parametrize(
    ("text", "inputs", "columns"),
    [
        (
            BANKS,
            {"cylinders.bank_angles.1": "60 deg,120 deg,-60 deg,359 deg,0 deg,90 deg"},
            ["M_max", "dE"],
        ),
        (BANKS, {"cylinders.each.stroke": "80 mm,90 mm"}, ["M_max", "dE"]),
        (
            PINS,
            {"cylinders.crank_positions.2": "90 deg,240 deg,450 deg,360 deg,-30 deg"},
            ["M_max", "dE"],
        ),
        (LISTED, {"cylinders.1.crank_position": "0 deg,90 deg,450 deg"}, ["M_max", "dE"]),
        (
            LIKE,
            {"cylinders.0.bore": "2 m,3 m,4 m", "cylinders.1.masses.piston": "5 kg,6 kg,-6 kg"},
            ["P_max"],
        ),
    ],
    ids=["bank angles", "stroke", "crank positions", "a crank position", "like another"],
)
def test_each_row_is_the_machine_with_its_values(
    text: str, inputs: dict[str, str], columns: Sequence[str]
) -> None:
    """What a bank angle leaves open, the turn in which a cylinder fires, each row decides for itself."""
    rows = {key: values.split(",") for key, values in inputs.items()}
    together = sweep(text, rows, columns)
    for row in range(len(together["failure"])):
        alone = sweep(text, {key: [values[row]] for key, values in rows.items()}, columns)
        for name, values in together.items():
            if name == "failure":
                assert values[row] == alone[name][0]
            else:
                assert np.asarray(values[row]) == pytest.approx(
                    np.asarray(alone[name][0]), rel=1e-12, nan_ok=True
                ), name


def test_a_cylinder_that_is_like_another_varies_with_it() -> None:
    found = sweep(LIKE, {"cylinders.0.bore": ["2 m", "3 m"]}, ["A_head"])
    areas = [found[f"{name}.A_head"] for name in "abc"]
    assert areas == [
        pytest.approx(np.pi / 4 * np.array(bores) ** 2) for bores in ([2, 3], [2, 3], [2, 2])
    ]
