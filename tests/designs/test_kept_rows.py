"""`kurbel sweep --resume`: it goes on in the file of the same sweep only."""

import sys
from collections.abc import Sequence
from functools import cache
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from kurbel.cli import kurbel as command
from kurbel.designs import workers
from kurbel.designs.sweep import Design, Sweep
from kurbel.errors import KurbelError

CONFIGS = Path(__file__).parent.parent.parent / "configs"
ASKED = ("--vary", "rod_ratio=3:6:0.3", "--columns", "c_max,T_max")


@pytest.fixture
def machine(tmp_path: Path) -> Path:
    file = tmp_path / "engine.yaml"
    file.write_text((CONFIGS / "waterworks.yaml").read_text())
    return file


def run(machine: Path, *args: str) -> Result:
    return CliRunner().invoke(command, ["sweep", str(machine), *args])


@cache
def swept(text: str, args: tuple[str, ...]) -> list[str]:
    """Return the lines of a sweep of the machine in a text: they do not hang on the file that they are written to."""
    result = CliRunner().invoke(command, ["sweep", "-", *args], input=text)
    assert result.exit_code == 0
    return result.stdout.splitlines(keepends=True)


def interrupted(machine: Path, *args: str, rows: int = 6) -> Path:
    """Return a file with the first rows of a sweep."""
    file = machine.with_name("rows.json" if "json" in args else "rows.csv")
    file.write_text(
        "".join(swept(machine.read_text(), ("-f", file.suffix[1:], *args))[: rows + (file.suffix == ".csv")])
    )
    return file


@pytest.mark.parametrize("written", ["csv", "json"])
@pytest.mark.parametrize(
    ("others", "message"),
    [
        (("--set", "speed=60 rpm"), "row 6 has 2.1"),
        (("--vary", "rod_ratio=3:6:0.2"), "row 2 has 3.3 rod_ratio in it, and 3.2 now"),
        (("--vary", "rod_ratio=3:4:0.3"), "it has row 5, these are rows 1 to 4"),
        (("--vary", "rod_ratio=6:3:-0.3"), "row 1 has 3.0 rod_ratio in it, and 6.0 now"),
        (("--where", "rod_ratio > 7"), "which --where leaves out"),
        (("--shard", "2/2"), "it "),
        (("--columns", "c_max,N_max"), ""),
        (("--columns", "c_max"), ""),
    ],
)
def test_another_sweep_does_not_go_on(machine: Path, written: str, others: tuple[str, ...], message: str) -> None:
    file = interrupted(machine, *ASKED, "-f", written)
    before = file.read_bytes()
    asked = others if others[0] == "--vary" else ASKED[:2] + others
    asked += () if "--columns" in others else ASKED[2:]
    result = run(machine, *asked, "-f", written, "-o", str(file), "--resume")
    assert result.exit_code == 2
    assert f"--resume: {file} is not of this sweep: " in result.output
    assert message in result.output
    assert file.read_bytes() == before


def test_answers_are_compared_though_the_last_rows_have_none(machine: Path) -> None:
    asked = ("--vary", "rod_ratio=5,4,0.5,0.4,3", "--columns", "c_max")
    file = interrupted(machine, *asked, rows=4)
    assert "row 2 has" in run(machine, *asked, "--set", "speed=60 rpm", "-o", str(file), "--resume").output
    assert run(machine, *asked, "-o", str(file), "--resume").exit_code == 0
    assert len(file.read_text().splitlines()) == 6


def test_chosen_rows_go_on_where_they_end(machine: Path) -> None:
    asked = (*ASKED, "--where", "T_max < 88.5 kN")
    whole = interrupted(machine, *asked, rows=99).read_bytes()
    file = interrupted(machine, *asked, rows=2)
    assert run(machine, *asked, "-o", str(file), "--resume").exit_code == 0
    assert file.read_bytes() == whole
    file = interrupted(machine, *asked, rows=2)
    assert "is missing in it" in run(machine, *ASKED, "-o", str(file), "--resume").output


@pytest.mark.parametrize("content", ["something else", "a,b\n1,2\n", "row,rod_ratio,c_max_m/s,T_max_N,failure\n1,x\n"])
def test_a_file_of_something_else_stays(machine: Path, content: str) -> None:
    file = machine.with_name("rows.csv")
    file.write_text(content)
    result = run(machine, *ASKED, "-o", str(file), "--resume")
    assert (result.exit_code, file.read_text()) == (2, content)
    assert "is not of this sweep: it " in result.output


