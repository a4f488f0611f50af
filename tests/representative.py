"""Parameters of which a few stand for all by default, and all run with the slow tests."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import pytest
from _pytest.mark import ParameterSet

SHIPPED = sorted((Path(__file__).parent.parent / "configs").glob("*.yaml"))
"""The machines that come with kurbel."""


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
