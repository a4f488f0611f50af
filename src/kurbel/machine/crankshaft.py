"""One crank throw between two bearings or overhung beyond one, with a flywheel (Öl- und Gasmaschinen)."""

import functools
from collections.abc import Iterator
from typing import Any

import numpy as np

from kurbel.arrays import Truth
from kurbel.declared.record import Record, Rule, field

_ROUNDED = 1.05
"""What lengths may contradict one another by: printed examples round them."""


class Crankshaft(Record):
    """A crank throw between bearing A and bearing B, the one on the side of the flywheel; lengths in m.

    a, b: from the middle of the pin to A and B; web_distance: from there to the middle of each web; flywheel_position:
    from B, positive outward, negative between the bearings. Without the journals' diameter they are not examined.
    overhung: the pin is outside bearing A, on a single web.
    """

    a: float = field(
        "length", "From the middle of the crank pin to bearing A, away from the flywheel", "a", above=0, required=True
    )
    b: float = field(
        "length", "From the middle of the crank pin to bearing B, next to the flywheel", "b", above=0, required=True
    )
    web_distance: float = field(
        "length", "From the middle of the crank pin to the middle of a web", "e", above=0, required=True
    )
    web_thickness: float = field("length", "Thickness of a web along the shaft", "t", above=0, required=True)
    web_width: float = field("length", "Width of a web across its arm", "w", above=0, required=True)
    pin_diameter: float = field("length", "Diameter of the crank pin", "d_z", above=0, required=True)
    pin_length: float = field("length", "Length of the crank pin", "l_z", above=0, required=True)
    journal_diameter: float | None = field(
        "length", "Diameter of the journals", "d_j", above=0, absent="journals not examined"
    )
    journal_length: float | None = field("length", "Length of a journal", "l_j", above=0, absent="no journal pressure")
    flywheel_mass: float = field(
        "mass",
        "Mass of the flywheel",
        "m_s",
        default=0.0,
        least=0,
        absent="no flywheel",
        needs="flywheel_position",
    )
    flywheel_position: float = field(
        "length",
        "Middle of the flywheel from bearing B, positive outward",
        default=0.0,
        absent="no flywheel",
        needs="flywheel_mass",
    )
    allowable_bending: float | None = field(
        "stress", "Allowable stress in bending", "k_b", above=0, absent="no safety figures"
    )
    allowable_torsion: float | None = field(
        "stress", "Allowable stress in torsion", "k_d", above=0, absent="no safety figures"
    )
    overhung: bool = field(
        bool,
        "True if the pin is overhung: outside bearing A, at the end of the shaft",
        default=False,
    )

    bearing_metal: str | None = field(
        ("gunmetal", "white-metal"), "Metal of the shells, by which p_m v of the crank pin is judged", absent="both"
    )

    def rules(self) -> Iterator[Rule]:
        beside = "beside the web" if self.overhung else "between the webs"
        numbers = {"end": self._web_end, "span": self.span, "gap": 2 * self.web_distance - self.web_thickness}
        yield Rule(
            "web_thickness",
            self.web_thickness >= self.web_width,
            "{web_thickness} is not less than the width ({web_width}); the thickness lies along the shaft",
        )
        yield Rule(
            "web_distance",
            self.web_distance <= self.web_thickness / 2,
            f"{{web_distance}} leaves no pin {beside}; it must be more than half the thickness ({{web_thickness}})",
        )
        for name, place in (("a", self.a), ("b", self.b)):
            inside = "puts the bearing inside the web ({end:length} from the pin); measure to the middle of the bearing"
            yield Rule(name, place <= self._web_end, f"{{{name}}} {inside}", numbers)
        beyond: Truth = self.flywheel_position <= -self.span
        if self.overhung:
            before = self.b <= self.a
            yield Rule("b", before, "{b} puts B before bearing A ({a}); an overhung pin lies beyond A")
            beyond = beyond & ~np.asarray(before)
        yield Rule(
            "flywheel_position",
            beyond,
            "{flywheel_position} lies beyond bearing A; A is the bearing away from the flywheel, {span:length} from B",
            numbers,
        )
        if not self.overhung:
            room = self._web_end - self.b
            yield Rule(
                "flywheel_position",
                ~np.asarray(beyond) & (self.flywheel_position <= room) & (room < 0),
                "{flywheel_position} is not between web and bearing B, which leave {room:length}; "
                "B is the bearing next to the flywheel",
                {"room": -room},
            )
        yield Rule(
            "pin_length",
            (self.pin_length > _ROUNDED * numbers["gap"]) & (numbers["gap"] > 0),
            f"{{pin_length}} does not fit {beside}, which leave{'s' * self.overhung} {{gap:length}}: twice "
            "web_distance less web_thickness",
            numbers,
        )
        yield from self._journal_rules()

    def _journal_rules(self) -> Iterator[Rule]:
        """Yield the rule of the journal in each room, broken where that is the shortest one.

        A room is the distance from the middle of a bearing to pin, flywheel or half the way to the other bearing.
        """
        if self.journal_length is None:
            return
        has_flywheel = (np.asarray(self.flywheel_mass) > 0) & np.not_equal(self.flywheel_position, 0)
        rooms: dict[str, Any] = {
            "the middle of bearing A and web A": self.a - self._web_end,
            "the middle of bearing B and web B": np.inf if self.overhung else self.b - self._web_end,
            "the middle of bearing A and half the way to B": self.span / 2 if self.overhung else np.inf,
            "the middles of bearing B and flywheel": np.where(has_flywheel, abs(self.flywheel_position), np.inf),
        }
        shortest = functools.reduce(np.minimum, rooms.values())
        for what, room in rooms.items():
            sentence = (
                f"half of {{journal_length}} does not fit between {what}, which leave {{room:length}}; "
                "'a', 'b' and 'flywheel_position' go to the middle of a bearing"
            )
            short = (self.journal_length / 2 > _ROUNDED * room) & (room > 0) & (room == shortest)
            yield Rule("journal_length", short, sentence, {"room": room})

    @property
    def place_A(self) -> float:
        """Place of bearing A in m from the middle of the pin, positive toward B: −a, and a for an overhung crank."""
        return self.a if self.overhung else -self.a

    @property
    def span(self) -> float:
        """Distance in m from bearing A to bearing B."""
        return self.b - self.place_A

    @property
    def _web_end(self) -> float:
        """Distance in m of the outer face of a web from the middle of the pin."""
        return self.web_distance + self.web_thickness / 2
