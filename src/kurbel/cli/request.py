"""What the commands on one machine share: the machine with its results, the rows of its table, and the printing."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import click
from click.core import ParameterSource

from kurbel.cli.group import Progress
from kurbel.cli.options import Output, Spreads
from kurbel.errors import UsageError
from kurbel.machine import Machine, of_cycle
from kurbel.machine_file import load
from kurbel.machine_file.reader import load_cases
from kurbel.render.output import refuse_overwriting
from kurbel.report.commands import COMMANDS
from kurbel.report.frame import Frame, Subject, over_stroke, rows_where
from kurbel.report.limits import cases_report
from kurbel.report.tables import Report, crank_angles
from kurbel.solver.case import Case

_OF_ANY_SELECTION = {"file", "overrides", "case_name", "cylinder", "units", "comma", "digits", "width"}
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
    return [Case(one) for one in load_cases(machine.origin, [one.name for one in machine.cases])]


@dataclass(frozen=True, eq=False)
class Request:
    """What a command that reports on a machine is called with, by the names of the options.

    units: of the figures; where, over: what has a value, or the stroke, over which the rows are instead of the angle;
    cases: a row for each load case instead of all else; cycle: number of one of a measured trace; spreads:
    uncertainties of inputs in addition to those of the file, None for a command without any; instead: the option that
    asks for other tables instead of that over the crank angle.
    """

    command: str
    file: str
    case_name: str
    overrides: tuple[str, ...]
    units: str
    cylinder: str | None
    key_values_only: bool
    output: Output
    step: float = 10.0
    angles: tuple[float, ...] | None = None
    columns: tuple[str, ...] | None = None
    where: str | None = None
    over: str | None = None
    compare: bool = False
    cases: bool = False
    cycle: int | None = None
    spreads: Spreads | None = None
    instead: str = ""

    def case(self, cycle: int | None = None) -> Case:
        """Return the machine with its results, each computed on first use; cycle: number of one of a trace."""
        case = case_of(self.file, self.case_name, self.overrides, self.output.file_name)
        return case if cycle is None else Case(of_cycle(case.machine, cycle))

    def print(self, **own: object) -> None:
        """Print the report on the machine; own: options of this command alone, which its report takes."""
        self._refuse_contradictions()
        if self.cases:
            machine = self.case().machine
            report = cases_report(machine, cases_of(machine), self.command, self.units, self.columns)
            return self._write(self._requested(report))
        case = self.case(self.cycle)
        report = self._requested(COMMANDS[self.command].functions.report(case, self._frame(case), **own))
        if not self.instead and self.spreads is not None and (self.spreads or case.machine.uncertainty):
            from kurbel.designs.uncertainty import with_uncertainty

            progress = Progress(self.command)
            report = with_uncertainty(
                report, case, self.spreads, self.units, lambda items: progress.counted(items, "machines", len(items))
            )
        self._write(report)

    def _refuse_contradictions(self) -> None:
        """Raise UsageError for options that ask for the rows of a table which others leave out, or for two tables."""
        ways = {"--where": self.where, "--over": self.over, "--angles": self.angles}
        rows = [way for way, value in ways.items() if value is not None]
        table = [*(["--columns"] if self.columns else []), *(["--cycle"] if self.cycle else []), *rows]
        if self.cases and (given := [*rows, *(["--case"] if self.case_name else [])]):
            raise click.UsageError(f"--cases has a row for every load case; leave {' and '.join(given)} out.")
        if self.instead and table:
            raise click.UsageError(f"{self.instead} has no table over the angle; leave out {' and '.join(table)}.")
        if self.key_values_only and self.columns and not self.cases:
            raise click.UsageError(
                "--columns names columns of the table that --key-values leaves out; a key value is a line, grep 'p_i '"
            )
        if len(rows) > 1:
            raise click.UsageError(f"{' and '.join(rows)} both give crank angles; give only one of them.")

    def _frame(self, case: Case) -> Frame:
        """Return the frame of the report, with rows from 0 to the end of the cycle, or as requested."""
        end = COMMANDS[self.command].functions.end(case)
        angles: Sequence[float] | Callable[[Subject], Sequence[float]]
        if self.where is not None:  # where a force has a value there is a motion to print, too
            angles = rows_where(self.where, "forces" if self.command == "motion" else self.command, end)
        elif self.over:
            angles = over_stroke(self.step, end)
        else:
            angles = crank_angles(self.step, self.angles, end, max(len(case.cylinders), 1))
        prose = self.output.look.format != "csv" or self.key_values_only
        over, table = "z" if self.over else "", not self.instead
        return Frame(self.command, angles, self.columns, self.units, over, self.compare, prose, table)

    def _requested(self, report: Report) -> Report:
        """Return the requested part of the report."""
        report = report if self.cylinder is None else report.of_cylinder(self.cylinder)
        return report.key_values_alone() if self.key_values_only else report

    def _write(self, report: Report) -> None:
        """Write the report, on a terminal a first selection unless options ask for something in particular."""
        context = click.get_current_context()
        names = {one.name or "" for one in context.command.params} - _OF_ANY_SELECTION
        given = any(context.get_parameter_source(one) is ParameterSource.COMMANDLINE for one in names)
        self.output.write(report, None if given else COMMANDS[self.command].first.split())
