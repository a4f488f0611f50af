"""Every quantity that kurbel prints, declared once: the tables, CSV heads, JSON, limits and docs read it here."""

from __future__ import annotations

from typing import NamedTuple


class Quantity(NamedTuple):
    """One printed quantity.

    `id` stands in JSON and CSV, `symbol` over the printed table (`plain` where the output has no Greek letters),
    `kind` decides the unit (see `units`), and `text` says in one sentence what it is. A `residual` would be zero
    without rounding: people are not shown what of it is only that.
    """

    id: str
    symbol: str
    kind: str
    text: str
    plain: str = ""
    residual: bool = False

    @property
    def ascii_symbol(self) -> str:
        """The symbol for an output that cannot show Greek letters."""
        return self.plain or self.symbol

    def is_noise(self, value: float) -> bool:
        """Whether this value is a residual of rounding alone."""
        return self.residual and abs(value) < 10.0**NOISE_POWER


def _index(*quantities: Quantity) -> dict[str, Quantity]:
    return {quantity.id: quantity for quantity in quantities}


NOISE_POWER = -14
"""A residual below this power of ten is rounding, another on every processor."""

LISTS = ("phi_b_zero", "phi_reversal", "phi_crossing", "lobes")
"""Key values that are lists: no bound can be put on them."""

SHAFT_PARTS = {
    "pin": ("pin", "the crank pin"),
    "web_A": ("w,A", "web A"),
    "web_B": ("w,B", "web B"),
    "journal_A": ("j,A", "journal A"),
    "journal_B": ("j,B", "journal B"),
}
"""Parts of a crankshaft: the index of their symbols, and what they are called in a sentence."""


def _each(
    id: str, symbol: str, kind: str, text: str, parts: tuple[str, ...] = tuple(SHAFT_PARTS)
) -> tuple[Quantity, ...]:
    """Return the same quantity for each of these parts of a crankshaft; `*` stands for the part."""
    return tuple(
        Quantity(
            id.replace("*", part),
            symbol.replace("*", SHAFT_PARTS[part][0]),
            kind,
            text.replace("*", SHAFT_PARTS[part][1]),
            symbol.replace("*", SHAFT_PARTS[part][0]).replace("σ", "sigma"),
        )
        for part in parts
    )


_TURNING = ("pin", "journal_A", "journal_B")


