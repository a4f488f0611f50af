"""What `kurbel stress` tells over the crank angle: forces on pin and bearings, and the largest stress of each part."""

from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.solver.cylinder.state import State
from kurbel.solver.shaft.statics import FreeBody
from kurbel.solver.strength.places import PARTS, Place


class StrengthColumns(NamedTuple):
    """Everything that is told over the crank angle; attributes by the ids of the columns, in SI, each (n,).

    D, T: force of the rod on the pin, R 302 and 303; A_D, A_T, B_D, B_T: forces on the bearings in the frame of the
    throw; sigma_ and mises_ with the name of a part: its largest combined stress. A part that is not examined is None.
    """

    phi: Array
    D: Array
    T: Array
    A_D: Array
    A_T: Array
    B_D: Array
    B_T: Array
    sigma_pin: Array
    sigma_web_A: Array
    sigma_web_B: Array | None
    sigma_journal_A: Array | None
    sigma_journal_B: Array | None
    mises_pin: Array
    mises_web_A: Array
    mises_web_B: Array | None
    mises_journal_A: Array | None
    mises_journal_B: Array | None


def strength_columns(state: State, body: FreeBody, looked_at: tuple[Place, ...]) -> StrengthColumns:
    """Return the columns under the forces on the free body at the crank angles (n,) of the state."""
    stresses: dict[str, Any] = {}
    for part in PARTS:
        own = [(place.stresses(body), place.alpha) for place in looked_at if place.part == part]
        stresses[f"sigma_{part}"] = _largest([one.combined(alpha) for one, alpha in own])
        stresses[f"mises_{part}"] = _largest([one.von_mises() for one, _ in own])
    return StrengthColumns(state.phi, state.D, state.T, *body.A, *body.B, **stresses)


def _largest(values: list[Any]) -> Any:
    return np.max(values, axis=0) if values else None
