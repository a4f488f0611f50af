"""`kurbel sweep --resume`: it goes on in the file of the same sweep only."""

from collections.abc import Sequence
from functools import cache
from pathlib import Path

import pytest

from command import run
from kurbel.designs.answers import Design
from kurbel.designs.sweep import Sweep
from kurbel.errors import KurbelError
from representative import CONFIGS

SWEEP = ("--vary", "rod_ratio=3:6:0.3", "--columns", "c_max,T_max")


@pytest.fixture
def machine(tmp_path: Path) -> Path:
    file = tmp_path / "engine.yaml"
    file.write_text(CONFIGS["waterworks"].read_text())
    return file


@cache
def swept(text: str, args: tuple[str, ...]) -> list[str]:
    """Return the lines of a sweep of the machine in a text: they do not hang on the file that they are written to."""
    result = run("sweep", "-", *args, text=text)
    assert result.exit_code == 0
    return result.stdout.splitlines(keepends=True)


def interrupted(machine: Path, *args: str, rows: int = 6) -> Path:
    """Return a file with the first rows of a sweep."""
    file = machine.with_name("rows.json" if "json" in args else "rows.csv")
    file.write_text(
        "".join(
            swept(machine.read_text(), ("-f", file.suffix[1:], *args))[
                : rows + (file.suffix == ".csv")
            ]
        )
    )
    return file


@pytest.mark.parametrize("written", ["csv", "json"])
@pytest.mark.parametrize(
    ("others", "message"),
    [
        (("--set", "speed=60 rpm"), "row 6 has 2.1"),
        (("--vary", "rod_ratio=3:6:0.2"), "row 2 has 3.3 in it, and 3.2 now"),
        (("--vary", "rod_ratio=3:4:0.3"), "it has row 5, these are rows 1 to 4"),
        (("--vary", "rod_ratio=6:3:-0.3"), "row 1 has 3.0 in it, and 6.0 now"),
        (("--where", "rod_ratio > 7"), "which --where leaves out"),
        (("--shard", "2/2"), "it "),
        (("--columns", "c_max,N_max"), ""),
        (("--columns", "c_max"), ""),
    ],
)
def test_another_sweep_does_not_go_on(
    machine: Path, written: str, others: tuple[str, ...], message: str
) -> None:
    file = interrupted(machine, *SWEEP, "-f", written)
    before = file.read_bytes()
    words = others if others[0] == "--vary" else SWEEP[:2] + others
    words += () if "--columns" in others else SWEEP[2:]
    result = run("sweep", machine, *words, "-f", written, "-o", str(file), "--resume")
    assert result.exit_code == 2
    assert f"--resume: {file} is not of this sweep: " in result.output
    assert message in result.output
    assert file.read_bytes() == before


def test_chosen_rows_go_on_where_they_end(machine: Path) -> None:
    words = (*SWEEP, "--where", "T_max < 88.5 kN")
    whole = interrupted(machine, *words, rows=99).read_bytes()
    file = interrupted(machine, *words, rows=2)
    assert run("sweep", machine, *words, "-o", str(file), "--resume").exit_code == 0
    assert file.read_bytes() == whole
    file = interrupted(machine, *words, rows=2)
    assert "is missing in it" in run("sweep", machine, *SWEEP, "-o", str(file), "--resume").output


# what was there before


def files(folder: Path) -> dict[str, str]:
    return {path.name: path.read_text() for path in folder.iterdir() if path.suffix != ".yaml"}


@pytest.fixture
def lost(monkeypatch: pytest.MonkeyPatch) -> None:
    """Sweeps that get no further than 20 rows."""

    def block(self: Sweep, rows: range) -> Sequence[Design]:
        if rows.start >= 20:
            raise KurbelError("a worker process was killed (SIGKILL)")
        return whole(self, rows)

    whole = Sweep.block
    monkeypatch.setattr(Sweep, "block", block)


MANY = ("--vary", "rod_ratio=3:6:0.1", "--columns", "c_max")


@pytest.mark.usefixtures("lost")
def test_an_early_end_leaves_the_old_file_and_a_part(
    machine: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = "".join(
        swept(machine.read_text(), (*MANY[:1], "rod_ratio=3:4.9:0.1", *MANY[2:], "-f", "csv"))
    )
    file, link = machine.with_name("rows.csv"), machine.with_name("link.csv")
    file.write_text("old")
    file.chmod(0o640)
    link.symlink_to(file)
    result = run("sweep", machine, *MANY, "-o", str(link))
    assert (result.exit_code, result.stderr) == (
        2,
        f"{file}.part holds 20 rows; run again with --resume to continue\n"
        "Error: a worker process was killed (SIGKILL)\n",
    )
    assert files(machine.parent) == {"rows.csv": "old", "link.csv": "old", "rows.csv.part": whole}
    assert "holds 20 rows" in run("sweep", machine, *MANY, "-o", str(link), "--resume").stderr
    monkeypatch.undo()
    assert run("sweep", machine, *MANY, "-o", str(link), "--resume").exit_code == 0
    whole = "".join(swept(machine.read_text(), (*MANY, "-f", "csv")))
    assert files(machine.parent) == {"rows.csv": whole, "link.csv": whole}
    assert (link.is_symlink(), file.stat().st_mode & 0o777) == (True, 0o640)
