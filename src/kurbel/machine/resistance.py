"""What the output of a mechanism works against: the ram of a shaper or a press, the rocker of a four-bar."""

from dataclasses import dataclass
from typing import ClassVar

from kurbel.declared.forms import not_negative
from kurbel.declared.keys import Described, Keys, check
from kurbel.errors import refused


@dataclass(frozen=True, eq=False, repr=False)
class RamForce(Described):
    """A force in N on the ram that opposes its motion, constant on each stroke: cutting out, dragging back."""

    work: float = 0.0
    back: float = 0.0

    KEYS: ClassVar[Keys] = {
        "work": not_negative("force", "Force against the motion on the working stroke", "P_a", absent="0"),
        "return": not_negative("force", "Force against the motion on the return stroke", "P_r", absent="0"),
    }

    def __post_init__(self) -> None:
        check(self.KEYS, {"work": self.work, "return": self.back})

    @classmethod
    def of_keys(cls, work: float | None = None, **others: float) -> "RamForce":
        """Return the resistance that these keys of a machine file describe; raises RuleError where it has none."""
        if work is None and not others:
            refused("give 'work', the force on the working stroke, or 'return', or both")
        return cls(work or 0.0, others.get("return", 0.0))


@dataclass(frozen=True, eq=False, repr=False)
class Moment(RamForce):
    """A moment in N m on a member that swings or turns, opposing its motion; what turns has no return stroke."""

    KEYS: ClassVar[Keys] = {
        "work": not_negative("torque", "Moment against the motion on the working stroke", "M_a", absent="0"),
        "return": not_negative("torque", "Moment against the motion on the return stroke", "M_r", absent="0"),
    }
