"""What is put on a machine to balance it: counterweights on the crank, balance shafts, the wheels of a locomotive."""

from dataclasses import dataclass
from typing import Any, ClassVar

from kurbel.declared.forms import Choice, Count, Listing, Number, Physical, not_negative, positive
from kurbel.declared.keys import Described, Key, Keys
from kurbel.errors import refused

_WEIGHT_KEYS: Keys = {
    "product": not_negative(
        "unbalance",
        "Its mass times the radius of its centre of gravity; or give both",
        "u",
        required=True,
        example="0.12 kg m",
    ),
    "mass": not_negative("mass", "Mass of the counterweight", "m_g", instead="product", needs="radius"),
    "radius": positive("length", "From the axis of the shaft to its centre of gravity", "r_g", needs="mass"),
    "axial_position": Key(Physical("length"), "Its place along the shaft", "z", absent="that of its cylinder"),
}


def _product(keys: dict[str, Any]) -> float:
    """Take product, or mass and radius, out of the keys, and return the product in kg m."""
    mass, radius = keys.pop("mass", None), keys.pop("radius", None)
    product: float = keys.pop("product") if mass is None else mass * radius
    return product


@dataclass(frozen=True, eq=False, repr=False)
class Counterweight(Described):
    """A weight that turns with the crank: mass times radius in kg m, its direction and its place.

    angle: degrees from the throw, in the sense of rotation; axial_position: place along the shaft in m, None for that
    of the cylinder, and not known for a weight of the whole machine.
    """

    product: float
    angle: float = 180.0
    axial_position: float | None = None

    KEYS: ClassVar[Keys] = _WEIGHT_KEYS | {
        "angle": Key(
            Physical("angle", least=-360, most=360),
            "Its direction from the throw of its cylinder, or of crank 1, in the sense of rotation",
            "α",
            absent="180 deg, opposite the throw",
        )
    }

    @classmethod
    def of_keys(cls, **keys: Any) -> "Counterweight":
        """Return the counterweight that these keys of a machine file describe."""
        return cls(_product(keys), **keys)


@dataclass(frozen=True, eq=False, repr=False)
class SharedCounterweights(Described):
    """Counterweights opposite each throw, for what turns with it and a share of what goes to and fro.

    planes: two places along the shaft in m between which those of every throw are divided as by a lever, so that they
    have its force and its moment; empty: each stands at its own throw.
    """

    share: float
    planes: tuple[float, ...] = ()

    KEYS: ClassVar[Keys] = {
        "share": Key(
            Number(least=0, most=1),
            "Share of the reciprocating mass that is balanced, beside all of the rotating mass",
            "c",
            required=True,
            example="0.5",
        ),
        "planes": Key(
            Listing(Physical("length")),
            "Two places along the shaft where all of them stand, such as the wheels of a locomotive",
            absent="each opposite its own throw",
        ),
    }

    def __post_init__(self) -> None:
        if self.planes and (len(self.planes) != 2 or self.planes[0] == self.planes[1]):
            message = "give two different places, such as '[-750 mm, 750 mm]', or leave it out"
            refused(f"{len(self.planes)} of them, {len(set(self.planes))} different; {message}", "planes")


@dataclass(frozen=True, eq=False, repr=False)
class BalanceShaft(Described):
    """A shaft with a weight of mass times radius in kg m that turns `order` times in a turn of the crank.

    against: whether it turns against the crank; angle: degrees of the weight from the stroke line of cylinder 1, in the
    sense of rotation of the crank, while crank 1 is in its inner dead centre; axial_position: in m, None: not known.
    """

    product: float
    order: int
    against: bool = False
    angle: float = 180.0
    axial_position: float | None = None

    KEYS: ClassVar[Keys] = _WEIGHT_KEYS | {
        "order": Key(Count(least=1, most=8), "Its turns in one turn of the crank", "n", required=True, example="2"),
        "sense": Key(
            Choice(
                ("with", "against"),
                {"same": "with", "forward": "with", "+": "with", "opposite": "against", "backward": "against"},
            ),
            "Whether it turns with the crank or against it",
            required=True,
        ),
        "axial_position": Key(Physical("length"), "Its place along the shaft", "z", absent="moments left out"),
        "angle": Key(
            Physical("angle", least=-360, most=360),
            "Direction of its weight from the stroke line of cylinder 1, in the sense of rotation of the crank, while "
            "crank 1 is in its inner dead centre",
            "α",
            absent="180 deg, away from the cylinder",
        ),
    }

    @classmethod
    def of_keys(cls, sense: str, **keys: Any) -> "BalanceShaft":
        """Return the shaft that these keys of a machine file describe."""
        return cls(_product(keys), against=sense == "against", **keys)


@dataclass(frozen=True, eq=False, repr=False)
class Locomotive(Described):
    """The driven wheels of a locomotive, in which its counterweights stand: lengths in m, forces in N.

    wheel_distance: between the planes of the counterweights in the left and the right wheel, in the middle of which
    the cylinders stand; hammer_limit: what the variation of the load of a wheel by its counterweight may be.
    """

    wheel_distance: float
    wheel_diameter: float | None = None
    wheel_load: float | None = None
    hammer_limit: float | None = None

    KEYS: ClassVar[Keys] = {
        "wheel_distance": positive(
            "length", "Between the counterweights of the left and of the right wheel", required=True
        ),
        "wheel_diameter": positive("length", "Diameter of the driven wheels", "D", absent="speed of the shaft alone"),
        "wheel_load": positive(
            "force",
            "Load of one driven wheel on its rail, at rest",
            "Q",
            absent="not told at which speed a wheel lifts",
        ),
        "hammer_limit": positive(
            "force", "Largest allowed hammer blow of a wheel", absent="not told which share may be balanced"
        ),
    }
