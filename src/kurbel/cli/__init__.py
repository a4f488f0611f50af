"""The command line: a thin command for every row of `COMMANDS`; it imports what it computes with when it is called."""

from kurbel.cli.designs import find, sweep
from kurbel.cli.group import exit_statuses, kurbel
from kurbel.cli.machine import balance, bearings, delivery, flywheel, forces, harmonics, motion, stress, torsion
from kurbel.cli.pages import accuracy, check, plot, report
from kurbel.cli.reference import example, friction, keys, schema, table, units
from kurbel.report.commands import COMMANDS

__all__ = ["COMMANDS", "kurbel"]

_WITH_MACHINE = (motion, forces, flywheel, stress, bearings, balance, harmonics, torsion, delivery)
_MORE = (plot, report, sweep, find, accuracy, check)
_OF_REFERENCE = (table, friction, example, keys, units, schema)
for _command in (*_WITH_MACHINE, *_MORE, *_OF_REFERENCE):
    assert _command.name
    _command.epilog = exit_statuses(_command.name)
    _command.short_help = COMMANDS[_command.name].summary
    kurbel.add_command(_command)
