"""The quantities of a compressor's rod load (API 618)."""

from functools import partial

from kurbel.declared.quantity import Quantity

_rod = partial(Quantity, commands=("forces",), unless="no_compressor")
_reversal = partial(_rod, wanted_large=True)

ROD_COLUMNS = (
    _rod(
        "P_rod",
        "P_G",
        "force",
        "Rod load at the crosshead pin: gas, inertia and weight of all but the connecting rod, compression positive",
        after="P",
    ),
    _rod("P_piston_rod", "P_KS", "force", "The same at the piston rod, without the crosshead", after="P"),
)

_LOADS = (
    ("rod", "P_rod", "P_G", "rod load at the crosshead pin"),
    ("piston_rod", "P_piston_rod", "P_KS", "load on the piston rod"),
    ("gas", "P_gas", "P_gas", "gas load"),
)

ROD_VALUES = (
    *(
        _rod(f"{id}_{way}_max", f"{symbol},{index}", "force", f"Largest {called} in {way}", asks=(f"{way}_max", column))
        for id, column, symbol, called in _LOADS
        for way, index in (("compression", "d"), ("tension", "z"))
    ),
    _rod(
        "phi_rod_reversal",
        "φ_G=0",
        "angle",
        "Crank angles at which the rod load at the crosshead pin reverses",
        listed=True,
    ),
    _reversal(
        "reversal_angle",
        "Δφ_G",
        "angle",
        "Crank angle per cycle of a reversed rod load: pressed or pulled, whichever is less; a bound is the least",
    ),
    _reversal("reversal_longest", "Δφ_G,1", "angle", "The longest stretch of it; a bound is the least"),
    _reversal(
        "reversal_ratio",
        "P_G,min/max",
        "ratio",
        "Smaller over larger peak of the rod load, pressed and pulled; a bound is the least",
    ),
)
