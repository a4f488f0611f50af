"""The machines of `kurbel accuracy` where no file is given, and what they are there for."""

from collections.abc import Callable
from typing import NamedTuple

from kurbel.machine import Machine


class Scene(NamedTuple):
    """A machine, and the crank angles in degrees at which its motion is compared.

    quick: whether it also belongs to the quick run; moving: whether its motion is compared, which an earlier scene may
    have done already.
    """

    machine: Machine
    turns: int = 0
    quick: bool = False
    moving: bool = True

    @property
    def angles(self) -> tuple[float, ...]:
        """361 angles of one turn, so many turns after the first."""
        return tuple(360.0 * self.turns + degree for degree in range(361))


STEAM = (
    "{unit: at, expansion: [[0, 9.5], [0.35, 9.5], [0.5, 6.7], [0.7, 4.7], [0.95, 3.3], [1, 2.2]], "
    "compression: [[1, 1.2], [0.25, 1.2], [0.1, 2.4], [0.02, 6.5], [0, 9.5]]}"
)
"""The card of a steam engine."""


def _plain(name: str, rod: str = "2000 mm", more: str = "") -> str:
    return f'{{name: "{name}", speed: 50 rpm, crank: 400 mm, rod: {rod}{more}}}'


def _steam(name: str, more: str, rod: str = "2000 mm") -> str:
    return _plain(name, rod, f", bore: 450 mm, indicator: {{head_end: {STEAM}, crank_end: mirrored}}, {more}")


_PISTON, _RUBS, _FAN = "masses: {piston: 200 kg}", "friction: {crosshead: 0.06}", "load: {power_law: 2}"
_GAS_ENGINE = """
name: Gas engine, offset
speed: 160 rpm
cycle: four-stroke
stroke: 600 mm
rod: 1400 mm
offset: 20 mm
bore: 400 mm
indicator:
  pressures: absolute
  head_end:
    unit: bar
    interpolate: polytropic
    clearance: 0.2
    intake: [[0, 0.95], [1, 0.95]]
    compression: [[1, 0.95], [0, 9.8]]
    expansion: [[0, 26], [0.03, 25], [1, 2.6]]
    exhaust: [[1, 1.1], [0, 1.1]]
masses: {piston: 240 kg, connecting_rod: 180 kg}
inclination: 90 deg
friction: {crosshead: 0.05, rings: {count: 5, height: 12 mm, pressure: 0.4 bar, coefficient: 0.1}}
flywheel: {inertia: 4000 kg m2}
load: {slip: 0.02}
"""

Loads = Callable[[str], Machine]
"""Reads the text of a machine file: only the command line knows how."""


def built_in(quick: bool, loads: Loads) -> list[Scene]:
    """Return the built-in scenes, of the quick run those that belong to it."""
    engine = f"{_PISTON}, inclination: 0 deg, {_RUBS}, flywheel: {{inertia: 900 kg m2}}, {_FAN}"
    stiff = f"{_PISTON}, flywheel: {{inertia: 20 kg m2}}, load: {{slip: 1e-6}}"
    heavy = f"flywheel: {{inertia: 6e7 kg m2}}, {_FAN}"
    scenes = [
        Scene(loads(_steam("Steam engine", engine)), quick=True),
        Scene(loads(_GAS_ENGINE)),
        Scene(loads(_steam("Short rod, L/R = 1.01", f"{_PISTON}, {_RUBS}", "404 mm"))),
        Scene(loads(_plain("Long rod, L/R = 1e6", "400 km")), quick=True),
        Scene(loads(_plain("Millionth turn")), turns=10**6),
        Scene(loads(_steam("Stiff: on the grid, slip 1e-6", stiff)), quick=True, moving=False),
        Scene(loads(_steam("Slow: heavy flywheel and a fan", heavy)), moving=False),
    ]
    return [scene for scene in scenes if scene.quick or not quick]
