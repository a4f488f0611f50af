"""Rounding is another on every processor: what people read does not hang on it, json keeps it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from kurbel.machine_file import loads
from kurbel.quantities import every_quantity
from kurbel.quantity import by_id
from kurbel.render import Look
from kurbel.render.formats import render
from kurbel.report.check import checked
from kurbel.report.frame import shown_key_values
from kurbel.report.tables import Column, Part, Report
from kurbel.solver.case import Case

CONFIGS = Path(__file__).parents[2] / "configs"
KEY_VALUES = by_id(*every_quantity().all_key_values)
ROUNDING = (0.0, 5e-324, -8.568e-17, 9.99e-15)
LOOKS = (Look(), Look(layout="rows"), Look(digits=17), Look(comma=True), Look(encoding="ascii"), Look("markdown"))


def report(residual: float) -> Report:
    values = (("work", 12345.678), ("loss_crosshead", 0.0123), ("energy_residual", residual))
    phi = Column("phi", "φ", "phi", "deg", (0, 90))
    part = Part("one", (phi,), tuple(shown_key_values([(KEY_VALUES[name], value) for name, value in values], "si")))
    return Report("Forces", "forces", "Demo", "cylinders", (part,))


@pytest.mark.parametrize("look", LOOKS)
def test_no_page_hangs_on_rounding(look: Look) -> None:
    pages = {render(report(residual), look) for residual in ROUNDING}
    assert len(pages) == 1
    shown = "< 1e-14" if look.encoding == "ascii" else "\\< 10⁻¹⁴" if look.format == "markdown" else "< 10⁻¹⁴"
    assert shown in pages.pop()


@pytest.mark.parametrize("residual", ROUNDING)
def test_json_keeps_every_digit(residual: float) -> None:
    parsed = json.loads(render(report(residual), Look("json")))["cylinders"][0]["key_values"][-1]
    assert parsed == {"id": "energy_residual", "symbol": "ΔA/A", "unit": "", "value": residual}


def test_a_limit_is_not_compared_with_rounding_in_sight() -> None:
    limited = (CONFIGS / "waterworks.yaml").read_text(encoding="utf-8") + "limits: {energy_residual: 0.001}\n"
    (entry,) = next(s for s in checked(Case(loads(limited))).sections if s.title == "Limits").entries
    assert entry.text.startswith("< 1e-14 ≤ 0.001  kept")
