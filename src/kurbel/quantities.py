"""Every quantity that kurbel prints, declared once: the tables, CSV heads, JSON, limits and docs read it here."""

from __future__ import annotations

from typing import NamedTuple


class Quantity(NamedTuple):
    """One printed quantity.

    `id` stands in JSON and CSV, `symbol` over the printed table (`plain` where the output has no Greek letters),
    `kind` decides the unit (see `kurbel.units`), and `text` says in one sentence what it is.
    """

    id: str
    symbol: str
    kind: str
    text: str
    plain: str = ""

    @property
    def ascii_symbol(self) -> str:
        """The symbol for an output that cannot show Greek letters."""
        return self.plain or self.symbol


def _index(*quantities: Quantity) -> dict[str, Quantity]:
    return {quantity.id: quantity for quantity in quantities}


COLUMNS = _index(
    Quantity("phi", "φ", "angle", "Crank angle from the inner dead centre, in the sense of rotation", "phi"),
    Quantity("psi", "ψ", "angle", "Angle between connecting rod and stroke line", "psi"),
    Quantity("x", "x", "length", "Displacement from the inner dead centre, positive toward the shaft"),
    Quantity("c", "c", "velocity", "Velocity, positive toward the shaft"),
    Quantity("b", "b", "acceleration", "Acceleration, positive toward the shaft"),
    Quantity("theta", "θ", "angle", "Angle of the swinging member", "theta"),
    Quantity("theta_dot", "θ̇", "angular_velocity", "Angular velocity of the swinging member", "theta_dot"),
    Quantity("theta_ddot", "θ̈", "angular_acceleration", "Angular acceleration of the swinging member", "theta_ddot"),
    Quantity("p_head", "p_H", "pressure", "Gauge pressure in the head-end chamber, just after a jump"),
    Quantity("p_crank", "p_C", "pressure", "Gauge pressure in the crank-end chamber, just after a jump"),
    Quantity("P_gas", "P_gas", "force", "Force of gas, steam or water on all pistons of the rod"),
    Quantity("P_inertia", "P_b", "force", "Inertia force −m b of the reciprocating masses"),
    Quantity("P_weight", "P_w", "force", "Weight of the reciprocating masses along the stroke line"),
    Quantity("P", "P", "force", "Force along the stroke line at the crosshead: gas, inertia and weight"),
    Quantity("S", "S", "force", "Force in the connecting rod, compression positive"),
    Quantity("N", "N", "force", "Force on the guide, positive on the side where it lies while an engine drives"),
    Quantity("D", "D", "force", "Radial force at the crank pin, positive toward the shaft"),
    Quantity("T", "T", "force", "Tangential force at the crank pin, positive when it drives"),
    Quantity(
        "F_friction", "F_f", "force", "Friction of crosshead and rings along the stroke line, opposing the motion"
    ),
    Quantity("M", "M", "torque", "Torque on the shaft"),
    Quantity("E", "E", "energy", "Excess work stored in the moving masses since angle 0"),
    Quantity("omega", "ω", "angular_velocity", "Angular velocity of the shaft", "omega"),
)
"""Columns over the crank angle, by id."""

KEY_VALUES = _index(
    Quantity("stroke", "s", "length", "Stroke"),
    Quantity("swing", "θ_s", "angle", "Angle through which the member swings", "theta_s"),
    Quantity("phi_idc", "φ_i", "angle", "Crank angle of the inner dead centre", "phi_i"),
    Quantity("phi_odc", "φ_o", "angle", "Crank angle of the outer dead centre", "phi_o"),
    Quantity("phi_work", "φ_w", "angle", "Crank rotation of the working stroke", "phi_w"),
    Quantity("phi_return", "φ_r", "angle", "Crank rotation of the return stroke", "phi_r"),
    Quantity("time_ratio", "t_w/t_r", "ratio", "Time of the outstroke (working stroke) over that of the return stroke"),
    Quantity("v", "v", "velocity", "Crank-pin speed"),
    Quantity("c_m", "c_m", "velocity", "Mean piston speed 2 s n (R 290)"),
    Quantity("c_max", "c_max", "velocity", "Largest velocity toward the shaft"),
    Quantity("c_min", "c_min", "velocity", "Largest velocity away from the shaft, negative"),
    Quantity("c_work_max", "c_a,max", "velocity", "Largest speed of the working stroke (R 304)"),
    Quantity("c_return_max", "c_r,max", "velocity", "Largest speed of the return stroke (R 305)"),
    Quantity("b_max", "b_max", "acceleration", "Largest acceleration"),
    Quantity("b_min", "b_min", "acceleration", "Smallest acceleration: the largest deceleration, negative"),
    Quantity("phi_b_zero", "φ_b=0", "angle", "Crank angles at which the acceleration passes zero", "phi_b=0"),
    Quantity("theta_dot_max", "θ̇_max", "angular_velocity", "Largest angular velocity of the swing", "theta_dot_max"),
    Quantity("theta_dot_min", "θ̇_min", "angular_velocity", "Smallest angular velocity of the swing", "theta_dot_min"),
    Quantity("transmission_min", "μ_min", "angle", "Smallest transmission angle", "mu_min"),
    Quantity("transmission_max", "μ_max", "angle", "Largest transmission angle", "mu_max"),
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
    Quantity("T_max", "T_max", "force", "Largest tangential force"),
    Quantity("T_min", "T_min", "force", "Smallest tangential force"),
    Quantity("M_max", "M_max", "torque", "Largest torque"),
    Quantity("M_min", "M_min", "torque", "Smallest torque"),
    Quantity("work", "A_i", "energy", "Indicated work of all pistons of the rod per cycle"),
    Quantity("work_driving", "A_i+", "energy", "Indicated work of the driving pistons per cycle"),
    Quantity("work_driven", "A_i−", "energy", "Indicated work of the driven pistons per cycle, negative", "A_i-"),
    Quantity("power", "N_i", "power", "Indicated power"),
    Quantity("mean_pressure", "p_i", "pressure", "Mean indicated pressure of the cylinder's own piston"),
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
    Quantity("energy_residual", "ΔA/A", "ratio", "Energy in minus energy out by an independent quadrature", "dA/A"),
    Quantity("M_mean", "M_m", "torque", "Mean torque"),
    Quantity("dE", "ΔE", "energy", "Largest swing of the excess work", "dE"),
    Quantity("delta", "δ", "ratio", "Coefficient of speed fluctuation", "delta"),
    Quantity("J", "J", "inertia", "Moment of inertia of the flywheel"),
    Quantity("GD2", "GD²", "gd2", "Old form of the moment of inertia, 4gJ as a weight times an area", "GD2"),
    Quantity("omega_max", "ω_max", "angular_velocity", "Largest angular velocity", "omega_max"),
    Quantity("omega_min", "ω_min", "angular_velocity", "Smallest angular velocity", "omega_min"),
)
"""Key values, by id."""

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
