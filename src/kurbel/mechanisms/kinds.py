"""The mechanisms that a machine file may name."""

from kurbel.declared.forms.structures import RecordForm
from kurbel.mechanisms import Mechanism
from kurbel.mechanisms.four_bar import FourBar
from kurbel.mechanisms.parallel_crank import ParallelCrank
from kurbel.mechanisms.scotch_yoke import ScotchYoke
from kurbel.mechanisms.slider_crank import SliderCrank, YokeFrame
from kurbel.mechanisms.slotted_lever import SlottedLever

KINDS: tuple[type[Mechanism], ...] = (
    SliderCrank,
    ScotchYoke,
    SlottedLever,
    FourBar,
    ParallelCrank,
    YokeFrame,
)
MECHANISMS = {kind.name: RecordForm(kind) for kind in KINDS}
"""Word in the machine file -> what reads its keys."""
