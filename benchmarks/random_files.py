"""Random machine files of every kind through every command: no fault of kurbel's own, and how long the slowest took.

    python benchmarks/random_files.py [COUNT [SEED]]

Without a seed it is that of the day.
"""

from __future__ import annotations

import math
import sys
import time
from collections import Counter
from datetime import date
from typing import Any

import numpy as np
import yaml
from click.testing import CliRunner

from kurbel.cli import kurbel

Random = np.random.Generator
Keys = dict[str, Any]


def size(random: Random, middle: float, unit: str, decades: float = 0.7) -> str:
    """Return a positive quantity so many decades round its middle; one in thirty lies far out."""
    decades = 6.0 if random.random() < 0.03 else decades
    return f"{middle * 10 ** random.uniform(-decades, decades):.6g} {unit}".strip()


def number(random: Random, low: float, high: float) -> float:
    return float(f"{random.uniform(low, high):.6g}")


def maybe(random: Random, share: float, keys: Keys) -> Keys:
    return keys if random.random() < share else {}


KINDS = ["slider-crank", "scotch-yoke", "slotted-lever", "four-bar", "parallel-crank", "yoke-frame"]


def mechanism(random: Random) -> tuple[str, Keys]:
    """Return a mechanism: lengths that mostly fit one another, and its optional sizes now and then."""
    crank = 10 ** random.uniform(-2, 0.3)

    def long(low: float, high: float) -> str:
        return f"{crank * random.uniform(low, high):.6g} m"

    pin = maybe(random, 0.5, {"pin_diameter": long(0.1, 0.3), "pin_length": long(0.1, 0.4)})
    rod = {"crank": f"{crank:.6g} m", "rod": long(1.05, 8)} | maybe(
        random, 0.3, {"offset": long(-0.3, 0.3)}
    )
    name = str(random.choice(["slider-crank"] * 5 + ["four-bar", *KINDS]))
    kinds: dict[str, Keys] = {
        "slider-crank": rod,
        "yoke-frame": rod | maybe(random, 0.5, {"gland": long(1, 3)}),
        "scotch-yoke": {"stroke": long(1, 4)}
        | pin
        | maybe(random, 0.5, {"guide_length": long(0.5, 2)}),
        "slotted-lever": {"crank": f"{crank:.6g} m", "frame": long(0.5, 4), "lever": long(2, 8)}
        | pin,
        "four-bar": {
            "crank": f"{crank:.6g} m",
            "coupler": long(0.8, 5),
            "rocker": long(0.8, 5),
            "frame": long(0.1, 5),
        },
        "parallel-crank": {"crank": f"{crank:.6g} m", "frame": long(2, 6)}
        | maybe(random, 0.5, {"coupler_mass": "80 kg"}),
    }
    far = "rocker_pin" if name == "four-bar" else "crosshead_pin"
    point = {"from": str(random.choice(["crank_pin", far])), "along": long(-1, 3)}
    point |= maybe(random, 0.5, {"across": long(-1, 1)})
    joined = name in ("slider-crank", "yoke-frame", "four-bar")
    return name, {"mechanism": name} | kinds[name] | maybe(
        random, 0.3 if joined else 0.02, {"point": point}
    )


def pressure(random: Random, four: bool) -> Any:
    """Return what stands for one end of an indicator."""
    high, low = number(random, 1, 60), number(random, 0.2, 0.9)
    kind = random.choice(["card", "constant", "trace", "trace", "ideal", "one", "drawn"])
    if kind == "one":
        return f"{high} bar"
    if kind == "drawn" and not four:
        return drawn(random, high, low)
    if kind == "constant" and not four:
        return {"constant": {"expansion": f"{high} bar", "compression": f"{low} bar"}}
    if kind == "trace":
        return {"trace": trace(random, four, high, low)}
    if kind == "ideal":
        if four:
            return {
                "otto": {
                    "intake": f"{low} bar",
                    "compression_ratio": number(random, 3, 15),
                    "peak": f"{high + 60} bar",
                }
            }
        cut = number(random, 0.05, 0.9)
        return {
            "steam": {
                "admission": f"{high} bar",
                "exhaust": f"{low} bar",
                "cut_off": cut,
                "clearance": number(random, 0.02, 0.3),
            }
        }
    inner = sorted(number(random, 0.01, 0.99) for _ in range(int(random.integers(0, 5))))

    def line(first: float, last: float) -> list[list[float]]:
        return [[0, first], *([z, number(random, low, high)] for z in inner), [1, last]]

    card = {"unit": "bar", "expansion": line(high, low), "compression": line(high, low)[::-1]}
    return card | ({"intake": line(low, low), "exhaust": line(low, low)[::-1]} if four else {})


