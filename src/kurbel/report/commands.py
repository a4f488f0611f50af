"""Every command, one row each: help, completion, exit statuses, the whole report, sweeps and the documents read it."""

from typing import NamedTuple

BROKEN, NO_SOLUTION = 1, 3
"""Exit statuses that only some commands return."""


class Command(NamedTuple):
    """A command: its word, its summary in `kurbel --help`, and the statuses that only some commands return.

    title: of its section in the whole report, '' for none; turns: whether its table covers the cycle, else one turn;
    first: ids of the columns, key values and tables that are shown on a terminal with too few lines for all.
    """

    word: str
    summary: str
    statuses: tuple[int, ...] = ()
    title: str = ""
    turns: bool = True
    first: str = ""


_STALLS = (NO_SOLUTION,)
_MOTION = "x c b theta theta_dot stroke swing c_m c_max b_max b_min time_ratio"
_ROWS = (
    Command("table", "Zusammenstellung 112 for any L/R; needs no machine file."),
    Command("motion", "Displacement, velocity, acceleration of any mechanism.", (), "Motion", False, _MOTION),
    Command(
        "forces",
        "Forces, work and friction loss of every cylinder.",
        _STALLS,
        "Forces",
        first="x theta p_head P N T M_out c_m b_max P_max P_min N_max T_max T_min power mean_pressure",
    ),
    Command(
        "flywheel",
        "Turning effort, flywheel and speed line of the machine.",
        _STALLS,
        "Turning effort and flywheel",
        first="T M E omega M_mean power_shaft T_max dE energy_fluctuation J J_needed delta",
    ),
    Command(
        "stress",
        "Bearing forces and stresses of the crankshaft.",
        _STALLS,
        "Strength of the crankshaft",
        first="P_dc safety_pin_min safety_web_A_min safety_web_B_min safety_journal_A_min safety_journal_B_min "
        "A_max B_max p_pin_max p_journal_A_max p_journal_B_max",
    ),
    Command(
        "bearings",
        "Loads on pins and main bearings.",
        _STALLS,
        "Bearings",
        first="load load_max load_mean unloaded_arc pressure_max pressure_velocity",
    ),
    Command(
        "balance",
        "Unbalanced forces and moments, counterweights.",
        _STALLS,
        "Balance of the masses",
        first="F_free_max M_free_max counterweight_best counterweight_best_angle share_best F_free_best "
        "orders best_weights wheels "
        "hammer_blow hammer_train_speed",
    ),
    Command("harmonics", "Orders of the turning effort, gas and inertia apart.", (), "Orders of the turning effort"),
    Command(
        "torsion",
        "Torsional vibration of the shaft line.",
        _STALLS,
        "Torsional vibration",
        first="modes critical_speeds natural_frequency M_vibratory tau_vibratory",
    ),
    Command(
        "delivery",
        "Flow of pumps, capacity of compressors.",
        _STALLS,
        "Delivery",
        first="flow flow_mean volume_fluctuation vessel_volume suction_lift_max volumetric_efficiency capacity "
        "discharge_temperature stage_power isentropic_efficiency",
    ),
    Command("plot", "Pictures, in the terminal or as SVG, PNG, PDF.", _STALLS),
    Command("report", "Everything on one page of HTML; two machines side by side."),
    Command("sweep", "Key values of many designs of a machine."),
    Command("find", "The value of a key that gives a wanted key value.", _STALLS),
    Command("accuracy", "Error against run time; stiff and extreme cases.", (BROKEN, NO_SOLUTION)),
    Command("friction", "Body on an inclined plane; needs no machine file."),
    Command("check", "Read and check a machine file and its limits.", (BROKEN, NO_SOLUTION)),
    Command("example", "List the shipped machines, or print one."),
    Command("keys", "The keys of the machine file, or one of them in full."),
    Command("units", "The units of every kind of quantity."),
    Command("schema", "JSON Schema of the machine file, for editors, or of the answers."),
)
COMMANDS = {one.word: one for one in _ROWS}
"""By its word, in the order in which `kurbel --help` lists them."""
REPORTS = {word: one for word, one in COMMANDS.items() if one.title}
"""Those that report on a machine, in the order of the whole report; `kurbel.report.whole` has their functions."""
