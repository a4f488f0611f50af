"""What a machine does not have is neither computed nor printed nor imported."""

from __future__ import annotations

from functools import cached_property
from pathlib import Path

import numpy as np

from imported import modules_after
from kurbel.accuracy.leaving_out import evaluated, savings
from kurbel.accuracy.timing import Patience
from kurbel.machine_file import loads
from kurbel.quantity import Computed
from kurbel.report.accuracy import everything
from kurbel.report.crank import forces_report
from kurbel.report.frame import Frame
from kurbel.solver.case import Case

BARE = "{name: bare, speed: 60 rpm, crank: 400 mm, rod: 2000 mm}"
FULL = """
{name: full, speed: 60 rpm, crank: 400 mm, rod: 2000 mm, bore: 450 mm, inclination: 0 deg,
 indicator: {head_end: {constant: {expansion: 5 bar, compression: 1 bar}}, crank_end: mirrored},
 masses: {piston: 200 kg}, friction: {crosshead: 0.05},
 flywheel: {inertia: 900 kg m2}, load: {slip: 0.1}}
"""
NOT_OF_A_BARE_MACHINE = ("kurbel.accuracy", "scipy", "typst", "rich")


def test_nothing_is_imported_for_what_is_absent(tmp_path: Path) -> None:
    bare = tmp_path / "bare.yaml"
    bare.write_text(BARE, encoding="utf-8")
    assert modules_after(["motion", str(bare)], ["forces", str(bare)]).isdisjoint(NOT_OF_A_BARE_MACHINE)


def stages_of(thing: object) -> set[str]:
    """Names of the cached properties that have been computed and are not empty."""
    return {
        name
        for name, value in vars(thing).items()
        if isinstance(getattr(type(thing), name, None), (cached_property, Computed))
        and (isinstance(value, np.ndarray) or value not in (None, (), {}, 0.0, False))
    }


def test_nothing_is_computed_for_what_is_absent() -> None:
    case = Case(loads(BARE))
    everything(case)
    forces = case.cylinders[0]
    assert stages_of(case) == {"cylinders"}
    assert stages_of(forces) == {"motion"}  # no pieces, no samples, no extremes, no work
    assert stages_of(forces.drive) == {"omega"}


def test_only_what_the_command_needs_is_computed() -> None:
    case = Case(loads(FULL))
    everything(case)
    assert "flywheel" not in vars(case)
    assert "strength" not in vars(case)
    assert {"_cycle", "_extremes", "friction_works", "work"} <= stages_of(case.cylinders[0])


def test_nothing_is_printed_for_what_is_absent() -> None:
    part = forces_report(Case(loads(BARE)), Frame("forces", (0.0, 90.0), None, "si")).parts[0]
    assert [column.id for column in part.columns] == ["phi", "psi", "x", "c", "b"]
    assert not {"P_max", "T_max", "work", "friction_work", "loss_crosshead", "m"} & {one.id for one in part.key_values}


def test_every_thing_left_out_saves_stages() -> None:
    found = list(savings(loads(FULL), everything, Patience(1, 0.0)))
    assert [one.machine for one in found] == [
        "everything",
        "no friction",
        "no masses either",
        "no cards either: motion alone",
        "no speed either: positions alone",
    ]
    counts = [one.stages for one in found]
    assert counts == sorted(counts, reverse=True)
    assert len(set(counts)) >= 4  # without a speed the same is computed, of positions alone
    assert found[0].ratio == 1.0


def test_stages_are_counted_through_everything_a_case_holds() -> None:
    case = Case(loads(BARE))
    assert evaluated(case) == 0
    _ = case.cylinders[0].motion.c_max
    assert evaluated(case) >= 4  # the cylinders, the extreme, what it hangs on, and ω