def trace(random: Random, four: bool, high: float, low: float) -> Keys:
    """Return a measured trace, one cycle or several turns, with keys of which some are odd, or do not go together."""
    period = 720 if four else 360
    angles = np.linspace(0, period, int(random.integers(8, 400)))
    laps = int(random.choice([1, 1, 1, 2, 3]))
    wave = low + (high - low) * np.exp(
        -((np.minimum(angles, angles[-1] - angles) / number(random, 5, 60)) ** 2)
    )
    wave = np.tile(wave, laps) + maybe_other(
        random, 0.3, 0.0, [0.01, 0.1, 0.5]
    ) * random.standard_normal(laps * len(wave))
    counted = np.tile(angles, laps) * maybe_other(
        random, 0.05, 1.0, [math.pi / 180, 0.5, 2.0, -1.0, 1e-4]
    )
    counted = counted + maybe_other(random, 0.2, 0.0, [-180.0, -360.0, 17.3])
    points = [[float(f"{a:.6g}"), float(f"{p:.6g}")] for a, p in zip(counted, wave)]
    if random.random() < 0.1:
        del points[int(random.integers(len(points))) :: int(random.integers(1, 60))]
    keys: Keys = {
        "unit": str(maybe_other(random, 0.2, "bar", ["kPa", "psi", "Pa"])),
        "points": points,
    }
    keys |= maybe(random, 0.2, {"angle_zero": f"{number(random, -720, 720)} deg"})
    keys |= maybe(random, 0.1, {"angle_sense": str(random.choice(["with", "against"]))})
    keys |= maybe(random, 0.1, {"scale": float(random.choice([-1.0, 0.0, 1e-9, 20.0, 1e12]))})
    keys |= maybe(random, 0.1, {"offset": f"{number(random, -60, 60)} bar"}) | maybe(
        random, 0.1, {"drift": "linear"}
    )
    known = {
        "angle": f"{number(random, -1000, 1000)} deg",
        "pressure": f"{number(random, -2, 9)} bar",
    }
    keys |= maybe(random, 0.2, {"pegging": "ambient" if random.random() < 0.5 else known})
    keys |= maybe(random, 0.3, {"compression_ratio": 1 + 10 ** number(random, -9, 6)})
    keys |= maybe(random, 0.1, {"clearance": 10 ** number(random, -7, 3)})
    return keys | maybe(random, 0.02, {"skip_rows": 1, "angle_step": "1 deg"})


def maybe_other(random: Random, share: float, usual: Any, others: list[Any]) -> Any:
    """Return what is usual, or one of the others."""
    return others[int(random.integers(len(others)))] if random.random() < share else usual


def drawn(random: Random, high: float, low: float) -> Keys:
    """Return a card on paper: its lines in millimetres, or its area or mean height by planimeter."""
    length = number(random, 50, 120)
    paper: Keys = {"drawn": {"length": f"{length} mm", "spring": f"{number(random, 2, 20)} mm/bar"}}
    kind = random.choice(["lines", "area", "mean_height"])
    if kind == "lines":
        lines = {
            "expansion": [[0, high], [length / 3, high], [length, low]],
            "compression": [[length, low], [0, high]],
        }
        return paper | lines
    return paper | {
        str(kind): f"{number(random, 100, 3000)} mm2" if kind == "area" else f"{high} mm"
    }


