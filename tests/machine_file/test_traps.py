"""Traps of YAML 1.1 and of word processors: read as a person reads them, or refused."""

import io
import math
import re
import sys
from pathlib import Path

import pytest

from command import run
from kurbel.declared.numerals import parse_number
from kurbel.declared.units import parse_quantity
from kurbel.errors import MachineFileError, UnitError, UnreadableFileError
from kurbel.machine_file import load, loads
from kurbel.machine_file.source import SIZE_LIMIT, decode
from representative import law_of_each

NUMBERS = {
    "1e3": 1000.0,
    "1E1": 10.0,
    "12e-1": 1.2,
    "1.0e3": 1000.0,
    "1.0e+1": 10.0,
    "5.": 5.0,
    "infinite": math.inf,
}
NO_NUMBERS = {  # beside those of the bad files
    **dict.fromkeys(
        ("NO", "yes", "on", "0777", "0b11", "0o17", "1__0", "2024-13-45"), "expected a number"
    ),
    **dict.fromkeys(("1:30.5", "12:30:45"), "a ratio is written as one number"),
    **dict.fromkeys(("-.inf", "1e400", "nan", "inf", "9" * 5000), "rod_ratio: "),
}


@pytest.mark.parametrize("text", NUMBERS)
def test_numbers_are_those_of_yaml_1_2(text: str) -> None:
    mechanism = loads(f"crank: 1 m\nrod_ratio: {text}").cylinders[0].mechanism
    assert float(mechanism.rod) / mechanism.crank == NUMBERS[text]


def refused(text: str) -> str:
    with pytest.raises(MachineFileError) as caught:
        loads(text)
    return str(caught.value)


@pytest.mark.parametrize("text", NO_NUMBERS)
def test_what_yaml_1_1_takes_for_something_else_is_refused(text: str) -> None:
    assert NO_NUMBERS[text] in refused(f"crank: 1 m\nrod_ratio: {text}")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("on: 1\ncrank: 1 m\nrod_ratio: 5", "on: unknown key"),
        ("crank: 1e200 m\nrod_ratio: 1e200", "too large"),
        ("? {a: [1, 2]}\n: 5\ncrank: 1 m\nrod_ratio: 5", "a key must be a plain text"),
        # columns count characters, lines end where those of YAML do
        ("{name: äöüß, crank: 4, rod_ratio: 5}", "<text>:1:21: crank:"),
        ("name: a\x85crank: 1 m\u2028rod_ratio: x", "<text>:3:12: rod_ratio:"),
        ("name: a\x0cb\ncrank: 1", "<text>:1:8: the character U+000C"),
        ("\n".join(" " * i + "a:" for i in range(2000)), "nested deeper than 32"),
        ("name: \ud800\ncrank: 1 m", "no UTF-8"),
        ('{"name": "\\ud800", crank: 1 m, rod_ratio: 5}', "<text>:1:"),
        ('{"\\e[31m\\n": 1, crank: 1 m, rod_ratio: 5}', "<text>:1:2: \\u001b[31m : unknown key"),
    ],
)
def test_what_is_easily_mistaken_is_named(text: str, message: str) -> None:
    assert message in refused(text)


def test_json_is_a_machine_file_too() -> None:
    machine = loads('{"name": "J", "crank": "400 mm", "rod_ratio": 5, "speed": "50 rpm"}')
    assert (machine.name, machine.cylinders[0].mechanism.crank) == ("J", 0.4)


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-le", "utf-16-be", "latin-1"])
def test_other_encodings_are_named(encoding: str) -> None:
    place = (
        "m:2:15: byte 0xF6"
        if encoding == "latin-1"
        else "m:1:1: the file is UTF-16; save it as UTF-8"
    )
    with pytest.raises(MachineFileError, match=f"^{re.escape(place)}"):
        decode("m", "crank: 1 m\nname: Kurbelgröße".encode(encoding))
    assert decode("m", b"\xef\xbb\xbfcrank: 1 m").text == "crank: 1 m"


def test_what_cannot_be_read_is_named(tmp_path: Path) -> None:
    reasons = {
        "no/such.yaml": "there is no such file",
        str(tmp_path): "is a folder",
        "a\0b": "cannot be read",
    }
    for name, reason in reasons.items():
        with pytest.raises(UnreadableFileError, match=reason):
            load(name)
    with pytest.raises(UnreadableFileError, match="larger than 16 MiB"):
        decode("m.yaml", b"#" * (SIZE_LIMIT + 1))


def test_standard_input(monkeypatch: pytest.MonkeyPatch) -> None:
    for rod in ("300 mm", "2 m"):
        monkeypatch.setattr(
            sys, "stdin", io.TextIOWrapper(io.BytesIO(f"crank: 400 mm\nrod: {rod}\n".encode()))
        )
        if rod == "2 m":
            assert load("-").name == "machine"
            continue
        with pytest.raises(MachineFileError, match=r"^<stdin>:2:6: rod: 300 mm is shorter"):
            load("-")


# white space and signs that word processors put in the place of ours: read as what they look like, or refused

# all of Unicode's white space, none beyond its first plane, but the line ends of YAML and the signs that it refuses
SPACES = [
    c
    for c in re.findall(r"\s", "".join(map(chr, range(0x80, 0x10000))))
    if c not in "\x85\u2028\u2029"
]


@law_of_each(SPACES)
def test_any_white_space_is_a_space(space: str) -> None:
    text = (
        "crank: 400 mm\nrod_ratio: 5\nspeed: 50 rpm\nbore: 300 mm\n"
        "indicator:\n  head_end: {unit: kgf / cm2, expansion: [[0, 5], [1, 2]], compression: [[1, 1], [0, 1]]}\n"
    )
    odd = loads(text.replace(" ", space))
    assert repr(odd.cylinders[0].mechanism) == "SliderCrank(crank=0.4, rod=2.0)"
    assert odd.speed == 50 / 60
    head = odd.cylinders[0].pistons[0].indicator.head_end
    assert head.lines[0].pressures == (5 * 98066.5, 2 * 98066.5)


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
    "text",
    ["\u0665", "5\u00b2", "\u00bd", "1\u00d710", "\u2163", "4\u200b5", "\ufeff5\u2060", "5\u0301"],
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
def test_a_file_name_turns_no_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, case: str
) -> None:
    """What a file is called reaches the terminal and the report without a sign that turns the writing."""
    monkeypatch.chdir(tmp_path)
    Path(f"{TURNED}.yaml").write_text("speed: 60 rpm\ncrank: 400 mm\nrod: 2 m\n")
    Path(f"bad{TURNED}.yaml").write_text("crank: 400\n")
    result = run(*WORDS[case])
    assert result.stdout + result.stderr
    assert "\u202e" not in result.stdout + result.stderr
