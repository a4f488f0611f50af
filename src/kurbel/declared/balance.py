"""Columns of the tables of `kurbel balance`: orders, ellipses, weights."""

from kurbel.quantity import Quantity, by_id

ORDERS = by_id(
    Quantity("order", "n", "ratio", "Turns of the circles in one turn of the crank"),
    Quantity("F_forward", "F_+", "force", "Free force: circle that turns with the crank"),
    Quantity("F_backward", "F_−", "force", "Free force: circle that turns against it"),
    Quantity("F_forward_book", "F_+,0", "force", "The same by the acceleration of first order (R 291)"),
    Quantity("F_backward_book", "F_−,0", "force", "The same by the acceleration of first order (R 291)"),
    Quantity("F_share", "F_n²/F²", "ratio", "Share of the order in the mean square of the free force", "F_n2/F2"),
    Quantity("M_forward", "M_+", "torque", "Free moment: circle that turns with the crank"),
    Quantity("M_backward", "M_−", "torque", "Free moment: circle that turns against it"),
    Quantity("M_forward_book", "M_+,0", "torque", "The same by the acceleration of first order (R 291)"),
    Quantity("M_backward_book", "M_−,0", "torque", "The same by the acceleration of first order (R 291)"),
    Quantity("M_share", "M_n²/M²", "ratio", "Share of the order in the mean square of the free moment", "M_n2/M2"),
)
"""Columns of the table of orders; amplitudes."""


def _ellipse(name: str, kind: str, of: str) -> tuple[Quantity, ...]:
    return (
        Quantity(f"{name}_long", f"{name}_a", kind, f"{of}: longer half-axis of the ellipse of this order"),
        Quantity(f"{name}_short", f"{name}_b", kind, f"{of}: shorter half-axis"),
        Quantity(f"{name}_direction", f"∠{name}_a", "angle", "Direction of the longer axis", f"arg {name}_a"),
        Quantity(f"{name}_forward_phase", f"∠{name}_+", "angle", "Forward circle at φ = 0", f"arg {name}_+"),
        Quantity(f"{name}_backward_phase", f"∠{name}_−", "angle", "Backward circle at φ = 0", f"arg {name}_-"),
    )


ELLIPSES = by_id(ORDERS["order"], *_ellipse("F", "force", "Free force"), *_ellipse("M", "torque", "Free moment"))
"""Columns of the table of ellipses: what the two circles of an order make together."""

WEIGHTS = by_id(
    Quantity("axial_position", "z", "length", "Place along the shaft"),
    Quantity("product", "u", "unbalance", "Mass times radius"),
    Quantity("angle", "α", "angle", "Direction at φ = 0 from the stroke line of cylinder 1"),
    Quantity("hammer_blow", "H", "force", "By how much it loads and lifts its wheel"),
)
"""Columns of the tables of weights."""