def friction(random: Random) -> Keys:
    """Return the friction of a piston: of the crosshead on its guide, of rings, as a constant force."""
    crosshead = {"crosshead": number(random, 0, 0.3)}
    shoe = {"guide": {"length": size(random, 0.2, "m"), "width": size(random, 0.1, "m")}}
    rings = {
        "rings": {
            "count": 3,
            "height": size(random, 0.01, "m"),
            "pressure": "2 bar",
            "coefficient": 0.1,
        }
    }
    keys = maybe(random, 0.7, crosshead | maybe(random, 0.4, shoe)) | maybe(random, 0.3, rings)
    keys |= maybe(random, 0.5, {"constant": size(random, 300, "N")}) | maybe(
        random, 0.4, rubbing(random)
    )
    return keys or crosshead


def rubbing(random: Random) -> Keys:
    """Return the friction of pins and journals, each with its diameter."""
    keys: Keys = {}
    for name, diameter in (("crank_pin",) * 2, ("crosshead_pin",) * 2, ("journals", "journal")):
        given = {name: number(random, 0, 0.2), f"{diameter}_diameter": size(random, 0.1, "m")}
        keys |= maybe(random, 0.7, given)
    return keys | (
        {"crosshead_pin_length": size(random, 0.1, "m")} if "crosshead_pin" in keys else {}
    )


def counterweight(random: Random) -> Keys:
    """Return a weight by its product, or by mass and radius; now and then without its place."""
    pair = {"mass": size(random, 20, "kg"), "radius": size(random, 0.2, "m")}
    keys = pair if random.random() < 0.5 else {"product": size(random, 5, "kg m")}
    keys |= maybe(random, 0.5, {"angle": f"{number(random, -360, 360)} deg"})
    return keys | maybe(random, 0.5, {"axial_position": f"{number(random, -2, 2)} m"})


def counterweights(random: Random) -> Keys:
    """Return counterweights: a share, a share in two planes, or some one by one."""
    if random.random() < 0.4:
        return {
            "counterweights": [counterweight(random) for _ in range(int(random.integers(0, 4)))]
        }
    planes = {"planes": [f"{number(random, -2, 0)} m", f"{number(random, 0, 2)} m"]}
    return {"counterweights": {"share": number(random, 0, 1)} | maybe(random, 0.2, planes)}


def balancing(random: Random) -> Keys:
    """Return what is put on a machine to balance it: counterweights, shafts, the wheels of a locomotive."""
    shafts = [
        counterweight(random)
        | {"order": int(random.integers(1, 9)), "sense": str(random.choice(["with", "against"]))}
        for _ in range(int(random.integers(1, 4)))
    ]
    wheels: Keys = {"wheel_distance": size(random, 1.5, "m")} | maybe(
        random, 0.7, {"wheel_diameter": "1.4 m"}
    )
    wheels |= maybe(random, 0.7, {"wheel_load": size(random, 7e4, "N")})
    wheels |= maybe(random, 0.7, {"hammer_limit": size(random, 1e4, "N")})
    keys = maybe(random, 0.3, counterweights(random)) | maybe(
        random, 0.2, {"balance_shafts": shafts}
    )
    keys |= maybe(random, 0.1, {"locomotive": wheels})
    return keys | maybe(random, 0.1, {"moment_reference": f"{number(random, -2, 2)} m"})


