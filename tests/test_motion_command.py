"""`kurbel motion` as a user calls it: every mechanism, every format, and a mechanism from outside."""

from __future__ import annotations

import csv
import io
import json
import math
import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from command import run

pytestmark = pytest.mark.usefixtures("solved_once")

FOLDER = Path(__file__).parent
SLIDER = "crank: 400 mm\nrod: 2000 mm\n"
MACHINES = {
    "slider-crank": SLIDER,
    "infinite rod": "stroke: 800 mm\nrod: infinite\n",
    "offset": "crank: 30 mm\nrod: 50 mm\noffset: 10 mm\n",
    "scotch-yoke": "mechanism: scotch-yoke\nstroke: 800 mm\n",
    "slotted-lever": "mechanism: slotted-lever\ncrank: 300 mm\nframe: 800 mm\nlever: 1300 mm\n",
    "shaper with link": "mechanism: slotted-lever\ncrank: 300 mm\nframe: 800 mm\nlever: 1300 mm\nlink: 500 mm\n",
    "Whitworth": "mechanism: slotted-lever\ncrank: 150 mm\nframe: 100 mm\nlever: 200 mm\n",
    "four-bar": "mechanism: four-bar\ncrank: 40 mm\ncoupler: 150 mm\nrocker: 80 mm\nframe: 150 mm\n",
    "parallel-crank": "mechanism: parallel-crank\ncrank: 300 mm\nframe: 2 m\n",
    "yoke-frame": "mechanism: yoke-frame\nstroke: 160 mm\nrod: 320 mm\n",
}
SLIDES = {"x", "c", "b"}
SWINGS = {"theta", "theta_dot", "theta_ddot"}
STROKES = {"stroke", "phi_idc", "phi_odc", "v", "c_m", "c_max", "b_max", "b_min", "phi_b_zero"}
RETURN = {"c_work_max", "c_return_max", "c_work_m", "c_return_m"}
UNEQUAL = {"phi_work", "phi_return", "time_ratio"}
SWING = {"swing", "theta_min", "theta_max"}
TURNING = {"theta_dot_max", "theta_dot_min", "theta_ddot_max", "theta_ddot_min"}
FITTING: dict[str, tuple[set[str], set[str]]] = {
    "slider-crank": ({"psi", *SLIDES}, {*STROKES, "phi_b_zero_book"}),
    "infinite rod": ({"psi", *SLIDES}, STROKES),
    "offset": ({"psi", *SLIDES}, {*STROKES, *UNEQUAL, "c_work_m", "c_return_m", "c_min"}),
    "scotch-yoke": ({*SLIDES, "c_block"}, STROKES),
    "slotted-lever": (
        {*SLIDES, *SWINGS, "c_block"},
        {*STROKES, *UNEQUAL, *SWING, *TURNING, *RETURN},
    ),
    "shaper with link": (
        {*SLIDES, *SWINGS, "c_block"},
        {*STROKES, *UNEQUAL, *SWING, *TURNING, *RETURN},
    ),
    "Whitworth": ({*SLIDES, *SWINGS, "c_block"}, {*STROKES, *UNEQUAL, *TURNING, *RETURN}),
    "four-bar": (
        SWINGS,
        {*UNEQUAL, *SWING, *TURNING, "phi_idc", "phi_odc", "v", "transmission_min", "transmission_max"},
    ),
    "parallel-crank": (
        {*SWINGS, "x_coupler", "y_coupler", "bx_coupler", "by_coupler"},
        {"phi_idc", "phi_odc", "v", "b_coupler"},
    ),
    "yoke-frame": ({"psi", *SLIDES}, {*STROKES, "phi_b_zero_book"}),
}


def answer(*arguments: str, text: str | None = None) -> dict[str, Any]:
    result = run("motion", *arguments, "-f", "json", text=text)
    assert result.exit_code == 0, result.output
    parsed: dict[str, Any] = json.loads(result.stdout)
    return parsed


def only_part(parsed: dict[str, Any]) -> tuple[dict[str, list[float]], dict[str, Any]]:
    (part,) = parsed["cylinders"]
    return {c["id"]: c["values"] for c in part["columns"]}, {k["id"]: k for k in part["key_values"]}


def motion_of(name: str, *arguments: str) -> tuple[dict[str, list[float]], dict[str, Any]]:
    return only_part(answer("-", *arguments, text=f"speed: 60 rpm\n{MACHINES[name]}"))


