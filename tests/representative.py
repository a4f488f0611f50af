"""Parameters of which a few stand for all by default, and all run with the slow tests."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cache
from pathlib import Path

import pytest
from _pytest.mark import ParameterSet

from kurbel.machine_file import load
from kurbel.solver.case import Case

SHIPPED = sorted((Path(__file__).parent.parent / "configs").glob("*.yaml"))
"""The machines that come with kurbel."""
CONFIGS = {path.stem: path for path in SHIPPED}


@cache
def case_of(name: str) -> Case:
    """The results of a machine that comes with kurbel: computed once, since nothing can change them."""
    return Case(load(CONFIGS[name]))


def shipped(*names: str) -> list[ParameterSet]:
    """Return the machines that come with kurbel, slow but for these names."""
    assert set(names) <= {path.stem for path in SHIPPED}
    return few(SHIPPED, [path for path in SHIPPED if path.stem in names], [path.stem for path in SHIPPED])


def few(
    values: Iterable[object], kept: Iterable[object], ids: Iterable[str | None] | None = None
) -> list[ParameterSet]:
    """Return parameters that are slow but for those kept; a tuple is of several arguments."""
    every, default = list(values), list(kept)
    assert all(value in every for value in default)
    return [
        pytest.param(
            *(value if isinstance(value, tuple) else (value,)),
            marks=[] if value in default else [pytest.mark.slow],
            id=name,
        )
        for value, name in zip(every, ids or [None] * len(every))
    ]
