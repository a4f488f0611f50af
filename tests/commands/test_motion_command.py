"""`kurbel motion` as a user calls it: every mechanism, every format, and a mechanism from outside."""

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
import yaml

from command import answer, run

FOLDER = Path(__file__).parents[1]
SLIDER = "crank: 400 mm\nrod: 2000 mm\n"
FITTING = yaml.safe_load((FOLDER / "motion_of_mechanisms.yaml").read_text("utf-8"))


def motion(text: str, *options: str) -> dict[str, Any]:
    return answer("motion", "-", *options, text=text)


def only_part(parsed: dict[str, Any]) -> tuple[dict[str, list[float]], dict[str, Any]]:
    (part,) = parsed["cylinders"]
    return {c["id"]: c["values"] for c in part["columns"]}, {k["id"]: k for k in part["key_values"]}


@pytest.mark.parametrize("name", FITTING)
def test_columns_and_key_values_fit_the_mechanism_and_no_others(name: str) -> None:
    columns, key_values = only_part(motion(FITTING[name]["machine"], "--set", "speed=60 rpm"))
    assert set(columns) == {"phi", *FITTING[name]["columns"].split()}
    assert set(key_values) == set(FITTING[name]["key_values"].split())
    assert columns["phi"] == list(range(0, 361, 10))
    assert all(math.isfinite(value) for values in columns.values() for value in values)


def test_several_cylinders_each_with_its_own_part() -> None:
    text = (
        "speed: 60 rpm\ncylinders:\n"
        "  - {name: engine, crank: 400 mm, rod_ratio: 5}\n"
        "  - {name: valve gear, mechanism: four-bar, crank: 40 mm, coupler: 150 mm, rocker: 80 mm, frame: 150 mm}\n"
    )
    parsed = motion(text)
    assert [part["name"] for part in parsed["cylinders"]] == ["engine", "valve gear"]
    ids = [{column["id"] for column in part["columns"]} for part in parsed["cylinders"]]
    assert ids == [{"phi", "psi", "x", "c", "b"}, {"phi", "theta", "theta_dot", "theta_ddot"}]
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
    machine.write_text(
        "speed: 60 rpm\nmechanism: harmonic-cam\ncrank: 20 mm\nsecond: 2 mm\nram_force: {work: 1 kN}\n"
    )
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
    done = subprocess.run(
        arguments, capture_output=True, env=environment, check=False, encoding="utf-8"
    )
    assert done.returncode == 0, done.stderr
    motion, forces = (json.loads(printed) for printed in done.stdout.split("\0")[:2])
    columns, key_values = only_part(motion)
    assert columns["x"] == pytest.approx([0, 0.022])
    assert set(key_values) == set(FITTING["scotch-yoke"]["key_values"].split())
    # c = ω sin φ (a + 2k cos φ) is largest where cos φ = (√(a² + 32k²) − a)/(8k)
    cos = (math.sqrt(20**2 + 32 * 2**2) - 20) / (8 * 2)
    peak = 2 * math.pi * math.sqrt(1 - cos * cos) * (0.02 + 0.004 * cos)
    assert key_values["c_max"]["value"] == pytest.approx(peak, rel=1e-14)
    columns, key_values = only_part(forces)
    assert columns["M"] == pytest.approx([0, -1000 * 0.02])
    assert key_values["resistance_work"]["value"] == pytest.approx(-1000 * 0.04)
