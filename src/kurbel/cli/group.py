"""The group of commands, and the one place where errors become messages and exit statuses."""

import inspect
import math
import os
import sys
import warnings
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from io import StringIO
from time import monotonic
from typing import Any, NoReturn, TypeVar

import click

from kurbel import __version__
from kurbel.errors import KurbelError, MachineFileError
from kurbel.near_words import did_you_mean
from kurbel.render import Look
from kurbel.render.output import silence, terminal_size
from kurbel.report.commands import BROKEN, COMMANDS, NO_SOLUTION

# before numpy: its thread pool doubles the start-up time on a busy machine, and no matrix here is large enough for it
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

_DEBUG = "KURBEL_DEBUG"
_PATIENCE = 2.0
"""Seconds after which a terminal shows what is being done."""
Item = TypeVar("Item")

DONE, WRONG, INTERNAL, INTERRUPTED = 0, 2, 70, 130

_MEANINGS = {
    DONE: "done",
    BROKEN: "a limit or expectation failed (check) or a case failed (accuracy --extremes)",
    WRONG: "wrong usage or input, or the output cannot be written",
    NO_SOLUTION: "no solution: the machine stalls, locks or is in resonance, or find has no solution",
    INTERNAL: "a bug in kurbel",
    INTERRUPTED: "interrupted",
}


def exit_statuses(command: str = "") -> str:
    """Return the last sentence of the help of a command, or of `kurbel` itself."""
    of_command = COMMANDS[command].statuses if command else (BROKEN, NO_SOLUTION)
    meanings = []
    for status, meaning in _MEANINGS.items():
        if status in of_command or status not in (BROKEN, NO_SOLUTION):
            meanings.append(f"{status} {meaning}")
    return "Exit status: " + "; ".join(meanings)


def _legend(texts: Iterable[str]) -> str:
    from kurbel.tables.sources import legend

    return legend(texts)


_FIRST_OPTIONS = ("vary", "ratio", "rows", "columns", "names", "units", "format", "file_name")
"""Options that most calls of a command have: its help begins with them."""


