"""What `kurbel bearings` reports of pins and main bearings."""

from functools import partial

from kurbel.declared.quantity import Quantity

_bearing = partial(Quantity, commands=("bearings",))

_LOAD_COLUMNS = (
    ("throw", "K", "from its throw outward, of a main bearing from that of crank 1"),
    ("engine", "M", "from the stroke line of cylinder 1 outward"),
    ("rod", "S", "from the line of the rod, crank pin to crosshead"),
)
"""Frame, index of the symbol, and from where directions count in it."""

BEARING_COLUMNS = (
    _bearing("load", "F_L", "force", "Load of a rod on its pin, or of the shaft on a main bearing"),
    *(
        _bearing(f"load_{frame}", f"ε_{index}", "angle", f"Direction of the load {whence}")
        for frame, index, whence in _LOAD_COLUMNS
    ),
)

BEARING_VALUES = (
    _bearing("load_max", "F_L,max", "force", "Largest load"),
    _bearing("load_min", "F_L,min", "force", "Smallest load"),
    _bearing("load_mean", "F_L,m", "force", "Mean load over time"),
    _bearing("load_high", "F_L,m,½", "force", "Mean load while it exceeds half the largest"),
    _bearing("unloaded_arc", "Δε_Z", "angle", "Arc of the pin or journal that is never loaded"),
    _bearing("unloaded_middle", "ε_Z", "angle", "Middle of its widest piece, in the frame of the pin"),
    _bearing("unloaded_arc_shell", "Δε_L", "angle", "Arc of the shell that is never loaded"),
    _bearing("unloaded_middle_shell", "ε_L", "angle", "Middle of its widest piece, in the frame of the shell"),
    _bearing("pressure_max", "p_L,max", "pressure", "Largest pressure, load over d l"),
    _bearing("pressure_mean", "p_L,m", "pressure", "Mean pressure over time"),
    _bearing("rubbing_speed_max", "v_L,max", "velocity", "Largest speed of one surface on the other"),
    _bearing("rubbing_speed_mean", "v_L,m", "velocity", "Mean speed of one surface on the other"),
    _bearing("pressure_velocity", "k_L", "pressure_velocity", "Mean pressure times mean speed, p v"),
    _bearing("work_rubbing", "A_f,L", "energy", "Work lost by its friction per cycle"),
)
