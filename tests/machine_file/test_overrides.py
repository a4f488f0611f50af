"""`--set KEY=VALUE`: values over those of the file, and faults that name them."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from click.testing import CliRunner

from good_machines import DEMO, EQUAL, LIKE_ONE
from kurbel.cli import kurbel
from kurbel.errors import KurbelError
from kurbel.machine_file import loads


def test_a_value_of_any_depth_is_set() -> None:
    card = "indicator.head_end.expansion.1=[0.3, 9.5]"
    machine = loads(
        DEMO, "m", ["speed=9 rpm", "speed=60 rpm", "flywheel.fluctuation=1/80", card, "masses={piston: 9 kg}"]
    )
    (cylinder,) = machine.cylinders
    assert machine.speed == 1  # the last one holds
    assert machine.flywheel.fluctuation == 1 / 80  # type: ignore[union-attr]
    assert cylinder.masses.parts == 9  # type: ignore[union-attr]
    assert cylinder.pistons[0].indicator.head_end.lines[0].fractions[1] == 0.3  # type: ignore[union-attr]


def test_what_is_like_the_changed_one_changes_with_it() -> None:
    for key in ("cylinders.0.crank", "cylinders[0].crank"):
        assert [one.mechanism.crank for one in loads(LIKE_ONE, "m", [f"{key}=150 mm"]).cylinders] == [0.15, 0.15]
    changed = ["cylinders.count=2", "cylinders.firing_order=1-2", "cylinders.each.bore=1 m"]
    found = [(one.pistons[0].bore, one.crank_position) for one in loads(EQUAL, "m", changed).cylinders]
    assert found == [(1, 0), (1, 360)]


@pytest.mark.parametrize(
    ("override", "message"),
    [
        ("boore=3", "--set boore=3: boore: unknown key; did you mean 'bore'?"),
        ("bore=450", "--set bore=450: bore: 450 has no unit"),
        ("crank=", "--set crank=: crank: a value is missing"),
        ("masses={piston: 80}", "--set masses={piston: 80}: masses.piston: 80 has no unit"),
        # a fault elsewhere says what was set
        ("crank=3 m", "m:4:6: rod: 2000 mm is shorter than the crank (3000 mm); the crank turns fully only with"),
        ("crank=3 m", "(with --set crank=3 m)"),
        ("bore.x=3", "--set bore.x=3: nothing stands below 'bore', which is '450 mm'"),
        ("cylinders.0.bore=3 m", "--set cylinders.0.bore=3 m: there is no list 'cylinders' in the file"),
        ("indicator.head_end.expansion.9=[1, 2]", "'indicator.head_end.expansion' is a list; its items are 0 to 5"),
        ("speed", "--set speed: write KEY=VALUE"),
        (".=3", "--set .=3: write KEY=VALUE"),
        (f"{'9' * 5000}=3", "99…: unknown key; known here are kurbel, name, speed"),
        ("bore=*a", "'*a' is not supported; write the value itself; a cylinder may be 'like: NAME'"),
        ("name=\x1b[31mred", "--set name=\\u001b[31mred: the character U+001B cannot be printed; remove it"),
        ("name=a\udcff", "is no UTF-8"),
        ("bore=[1", "--set bore=[1: a comma or ']' is missing"),
    ],
)
def test_a_fault_names_the_override(override: str, message: str) -> None:
    with pytest.raises(KurbelError, match=re.escape(message)) as caught:
        loads(DEMO, "m", [override])
    assert "Traceback" not in str(caught.value)


def test_the_answer_is_that_of_the_changed_machine(tmp_path: Path) -> None:
    (tmp_path / "m.yaml").write_text(DEMO)
    asked = ["motion", str(tmp_path / "m.yaml"), "-f", "json", "--set", "crank=500 mm", "--set", "speed=60 rpm"]
    found = json.loads(CliRunner().invoke(kurbel, asked).stdout)["cylinders"][0]["key_values"]
    # c_m = 2 s n
    assert next(one["value"] for one in found if one["id"] == "c_m") == pytest.approx(2 * 1.0 * 1)
