"""`kurbel.sweep`: what Python asks of many designs of a machine, as arrays."""

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from kurbel.declared.unit_systems import SI
from kurbel.designs.binding import Binder, written_texts
from kurbel.designs.plan import Input
from kurbel.designs.sweep import Row, Spec, Sweep
from kurbel.designs.workers import rows_of
from kurbel.errors import UsageError
from kurbel.machine import Machine
from kurbel.machine.origin import Origin
from kurbel.machine_file.reader import machine_of


def sweep(
    machine: Machine | str | os.PathLike[str],
    inputs: Mapping[str, Any],
    columns: Sequence[str] | str = (),
    with_angles: bool = False,
) -> dict[str, Any]:
    """Return key values of many designs of a machine as arrays (n,), in SI, by their ids.

    machine: as `load` or `loads` returned it, or what these take; inputs: dotted key of its file -> numbers (n,) in SI
    (angles in degrees, speeds in revolutions per second), or texts as the file would have them; a single one holds for
    every row. columns: id or symbol of a key value, or
    several, all of `kurbel forces` where none is named. Numbers are nan, and `failure` (n,) tells why, where a design
    fails; a list of angles is a tuple. With limits in the file `keeps` tells whether they are kept.

    >>> import kurbel
    >>> found = sweep(kurbel.loads("{stroke: 1 m, rod_ratio: 5, speed: 60 rpm}"), {"rod_ratio": [4, 5]}, ["b_max"])
    >>> found["b_max"].round(3).tolist()
    [24.674, 23.687]

    Raises UsageError for inputs of different lengths, keys without a value, and columns that the machine has not.
    """
    machine = machine_of(machine)
    if machine.origin is None:
        raise UsageError("only a machine that was read can vary by its keys: take it from kurbel.load or kurbel.loads")
    given = tuple(_inputs(machine.origin, inputs))
    names = (columns,) if isinstance(columns, str) else tuple(columns)
    found = Sweep(Spec(machine.origin, given=given, side_by_side=True, columns=names, with_angles=with_angles))
    return _arrays(found, list(rows_of(found, range(found.rows))))


def _inputs(origin: Origin, inputs: Mapping[str, Any]) -> Iterator[Input]:
    """Yield the inputs with their values as texts of the machine file."""
    columns = {key: np.atleast_1d(np.asarray(values)) for key, values in inputs.items()}
    count = max(map(len, columns.values()), default=0)
    columns = {key: np.repeat(one, count) if np.ndim(inputs[key]) == 0 else one for key, one in columns.items()}
    lengths = {key: len(column) for key, column in columns.items()}
    counts = set(lengths.values())
    if len(counts) != 1 or 0 in counts or any(column.ndim != 1 for column in columns.values()):
        each = ", ".join(f"{key} has {count}" for key, count in lengths.items())
        raise UsageError(f"give as many values of every key, one or more of them; {each or 'there is none'}")
    keys = tuple(columns)
    binder = Binder(origin, keys, written_texts(origin, keys))
    for (key, column), kind in zip(columns.items(), binder.kinds):
        unit = f" {SI[kind]}".rstrip() if kind in SI and column.dtype.kind in "fiu" else ""
        yield Input(key, tuple(f"{one}{unit}" for one in column.tolist()))


def _arrays(found: Sweep, rows: Sequence[Row]) -> dict[str, Any]:
    arrays: dict[str, Any] = {}
    for head, values in zip(found.heads, zip(*(row.values for row in rows)), strict=True):
        if head.input:
            continue
        if any(isinstance(one, tuple) for one in values):
            arrays[head.id] = np.empty(len(values), dtype=object)
            arrays[head.id][:] = values
        else:
            arrays[head.id] = np.array([np.nan if one is None else one for one in values], dtype=float)
    arrays["failure"] = np.array([row.failure for row in rows])
    if found.limited:
        arrays["keeps"] = np.array([bool(row.keeps) for row in rows])
    return arrays