COLUMNS = _index(
    Quantity("phi", "φ", "angle", "Crank angle from the inner dead centre, in the sense of rotation", "phi"),
    Quantity("psi", "ψ", "angle", "Angle between connecting rod and stroke line", "psi"),
    Quantity(
        "x",
        "x",
        "length",
        "Displacement from the inner dead centre toward the shaft; of a quick-return ram, from mid-stroke",
    ),
    Quantity("c", "c", "velocity", "Velocity, positive toward the shaft; of a quick-return ram, on the working stroke"),
    Quantity("b", "b", "acceleration", "Acceleration, positive as the velocity"),
    Quantity("theta", "θ", "angle", "Angle of the swinging member", "theta"),
    Quantity("theta_dot", "θ̇", "angular_velocity", "Angular velocity of the swinging member", "theta_dot"),
    Quantity("theta_ddot", "θ̈", "angular_acceleration", "Angular acceleration of the swinging member", "theta_ddot"),
    Quantity("c_block", "c_b", "velocity", "Speed at which the block on the crank pin slides along its slot"),
    Quantity("x_coupler", "x_K", "length", "Way of every coupler point along the frame"),
    Quantity("y_coupler", "y_K", "length", "Way of every coupler point across the frame"),
    Quantity("bx_coupler", "b_Kx", "acceleration", "Acceleration of every coupler point along the frame"),
    Quantity("by_coupler", "b_Ky", "acceleration", "Acceleration of every coupler point across the frame"),
    Quantity("p_head", "p_H", "pressure", "Gauge pressure in the head-end chamber, just after a jump"),
    Quantity("p_crank", "p_C", "pressure", "Gauge pressure in the crank-end chamber, just after a jump"),
    Quantity("P_gas", "P_gas", "force", "Force of gas, steam or water on all pistons of the rod"),
    Quantity("P_inertia", "P_b", "force", "Inertia force −m b of the reciprocating masses"),
    Quantity("P_weight", "P_w", "force", "Weight of the reciprocating masses along the stroke line"),
    Quantity("P_ram", "P_r", "force", "Force on a ram against its motion"),
    Quantity("M_out", "M_2", "torque", "Moment on what swings, or on the second crank, against its motion"),
    Quantity("P", "P", "force", "Force along the stroke line: gas, inertia, weight, and what a ram works against"),
    Quantity("S", "S", "force", "Force in the connecting rod, compression positive"),
    Quantity(
        "N",
        "N",
        "force",
        "Force on the guide (yoke frame: on the piston rod), positive on the side where it lies while an engine drives",
    ),
    Quantity("D", "D", "force", "Radial force at the crank pin, positive toward the shaft"),
    Quantity("T", "T", "force", "Tangential force at the crank pin, positive when it drives"),
    Quantity(
        "F_friction", "F_f", "force", "Friction of crosshead and rings along the stroke line, opposing the motion"
    ),
    Quantity("F_pin", "F_z", "force", "Force of the sliding block on the crank pin, in the sense of P"),
    Quantity("N_pair", "N_2", "force", "Force on each of the two guides of a yoke, opposite to one another"),
    Quantity("M_bend", "M_b", "torque", "Bending moment of N on the piston rod at its stuffing box"),
    Quantity("F_coupler", "F_K", "force", "Force in the coupler, thrust positive"),
    Quantity("M", "M", "torque", "Torque on the shaft"),
    Quantity("T_inertia", "T_b", "force", "Share of the inertia forces in T, at uniform rotation (Tolle)"),
    Quantity("E", "E", "energy", "Excess of the work of M over that of the resistance since angle 0"),
    Quantity("omega", "ω", "angular_velocity", "Angular velocity of the shaft", "omega"),
    Quantity("M_coupling", "M_K", "torque", "Torque in the elastic coupling"),
    Quantity("A_D", "A_D", "force", "Force on bearing A along D, in the frame that turns with the throw"),
    Quantity("A_T", "A_T", "force", "Force on bearing A along T"),
    Quantity("B_D", "B_D", "force", "Force on bearing B, beside the flywheel, along D"),
    Quantity("B_T", "B_T", "force", "Force on bearing B along T"),
    *_each("sigma_*", "σ_*", "stress", "Largest combined stress of * (Bach)"),
    *_each("mises_*", "σ_v,*", "stress", "Largest equivalent stress of * (von Mises)"),
)
"""Columns over the crank angle, by id."""

