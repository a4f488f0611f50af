"""kurbel: crank-drive calculation after the old machine-element books, exact where they approximate.

>>> import kurbel
>>> machine = kurbel.loads('''
... speed: 50 rpm
... stroke: 800 mm
... rod_ratio: 5
... masses: {piston: 830 kg}
... ''')
>>> case = kurbel.solve(machine)
>>> cylinder = case.cylinders[0]
>>> round(cylinder.motion.c_max.value, 4), round(cylinder.motion.c_max.degrees, 4)
(2.1359, 79.1001)
>>> [round(float(force)) for force in cylinder.at([0, 90, 180]).P_inertia]
[-10922, 1858, 7282]

Values are SI floats and arrays; crank angles are in degrees. Names below are imported when they are first used.
"""

__version__ = "0.1.0"

__all__ = [
    "Case",
    "Cylinder",
    "KurbelError",
    "Machine",
    "Mechanism",
    "Piston",
    "SliderCrank",
    "draw",
    "find",
    "load",
    "loads",
    "solve",
    "sweep",
]

TYPE_CHECKING = False  # as in typing, whose import an interrupt could hit before anything guards it
if TYPE_CHECKING:
    import os

    from kurbel.designs.api import find as find
    from kurbel.designs.api import sweep as sweep
    from kurbel.errors import KurbelError as KurbelError
    from kurbel.machine import Cylinder as Cylinder
    from kurbel.machine import Machine as Machine
    from kurbel.machine.parts import Piston as Piston
    from kurbel.machine_file.from_python import load as load
    from kurbel.machine_file.from_python import loads as loads
    from kurbel.mechanisms import Mechanism as Mechanism
    from kurbel.mechanisms.slider_crank import SliderCrank as SliderCrank
    from kurbel.notebook import Case as Case
    from kurbel.notebook import draw as draw

_HOMES = {
    "Case": "kurbel.notebook",
    "Cylinder": "kurbel.machine",
    "KurbelError": "kurbel.errors",
    "Machine": "kurbel.machine",
    "Mechanism": "kurbel.mechanisms",
    "Piston": "kurbel.machine.parts",
    "SliderCrank": "kurbel.mechanisms.slider_crank",
    "draw": "kurbel.notebook",
    "find": "kurbel.designs.api",
    "load": "kurbel.machine_file.from_python",
    "loads": "kurbel.machine_file.from_python",
    "sweep": "kurbel.designs.api",
}
"""Public name -> module; nothing is imported before it is used, so that the command line starts quickly."""


def solve(machine: "Machine | str | os.PathLike[str]") -> "Case":
    """Return the machine with its results, each computed on first use.

    machine: from `load`, `loads`, or built in Python; or what these take, the path or the text of a machine file.
    A result that does not exist raises NoSolutionError on use, as where a crosshead locks itself.
    """
    from kurbel.notebook import Case  # which shows itself there

    return Case(machine)


def __getattr__(name: str) -> object:
    if name not in _HOMES:
        raise AttributeError(f"module 'kurbel' has no attribute '{name}'")
    from importlib import import_module

    return getattr(import_module(_HOMES[name]), name)


def __dir__() -> list[str]:
    return sorted([*__all__, "__version__"])
