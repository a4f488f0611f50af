"""Whatever stands in a file, the reader gives a machine with finite numbers or a KurbelError."""

import math
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from good_machines import ALL
from kurbel.errors import KurbelError, MachineFileError
from kurbel.machine import Machine
from kurbel.machine_file import reader, source

SETTINGS = settings(max_examples=3 * settings.default.max_examples)
INFINITE_BY_WORD = {"rod", "link"}  # `rod: infinite`
VALUES = "~ null true NO 1e400 .nan .inf -1 0 1:30 010 1_000 0,5 1e308 1e-320 1e200 {} [] '' infinite mirrored 1/0 5"
SIGNS = '&a *a !!str !x <<: ? - : , { } [ ] | > % @ ` # --- ... " \t \x00 \x85 \u2028 é 🚂 \ud7ff'
SNIPPETS = [
    *VALUES.split(" "),
    *SIGNS.split(" "),
    *[
        "0 mm",
        "1e308 km",
        "-1e308 km",
        "1e-320 mm",
        "1 kg",
        "5 at",
        "[[0, 1]]",
        "[[0, 1e308], [1, 2]]",
        "[0,5, 1,5]",
    ],
    *["\ncrank: 1 m\n", "\n  bore: 1 mm\n", "\ncylinders:\n  - {}\n", "\nmechanism: four-bar\n"],
    *[
        "\ncycle: four-stroke\n",
        "\nmechanism: slotted-lever\n",
        "\nload: {slip: 1e-320}\n",
        "\noffset: 1e300 m\n",
    ],
    "\nmasses: {piston: [1e308 kg, 1e308 kg]}\n",
]


def read(content: bytes) -> Machine | None:
    try:
        machine = reader.read_machine(source.decode("fuzz.yaml", content))
    except MachineFileError as error:
        check_error(error)
        return None
    except KurbelError:
        return None
    check_finite(machine, "machine")
    return machine


def check_error(error: MachineFileError) -> None:
    """One printable line for every fault, in the order of the file."""
    lines = str(error).split("\n")
    assert len(lines) == len(error.faults) > 0
    assert all(line.isprintable() for line in (*lines, *error.pretty().split("\n")))
    places = [(fault.line, fault.column) for fault in error.faults]
    assert places == sorted(places)
    assert min(places) >= (1, 1)


def check_finite(value: Any, name: str) -> None:
    """Walk through every record and number of a machine."""
    if isinstance(value, float):
        assert math.isfinite(value) or (name in INFINITE_BY_WORD and value == math.inf), name
    elif isinstance(value, (tuple, list)):
        for item in value:
            check_finite(item, name)
    elif hasattr(value, "__dict__"):
        for inner, item in vars(value).items():
            check_finite(item, inner)


@SETTINGS
@given(st.binary(max_size=400))
def test_random_bytes(content: bytes) -> None:
    read(content)


@SETTINGS
@given(st.data())
def test_mutated_machines(data: st.DataObject) -> None:
    text = data.draw(st.sampled_from(list(ALL.values())))
    for _ in range(data.draw(st.integers(1, 4))):
        start = data.draw(st.integers(0, len(text)))
        length = data.draw(st.sampled_from([0, 1, 2, 5, 20, 80]))
        text = text[:start] + data.draw(st.sampled_from(SNIPPETS)) + text[start + length :]
    read(text.encode())


@SETTINGS
@given(st.data())
def test_other_values_for_keys(data: st.DataObject) -> None:
    """Swap whole values: the shape stays YAML, what stands under the keys does not stay sensible."""
    text = data.draw(st.sampled_from(list(ALL.values())))
    lines = text.splitlines()
    for _ in range(data.draw(st.integers(1, 3))):
        index = data.draw(st.integers(0, len(lines) - 1))
        key, colon, _ = lines[index].partition(":")
        lines[index] = f"{key}{colon} {data.draw(st.sampled_from(SNIPPETS))}"
    read("\n".join(lines).encode())


NUMBERS = st.one_of(
    st.floats(allow_nan=False, allow_infinity=False),
    st.sampled_from([0.0, 5e-324, 1e-300, 1e150, 1e308]),
)


@SETTINGS
@given(
    NUMBERS,
    NUMBERS,
    NUMBERS,
    st.sampled_from(["rod", "rod_ratio"]),
    st.sampled_from(["crank", "stroke"]),
)
def test_extreme_lengths(
    crank: float, rod: float, offset: float, rod_key: str, crank_key: str
) -> None:
    unit = " m" if rod_key == "rod" else ""
    read(f"{crank_key}: {crank!r} m\n{rod_key}: {rod!r}{unit}\noffset: {offset!r} m\n".encode())


@pytest.mark.parametrize("size", [100_000])
@pytest.mark.parametrize(
    "sign",
    [
        "[",
        "{",
        "- ",
        "? ",
        "a: ",
        "'",
        '"',
        "&a ",
        "*a ",
        "!",
        "a:\n",
        "[],",
        "#",
        "%",
        "\t",
        "|\n",
    ],
)
def test_no_sign_repeated_is_a_fault_of_kurbel(sign: str, size: int) -> None:
    read((sign * (size // len(sign))).encode())
