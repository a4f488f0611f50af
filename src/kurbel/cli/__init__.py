"""The command line: a thin command for every row of `COMMANDS`; it imports what it computes with when it is called."""

from kurbel.cli.find import find
from kurbel.cli.group import exit_statuses, kurbel
from kurbel.cli.machine import balance, bearings, delivery, flywheel, forces, harmonics, motion, stress, torsion
from kurbel.cli.pages import accuracy, check, plot, report
from kurbel.cli.reference import example, friction, keys, schema, table, units
from kurbel.cli.sweep import sweep
from kurbel.report.commands import COMMANDS

__all__ = ["COMMANDS", "kurbel"]

for _command in (
    *(
        table,
        motion,
        forces,
        flywheel,
        stress,
        bearings,
        balance,
        harmonics,
        torsion,
        delivery,
        plot,
        report,
        sweep,
        find,
        accuracy,
    ),
    *(friction, check, example, keys, units, schema),
):
    assert _command.name
    _command.epilog = exit_statuses(_command.name)
    _command.short_help = COMMANDS[_command.name].summary
    kurbel.add_command(_command)
