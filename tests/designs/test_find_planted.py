"""Values planted in machines drawn at random are found again, and no solution is missed that a dense scan separates."""

import numpy as np
import pytest

from kurbel import loads, sweep
from kurbel.arrays import Array
from kurbel.declared.unit_systems import SI
from kurbel.designs.answers import requested_answers
from kurbel.designs.find import find_solutions
from kurbel.errors import KurbelError
from kurbel.machine.origin import Origin
from kurbel.machine_file.source import decode, read
from swept_rows import EXAMPLES, numbers_in

OF_ONE = (
    "c_max",
    "b_max",
    "T_max",
    "T_min",
    "N_max",
    "S_min",
    "work",
    "P_max",
    "friction_work",
    "mean_pressure",
)
OF_ALL = ("dE", "delta", "M_mean", "F_free_max", "share_best", "omega_max")
SCANNED = 65


def engine(random: np.random.Generator) -> str:
    """Return a plausible machine of one or two slider-cranks."""

    def some(*choices: str) -> str:
        return str(random.choice(choices))

    def between(low: float, high: float, digits: int = 4) -> str:
        return f"{random.uniform(low, high):.{digits}g}"

    stroke = random.uniform(0.15, 1.0)
    steam = f"steam: {{admission: {between(4, 12)} bar, exhaust: 0.2 bar, cut_off: {between(0.1, 0.8)}, clearance: 0.06}}"
    diesel = f"diesel: {{intake: 0 bar, cut_off: {between(0.03, 0.12)}, compression_ratio: {between(12, 20)}}}"
    pump = f"constant: {{expansion: -0.5 bar, compression: {between(2, 9)} bar}}"
    drawn = "unit: at, expansion: [[0, 9], [0.3, 9], [0.6, 5], [1, 2]], compression: [[1, 1], [0.2, 1], [0, 7]]"
    lines = [
        f"{{crank: {stroke / 2:.4g} m, rod_ratio: {between(2.5, 7)}, bore: {stroke * random.uniform(0.5, 1):.4g} m",
        some("crank_end_rod: 0.03 m", f"offset: {between(0.001, 0.1)} m"),
        f"indicator: {{head_end: {{{some(steam, diesel, pump, drawn)}}}{some('', ', crank_end: mirrored')}}}",
        f"masses: {{reciprocating: {2000 * stroke**3:.4g} kg, rotating: {900 * stroke**3:.4g} kg}}",
        some(
            f"inclination: {between(1, 90)} deg", f"friction: {{crosshead: {between(0.02, 0.12)}}}"
        ),
        f"friction: {{rings: {{count: 4, height: 9 mm, pressure: {between(0.2, 1)} bar, coefficient: 0.1}}}}",
    ]
    one = ", ".join(lines[: -1 if "friction" in lines[-2] else None])
    cylinders = [
        f"  - {one}, crank_position: {angle} deg}}"
        for angle in ("0", between(30, 330))[: random.integers(1, 3)]
    ]
    speed = 60 * random.uniform(0.5, 1.2) / stroke**0.5
    wheel = f"flywheel: {{inertia: {3000 * stroke**5 * 10 ** random.uniform(0, 1):.4g} kg m2}}"
    load = some(
        "", f"load: {{power_law: {between(0.5, 3)}}}\n", f"load: {{slip: {between(0.02, 0.1)}}}\n"
    )
    return f"speed: {speed:.4g} rpm\n{wheel}\n{load}cylinders:\n" + "\n".join(cylinders) + "\n"


def planted(
    origin: Origin, random: np.random.Generator
) -> tuple[str, float, float, float, str] | None:
    """Return one of the keys of a machine with a range in its unit, where in the range its value is, and that unit."""
    keys = [
        one for one in numbers_in(origin) if not {"compression", "expansion"} & {*one[0].split(".")}
    ]
    if not keys:
        return None
    key, value, unit = keys[random.integers(len(keys))]
    low, high = value * random.uniform(0.6, 0.95), value * random.uniform(1.05, 1.5)
    return key, low, high, (value - low) / (high - low), unit


def fault(origin: Origin, random: np.random.Generator) -> str | None:
    """Return what is wrong with what is found of a value planted in a machine, '' for nothing; None without a value."""
    if not (one := planted(origin, random)):
        return None
    key, low, high, share, unit = one

    def of(name: str, shares: Array) -> Array:
        texts = [f"{low + (high - low) * share!r} {unit}".strip() for share in shares.tolist()]
        return np.asarray(sweep(origin.text, {key: texts}, [name])[name])

    for name in random.permutation((*OF_ONE, *OF_ALL)).tolist():
        try:
            value, before, after = of(name, share + np.array([0.0, -1e-4, 1e-4]))
        except (KurbelError, KeyError):
            continue
        # on a level every place is a solution, and at a summit or in a valley the value is met without being crossed
        steps = np.array([value - before, after - value])
        if (
            not np.isfinite(steps).all()
            or min(abs(steps)) <= 1e-9 * abs(value)
            or steps[0] * steps[1] < 0
        ):
            continue
        scan = of(name, np.linspace(0.0, 1.0, SCANNED)) - value
        unit_of = SI[requested_answers(loads(origin.text), [name])[0].kind]
        result = find_solutions(
            origin,
            [f"{key}={low!r}:{high!r} {unit}"],
            [f"{name} = {float(value)!r} {unit_of}".strip()],
        )
        span = result.varied[0].high - result.varied[0].low
        every = (*result.found, *result.jumps)
        places = np.array(
            [(solution.values[0] - result.varied[0].low) / span for solution in every]
        )
        slope = abs(after - before) / 2e-4
        missed = abs(places - share).min()
        if missed > max(1e-9, 1e-12 * np.nanmax(np.abs(result.values)) / slope):
            return f"{name} over {key}: {missed} from what was planted"
        crossings = np.count_nonzero(scan[:-1] * scan[1:] < 0) + np.count_nonzero(scan == 0)
        return (
            ""
            if len(places) >= crossings
            else f"{name} over {key}: {len(places)} of {crossings} found"
        )
    return None


@pytest.mark.slow
@pytest.mark.parametrize("first", range(0, 20, 10))
def test_planted_values_are_found_and_none_is_missed(first: int) -> None:
    faults = list[str]()
    for seed in range(first, first + 10):
        random = np.random.default_rng(seed)
        if result := fault(decode("<random>", engine(random).encode()), random):
            faults.append(f"{seed}: {result}")
    assert faults == []


@pytest.mark.slow
def test_planted_values_in_machines_of_books() -> None:
    results = []
    for seed in range(30):
        random = np.random.default_rng(seed)
        results.append(fault(read(EXAMPLES[random.integers(len(EXAMPLES))]), random))
    assert results.count("") > 2
    assert set(results) <= {None, ""}
