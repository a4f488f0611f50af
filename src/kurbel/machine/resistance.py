"""What the output of a mechanism works against: the ram of a shaper or a press, the rocker of a four-bar."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from kurbel.declared.record import Record, Rule, field


@dataclass(frozen=True, eq=False, repr=False)
class RamForce(Record):
    """A force on the ram that opposes its motion, constant on each stroke: cutting out, dragging back."""

    work: float = field(
        "force", "Force against the motion on the working stroke", "P_a", default=0.0, least=0, absent="0"
    )
    back: float = field(
        "force", "Force against the motion on the return stroke", "P_r", default=0.0, least=0, absent="0", key="return"
    )

    @classmethod
    def rules_of_keys(cls, given: Mapping[str, Any]) -> Iterator[Rule]:
        yield Rule((), not given, "give 'work', the force on the working stroke, or 'return', or both")


@dataclass(frozen=True, eq=False, repr=False)
class Moment(RamForce):
    """A moment on a member that swings or turns, opposing its motion; what turns has no return stroke."""

    work: float = field(
        "torque", "Moment against the motion on the working stroke", "M_a", default=0.0, least=0, absent="0"
    )
    back: float = field(
        "torque",
        "Moment against the motion on the return stroke",
        "M_r",
        default=0.0,
        least=0,
        absent="0",
        key="return",
    )
