"""The traps of YAML 1.1 and of PyYAML, one test each; what a person reads is what is meant, or it is refused."""

from __future__ import annotations

import math

import pytest

from kurbel.errors import MachineFileError, UnreadableFileError
from kurbel.machine import Machine
from kurbel.machine_file import load, loads
from kurbel.machine_file.source import SIZE_LIMIT, decode


def ratio(text: str) -> float:
    """Return L/R as it arrives for `rod_ratio: text`."""
    mechanism = loads(f"crank: 1 m\nrod_ratio: {text}").cylinders[0].mechanism
    return float(mechanism.rod) / mechanism.crank  # type: ignore[attr-defined]


def refused(text: str) -> str:
    with pytest.raises(MachineFileError) as caught:
        loads(text)
    return str(caught.value)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1e3", 1000.0),
        ("1E1", 10.0),
        ("12e-1", 1.2),
        ("1.0e3", 1000.0),
        ("1.5e2", 150.0),
        ("1.0e+1", 10.0),
        ("5.", 5.0),
    ],
)
def test_numbers_are_those_of_yaml_1_2(text: str, value: float) -> None:
    assert ratio(text) == value


@pytest.mark.parametrize("text", ["NO", "Off", "yes", "true", "on"])
def test_words_are_no_truth_values(text: str) -> None:
    assert f"got '{text}'" in refused(f"crank: 1 m\nrod_ratio: {text}")


def test_a_name_may_be_a_word_that_yaml_takes_for_a_truth_value() -> None:
    assert loads("name: NO\ncrank: 1 m\nrod_ratio: 5").name == "NO"


def test_on_is_a_key_like_any_other() -> None:
    assert "on: unknown key" in refused("on: 1\ncrank: 1 m\nrod_ratio: 5")


@pytest.mark.parametrize("text", ["1:30", "1:30.5", "12:30:45", "0:45"])
def test_no_base_sixty(text: str) -> None:
    assert "a ratio is written as one number" in refused(f"crank: 1 m\nrod_ratio: {text}")


@pytest.mark.parametrize("text", ["010", "0777", "0x1F", "0b11", "1_000", "1__0", "1_2_3", "0o17"])
def test_no_octal_hexadecimal_binary_or_underscores(text: str) -> None:
    assert f"expected a number, got '{text}'" in refused(f"crank: 1 m\nrod_ratio: {text}")


@pytest.mark.parametrize("text", ["2024-01-02", "2024-13-45"])
def test_no_dates(text: str) -> None:
    assert f"expected a number, got '{text}'" in refused(f"crank: 1 m\nrod_ratio: {text}")


def test_huge_integers_do_not_stop_the_reader() -> None:
    assert "rod_ratio: expected a number" in refused("crank: 1 m\nrod_ratio: " + "9" * 5000)


@pytest.mark.parametrize("text", ["~", "", "null"])
def test_nothing_is_a_missing_value(text: str) -> None:
    assert "a value is missing" in refused(f"crank: 1 m\nrod_ratio: {text}")


@pytest.mark.parametrize("text", [".inf", ".nan", "-.inf", "1e400", "nan", "inf"])
def test_numbers_are_finite(text: str) -> None:
    assert "rod_ratio" in refused(f"crank: 1 m\nrod_ratio: {text}")


def test_infinite_is_a_word() -> None:
    assert ratio("infinite") == math.inf


def test_products_that_overflow_are_refused_not_taken_for_infinite() -> None:
    assert "too large" in refused("crank: 1e200 m\nrod_ratio: 1e200")


def test_decimal_commas_do_not_double_a_list() -> None:
    text = "effort: {unit: N m, points: [[0, 1,5], [180, 2,3]]}"
    assert "write decimal points" in refused(text)


def test_missing_comma_in_a_pair() -> None:
    assert "write [0, 1.3]" in refused("effort: {unit: N m, points: [[0 1.3], [180, 2]]}")


def test_no_space_after_the_colon() -> None:
    assert "write 'bore: 450 mm'" in refused("crank: 1 m\nrod_ratio: 5\nbore:450 mm\n")


def test_a_key_twice_is_refused_at_its_second_place() -> None:
    assert refused("crank: 1 m\ncrank: 2 m\nrod_ratio: 5") == "<text>:2:1: crank: given twice; leave one of them out"


def test_one_and_quoted_one_are_the_same_key() -> None:
    assert "given twice" in refused("1: a\n'1': b")


