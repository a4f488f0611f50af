"""The command line as a process: pipes, terminals, encodings, full disks, start-up."""

import os
import shlex
import subprocess
import sys
from io import StringIO
from pathlib import Path

import click
import pytest
from click.testing import CliRunner

from command import limited, run
from kurbel.cli import COMMANDS, checking, group, kurbel
from representative import CONFIGS, few, law_of_each

ESCAPE = b"\x1b"
POSIX_ONLY = pytest.mark.skipif(os.name != "posix", reason="needs a POSIX shell or terminal")


def process(
    *arguments: str, stdout: object = subprocess.PIPE, **environment: str
) -> subprocess.CompletedProcess[bytes]:
    kept = {
        key: value
        for key, value in os.environ.items()
        if key not in ("NO_COLOR", "FORCE_COLOR", "COLUMNS", "TERM")
    }
    return subprocess.run(
        [sys.executable, "-m", "kurbel", *arguments],
        stdout=stdout,
        stderr=subprocess.PIPE,
        env=kept | {"PYTHONIOENCODING": "utf-8"} | environment,
        check=False,
    )


def on_terminal(*arguments: str, columns: int = 120, rows: int = 50, **environment: str) -> bytes:
    """Return what the command writes to a terminal of this width and height."""
    import fcntl
    import pty
    import struct
    import termios

    leader, follower = pty.openpty()
    fcntl.ioctl(follower, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))
    settings = {"TERM": "xterm-256color", "COLUMNS": str(columns)} | environment
    with subprocess.Popen(
        [sys.executable, "-m", "kurbel", *arguments],
        stdout=follower,
        stderr=follower,
        env={
            key: value
            for key, value in os.environ.items()
            if key not in ("NO_COLOR", "FORCE_COLOR", "LINES")
        }
        | {"PYTHONIOENCODING": "utf-8"}
        | settings,
    ) as process:
        limited(process)
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


@POSIX_ONLY
def test_a_terminal_gets_no_page_of_a_report_and_a_word_on_many_columns() -> None:
    assert b"give --output NAME.html" in on_terminal("report", WATERWORKS)
    assert b"'--columns ID,ID' prints fewer" in on_terminal(
        "sweep", WATERWORKS, "--vary", "rod_ratio=4,5"
    )


def test_a_file_named_without_its_ending(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "mill.yaml").write_text("crank: 1 m\n", encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    assert "did you mean 'mill.yaml'?" in run("check", "mill").stderr


@law_of_each(COMMANDS)
def test_every_command_has_help_that_any_encoding_can_show(command: str) -> None:
    result = run(command, "--help")
    assert result.exit_code == 0
    assert result.stdout.startswith(f"Usage: kurbel {command}")
    assert result.stdout.isascii()
    assert max(map(len, result.stdout.splitlines())) <= 80
    # the first screen has an example, which can be read, and the options of most calls
    screen = "\n".join(result.stdout.splitlines()[:24])
    name, word, *words = shlex.split(COMMANDS[command].example.partition(" > ")[0])
    assert (name, word) == ("kurbel", command)
    assert f"Example: {COMMANDS[command].example}" in screen
    click_command = kurbel.get_command(click.Context(kurbel), command)
    assert click_command
    with click_command.make_context(command, words):
        for option in ("--units", "--format", "--output"):
            assert (option in screen) == (option in result.stdout)


def test_a_fault_in_kurbel_is_no_traceback(monkeypatch: pytest.MonkeyPatch) -> None:
    from kurbel.report import zusammenstellung

    monkeypatch.setattr(zusammenstellung, "zusammenstellung", lambda *_: 1 / 0)
    result = run("table")
    assert result.exit_code == 70
    assert "ZeroDivisionError" in result.stderr
    assert "Traceback" not in result.stderr


def interrupted(*_: object) -> None:
    raise KeyboardInterrupt


def test_interrupt_is_130(monkeypatch: pytest.MonkeyPatch) -> None:
    from kurbel.report import zusammenstellung

    monkeypatch.setattr(zusammenstellung, "zusammenstellung", interrupted)
    result = run("table")
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
    result = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, check=False, encoding="utf-8"
    )
    assert result.returncode == 0, result.stderr


