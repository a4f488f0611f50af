"""Every quantity that kurbel prints, declared once: reports, CSV heads, JSON, limits and docs read it here."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial

from kurbel.declared.balance import BALANCE_COLUMNS, BALANCE_VALUES
from kurbel.declared.bearings import BEARING_COLUMNS, BEARING_VALUES, PIN_LOSSES
from kurbel.declared.factors import PHI
from kurbel.declared.flywheel import EFFORT_VALUES, FLYWHEEL_COLUMNS, FLYWHEEL_VALUES
from kurbel.declared.forces import INDICATED_COLUMNS, INDICATED_VALUES, ROD_COLUMNS, ROD_VALUES
from kurbel.declared.quantity import Quantity, by_id, extremes, placed
from kurbel.declared.shaft import STRENGTH_COLUMNS, STRENGTH_VALUES
from kurbel.declared.torsion import HARMONIC_VALUES, TORSION_COLUMNS, TORSION_VALUES

_FORCES, _FLYWHEEL, _STRESS = ("forces",), ("flywheel",), ("stress",)
_motion = partial(Quantity, commands=("motion", "forces"))
_forces = partial(Quantity, commands=_FORCES)
_searched = partial(Quantity, commands=_FORCES, extremes=_FORCES)
_turning = partial(Quantity, commands=(*_FORCES, *_FLYWHEEL))
_strokes, _both_ways = partial(_motion, unless="equal_strokes"), partial(_forces, unless="works_one_way")
_guide, _inertia = partial(_forces, after="T_peak"), partial(_forces, after="P_start_min")


_COLUMNS = (
    PHI,
    _motion(
        "z",
        "z",
        "ratio",
        "Fraction of the stroke, or of the swing, from the inner dead centre",
        on_request=("motion", "forces"),
    ),
    _motion("psi", "ψ", "angle", "Angle between connecting rod and stroke line"),
    _motion(
        "x",
        "x",
        "length",
        "Displacement from the inner dead centre toward the shaft; of a quick-return ram, from mid-stroke",
    ),
    _motion("c", "c", "velocity", "Velocity, positive toward the shaft; of a quick-return ram, on the working stroke"),
    _motion("b", "b", "acceleration", "Acceleration, positive as the velocity"),
    *(
        Quantity(id, symbol, kind, text, commands=("motion", "forces"), on_request=_FORCES)
        for id, symbol, kind, text in (
            ("x_point", "x_Q", "length", "Place of the point of the rod from the shaft axis, along φ = 0"),
            ("y_point", "y_Q", "length", "Place of the point of the rod from the shaft axis, along φ = 90°"),
            ("v_point", "v_Q", "velocity", "Speed of the point of the rod"),
            ("b_point", "b_Q", "acceleration", "Magnitude of the acceleration of the point of the rod"),
        )
    ),
    _forces("p_head", "p_H", "pressure", "Gauge pressure in the head-end chamber, just after a jump", gauge=True),
    _forces("p_crank", "p_C", "pressure", "Gauge pressure in the crank-end chamber, just after a jump", gauge=True),
    *INDICATED_COLUMNS,
    _forces("P_gas", "P_gas", "force", "Force of gas, steam or water on all pistons of the rod"),
    _forces("P_gas_book", "P_297", "force", "The same by the mean of both areas (R 297)", on_request=_FORCES),
    _forces("P_inertia", "P_b", "force", "Inertia force −m b of the reciprocating masses"),
    _forces("P_weight", "P_w", "force", "Weight of the reciprocating masses along the stroke line"),
    _forces("P_ram", "P_r", "force", "Force on a ram against its motion"),
    _searched(
        "P",
        "P",
        "force",
        "Force along the stroke line: gas, inertia, weight, and what a ram works against",
        called="piston force",
        peak=True,
    ),
    Quantity(
        "P_start",
        "P_0",
        "force",
        "Force along the stroke line without inertia",
        extremes=_FORCES,
        called="piston force without inertia: starting and slow running",
    ),
    _searched(
        "S",
        "S",
        "force",
        "Force in the connecting rod, compression positive; of an exact rod, between the masses at its ends",
        called="rod force",
        peak=True,
    ),
    _searched(
        "S_crosshead",
        "S_H",
        "force",
        "Force along an exact rod at the crosshead pin, compression positive",
        called="force along the rod at the crosshead pin",
    ),
    _searched(
        "S_crank",
        "S_Z",
        "force",
        "Force along an exact rod at the crank pin, compression positive",
        called="force along the rod at the crank pin",
    ),
    _searched(
        "N",
        "N",
        "force",
        "Force on the guide (yoke frame: on the piston rod), positive on the side where it lies while an engine drives",
        called="guide force",
        peak=True,
    ),
    _forces("p_guide", "p_g", "pressure", "Mean pressure of the crosshead's shoe on its guide, |N| over its area"),
    _forces("wear", "f N c", "power", "Work of friction on the guide over time, by which it wears (Redtenbacher)"),
    Quantity(
        "D", "D", "force", "Radial force at the crank pin, positive toward the shaft", commands=(*_FORCES, *_STRESS)
    ),
    _forces("M_out", "M_2", "torque", "Moment on what swings, or on the second crank, against its motion"),
    Quantity(
        "T",
        "T",
        "force",
        "Tangential force at the crank pin, positive when it drives",
        extremes=(*_FORCES, *_FLYWHEEL),
        called="tangential force",
        peak=True,
        commands=(*_FORCES, *_FLYWHEEL, *_STRESS),
    ),
    _forces("F_friction", "F_f", "force", "Friction along the stroke line, opposing the motion"),
    *FLYWHEEL_COLUMNS,
    *ROD_COLUMNS,
    *STRENGTH_COLUMNS,
    *BEARING_COLUMNS,
    *BALANCE_COLUMNS,
    *TORSION_COLUMNS,
)


_MOTION_VALUES = (
    _motion("stroke", "s", "length", "Stroke"),
    _motion("phi_idc", "φ_i", "angle", "Crank angle of the inner dead centre"),
    _motion("phi_odc", "φ_o", "angle", "Crank angle of the outer dead centre"),
    _strokes("phi_work", "φ_w", "angle", "Crank rotation of the outstroke (working stroke)"),
    _strokes("phi_return", "φ_r", "angle", "Crank rotation of the return stroke"),
    _strokes("time_ratio", "t_w/t_r", "ratio", "Time of the outstroke (working stroke) over that of the return stroke"),
    _motion("v", "v", "velocity", "Crank-pin speed"),
    _motion("c_m", "c_m", "velocity", "Mean piston speed 2 s n (R 290)"),
    _strokes("c_work_m", "c_a,m", "velocity", "Mean speed of the outstroke (of work, R p. 615)"),
    _strokes("c_return_m", "c_r,m", "velocity", "Mean speed of the return stroke (R p. 615)"),
    _motion("c_max", "c_max", "velocity", "Largest velocity on the outstroke"),
    _motion("c_min", "c_min", "velocity", "Largest velocity on the return stroke, negative", unless="has_no_c_min"),
    _motion("c_work_max", "c_a,max", "velocity", "Largest speed of the working stroke (R 304)"),
    _motion("c_return_max", "c_r,max", "velocity", "Largest speed of the return stroke (R 305)"),
    _motion("b_max", "b_max", "acceleration", "Largest acceleration"),
    _motion("b_min", "b_min", "acceleration", "Smallest acceleration: the largest deceleration, negative"),
    _motion("phi_b_zero", "φ_b=0", "angle", "Crank angles at which the acceleration passes zero", listed=True),
)
_CYLINDER_VALUES = (
    _forces("A_head", "A_H", "area", "Piston area at the head end"),
    _forces("A_crank", "A_C", "area", "Piston area at the crank end"),
    _forces("p_max", "p_max", "pressure", "Largest gauge pressure in the cylinder's own piston", gauge=True),
    _guide("p_guide_max", "p_g,max", "pressure", "Largest pressure of the crosshead's shoe on its guide"),
    _guide("p_guide_mean", "p_g,m", "pressure", "Mean over the way of the shoe's pressure on its guide"),
    _guide("wear_max", "f N c_max", "power", "Largest value of the wear line of the guide"),
    _guide("wear_mean", "f N c_m", "power", "Mean of the wear line: power lost on the guide"),
    _forces("m", "m", "mass", "Reciprocating mass with its share of the connecting rod"),
    _inertia("P_inertia_max", "P_b,max", "force", "Largest inertia force toward the shaft"),
    _inertia("P_inertia_min", "P_b,min", "force", "Largest inertia force away from the shaft, negative"),
)
_WORK_VALUES = (
    _forces(
        "phi_reversal", "φ_P=0", "angle", "Druckwechsel: crank angles at which the piston force turns over", listed=True
    ),
    _forces("work", "A_i", "energy", "Indicated work of all pistons of the rod per cycle"),
    _both_ways("work_driving", "A_i+", "energy", "Indicated work of the driving pistons per cycle"),
    _both_ways("work_driven", "A_i−", "energy", "Indicated work of the driven pistons per cycle, negative"),
    _forces("resistance_work", "A_r", "energy", "Work per cycle of what the ram or rocker works against, negative"),
    _forces("power", "N_i", "power", "Indicated power"),
    _forces("mean_pressure", "p_i", "pressure", "Mean indicated pressure of the cylinder's own piston"),
    *INDICATED_VALUES,
    _forces(
        "work_sensitivity",
        "dA_i/A_i",
        "ratio",
        "Change of the indicated work of the traces, over that work, if they are put 0.1 deg later",
    ),
    _turning("W", "W", "force", "Mean tangential force over the cycle: the resistance"),
    _forces("friction_work", "A_f", "energy", "Work lost by friction per cycle"),
    _forces("loss_crosshead", "e_K", "ratio", "Work lost at the crosshead over that of the driving pistons"),
    _forces(
        "loss_crosshead_redtenbacher",
        "½ λ f",
        "ratio",
        "Redtenbacher's mean over the rod angle of the same loss (D 7)",
        "lam f/2",
    ),
    _forces("loss_rings", "e_R", "ratio", "Work lost at the piston rings over that of the driving pistons"),
    *PIN_LOSSES,
    _forces(
        "energy_residual", "ΔA/A", "ratio", "Energy in minus energy out by an independent quadrature", residual=True
    ),
    _forces("residual", "r_F", "ratio", "What Newton's law leaves open of the forces, over the largest", residual=True),
    *EFFORT_VALUES,
)


@dataclass(frozen=True, eq=False)
class Lists:
    """The columns and the key values that there can be, each in the order in which they are printed."""

    all_columns: tuple[Quantity, ...]
    all_key_values: tuple[Quantity, ...]

    @classmethod
    def of(cls, columns: Iterable[Quantity] = (), key_values: Iterable[Quantity] = ()) -> "Lists":
        """Return what every machine may have, and these quantities, which a mechanism adds."""
        found = placed((*_COLUMNS, *columns))
        common = (
            *_MOTION_VALUES,
            *extremes(found, "motion", "forces"),
            *_CYLINDER_VALUES,
            *extremes(found, "forces"),
            *_WORK_VALUES,
            *ROD_VALUES,
            *extremes(found, "flywheel"),
            *FLYWHEEL_VALUES,
            *STRENGTH_VALUES,
            *BEARING_VALUES,
            *BALANCE_VALUES,
            *HARMONIC_VALUES,
            *TORSION_VALUES,
        )
        return cls(found, placed((*common, *key_values)))

    @property
    def absolute(self) -> "Lists":
        """The same for a machine whose pressures are absolute."""
        return self._changed(Quantity.absolute)

    @property
    def of_ram(self) -> "Lists":
        """The same for a machine that drives a ram and has no piston."""
        return self._changed(Quantity.of_ram)

    def _changed(self, change: Callable[[Quantity], Quantity]) -> "Lists":
        return Lists(tuple(map(change, self.all_columns)), tuple(map(change, self.all_key_values)))

    def columns(self, command: str) -> dict[str, Quantity]:
        """Return the columns of a command, by id."""
        return by_id(*(one for one in self.all_columns if command in one.commands))

    def key_values(self, command: str) -> dict[str, Quantity]:
        """Return the key values of a command, by id."""
        return by_id(*(one for one in self.all_key_values if command in one.commands))

    def commands_of(self, id: str) -> tuple[str, ...]:
        """Return the commands that have a key value, the one whose own it is first."""
        return tuple(dict.fromkeys(word for one in self.all_key_values if one.id == id for word in one.commands))


COMMON = Lists.of()
"""What every machine may have; a mechanism adds its own (`kurbel.mechanisms.kinds.every_quantity`)."""
COLUMNS = by_id(*(one for one in COMMON.all_columns if one.commands))
