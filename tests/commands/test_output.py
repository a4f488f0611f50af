"""Where results go: files that are replaced whole or not at all, never what is read; statuses whatever stderr does."""

import hashlib
import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from command import run
from kurbel.errors import UsageError
from kurbel.render.output import write_out
from kurbel.tables.tables import MOST_ROWS, check_rows, stepped
from representative import few

POSIX_ONLY = pytest.mark.skipif(os.name != "posix", reason="needs POSIX files and signals")
MACHINE = "speed: 60 rpm\ncrank: 400 mm\nrod: 2 m\nbore: 450 mm\n"
PRESSURE = "indicator: {head_end: {constant: {expansion: 5 bar, compression: 1 bar}}}\n"


# files that are read


def links(folder: Path) -> Iterator[str]:
    """Yield the names under which the file m.yaml of a folder may be written over."""
    machine = folder / "m.yaml"
    (folder / "soft.yaml").symlink_to(machine)
    (folder / "hard.yaml").hardlink_to(machine)
    yield from (
        str(machine),
        "m.yaml",
        "./m.yaml",
        f"../{folder.name}/m.yaml",
        "soft.yaml",
        "hard.yaml",
    )


@POSIX_ONLY
@pytest.mark.parametrize("command", ["motion", "forces", "flywheel"])
def test_the_machine_file_is_never_written_over(
    command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = MACHINE + PRESSURE
    (tmp_path / "m.yaml").write_text(text)
    monkeypatch.chdir(tmp_path)
    for name in links(tmp_path):
        result = run(command, "m.yaml", "-o", name)
        assert (result.exit_code, (tmp_path / "m.yaml").read_text()) == (2, text), name
        assert "would overwrite m.yaml, which is read" in result.stderr


def test_no_trace_that_is_read_is_written_over(tmp_path: Path) -> None:
    trace = "".join(f"{angle},{1 + angle / 720}\n" for angle in range(0, 361, 10))
    (tmp_path / "p.csv").write_text(trace)
    (tmp_path / "m.yaml").write_text(
        MACHINE + "indicator: {head_end: {trace: {file: p.csv, unit: bar}}}\n"
    )
    for command in ("forces", "accuracy"):
        result = run(command, tmp_path / "m.yaml", "-o", tmp_path / "p.csv")
        assert (result.exit_code, (tmp_path / "p.csv").read_text()) == (2, trace)
        assert "p.csv, which is read" in result.stderr


@POSIX_ONLY
def test_standard_input_is_a_file_that_is_read_too(tmp_path: Path) -> None:
    (tmp_path / "m.yaml").write_text(MACHINE)
    with open(tmp_path / "m.yaml", "rb") as machine:
        command = [sys.executable, "-m", "kurbel", "motion", "-", "-o", str(tmp_path / "m.yaml")]
        result = subprocess.run(command, stdin=machine, capture_output=True, check=False)
    assert (result.returncode, (tmp_path / "m.yaml").read_text()) == (2, MACHINE)
    assert b"would overwrite standard input" in result.stderr


# files that are written


def test_what_fails_half_way_leaves_the_old_file_and_nothing_next_to_it(tmp_path: Path) -> None:
    def interrupted() -> Iterator[str]:
        yield "half"
        raise KeyboardInterrupt

    (tmp_path / "out.csv").write_text("old")
    for name in ("out.csv", "new.csv"):
        with pytest.raises(KeyboardInterrupt):
            write_out(interrupted(), str(tmp_path / name))
    assert [(path.name, path.read_text()) for path in tmp_path.iterdir()] == [("out.csv", "old")]


@POSIX_ONLY
def test_a_full_disk_leaves_the_old_file_whole(tmp_path: Path) -> None:
    limited = (
        "import resource, signal, sys; signal.signal(signal.SIGXFSZ, signal.SIG_IGN); "
        "resource.setrlimit(resource.RLIMIT_FSIZE, (512, 512)); from kurbel.__main__ import main; main()"
    )
    (tmp_path / "out.csv").write_text("old")
    # -B: under such a limit Python would leave its compiled modules torn behind
    arguments = [
        sys.executable,
        "-B",
        "-c",
        limited,
        "table",
        "-f",
        "csv",
        "-o",
        str(tmp_path / "out.csv"),
    ]
    result = subprocess.run(arguments, capture_output=True, check=False)
    assert (result.returncode, b"cannot write" in result.stderr) == (2, True)
    assert [(path.name, path.read_text()) for path in tmp_path.iterdir()] == [("out.csv", "old")]


@POSIX_ONLY
def test_a_replaced_file_keeps_its_mode_and_a_link_stays_one(tmp_path: Path) -> None:
    target, link = tmp_path / "out.csv", tmp_path / "link.csv"
    target.write_text("old")
    target.chmod(0o640)
    link.symlink_to(target)
    write_out(("new",), str(link))
    assert (target.read_text(), target.stat().st_mode & 0o777, link.is_symlink()) == (
        "new",
        0o640,
        True,
    )


@pytest.mark.parametrize(
    ("name", "begin"),
    [("o.csv", "phi_deg"), ("o.JSON", "{"), ("o.md", "# "), ("o.txt", "m. Mot"), ("o", "m. Mot")],
)
def test_the_suffix_decides_the_format(name: str, begin: str, tmp_path: Path) -> None:
    (tmp_path / "m.yaml").write_text(MACHINE)
    for arguments in (["motion", str(tmp_path / "m.yaml")], ["table"]):
        result = run(*arguments, "-o", tmp_path / name)
        assert (result.exit_code, result.output) == (0, "")
        if arguments[0] == "motion":
            assert (
                (tmp_path / name)
                .read_text(encoding="utf-8")
                .lstrip("#*")
                .startswith(begin.lstrip("# "))
            )


def test_a_format_that_contradicts_the_suffix_is_refused(tmp_path: Path) -> None:
    result = run("table", "-f", "csv", "-o", tmp_path / "o.json")
    assert (result.exit_code, list(tmp_path.iterdir())) == (2, [])
    assert "--format csv contradicts the name" in result.stderr
    for name in ("o.txt", "o.csv"):
        assert run("table", "-f", "csv", "-o", tmp_path / name).exit_code == 0


# provenance


def test_json_names_what_it_was_made_from(tmp_path: Path) -> None:
    trace = "".join(f"{angle},{1 + angle / 720}\n" for angle in range(0, 361, 10))
    (tmp_path / "p.csv").write_text(trace)
    text = MACHINE + "indicator: {head_end: {trace: {file: p.csv, unit: bar}}}\n"
    (tmp_path / "m.yaml").write_text(text)
    inputs = [
        {"file": str(tmp_path / name), "sha256": hashlib.sha256(content.encode()).hexdigest()}
        for name, content in (("m.yaml", text), ("p.csv", trace))
    ]
    for command in ("motion", "forces", "check"):
        result = run(command, tmp_path / "m.yaml", "-f", "json")
        parsed = json.loads(result.stdout)
        assert parsed["inputs"] == inputs
        assert parsed["overrides"] == []
        assert parsed["versions"] == {"kurbel": parsed["kurbel"], "numpy": np.__version__}
    parsed = json.loads(run("motion", "-", "-f", "json", text=MACHINE).stdout)
    assert parsed["inputs"] == [
        {"file": "<stdin>", "sha256": hashlib.sha256(MACHINE.encode()).hexdigest()}
    ]


# statuses


ENDS = [
    ("check missing.yaml", 2),  # KurbelError
    ("table --ratio 5,4", 2),  # click's usage error
    ("check m.yaml", 2),  # MachineFileError
    ("table >/dev/full", 2),  # OSError
    ("flywheel stalls.yaml", 3),
]
UNHEARD = [(*end, stderr) for stderr in ("2>/dev/full", "2>&-") for end in ENDS]


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
@pytest.mark.parametrize(("arguments", "status", "stderr"), few(UNHEARD, UNHEARD[::2]))
def test_no_status_depends_on_standard_error(
    arguments: str, status: int, stderr: str, tmp_path: Path
) -> None:
    (tmp_path / "m.yaml").write_text("crank: 400\n")
    (tmp_path / "stalls.yaml").write_text(MACHINE + PRESSURE + "flywheel: {inertia: 1e-3 kg m2}\n")
    command = f"{sys.executable} -m kurbel {arguments} {stderr}"
    assert (
        subprocess.run(["bash", "-c", command], cwd=tmp_path, check=False, stdout=-3).returncode
        == status
    )


# long tables


def test_too_many_rows_are_refused_before_anything_is_computed() -> None:
    check_rows(MOST_ROWS, 1)
    with pytest.raises(
        UsageError, match=f"800000 crank angles for each of 2 give more than {MOST_ROWS} rows"
    ):
        check_rows(800_000, 2)
    for step, parts in ((1e-320, 1), (0.0001, 1), (0.0004, 2)):
        with pytest.raises(UsageError, match="take a larger --step"):
            stepped(step, 360, parts)
    result = run("table", "--step", "0.0004", *["--ratio", "5"] * 4)
    assert (result.exit_code, f"more than {MOST_ROWS} rows" in result.stderr) == (2, True)
