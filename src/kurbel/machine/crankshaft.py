"""The crankshaft: a throw between two bearings or overhung beyond one (Öl- und Gasmaschinen); and what balances it."""

import functools
from collections.abc import Iterator

import numpy as np

from kurbel.arrays import Number, Truth
from kurbel.declared.forms.values import Choice
from kurbel.declared.record import Record, Rule, alternative, field

_ROUNDED = 1.05
"""What lengths may contradict one another by: printed examples round them."""


class Crankshaft(Record):
    """A crank throw between bearing A and bearing B, the one on the side of the flywheel; lengths in m.

    a, b: from the middle of the pin to A and B; web_distance: from there to the middle of each web; flywheel_position:
    from B, positive outward, negative between the bearings. Without the journals' diameter they are not examined.
    overhung: the pin is outside bearing A, on a single web.
    """

    a: float = field(
        "length",
        "From the middle of the crank pin to bearing A, away from the flywheel",
        "a",
        above=0,
    )
    b: float = field(
        "length",
        "From the middle of the crank pin to bearing B, next to the flywheel",
        "b",
        above=0,
    )
    web_distance: float = field(
        "length", "From the middle of the crank pin to the middle of a web", "e", above=0
    )
    web_thickness: float = field("length", "Thickness of a web along the shaft", "t", above=0)
    web_width: float = field("length", "Width of a web across its arm", "w", above=0)
    pin_diameter: float = field("length", "Diameter of the crank pin", "d_z", above=0)
    pin_length: float = field("length", "Length of the crank pin", "l_z", above=0)
    rod_spacing: float | None = field(
        "length",
        "Distance of the middles of neighbouring rods on one crank pin, of which that of the "
        "cylinder that is first in the file is farthest from bearing B; 0 mm: fork and blade",
        "s",
        least=0,
        absent="pin_length over the number of rods on the pin",
    )
    journal_diameter: float | None = field(
        "length", "Diameter of the journals", "d_j", above=0, absent="journals not examined"
    )
    journal_length: float | None = field(
        "length", "Length of a journal", "l_j", above=0, absent="no journal pressure"
    )
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
        ("gunmetal", "white-metal"),
        "Metal of the shells, by which p_m v of the crank pin is judged",
        absent="both",
    )

    def rules(self) -> Iterator[Rule]:
        yield from self._web_rules()
        yield from self._bearing_rules()
        yield from self._pin_rules()
        yield from self._journal_rules()

    def _web_rules(self) -> Iterator[Rule]:
        """Yield the rules on the dimensions of a web."""
        message = (
            "{web_thickness} is not less than the width ({web_width}); "
            "the thickness lies along the shaft"
        )
        yield Rule("web_thickness", self.web_thickness >= self.web_width, message)
        message = (
            f"{{web_distance}} leaves no pin {self._beside_webs}; "
            "it must be more than half the thickness ({web_thickness})"
        )
        yield Rule("web_distance", self.web_distance <= self.web_thickness / 2, message)

    @property
    def _beside_webs(self) -> str:
        """Where the pin is, for messages."""
        return "beside the web" if self.overhung else "between the webs"

    def _bearing_rules(self) -> Iterator[Rule]:
        """Yield the rules on the places of bearings and flywheel along the shaft."""
        # the bearings are outside of the webs
        numbers = {"end": self._web_end}
        message = (
            "puts the bearing inside the web ({end:length} from the pin); "
            "measure to the middle of the bearing"
        )
        yield Rule("a", self.a <= self._web_end, f"{{a}} {message}", numbers)
        yield Rule("b", self.b <= self._web_end, f"{{b}} {message}", numbers)
        # the flywheel is on the side of B
        is_beyond_A: Truth = self.flywheel_position <= -self.span
        if self.overhung:
            is_B_before_A = self.b <= self.a
            message = "{b} puts B before bearing A ({a}); an overhung pin lies beyond A"
            yield Rule("b", is_B_before_A, message)
            is_beyond_A = is_beyond_A & ~np.asarray(is_B_before_A)
        message = (
            "{flywheel_position} lies beyond bearing A; "
            "A is the bearing away from the flywheel, {span:length} from B"
        )
        yield Rule("flywheel_position", is_beyond_A, message, {"span": self.span})
        if not self.overhung:
            room = self.b - self._web_end
            is_in_throw = (self.flywheel_position <= -room) & (room > 0)
            message = (
                "{flywheel_position} is not between web and bearing B, which leave {room:length}; "
                "B is the bearing next to the flywheel"
            )
            is_broken = is_in_throw & ~np.asarray(is_beyond_A)
            yield Rule("flywheel_position", is_broken, message, {"room": room})

    def _pin_rules(self) -> Iterator[Rule]:
        """Yield the rules on the length of the crank pin."""
        gap = 2 * self.web_distance - self.web_thickness
        does_not_fit = (self.pin_length > _ROUNDED * gap) & (gap > 0)
        verb = "leaves" if self.overhung else "leave"
        message = (
            f"{{pin_length}} does not fit {self._beside_webs}, which {verb} {{gap:length}}: "
            "twice web_distance less web_thickness"
        )
        yield Rule("pin_length", does_not_fit, message, {"gap": gap})
        if self.rod_spacing is not None:
            message = "{rod_spacing} is not less than the length of the pin ({pin_length})"
            yield Rule("rod_spacing", self.rod_spacing >= self.pin_length, message)

    def _journal_rules(self) -> Iterator[Rule]:
        """Yield the rule of the journal in each room, broken where that is the shortest one.

        A room is the distance from the middle of a bearing to pin, flywheel or half the way to the other bearing.
        """
        if self.journal_length is None:
            return
        has_flywheel = np.asarray(self.flywheel_mass) > 0
        is_off_B = has_flywheel & np.not_equal(self.flywheel_position, 0)
        rooms: dict[str, Number] = {"the middle of bearing A and web A": self.a - self._web_end}
        if self.overhung:
            rooms["the middle of bearing A and half the way to B"] = self.span / 2
        else:
            rooms["the middle of bearing B and web B"] = self.b - self._web_end
        rooms["the middles of bearing B and flywheel"] = np.where(
            is_off_B, abs(self.flywheel_position), np.inf
        )
        shortest = functools.reduce(np.minimum, rooms.values())
        for between, room in rooms.items():
            does_not_fit = (self.journal_length / 2 > _ROUNDED * room) & (room > 0)
            message = (
                f"half of {{journal_length}} does not fit between {between}, "
                "which leave {room:length}; "
                "'a', 'b' and 'flywheel_position' go to the middle of a bearing"
            )
            is_broken = does_not_fit & (room == shortest)
            yield Rule("journal_length", is_broken, message, {"room": room})

    @property
    def place_A(self) -> float:
        """Place of bearing A in m from the middle of the pin, positive toward B: −a, and a for an overhung crank."""
        if self.overhung:
            return self.a
        return -self.a

    @property
    def span(self) -> float:
        """Distance in m from bearing A to bearing B."""
        return self.b - self.place_A

    def rod_places(self, count: int) -> list[Number]:
        """Return the places u_k in m of so many rods on one pin from its middle, positive toward B."""
        spacing = self.pin_length / count if self.rod_spacing is None else self.rod_spacing
        return [(number - (count - 1) / 2) * spacing for number in range(count)]

    @property
    def _web_end(self) -> float:
        """Distance in m of the outer face of a web from the middle of the pin."""
        return self.web_distance + self.web_thickness / 2


