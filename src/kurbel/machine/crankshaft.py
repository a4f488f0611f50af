"""One crank throw between two bearings, with a flywheel (Öl- und Gasmaschinen)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from kurbel.crank_angle import CrankAngle
from kurbel.declared.forms import Physical
from kurbel.declared.keys import Described, Key, Keys
from kurbel.declared.unit_systems import show
from kurbel.errors import Fault, refuse

if TYPE_CHECKING:
    from collections.abc import Iterator

    from kurbel.machine import Machine

_ROUNDED = 1.05
"""What lengths may contradict one another by: printed examples round them."""


def _length(text: str, symbol: str, required: bool = True, absent: str = "") -> Key:
    return Key(Physical("length", above=0), text, symbol, required, absent)


@dataclass(frozen=True, eq=False)
class Crankshaft(Described):
    """A crank throw between bearing A and bearing B, the one on the side of the flywheel; lengths in m.

    a, b: from the middle of the pin to A and B; web_distance: from there to the middle of each web; flywheel_position:
    from B, positive outward, negative between the bearings; flywheel_mass in kg; allowable stresses in Pa or None.
    Without the journals' diameter they are not examined.
    """

    a: float
    b: float
    web_distance: float
    web_thickness: float
    web_width: float
    pin_diameter: float
    pin_length: float
    journal_diameter: float | None = None
    journal_length: float | None = None
    flywheel_mass: float = 0.0
    flywheel_position: float = 0.0
    allowable_bending: float | None = None
    allowable_torsion: float | None = None

    KEYS: ClassVar[Keys] = {
        "a": _length("From the middle of the crank pin to bearing A, away from the flywheel", "a"),
        "b": _length("From the middle of the crank pin to bearing B, beside the flywheel", "b"),
        "web_distance": _length("From the middle of the crank pin to the middle of a web", "e"),
        "web_thickness": _length("Thickness of a web along the shaft", "t"),
        "web_width": _length("Width of a web across its arm", "w"),
        "pin_diameter": _length("Diameter of the crank pin", "d_z"),
        "pin_length": _length("Length of the crank pin", "l_z"),
        "journal_diameter": _length("Diameter of the journals", "d_j", False, "journals not examined"),
        "journal_length": _length("Length of a journal", "l_j", False, "no journal pressure"),
        "flywheel_mass": Key(
            Physical("mass", least=0), "Mass of the flywheel", "m_s", absent="no flywheel", needs="flywheel_position"
        ),
        "flywheel_position": Key(
            Physical("length"),
            "Middle of the flywheel from bearing B, positive outward",
            absent="no flywheel",
            needs="flywheel_mass",
        ),
        "allowable_bending": Key(
            Physical("stress", above=0), "Allowable stress in bending", "k_b", absent="no safety figures"
        ),
        "allowable_torsion": Key(
            Physical("stress", above=0), "Allowable stress in torsion", "k_d", absent="no safety figures"
        ),
    }

    def __post_init__(self) -> None:
        refuse(*self._web_faults(), *self._place_faults(), *self._length_faults())

    def _web_faults(self) -> list[Fault]:
        thickness, width = show(self.web_thickness, "length"), show(self.web_width, "length")
        faults = []
        if self.web_thickness >= self.web_width:
            faults.append(
                Fault(
                    ("web_thickness",),
                    f"{thickness} is not less than the width ({width}); the thickness lies along the shaft",
                )
            )
        if self.web_distance <= self.web_thickness / 2:
            faults.append(
                Fault(
                    ("web_distance",),
                    f"{show(self.web_distance, 'length')} leaves no pin between the webs; "
                    f"it must be more than half the thickness ({thickness})",
                )
            )
        return faults

    def _place_faults(self) -> list[Fault]:
        faults = [
            Fault(
                (name,),
                f"{show(value, 'length')} puts the bearing inside the web "
                f"({show(self._web_end, 'length')} from the pin); measure to the middle of the bearing",
            )
            for name, value in (("a", self.a), ("b", self.b))
            if value <= self._web_end
        ]
        if self.flywheel_position <= -(self.a + self.b):
            faults.append(
                Fault(
                    ("flywheel_position",),
                    f"{show(self.flywheel_position, 'length')} lies beyond bearing A; "
                    f"A is the bearing away from the flywheel, {show(self.a + self.b, 'length')} from B",
                )
            )
        elif self.flywheel_position <= self._web_end - self.b < 0:
            faults.append(
                Fault(
                    ("flywheel_position",),
                    f"{show(self.flywheel_position, 'length')} is not between web and bearing B, which leave "
                    f"{show(self.b - self._web_end, 'length')}; B is the bearing beside the flywheel",
                )
            )
        return faults

    def _length_faults(self) -> Iterator[Fault]:
        """Yield what is wrong with the lengths of pin and journals, beside faults of the places themselves."""
        gap = 2 * self.web_distance - self.web_thickness
        if self.pin_length > _ROUNDED * gap > 0:
            yield Fault(
                ("pin_length",),
                f"{show(self.pin_length, 'length')} does not fit between the webs, which leave {show(gap, 'length')}: "
                "twice web_distance less web_thickness",
            )
        room, what = min(self._rooms)
        if self.journal_length and self.journal_length / 2 > _ROUNDED * room > 0:
            yield Fault(
                ("journal_length",),
                f"half of {show(self.journal_length, 'length')} does not fit between {what}, which leave "
                f"{show(room, 'length')}; 'a', 'b' and 'flywheel_position' go to the middle of a bearing",
            )

    @property
    def _rooms(self) -> Iterator[tuple[float, str]]:
        """Lengths in m beside the middles of the bearings, with what stands at both ends."""
        yield self.a - self._web_end, "the middle of bearing A and web A"
        yield self.b - self._web_end, "the middle of bearing B and web B"
        if self.flywheel_mass and self.flywheel_position:
            yield abs(self.flywheel_position), "the middles of bearing B and flywheel"

    @property
    def _web_end(self) -> float:
        """Distance in m of the outer face of a web from the middle of the pin."""
        return self.web_distance + self.web_thickness / 2


def strength_obstacle(machine: Machine) -> str:
    """Return why the strength of a machine's crankshaft cannot be examined, or an empty text."""
    if machine.crankshaft is None:
        return "no 'crankshaft' is given; its strength needs the lengths of the throw: 'crankshaft: {a: …, b: …, …}'"
    if len(machine.cylinders) != 1:
        return (
            f"{len(machine.cylinders)} cylinders; the crankshaft that is examined has one throw, for one cylinder"
            if machine.cylinders
            else "no cylinder loads the crankshaft; 'effort' tells a torque and no force on the pin"
        )
    cylinder = machine.cylinders[0]
    if cylinder.mechanism.quick_return or cylinder.mechanism.radial(CrankAngle.of(0.0)) is None:
        return f"the force on the crank pin of a {cylinder.mechanism.name} is not known; give a slider-crank"
    if not any(piston.indicator for piston in cylinder.pistons):
        return "no pressure loads the crankshaft; give 'bore' and 'indicator'"
    return ""
