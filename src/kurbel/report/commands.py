"""Every command, one row each: the command line, exit statuses, the whole report, sweeps and the documents read it.

A command on a machine has a function here: its docstring is the help of the command, and what it imports and returns,
the `CommandReport` of a report, is loaded when the command is called. So help and completion need neither numpy nor the
solver.
"""

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from kurbel.solver.case import Case
    from kurbel.tables.frame import CommandReport, Frame, Subject
    from kurbel.tables.tables import Report

BROKEN, NO_SOLUTION = 1, 3
"""Exit statuses that only some commands return."""


class Command(NamedTuple):
    """A command: its word, its summary in `kurbel --help`, and the statuses that only some commands return.

    of: of a command that reports on a machine, the function in this file that has its help and returns its `CommandReport`;
    section: place and title of its section in the whole report; over_angle: whether it has columns over the crank
    angle; options: those of `where` and `uncertainty` that it takes. first: ids of the columns, key values and tables
    that are shown on a terminal with too few lines for all; named: those of its key values that it never
    drops, however few the lines; in_cases: ids of the key values in its table of load cases,
    '' for a command that has none; example: a line of the shell, which its help shows.
    """

    word: str
    summary: str
    of: "Callable[[], CommandReport] | None" = None
    statuses: tuple[int, ...] = ()
    section: tuple[int, str] = (0, "")
    over_angle: bool = True
    options: tuple[str, ...] = ()
    first: str = ""
    named: str = ""
    in_cases: str = ""
    example: str = ""

    @property
    def title(self) -> str:
        """The title of its section in the whole report."""
        return self.section[1]

    @property
    def functions(self) -> "CommandReport":
        """The functions that compute its results."""
        assert self.of, f"kurbel {self.word} does not report on a machine"
        return self.of()


def subjects_of(case: "Case", command: str, pistons: bool = False) -> "list[Subject]":
    """Return what a command has results of: each cylinder or bearing, and the whole machine last.

    pistons: also each piston of a rod that has several. Raises UsageError if the machine has no such results,
    NoSolutionError if it jams, stalls, or vibrates without limit.
    """
    subjects = list(COMMANDS[command].functions.subjects(case))
    if pistons:
        for subject in tuple(subjects):
            subjects += subject.pistons
    return subjects


def report_of(case: "Case", frame: "Frame") -> "Report":
    """Return the report of the command that the frame is of."""
    return COMMANDS[frame.command].functions.report(case, frame)


def _motion() -> "CommandReport":
    """Print the motion of every cylinder's mechanism in FILE over one turn of the crank, and the key values.

    A sliding output has x, c, b, a swinging one theta, theta_dot, theta_ddot. Without a speed in FILE only the
    positions are printed.
    """
    from kurbel.report.forces import MOTION

    return MOTION


def _forces() -> "CommandReport":
    """Print the forces in the crank train over the working cycle, and the key values, for every cylinder of FILE.

    P acts along the stroke line, S in the rod, N on the guide, D and T at the crank pin; forces toward the shaft
    count positive. At a jump of the pressure the table has the value just after it.
    """
    from kurbel.report.forces import FORCES

    return FORCES


def _flywheel() -> "CommandReport":
    """Print turning effort, excess work, flywheel and speed fluctuation of the whole machine.

    Every cylinder counts at the angle of its crank; T is referred to the radius of crank 1, T_b is the share of the
    inertia forces in it. E is the excess of the work over that of the resistance, omega the speed under the load of
    FILE, which may depend on it.
    """
    from kurbel.report.flywheel import FLYWHEEL

    return FLYWHEEL


def _stress() -> "CommandReport":
    """Print the forces on the bearings of each throw of a crankshaft, and the stresses in pin, webs and journals.

    Stresses are listed for each place: in the dead centre under the full piston force, at the largest torque, and at
    the largest stress of the place over the whole cycle; combined after Bach (sigma_res) and after von Mises
    (sigma_v). FILE needs 'crankshaft', one cylinder and a pressure.
    """
    from kurbel.report.stress import STRESS

    return STRESS


def _bearings() -> "CommandReport":
    """Print the loads on crank pins, crosshead pins and main bearings over the cycle.

    The direction of each load is given in the frames of throw, engine and rod; key values are the largest, smallest
    and mean load, pressures, p v, and the arcs of the surfaces that are never loaded. Main bearings need 'crankshaft',
    whose throw is used for every throw of a machine with several. --cylinder takes the name of a pin or bearing.
    """
    from kurbel.report.bearings import BEARINGS

    return BEARINGS