@pytest.mark.parametrize("name", MACHINES)
def test_columns_and_key_values_fit_the_mechanism_and_no_others(name: str) -> None:
    columns, key_values = motion_of(name)
    assert set(columns) == {"phi", *FITTING[name][0]}
    assert set(key_values) == FITTING[name][1]
    assert columns["phi"] == list(range(0, 361, 10))
    assert all(math.isfinite(value) for values in columns.values() for value in values)


def test_what_the_mechanism_says_of_itself_is_a_note() -> None:
    parsed = answer("-", text=MACHINES["parallel-crank"])
    (note,) = parsed["notes"]
    assert "second pair of cranks at 90 deg" in note
    result = run("motion", "-", text=MACHINES["parallel-crank"])
    assert note in result.stdout
    assert note in run("check", "-", text=MACHINES["parallel-crank"]).stdout


def test_several_cylinders_each_with_its_own_part() -> None:
    text = (
        "speed: 60 rpm\ncylinders:\n"
        "  - {name: engine, crank: 400 mm, rod_ratio: 5}\n"
        "  - {name: valve gear, mechanism: four-bar, crank: 40 mm, coupler: 150 mm, rocker: 80 mm, frame: 150 mm}\n"
    )
    parsed = answer("-", text=text)
    assert [part["name"] for part in parsed["cylinders"]] == ["engine", "valve gear"]
    ids = [{column["id"] for column in part["columns"]} for part in parsed["cylinders"]]
    assert ids == [{"phi", "psi", *SLIDES}, {"phi", *SWINGS}]
    rows = list(csv.DictReader(io.StringIO(run("motion", "-", "-f", "csv", text=text).stdout)))
    assert [row["cylinder"] for row in rows] == ["engine"] * 37 + ["valve gear"] * 37
    assert rows[40]["x_m"] == ""
    assert "Key values: valve gear" in run("motion", "-", text=text).stdout


def test_a_mechanism_from_outside_needs_one_file_and_one_line(tmp_path: Path) -> None:
    """The one of the page on architecture, as it stands there."""
    page = (FOLDER.parent / "docs" / "architecture.md").read_text(encoding="utf-8")
    (whole,) = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    (tmp_path / "toy_mechanism.py").write_text(whole, encoding="utf-8")
    machine = tmp_path / "cam.yaml"
    machine.write_text("speed: 60 rpm\nmechanism: harmonic-cam\ncrank: 20 mm\nsecond: 2 mm\nram_force: {work: 1 kN}\n")
    code = (
        "import sys\nfrom kurbel.declared.forms.structures import RecordForm\n"
        "from kurbel.mechanisms.kinds import MECHANISMS\n"
        "from toy_mechanism import HarmonicCam\n"
        "MECHANISMS['harmonic-cam'] = RecordForm(HarmonicCam)\n"
        "from kurbel.cli import kurbel\n"
        "for command in ('motion', 'forces'):\n"
        "    try:\n        kurbel.main([command, *sys.argv[1:]])\n"
        "    except SystemExit as end:\n        assert not end.code, end.code\n"
        "    sys.stdout.write('\\0')\n"
    )
    path = os.pathsep.join((str(tmp_path), os.environ.get("PYTHONPATH", "")))
    environment = os.environ | {"PYTHONPATH": path, "PYTHONIOENCODING": "utf-8"}
    arguments = [sys.executable, "-c", code, str(machine), "-f", "json", "--angles", "0,90"]
    done = subprocess.run(arguments, capture_output=True, env=environment, check=False, encoding="utf-8")
    assert done.returncode == 0, done.stderr
    motion, forces = (json.loads(printed) for printed in done.stdout.split("\0")[:2])
    columns, key_values = only_part(motion)
    assert columns["x"] == pytest.approx([0, 0.022])
    assert set(key_values) == STROKES
    # c = ω sin φ (a + 2k cos φ) is largest where cos φ = (√(a² + 32k²) − a)/(8k)
    cos = (math.sqrt(20**2 + 32 * 2**2) - 20) / (8 * 2)
    peak = 2 * math.pi * math.sqrt(1 - cos * cos) * (0.02 + 0.004 * cos)
    assert key_values["c_max"]["value"] == pytest.approx(peak, rel=1e-14)
    columns, key_values = only_part(forces)
    assert columns["M"] == pytest.approx([0, -1000 * 0.02])
    assert key_values["resistance_work"]["value"] == pytest.approx(-1000 * 0.04)
