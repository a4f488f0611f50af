"""Engines as they are built: the figures of ten machines, by calculations that are independent of kurbel."""

import inspect
import textwrap
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml

from command import answer
from kurbel.machine import Machine
from kurbel.machine.cylinder import crank_lag, pin_lag
from kurbel.machine.firing import firings
from kurbel.machine.several import intervals
from kurbel.machine_file import loads

LATER = ("radial-9", "v-link", "wobbler", "opposed", "vr-pins", "v6-odd-fire", "v6-split", "w9")
"""Machines with keys that kurbel does not have yet."""
MACHINES: dict[str, dict[str, Any]] = {}
for document in yaml.safe_load_all(
    Path(__file__).with_name("engine_layouts.yaml").read_text(encoding="utf-8")
):
    if document["id"] not in LATER:
        MACHINES[document["id"]] = document
FIGURES = [(id, figure) for id, document in MACHINES.items() for figure in document["figures"]]


def named(figure: tuple[str, dict[str, Any]]) -> str:
    """Return what identifies a figure in the output of pytest."""
    id, what = figure
    words = [str(value) for key, value in what.items() if key not in ("value", "at", "intervals")]
    return "-".join((id, *words)).replace(" ", "_")


def pins_behind(machine: Machine) -> list[float]:
    """Return by how much the pins lag that of cylinder 1, from 0° to 360°."""
    first = machine.cylinders[0]
    return [pin_lag(cylinder, first) % 360.0 for cylinder in machine.cylinders]


def rows_of(printed: dict[str, Any], figure: dict[str, Any]) -> dict[str, Any]:
    """Return the part of a JSON answer that a figure is about."""
    name = figure.get("cylinder") or figure.get("bearing")
    parts = [*printed.get("cylinders", ()), *printed.get("bearings", ())]
    for part in parts:
        if name is not None and part["name"] == name:
            return part
    if name == "cylinder 1" or (name is None and len(parts) == 1):
        return parts[0]
    assert name is None, f"no part is called {name}"
    return {
        "columns": printed.get("machine_columns"),
        "key_values": printed.get("machine_key_values"),
    }


def column(columns: list[dict[str, Any]], id: str) -> list[Any]:
    """Return the values of a column."""
    return next(one["values"] for one in columns if one["id"] == id)


def is_figure(text: str, figure: dict[str, Any], path: Path) -> None:
    """Assert that kurbel gives this figure of a machine file."""
    path.write_text(text, encoding="utf-8")
    if figure["ask"] == "check":
        machine = loads(text)
        if figure["what"] == "firing":
            found = firings(machine)
            angles = [angle for angle, _ in found]
            assert "-".join(str(number) for _, number in found) == figure["order"]
            assert angles == pytest.approx(figure["at"], rel=1e-9)
            assert intervals(angles, 720.0) == pytest.approx(figure["intervals"], rel=1e-9)
        else:
            assert pins_behind(machine) == pytest.approx(figure["value"], rel=1e-9, abs=1e-9)
        return
    words = figure["ask"].split()
    if "order" in figure:
        printed = answer(*words, path, "--orders")
        (table,) = (one for one in printed["machine_place_tables"] if one["id"] == "orders")
        row = column(table["columns"], "order").index(figure["order"])
        value = column(table["columns"], figure["component"])[row]
        assert value == pytest.approx(figure["value"], rel=1e-7, abs=1e-9)
    elif "column" in figure:
        printed = answer(*words, path, "--angles", figure["at_deg"])
        (value,) = column(rows_of(printed, figure)["columns"], figure["column"])
        assert value == pytest.approx(figure["value"], rel=1e-9)
    else:
        rows = rows_of(answer(*words, path), figure)["key_values"]
        (row,) = (one for one in rows if one["id"] == figure["key_value"])
        assert row["value"] == pytest.approx(figure["value"], rel=1e-9)
        if "at_deg" in figure:
            assert row["at_deg"] == pytest.approx(figure["at_deg"], abs=1e-3)


@pytest.mark.parametrize("of_machine", FIGURES, ids=named)
def test_figure_of_an_engine(of_machine: tuple[str, dict[str, Any]], tmp_path: Path) -> None:
    id, figure = of_machine
    is_figure(MACHINES[id]["machine"], figure, tmp_path / f"{id}.yaml")


SLIPS: tuple[tuple[str, Callable[..., Any], str, str], ...] = (
    ("vr-pair", crank_lag, "+ (first_inner - inner)", ""),
    ("vr-pair", crank_lag, "first_inner - inner", "inner - first_inner"),
)
"""Machine, function, its text and a wrong one."""


@pytest.mark.parametrize(("id", "function", "right", "wrong"), SLIPS)
def test_a_planted_slip_changes_a_figure(
    id: str,
    function: Callable[..., Any],
    right: str,
    wrong: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    source = textwrap.dedent(inspect.getsource(function))
    assert right in source, (
        f"{function.__name__} has no '{right}': plant the slip in it as it is now"
    )
    module = inspect.getmodule(function)
    spoilt: dict[str, Any] = {**vars(module)}
    lines = source.replace(right, wrong, 1)
    exec(lines[lines.index("def ") :], spoilt)
    monkeypatch.setattr(function, "__code__", spoilt[function.__name__].__code__)
    document = MACHINES[id]
    broken = 0
    for figure in document["figures"]:
        try:
            is_figure(document["machine"], figure, tmp_path / "machine.yaml")
        except AssertionError:
            broken += 1
    assert broken
