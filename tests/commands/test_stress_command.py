"""`kurbel stress` and what `kurbel check` says of a crankshaft, as a user calls them."""

import csv
import io
import json
import math

import pytest

from command import run
from representative import CONFIGS

ENGINE = CONFIGS["gas-engine"].read_text("utf-8")
PLACES = [
    *(("pin", place) for place in ("middle", "at_web_A", "at_web_B")),
    *(
        (web, place)
        for web in ("web_A", "web_B")
        for place in ("wide_face", "narrow_face", "corner")
    ),
    *(("journal_A", "at_web"), ("journal_B", "at_web"), ("journal_B", "in_bearing")),
]


def test_csv_over_the_crank_angle_and_by_place() -> None:
    rows = list(
        csv.DictReader(
            io.StringIO(run("stress", "-", "-f", "csv", "--angles", "0,35", text=ENGINE).stdout)
        )
    )
    assert [row["phi_deg"] for row in rows] == ["0", "35"]
    pull = 0.6 * 260 * 0.3 * (200 * math.pi / 30) ** 2  # of the connecting rod's turning part
    assert float(rows[0]["D_N"]) - pull == pytest.approx(float(rows[0]["A_D_N"]) * 2, rel=1e-12)
    rows = list(
        csv.DictReader(io.StringIO(run("stress", "-", "--places", "-f", "csv", text=ENGINE).stdout))
    )
    assert [(row["part"], row["place"]) for row in rows] == PLACES * 3
    assert rows[0]["compression_Pa"] == ""
    assert float(rows[3]["torsion_Pa"]) > 0


def test_key_values_by_name_are_those_of_throws() -> None:
    """The parts have one name, whether all is printed or single key values are."""
    engine = str(CONFIGS["four-throws"])
    whole = json.loads(run("stress", engine, "-f", "json").stdout)
    chosen = json.loads(
        run("stress", engine, "-f", "json", "--key-values", "safety_pin_min").stdout
    )
    names = [throw["name"] for throw in whole["throws"]]
    assert [throw["name"] for throw in chosen["throws"]] == names
    assert "cylinders" not in chosen
