"""Machines with what `random_files` lacks: engines as they are built, all their parts together, and hard cases."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from indicated import Engine, columns_file, cycles
from random_files import CRANKSHAFT, Keys, Random, maybe, number

CRANK = 0.3
EXACT_ROD: Keys = {"mass": "90 kg", "center_of_gravity": "250 mm", "inertia": "22 kg m2"}
PIN: Keys = {"crosshead_pin": 0.05, "crosshead_pin_diameter": "90 mm", "crosshead_pin_length": "120 mm"}


def write_traces(folder: Path) -> None:
    """Write the measured files of `traced`: five cycles, fired and motored."""
    engine = Engine()
    for name, heat in (("cycles.csv", engine.heat), ("motored.csv", 0.0)):
        angles, pressures = cycles(engine._replace(heat=heat), 5, 1.0, noise=0.01, spread=0.03)
        columns_file(folder / name, np.column_stack([angles, pressures.T]))


def engine(random: Random, rod_ratio: float, head_end: Keys, **more: object) -> Keys:
    """Return a slider-crank of 600 mm stroke with an exact rod."""
    keys: Keys = {"speed": f"{number(random, 60, 300)} rpm", "crank": f"{CRANK} m", "rod_ratio": rod_ratio}
    keys |= {"bore": "400 mm", "indicator": {"pressures": "absolute", "head_end": head_end}}
    keys |= {"masses": {"piston": f"{number(random, 50, 200)} kg", "connecting_rod": EXACT_ROD, "rotating": "60 kg"}}
    return keys | maybe(random, 0.5, {"inclination": f"{number(random, 0, 90)} deg"}) | more


def steam(random: Random) -> Keys:
    """Return an ideal card of steam with every key."""
    pressures = {"admission": f"{number(random, 5, 15)} bar", "exhaust": f"{number(random, 0.1, 1.5)} bar"}
    times = {"cut_off": number(random, 0.1, 0.8), "release": 0.95, "compression": number(random, 0.05, 0.3)}
    return {"steam": pressures | times | {"clearance": number(random, 0.02, 0.1), "exponent": number(random, 1, 1.2)}}


def compressor(random: Random) -> Keys:
    """Return an ideal card of a compressor."""
    delivery, clearance = f"{number(random, 2, 12)} bar", 10 ** number(random, -6, -1)
    return {"compressor": {"suction": "1 bar", "delivery": delivery, "clearance": clearance, "exponent": 1.3}}


def diesel(random: Random) -> Keys:
    """Return an ideal four-stroke card."""
    keys: Keys = {"intake": "0.95 bar", "exhaust": "1.1 bar", "compression_ratio": number(random, 12, 18)}
    keys |= {"exponent": 1.36, "expansion_exponent": 1.28, "cut_off": number(random, 0.02, 0.1)}
    return {"diesel": keys | maybe(random, 0.5, {"peak": "90 bar"})}


def beside_locking(random: Random) -> Keys:
    """Return a rod hardly longer than the crank, an exact one, with friction on which some lock."""
    near = 1 + 10 ** number(random, -2.5, -0.5)
    friction = {"crosshead": number(random, 0, 0.5)} | maybe(random, 0.5, PIN)
    return engine(random, near, steam(random), friction=friction)


def all_bearings(random: Random) -> Keys:
    """Return an engine whose journals rub under the loads of its crankshaft."""
    overhung = {"overhung": True, "b": "900 mm", "flywheel_position": "-300 mm"} if random.random() < 0.3 else {}
    rubbing = {"crosshead": 0.05, "crank_pin": 0.03, "journals": number(random, 0.01, 0.1)}
    guide = {"guide": {"length": "350 mm", "width": "250 mm"}}
    keys = engine(random, number(random, 3.5, 6), steam(random), friction=rubbing | PIN | guide)
    keys["indicator"]["crank_end"] = "mirrored"
    keys |= {"crank_end_rod": "70 mm", "crankshaft": CRANKSHAFT | overhung}
    return keys | {"flywheel": {"inertia": f"{number(random, 500, 3000)} kg m2"}, "load": {"slip": 0.03}}


def pumping(random: Random) -> Keys:
    """Return a steam engine with a compressor in tandem, which a large counterweight balances badly."""
    keys = engine(random, number(random, 3, 6), steam(random), counterweights={"share": number(random, 0, 1)})
    driven = {"name": "pump", "bore": "300 mm", "indicator": {"pressures": "absolute", "head_end": compressor(random)}}
    masses = {"piston": ["80 kg", "50 kg"], "piston_rod": "40 kg", "other": "20 kg", "connecting_rod": EXACT_ROD}
    return keys | {"tandem": [driven], "masses": masses, "crank_end_rod": "60 mm"}


def several(random: Random) -> Keys:
    """Return four-stroke engines on one shaft, with a balance shaft, in a V or in line, behind a coupling or rigid."""
    order = "-".join(str(one) for one in random.permutation(4) + 1)
    at_once: Keys = {"count": 4, "firing_order": order, "spacing": "500 mm"}
    at_once |= maybe(random, 0.5, {"bank_angles": ["-45 deg", "45 deg"]})
    each = engine(random, number(random, 3.5, 5), diesel(random), friction={"crosshead": 0.04, "constant": "200 N"})
    keys: Keys = {"cycle": "four-stroke", "speed": each.pop("speed"), "cylinders": at_once | {"each": each}}
    keys |= {
        "load": {"power_law": number(random, -1, 3)},
        "flywheel": {"inertia": f"{number(random, 300, 2000)} kg m2"},
    }
    driven = {"stiffness": "900 kN m/rad", "damping": "3 kN m s/rad", "inertia": f"{number(random, 100, 900)} kg m2"}
    return keys | maybe(random, 0.6, {"coupling": driven})


def traced(random: Random) -> Keys:
    """Return an engine measured over five cycles, its dead centre found by a motored trace."""
    trace: Keys = {"file": "cycles.csv", "unit": "bar", "pressure_columns": "2-6", "compression_ratio": 15}
    trace |= {"angle_zero": {"motored": "motored.csv", "loss_angle": f"{number(random, 0.3, 1)} deg"}}
    trace |= maybe(random, 0.5, {"pegging": "ambient"}) | maybe(random, 0.3, {"drift": "linear"})
    return engine(random, 4, {"trace": trace}, cycle="four-stroke", flywheel={"inertia": "900 kg m2"})


def shaping(random: Random) -> Keys:
    """Return a quick-return ram on a link."""
    keys: Keys = {"speed": "40 rpm", "mechanism": "slotted-lever", "crank": f"{CRANK} m", "frame": "800 mm"}
    keys |= {"lever": "1.3 m", "link": f"{number(random, 0.4, 3)} m", "ram_height": f"{number(random, 1.1, 1.3)} m"}
    return keys | {"ram_force": {"work": "6 kN", "return": "600 N"}, "flywheel": {"fluctuation": 0.05}}


def rocking(random: Random) -> Keys:
    """Return a four-bar linkage whose rocker all but stretches out."""
    spare = 10 ** number(random, -6, -1)
    keys: Keys = {
        "speed": "90 rpm",
        "mechanism": "four-bar",
        "crank": f"{CRANK} m",
        "coupler": "1 m",
        "rocker": "800 mm",
    }
    longest = 1.8 - CRANK - spare if random.random() < 0.5 else CRANK + 0.2 + spare
    return keys | {"frame": f"{longest} m", "moment": {"work": "900 N m", "return": "100 N m"}}


def flywheels(random: Random) -> Keys:
    """Return the least flywheel for a wish, with a rim, under loads that hang on the speed or the angle."""
    loads: list[object] = [{"slip": 10 ** number(random, -6, -1)}, {"power_law": number(random, -1, 4)}]
    loads += [{"unit": "N m", "points": [[0, 0], [40, 9000], [40, 500], [360, 0]]}]
    rim = {"outer_diameter": "3 m", "inner_diameter": "2.6 m", "density": "7200 kg/m3", "allowable_tension": "6 N/mm2"}
    wheel: Keys = {"fluctuation": number(random, 0.002, 0.1), "rim": rim}
    keys = engine(random, number(random, 3, 6), steam(random), flywheel=wheel, efficiency=0.85)
    keys["indicator"]["crank_end"] = "mirrored"
    return keys | {"load": loads[int(random.integers(len(loads)))]}


def polytropic(random: Random) -> Keys:
    """Return a card whose points are joined by polytropes, on an offset slider-crank with a point of its rod."""
    lines: Keys = {"unit": "bar", "interpolate": "polytropic", "clearance": number(random, 0.05, 0.2)}
    lines |= {"expansion": [[0, 12], [0.2, 12], [0.6, 5], [1, 2.5]], "compression": [[1, 1.1], [0.3, 1.3], [0, 12]]}
    keys = engine(random, number(random, 2, 5), lines, offset=f"{number(random, -0.2, 0.2)} m")
    return keys | {"point": {"from": "crank_pin", "along": "400 mm", "across": "100 mm"}}


KINDS: tuple[Callable[[Random], Keys], ...] = (
    *(beside_locking, all_bearings, pumping, several, traced),
    *(shaping, rocking, flywheels, polytropic),
)