def cylinder(random: Random, four: bool) -> Keys:
    """Return the keys of one cylinder."""
    name, keys = mechanism(random)
    slides = name not in ("four-bar", "parallel-crank")
    rod = name in ("slider-crank", "yoke-frame")
    if slides and random.random() < 0.85:
        keys |= {"bore": size(random, 0.3, "m")}
        ends = {"head_end": pressure(random, four)} | maybe(random, 0.4, {"crank_end": "mirrored"})
        keys |= {"indicator": {"pressures": str(random.choice(["gauge", "absolute"]))} | ends}
        keys |= maybe(random, 0.2, {"crank_end_rod": "20 mm"})
    if slides and random.random() < 0.85:
        masses: Keys = {str(random.choice(["piston", "reciprocating"])): size(random, 100, "kg")}
        if rod and "piston" in masses and random.random() < 0.6:
            exact = {
                "mass": size(random, 60, "kg"),
                "center_of_gravity": keys["crank"],
                "inertia": size(random, 8, "kg m2"),
            }
            masses["connecting_rod"] = (
                exact
                if random.random() < 0.5
                else {"mass": size(random, 60, "kg"), "share": number(random, 0.2, 0.8)}
            )
        masses |= maybe(random, 0.3, {"rotating": size(random, 50, "kg")})
        keys |= {"masses": masses} | maybe(
            random, 0.3, {"inclination": f"{number(random, -180, 180)} deg"}
        )
        keys |= maybe(random, 0.2, counterweights(random))
    if name == "slider-crank" and "bore" in keys:
        keys |= maybe(random, 0.5, {"friction": friction(random)})
    if slides and "bore" not in keys:
        keys |= maybe(
            random,
            0.6,
            {"ram_force": {"work": size(random, 5e3, "N"), "return": size(random, 5e2, "N")}},
        )
    if not slides:
        back = {"return": size(random, 20, "N m")} if name == "four-bar" else {}
        keys |= maybe(random, 0.6, {"moment": {"work": size(random, 50, "N m")} | back})
    return keys


def turning(random: Random) -> Keys:
    """Return flywheel, load and coupling."""
    inertia = {"inertia": size(random, 300, "kg m2", 2.5)}
    if random.random() < 0.3:
        inertia = {"mass": size(random, 300, "kg", 2.5), "radius_of_gyration": size(random, 1, "m")}
    wish = {"fluctuation": number(random, 0.001, 0.2)}
    flywheel = (
        inertia if random.random() < 0.5 else wish if random.random() < 0.7 else inertia | wish
    )
    rim: Keys = (
        {"mean_diameter": size(random, 2, "m")}
        | maybe(random, 0.3, {"depth": size(random, 0.2, "m")})
        | maybe(random, 0.5, {"allowable_tension": "5 N/mm2"})
    )
    flywheel |= maybe(random, 0.4, {"rim": rim})
    loads: list[Keys] = [
        {"power_law": number(random, -0.5, 4)},
        {"slip": 10 ** random.uniform(-9, 0)},
    ]
    coupling = {
        "stiffness": size(random, 1e5, "N m/rad", 2),
        "damping": size(random, 100, "N m s/rad", 2),
        "inertia": size(random, 300, "kg m2", 2),
    }
    keys = maybe(random, 0.6, {"flywheel": flywheel})
    keys |= maybe(random, 0.5, {"load": loads[int(random.integers(2))]}) | maybe(
        random, 0.25, {"coupling": coupling}
    )
    return keys | maybe(random, 0.15, {"efficiency": number(random, 0.5, 1)})


CRANKSHAFT = {
    **{
        "a": "300 mm",
        "b": "320 mm",
        "web_distance": "140 mm",
        "web_thickness": "80 mm",
        "web_width": "200 mm",
    },
    **{
        "pin_diameter": "130 mm",
        "pin_length": "130 mm",
        "journal_diameter": "130 mm",
        "journal_length": "200 mm",
    },
    **{"flywheel_mass": "2000 kg", "flywheel_position": "400 mm"},
    **{"allowable_bending": "60 N/mm2", "allowable_torsion": "45 N/mm2"},
}


def shaft(random: Random, cylinders: list[str]) -> list[Any]:
    """Return a shaft line: masses and pieces of any size, gears, grounds, dampers, and now and then one too many."""
    count = int(random.integers(1, 12)) if random.random() < 0.95 else 50
    places = random.integers(0, count, len(cylinders))
    parts: list[Any] = ["ground"] * bool(random.random() < 0.15)
    for index in range(count):
        here = [name for name, place in zip(cylinders, places) if place == index]
        mass: Keys = {"cylinder": here} if here else {}
        mass |= (
            {"inertia": size(random, 3, "kg m2", 2)} if not here or random.random() < 0.7 else {}
        )
        mass |= maybe(random, 0.2, {"damping": size(random, 5, "N m s/rad", 2)}) | maybe(
            random, 0.03, {"load": True}
        )
        after: list[Any] = [{"gear": number(random, 0.1, 4)}] * bool(random.random() < 0.04)
        parts += [_piece(random)] * bool(parts) + [
            "flywheel" if not here and random.random() < 0.1 else mass,
            *after,
        ]
    return parts + [_piece(random), "ground"] * bool(random.random() < 0.1)


