"""What the commands on one machine share: the machine with its results, the rows of its table, and the printing."""

from collections.abc import Callable, Iterable, Sequence

import click
from click.core import ParameterSource

from kurbel.cli.group import ProgressLine
from kurbel.cli.options import UncertaintyTexts
from kurbel.errors import UsageError
from kurbel.machine import Machine
from kurbel.machine_file import load
from kurbel.machine_file.reader import load_cases
from kurbel.render.formats import Output
from kurbel.render.output import refuse_overwriting
from kurbel.report.commands import COMMANDS
from kurbel.solver.case import Case
from kurbel.tables.frame import Frame, Subject
from kurbel.tables.named_values import choices_in
from kurbel.tables.tables import table_angles

_OF_ANY_SELECTION = {
    "file",
    "overrides",
    "case_name",
    "cylinder",
    "units",
    "comma",
    "digits",
    "width",
}
"""Options that ask for nothing of which a first selection has only a part."""


def case_of(file: str, case_name: str, overrides: Iterable[str], *outputs: str | None) -> Case:
    """Read the machine, with the values of a load case of its file, '' for none, and these values over them.

    Raises UsageError where an output would overwrite its file, or a trace that it names.
    """
    machine = load(file, tuple(overrides), case_name)
    for output in outputs:
        refuse_overwriting(output, (file, *machine.trace_files))
    return Case(machine)


def cases_of(machine: Machine) -> list[Case]:
    """Return the load cases of the file of a machine. Raises UsageError where it has none."""
    if not machine.cases or machine.origin is None:
        raise UsageError("--cases: the file has no 'cases'")
    return [
        Case(load_case)
        for load_case in load_cases(machine.origin, [case.name for case in machine.cases])
    ]


def print_report(
    command: str,
    output: Output,
    file: str,
    case_name: str,
    overrides: tuple[str, ...],
    units: str,
    cylinder: str | None,
    names: str | None,
    step: float = 10.0,
    angles: tuple[float, ...] | None = None,
    columns: tuple[str, ...] | None = None,
    where: str | None = None,
    over: str | None = None,
    compare: bool = False,
    cases: bool = False,
    cycle: int | None = None,
    spreads: UncertaintyTexts | None = None,
    instead: str = "",
    **own: object,
) -> None:
    """Print the report of a command on the machine, called with the names of the options.

    units: of the figures; names: of key values, which are printed alone, '' for all, None with tables; where, over:
    what has a value, or the stroke, over which the rows are instead of the angle; cases: a row for each load case
    instead of all else; cycle: number of one of a measured trace; spreads: uncertainties of inputs in addition to
    those of the file, None for a command without any; instead: the option that asks for other tables instead of that
    over the crank angle; own: what only the report of this command takes.
    """
    rows = [
        way
        for way, value in (("--where", where), ("--over", over), ("--angles", angles))
        if value is not None
    ]
    not_of_cases = [*rows, *(["--case"] if case_name else [])]
    of_table = [*(["--columns"] if columns else []), *(["--cycle"] if cycle else []), *rows]
    for wrong, message in (
        (
            cases and not_of_cases,
            f"--cases has a row for every load case; leave {' and '.join(not_of_cases)} out.",
        ),
        (
            instead and of_table,
            f"{instead} has no table over the angle; leave out {' and '.join(of_table)}.",
        ),
        (
            columns and (names or (names is not None and not cases)),
            "--columns names columns of the table that --key-values leaves out; name key values in --key-values NAMES.",
        ),
        (len(rows) > 1, f"{' and '.join(rows)} both give crank angles; give only one of them."),
    ):
        if wrong:
            raise click.UsageError(message)

    case = case_of(file, case_name, overrides, output.file_name)
    if cases:
        from kurbel.checks.limits import cases_report

        chosen = [one.id for one in choices_in(names, command, ())] if names else columns
        report = cases_report(case.machine, cases_of(case.machine), command, units, chosen)
    else:
        if cycle is not None:
            from kurbel.machine.one_cycle import of_cycle

            case = Case(of_cycle(case.machine, cycle))
        functions = COMMANDS[command].functions
        end = functions.end(case)
        rows_at: Sequence[float] | Callable[[Subject], Sequence[float]]
        if where is not None:  # where a force has a value there is a motion to print, too
            from kurbel.tables.row_angles import rows_where

            rows_at = rows_where(where, "forces" if command == "motion" else command, end)
        elif over:
            from kurbel.tables.row_angles import over_stroke

            rows_at = over_stroke(step, end)
        else:
            rows_at = table_angles(step, angles, end, max(len(case.cylinders), 1))
        prose = output.look.format != "csv" or names is not None
        frame = Frame(
            command,
            rows_at,
            columns,
            units,
            "z" if over else "",
            compare,
            prose,
            not instead,
            names or "",
        )
        report = functions.report(case, frame, **own)
    report = report if cylinder is None else report.of_cylinder(cylinder)
    report = report if names is None or cases else report.key_values_alone()
    if not cases and not instead and spreads is not None and (spreads or case.machine.uncertainty):
        from kurbel.designs.uncertainty import with_uncertainty

        progress = ProgressLine(command)
        report = with_uncertainty(
            report,
            case,
            spreads,
            units,
            lambda items: progress.counted(items, "machines", len(items)),
            bool(names),
        )
    context = click.get_current_context()
    options = {option.name or "" for option in context.command.params} - _OF_ANY_SELECTION
    selected = any(
        context.get_parameter_source(option) is ParameterSource.COMMANDLINE for option in options
    )
    shown = COMMANDS[command]
    output.write(report, None if selected else shown.first.split(), shown.named.split())