_FLYWHEEL = (
    Quantity("M_mean", "M_m", "torque", "Mean torque of the turning effort: the resistance"),
    Quantity("work_shaft", "A", "energy", "Work of the turning effort per cycle"),
    Quantity("power_shaft", "N_e", "power", "Power at the shaft, mean torque times nominal angular velocity"),
    Quantity("phi_crossing", "φ_T=W", "angle", "Crank angles at which the effort crosses the resistance", "phi_T=W"),
    Quantity("lobes", "A_1, A_2, …", "energy", "Excess work of the lobes, from crossing to crossing", "A_1, ..."),
    Quantity("E_max", "E_max", "energy", "Largest excess work since angle 0"),
    Quantity("E_min", "E_min", "energy", "Smallest excess work since angle 0"),
    Quantity("dE", "ΔE", "energy", "Largest swing of the excess work, over all lobes", "dE"),
    Quantity("energy_fluctuation", "ΔE/A", "ratio", "Coefficient of fluctuation of energy", "dE/A"),
    Quantity("J", "J", "inertia", "Moment of inertia of the flywheel: the given one, or that for the wanted δ"),
    Quantity("GD2", "GD²", "gd2", "Old form of the moment of inertia, 4gJ as a weight times an area", "GD2"),
    Quantity("J_needed", "J_δ", "inertia", "Flywheel for the wanted δ, ΔE/(δ ω²)", "J_delta"),
    Quantity(
        "J_exact", "J_δ,ω", "inertia", "Flywheel with which δ of the speed line is the wanted one", "J_delta,omega"
    ),
    Quantity("GD2_needed", "GD²_δ", "gd2", "The same as GD² = 4gJ", "GD2_delta"),
    Quantity("delta", "δ", "ratio", "Coefficient of speed fluctuation, (ω_max − ω_min)/ω_m", "delta"),
    Quantity("delta_book", "δ_0", "ratio", "The same after the books, ΔE/(J ω²)", "delta_0"),
    Quantity("omega_max", "ω_max", "angular_velocity", "Largest angular velocity", "omega_max"),
    Quantity("omega_min", "ω_min", "angular_velocity", "Smallest angular velocity", "omega_min"),
    Quantity("omega_mean", "ω_m", "angular_velocity", "Mean angular velocity over time", "omega_m"),
    Quantity(
        "multiplier", "μ", "ratio", "What is left of a disturbance after a cycle (Floquet); below 1 it dies away", "mu"
    ),
    Quantity("natural_order", "n_e", "ratio", "Natural frequency of the coupled masses over the angular velocity"),
    Quantity("M_coupling_max", "M_K,max", "torque", "Largest torque in the elastic coupling"),
    Quantity("M_coupling_min", "M_K,min", "torque", "Smallest torque in the elastic coupling"),
    Quantity("amplification", "V", "ratio", "Swing of the torque in the coupling over that in a rigid one"),
    Quantity("P_dead_centre", "P_d + P_p", "force", "Force before the pump in a dead centre, without inertia"),
)
_STRENGTH = (
    Quantity("P_dc", "P_dc", "force", "Full piston force, without inertia, taken in the dead centre"),
    Quantity(
        "C_rod", "C_r", "force", "Centrifugal force of the connecting rod's turning part, which D does not contain"
    ),
    *_each("sigma_*_dc", "σ_*,dc", "stress", "Combined stress of * in the dead centre under full force (Bach)"),
    *_each("sigma_*_max", "σ_*,max", "stress", "Largest combined stress of * over the cycle (Bach)"),
    *_each("mises_*_max", "σ_v,*,max", "stress", "Largest equivalent stress of * over the cycle (von Mises)"),
    *_each("safety_*_min", "S_*", "ratio", "Smallest safety of *: k_b over its combined stress, dead centre and cycle"),
    Quantity("A_max", "A_max", "force", "Largest force on bearing A"),
    Quantity("B_max", "B_max", "force", "Largest force on bearing B, beside the flywheel"),
    Quantity("p_pin_dc", "p_pin,dc", "pressure", "Pressure on the crank pin under full force, P/(d l)"),
    *_each("p_*_max", "p_*,max", "pressure", "Largest pressure on * over the cycle, force over d l", _TURNING),
    *_each("p_*_mean", "p_*,m", "pressure", "Mean pressure on * over the time of a cycle", _TURNING),
    *_each("k_*", "k_*", "pressure_velocity", "Mean pressure times surface speed, p_m v, of *", _TURNING),
    Quantity(
        "equilibrium_residual",
        "ΣF, ΣM",
        "ratio",
        "What is left of the sums of forces and moments on the crankshaft",
        "sum F, M",
        residual=True,
    ),
)
_MOTION = (
    Quantity("stroke", "s", "length", "Stroke"),
    Quantity("swing", "θ_s", "angle", "Angle through which the member swings", "theta_s"),
    Quantity("theta_min", "θ_min", "angle", "Smallest angle of the swinging member", "theta_min"),
    Quantity("theta_max", "θ_max", "angle", "Largest angle of the swinging member", "theta_max"),
    Quantity("phi_idc", "φ_i", "angle", "Crank angle of the inner dead centre", "phi_i"),
    Quantity("phi_odc", "φ_o", "angle", "Crank angle of the outer dead centre", "phi_o"),
    Quantity("phi_work", "φ_w", "angle", "Crank rotation of the outstroke (working stroke)", "phi_w"),
    Quantity("phi_return", "φ_r", "angle", "Crank rotation of the return stroke", "phi_r"),
    Quantity("time_ratio", "t_w/t_r", "ratio", "Time of the outstroke (working stroke) over that of the return stroke"),
    Quantity("v", "v", "velocity", "Crank-pin speed"),
    Quantity("c_m", "c_m", "velocity", "Mean piston speed 2 s n (R 290)"),
    Quantity("c_max", "c_max", "velocity", "Largest velocity on the outstroke"),
    Quantity("c_min", "c_min", "velocity", "Largest velocity on the return stroke, negative"),
    Quantity("c_work_max", "c_a,max", "velocity", "Largest speed of the working stroke (R 304)"),
    Quantity("c_return_max", "c_r,max", "velocity", "Largest speed of the return stroke (R 305)"),
    Quantity("b_max", "b_max", "acceleration", "Largest acceleration"),
    Quantity("b_min", "b_min", "acceleration", "Smallest acceleration: the largest deceleration, negative"),
    Quantity("phi_b_zero", "φ_b=0", "angle", "Crank angles at which the acceleration passes zero", "phi_b=0"),
    Quantity("theta_dot_max", "θ̇_max", "angular_velocity", "Largest angular velocity of the swing", "theta_dot_max"),
    Quantity("theta_dot_min", "θ̇_min", "angular_velocity", "Smallest angular velocity of the swing", "theta_dot_min"),
    Quantity("theta_ddot_max", "θ̈_max", "angular_acceleration", "Largest angular acceleration", "theta_ddot_max"),
    Quantity("theta_ddot_min", "θ̈_min", "angular_acceleration", "Smallest angular acceleration", "theta_ddot_min"),
    Quantity("b_coupler", "b_K", "acceleration", "Acceleration v²/R of every coupler point, toward its centre"),
    Quantity("transmission_min", "μ_min", "angle", "Smallest transmission angle", "mu_min"),
    Quantity("transmission_max", "μ_max", "angle", "Largest transmission angle", "mu_max"),
)
KEY_VALUES = _index(
    *_MOTION,
    Quantity("A_head", "A_H", "area", "Piston area at the head end"),
    Quantity("A_crank", "A_C", "area", "Piston area at the crank end"),
    Quantity("m", "m", "mass", "Reciprocating mass with its share of the connecting rod"),
    Quantity("P_max", "P_max", "force", "Largest piston force"),
    Quantity("P_min", "P_min", "force", "Smallest piston force"),
    Quantity("P_start_max", "P_0,max", "force", "Largest piston force without inertia: starting and slow running"),
    Quantity("P_start_min", "P_0,min", "force", "Smallest piston force without inertia: starting and slow running"),
    Quantity("P_inertia_max", "P_b,max", "force", "Largest inertia force toward the shaft"),
    Quantity("P_inertia_min", "P_b,min", "force", "Largest inertia force away from the shaft, negative"),
    Quantity(
        "phi_reversal", "φ_P=0", "angle", "Druckwechsel: crank angles at which the piston force turns over", "phi_P=0"
    ),
    Quantity("S_max", "S_max", "force", "Largest rod force"),
    Quantity("S_min", "S_min", "force", "Smallest rod force"),
    Quantity("N_max", "N_max", "force", "Largest guide force"),
    Quantity("N_min", "N_min", "force", "Smallest guide force"),
    Quantity("F_pin_max", "F_z,max", "force", "Largest force of the sliding block on the crank pin"),
    Quantity("F_pin_min", "F_z,min", "force", "Smallest force of the sliding block on the crank pin"),
    Quantity("pin_pressure", "p_z", "pressure", "Largest pressure of the sliding block on the crank pin"),
    Quantity("N_pair_max", "N_2,max", "force", "Largest force on each of the two guides of a yoke"),
    Quantity("N_pair_min", "N_2,min", "force", "Smallest force on each of the two guides of a yoke"),
    Quantity("M_bend_max", "M_b,max", "torque", "Largest bending moment of N on the piston rod"),
    Quantity("M_bend_min", "M_b,min", "torque", "Smallest bending moment of N on the piston rod"),
    Quantity("F_coupler_max", "F_K,max", "force", "Largest force in the coupler"),
    Quantity("F_coupler_min", "F_K,min", "force", "Smallest force in the coupler"),
    Quantity("coupler_inertia", "F_b", "force", "Inertia force m v²/R of the coupler, turning with the cranks"),
    Quantity("T_max", "T_max", "force", "Largest tangential force"),
    Quantity("T_min", "T_min", "force", "Smallest tangential force"),
    Quantity("M_max", "M_max", "torque", "Largest torque"),
    Quantity("M_min", "M_min", "torque", "Smallest torque"),
    Quantity("work", "A_i", "energy", "Indicated work of all pistons of the rod per cycle"),
    Quantity("work_driving", "A_i+", "energy", "Indicated work of the driving pistons per cycle"),
    Quantity("work_driven", "A_i−", "energy", "Indicated work of the driven pistons per cycle, negative", "A_i-"),
    Quantity("resistance_work", "A_r", "energy", "Work per cycle of what the ram or rocker works against, negative"),
    Quantity("power", "N_i", "power", "Indicated power"),
    Quantity("mean_pressure", "p_i", "pressure", "Mean indicated pressure of the cylinder's own piston"),
    Quantity(
        "work_sensitivity",
        "dA_i/A_i",
        "ratio",
        "Change of the indicated work of the traces, over that work, if they are put 0.1 deg later",
    ),
    Quantity("W", "W", "force", "Mean tangential force over the cycle: the resistance"),
    Quantity("friction_work", "A_f", "energy", "Work lost by crosshead and ring friction per cycle"),
    Quantity("loss_crosshead", "e_K", "ratio", "Work lost at the crosshead over that of the driving pistons"),
    Quantity(
        "loss_crosshead_redtenbacher",
        "½ λ f",
        "ratio",
        "Redtenbacher's mean over the rod angle of the same loss (D 7)",
        "lam f/2",
    ),
    Quantity("loss_rings", "e_R", "ratio", "Work lost at the piston rings over that of the driving pistons"),
    Quantity(
        "energy_residual",
        "ΔA/A",
        "ratio",
        "Energy in minus energy out by an independent quadrature",
        "dA/A",
        residual=True,
    ),
    *_FLYWHEEL,
    *_STRENGTH,
)
"""Key values, by id."""

