"""The mechanisms that a machine file may name, each behind a door: a function with one import inside."""

from collections.abc import Callable
from typing import TYPE_CHECKING

from kurbel.declared.forms.structures import RecordForm
from kurbel.mechanisms import Mechanism

if TYPE_CHECKING:
    from kurbel.mechanisms.four_bar import FourBar
    from kurbel.mechanisms.oscillating_cylinder import OscillatingCylinder
    from kurbel.mechanisms.parallel_crank import ParallelCrank
    from kurbel.mechanisms.scotch_yoke import ScotchYoke
    from kurbel.mechanisms.slider_crank import SliderCrank, YokeFrame
    from kurbel.mechanisms.slotted_lever import SlottedLever


def _slider_crank() -> "type[SliderCrank]":
    from kurbel.mechanisms.slider_crank import SliderCrank

    return SliderCrank


def _scotch_yoke() -> "type[ScotchYoke]":
    from kurbel.mechanisms.scotch_yoke import ScotchYoke

    return ScotchYoke


def _slotted_lever() -> "type[SlottedLever]":
    from kurbel.mechanisms.slotted_lever import SlottedLever

    return SlottedLever


def _four_bar() -> "type[FourBar]":
    from kurbel.mechanisms.four_bar import FourBar

    return FourBar


def _parallel_crank() -> "type[ParallelCrank]":
    from kurbel.mechanisms.parallel_crank import ParallelCrank

    return ParallelCrank


def _yoke_frame() -> "type[YokeFrame]":
    from kurbel.mechanisms.slider_crank import YokeFrame

    return YokeFrame


def _oscillating_cylinder() -> "type[OscillatingCylinder]":
    from kurbel.mechanisms.oscillating_cylinder import OscillatingCylinder

    return OscillatingCylinder


KINDS: dict[str, Callable[[], type[Mechanism]]] = {
    "slider-crank": _slider_crank,
    "scotch-yoke": _scotch_yoke,
    "slotted-lever": _slotted_lever,
    "four-bar": _four_bar,
    "parallel-crank": _parallel_crank,
    "yoke-frame": _yoke_frame,
    "oscillating-cylinder": _oscillating_cylinder,
}
"""Word in the machine file -> door of the class."""
MECHANISMS = {name: RecordForm(door) for name, door in KINDS.items()}
"""Word in the machine file -> what reads its keys."""