class KurbelCommand(click.Command):
    """A command whose help shows on its first screen what it prints, an example, and the options of most calls.

    Further paragraphs follow the options; the help ends with the books to which it refers, and with its exit statuses.
    """

    def __init__(self, *args: Any, **extra: Any) -> None:
        super().__init__(*args, **extra)
        self.params.sort(key=_place_in_help)

    def format_help_text(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the first paragraph, and the example."""
        first, _ = self.first_and_further_help()
        formatter.write_paragraph()
        with formatter.indentation():
            formatter.write_text(first)
            formatter.write_paragraph()
            formatter.write_text(f"\b\nExample: {COMMANDS[self.name or ''].example}")

    def first_and_further_help(self) -> tuple[str, str]:
        """Return the first paragraph of the help, and those that follow it."""
        first, _, further = inspect.cleandoc(self.help or "").partition("\n\n")
        return first, further

    def end_of_help(self) -> list[str]:
        """Return these paragraphs, in ASCII."""
        texts = [self.help or ""]
        texts += [option.help or "" for option in self.params if isinstance(option, click.Option)]
        books = Look(encoding="ascii").text(_legend(texts))
        return [text for text in (books, exit_statuses(self.name or "")) if text]

    def format_epilog(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        _, further = self.first_and_further_help()
        paragraphs = [further] if further else []
        for text in (*paragraphs, *self.end_of_help()):
            formatter.write_paragraph()
            formatter.write_text(text)


def _place_in_help(parameter: click.Parameter) -> int:
    """Return the place of an option among those that come first, arguments before them, all others behind."""
    if isinstance(parameter, click.Argument):
        return -1
    name = parameter.name or ""
    return _FIRST_OPTIONS.index(name) if name in _FIRST_OPTIONS else len(_FIRST_OPTIONS)


class Kurbel(click.Group):
    """The group, which ends every run with a message instead of a traceback."""

    command_class = KurbelCommand
    door: Callable[[str], object]
    """Imports the module of a command, which adds it; set by `kurbel.cli`."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name in COMMANDS and cmd_name not in self.commands:
            self.door(cmd_name)
        return super().get_command(ctx, cmd_name)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        with formatter.section("Commands"):
            formatter.write_dl([(command.word, command.summary) for command in COMMANDS.values()])

    def add_command(self, cmd: click.Command, name: str | None = None) -> None:
        super().add_command(cmd, name)
        assert cmd.name
        cmd.short_help = COMMANDS[cmd.name].summary

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        name = args[0]
        if name in COMMANDS or name.startswith("-"):
            return super().resolve_command(ctx, args)
        hint = did_you_mean(name, tuple(COMMANDS))
        if not hint:
            hint = (
                "; 'kurbel forces FILE' computes a machine, "
                "'kurbel --help' and 'kurbel COMMAND --help' explain"
            )
        raise click.UsageError(f"no command '{name}'{hint}", ctx)

    def main(self, *args: Any, **extra: Any) -> NoReturn:
        # no message fails because standard error is closed or an encoding lacks one of its characters
        sys.stderr = sys.stderr or StringIO()
        for stream in (sys.stdout, sys.stderr):
            if hasattr(stream, "reconfigure"):
                stream.reconfigure(errors="replace")
        warnings.simplefilter("error", RuntimeWarning)  # what numpy warns of is no result
        message = ""
        try:
            status = super().main(*args, **(extra | {"standalone_mode": False}))
        except SystemExit:  # click's answer to a reader of its help that leaves early
            status = DONE
        except Exception as error:
            status, message = _status_and_message(error)
            if status == INTERNAL and os.environ.get(_DEBUG):
                raise
        if message:
            to_stderr(message)
        sys.exit(status if isinstance(status, int) else DONE)


def _status_and_message(error: Exception) -> tuple[int, str]:
    """Return the exit status of an error that ended a run, and its message, '' for none."""
    if isinstance(error, click.ClickException):
        text = StringIO()
        error.show(text)
        return error.exit_code, text.getvalue()
    if isinstance(error, click.Abort):
        return INTERRUPTED, ""
    if isinstance(error, KurbelError):
        return error.exit_status, message_of(error)
    if isinstance(error, (OverflowError, FloatingPointError, RuntimeWarning)):
        return WRONG, f"Error: numeric overflow ({error}); check magnitudes and units in the file"
    if isinstance(error, OSError):
        silence(sys.stdout)
        file = f"{error.filename}: " if error.filename else ""
        return WRONG, f"Error: {file}{error.strerror or error}"
    # what Python before 3.12 makes of an interrupt that comes while attributes of a class are named
    if isinstance(error.__cause__, KeyboardInterrupt) and not os.environ.get(_DEBUG):
        return INTERRUPTED, ""
    return INTERNAL, (
        f"Error: this is a bug in kurbel, not in your input: {type(error).__name__}: {error}\n"
        f"Please report it; {_DEBUG}=1 shows where it happened."
    )


def message_of(error: KurbelError) -> str:
    """Return the message of an error; for a machine file all faults, with source lines cut to the terminal's width."""
    if not isinstance(error, MachineFileError):
        return f"Error: {error}"
    width, _ = terminal_size((104, 24))
    return error.pretty(min(width, 104), _stderr_look().text)


def _stderr_look() -> Look:
    """Return the look of texts in the encoding of standard error."""
    return Look(encoding=getattr(sys.stderr, "encoding", None) or "utf-8")


def to_stderr(message: str) -> None:
    """Write a message to standard error in its encoding; nothing if it is full or closed."""
    try:
        lines = map(_stderr_look().text, message.splitlines())
        click.echo("\n".join(lines), err=True)
    except (OSError, ValueError):
        silence(sys.stderr)


class ProgressLine:
    """A progress line on standard error: what is being computed, and the remaining time.

    It appears after two seconds and disappears at the end; in a pipe and on a CI service there is none.
    """

    def __init__(self, command: str) -> None:
        self._command = command
        self._begin = monotonic()
        self._width = 0
        is_shown = sys.stderr.isatty() and not os.environ.get("CI")
        self._next = self._begin + _PATIENCE if is_shown else math.inf

    def __call__(self, doing: str, share: float = 0.0) -> None:
        """Show what is being done; share: completed share of all, 0 if unknown."""
        now = monotonic()
        if now < self._next:
            return
        self._next = now + _PATIENCE / 10
        text = f"kurbel {self._command}: {doing}"
        if share:
            seconds = (now - self._begin) * (1 / share - 1)
            remaining = f"{seconds / 60:.0f} min" if seconds >= 100 else f"{seconds:.0f} s"
            text += f", {remaining} left"
        self._write(text)

    def counted(self, items: Iterable[Item], what: str, count: int) -> Iterator[Item]:
        """Yield the items and show how many of them are done; what: their name in the plural."""
        with self:
            for number, item in enumerate(items):
                self(f"{number} of {count} {what}", number / max(count, 1))
                yield item

    def __enter__(self) -> "ProgressLine":
        return self

    def __exit__(self, *_: object) -> None:
        if self._width:
            self._write("")

    def _write(self, text: str) -> None:
        """Write a text over the line; '' leaves an empty line, in which the next output begins."""
        terminal_width, _ = terminal_size()
        text = _stderr_look().text(text)[: terminal_width - 1]
        line = f"\r{text.ljust(self._width)}"
        if not text:
            line += "\r"
        with suppress(OSError, ValueError):
            sys.stderr.write(line)
            sys.stderr.flush()
        self._width = len(text)


@click.group(
    cls=Kurbel,
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog=exit_statuses(),
    invoke_without_command=True,
)
@click.version_option(__version__, prog_name="kurbel", message="%(prog)s %(version)s")
@click.pass_context
def kurbel(context: click.Context) -> None:
    """Calculate crank drives: motion, forces, friction, flywheel and crankshaft of piston machines.

    A machine is described in a YAML file, every value with its unit; kurbel prints tables with
    the symbols of the old machine-element books. Start with

    \b
      kurbel table                              the factors of any slider-crank
      kurbel example                            the machines that come with kurbel
      kurbel example waterworks > engine.yaml   take one as a pattern
      kurbel check engine.yaml                  what is computed, and what is not
      kurbel motion engine.yaml                 travel, velocity, acceleration
      kurbel forces engine.yaml                 forces and key values
      kurbel flywheel engine.yaml               turning effort, flywheel, speed
      kurbel balance engine.yaml                unbalanced forces, counterweights
      kurbel plot --list                        list of pictures
      kurbel plot engine.yaml                   the most informative picture
      kurbel report engine.yaml -o report.html  everything on one page

    Results go to standard output, everything else to standard error.
    """
    if context.invoked_subcommand is None:
        click.echo(context.get_help())
