"""The key values and columns of the strength of a throw, and of a crankshaft."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from functools import cached_property

import numpy as np

from kurbel.arrays import Array, Number
from kurbel.quantity import Heading, ValuesById, value, values_for
from kurbel.solver.chapters.stress_places import PARTS, Place
from kurbel.solver.figures import AtAngles, Results
from kurbel.solver.shaft import FreeBody
from kurbel.solver.state import State

_BEARINGS = {part: PARTS[part] for part in ("pin", "journal_A", "journal_B")}
"""Parts that are pressed: by the rod, and by bearings A and B."""


class StressColumns(AtAngles):
    """Forces and stresses of one throw at crank angles φ (n,) in degrees; states: of its cylinders there.

    torques: whether the torques in its journals are columns, as where there are several throws.
    """

    commands = ("stress",)
    D = value("D", "force", "Radial force at the crank pin, positive toward the shaft")
    T = value("T", "force", "Tangential force M/R: the torque on the shaft over the crank radius")
    T_pin = value(
        "T_Z",
        "force",
        "Tangential force of the rod on the crank pin, where its friction makes it another",
    )
    A_D = value("A_D", "force", "Force on bearing A along D, in the frame rotating with the throw")
    A_T = value("A_T", "force", "Force on bearing A along T")
    B_D = value("B_D", "force", "Force on bearing B, next to the flywheel, along D")
    B_T = value("B_T", "force", "Force on bearing B along T")
    M_A = value("M_A", "torque", "Torque in journal A, that of the throws before this one")
    M_B = value("M_B", "torque", "Torque in journal B, that of the throws up to this one")
    sigma = values_for(PARTS, "sigma_*", "σ_*", "stress", "Largest combined stress of * (Bach)")
    mises = values_for(
        PARTS, "mises_*", "σ_v,*", "stress", "Largest equivalent stress of * (von Mises)"
    )

    def __init__(
        self,
        phi: Array,
        states: Sequence[State],
        body: FreeBody,
        at: Sequence[Place],
        torques: bool,
    ) -> None:
        self.phi, self._states, self._body, self._places, self._torques = (
            phi,
            states,
            body,
            at,
            torques,
        )

    @cached_property
    def answers(self) -> ValuesById:
        """The columns by id; of the stresses those of the parts that are examined."""
        body = self._body
        loaded = [state for state in self._states if state.drive.has_force]
        nothing = np.zeros(len(self.phi))
        columns: ValuesById = {
            "D": sum(state.D for state in loaded) + nothing,
            "T": sum(state.T for state in loaded) + nothing,
            "A_D": body.A.real,
            "A_T": body.A.imag,
            "B_D": body.B.real,
            "B_T": body.B.imag,
        }
        if any(state.T_pin is not None for state in loaded):
            columns["T_pin"] = sum(state.tangential_at_pin for state in loaded) + nothing
        if self._torques:
            columns["M_A"] = nothing if body.torque_A is None else body.torque_A
            columns["M_B"] = body.torque_B
        for place in self._places:
            # of a part the largest stress of its places
            bach, mises = f"sigma_{place.part}", f"mises_{place.part}"
            columns[bach] = np.maximum(columns.get(bach, 0.0), place.combined)
            columns[mises] = np.maximum(columns.get(mises, 0.0), place.von_mises)
        return columns


class Strength(Results, ABC):
    """Statics and stresses of a throw, or of all throws of a machine; of many machines values are (machines,)."""

    command = "stress"
    state = StressColumns

    _loads = Heading("Loads")
    P_dc = value("P_dc", "force", "Full piston force, without inertia, applied at the dead centre")
    C_rod = value(
        "C_r",
        "force",
        "Centrifugal force of the rotating part of the connecting rod, not included in D",
    )
    _stresses = Heading("Stresses")
    sigma_dc = values_for(
        PARTS,
        "sigma_*_dc",
        "σ_*,dc",
        "stress",
        "Combined stress of * in the dead centre under full force (Bach)",
        group=str,
    )
    sigma_max = values_for(
        PARTS,
        "sigma_*_max",
        "σ_*,max",
        "stress",
        "Largest combined stress of * over the cycle (Bach)",
        group=str,
    )
    mises_max = values_for(
        PARTS,
        "mises_*_max",
        "σ_v,*,max",
        "stress",
        "Largest equivalent stress of * over the cycle (von Mises)",
        group=str,
    )
    safety = values_for(
        PARTS,
        "safety_*_min",
        "S_*",
        "ratio",
        "Smallest safety of *: k_b over its combined stress, dead centre and cycle",
        group=str,
    )
    _bearings = Heading("Bearings")
    A_max = value("A_max", "force", "Largest force on bearing A")
    B_max = value("B_max", "force", "Largest force on bearing B, next to the flywheel")
    p_pin_dc = value("p_pin,dc", "pressure", "Pressure on the crank pin under full force, P/(d l)")
    pressure_max = values_for(
        _BEARINGS,
        "p_*_max",
        "p_*,max",
        "pressure",
        "Largest pressure on * over the cycle, force over d l",
        group=str,
    )
    pressure_mean = values_for(
        _BEARINGS,
        "p_*_mean",
        "p_*,m",
        "pressure",
        "Mean pressure on * over the time of a cycle",
        after="p_*_max",
        group=str,
    )
    pressure_velocity = values_for(
        _BEARINGS,
        "k_*",
        "k_*",
        "pressure_velocity",
        "Mean pressure times surface speed, p_m v, of *",
        after="p_*_mean",
        group=str,
    )
    _checks = Heading("Checks")
    equilibrium_residual = value(
        "ΣF, ΣM",
        "ratio",
        "Residual of the equilibrium of forces and moments on the crankshaft",
        lambda strength: strength.unbalanced(),
        plain="sum F, M",
        residual=True,
    )

    count: int | None

    @property
    @abstractmethod
    def answers(self) -> ValuesById:
        """The key values by id."""

    @abstractmethod
    def unbalanced(self) -> Number:
        """Return what is left of the sums of forces and moments, over the sizes of their terms, at its worst."""
