"""Values planted in machines of books are found again, and no solution is missed that a dense scan separates."""

import re
from pathlib import Path

import numpy as np
import pytest

from kurbel import sweep
from kurbel.arrays import Array
from kurbel.declared.unit_systems import SI
from kurbel.designs.find import find
from kurbel.errors import KurbelError
from kurbel.machine.origin import Origin
from kurbel.machine_file.overrides import dotted, leaves, tree_of
from kurbel.machine_file.source import read

KEY_VALUES = ("c_max", "b_max", "T_max", "N_max", "S_min", "work", "P_max", "dE", "M_mean")
NUMBER = re.compile(r"([0-9.]+(?:e[+-]?[0-9]+)?)(?: (.*))?")
EXAMPLES = sorted(path for path in Path(__file__).parents[1].glob("examples/*.yaml") if path.stem != "answers")
NO_NUMBERS = {"uncertainty", "limits", "expect", "trace", "points", "name", "count"}


def planted(seed: int) -> tuple[Origin, str, float, float, float, str] | None:
    """Return a machine, one of its keys with a range in its unit, where in the range its value is, and that unit."""
    random = np.random.default_rng(seed)
    origin = read(EXAMPLES[random.integers(len(EXAMPLES))])
    try:
        keys = [(path, NUMBER.fullmatch(text)) for path, text in leaves(tree_of(origin)) if isinstance(text, str)]
    except KurbelError:
        return None
    keys = [
        (path, found) for path, found in keys if found and float(found[1]) > 0 and not NO_NUMBERS & {*map(str, path)}
    ]
    if not keys:
        return None
    path, found = keys[random.integers(len(keys))]
    assert found
    value = float(found[1])
    low, high = value * random.uniform(0.6, 0.95), value * random.uniform(1.05, 1.5)
    return origin, dotted(path), low, high, (value - low) / (high - low), found[2] or ""


@pytest.mark.slow
def test_planted_values_are_found_and_none_is_missed() -> None:
    done = 0
    for seed in range(30):
        if not (one := planted(seed)):
            continue
        origin, key, low, high, share, unit = one
        vary = f"{key}={low!r}:{high!r} {unit}"

        def of(name: str, shares: Array) -> Array:
            texts = [f"{low + (high - low) * share!r} {unit}".strip() for share in shares.tolist()]  # noqa: B023
            return np.asarray(sweep(origin.text, {key: texts}, [name])[name])  # noqa: B023

        for name in np.random.default_rng(seed).permutation(KEY_VALUES).tolist():
            try:
                value, before, after = of(name, share + np.array([0.0, -1e-4, 1e-4]))
            except (KurbelError, KeyError):
                continue
            steps = np.abs([value - before, after - value])  # on a level every place is a solution
            if not np.isfinite(steps).all() or min(steps) <= 1e-9 * abs(value):
                continue
            scan = of(name, np.linspace(0.0, 1.0, 129)) - value
            kind = {"c_max": "velocity", "b_max": "acceleration", "work": "energy", "dE": "energy", "M_mean": "torque"}
            found = find(origin, [vary], [f"{name} = {float(value)!r} {SI[kind.get(name, 'force')]}"])
            places = [
                (solution.values[0] - found.varied[0].low) / (found.varied[0].high - found.varied[0].low)
                for solution in (*found.found, *found.jumps)
            ]
            slope = abs(after - before) / 2e-4
            assert min(abs(np.array(places) - share)) <= max(1e-9, 1e-12 * np.nanmax(np.abs(found.values)) / slope), (
                seed
            )
            crossings = np.count_nonzero(scan[:-1] * scan[1:] < 0) + np.count_nonzero(scan == 0)
            assert len(places) >= crossings, seed
            done += 1
            break
    assert done > 2
