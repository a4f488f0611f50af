"""The command line: the module of a command is imported when the command is called, or its help."""

from kurbel.cli.group import kurbel
from kurbel.report.commands import COMMANDS

__all__ = ["COMMANDS", "kurbel"]


def _load(word: str) -> None:
    """Import the module of a command, which adds it to the group; that of one with a report is made from its row."""
    row = COMMANDS[word]
    if row.of:
        from kurbel.cli.reports import command_of

        kurbel.add_command(command_of(row))
    elif word in ("sweep", "find"):
        from kurbel.cli import many as many
    elif word in ("plot", "report", "check", "accuracy"):
        from kurbel.cli import pages as pages
    else:
        from kurbel.cli import reference as reference


kurbel.door = _load
