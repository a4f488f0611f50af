"""The quantities of `kurbel flywheel`: turning effort, excess work, flywheel, speed line, coupling."""

from functools import partial

from kurbel.declared.quantity import Quantity

_FLYWHEEL = ("flywheel",)
_flywheel = partial(Quantity, commands=_FLYWHEEL)

FLYWHEEL_COLUMNS = (
    _flywheel("T_inertia", "T_b", "force", "Share of the inertia forces in T, at uniform rotation (Tolle)"),
    Quantity("M", "M", "torque", "Torque on the shaft", commands=_FLYWHEEL, extremes=_FLYWHEEL, called="torque"),
    _flywheel("E", "E", "energy", "Excess of the work of M over that of the resistance since angle 0"),
    _flywheel("omega", "ω", "angular_velocity", "Angular velocity of the shaft"),
    _flywheel(
        "alpha",
        "α",
        "angular_acceleration",
        "Angular acceleration of the shaft, just after a jump",
        extremes=_FLYWHEEL,
        called="angular acceleration of the shaft",
    ),
    _flywheel("M_coupling", "M_K", "torque", "Torque in the elastic coupling"),
)
EFFORT_VALUES = (
    Quantity(
        "M_mean",
        "M_m",
        "torque",
        "Mean torque of the turning effort: the resistance",
        commands=(*_FLYWHEEL, "harmonics"),
    ),
    _flywheel("work_shaft", "A", "energy", "Work of the turning effort per cycle"),
    _flywheel("power_shaft", "N_e", "power", "Power at the shaft, mean torque times nominal angular velocity"),
)
FLYWHEEL_VALUES = (
    _flywheel("phi_crossing", "φ_T=W", "angle", "Crank angles at which the effort crosses the resistance", listed=True),
    _flywheel(
        "lobes", "A_1, A_2, …", "energy", "Excess work of the lobes, from crossing to crossing", "A_1, ...", listed=True
    ),
    _flywheel("E_max", "E_max", "energy", "Largest excess work since angle 0"),
    _flywheel("E_min", "E_min", "energy", "Smallest excess work since angle 0"),
    _flywheel("dE", "ΔE", "energy", "Largest swing of the excess work, over all lobes"),
    _flywheel("energy_fluctuation", "ΔE/A", "ratio", "Coefficient of fluctuation of energy"),
    _flywheel("J", "J", "inertia", "Moment of inertia of the flywheel: the given one, or that for the wanted δ"),
    _flywheel("GD2", "GD²", "gd2", "Old form of the moment of inertia, 4gJ as a weight times an area", "GD2"),
    _flywheel("J_needed", "J_δ", "inertia", "Flywheel for the wanted δ, ΔE/(δ ω²)", unless="is_the_needed"),
    _flywheel("GD2_needed", "GD²_δ", "gd2", "The same as GD² = 4gJ", "GD2_delta", unless="is_the_needed"),
    _flywheel("rim_section", "A_K", "area", "Section of the rim for the wanted δ, or for J: 4 J/(π ρ D (D² + h²))"),
    _flywheel("rim_speed", "v_K", "velocity", "Speed of the middle of the rim"),
    _flywheel("rim_stress", "σ_K", "stress", "Hoop stress of the rim, ρ v²"),
    _flywheel("J_exact", "J_δ,ω", "inertia", "Flywheel with which δ of the speed line is the wanted one"),
    _flywheel("delta", "δ", "ratio", "Coefficient of speed fluctuation, (ω_max − ω_min)/ω_m"),
    _flywheel("delta_book", "δ_0", "ratio", "The same after the books, ΔE/(J ω²)"),
    _flywheel("omega_max", "ω_max", "angular_velocity", "Largest angular velocity"),
    _flywheel("omega_min", "ω_min", "angular_velocity", "Smallest angular velocity"),
    _flywheel("omega_mean", "ω_m", "angular_velocity", "Mean angular velocity over time"),
    _flywheel(
        "multiplier", "μ", "ratio", "What is left of a disturbance after a cycle (Floquet); below 1 it dies away"
    ),
    _flywheel("natural_order", "n_e", "ratio", "Natural frequency of the coupled masses over the angular velocity"),
    _flywheel("M_coupling_max", "M_K,max", "torque", "Largest torque in the elastic coupling"),
    _flywheel("M_coupling_min", "M_K,min", "torque", "Smallest torque in the elastic coupling"),
    _flywheel("amplification", "V", "ratio", "Swing of the torque in the coupling over that in a rigid one"),
    _flywheel("P_dead_centre", "P_d + P_p", "force", "Force before the pump in a dead centre, without inertia"),
)
