"""What the commands on one machine share: the machine with its results, the rows of its table, and the printing."""

from collections.abc import Callable, Iterable, Sequence

import click
from click.core import ParameterSource

from kurbel.cli.group import ProgressLine
from kurbel.cli.options import UncertaintyTexts, refuse_contradictions
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
from kurbel.tables.tables import Report, table_angles

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
    names = [case.name for case in machine.cases]
    return list(map(Case, load_cases(machine.origin, names)))


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
    **of_report: object,
) -> None:
    """Print the report of a command on the machine, called with the names of the options.

    units: of the figures; names: of key values, which are printed alone, '' for all, None with tables; where, over:
    what has a value, or the stroke, over which the rows are instead of the angle; cases: a row for each load case
    instead of all else; cycle: number of one of a measured trace; spreads: uncertainties of inputs in addition to
    those of the file, None for a command without any; instead: the option that asks for other tables instead of that
    over the crank angle; of_report: what only the report of this command takes.
    """
    rows_options = _options_of_rows(where, over, angles)
    _refuse_contradictions(rows_options, case_name, names, columns, cases, cycle, instead)
    case = case_of(file, case_name, overrides, output.file_name)
    if cases:
        report = _report_on_cases(case, command, units, names, columns)
        if cylinder is not None:
            report = report.of_cylinder(cylinder)
        _write(report, output, command)
        return

    # the report, for the angles of its table
    if cycle is not None:
        case = _one_cycle(case, cycle)
    functions = COMMANDS[command].functions
    end = functions.last_angle(case)
    rows: Sequence[float] | Callable[[Subject], Sequence[float]]
    if where is not None:
        rows = _rows_where(where, command, end)
    elif over:
        rows = _rows_over_stroke(step, end)
    else:
        rows = table_angles(step, angles, end, max(len(case.cylinders), 1))
    frame = Frame(
        command,
        rows,
        columns,
        units,
        over="z" if over else "",
        compare=compare,
        prose=output.look.format != "csv" or names is not None,
        table=not instead,
        names=names or "",
    )
    report = functions.report(case, frame, **of_report)

    # the parts of it that are wanted, with their uncertainties
    if cylinder is not None:
        report = report.of_cylinder(cylinder)
    if names is not None:
        report = report.key_values_alone()
    takes_uncertainty = spreads is not None and not instead
    if takes_uncertainty and (spreads or case.machine.uncertainty):
        report = _with_uncertainty(report, case, command, spreads or (), units, bool(names))
    _write(report, output, command)


def _options_of_rows(
    where: str | None, over: str | None, angles: tuple[float, ...] | None
) -> list[str]:
    """Return the options that say which rows the table has, instead of a step of the angle."""
    options = []
    if where is not None:
        options.append("--where")
    if over is not None:
        options.append("--over")
    if angles is not None:
        options.append("--angles")
    return options


def _refuse_contradictions(
    rows_options: list[str],
    case_name: str,
    names: str | None,
    columns: tuple[str, ...] | None,
    cases: bool,
    cycle: int | None,
    instead: str,
) -> None:
    """Raise UsageError for options of a report that do not go together."""
    not_of_cases = [*rows_options]
    if case_name:
        not_of_cases.append("--case")
    of_table = [*rows_options]
    if cycle:
        of_table.insert(0, "--cycle")
    if columns:
        of_table.insert(0, "--columns")
    leaves_columns_out = names if cases else names is not None
    refuse_contradictions(
        (
            cases and not_of_cases,
            f"--cases has a row for every load case; leave {' and '.join(not_of_cases)} out.",
        ),
        (
            instead and of_table,
            f"{instead} has no table over the angle; leave out {' and '.join(of_table)}.",
        ),
        (
            columns and leaves_columns_out,
            "--columns names columns of the table that --key-values leaves out; "
            "name key values in --key-values NAMES.",
        ),
        (
            len(rows_options) > 1,
            f"{' and '.join(rows_options)} both give crank angles; give only one of them.",
        ),
    )


def _report_on_cases(
    case: Case, command: str, units: str, names: str | None, columns: tuple[str, ...] | None
) -> Report:
    """Return the table with a row of key values for each load case of the file."""
    from kurbel.checks.limits import cases_report

    ids: Sequence[str] | None = columns
    if names:
        ids = [choice.id for choice in choices_in(names, command, ())]
    return cases_report(case.machine, cases_of(case.machine), command, units, ids)


def _one_cycle(case: Case, cycle: int) -> Case:
    """Return the machine in this measured cycle of its traces."""
    from kurbel.machine.one_cycle import of_cycle

    return Case(of_cycle(case.machine, cycle))


def _rows_where(where: str, command: str, end: float) -> Callable[[Subject], Sequence[float]]:
    """Return what gives the angles at which a column has a value."""
    from kurbel.tables.row_angles import rows_where

    # where a force has a value there is a motion to print, too
    return rows_where(where, "forces" if command == "motion" else command, end)


def _rows_over_stroke(step: float, end: float) -> Callable[[Subject], Sequence[float]]:
    """Return what gives the angles at every so many percent of the stroke."""
    from kurbel.tables.row_angles import over_stroke

    return over_stroke(step, end)


def _with_uncertainty(
    report: Report,
    case: Case,
    command: str,
    spreads: UncertaintyTexts,
    units: str,
    are_named: bool,
) -> Report:
    """Return the report with the uncertainty of its key values; are_named: they were chosen by name."""
    from kurbel.designs.uncertainty import with_uncertainty

    progress = ProgressLine(command)
    return with_uncertainty(
        report,
        case,
        spreads,
        units,
        lambda items: progress.counted(items, "machines", len(items)),
        are_named,
    )


def _write(report: Report, output: Output, command: str) -> None:
    """Write a report; without any option that selects something, its first answer."""
    context = click.get_current_context()
    options = {option.name or "" for option in context.command.params} - _OF_ANY_SELECTION
    is_selected = any(
        context.get_parameter_source(option) is ParameterSource.COMMANDLINE for option in options
    )
    row = COMMANDS[command]
    output.write(report, None if is_selected else row.first.split(), row.named.split())
