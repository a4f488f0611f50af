"""The mechanisms that a machine file may name, and what machines may have, whatever their mechanism."""

from typing import Any

from kurbel.declared.forms import Record
from kurbel.declared.quantities import Lists
from kurbel.mechanisms import Mechanism, lists_of
from kurbel.mechanisms.four_bar import FourBar
from kurbel.mechanisms.parallel_crank import ParallelCrank
from kurbel.mechanisms.scotch_yoke import ScotchYoke
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.mechanisms.slotted_lever import SlottedLever
from kurbel.mechanisms.yoke_frame import YokeFrame

_KINDS: tuple[type[Mechanism], ...] = (SliderCrank, ScotchYoke, SlottedLever, FourBar, ParallelCrank, YokeFrame)
MECHANISMS = {one.name: Record(one) for one in _KINDS}
"""Word in the machine file -> what reads its keys."""


def every_quantity() -> Lists:
    """Return what machines may have, whatever their mechanism."""
    every: list[Any] = [record.load() for record in MECHANISMS.values()]
    return lists_of(tuple(o for one in every for o in one.OFFERS), tuple(o for one in every for o in one.KEY_OFFERS))
