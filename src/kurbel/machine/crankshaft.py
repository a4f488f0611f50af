"""One crank throw between two bearings or overhung beyond one, with a flywheel (Öl- und Gasmaschinen)."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

from kurbel.declared.forms import Physical, Truth, not_negative, positive
from kurbel.declared.keys import Described, Key, Keys
from kurbel.declared.unit_systems import show
from kurbel.errors import Fault, refuse

_ROUNDED = 1.05
"""What lengths may contradict one another by: printed examples round them."""


def _length(text: str, symbol: str, required: bool = True, absent: str = "") -> Key:
    return positive("length", text, symbol, required=required, absent=absent)


@dataclass(frozen=True, eq=False, repr=False)
class Crankshaft(Described):
    """A crank throw between bearing A and bearing B, the one on the side of the flywheel; lengths in m.

    a, b: from the middle of the pin to A and B; web_distance: from there to the middle of each web; flywheel_position:
    from B, positive outward, negative between the bearings; flywheel_mass in kg; allowable stresses in Pa or None.
    Without the journals' diameter they are not examined. overhung: the pin stands outside of A, on one web beside it.
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
    overhung: bool = False

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
        "flywheel_mass": not_negative(
            "mass", "Mass of the flywheel", "m_s", absent="no flywheel", needs="flywheel_position"
        ),
        "flywheel_position": Key(
            Physical("length"),
            "Middle of the flywheel from bearing B, positive outward",
            absent="no flywheel",
            needs="flywheel_mass",
        ),
        "allowable_bending": positive("stress", "Allowable stress in bending", "k_b", absent="no safety figures"),
        "allowable_torsion": positive("stress", "Allowable stress in torsion", "k_d", absent="no safety figures"),
        "overhung": Key(
            Truth(), "Whether the pin stands outside of bearing A, at the end of the shaft", absent="false"
        ),
    }

    def __post_init__(self) -> None:
        refuse(*self._web_faults(), *self._place_faults(), *self._length_faults())

    def _wrong(self, name: str, message: str, part: str = "") -> Fault:
        return Fault((name,), f"{part}{show(getattr(self, name), 'length')} {message}")

    def _web_faults(self) -> Iterator[Fault]:
        thickness, width = show(self.web_thickness, "length"), show(self.web_width, "length")
        if self.web_thickness >= self.web_width:
            yield self._wrong(
                "web_thickness", f"is not less than the width ({width}); the thickness lies along the shaft"
            )
        if self.web_distance <= self.web_thickness / 2:
            more = f"it must be more than half the thickness ({thickness})"
            yield self._wrong("web_distance", f"leaves no pin {self._beside_pin}; {more}")

    def _place_faults(self) -> Iterator[Fault]:
        end = show(self._web_end, "length")
        for name in ("a", "b"):
            if getattr(self, name) <= self._web_end:
                inside = f"puts the bearing inside the web ({end} from the pin)"
                yield self._wrong(name, f"{inside}; measure to the middle of the bearing")
        if self.overhung and self.b <= self.a:
            yield self._wrong("b", f"puts B before bearing A ({show(self.a, 'length')}); an overhung pin lies beyond A")
        elif self.flywheel_position <= -self.span:
            beyond = "lies beyond bearing A; A is the bearing away from the flywheel"
            yield self._wrong("flywheel_position", f"{beyond}, {show(self.span, 'length')} from B")
        elif not self.overhung and self.flywheel_position <= self._web_end - self.b < 0:
            room = f"is not between web and bearing B, which leave {show(self.b - self._web_end, 'length')}"
            yield self._wrong("flywheel_position", f"{room}; B is the bearing beside the flywheel")

    def _length_faults(self) -> Iterator[Fault]:
        """Yield what is wrong with the lengths of pin and journals, beside faults of the places themselves."""
        gap = 2 * self.web_distance - self.web_thickness
        if self.pin_length > _ROUNDED * gap > 0:
            leave = f"does not fit {self._beside_pin}, which leave{'s' * self.overhung} {show(gap, 'length')}"
            yield self._wrong("pin_length", f"{leave}: twice web_distance less web_thickness")
        room, what = min(self._rooms)
        if self.journal_length and self.journal_length / 2 > _ROUNDED * room > 0:
            leave = f"does not fit between {what}, which leave {show(room, 'length')}"
            yield self._wrong(
                "journal_length", f"{leave}; 'a', 'b' and 'flywheel_position' go to the middle of a bearing", "half of "
            )

    @property
    def _rooms(self) -> Iterator[tuple[float, str]]:
        """Lengths in m beside the middles of the bearings, with what stands at both ends."""
        yield self.a - self._web_end, "the middle of bearing A and web A"
        if self.overhung:
            yield self.span / 2, "the middle of bearing A and half the way to B"
        else:
            yield self.b - self._web_end, "the middle of bearing B and web B"
        if self.flywheel_mass and self.flywheel_position:
            yield abs(self.flywheel_position), "the middles of bearing B and flywheel"

    @property
    def place_A(self) -> float:
        """Place of bearing A in m from the middle of the pin, positive toward B: −a, and a for an overhung crank."""
        return self.a if self.overhung else -self.a

    @property
    def span(self) -> float:
        """Distance in m from bearing A to bearing B."""
        return self.b - self.place_A

    @property
    def _beside_pin(self) -> str:
        return "beside the web" if self.overhung else "between the webs"

    @property
    def _web_end(self) -> float:
        """Distance in m of the outer face of a web from the middle of the pin."""
        return self.web_distance + self.web_thickness / 2
