"""`kurbel.sweep` and `kurbel.find`: many designs of a machine from Python."""

import math
import os
import warnings
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from kurbel.designs.binding import Binder, numbers_of
from kurbel.designs.find import Solutions
from kurbel.designs.find import find_solutions as find_in
from kurbel.designs.plan import Input
from kurbel.designs.sweep import Spec, Sweep, computed_rows
from kurbel.errors import KurbelError, UsageError
from kurbel.machine import Machine
from kurbel.machine.origin import Origin
from kurbel.machine_file.from_python import errors_of_python
from kurbel.machine_file.overrides import texts_at
from kurbel.machine_file.reader import machine_of, read_machine
from kurbel.notes.plausible import doubts_of


def sweep(
    machine: Machine | str | os.PathLike[str],
    inputs: Mapping[str, object],
    columns: Sequence[str] | str = (),
    with_angles: bool = False,
) -> dict[str, Any]:
    """Return key values of many designs of a machine as arrays (n,), in SI, by their ids.

    machine: as `load` or `loads` returned it, or what these take; inputs: dotted key of its file -> numbers (n,) in SI
    (angles in degrees, speeds in revolutions per second), or texts as in the file; a single value is that of every
    row. columns: id or symbol of a key value, or several; all of `kurbel forces` where none is named. Where a design
    fails its numbers are nan, and `failure` (n,) has the reason; a list of angles is a tuple. If the file has limits,
    `keeps` is true where all of them are kept.

    >>> import kurbel
    >>> found = sweep(kurbel.loads("{stroke: 1 m, rod_ratio: 5, speed: 60 rpm}"), {"rod_ratio": [4, 5]}, ["b_max"])
    >>> found["b_max"].round(3).tolist()
    [24.674, 23.687]

    Raises UsageError for inputs of different lengths, keys without a value, and columns that the machine has not.
    """
    names = (columns,) if isinstance(columns, str) else tuple(columns)
    with errors_of_python(varied="inputs"):
        origin = _read(machine)
        start = tuple(texts_at(origin, tuple(inputs)))
        axis = tuple(_inputs(Binder(origin, tuple(inputs), start), inputs))
        swept = Sweep(Spec(origin, (axis,), columns=names, with_angles=with_angles, start=start))
        rows = list(computed_rows(swept, range(swept.rows)))
    for input, kind in zip(axis, swept.kinds):
        _warn_of_numbers(origin, input.key, input.numbers, kind, input.unit)
    arrays: dict[str, Any] = {}
    for head, values in zip(swept.heads, zip(*(row.values for row in rows))):
        if head.input:
            continue
        if any(isinstance(value, tuple) for value in values):
            arrays[head.id] = np.fromiter(values, object)
        else:
            arrays[head.id] = np.array(values, dtype=float)
    texts = dict(zip(swept.texts, zip(*(row.texts for row in rows))))
    arrays["failure"] = np.array(texts["failure"])
    if "keeps" in texts:
        arrays["keeps"] = np.array(texts["keeps"]) == "yes"
    return arrays


def find(
    machine: Machine | str | os.PathLike[str],
    vary: Mapping[str, tuple[float | str, float | str]],
    wanted: Sequence[str] | str = (),
    least: str = "",
    greatest: str = "",
    where: Sequence[str] | str = (),
) -> Solutions:
    """Return the values of one key or two that give wanted key values, or for which one is the least or the greatest.

    machine: as `load` or `loads` returned it, or what these take; vary: dotted key of its file -> ends of the range, in
    SI, or texts as in the file; wanted: as many texts `delta = 1/50`; least, greatest: id or symbol of a
    key value instead; where: conditions such as `c_m < 5 m/s`. Solutions have `values` of the keys, in their order, and
    `key_values`, in SI.

    Raises UsageError for what cannot be read, NoSolutionError where nothing is found.

    >>> import kurbel
    >>> found = find("{stroke: 1 m, rod_ratio: 5, speed: 60 rpm}", {"speed": ("50 rpm", "99 rpm")}, "c_m = 3 m/s")
    >>> found.found[0].values  # revolutions per second
    (1.5,)
    """
    with errors_of_python():
        origin = _read(machine)
        texts = []
        for key, (low, high) in vary.items():
            unit = ""
            if not (isinstance(low, str) and isinstance(high, str)):
                binder = Binder(origin, [key], texts_at(origin, [key]))
                (unit,) = binder.units
                numbers = [float(end) for end in (low, high) if not isinstance(end, str)]
                _warn_of_numbers(origin, key, numbers, binder.kinds[0], unit)
            texts.append(f"{key}={low}:{high} {unit}".rstrip())
        return find_in(origin, texts, _as_list(wanted), least, greatest, _as_list(where))


_SAME_UNIT = 5.0
"""Times a number of the file, up to which another one is probably in the same unit."""


def _warn_of_numbers(
    origin: Origin, key: str, numbers: Sequence[float], kind: str, unit: str
) -> None:
    """Warn of numbers that are far from that of the file and make a machine that nobody builds: mm for m, say."""
    finite = [number for number in numbers if math.isfinite(number)]
    if not finite:
        return
    (text,) = texts_at(origin, [key])
    (in_file,) = numbers_of(Input(key, (text,)), kind)
    for number in dict.fromkeys((min(finite), max(finite))):
        is_near = abs(in_file) <= _SAME_UNIT * abs(number) <= _SAME_UNIT**2 * abs(in_file)
        if is_near:
            continue
        doubts = _new_doubts(origin, f"{key}={number!r} {unit}".rstrip())
        if doubts:
            written = f"{number:g} {unit}".rstrip()
            _, _, sentence = doubts[0].rpartition(": ")  # without the part that has the key
            message = f"{key} = {written}, as numbers are in SI: {sentence}"
            warnings.warn(message, stacklevel=3)
            return


def _new_doubts(origin: Origin, varied: str) -> list[str]:
    """Return what no machine built has of a file with another value of a key, unless the file itself has it."""
    try:
        doubts = list(doubts_of(read_machine(origin._replace(varied=(varied,)))))
    except KurbelError:  # its row has the reason
        return []
    doubts_of_file = set(doubts_of(read_machine(origin)))
    return [doubt for doubt in doubts if doubt not in doubts_of_file]


def _as_list(texts: Sequence[str] | str) -> list[str]:
    """Return one text or several as a list; an empty text is none."""
    if isinstance(texts, str):
        if not texts:
            return []
        return [texts]
    return list(texts)


def _read(machine: Machine | str | os.PathLike[str]) -> Origin:
    """Return the file that a machine was read from. Raises UsageError where it was not."""
    origin = machine_of(machine).origin
    if origin is None:
        raise UsageError(
            "only a machine that was read can vary by its keys: take it from kurbel.load or kurbel.loads"
        )
    return origin


def _inputs(binder: Binder, inputs: Mapping[str, object]) -> Iterator[Input]:
    """Yield the inputs with their values; raises UsageError for different lengths."""
    columns = [np.atleast_1d(np.asarray(values)) for values in inputs.values()]
    count = max(map(len, columns), default=0)
    fits = all(column.shape in ((count,), (1,)) for column in columns)
    if not count or not fits:
        lengths = ", ".join(f"{key} has {len(column)}" for key, column in zip(inputs, columns))
        raise UsageError(
            f"give as many values of every key, one or more of them; {lengths or 'there is none'}"
        )
    for key, column, unit in zip(inputs, columns, binder.units):
        values = np.broadcast_to(column, count).tolist()
        if column.dtype.kind in "fiu":
            yield Input(key, (), tuple(values), unit)
        else:
            yield Input(key, tuple(map(str, values)))
