"""What `kurbel find` prints: the solutions as rows, as JSON, as a picture, and what is remarked on them."""

import numpy as np

import kurbel
from kurbel.arrays import Array
from kurbel.declared.unit_systems import SI, convert, shown_unit
from kurbel.designs.answers import Design
from kurbel.designs.find import Solution, Solutions, Target
from kurbel.pictures.picture import Axis, Curve, Mark, PageFigure, Panel, Picture, Words
from kurbel.pictures.picture_source import in_units, level
from kurbel.render.json_text import FORMAT
from kurbel.render.sweep_rows import Titles


def as_rows(solutions: Solutions, system: str) -> tuple[Titles, list[Design]]:
    """Return a row for each solution: the keys in the units of their ranges, and the key values."""
    key_values = [solution.key_values for solution in solutions.found]
    largest = [max(map(abs, values)) for values in zip(*key_values)]

    # name, kind of quantity and unit of each column: the keys, then the key values
    columns = [(varied.key, varied.kind, varied.unit) for varied in solutions.varied]
    for head, size in zip(solutions.heads, largest):
        columns.append((head.id, head.kind, shown_unit(head.kind, system, size)))

    rows = []
    for number, solution in enumerate(solutions.found, 1):
        in_si = (*solution.values, *solution.key_values)
        cells = tuple(
            float(convert(value, kind, unit)) for value, (_, kind, unit) in zip(in_si, columns)
        )
        rows.append(Design(number, cells))
    names = tuple((name, unit) for name, _, unit in columns)
    return Titles(names), rows


def as_json(solutions: Solutions) -> dict[str, object]:
    """Return the solutions for JSON, all in SI."""
    ranges = [list(span) for span in solutions.met]
    return {
        "kurbel": kurbel.__version__,
        "format": FORMAT,
        "command": "find",
        "machine": solutions.machine,
        "varied": [
            {"key": key.key, "low": key.low, "high": key.high, "unit": SI[key.kind]}
            for key in solutions.varied
        ],
        "wanted": [
            {
                "id": target.head.id,
                "unit": target.head.unit,
                "aim": target.aim,
                "value": target.value,
            }
            for target in solutions.wanted
        ],
        "found": [_solution_json(solutions, solution) for solution in solutions.found],
        "range": ranges[0] if len(ranges) == 1 else ranges,
        "jumps": [list(jump.values) for jump in solutions.jumps],
        "failed": [
            {"low": part.low, "high": part.high, "failure": part.why} for part in solutions.failed
        ],
    }


def _solution_json(solutions: Solutions, solution: Solution) -> dict[str, object]:
    key_values = []
    for head, answer, value in zip(solutions.heads, solutions.answers, solution.key_values):
        symbol = answer.quantity.symbol
        key_values.append({"id": head.id, "symbol": symbol, "unit": head.unit, "value": value})
    return {
        "values": list(solution.values),
        "key_values": key_values,
        "notes": list(solution.notes),
    }


def picture(solutions: Solutions, system: str) -> Picture:
    """Return the wanted key value over the only key, with the solutions, and gaps at jumps and where designs fail."""
    key = solutions.varied[0]
    target = solutions.wanted[0]
    x, y = _course(solutions, target)

    # the key value, and the level that is wanted
    quantity = solutions.answers[target.place].quantity
    symbol = Words(quantity.symbol, quantity.ascii_symbol)
    curves = [Curve(symbol, x, y)]
    if target.value is not None:
        curves.append(level(x, target.value, Words(target.text)))

    # a mark at each solution
    name = Words(key.key.rpartition(".")[2])
    marks = []
    for solution in solutions.found:
        figure = PageFigure(name, solution.values[0], kind=key.kind)
        marks.append(Mark(solution.values[0], solution.key_values[target.place], figure))

    across = Axis(Words(key.key), key.kind, low=key.low, high=key.high)
    up = Axis(symbol, target.head.kind)
    panel = in_units(Panel(across, up, tuple(curves), marks=tuple(marks)), system)
    text = "The key value over the key; marked where it is as wanted, parted where it jumps or designs fail."
    return Picture("find", f"{target.head.id} over {key.key}", text, (panel,), solutions.machine)


def _course(solutions: Solutions, target: Target) -> tuple[Array, Array]:
    """Return the key (n,) and the key value (n,), with a nan at each jump and two where a design fails."""
    keys = solutions.places[:, 0]
    key_values = solutions.values[:, target.place]
    times = 1 + np.isnan(key_values)
    keys = np.repeat(keys, times)
    key_values = np.repeat(key_values, times)
    jumps = np.searchsorted(keys, [jump.values[0] for jump in solutions.jumps])
    keys = np.insert(keys, jumps, np.nan)
    key_values = np.insert(key_values, jumps, np.nan)
    keys = np.where(np.isnan(key_values), np.nan, keys)
    return keys, key_values


def remarks(solutions: Solutions) -> list[str]:
    """Return the remarks on the solutions, a line each."""
    key = solutions.varied[0]
    lines = []
    for number, solution in enumerate(solutions.found, 1):
        lines += [f"solution {number}: {note}" for note in solution.notes]
    for jump in solutions.jumps:
        value = key.written(jump.values[0], figures=9)
        lines.append(f"{solutions.wanted[0].text}: passed by a jump at {key.key} = {value}")
    for part in solutions.failed:
        is_point = part.low == part.high
        where = "at" if is_point else f"from {key.in_unit(part.low):.6g} to"
        lines.append(f"{key.key} {where} {key.written(part.high)}: designs fail: {part.why}")
    return lines