def _balance() -> "CommandReport":
    """Print the unbalanced forces and moments on the frame of FILE, and the counterweights against them.

    F_x is the unbalanced force along the stroke line of cylinder 1, outward from the shaft, F_y that across it, 90
    degrees on in the sense of rotation; M_x and M_y are their moments along the shaft; M_roll rolls the frame about
    it. Each order is a vector that turns with the crank and one that turns against it; an order that cancels is
    exactly 0. The best counterweights replace those of FILE.
    """
    from kurbel.report.balance import BALANCE

    return BALANCE


def _harmonics() -> "CommandReport":
    """Print the orders of the torque of every cylinder, and of the turning effort of the whole machine.

    Orders count periods per turn of the shaft, so that a four-stroke cycle has halves. They are integrated piece by
    piece between the corners of the cards. t is the tangential pressure |M|/(R A). Major orders are those in which all
    cranks pull together.
    """
    from kurbel.report.harmonics import HARMONICS

    return HARMONICS


def _torsion() -> "CommandReport":
    """Print natural frequencies, Holzer's table, and critical speeds of the shaft line.

    Where damping and torques are given, also the steady vibration: torque and stress in every shaft segment at the
    working speed, all orders together, and at the critical speeds that the machine meets, with orders up to 24;
    --columns M_shaft,tau prints them over the crank angle. FILE needs 'shaft', or a 'coupling' behind a 'flywheel'.
    """
    from kurbel.report.torsion import TORSION

    return TORSION


def _delivery() -> "CommandReport":
    """Print what the pumps and compressors of FILE deliver.

    Of pumps the flow over the crank angle, its mean and fluctuation, and the effect of air vessels and pipes; of
    compressors capacity, mass flow and temperature of every end and stage, by their ideal cards.
    """
    from kurbel.report.delivery import DELIVERY

    return DELIVERY


