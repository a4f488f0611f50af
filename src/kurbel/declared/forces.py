"""Quantities of `kurbel forces` that few machines have: of an indicator diagram, and of a rod load (API 618).

Of the diagram, beside its work: volumes, rise of pressure, spread of cycles, the brake.
"""

from functools import partial

from kurbel.declared.quantity import Quantity

_chamber = partial(Quantity, commands=("forces",), on_request=("forces",))
_forces = partial(Quantity, commands=("forces",))
_brake = partial(Quantity, commands=("forces", "flywheel"))
_rod = partial(Quantity, commands=("forces",), unless="no_compressor")
_reversal = partial(_rod, wanted_large=True)

INDICATED_COLUMNS = (
    _chamber("V", "V", "volume", "Volume of the head-end chamber, with its clearance where that is given"),
    _chamber("V_crank", "V_C", "volume", "Volume of the crank-end chamber, with its clearance where that is given"),
    _chamber("dV", "dV/dφ", "volume_rise", "Change of the volume of the head-end chamber over the angle"),
    _chamber("dp_head", "dp_H/dφ", "pressure_rise", "Rise of the head-end pressure, over 1 deg"),
    _chamber("dp_crank", "dp_C/dφ", "pressure_rise", "Rise of the crank-end pressure, over 1 deg"),
)
INDICATED_VALUES = (
    _forces("mean_pressure_gross", "p_i,g", "pressure", "Share of p_i of compression and expansion"),
    _forces("mean_pressure_exchange", "p_i,w", "pressure", "Share of p_i of exhaust and intake: the pumping loop"),
    _forces("V_clearance", "V_c", "volume", "Clearance of the head-end chamber"),
    _forces("n_compression", "n_c", "ratio", "Exponent of p V^n over the compression, 90 to 40 deg before its end"),
    _forces("n_expansion", "n_d", "ratio", "Exponent of p V^n over the expansion, 60 to 100 deg after its start"),
    _forces("p_rise_max", "dp/dφ_max", "pressure_rise", "Largest rise of pressure over 1 deg of angle"),
    _forces("cycles_measured", "Z", "ratio", "Number of measured cycles, of whose mean the forces are"),
    _forces("mean_pressure_std", "s_p_i", "pressure", "Standard deviation of p_i over the cycles"),
    _forces("mean_pressure_cov", "COV", "ratio", "Coefficient of variation of p_i: standard deviation over mean"),
    _forces("p_max_mean", "p_max,m", "pressure", "Mean of the largest gauge pressures of the cycles", gauge=True),
    _forces("p_max_std", "s_p_max", "pressure", "Standard deviation of the largest pressures of the cycles"),
    _forces("p_max_most", "p_max,Z", "pressure", "Largest gauge pressure of any cycle", gauge=True),
    _forces("cycle_worst", "Z_min", "ratio", "Number of the cycle with the smallest p_i, counted from 1"),
    _brake("mean_pressure_brake", "p_e", "pressure", "Mean effective pressure: brake work over the swept volume"),
    _brake("mean_pressure_friction", "p_r", "pressure", "Friction mean pressure, p_i less p_e"),
    _brake("eta_m", "η_m", "ratio", "Mechanical efficiency: brake power over indicated power"),
)
CYCLE_VALUES = (
    Quantity("mean_pressure", "p_i", "pressure", "Mean indicated pressure of the cycle"),
    Quantity("p_max", "p_max", "pressure", "Largest gauge pressure of the cycle", gauge=True),
    Quantity("phi_p_max", "φ_p,max", "angle", "Crank angle of the largest pressure"),
    Quantity("p_rise_max", "dp/dφ_max", "pressure_rise", "Largest rise of pressure over 1 deg"),
)
"""Columns of the table of all measured cycles."""

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
