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


@pytest.mark.parametrize("key", ["pegging.angle", "pegging.pressure"])
def test_keys_within_a_trace_vary_with_another_key(key: str) -> None:
    """A trace is of one machine: numbers within it are read row by row, however deep they are."""
    points = ", ".join(
        f"[{angle}, {60 * np.exp(-((angle - 180) ** 2) / 800):.4f}]" for angle in range(0, 361, 5)
    )
    pegging = "{angle: 90 deg, pressure: 0.5 bar}"
    text = (
        "{speed: 600 rpm, crank: 70 mm, rod: 200 mm, bore: 100 mm, masses: {piston: 2 kg, "
        "connecting_rod: {mass: 3 kg, share: 0.4}}, "
        f"indicator: {{head_end: {{trace: {{unit: bar, points: [{points}], pegging: {pegging}}}}}}}}}"
    )
    unit = "deg" if key.endswith("angle") else "bar"
    inputs = {
        f"indicator.head_end.trace.{key}": [f"{value} {unit}" for value in (41, 0.5, 73, 90)],
        "masses.connecting_rod.share": ["0.2", "0.4", "0.6", "0.8"],
    }
    together = sweep(text, inputs, ["T_max"])
    for row in range(4):
        alone = sweep(text, {name: [values[row]] for name, values in inputs.items()}, ["T_max"])
        assert together["T_max"][row] == pytest.approx(alone["T_max"][0], rel=1e-12)


def test_a_cylinder_that_is_like_another_varies_with_it() -> None:
    result = sweep(LIKE, {"cylinders.0.bore": ["2 m", "3 m"]}, ["A_head"])
    areas = [result[f"{name}.A_head"] for name in "abc"]
    assert areas == [
        pytest.approx(np.pi / 4 * np.array(bores) ** 2) for bores in ([2, 3], [2, 3], [2, 2])
    ]


# parts of a row are those that the columns name


def two_stages() -> str:
    """A compressor of two cylinders, both double-acting, that compress from 1 to 2.8 and from 2.8 to 8 bar."""
    card = "{{compressor: {{suction: {} bar, delivery: {} bar, clearance: 8 %, exponent: 1.35}}}}"
    texts = ["speed: 600 rpm", "cylinders:"]
    for name, bore, suction, delivery in (("LP", 320, 1, 2.8), ("HP", 195, 2.8, 8)):
        ends = ", ".join(
            f"{end}: {card.format(suction, delivery)}" for end in ("head_end", "crank_end")
        )
        indicator = f"indicator: {{pressures: absolute, {ends}}}"
        texts.append(
            f"  - {{name: {name}, crank: 90 mm, rod: 450 mm, bore: {bore} mm, {indicator}}}"
        )
    return "\n".join(texts)


@pytest.mark.parametrize("count", [2, 6])
def test_columns_of_stages_are_named_by_their_pistons(count: int) -> None:
    """Other suction at one end makes it a stage of its own: no column may then have the volume of another part."""
    suctions = [f"{1 + row / 100} bar" for row in range(count)]
    result = sweep(
        two_stages(),
        {"cylinders.0.indicator.head_end.compressor.suction": suctions},
        ["stroke_volume"],
    )
    areas = np.pi / 4 * np.array([0.32, 0.195]) ** 2
    assert result["LP.stroke_volume"][0] == pytest.approx(2 * areas[0] * 0.18, rel=1e-12)
    assert np.isnan(result["LP.stroke_volume"][1:]).all()
    assert result["HP.stroke_volume"] == pytest.approx(
        np.full(count, 2 * areas[1] * 0.18), rel=1e-12
    )
    others = "it has other parts: no 'LP', but 'LP, head end', 'LP, crank end'"
    assert not result["failure"][0]
    assert all(set(text.split("'")) == set(others.split("'")) for text in result["failure"][1:])


def test_a_bearing_of_other_neighbours_is_another_bearing() -> None:
    text = """
speed: 600 rpm
crankshaft: {a: 100 mm, b: 100 mm, pin_diameter: 50 mm, pin_length: 50 mm, web_distance: 50 mm,
  web_thickness: 20 mm, web_width: 60 mm, journal_diameter: 50 mm}
cylinders:
  - {name: p, crank: 100 mm, rod: 400 mm, axial_position: 0 m, masses: {piston: 1 kg}}
  - {name: q, crank: 100 mm, rod: 400 mm, axial_position: 0.2 m, masses: {piston: 3 kg}, crank_position: 90 deg}
"""
    result = sweep(text, {"cylinders.1.axial_position": ["0.2 m", "-0.2 m"]}, ["load_max"])
    outer = result["bearing 1.load_max"]
    # ω² R (1 + λ) m of the piston next to it, half of which each of its bearings carries
    assert outer[0] == pytest.approx((20 * np.pi) ** 2 * 0.1 * 1.25 / 2, rel=1e-12)
    assert np.isnan(outer[1])
    assert "'bearing 1 next to p', 'bearing 2 next to p, q'" in result["failure"][1]
    assert "but 'bearing 1 next to q'" in result["failure"][1]
