"""The output of `kurbel find`: rows, JSON, and remarks on jumps, failing designs and bounds."""

import numpy as np

import kurbel
from kurbel.declared.unit_systems import SI, convert, shown_unit
from kurbel.designs.find import Solutions
from kurbel.designs.sweep import Design
from kurbel.render.data import FORMAT
from kurbel.report.picture import Axis, Curve, Mark, PageFigure, Panel, Picture, Words
from kurbel.report.picture_source import in_units, level


def columns(found: Solutions, system: str) -> list[tuple[str, str, str]]:
    """Return name, unit and kind of each column: the keys in the units of their ranges, and the key values."""
    keys = [(one.key, one.unit, one.kind) for one in found.varied]
    largest = np.max(np.abs([one.key_values for one in found.found]), axis=0)
    answers = zip(found.names, (one.kind for one in found.answers), largest.tolist())
    return [*keys, *((name, shown_unit(kind, system, size), kind) for name, kind, size in answers)]


def as_rows(found: Solutions, system: str) -> list[Design]:
    """Return a row for each solution, in the order and the units of the columns."""
    units = [(kind, unit) for _, unit, kind in columns(found, system)]
    return [
        Design(number, tuple(float(convert(value, *of)) for value, of in zip((*one.values, *one.key_values), units)))
        for number, one in enumerate(found.found, 1)
    ]


def as_json(found: Solutions) -> dict[str, object]:
    """Return the findings for JSON, all in SI."""

    answers = [
        {"id": name, "symbol": one.quantity.symbol, "unit": SI[one.kind]}
        for name, one in zip(found.names, found.answers)
    ]
    wanted = zip(found.names, found.wanted)
    ranges = [list(span) for span in found.met]
    return {
        "kurbel": kurbel.__version__,
        "format": FORMAT,
        "command": "find",
        "machine": found.machine,
        "varied": [{"key": one.key, "low": one.low, "high": one.high, "unit": SI[one.kind]} for one in found.varied],
        "wanted": [{"id": id, "unit": SI[one.answer.kind], "aim": one.aim, "value": one.value} for id, one in wanted],
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
    places, values = found.places[:, 0], found.values[:, 0]
    # one nan at a jump, two for a design that fails
    places, values = (np.repeat(one, 1 + np.isnan(values)) for one in (places, values))
    jumps = np.searchsorted(places, [one.values[0] for one in found.jumps])
    x, y = np.insert(places, jumps, np.nan), np.insert(values, jumps, np.nan)
    x = np.where(np.isnan(y), np.nan, x)
    symbol = Words(wanted.answer.quantity.symbol, wanted.answer.quantity.ascii_symbol)
    curves = [Curve(symbol, x, y)]
    if wanted.value is not None:
        curves.append(level(x, wanted.value, Words(wanted.text.strip())))
    name = Words(key.key.rpartition(".")[2])
    marks = [Mark(at, one.key_values[0], PageFigure(name, at), True) for one in found.found for at in one.values]
    across, up = Axis(Words(key.key), key.kind, low=key.low, high=key.high), Axis(symbol, wanted.answer.kind)
    panel = in_units(Panel(across, up, tuple(curves), marks=tuple(marks)), system)
    text = "The key value over the key; marked where it is as wanted, parted where it jumps or designs fail."
    return Picture("find", f"{found.names[0]} over {key.key}", text, (panel,), found.machine)


def remarks(found: Solutions) -> list[str]:
    """Return the remarks on the solutions, a line each."""
    key = found.varied[0]
    lines = [f"solution {number}: {note}" for number, one in enumerate(found.found, 1) for note in one.notes]
    for one in found.jumps:
        place = f"{key.key} = {key.in_unit(one.values[0]):.9g} {key.unit}".rstrip()
        lines.append(f"{found.wanted[0].text.strip()}: passed by a jump at {place}")
    for part in found.failed:
        ends = [f"{key.in_unit(end):.6g}" for end in (part.low, part.high)]
        where = f"at {ends[0]}" if ends[0] == ends[1] else f"from {ends[0]} to {ends[1]}"
        lines.append(f"{key.key} {where} {key.unit}".rstrip() + f": designs fail: {part.why}")
    return lines
