"""What varies, and in which order."""

from pathlib import Path

import numpy as np
import pytest

import kurbel
from kurbel.declared.units import kinds, unit_names
from kurbel.designs.binding import numbers_of
from kurbel.designs.plan import Input, Plan, read_axis, read_input, shard
from kurbel.errors import UsageError


@pytest.mark.parametrize(
    ("text", "texts"),
    [
        ("rod_ratio=3:6:0.75", ("3", "3.75", "4.5", "5.25", "6")),
        ("bore=300 mm:500:100", ("300 mm", "400 mm", "500 mm")),
        ("speed=60:40:-10 rpm", ("60 rpm", "50 rpm", "40 rpm")),
        ("speed=40,50 1/s,60 rpm", ("40 rpm", "50 1/s", "60 rpm")),
        ("rod_ratio=3,7/2", ("3", "7/2")),
        ("mechanism=slider-crank,scotch-yoke", ("slider-crank", "scotch-yoke")),
        ("x=0:0.3:0.1", ("0", "0.1", "0.2", "0.3")),
    ],
)
def test_values(text: str, texts: tuple[str, ...]) -> None:
    one = read_input(text)
    assert tuple(map(one.text, range(one.length))) == texts


def test_grid_list_and_sample() -> None:
    a, b = read_axis("a=1,2"), read_axis("b=5,6,7")
    grid = Plan([a, b])
    assert [grid.texts(row) for row in range(grid.rows)] == [(x, y) for x in "12" for y in "567"]
    side_by_side = Plan([a, read_axis("b=5,6")], side_by_side=True)
    assert [side_by_side.texts(row) for row in range(side_by_side.rows)] == [("1", "5"), ("2", "6")]
    together = Plan([read_axis("a=1:2:1; b=5,6"), read_axis("c=7,8,9")])
    rows = [together.texts(row) for row in range(together.rows)]
    assert rows == [(x, y, z) for x, y in ("15", "26") for z in "789"]
    assert [read_axi.texts for read_axi in read_axis("name=a;b; speed=1 rpm")] == [
        ("a;b",),
        ("1 rpm",),
    ]
    both = Plan([a, read_axis("c=normal(10, 1)")], sample=50, seed=3)
    drawn = np.array([[float(text) for text in both.texts(row)] for row in range(both.rows)])
    assert both.rows == 100
    assert (drawn[:50, 1] == drawn[50:, 1]).all()
    # one in each of fifty strips of equal probability: the mean is that of the distribution far beyond chance
    assert abs(drawn[:50, 1].mean() - 10) < 0.02


def test_a_number_in_a_unit_is_read_as_its_text() -> None:
    for kind, unit in [
        ("ratio", "%"),
        *((name, unit) for name in kinds() for unit in unit_names(name)),
    ]:
        one = Input("x", (), (12.5, 3, 0.1, -2.25), unit)
        texts = Input("x", tuple(map(one.text, range(4))))
        assert numbers_of(one, kind).tobytes() == numbers_of(texts, kind).tobytes(), (kind, unit)


def test_shards_are_the_whole() -> None:
    for count in (1, 3, 7, 20):
        rows = [row for k in range(count) for row in shard(f"{k + 1}/{count}", 17)]
        assert rows == list(range(17))
    for wrong in ("0/3", "4/3", "1", "a/b", "1/0", f"1/{'9' * 5000}"):
        with pytest.raises(UsageError, match="write K/N"):
            shard(wrong, 10)


def test_a_text_varies_in_the_folder_that_it_was_read_in(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its name stands for the file in messages alone, a folder in it is none of its traces."""
    monkeypatch.chdir(tmp_path)
    Path("trace.csv").write_text(
        "".join(f"{angle},{5 + angle % 7}\n" for angle in range(0, 361, 10))
    )
    trace = "trace: {file: trace.csv, unit: bar}"
    text = f"{{crank: 0.2 m, rod_ratio: 5, bore: 0.1 m, indicator: {{head_end: {{{trace}}}}}}}"
    machine = kurbel.loads(text, name="elsewhere/machine.yaml")
    result = kurbel.sweep(machine, {"bore": [0.1, 0.2]}, ["P_max"])
    assert result["P_max"][1] == pytest.approx(4 * result["P_max"][0], rel=1e-12)
