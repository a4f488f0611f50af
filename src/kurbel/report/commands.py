"""Every command, one row each: help, completion, exit statuses, the whole report, sweeps and the documents read it."""

from typing import NamedTuple

BROKEN, NO_SOLUTION = 1, 3
"""Exit statuses that only some commands return."""


class Command(NamedTuple):
    """A command: its word, what `kurbel --help` says of it, and the statuses that only some commands return.

    title: of its section in the whole report, '' for none; turns: whether its table runs over the cycle, else over one
    turn.
    """

    word: str
    summary: str
    statuses: tuple[int, ...] = ()
    title: str = ""
    turns: bool = True


_STALLS = (NO_SOLUTION,)
_ROWS = (
    Command("table", "Zusammenstellung 112 for any L/R; needs no machine file."),
    Command("motion", "Displacement, velocity, acceleration of any mechanism.", (), "Motion", False),
    Command("forces", "Forces, work and friction loss of every cylinder.", _STALLS, "Forces"),
    Command(
        "flywheel", "Turning effort, flywheel and speed line of the machine.", _STALLS, "Turning effort and flywheel"
    ),
    Command("stress", "Bearing forces and stresses of the crankshaft.", _STALLS, "Strength of the crankshaft"),
    Command("bearings", "Loads on pins and main bearings.", _STALLS, "Bearings"),
    Command("balance", "Free forces and moments, counterweights.", _STALLS, "Balance of the masses"),
    Command("harmonics", "Orders of the turning effort, gas and inertia apart.", (), "Orders of the turning effort"),
    Command("torsion", "Torsional vibration of the shaft line.", _STALLS, "Torsional vibration"),
    Command("delivery", "Flow of pumps, capacity of compressors.", _STALLS, "Delivery"),
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
