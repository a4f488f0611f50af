"""Imperial output is imperial throughout: tables, key values, verdicts, notes, subtitles, tiles and pictures."""

import html
import re

from command import run
from kurbel.declared.unit_systems import SYSTEMS
from kurbel.quantities import every_quantity
from representative import CONFIGS, law_of_each

METRIC = (
    r"mm|cm|dm|m|km|µm|um|mm²|cm²|m²|cm³|dm³|m³|l|kg|g|t|N|kN|MN|kgf|kp|bar|mbar|Pa|kPa|MPa|J|kJ|MJ|"
    r"W|kW|MW|PS|K|°C"
)
FIGURE = re.compile(rf"(?<![\w/.])[-−]?\d(?:[\d.,]*\d)?\s?({METRIC})(?![\w(=²³·])")


def test_units_of_all_quantities_are_imperial() -> None:
    quantities = every_quantity()
    shown = {quantity.kind for quantity in quantities.all_columns + quantities.all_key_values}
    for kind in sorted(shown):
        unit = SYSTEMS["imperial"][kind]
        assert isinstance(unit, str)
        words = re.split(r"[ /]", unit.replace("^2", "").replace("^3", ""))
        assert not any(re.fullmatch(METRIC, word) for word in words), (kind, unit)


WITH_NOTES = (
    "gas-engine",
    "compressor-two-stage",
    "locomotive-link",
    "marine-diesel",
    "waterworks",
    "diesel-trace",
    "mill-engine",
    "four-throws",
)


@law_of_each(WITH_NOTES)
def test_checks_have_no_metric_figure(name: str) -> None:
    result = run("check", CONFIGS[name], "--units", "imperial")
    assert result.exit_code == 0
    assert [match[0] for match in FIGURE.finditer(result.output)] == []


def readable(page: str) -> str:
    """Return the texts of a page, with those of its pictures, without the keys of the file, which are quoted."""
    page = re.sub(r"<style.*?</style>", "", page, flags=re.DOTALL)
    page = re.sub(r'<section id="input".*?</section>', "", page, flags=re.DOTALL)
    page = re.sub(r"</?(span|sub|sup|b|i|em|strong|a|code|tspan)\b[^>]*>", "", page)
    return html.unescape(re.sub(r"<[^>]+>", "\n", page))


def test_a_report_has_no_metric_figure() -> None:
    """Bearings with films, strength, balance, pictures, tiles, subtitle and limits."""
    result = run("report", CONFIGS["gas-engine"], "--units", "imperial", "--step", "90")
    assert result.exit_code == 0
    assert [match[0] for match in FIGURE.finditer(readable(result.output))] == []