def test_a_width_is_filled_where_it_is_requested() -> None:
    """COLUMNS in a pipe, --width everywhere; no line is longer, and no word is broken."""
    machine = str(CONFIGS["waterworks"])
    for arguments in (["table"], ["forces", machine, "--layout", "rows"], ["check", machine]):
        plain = run(*arguments).stdout
        for columns in (80, 40):
            narrow = CliRunner(env={"COLUMNS": str(columns)}).invoke(kurbel, arguments).stdout
            assert max(map(len, narrow.splitlines())) <= columns, arguments
            words = {word for word in narrow.split() if word.strip("─")}
            assert words <= set(plain.split()), arguments
            if arguments[0] != "check":
                assert run(*arguments, "--width", columns).stdout == narrow


@pytest.mark.parametrize("encoding", few(["ascii", "cp1252", "cp850"], ["ascii", "cp1252"]))
def test_poor_encodings(encoding: str) -> None:
    commands = (
        ["table"],
        ["table", "-f", "json"],
        ["table", "-f", "markdown"],
        ["example"],
        ["--help"],
    )
    code = one_after_another(*commands)
    environment = {**os.environ, "PYTHONIOENCODING": encoding, "PYTHONUTF8": "0", "LC_ALL": "C"}
    result = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, env=environment, check=False
    )
    assert (result.returncode, result.stderr) == (0, b"")
    assert "?" not in result.stdout.decode(encoding)


@POSIX_ONLY
def test_reader_that_leaves_early() -> None:
    command = f"{sys.executable} -m kurbel table --step 0.05 -f csv | head -1"
    result = subprocess.run(
        ["bash", "-o", "pipefail", "-c", command], capture_output=True, check=False
    )
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


WATERWORKS = str(CONFIGS["waterworks"])
SELECTED = b"First selection. All columns, angles and key values: kurbel forces FILE --all"


@POSIX_ONLY
def test_a_low_terminal_shows_a_first_selection_and_shows_how_to_see_all() -> None:
    shown = on_terminal("forces", WATERWORKS, columns=80, rows=33, NO_COLOR="1").decode()
    whole = process("forces", WATERWORKS, COLUMNS="80").stdout.decode()
    lines = [line.rstrip() for line in shown.splitlines()]
    assert (len(lines) < 33, lines[1].encode()) == (True, SELECTED)
    key_values, table = shown.replace("\r", "").split("\n\nφ")
    # every number is that of the whole page, where it is among all the others
    numbers = [
        line.split() for line in whole.splitlines() if line[:1] in "xPNT" and line[:1].strip()
    ]
    for row in (line.split() for line in table.splitlines()[2:] if line and line[0] in "xPNT"):
        values = [float(value) for other in numbers if other[:2] == row[:2] for value in other[2:]]
        assert [float(value) for value in row[2:]] == pytest.approx(values[::6], rel=2e-3)
    assert {line.split()[0] for line in key_values.splitlines() if line.startswith("  ")} < set(
        whole.split()
    )


@POSIX_ONLY
def test_on_24_lines_nothing_scrolls_away() -> None:
    """The table over the angle gives way to the key values, and the prompt has the last line."""
    shown = on_terminal("forces", WATERWORKS, columns=80, rows=24, NO_COLOR="1").decode()
    lines = [line.rstrip() for line in shown.splitlines()]
    symbols = [line.split()[0] for line in lines if line.startswith("  ")]
    assert len(lines) <= 23
    assert lines[1].encode() == SELECTED
    assert {"b_max", "c_max", "A_f", "N_f", "e_f", "F_m"} <= set(symbols)
    assert not any(line.startswith("φ") for line in lines)


@POSIX_ONLY
@pytest.mark.parametrize("more", [["--all"], ["--columns", "P"], ["--step", "5"], ["--key-values"]])
def test_what_is_requested_is_shown_on_a_low_terminal_too(more: list[str]) -> None:
    shown = on_terminal("forces", WATERWORKS, *more, columns=80, rows=24, NO_COLOR="1")
    plain = process("forces", WATERWORKS, *more, COLUMNS="80").stdout
    assert shown.replace(b"\r\n", b"\n").splitlines() == plain.splitlines()


@POSIX_ONLY
def test_a_high_terminal_and_a_pipe_have_all() -> None:
    high = on_terminal("forces", WATERWORKS, columns=80, rows=500, NO_COLOR="1").replace(
        b"\r\n", b"\n"
    )
    assert high == process("forces", WATERWORKS, COLUMNS="80").stdout
    assert SELECTED not in high


