"""Worked examples of books and pages: which output of kurbel has each figure of their table, and its value.

`examples/answers.yaml` is the table; its head explains the entries. The test of the examples and the page of validation
both read it here.
"""

import math
import re
from functools import cache
from pathlib import Path
from typing import Any

import yaml

from command import answer as answer_of

FOLDER = Path(__file__).parent / "examples"
TABLE: dict[str, list[dict[str, Any]]] = yaml.load(
    (FOLDER / "answers.yaml").read_text(encoding="utf-8"),
    getattr(yaml, "CSafeLoader", yaml.SafeLoader),
)
ROWS = [{"file": example, **row} for example, rows in TABLE.items() for row in rows]
COMPUTED = [row for row in ROWS if "ask" in row]
FILES = sorted(path.stem for path in FOLDER.glob("*.yaml") if path.stem != "answers")
POUND, POUND_FORCE, FOOT = 0.45359237, 4.4482216152605, 0.3048
SI = {
    **dict.fromkeys(
        ("", "deg", "m", "m/s", "m/s2", "rad/s", "rad/s2", "kg", "kg m2", "N", "N m", "Pa", "Hz"),
        1.0,
    ),
    **dict.fromkeys(("rpm", "per min"), 1 / 60),
    **{
        "mm": 1e-3,
        "cm": 1e-2,
        "in/s": FOOT / 12,
        "kN": 1e3,
        "kW": 1e3,
        "percent": 1e-2,
        "cm3": 1e-6,
    },
    **{"lb": POUND, "lbf": POUND_FORCE, "lb ft2": POUND * FOOT**2, "ton": 2240 * POUND},
    **{"hp": 550 * FOOT * POUND_FORCE, "PS": 735.49875},
}
QUESTION = re.compile(
    r"(?P<command>\w+) (?:(?P<table>\w+)\.)?(?P<id>\w+)(?:\[(?P<nth>\d)\])?(?:\[(?P<rows>\w+=.+)\])?"
    r"(?:(?P<at>@)(?P<angle>\d*))?(?: where (?P<where>.+))?"
)


def question(row: dict[str, Any]) -> dict[str, str | None]:
    result = QUESTION.fullmatch(row["ask"])
    assert result, row["ask"]
    return result.groupdict()


@cache
def answer(file: str, command: str, where: str | None) -> dict[str, Any]:
    """Run the command once for all the crank angles that the table takes from this file, or where a column has a value."""
    request = [question(row) for row in COMPUTED if row["file"] == file]
    request = [one for one in request if (one["command"], one["where"]) == (command, where)]
    angles = sorted({one["angle"] for one in request if one["angle"]}, key=int) or ["0"]
    columns = {str(one["id"]): "" for one in request if one["angle"] or where}
    arguments = [command, str(FOLDER / f"{file}.yaml")]
    if any(one["rows"] for one in request):
        return answer_of(*arguments)
    arguments += ["--where", where] if where else ["--angles", ",".join(angles)]
    arguments += ["--columns", ",".join(("phi", *columns))] if columns else []
    return answer_of(*arguments)


def of_table(parsed: dict[str, Any], request: dict[str, str | None]) -> list[float]:
    """Return the values of a column in the rows of a table of the whole machine where others have these values."""
    table = next(
        table for table in parsed["machine_place_tables"] if table["id"] == request["table"]
    )
    columns = {column["id"]: column["values"] for column in table["columns"]}
    rows = list(range(len(columns[str(request["id"])])))
    for condition in str(request["rows"]).split("; "):
        name, _, values = condition.partition("=")
        rows = [
            row for value in values.split(",") for row in rows if columns[name][row] == float(value)
        ]
    return [columns[str(request["id"])][row] for row in rows]


def printed_answer(row: dict[str, Any]) -> Any:
    """Return what kurbel answers, in SI units: a number or a list of them."""
    request = question(row)
    parsed = answer(row["file"], request["command"] or "", request["where"])
    if request["rows"]:
        return of_table(parsed, request)
    parts = [
        {key.removeprefix("machine_"): what for key, what in parsed.items()},
        *parsed.get("cylinders", ()),
    ]
    if request["table"]:
        table = next(
            place_table
            for part in parts
            for place_table in part.get("place_tables", ())
            if place_table["id"] == request["table"]
        )
        return next(column for column in table["columns"] if column["id"] == request["id"])[
            "values"
        ][int(request["nth"] or 0)]
    kind = "columns" if request["angle"] or request["where"] else "key_values"
    one = next(one for part in parts for one in part.get(kind, ()) if one["id"] == request["id"])
    if request["angle"]:
        at = next(one for part in parts for one in part.get(kind, ()) if one["id"] == "phi")[
            "values"
        ]
        return one["values"][at.index(float(request["angle"]))]
    if request["nth"]:
        return one["values" if request["where"] else "value"][int(request["nth"])]
    return one["at_deg" if request["at"] else "value"]


def expected(row: dict[str, Any]) -> tuple[Any, Any]:
    """Return what kurbel has to answer in SI units, and a unit of the last digit of the recalculation."""
    factor = SI[row["unit"]] * row.get("times", 1)
    figures = row.get("strict", row["exact"])
    figures = figures if isinstance(figures, list) else [figures]
    digits = 12 if "strict" in row else row.get("digits", 12)
    # nothing is to be nothing
    last = [
        10.0 ** (math.floor(math.log10(abs(figure))) + 1 - digits) if figure else 0.0
        for figure in figures
    ]
    return [factor * figure + row.get("plus", 0) for figure in figures], [
        abs(factor) * one for one in last
    ]
