"""Parameters of which a few stand for all by default, and all run with the slow tests."""

from collections.abc import Callable, Iterable
from functools import cache
from pathlib import Path

import pytest

from kurbel.machine.origin import Origin
from kurbel.machine_file.reader import read_machine
from kurbel.machine_file.source import read
from kurbel.solver.case import Case

SHIPPED = sorted((Path(__file__).parent.parent / "configs").glob("*.yaml"))
"""The machines that come with kurbel."""
CONFIGS = {path.stem: path for path in SHIPPED}


@cache
def case_from(origin: Origin) -> Case:
    """The results of the machine in a text: computed once, since nothing can change them."""
    return Case(read_machine(origin))


def case_of(name: str) -> Case:
    """The results of a machine that comes with kurbel."""
    return case_from(read(CONFIGS[name]))


def shipped(*names: str) -> list[pytest.ParameterSet]:
    """Return the machines that come with kurbel, slow but for these names."""
    assert set(names) <= {path.stem for path in SHIPPED}
    return few(
        SHIPPED, [path for path in SHIPPED if path.stem in names], [path.stem for path in SHIPPED]
    )


def few(
    values: Iterable[object], kept: Iterable[object], ids: Iterable[str | None] | None = None
) -> list[pytest.ParameterSet]:
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


def law_of_each(values: Iterable[object]) -> Callable[[Callable[..., None]], Callable[[], None]]:
    """Make one test of a law that each of these keeps, where a test for each would cost more than the law does.

    A tuple is of several arguments; pytest shows those that fail beside the law.
    """
    every = [value if isinstance(value, tuple) else (value,) for value in values]

    def law(test: Callable[..., None]) -> Callable[[], None]:
        def test_of_all() -> None:
            assert every
            for value in every:
                test(*value)

        test_of_all.__doc__, test_of_all.__module__ = test.__doc__, test.__module__
        # for a law of some of them only
        test_of_all.law, test_of_all.values = test, every
        return test_of_all

    return law