OF_COMMAND = {
    "motion": tuple(quantity.id for quantity in _MOTION),
    "flywheel": tuple(quantity.id for quantity in _FLYWHEEL),
    "stress": tuple(quantity.id for quantity in _STRENGTH),
}
"""Command -> the ids of the key values that it answers; all others belong to `kurbel forces`."""
OF_WHOLE_MACHINE = ("W", "T_max", "T_min", "M_max", "M_min")
"""Key values that `kurbel flywheel` has of the whole machine, beside those of its cylinders."""

STRESSES = _index(
    Quantity(
        "compression",
        "σ_c",
        "stress",
        "Compression of a web by the force along it, negative where it is pulled",
        "sigma_c",
    ),
    Quantity("bending_in_plane", "σ_b1", "stress", "Bending in the plane of the throw", "sigma_b1"),
    Quantity("bending_out_of_plane", "σ_b2", "stress", "Bending square to the plane of the throw", "sigma_b2"),
    Quantity("torsion", "τ", "stress", "Torsion", "tau"),
    Quantity("combined", "σ_res", "stress", "Combined stress 0.35 σ + 0.65 √(σ² + 4(α₀τ)²) (Bach)", "sigma_res"),
    Quantity("von_mises", "σ_v", "stress", "Equivalent stress √(σ² + 3τ²) (von Mises)", "sigma_v"),
)
"""Stresses at one place of a crankshaft, by id."""

FACTORS = _index(
    Quantity("acceleration_factor", "cos φ + R/L cos 2φ", "ratio", "b over v²/R", "cos phi + R/L cos 2phi"),
    Quantity("velocity_factor", "sin(φ+ψ)/cos ψ", "ratio", "c over v, and T over P", "sin(phi+psi)/cos psi"),
    Quantity("displacement_factor", "x/R", "ratio", "x over R"),
    Quantity("psi", "ψ", "angle", "Angle between connecting rod and stroke line", "psi"),
    Quantity("rod_force_factor", "S/P", "ratio", "Rod force over piston force, 1/cos ψ (R 300)"),
    Quantity("guide_force_factor", "N/P", "ratio", "Guide force over piston force, tan ψ (R 301)"),
    Quantity("radial_force_factor", "D/P", "ratio", "Radial over piston force, cos(φ+ψ)/cos ψ (R 302)"),
)
"""Rows of Zusammenstellung 112, by id."""
