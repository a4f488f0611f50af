"""The report of `kurbel friction`: the inclined plane of Redtenbacher 1862, D 1 to 5."""

import math

from kurbel.errors import NoSolutionError, UsageError
from kurbel.quantity import Quantity, by_id
from kurbel.solver.friction import holding_force
from kurbel.tables.shown import PlaceRow, Places, shown_key_values
from kurbel.tables.tables import LeftOut, Part, Report

_UP = Quantity("P_up", "P/Q", "ratio", "Force over the weight that moves the body up")
_HELD = Quantity(
    "P_held", "P_1/Q", "ratio", "Force over the weight that keeps the body from sliding down"
)
_RHO = Quantity(
    "rho", "ρ", "angle", "Angle of friction: at a smaller incline the body rests by itself", "rho"
)


def inclined_plane(incline: float, coefficient: float, direction: float = 0.0) -> Report:
    """Return the forces over the weight on a body on a plane at `incline`, in degrees, with this coefficient f.

    direction: of the force above the plane, in degrees; a horizontal force (D 3) acts below it. Raises UsageError for
    angles and coefficients that make no inclined plane, and for a force that lifts the body off it.
    """
    _check(incline, coefficient, direction)
    requested = {
        f"{direction:g} deg above plane" if direction else "along plane": direction,
        "horizontal": -incline,
    }
    left: list[LeftOut] = []
    rows: list[PlaceRow] = []
    for name, angle in requested.items():
        forces: dict[str, float | None] = {}
        for quantity, friction in ((_UP, coefficient), (_HELD, -coefficient)):
            try:
                forces[quantity.id] = holding_force(incline, friction, angle)
            except NoSolutionError:
                what = f"{quantity.symbol} {name}"
                left.append(LeftOut(what, "no force does it, however large: the body locks itself"))
        rows.append(((name,), forces))
    table = Places(
        "plane", "Force P over the weight Q", ("direction",), by_id(_UP, _HELD), rows
    ).shown("si")
    (rho,) = shown_key_values([(_RHO, math.degrees(math.atan(coefficient)))], "si")
    body = Part("inclined plane", (), (rho,), tuple(left), place_tables=(table,))
    head = (
        f"Incline {incline:g} deg, coefficient {coefficient:g} (Redtenbacher 1862)",
        "P moves the body up, P_1 keeps it from sliding down; a negative P_1 must push: friction alone holds the body.",
    )
    return Report(
        "Friction on an inclined plane", "friction", None, "cylinders", (), body, head=head
    )


def _check(incline: float, coefficient: float, direction: float) -> None:
    if not 0 <= incline < 90:
        raise UsageError(f"--incline {incline:g}: a plane is inclined by 0 to less than 90 degrees")
    if not coefficient >= 0:
        raise UsageError(
            f"--coefficient {coefficient:g}: a coefficient of friction is not negative"
        )
    if not -90 < direction < 90 - incline:
        room = f"more than -90 and less than {90 - incline:g} degrees above the plane"
        raise UsageError(
            f"--direction {direction:g}: must be {room}; steeper the force lifts the body off"
        )
