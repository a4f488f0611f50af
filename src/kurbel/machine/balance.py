"""What is put on a machine to balance it: counterweights on the crank, balance shafts, the wheels of a locomotive."""

from collections.abc import Iterator

from kurbel.declared.forms.values import Choice
from kurbel.declared.record import Record, Rule, alternative, field


class _Weight(Record):
    """A weight that turns with a shaft: u = m r."""

    product: float = field(
        "unbalance",
        "Its mass times the radius of its centre of gravity; or give both",
        "u",
        least=0,
        required=True,
        example="0.12 kg m",
    )
    _mass = alternative(
        "mass",
        "Mass of the counterweight",
        "m_g",
        least=0,
        instead="product",
        needs="radius",
        gives=lambda given: {"product": given["mass"] * given["radius"]},
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
    axial_position: float | None = field("length", "Its place along the shaft", "z", absent="that of its cylinder")


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
        required=True,
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
        same = count == 2 and self.planes[0] == self.planes[1]
        message = "give two different places, such as '[-750 mm, 750 mm]', or leave it out"
        different = count if count != 2 else 1
        yield Rule("planes", count not in (0, 2) or same, f"{count} of them, {different} different; {message}")


class BalanceShaft(_Weight):
    """A shaft with a weight that turns `order` times in a turn of the crank, with it or against it."""

    _sense = alternative(
        Choice(
            ("with", "against"),
            {"same": "with", "forward": "with", "+": "with", "opposite": "against", "backward": "against"},
        ),
        "Sense of rotation: with the crank or against it",
        required=True,
        gives=lambda given: {"against": given["sense"] == "against"},
    )
    order: int = field(int, "Its turns per turn of the crank", "n", least=1, most=8, required=True, example="2")
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
    axial_position: float | None = field("length", "Its place along the shaft", "z", absent="moments left out")


class Locomotive(Record):
    """The driven wheels of a locomotive, with its counterweights; the cylinders are halfway between them."""

    wheel_distance: float = field(
        "length", "Between the counterweights of the left and of the right wheel", above=0, required=True
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
        "force", "Largest allowed hammer blow of a wheel", above=0, absent="permissible balanced share is not computed"
    )
