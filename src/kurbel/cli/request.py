"""What the commands on one machine share: the machine with its results, the rows of its table, and the printing."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

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
from kurbel.report.delivery import cases_report
from kurbel.report.frame import Frame
from kurbel.report.rows import over_stroke, rows_where
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
    """What a command that prints a table for a machine is called with, by the names of the options.

    units: of the figures; where, over: what has a value, or the stroke, over which the rows are instead of the angle;
    cases: a row for each load case instead of all else.
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

    def given(self, **others: object) -> list[str]:
        """Return which of these options are given; others: options of single commands."""
        named = {"--columns": self.columns, "--angles": self.angles, "--where": self.where, "--over": self.over}
        return [option for option, value in (named | others).items() if value is not None]

    def case(self, cycle: int | None = None) -> Case:
        """Return the machine with its results, each computed on first use; cycle: number of one of a trace."""
        case = case_of(self.file, self.case_name, self.overrides, self.output.file_name)
        return case if cycle is None else Case(of_cycle(case.machine, cycle))

    def print(
        self, report: Callable[..., Report], *how: object, case: Case | None = None, parts: int = 1, **also: Any
    ) -> None:
        """Print what `report` returns of the machine, the frame and `how`; parts: tables over the crank angle.

        also: see `write`.
        """
        if self.cases:
            return self._print_cases()
        case = case or self.case()
        end = 360.0 * case.machine.revolutions if COMMANDS[self.command].turns else 360.0
        if self.command == "balance":
            end = case.balance.cycle
        self.write(report(case, self.frame(end, parts), *how), case, **also)

    def _print_cases(self) -> None:
        """Print a row for each load case of the file. Raises UsageError where it has none."""
        given = self.given(**{"--columns": None, "--case": self.case_name or None})
        if given:
            raise click.UsageError(f"--cases has a row for every load case; leave {' and '.join(given)} out.")
        machine = self.case().machine
        self.write(cases_report(machine, cases_of(machine), self.command, self.units, self.columns))

    def frame(self, end: float, parts: int) -> Frame:
        """Return the frame of the report: rows from 0 to `end` degrees for each of so many parts, or as requested."""
        if self.key_values_only and self.columns:
            raise click.UsageError(
                "--columns names columns of the table that --key-values leaves out; a key value is a line, grep 'p_i '"
            )
        ways = {"--where": self.where, "--over": self.over, "--angles": self.angles or None}
        given = [way for way, value in ways.items() if value is not None]
        if len(given) > 1:
            raise click.UsageError(f"{' and '.join(given)} both give crank angles; give only one of them.")
        angles: Any
        if self.where is not None:  # where a force has a value there is a motion to print, too
            angles = rows_where(self.where, "forces" if self.command == "motion" else self.command, end)
        elif self.over:
            angles = over_stroke(self.step, end)
        else:
            angles = crank_angles(self.step, self.angles, end, parts)
        prose = self.output.look.format != "csv" or self.key_values_only
        return Frame(self.command, angles, self.columns, self.units, "z" if self.over else "", self.compare, prose)

    def write(self, report: Report, case: Case | None = None, spreads: Spreads | None = None) -> None:
        """Write the requested part of the report; spreads: uncertainties of inputs in addition to those of the file."""
        if self.cylinder is not None:
            report = report.of_cylinder(self.cylinder)
        report = report.key_values_alone() if self.key_values_only else report
        if case and spreads is not None and (spreads or case.machine.uncertainty):
            from kurbel.designs.uncertainty import with_uncertainty

            progress = Progress(self.command)
            report = with_uncertainty(
                report, case, spreads, self.units, lambda items: progress.counted(items, "machines", len(items))
            )
        context = click.get_current_context()
        names = {one.name or "" for one in context.command.params} - _OF_ANY_SELECTION
        given = any(context.get_parameter_source(one) is ParameterSource.COMMANDLINE for one in names)
        self.output.write(report, None if given else COMMANDS[self.command].first.split())
