"""White space and signs that word processors put in the place of ours: read as what they look like, or refused."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from click.testing import CliRunner

from kurbel.cli import kurbel
from kurbel.declared.numerals import parse_number
from kurbel.declared.units import parse_quantity
from kurbel.errors import MachineFileError, UnitError
from kurbel.machine_file import loads
from representative import law_of_each

# all of Unicode's white space, none beyond its first plane, but the line ends of YAML and the signs that it refuses
SPACES = [c for c in re.findall(r"\s", "".join(map(chr, range(0x80, 0x10000)))) if c not in "\x85\u2028\u2029"]


@law_of_each(SPACES)
def test_any_white_space_is_a_space(space: str) -> None:
    text = (
        "crank: 400 mm\nrod_ratio: 5\nspeed: 50 rpm\nbore: 300 mm\n"
        "indicator:\n  head_end: {unit: kgf / cm2, expansion: [[0, 5], [1, 2]], compression: [[1, 1], [0, 1]]}\n"
    )
    odd = loads(text.replace(" ", space))
    assert repr(odd.cylinders[0].mechanism) == "SliderCrank(crank=0.4, rod=2.0)"
    assert odd.speed == 50 / 60
    head = odd.cylinders[0].pistons[0].indicator.head_end  # type: ignore[union-attr]
    assert head.lines[0].pressures == (5 * 98066.5, 2 * 98066.5)  # type: ignore[union-attr]


@pytest.mark.parametrize(
    ("text", "plain", "kind"),
    [
        ("\u22125 mm", "-5 mm", "length"),
        ("5e\u22123\u202fm", "5e-3 m", "length"),
        ("\uff15\uff10\u3000\uff4d\uff4d", "50 mm", "length"),
        ("\uff0d1\uff0e5 m", "-1.5 m", "length"),
        ("450\u00a0\u00b5m", "450 um", "length"),
        ("3 kgf\u2215cm\u00b2", "3 kgf/cm2", "pressure"),
        ("3 kg\u22c5m\u00b2", "3 kg m2", "inertia"),
        ("90\u00ba", "90 deg", "angle"),
    ],
)
def test_signs_that_look_like_ours(text: str, plain: str, kind: str) -> None:
    assert parse_quantity(text, kind) == parse_quantity(plain, kind)


@pytest.mark.parametrize(
    "text", ["\u0665", "5\u00b2", "\u00bd", "1\u00d710", "\u2163", "4\u200b5", "\ufeff5\u2060", "5\u0301"]
)
def test_what_may_mean_something_else_is_no_number(text: str) -> None:
    with pytest.raises(UnitError, match="expected a number"):
        parse_number(text)
    with pytest.raises(UnitError):
        parse_quantity(f"{text} mm", "length")
    with pytest.raises(MachineFileError, match=r"points\[0\]\[1\]"):
        loads(f"effort: {{unit: N m, points: [[0, {text}], [360, 1]]}}")


TURNED = "en\u202elmay.gine"
"""What a terminal shows as 'en' and the rest turned round: the sign turns the direction of writing."""
WORDS: dict[str, list[str]] = {
    "check": ["check", f"{TURNED}.yaml"],
    "check as json": ["check", f"{TURNED}.yaml", "-f", "json"],
    "forces as json": ["forces", f"{TURNED}.yaml", "-f", "json"],
    "report": ["report", f"{TURNED}.yaml"],
    "a fault in the file": ["forces", f"{TURNED}.yaml", "--set", "crank=5"],
    "a fault of the file": ["forces", f"bad{TURNED}.yaml"],
    "no such file": ["forces", f"no{TURNED}.yaml"],
    "no such format": ["forces", f"{TURNED}.yaml", "-o", f"{TURNED}.foo"],
}


@pytest.mark.parametrize("case", WORDS)
def test_a_file_name_turns_no_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, case: str) -> None:
    """What a file is called reaches the terminal and the report without a sign that turns the writing."""
    monkeypatch.chdir(tmp_path)
    Path(f"{TURNED}.yaml").write_text("speed: 60 rpm\ncrank: 400 mm\nrod: 2 m\n")
    Path(f"bad{TURNED}.yaml").write_text("crank: 400\n")
    result = CliRunner().invoke(kurbel, WORDS[case])
    assert result.stdout + result.stderr
    assert "\u202e" not in result.stdout + result.stderr