class Terminal(StringIO):
    def isatty(self) -> bool:
        return True


@pytest.mark.parametrize(
    ("stream", "more", "shown"),
    [(Terminal, {}, True), (StringIO, {}, False), (Terminal, {"CI": "true"}, False)],
)
def test_a_terminal_shows_what_is_left_after_two_seconds(
    monkeypatch: pytest.MonkeyPatch, stream: type[StringIO], more: dict[str, str], shown: bool
) -> None:
    """Of ten designs of a second each, four are done after four seconds, and six seconds are left."""
    seconds = iter(range(100))
    monkeypatch.delenv("CI", raising=False)
    for name, value in more.items():
        monkeypatch.setenv(name, value)
    monkeypatch.setattr(group, "monotonic", lambda: next(seconds))
    monkeypatch.setattr(sys, "stderr", stream())
    assert [*group.ProgressLine("sweep").counted(range(10), "designs", 10)] == [*range(10)]
    written = sys.stderr.getvalue()  # type: ignore[attr-defined]
    assert bool(written) is shown
    if shown:
        lines = written.split("\r")
        assert (
            lines[1] == "kurbel sweep: 1 of 10 designs, 18 s left"
        )  # two seconds, one of them for the start
        assert lines[4] == "kurbel sweep: 4 of 10 designs, 8 s left"
        assert (lines[-2].strip(), lines[-1]) == ("", "")


def test_example_lists_every_machine_with_its_first_line() -> None:
    lines = run("example").stdout.splitlines()
    assert [line.split()[0] for line in lines] == sorted(CONFIGS)
    assert all(len(line.split()) > 3 for line in lines)


def test_example_prints_the_file_with_the_line_for_editors_in_any_encoding() -> None:
    modeline = b"# yaml-language-server: $schema=./kurbel.schema.json\n"
    shipped = modeline + CONFIGS["waterworks"].read_bytes()
    assert run("example", "waterworks").stdout_bytes == shipped
    assert (
        process("example", "waterworks.yaml", PYTHONIOENCODING="ascii", PYTHONUTF8="0").stdout
        == shipped
    )


def test_kurbel_alone_prints_its_help_and_ends_well() -> None:
    alone = run()
    assert alone.exit_code == 0
    assert alone.stdout == run("--help").stdout


def test_colours_are_forced_and_forbidden() -> None:
    command = ("motion", str(CONFIGS["waterworks"]), "--columns", "b")
    plain = process(*command)
    assert b"\x1b[" not in plain.stdout
    assert b"\x1b[" in process(*command, FORCE_COLOR="1").stdout
    for variables in ({"FORCE_COLOR": "0"}, {"FORCE_COLOR": "1", "NO_COLOR": "1"}):
        assert process(*command, **variables).stdout == plain.stdout


def test_example_check_compares_the_expected_figures() -> None:
    checked = run("example", "waterworks", "--check")
    assert (checked.exit_code, checked.stdout) == (0, "waterworks  PASS  5 expected figures\n")
    locomotive = run("example", "locomotive", "--check").stdout
    assert locomotive == "locomotive  PASS  1 expected figure\n"
    assert run("example", "nothing", "--check").exit_code == 2


def test_example_check_fails_where_a_figure_is_off(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    file = tmp_path / "off.yaml"
    file.write_text(
        "{crank: 400 mm, rod_ratio: 5, expect: {stroke: 810 mm ± 1 mm}}", encoding="utf-8"
    )
    monkeypatch.setattr(checking, "file_of", lambda name: str(file))
    checked = run("example", "locomotive", "--check")
    assert checked.exit_code == 1
    assert checked.stdout == "locomotive  FAIL  1 expected figure, off: stroke\n"


def test_the_page_for_newcomers_is_short_and_names_every_command() -> None:
    page = run("skill").stdout
    assert len(page.splitlines()) <= 120
    assert [
        word for word in COMMANDS if word not in ("skill",) and f"kurbel {word}" not in page
    ] == []


def test_the_smallest_machine_on_the_page_for_newcomers_runs() -> None:
    page = run("skill").stdout
    _, _, after = page.partition("The smallest machine that runs:")
    text, _, _ = after.partition("##")
    assert run("forces", "-", text=text).exit_code == 0
