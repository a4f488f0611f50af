"""The command line as a process: pipes, terminals, encodings, full disks, start-up."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from kurbel.cli import COMMANDS, kurbel
from representative import few, law_of_each

ESCAPE = b"\x1b"
POSIX_ONLY = pytest.mark.skipif(os.name != "posix", reason="needs a POSIX shell or terminal")


def process(
    *arguments: str, stdout: object = subprocess.PIPE, **environment: str
) -> subprocess.CompletedProcess[bytes]:
    kept = {
        key: value for key, value in os.environ.items() if key not in ("NO_COLOR", "FORCE_COLOR", "COLUMNS", "TERM")
    }
    return subprocess.run(
        [sys.executable, "-m", "kurbel", *arguments],
        stdout=stdout,
        stderr=subprocess.PIPE,
        env=kept | {"PYTHONIOENCODING": "utf-8"} | environment,
        check=False,
    )


def on_terminal(*arguments: str, columns: int = 120, **environment: str) -> bytes:
    """Return what the command writes to a terminal of this width."""
    import fcntl
    import pty
    import struct
    import termios

    leader, follower = pty.openpty()
    fcntl.ioctl(follower, termios.TIOCSWINSZ, struct.pack("HHHH", 50, columns, 0, 0))
    settings = {"TERM": "xterm-256color", "COLUMNS": str(columns)} | environment
    with subprocess.Popen(
        [sys.executable, "-m", "kurbel", *arguments],
        stdout=follower,
        stderr=follower,
        env={key: value for key, value in os.environ.items() if key not in ("NO_COLOR", "FORCE_COLOR")}
        | {"PYTHONIOENCODING": "utf-8"}
        | settings,
    ):
        os.close(follower)
        written = b""
        while True:
            try:
                piece = os.read(leader, 65536)
            except OSError:  # the other end is closed
                break
            if not piece:
                break
            written += piece
    os.close(leader)
    return written


@law_of_each(COMMANDS)
def test_every_command_has_help_that_any_encoding_can_show(command: str) -> None:
    result = CliRunner().invoke(kurbel, [command, "--help"])
    assert result.exit_code == 0
    assert result.stdout.startswith(f"Usage: kurbel {command}")
    assert result.stdout.isascii()


def test_a_fault_in_kurbel_is_no_traceback(monkeypatch: pytest.MonkeyPatch) -> None:
    from kurbel.report import zusammenstellung

    monkeypatch.setattr(zusammenstellung, "zusammenstellung", lambda *_: 1 / 0)
    result = CliRunner().invoke(kurbel, ["table"])
    assert result.exit_code == 70
    assert "ZeroDivisionError" in result.stderr
    assert "Traceback" not in result.stderr


def interrupted(*_: object) -> None:
    raise KeyboardInterrupt


def test_interrupt_is_130(monkeypatch: pytest.MonkeyPatch) -> None:
    from kurbel.report import zusammenstellung

    monkeypatch.setattr(zusammenstellung, "zusammenstellung", interrupted)
    result = CliRunner().invoke(kurbel, ["table"])
    assert (result.exit_code, result.output.strip()) == (130, "")


def one_after_another(*commands: list[str]) -> str:
    """Python that runs these commands, each to its end with status 0."""
    return (
        "import sys\nfrom kurbel.cli import kurbel\n"
        f"for arguments in {commands!r}:\n"
        "    try:\n        kurbel.main(arguments)\n"
        "    except SystemExit as end:\n        assert not end.code, arguments\n"
    )


def test_quick_commands_import_nothing_heavy() -> None:
    code = one_after_another(["--help"]) + "assert 'numpy' not in sys.modules\n"
    code += one_after_another(["table"], ["table", "-f", "csv"], ["table", "--compare"]) + (
        "heavy = {'yaml', 'rich', 'importlib.metadata'} & set(sys.modules)\nassert not heavy, heavy"
    )
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, check=False, encoding="utf-8")
    assert result.returncode == 0, result.stderr


def test_a_width_is_filled_where_it_is_asked_for(solved_once: None) -> None:
    """COLUMNS in a pipe, --width everywhere; no line is longer, and no word is broken."""
    machine = str(Path(__file__).parent.parent / "configs" / "waterworks.yaml")
    for arguments in (["table"], ["forces", machine, "--layout", "rows"], ["check", machine]):
        plain = CliRunner().invoke(kurbel, arguments).stdout
        for columns in (80, 40):
            narrow = CliRunner(env={"COLUMNS": str(columns)}).invoke(kurbel, arguments).stdout
            assert max(map(len, narrow.splitlines())) <= columns, arguments
            words = {word for word in narrow.split() if word.strip("─")}
            assert words <= set(plain.split()), arguments
            if arguments[0] != "check":
                assert CliRunner().invoke(kurbel, [*arguments, "--width", str(columns)]).stdout == narrow


@pytest.mark.parametrize("encoding", few(["ascii", "cp1252", "cp850"], ["ascii", "cp1252"]))
def test_poor_encodings(encoding: str) -> None:
    commands = ["table"], ["table", "-f", "json"], ["table", "-f", "markdown"], ["example"], ["--help"]
    code = one_after_another(*commands)
    environment = {**os.environ, "PYTHONIOENCODING": encoding, "PYTHONUTF8": "0", "LC_ALL": "C"}
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, env=environment, check=False)
    assert (result.returncode, result.stderr) == (0, b"")
    assert "?" not in result.stdout.decode(encoding)


@POSIX_ONLY
def test_reader_that_leaves_early() -> None:
    command = f"{sys.executable} -m kurbel table --step 0.05 -f csv | head -1"
    result = subprocess.run(["bash", "-o", "pipefail", "-c", command], capture_output=True, check=False)
    assert (result.returncode, result.stderr) == (0, b"")
    assert result.stdout == b"rod_ratio,phi_deg,acceleration_factor,velocity_factor\n"


FILLING = [["table"], ["table", "-f", "csv"], ["example", "waterworks"], ["--help"]]


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
@pytest.mark.parametrize("arguments", few(FILLING, [FILLING[0], FILLING[3]]))
def test_full_disk(arguments: list[str]) -> None:
    with open("/dev/full", "wb") as full:
        result = process(*arguments, stdout=full)
    assert result.returncode == 2
    assert b"No space left on device" in result.stderr
    assert b"Traceback" not in result.stderr
    assert b"Exception" not in result.stderr


@POSIX_ONLY
def test_a_terminal_gets_colour_and_as_many_angles_as_fit() -> None:
    wide, narrow = on_terminal("table", columns=220), on_terminal("table", columns=80)
    assert ESCAPE in wide
    assert wide.count("360° − φ".encode()) == 2  # in the head once, and below the table
    assert narrow.count("360° − φ".encode()) == 5


COLOURLESS = [{"NO_COLOR": "1"}, {"TERM": "dumb"}, {"NO_COLOR": "1", "FORCE_COLOR": "1"}]


@POSIX_ONLY
@pytest.mark.parametrize("environment", few(COLOURLESS, COLOURLESS[1:]))
def test_a_terminal_without_colours(environment: dict[str, str]) -> None:
    written = on_terminal("table", **environment)
    assert ESCAPE not in written
    assert "sin(φ+ψ)/cos ψ".encode() in written


def test_example_lists_every_machine_with_its_first_line() -> None:
    folder = Path(__file__).parent.parent / "configs"
    lines = CliRunner().invoke(kurbel, ["example"]).stdout.splitlines()
    assert [line.split()[0] for line in lines] == sorted(path.stem for path in folder.glob("*.yaml"))
    assert all(len(line.split()) > 3 for line in lines)


def test_example_prints_the_file_unchanged_in_any_encoding() -> None:
    shipped = (Path(__file__).parent.parent / "configs" / "waterworks.yaml").read_bytes()
    assert CliRunner().invoke(kurbel, ["example", "waterworks"]).stdout_bytes == shipped
    assert process("example", "waterworks.yaml", PYTHONIOENCODING="ascii", PYTHONUTF8="0").stdout == shipped