def _piece(random: Random) -> Keys:
    """Return a piece of shaft, damped or not."""
    thick = number(random, 20, 300)
    plain = {"diameter": f"{thick} mm", "length": size(random, 0.5, "m")}
    plain |= maybe(random, 0.2, {"bore": f"{thick / 2} mm"})
    piece = plain if random.random() < 0.5 else {"stiffness": size(random, 1e6, "N m/rad", 3)}
    piece |= maybe(random, 0.4, {"loss_factor": number(random, 0, 0.2)})
    return piece | maybe(random, 0.2, {"damping": size(random, 50, "N m s/rad", 3)})


def effort(random: Random) -> Keys:
    """Return a turning-moment diagram by its harmonics."""
    orders = [
        [order, number(random, -9, 9), number(random, -9, 9)]
        for order in range(1, int(random.integers(2, 9)))
    ]
    return {"unit": "kN m", "mean": number(random, -3, 9), "harmonics": orders}


def cylinders(random: Random, four: bool) -> Keys:
    """Return several cylinders: each for itself, like the first one, or equal ones at once."""
    count = int(random.integers(2, 7))
    order = {"firing_order": "-".join(str(number) for number in random.permutation(count) + 1)}
    kind = random.choice(["list", "like", "equal"])
    if kind == "equal":
        at_once = maybe(random, 0.95, order) | maybe(
            random, 0.5, {"spacing": size(random, 0.3, "m")}
        )
        at_once |= maybe(random, 0.3, {"bank_angles": ["-30 deg", "30 deg"]})
        return {"cylinders": {"count": count, "each": cylinder(random, four)} | at_once}
    found = [cylinder(random, four) | {"name": "first"}]
    for _ in range(count - 1):
        keys = {"like": "first"} | maybe(random, 0.3, {"bore": size(random, 0.3, "m")})
        found.append(cylinder(random, four) if kind == "list" else keys)
    found = [each | maybe(random, 0.7, standing(random)) for each in found]
    if random.random() < 0.5:
        return {"cylinders": found} | order
    return {
        "cylinders": [each | {"crank_position": f"{number(random, 0, 720)} deg"} for each in found]
    }


def standing(random: Random) -> Keys:
    """Return where a cylinder stands, at one of few angles and places, so that some share a pin."""
    places = {"axial_position": f"{int(random.integers(0, 4)) * 300} mm"}
    return maybe(random, 0.5, {"bank_angle": f"{int(random.integers(-2, 3)) * 45} deg"}) | maybe(
        random, 0.8, places
    )


EXPECTED = {
    **{
        "c_max": "6 m/s ± 10 %",
        "stroke": "0.5 m ± 0.4 m",
        "T_peak": ["1 N", "90 kN"],
        "alpha_max": "3 rad/s2 ± 1 %",
    },
    **{"work": "5 kJ ± 3 kJ", "delta": "1/100 ± 20 %", "S_max": "50 kN ± 50 %"},
    **{"F_free_max": "5 kN ± 50 %", "load_max": "9 kN ± 50 %", "reversal_angle": "90 deg ± 50 %"},
}


