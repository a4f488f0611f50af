"""The traps of YAML 1.1 and of PyYAML; what a person reads is what is meant, or it is refused."""

from __future__ import annotations

import io
import math
import re
import sys
from pathlib import Path

import pytest

from kurbel.errors import MachineFileError, UnreadableFileError
from kurbel.machine_file import load, loads
from kurbel.machine_file.source import SIZE_LIMIT, decode

NUMBERS = {"1e3": 1000.0, "1E1": 10.0, "12e-1": 1.2, "1.0e3": 1000.0, "1.0e+1": 10.0, "5.": 5.0, "infinite": math.inf}
NO_NUMBERS = {  # beside those of the bad files
    **dict.fromkeys(("NO", "yes", "on", "0777", "0b11", "0o17", "1__0", "2024-13-45"), "expected a number"),
    **dict.fromkeys(("1:30.5", "12:30:45"), "a ratio is written as one number"),
    **dict.fromkeys(("-.inf", "1e400", "nan", "inf", "9" * 5000), "rod_ratio: "),
}


@pytest.mark.parametrize("text", NUMBERS)
def test_numbers_are_those_of_yaml_1_2(text: str) -> None:
    mechanism = loads(f"crank: 1 m\nrod_ratio: {text}").cylinders[0].mechanism
    assert float(mechanism.rod) / mechanism.crank == NUMBERS[text]  # type: ignore[attr-defined]


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
    place = "m:2:15: byte 0xF6" if encoding == "latin-1" else "m:1:1: the file is UTF-16; save it as UTF-8"
    with pytest.raises(MachineFileError, match=f"^{re.escape(place)}"):
        decode("m", "crank: 1 m\nname: Kurbelgröße".encode(encoding))
    assert decode("m", b"\xef\xbb\xbfcrank: 1 m").text == "crank: 1 m"


def test_what_cannot_be_read_is_named(tmp_path: Path) -> None:
    reasons = {"no/such.yaml": "there is no such file", str(tmp_path): "is a folder", "a\0b": "cannot be read"}
    for name, reason in reasons.items():
        with pytest.raises(UnreadableFileError, match=reason):
            load(name)
    with pytest.raises(UnreadableFileError, match="larger than 16 MiB"):
        decode("m.yaml", b"#" * (SIZE_LIMIT + 1))


def test_standard_input(monkeypatch: pytest.MonkeyPatch) -> None:
    for rod in ("300 mm", "2 m"):
        monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(f"crank: 400 mm\nrod: {rod}\n".encode())))
        if rod == "2 m":
            assert load("-").name == "machine"
            continue
        with pytest.raises(MachineFileError, match=r"^<stdin>:2:6: rod: 300 mm is shorter"):
            load("-")
