"""What a start of kurbel does not pay for."""

from __future__ import annotations

from pathlib import Path

import pytest

from imported import modules_after
from kurbel.machine_file import load
from kurbel.report.warnings import cylinder_warnings
from kurbel.solver.case import Case

ROOT = Path(__file__).parent.parent
WATERWORKS, BOTH_CRANKS = (str(ROOT / "configs" / f"waterworks{name}.yaml") for name in ("", "-two-cranks"))
NEEDLESS = (
    (["--help"], ("machine", "mechanisms", "solver", "quantities")),
    (["example"], ("report.check", "machine", "mechanisms", "quantities")),
    (["table"], ("machine", "solver", "report.check")),
)


@pytest.mark.parametrize(("arguments", "needless"), NEEDLESS, ids=[arguments[0] for arguments, _ in NEEDLESS])
def test_a_command_imports_nothing_that_it_does_not_need(arguments: list[str], needless: tuple[str, ...]) -> None:
    assert {f"kurbel.{name}" for name in needless} & modules_after(arguments) == set()


def test_no_reversal_of_the_rod_load_of_an_engine_is_searched() -> None:
    forces = Case(load(WATERWORKS)).cylinders[0]
    assert list(cylinder_warnings(forces)) == []
    assert "rod_loads" not in vars(forces)
