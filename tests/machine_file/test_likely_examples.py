"""The examples that `kurbel keys` shows are those of one machine that could be built."""

import pytest

from kurbel.machine_file import load
from kurbel.report.keys import described
from representative import CONFIGS

ALONE = ["steam_lap", "exhaust_lap", "lead", "eccentric_rod", "port_width"]


@pytest.mark.parametrize("key", ALONE)
def test_an_example_of_the_valve_fits_a_mill_engine(key: str) -> None:
    """Laps, leads and ports of 450 mm do not: the valve would never open."""
    rows = dict(described(f"valve.{key}"))
    example = rows["example"].partition(": ")[2]
    machine = load(CONFIGS["mill-engine"], [f"valve.{key}={example}"])
    (cylinder,) = machine.cylinders
    assert cylinder.valve is not None
    assert cylinder.valve.travel == pytest.approx(0.090)