def test_last_digits_of_another_processor_are_no_other_sweep(machine: Path) -> None:
    file = interrupted(machine, *ASKED)
    text = file.read_text()
    last = text.splitlines()[-1].split(",")
    file.write_text(text.replace(last[3], repr(float(last[3]) * (1 + 3e-16))))
    assert run(machine, *ASKED, "-o", str(file), "--resume").exit_code == 0


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="is on Linux")
def test_a_device_without_an_end_has_no_rows(machine: Path) -> None:
    """It was read until no memory was left."""
    asked = ["sweep", str(machine), "--vary", "rod_ratio=3,4", "-f", "csv", "-o", "/dev/full", "--resume"]
    result = CliRunner().invoke(command, asked)
    assert (result.exit_code, "No space left on device" in result.output) == (2, True)


# what was there before


def files(folder: Path) -> dict[str, str]:
    return {path.name: path.read_text() for path in folder.iterdir() if path.suffix != ".yaml"}


@pytest.mark.parametrize("name", ["rows.csv", "rows.json", "rows.md", "rows.parquet"])
@pytest.mark.parametrize("refused", ["--dask=tcp://127.0.0.1:1", "--dask=tcp://no.such.node:1", "--set=stroke=-1 m"])
def test_what_cannot_begin_leaves_the_old_file(
    name: str, refused: str, machine: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(workers, "_ANSWERS_WITHIN", 0.5)
    if refused == "--dask=tcp://127.0.0.1:1":
        monkeypatch.setitem(sys.modules, "distributed", None)
    if name == "rows.parquet" and refused.startswith("--set"):
        monkeypatch.setitem(sys.modules, "pyarrow", None)
    machine.with_name(name).write_text("old")
    assert run(machine, *ASKED, refused, "-o", str(machine.with_name(name))).exit_code == 2
    assert files(machine.parent) == {name: "old"}


@pytest.fixture
def lost(monkeypatch: pytest.MonkeyPatch) -> None:
    """Sweeps that get no further than 20 rows."""

    def chunk(self: Sweep, company: range, wanted: range) -> Sequence[Design]:
        if wanted.start >= 20:
            raise KurbelError("a worker process was killed (SIGKILL)")
        return whole(self, company, wanted)

    whole = Sweep.chunk
    monkeypatch.setattr(Sweep, "chunk", chunk)


MANY = ("--vary", "rod_ratio=3:6:0.1", "--columns", "c_max")


@pytest.mark.usefixtures("lost")
def test_an_early_end_leaves_the_old_file_and_a_part(machine: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = "".join(swept(machine.read_text(), (*MANY[:1], "rod_ratio=3:4.9:0.1", *MANY[2:], "-f", "csv")))
    file, link = machine.with_name("rows.csv"), machine.with_name("link.csv")
    file.write_text("old")
    file.chmod(0o640)
    link.symlink_to(file)
    result = run(machine, *MANY, "-o", str(link))
    assert (result.exit_code, result.stderr) == (
        2,
        f"{file}.part holds 20 rows; run again with --resume to continue\n"
        "Error: a worker process was killed (SIGKILL)\n",
    )
    assert files(machine.parent) == {"rows.csv": "old", "link.csv": "old", "rows.csv.part": whole}
    assert "holds 20 rows" in run(machine, *MANY, "-o", str(link), "--resume").stderr
    monkeypatch.undo()
    assert run(machine, *MANY, "-o", str(link), "--resume").exit_code == 0
    whole = "".join(swept(machine.read_text(), (*MANY, "-f", "csv")))
    assert files(machine.parent) == {"rows.csv": whole, "link.csv": whole}
    assert (link.is_symlink(), file.stat().st_mode & 0o777) == (True, 0o640)


@pytest.mark.usefixtures("lost")
def test_what_an_early_end_leaves_of_other_formats(machine: Path) -> None:
    """They cannot go on; rows that are sorted are none before all are there."""
    for name, options, holds in (
        ("rows.md", (), "holds 20 rows\n"),
        ("rows.csv", ("--sort", "c_max"), ""),
        ("-", ("-f", "csv"), "20 rows written\n"),
    ):
        path = name if name == "-" else str(machine.with_name(name))
        result = run(machine, *MANY, *options, "-o", path)
        assert (result.exit_code, result.stderr.partition("Error")[0].endswith(holds)) == (2, True)
        assert "--resume" not in result.stderr
    assert set(files(machine.parent)) == {"rows.md.part"}


def test_a_part_of_another_sweep_does_not_go_on(machine: Path) -> None:
    file = interrupted(machine, *ASKED)
    part = file.rename(f"{file}.part")
    result = run(machine, *ASKED, "--set", "speed=60 rpm", "-o", str(file), "--resume")
    assert (result.exit_code, f"--resume: {part} is not of this sweep: row 6 has 2." in result.stderr) == (2, True)
    assert run(machine, *ASKED, "-o", str(file), "--resume").exit_code == 0
    assert files(machine.parent) == {"rows.csv": "".join(swept(machine.read_text(), (*ASKED, "-f", "csv")))}
