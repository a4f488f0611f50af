"""The quantities of `kurbel balance`: free forces and moments, their orders, and the weights against them."""

from functools import partial

from kurbel.declared.quantity import Quantity, by_id

_COMMAND = ("balance",)
_balance = partial(Quantity, commands=_COMMAND)
_on_request = partial(Quantity, commands=_COMMAND, on_request=_COMMAND)

BALANCE_COLUMNS = (
    _balance("F_x", "F_x", "force", "Free force along the stroke line of cylinder 1, outward from the shaft"),
    _balance("F_y", "F_y", "force", "Free force across it, 90° on in the sense of rotation"),
    _on_request("F_free", "F", "force", "Free force, its magnitude"),
    _on_request("F_x_book", "F_x,0", "force", "F_x by the acceleration of first order (R 291)"),
    _on_request("F_y_book", "F_y,0", "force", "F_y by the acceleration of first order (R 291)"),
    _balance("M_x", "M_x", "torque", "Free moment Σ (z − z_0) F_x"),
    _balance("M_y", "M_y", "torque", "Free moment Σ (z − z_0) F_y"),
    _on_request("M_free", "M_f", "torque", "Free moment, its magnitude"),
    _on_request("M_x_book", "M_x,0", "torque", "M_x by the acceleration of first order (R 291)"),
    _on_request("M_y_book", "M_y,0", "torque", "M_y by the acceleration of first order (R 291)"),
    _balance("M_roll", "M_roll", "torque", "Rolling moment on the frame about the shaft, in the sense of rotation"),
)
BALANCE_VALUES = (
    _balance("F_free_max", "F_max", "force", "Largest free force"),
    _balance("F_free_max_book", "F_0,max", "force", "The same by the acceleration of first order (R 291)"),
    _balance("M_free_max", "M_f,max", "torque", "Largest free moment"),
    _balance("M_free_max_book", "M_f,0,max", "torque", "The same by the acceleration of first order (R 291)"),
    _balance("M_roll_max", "M_roll,max", "torque", "Largest rolling moment on the frame", unless="rolls_as_it_turns"),
    _balance("M_roll_min", "M_roll,min", "torque", "Smallest rolling moment on the frame", unless="rolls_as_it_turns"),
    _balance("counterweight_given", "u", "unbalance", "Vector sum of the given counterweights, mass times radius"),
    _balance(
        "counterweight_best",
        "u_1",
        "unbalance",
        "Counterweight against what rotates and half of what reciprocates",
    ),
    _balance("counterweight_best_angle", "α_1", "angle", "Its direction from throw 1"),
    _balance("counterweight_least", "u_min", "unbalance", "Counterweight that leaves the least largest free force"),
    _balance("counterweight_least_angle", "α_min", "angle", "Its direction from throw 1"),
    _balance("share_best", "c_min", "ratio", "Share of the reciprocating mass that it balances"),
    _balance("F_free_best", "F_min", "force", "Largest free force that it leaves"),
    _balance("train_speed", "v_z", "velocity", "Speed of the train"),
    _balance("traction_variation", "F_z", "force", "Largest variation of the tractive force"),
    _balance("swaying_couple", "M_s", "torque", "Largest swaying couple, about the upright axis"),
    _balance("hammer_blow", "H", "force", "Hammer blow: by how much a counterweight loads and lifts its wheel"),
    _balance("hammer_speed", "n_H", "speed", "Speed of rotation at which the hammer blow is the load of the wheel"),
    _balance("hammer_train_speed", "v_H", "velocity", "Speed of the train at which it is"),
    _balance("share_allowed", "c_H", "ratio", "Largest share of the reciprocating masses within the limit of the blow"),
)

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
