"""The output of `kurbel find`: rows, JSON, and remarks on jumps, failing designs and bounds."""

import numpy as np

import kurbel
from kurbel.declared.unit_systems import SI, convert, shown_unit
from kurbel.designs.find import Solutions
from kurbel.designs.study import Design
from kurbel.render.data import FORMAT
from kurbel.report.picture import Axis, Curve, Mark, PageFigure, Panel, Picture, Words
from kurbel.report.picture_source import in_units, level


def columns(found: Solutions, system: str) -> list[tuple[str, str, str]]:
    """Return name, unit and kind of each column: the keys in the units of their ranges, and the key values."""
    keys = [(one.key, one.unit, one.kind) for one in found.varied]
    largest = [max(map(abs, values)) for values in zip(*(one.key_values for one in found.found))]
    sized = zip(found.heads, largest)
    return [*keys, *((one.id, shown_unit(one.kind, system, size), one.kind) for one, size in sized)]


def as_rows(found: Solutions, system: str) -> list[Design]:
    """Return a row for each solution, in the order and the units of the columns."""
    units = [(kind, unit) for _, unit, kind in columns(found, system)]
    return [
        Design(number, tuple(float(convert(value, *of)) for value, of in zip((*one.values, *one.key_values), units)))
        for number, one in enumerate(found.found, 1)
    ]


def as_json(found: Solutions) -> dict[str, object]:
    """Return the findings for JSON, all in SI."""
    quantities = [one.quantity for one in found.answers]
    answers = [{"id": one.id, "symbol": of.symbol, "unit": one.unit} for one, of in zip(found.heads, quantities)]
    ranges = [list(span) for span in found.met]
    return {
        "kurbel": kurbel.__version__,
        "format": FORMAT,
        "command": "find",
        "machine": found.machine,
        "varied": [{"key": one.key, "low": one.low, "high": one.high, "unit": SI[one.kind]} for one in found.varied],
        "wanted": [
            {"id": one.head.id, "unit": one.head.unit, "aim": one.aim, "value": one.value} for one in found.wanted
        ],
        "found": [
            {
                "values": list(one.values),
                "key_values": [{**answer, "value": value} for answer, value in zip(answers, one.key_values)],
                "notes": list(one.notes),
            }
            for one in found.found
        ],
        "range": ranges[0] if len(ranges) == 1 else ranges,
        "jumps": [list(one.values) for one in found.jumps],
        "failed": [{"low": one.low, "high": one.high, "failure": one.why} for one in found.failed],
    }


def picture(found: Solutions, system: str) -> Picture:
    """Return the wanted key value over the only key, with the solutions, and gaps at jumps and where designs fail."""
    key, wanted = found.varied[0], found.wanted[0]
    places, values = found.places[:, 0], found.values[:, wanted.place]
    # one nan at a jump, two for a design that fails
    places, values = (np.repeat(one, 1 + np.isnan(values)) for one in (places, values))
    jumps = np.searchsorted(places, [one.values[0] for one in found.jumps])
    x, y = np.insert(places, jumps, np.nan), np.insert(values, jumps, np.nan)
    x = np.where(np.isnan(y), np.nan, x)
    quantity = found.answers[wanted.place].quantity
    symbol = Words(quantity.symbol, quantity.ascii_symbol)
    curves = [Curve(symbol, x, y)]
    if wanted.value is not None:
        curves.append(level(x, wanted.value, Words(wanted.text)))
    name = Words(key.key.rpartition(".")[2])
    marks = tuple(
        Mark(one.values[0], one.key_values[wanted.place], PageFigure(name, one.values[0], kind=key.kind))
        for one in found.found
    )
    across, up = Axis(Words(key.key), key.kind, low=key.low, high=key.high), Axis(symbol, wanted.head.kind)
    panel = in_units(Panel(across, up, tuple(curves), marks=marks), system)
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
