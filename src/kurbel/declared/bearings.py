"""The quantities of pins and main bearings: their friction, and what `kurbel bearings` tells of each of them."""

from __future__ import annotations

from functools import partial

from kurbel.declared.quantity import Quantity

_forces = partial(Quantity, commands=("forces",))

_RUBBING = (
    ("crank_pin", "Z", "in the crank pin"),
    ("crosshead_pin", "H", "in the crosshead pin"),
    ("journals", "J", "in the journals of the throw"),
)
"""Key of the coefficient, index of the symbols, and where it rubs."""

PIN_LOSSES = (
    *(
        _forces(f"work_{id}", f"A_f,{index}", "energy", f"Work lost {where} per cycle", asks=("work_of", id))
        for id, index, where in _RUBBING
    ),
    *(
        _forces(
            f"loss_{id}",
            f"e_{index}",
            "ratio",
            f"Work lost {where} over that of the driving pistons",
            asks=("loss_of", id),
        )
        for id, index, where in _RUBBING
    ),
)
