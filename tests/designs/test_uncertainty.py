"""Standard uncertainties: against closed derivatives, and against a large sample."""

import json
from pathlib import Path
from statistics import NormalDist
from typing import Any

import mpmath as mp
import numpy as np
import pytest

import kurbel
from command import run
from kurbel.designs.answers import Answer
from kurbel.designs.uncertainty import Uncertain, given_uncertainty, uncertainties
from kurbel.quantities import every_quantity
from representative import CONFIGS

WATERWORKS = CONFIGS["waterworks"]


def of(spreads: dict[str, str], *ids: str, command: str = "forces") -> dict[str, Uncertain]:
    known = every_quantity().key_values(command)
    words = [
        Answer(known[id], command, "cylinder 1" if command == "forces" else "whole machine")
        for id in ids
    ]
    inputs = given_uncertainty(kurbel.load(WATERWORKS), [*spreads.items()])
    assert inputs
    result = uncertainties(inputs, words)
    return {one.answer.quantity.id: one for one in result}


def test_first_order_is_that_of_closed_formulas() -> None:
    """c_m = 2 s n; b_max = R ω² (1 + λ): relative uncertainties 2 of n, and λ/(1 + λ) of L/R."""
    result = of({"speed": "1 %", "rod_ratio": "2 %"}, "c_m", "b_max", "A_head")
    assert result["c_m"].spread == pytest.approx(0.01 * result["c_m"].value, rel=1e-9)
    assert result["c_m"].shares == pytest.approx((1, 0), abs=1e-15)
    by_speed, by_ratio = 2 * 0.01, 0.2 / 1.2 * 0.02
    size = np.hypot(by_speed, by_ratio)
    assert result["b_max"].spread == pytest.approx(size * result["b_max"].value, rel=1e-8)
    assert result["b_max"].shares == pytest.approx(
        ((by_speed / size) ** 2, (by_ratio / size) ** 2), rel=1e-7
    )
    assert result["A_head"].spread <= 1e-15
    assert all(one.sample == 0 for one in result.values())


def test_a_point_of_a_card_may_be_off() -> None:
    """A_i = s (A_H + A_C) ∮ p df: the line between f = 0.35 and 0.7 is drawn over its point at 0.5 on both sides."""
    result = of({"indicator.head_end.expansion.2.1": "0.1"}, "work", "A_head", "A_crank")
    areas = result["A_head"].value + result["A_crank"].value
    assert result["work"].spread == pytest.approx(
        0.1 * 98066.5 * (0.7 - 0.35) / 2 * 0.8 * areas, rel=1e-8
    )


def test_drawn_machines_that_fail_are_reported() -> None:
    """Of bores of 450 ± 900 mm 35 % are thinner than the rod."""
    (one,) = of({"bore": "200 %"}, "A_head").values()
    lost = 2000 - one.sample
    assert lost == pytest.approx(2000 * NormalDist(450, 900).cdf(100), abs=1)
    assert one.failed.startswith(f"{lost} of 2000 sampled machines fail and are ignored (bore: -")


def test_what_bends_is_known_by_a_sample() -> None:
    """c_max with L/R = 5 ± 0.8 is far from straight; the spread is that of a sample drawn otherwise."""
    (one,) = of({"rod_ratio": "0.8"}, "c_max").values()
    assert one.sample > 1000
    ratios = np.random.default_rng(4).normal(5, 0.8, 600)
    machine = kurbel.load(WATERWORKS)
    drawn = kurbel.sweep(machine, {"rod_ratio": ratios[ratios > 1.01]}, ["c_max"])["c_max"]
    assert one.spread == pytest.approx(np.nanstd(drawn), rel=0.15)


def test_forces_and_flywheel_report_it_with_their_key_values(tmp_path: Path) -> None:
    text = (
        WATERWORKS.read_text(encoding="utf-8")
    ) + 'uncertainty: {speed: "± 1 %", bore: ± 0.2 mm}\n'
    file = tmp_path / "m.yaml"
    file.write_text(text, encoding="utf-8")
    for name, id, part in (
        ("forces", "T_max", "cylinders"),
        ("flywheel", "dE", "machine_place_tables"),
    ):
        result = run(name, file, "--key-values", "-f", "json")
        assert result.exit_code == 0, result.output
        reported = json.loads(result.stdout)
        tables = (
            reported[part] if part == "machine_place_tables" else reported[part][0]["place_tables"]
        )
        (table,) = tables
        assert any(id in str(row) for row in table["rows"])
    page = run("forces", file, "--key-values").stdout
    assert "Standard uncertainty, and the share of each input in its square" in page
    assert "speed" in page


@pytest.mark.parametrize("share", [1e-5, 1e-3, 0.02, 0.05])
def test_differences_are_as_good_as_exact_derivatives(share: float) -> None:
    """Of c_max by L/R against thirty digits: u has eight of them from uncertainties of 1e-5 of the value to 5 %."""
    with mp.workdps(30):
        ratio = mp.mpf(5)

        def slope(length: Any, phi: Any) -> Any:
            return mp.diff(lambda p: mp.cos(p) + mp.sqrt(length**2 - mp.sin(p) ** 2), phi)

        place = mp.findroot(lambda phi: mp.diff(lambda p: slope(ratio, p), phi), mp.radians(79))
        by_ratio = mp.diff(
            lambda length: slope(length, place), ratio
        )  # where x′ is largest its place does not count
        exact = float(abs(by_ratio / slope(ratio, place)) * ratio * mp.mpf(share))
    (one,) = of({"rod_ratio": f"{100 * share!r} %"}, "c_max").values()
    assert one.sample == 0
    assert one.spread / one.value == pytest.approx(exact, rel=1e-8)
