"""`kurbel keys`, and what TAB completes."""

import pytest
from click.testing import CliRunner

from kurbel.cli import kurbel
from representative import CONFIGS


def completed(words: str) -> list[str]:
    """What bash is offered for a line that ends in an unfinished word."""
    environment = {
        "_KURBEL_COMPLETE": "bash_complete",
        "COMP_WORDS": words,
        "COMP_CWORD": str(len(words.split(" ")) - 1),
    }
    output = CliRunner().invoke(kurbel, [], env=environment, prog_name="kurbel").stdout
    return [line.partition(",")[2] for line in output.splitlines() if line]


@pytest.mark.parametrize(
    ("words", "some"),
    [
        ("kurbel fly", ["flywheel"]),
        ("kurbel example wat", ["waterworks", "waterworks-two-cranks"]),
        ("kurbel units press", ["pressure", "pressure_rise", "pressure_velocity"]),
        ("kurbel keys masses.connecting_rod.s", ["masses.connecting_rod.share"]),
        ("kurbel motion engine.yaml --columns x,theta_d", ["x,theta_dot", "x,theta_ddot"]),
        ("kurbel forces engine.yaml --set bo", ["bore="]),
        ("kurbel forces engine.yaml --set bore=4", []),
        ("kurbel forces engine.yaml --cylinder ", []),
        ("kurbel keys indicator.head_end.trace.sk", ["indicator.head_end.trace.skip_rows"]),
        (
            "kurbel forces engine.yaml --set masses.connecting_rod.s",
            ["masses.connecting_rod.share="],
        ),
        ("kurbel sweep engine.yaml --vary masses.cro", ["masses.crosshead="]),
        ("kurbel sweep engine.yaml --columns c_m,T_ma", ["c_m,T_max"]),
        ("kurbel sweep engine.yaml --sort T_mi", ["T_min"]),
        ("kurbel find engine.yaml --least T_ma", ["T_max"]),
        ("kurbel find engine.yaml T_mi", ["T_min"]),
    ],
)
def test_what_a_shell_completes(words: str, some: list[str]) -> None:
    assert completed(words) == some


def test_cylinders_are_completed_from_the_file(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(CONFIGS["waterworks"].parent)
    result = completed("kurbel forces four-cylinder-generator.yaml --cylinder ")
    assert result == [f"cylinder {i}" for i in (1, 2, 3, 4)]
