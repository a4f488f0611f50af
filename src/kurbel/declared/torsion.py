"""The quantities of harmonics and torsional vibration: orders, modes, critical speeds, what forced vibration makes."""

from kurbel.quantity import Quantity, by_id

TORQUE_ORDERS = by_id(
    Quantity("speed", "n", "speed", "Speed of rotation"),
    Quantity("order", "ν", "ratio", "Order: periods per turn of the shaft"),
    Quantity("M_cos", "a_ν", "torque", "Factor of cos νφ"),
    Quantity("M_sin", "b_ν", "torque", "Factor of sin νφ"),
    Quantity("M_amplitude", "|M_ν|", "torque", "Amplitude of the order"),
    Quantity("M_phase", "ε_ν", "angle", "Phase: the order is |M_ν| cos(νφ − ε_ν)"),
    Quantity("M_gas", "|M_g|", "torque", "Amplitude of what does not depend on the speed"),
    Quantity("M_inertia", "|M_b|", "torque", "Amplitude of the inertia forces, which goes with the square of ω"),
    Quantity("t_order", "t_ν", "pressure", "Tangential-pressure coefficient |M_ν|/(R A)"),
)
"""Of one order of a torque, by id."""

MODES = by_id(
    Quantity("mode", "i", "ratio", "Number of the mode; 0 is the rotation of the whole"),
    Quantity("frequency", "f", "frequency", "Natural frequency"),
    Quantity("omega_natural", "ω_e", "angular_velocity", "Natural angular frequency"),
)
"""Of one natural vibration, by id."""

PIECES = by_id(
    Quantity("M_shaft_mean", "M_w,m", "torque", "Mean torque in the piece of shaft"),
    Quantity("M_shaft_max", "M_w,max", "torque", "Largest torque in the piece, all orders together"),
    Quantity("M_shaft_min", "M_w,min", "torque", "Smallest torque in the piece"),
    Quantity("M_vibratory", "M_w,a", "torque", "Vibratory torque: half of what it swings"),
    Quantity("tau_mean", "τ_m", "stress", "Stress of the mean torque where the piece is thinnest"),
    Quantity("tau_vibratory", "τ_a", "stress", "Vibratory stress: half of what it swings"),
)
"""Of one piece of shaft at the working speed, by id."""

CRITICAL_SPEEDS = by_id(
    TORQUE_ORDERS["order"],
    MODES["mode"],
    Quantity("speed", "n_k", "speed", "Critical speed, at which the order meets the mode"),
    Quantity("phase_sum", "|ΣΘ|", "ratio", "Sum of the phase vectors of the cranks, Θ as in Holzer's table"),
    Quantity("distance", "Δn/n", "ratio", "Distance from the working speed, over that"),
    Quantity("M_vibratory", "M_w,a", "torque", "Largest vibratory torque of any piece when running there"),
    Quantity("tau_vibratory", "τ_a", "stress", "Largest vibratory stress of any piece when running there"),
)
"""Of one critical speed, by id."""

HOLZER = by_id(
    Quantity("inertia", "J", "inertia", "Moment of inertia of the mass"),
    Quantity("theta", "Θ", "ratio", "Amplitude of the mass, over that of the first"),
    Quantity("inertia_torque", "ω²JΘ", "torque", "Torque of the mass per radian of the first", "w2 J Theta"),
    Quantity("torque_sum", "Σω²JΘ", "torque", "Torque in the piece behind the mass per radian", "sum"),
    Quantity("stiffness", "k", "stiffness", "Stiffness of the piece behind the mass"),
    Quantity("twist", "ΔΘ", "ratio", "Twist of the piece behind the mass"),
)
"""Of one mass in Holzer's table, by id."""

SPEEDS = by_id(
    Quantity("speed", "n", "speed", "Speed of rotation"),
    Quantity("M_vibratory", "M_w,a", "torque", "Vibratory torque in the piece at that speed"),
    Quantity("tau_vibratory", "τ_a", "stress", "Vibratory stress in the piece at that speed"),
)
"""Of one piece at one speed, by id."""
