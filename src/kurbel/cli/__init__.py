"""The command line: its modules add their commands to the group; what these compute with is imported when called."""

from kurbel.cli import many, pages, reference, reports
from kurbel.cli.group import kurbel
from kurbel.report.commands import COMMANDS

__all__ = ["COMMANDS", "kurbel", "many", "pages", "reference", "reports"]