_STALLS = (NO_SOLUTION,)
_ROWS = (
    Command(
        "table",
        "Zusammenstellung 112 for any L/R; needs no machine file.",
        example="kurbel table --ratio 5",
    ),
    Command(
        "motion",
        "Displacement, velocity, acceleration of any mechanism.",
        _motion,
        section=(9, "Motion"),
        first="x c b theta theta_dot stroke swing c_m c_max b_max b_min time_ratio",
        example="kurbel motion engine.yaml --columns x,c,b --step 15",
    ),
    Command(
        "forces",
        "Forces, work and friction loss of every cylinder.",
        _forces,
        _STALLS,
        section=(3, "Forces"),
        options=("uncertainty",),
        first="x theta P N T M_out b_max c_max theta_ddot_max theta_dot_max power mean_pressure "
        "P_max P_min N_max N_min T_max T_min friction_work friction_power friction_loss friction_force_mean "
        "power_indicated power_friction mechanical_efficiency",
        named="b_max c_max theta_ddot_max theta_dot_max friction_work friction_power friction_loss power_friction",
        in_cases="p_max P_max P_min T_max rod_compression_max rod_tension_max reversal_angle reversal_ratio work power",
        example="kurbel forces engine.yaml --columns P,N,T -o forces.csv",
    ),
    Command(
        "flywheel",
        "Turning effort, flywheel and speed line of the machine.",
        _flywheel,
        _STALLS,
        section=(1, "Turning effort and flywheel"),
        options=("where", "uncertainty"),
        first="T M E omega M_mean power_shaft T_max dE energy_fluctuation J J_needed delta",
        example="kurbel flywheel engine.yaml --key-values dE J delta",
    ),
    Command(
        "stress",
        "Bearing forces and stresses of the crankshaft.",
        _stress,
        _STALLS,
        section=(5, "Strength of the crankshaft"),
        options=("uncertainty",),
        first="P_dc safety_pin_min safety_web_A_min safety_web_B_min safety_journal_A_min safety_journal_B_min "
        "A_max B_max p_pin_max p_journal_A_max p_journal_B_max",
        example="kurbel stress engine.yaml --places",
    ),
    Command(
        "bearings",
        "Loads on pins and main bearings.",
        _bearings,
        _STALLS,
        section=(4, "Bearings"),
        first="load load_max load_mean unloaded_arc pressure_max pressure_velocity",
        in_cases="load_max load_mean pressure_max pressure_velocity unloaded_arc",
        example="kurbel bearings engine.yaml --cylinder 'crank pin'",
    ),
    Command(
        "balance",
        "Unbalanced forces and moments, counterweights.",
        _balance,
        _STALLS,
        section=(6, "Balance of the masses"),
        first="F_free_max M_free_max counterweight_best counterweight_best_angle share_best F_free_best "
        "orders best_weights wheels "
        "hammer_blow hammer_train_speed",
        example="kurbel balance engine.yaml --orders",
    ),
    Command(
        "harmonics",
        "Orders of the turning effort, gas and inertia apart.",
        _harmonics,
        section=(8, "Orders of the turning effort"),
        over_angle=False,
        example="kurbel harmonics engine.yaml --orders 0.5:6:0.5",
    ),
    Command(
        "torsion",
        "Torsional vibration of the shaft line.",
        _torsion,
        _STALLS,
        section=(7, "Torsional vibration"),
        first="modes critical_speeds natural_frequency M_vibratory tau_vibratory",
        in_cases="natural_frequency M_vibratory tau_vibratory vibration_loss",
        example="kurbel torsion engine.yaml --speeds '300:900:10 rpm'",
    ),
    Command(
        "delivery",
        "Flow of pumps, capacity of compressors.",
        _delivery,
        _STALLS,
        section=(2, "Delivery"),
        first="flow flow_mean volume_fluctuation vessel_volume suction_lift_max npsh_available volumetric_efficiency "
        "capacity "
        "discharge_temperature stage_power isentropic_efficiency",
        in_cases="volumetric_efficiency capacity mass_flow discharge_temperature stage_power isentropic_efficiency "
        "flow_mean flow_max volume_fluctuation vessel_volume vessel_swing suction_lift_max npsh_available",
        example="kurbel delivery pump.yaml --key-values",
    ),
    Command(
        "plot",
        "Pictures, in the terminal or as SVG, PNG, PDF.",
        statuses=_STALLS,
        example="kurbel plot engine.yaml effort -o effort.svg",
    ),
    Command(
        "report",
        "Everything on one page of HTML; two machines side by side.",
        example="kurbel report engine.yaml -o report.html",
    ),
    Command(
        "sweep",
        "Key values of many designs of a machine.",
        example="kurbel sweep engine.yaml --vary rod_ratio=3:6:0.5 --columns T_max",
    ),
    Command(
        "find",
        "The value of a key that gives a wanted key value.",
        statuses=_STALLS,
        example="kurbel find engine.yaml 'power = 100 kW' --vary 'bore=300:500 mm'",
    ),
    Command(
        "accuracy",
        "Error against run time; stiff and extreme cases.",
        statuses=(BROKEN, NO_SOLUTION),
        example="kurbel accuracy engine.yaml",
    ),
    Command(
        "friction",
        "Body on an inclined plane; needs no machine file.",
        example="kurbel friction --incline 10 --coefficient 0.1",
    ),
    Command(
        "check",
        "Read and check a machine file and its limits.",
        statuses=(BROKEN, NO_SOLUTION),
        example="kurbel check engine.yaml --set limits.c_max='3 m/s'",
    ),
    Command(
        "example",
        "List the shipped machines, or print one.",
        statuses=(BROKEN,),
        example="kurbel example waterworks > engine.yaml",
    ),
    Command(
        "keys",
        "The keys of the machine file, or one of them in full.",
        example="kurbel keys flywheel",
    ),
    Command(
        "units",
        "The units of every kind of quantity.",
        example="kurbel units pressure",
    ),
    Command(
        "schema",
        "JSON Schema of the machine file, or of the JSON output.",
        example="kurbel schema > kurbel.schema.json",
    ),
    Command(
        "skill",
        "What to know before first use, on one page.",
        example="kurbel skill > SKILL.md",
    ),
)
COMMANDS = {row.word: row for row in _ROWS}
"""By its word, in the order in which `kurbel --help` lists them."""
REPORTS = sorted((row for row in _ROWS if row.of), key=lambda row: row.section)
"""Those that report on a machine, in the order of the whole report."""
