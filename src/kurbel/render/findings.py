"""The output of `kurbel find`: rows, JSON, and remarks on jumps, failing designs and bounds."""

import numpy as np

import kurbel
from kurbel.declared.unit_systems import SI, convert, shown_unit
from kurbel.designs.find import Solution, Solutions
from kurbel.designs.study import Design
from kurbel.report.picture import Axis, Curve, Mark, PageFigure, Panel, Picture, Words
from kurbel.report.picture_source import level

Heads = tuple[tuple[str, str], ...]


def heads(found: Solutions, system: str) -> Heads:
    """Return names and units of the columns: the keys in the units of their ranges, and the key values."""
    keys = [(one.key, one.unit) for one in found.varied]
    largest = [max(map(abs, values)) for values in zip(*(one.key_values for one in found.found))]
    return (*keys, *((one.id, shown_unit(one.kind, system, size)) for one, size in zip(found.heads, largest)))


def as_rows(found: Solutions, system: str) -> list[Design]:
    """Return a row for each solution, in the order and the units of the heads."""
    kinds = [*(one.kind for one in found.varied), *(one.kind for one in found.answers)]
    units = [unit for _, unit in heads(found, system)]
    return [
        Design(
            number,
            tuple(float(convert(value, *unit)) for value, *unit in zip((*one.values, *one.key_values), kinds, units)),
        )
        for number, one in enumerate(found.found, 1)
    ]


def as_json(found: Solutions) -> dict[str, object]:
    """Return the findings for JSON, all in SI."""

    def solution(one: Solution) -> dict[str, object]:
        key_values = [
            {"id": head.id, "symbol": answer.quantity.symbol, "unit": head.unit, "value": value}
            for head, answer, value in zip(found.heads, found.answers, one.key_values)
        ]
        return {"values": list(one.values), "key_values": key_values, "notes": list(one.notes)}

    ranges = [list(span) for span in found.met]
    return {
        "kurbel": kurbel.__version__,
        "format": 1,
        "command": "find",
        "machine": found.machine,
        "varied": [{"key": one.key, "low": one.low, "high": one.high, "unit": SI[one.kind]} for one in found.varied],
        "wanted": [
            {"id": one.head.id, "unit": one.head.unit, "aim": one.aim, "value": one.value} for one in found.wanted
        ],
        "found": [solution(one) for one in found.found],
        "range": ranges[0] if len(ranges) == 1 else ranges,
        "jumps": [list(one.values) for one in found.jumps],
        "failed": [{"low": one.low, "high": one.high, "failure": one.why} for one in found.failed],
    }


def picture(found: Solutions, system: str) -> Picture:
    """Return the wanted key value over the only key, with the solutions, and gaps at jumps and where designs fail."""
    key, wanted = found.varied[0], found.wanted[0]
    numbers, values, kind = found.places[:, 0], found.values[:, wanted.place], wanted.head.kind
    unit = shown_unit(kind, system, float(np.nanmax(np.abs(values))))
    # one nan at a jump, two for a design that fails
    numbers, values = (np.repeat(one, 1 + np.isnan(values)) for one in (numbers, values))
    jumps = np.searchsorted(numbers, [one.values[0] for one in found.jumps])
    numbers, values = np.insert(numbers, jumps, np.nan), np.insert(values, jumps, np.nan)
    x, y = np.where(np.isnan(values), np.nan, convert(numbers, key.kind, key.unit)), convert(values, kind, unit)
    quantity = found.answers[wanted.place].quantity
    symbol = Words(quantity.symbol, quantity.ascii_symbol)
    curves = [Curve(symbol, x, y)]
    if wanted.value is not None:
        curves.append(level(x, float(convert(wanted.value, kind, unit)), Words(wanted.text)))
    name = Words(key.key.rpartition(".")[2])
    places = [
        (key.in_unit(one.values[0]), float(convert(one.key_values[wanted.place], kind, unit))) for one in found.found
    ]
    marks = tuple(Mark(*place, PageFigure(name, place[0], key.unit)) for place in places)
    across = Axis(Words(key.key), unit=key.unit, low=key.in_unit(key.low), high=key.in_unit(key.high))
    panel = Panel(across, Axis(symbol, unit=unit), tuple(curves), marks=marks)
    text = "The key value over the key; marked where it is as wanted, parted where it jumps or designs fail."
    return Picture("find", f"{wanted.head.id} over {key.key}", text, (panel,), found.machine)


def remarks(found: Solutions) -> list[str]:
    """Return the remarks on the solutions, a line each."""
    key = found.varied[0]
    lines = [f"solution {number}: {note}" for number, one in enumerate(found.found, 1) for note in one.notes]
    for one in found.jumps:
        place = key.written(one.values[0], figures=9)
        lines.append(f"{found.wanted[0].text}: passed by a jump at {key.key} = {place}")
    for part in found.failed:
        where = "at" if part.low == part.high else f"from {key.in_unit(part.low):.6g} to"
        lines.append(f"{key.key} {where} {key.written(part.high)}: designs fail: {part.why}")
    return lines