def test_collections_as_keys_are_refused() -> None:
    assert "a key must be a plain text" in refused("? {a: [1, 2]}\n: 5\ncrank: 1 m\nrod_ratio: 5")


def test_tab_as_indentation() -> None:
    assert "indent with spaces" in refused("masses:\n\tpiston: 1 kg")


def test_byte_order_mark_is_fine() -> None:
    assert decode("m", b"\xef\xbb\xbfcrank: 1 m").text == "crank: 1 m"


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-le", "utf-16-be"])
def test_utf_16_is_named(encoding: str) -> None:
    with pytest.raises(MachineFileError, match="the file is UTF-16; save it as UTF-8"):
        decode("m", "crank: 1 m".encode(encoding))


def test_latin_1_has_line_and_column() -> None:
    with pytest.raises(MachineFileError) as caught:
        decode("m", "crank: 1 m\nname: Kurbelgröße".encode("latin-1"))
    assert str(caught.value).startswith("m:2:15: byte 0xF6")


def test_column_counts_characters_not_bytes() -> None:
    assert refused("{name: äöüß, crank: 4, rod_ratio: 5}").startswith("<text>:1:21: crank:")


def test_unusual_line_ends_count_as_yaml_counts_them() -> None:
    assert refused("name: a\x85crank: 1 m\u2028rod_ratio: x").startswith("<text>:3:12: rod_ratio:")


def test_form_feed_is_no_line_end() -> None:
    assert refused("name: a\x0cb\ncrank: 1").startswith("<text>:1:8: the character U+000C")


def test_deep_nesting_ends_at_once() -> None:
    assert "nested deeper than 32" in refused("crank: " + "[" * 200_000)


def test_deep_block_nesting_ends_at_once() -> None:
    assert "nested deeper than 32" in refused("\n".join(" " * i + "a:" for i in range(2000)))


def test_half_a_surrogate_pair_is_no_text() -> None:
    assert "no UTF-8" in refused("name: \ud800\ncrank: 1 m")


def test_an_escaped_surrogate_does_not_reach_the_machine() -> None:
    assert refused('{"name": "\\ud800", crank: 1 m, rod_ratio: 5}').startswith("<text>:1:")


def test_a_key_cannot_steer_the_terminal() -> None:
    assert refused('{"\\e[31m\\n": 1, crank: 1 m, rod_ratio: 5}').startswith("<text>:1:2: \\u001b[31m : unknown key")


def test_json_is_a_machine_file_too() -> None:
    machine = loads('{"name": "J", "crank": "400 mm", "rod_ratio": 5, "speed": "50 rpm"}')
    assert (machine.name, machine.cylinders[0].mechanism.crank) == ("J", 0.4)


def test_more_than_a_hundred_faults_end_the_reading() -> None:
    lines = refused("\n".join(f"key{i}: 1" for i in range(5000))).split("\n")
    assert len(lines) == 100
    assert lines[-1].endswith("(reading stopped after 100 faults)")


def test_size_is_limited(tmp_path: object) -> None:
    with pytest.raises(UnreadableFileError, match="larger than 16 MiB"):
        decode("m.yaml", b"#" * (SIZE_LIMIT + 1))


class TestFiles:
    def test_missing(self) -> None:
        with pytest.raises(UnreadableFileError, match="there is no such file"):
            load("no/such/machine.yaml")

    def test_folder(self, tmp_path: object) -> None:
        with pytest.raises(UnreadableFileError, match="is a folder"):
            load(str(tmp_path))

    def test_impossible_name(self) -> None:
        with pytest.raises(UnreadableFileError, match="cannot be read"):
            load("a\0b")

    def test_standard_input(self, monkeypatch: pytest.MonkeyPatch) -> None:
        import io
        import sys

        class Standard:
            buffer = io.BytesIO(b"crank: 400 mm\nrod: 300 mm\n")

        monkeypatch.setattr(sys, "stdin", Standard)
        with pytest.raises(MachineFileError, match=r"^<stdin>:2:6: rod: 300 mm is shorter"):
            load("-")

    def test_standard_input_makes_a_machine_called_machine(self, monkeypatch: pytest.MonkeyPatch) -> None:
        import io
        import sys

        class Standard:
            buffer = io.BytesIO(b"crank: 400 mm\nrod: 2 m\n")

        monkeypatch.setattr(sys, "stdin", Standard)
        machine = load("-")
        assert isinstance(machine, Machine)
        assert machine.name == "machine"