# what is put on a machine to balance it: counterweights on the crank, balance shafts, the wheels of a locomotive


class _Weight(Record):
    """A weight that turns with a shaft: u = m r."""

    product: float = field(
        "unbalance",
        "Its mass times the radius of its centre of gravity; or give both",
        "u",
        least=0,
        example="0.12 kg m",
    )
    _mass = alternative(
        "mass",
        "Mass of the counterweight",
        "m_g",
        least=0,
        instead="product",
        needs="radius",
        gives=lambda values: {"product": values["mass"] * values["radius"]},
    )
    _radius = alternative(
        "length",
        "From the axis of the shaft to its centre of gravity",
        "r_g",
        above=0,
        needs="mass",
    )


class Counterweight(_Weight):
    """A weight that turns with the crank; without a place it is at its cylinder, one of the machine has no place."""

    angle: float = field(
        "angle",
        "Its direction from the throw of its cylinder, or of crank 1, in the sense of rotation",
        "α",
        default=180.0,
        least=-360,
        most=360,
        absent="180 deg, opposite the throw",
    )
    axial_position: float | None = field(
        "length", "Its place along the shaft", "z", absent="that of its cylinder"
    )


class SharedCounterweights(Record):
    """Counterweights opposite each throw, for the rotating mass and a share of the reciprocating mass.

    planes: two places along the shaft in m; the weight of every throw is divided between them by the lever rule, so
    that force and moment are the same. Empty: each is at its own throw.
    """

    share: float = field(
        "ratio",
        "Share of the reciprocating mass that is balanced, in addition to all of the rotating mass",
        "c",
        least=0,
        most=1,
        example="0.5",
    )
    planes: tuple[float, ...] = field(
        ["length"],
        "Two positions along the shaft of all counterweights, such as the wheels of a locomotive",
        default=(),
        absent="each opposite its own throw",
    )

    def rules(self) -> Iterator[Rule]:
        count = len(self.planes)
        advice = "give two different places, such as '[-750 mm, 750 mm]', or leave it out"
        if count == 2:
            are_equal = self.planes[0] == self.planes[1]
            yield Rule("planes", are_equal, f"2 of them, 1 different; {advice}")
        elif count > 0:
            yield Rule("planes", True, f"{count} of them, {count} different; {advice}")


class BalanceShaft(_Weight):
    """A shaft with a weight that turns `order` times in a turn of the crank, with it or against it."""

    _sense = alternative(
        Choice(
            ("with", "against"),
            {
                "same": "with",
                "forward": "with",
                "+": "with",
                "opposite": "against",
                "backward": "against",
            },
        ),
        "Sense of rotation: with the crank or against it",
        required=True,
        gives=lambda values: {"against": values["sense"] == "against"},
    )
    order: int = field(int, "Its turns per turn of the crank", "n", least=1, most=8, example="2")
    against: bool = False
    angle: float = field(
        "angle",
        "Direction of its weight from the stroke line of cylinder 1, in the sense of rotation of the crank, while "
        "crank 1 is in its inner dead centre",
        "α",
        default=180.0,
        least=-360,
        most=360,
        absent="180 deg, away from the cylinder",
    )
    axial_position: float | None = field(
        "length", "Its place along the shaft", "z", absent="moments left out"
    )


class Locomotive(Record):
    """The driven wheels of a locomotive, with its counterweights; the cylinders are halfway between them."""

    wheel_distance: float = field(
        "length", "Between the counterweights of the left and of the right wheel", above=0
    )
    wheel_diameter: float | None = field(
        "length", "Diameter of the driven wheels", "D", above=0, absent="speed of the shaft alone"
    )
    wheel_load: float | None = field(
        "force",
        "Load of one driven wheel on its rail, at rest",
        "Q",
        above=0,
        absent="speed at which a wheel lifts is not computed",
    )
    hammer_limit: float | None = field(
        "force",
        "Largest allowed hammer blow of a wheel",
        above=0,
        absent="permissible balanced share is not computed",
    )