def machine_file(random: Random) -> str:
    """Return the text of a machine file."""
    four = bool(random.random() < 0.25)
    keys: Keys = maybe(random, 0.95, {"speed": size(random, 200, "rpm")}) | {
        "cycle": "four-stroke" if four else "two-stroke"
    }
    keys |= maybe(random, 0.3, {"rotation": str(random.choice(["over", "under"]))})
    if random.random() < 0.08:
        keys |= {"effort": effort(random)}
    else:
        keys |= cylinders(random, four) if random.random() < 0.3 else cylinder(random, four)
    overhung = (
        {"overhung": True, "b": "900 mm", "flywheel_position": "-300 mm"}
        if random.random() < 0.5
        else {}
    )
    keys |= turning(random) | maybe(random, 0.2, {"crankshaft": CRANKSHAFT | overhung})
    keys |= {} if "effort" in keys else {**balancing(random), **keys}
    own = keys.get("cylinders", [])
    count = 0 if "effort" in keys else own["count"] if isinstance(own, dict) else max(len(own), 1)
    named = isinstance(own, list) and bool(own)
    names = [
        "first" if named and not number else f"cylinder {number + 1}" for number in range(count)
    ]
    keys |= (
        {"shaft": shaft(random, names)} if random.random() < 0.4 and "coupling" not in keys else {}
    )
    keys |= maybe(random, 0.2, {"brake_torque": size(random, 2e3, "N m")})
    keys |= maybe(
        random,
        0.3,
        {
            "limits": {"stroke": "5 m"}
            | maybe(random, 0.8, {"c_max": "6 m/s"})
            | maybe(random, 0.3, {"delta": 0.01, "P_peak": "50 kN"})
            | maybe(random, 0.3, {"M_free_max": "1 kN m", "pressure_velocity": "4 N/mm2 m/s"})
            | maybe(
                random,
                0.3,
                {"reversal_angle": "15 deg", "reversal_ratio": "3 %", "unloaded_arc": "30 deg"},
            )
        },
    )
    figures = {key: value for key, value in EXPECTED.items() if random.random() < 0.3}
    keys |= {"expect": figures} if figures and random.random() < 0.2 else {}
    return yaml.safe_dump(keys, sort_keys=False)


COMMANDS: tuple[tuple[str, ...], ...] = (
    ("check",),
    ("check", "-f", "json"),
    ("motion",),
    ("motion", "--where", "b = 1/6 b_max"),
    ("motion", "--over", "x", "--compare"),
    ("forces",),
    ("forces", "--where", "P = 0"),
    ("forces", "--over", "x", "--units", "imperial", "--layout", "rows"),
    ("forces", "-f", "json", "--set", "rotation=under"),
    ("forces", "--each-cycle"),
    ("forces", "--cycle", "2", "--key-values"),
    ("flywheel",),
    ("stress",),
    ("balance",),
    ("balance", "--orders", "--compare", "-f", "json"),
    ("balance", "--units", "technical", "-f", "markdown"),
    ("bearings",),
    ("bearings", "-f", "csv", "--units", "imperial"),
    ("bearings", "-f", "json", "--set", "rotation=under"),
    ("harmonics",),
    ("harmonics", "--speeds", "100:500:100 rpm", "-f", "json"),
    ("torsion",),
    ("torsion", "--orders", "0.5,1,3", "--columns", "M_shaft,tau", "-f", "json"),
    ("torsion", "--speeds", "50:500:50 rpm", "--modes", "9"),
)


def main() -> None:
    """Print the statuses by command, every fault with its number, and the slowest run."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else date.today().toordinal()
    statuses: Counter[tuple[str, int]] = Counter()
    slowest = (0.0, "", -1)
    for number in range(count):
        text = machine_file(np.random.default_rng([seed, number]))
        for arguments in COMMANDS:
            command = " ".join(arguments)
            begin = time.process_time()
            result = CliRunner().invoke(kurbel, [*arguments, "-"], input=text)
            slowest = max(slowest, (time.process_time() - begin, command, number))
            statuses[command, result.exit_code] += 1
            if result.exit_code not in (0, 1, 2, 3) or "Warning:" in result.stderr:
                print(
                    f"machine {number}, {command}: status {result.exit_code}: {result.stderr.strip()[-300:]}"
                )
    for (command, status), found in sorted(statuses.items()):
        print(f"{command:<60} status {status}: {found}")
    print(f"seed {seed}; slowest: {slowest[0]:.1f} s of CPU, {slowest[1]} of machine {slowest[2]}")


if __name__ == "__main__":
    main()
