"""The report of `kurbel report`: all that a machine has, section by section; or two machines side by side."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import partial
from itertools import chain, zip_longest
from operator import itemgetter

import numpy as np

from kurbel.checks.check import checked
from kurbel.checks.limits import cases_report
from kurbel.declared.unit_systems import convert, shown_unit, units_of
from kurbel.errors import KurbelError, NoSolutionError, UsageError
from kurbel.notes.warnings import of_machine
from kurbel.numerics.extreme import number_of, size_of
from kurbel.page.contents import ENERGY, INPUT, LEFT_OUT, TABLES, Contents
from kurbel.page.summary import (
    facts_of,
    firing_order,
    first_page,
    limit_verdicts,
    results_if_any,
    subtitle_of,
)
from kurbel.pictures.picture import (
    Document,
    FactValue,
    Grid,
    Notice,
    OverAngle,
    Pair,
    Picture,
    ReportAnswers,
    Section,
    SectionItem,
)
from kurbel.pictures.picture_source import PictureOptions
from kurbel.pictures.pictures import PICTURES, PictureKind, pictures_if_any
from kurbel.quantity import Quantity
from kurbel.report.commands import REPORTS, Command, subjects_of
from kurbel.report.keys import meaning, places_of
from kurbel.solver.case import Case
from kurbel.solver.forces import RUBBING, SLIDING, CylinderForces
from kurbel.tables.frame import Frame, Subject, provenance
from kurbel.tables.tables import Part, Report, for_people, grouped, joined_names, stepped

KeyTexts = Sequence[tuple[str, str]]
"""The keys of a machine file with their values, as they were read."""
OnStep = Callable[[str], None]
"""Called with what is computed next."""
_NONE = "–"
_MOST_ROWS_IN_SHORT = 16
"""Rows of a table of places among the answers of all commands; longer ones are in the section of their command."""
EVERYTHING = Contents()


def _pictures(case: Case, command: str, system: str) -> list[Picture | str]:
    """Return the pictures of the section of a command; without one that of the first page."""
    pictures = list[Picture | str]()
    for kind in PICTURES:
        if kind.command == command:
            pictures += _drawn(case, kind, system)
    return pictures


def _drawn(case: Case, kind: PictureKind, system: str, name: str = "") -> list[Picture | str]:
    """Return one picture of a machine under this name, as often as it has it; without a solution a sentence."""
    try:
        pictures = pictures_if_any(case, kind, PictureOptions(system))
        return [picture._replace(machine=name) for picture in pictures]
    except NoSolutionError as error:
        return [f"{kind.title}: {error}"]


# one machine


@np.errstate(all="ignore")  # what overflows is refused by name
def whole_report(
    case: Case,
    key_texts: KeyTexts,
    system: str,
    step: float,
    progress: OnStep,
    cases: Sequence[Case] = (),
    contents: Contents = EVERYTHING,
) -> Document:
    """Return the report on a machine: a first page, pictures and tables of each command, energy balance, input.

    key_texts: the keys of its file; step: of the tables in degrees; cases: its load cases; contents: what is wanted of
    it. Raises UsageError for a section that is named and that this machine does not have.
    """
    stepped(step, 360.0)  # an invalid step is rejected at once
    machine = case.machine
    reports = _CommandSections(case, cases, system, step, contents)
    for command in REPORTS:
        progress(command.title.lower())
        reports.add(command)

    # what follows the commands
    sections = [*reports.sections]
    if contents.has(ENERGY):
        sections.append(Section(ENERGY, "Energy balance", tuple(_energy(case, system))))
    sections.append(Section(TABLES, "Over the crank angle", tuple(reports.tables)))
    if contents.has(LEFT_OUT):
        sections.append(Section(LEFT_OUT, "Left out", tuple(_left_out(reports.left_out))))
    if contents.has(INPUT):
        sections.append(Section(INPUT, "Input as understood", tuple(_input(case, key_texts))))
    return Document(
        machine.name,
        (subtitle_of(machine),),
        (*_pictures(case, "", system)[:1], *first_page(case, cases, system, reports.warnings)),
        tuple(section for section in sections if section.items),
        (provenance(machine),),
        contents.prints_tables,
    )


class _CommandSections:
    """The sections of the commands, and what their reports have for other sections.

    tables: over the crank angle; left_out: what and why, with the titles of the commands that leave it out; warnings:
    those of the whole machine, each once.
    """

    def __init__(
        self, case: Case, cases: Sequence[Case], system: str, step: float, contents: Contents
    ) -> None:
        self.case, self.cases = case, cases
        self.system, self.step = system, step
        self.contents = contents
        self.sections: list[Section] = []
        self.tables: list[SectionItem] = []
        self.left_out: dict[tuple[str, str], list[str]] = {}
        self.warnings = dict.fromkeys(of_machine(case))

    def add(self, command: Command) -> None:
        """Add the section of a command as far as it is wanted, or why the machine does not have it.

        Raises UsageError where it is named.
        """
        answers: list[SectionItem] = []
        try:
            report = _report_of(command, self.case, self.system, self.step)
        except NoSolutionError as error:
            answers.append(f"No solution: {error}")
        except UsageError as error:
            self._leave_out(command, error)
            return
        else:
            answers += self._answers(command, report)
            self._take_from(command, report)

        items: list[SectionItem] = []
        if self.contents.has_pictures(command.word):
            items += _pictures(self.case, command.word, self.system)
        if self.contents.has_answers(command.word):
            if command.word == "flywheel":
                items += firing_order(self.case.machine)
            items += answers
            items += self._load_cases(command)
        self.sections.append(Section(command.word, command.title, tuple(items)))

    def _answers(self, command: Command, report: Report) -> Iterator[SectionItem]:
        """Yield key values and tables of places of a command, in short if it is not named itself."""
        if command.word == "forces":
            report = _without_motion(report, self.case)
        if self.contents.has(command.word):
            yield ReportAnswers(report)
        else:
            yield from _in_short(report, command.word)

    def _take_from(self, command: Command, report: Report) -> None:
        """Take from a report what other sections show: its columns, what it leaves out, and its warnings."""
        has_columns = any(part.columns for part in report.all_parts)
        if has_columns and self.contents.has_table(command.word):
            self.tables.append(OverAngle(report, command.title))
        for part in report.all_parts:
            for reason in part.left_out:
                self.left_out.setdefault(reason, []).append(command.title.lower())
        # the warnings of a cylinder lack its name, and are among those of the machine
        if report.whole:
            self.warnings |= dict.fromkeys(report.whole.warnings)

    def _leave_out(self, command: Command, error: UsageError) -> None:
        """Note why the machine has no report of a command. Raises UsageError where it is named."""
        machine = self.case.machine.name
        why = str(error).removeprefix(f"{machine}: ")
        if command.word in self.contents.words:
            raise UsageError(f"--sections {command.word}: {machine}: {why}") from None
        self.left_out[command.title, why] = []

    def _load_cases(self, command: Command) -> Iterator[SectionItem]:
        """Yield the table of load cases of a command, if it has any."""
        if not self.cases or not command.in_cases:
            return
        with suppress(KurbelError):
            machine = self.case.machine
            yield ReportAnswers(cases_report(machine, self.cases, command.word, self.system))


def _report_of(command: Command, case: Case, system: str, step: float) -> Report:
    """Return the report of a command for people, with rows at even steps; raises as it does."""
    functions = command.functions
    angles = stepped(step, functions.last_angle(case), max(len(case.cylinders), 1))
    return for_people(functions.report(case, Frame(command.word, angles, None, system)))


def _in_short(report: Report, command: str) -> Iterator[SectionItem]:
    """Yield the answers of a report without what takes the most room, and which these are.

    Left out are long tables of places, and parts all of whose key values the whole machine has, too, as it has those
    of the worst throw.
    """
    of_whole = {key_value.id for key_value in report.whole.key_values} if report.whole else set()
    parts = list[Part]()
    left_out = list[str]()
    for part in report.parts:
        ids = {key_value.id for key_value in part.key_values}
        if ids and ids <= of_whole:
            left_out.append(str(part.name))
        else:
            parts.append(part)

    report = report._replace(parts=tuple(parts))
    long_tables = [
        table for table in report.printed_tables if len(table.names) > _MOST_ROWS_IN_SHORT
    ]
    left_out += [f"{table.title} ({len(table.names)} rows)" for table in long_tables]

    def without_long_tables(part: Part) -> Part:
        tables = tuple(table for table in part.place_tables if table not in long_tables)
        return part._replace(place_tables=tables)

    yield ReportAnswers(report.changed(without_long_tables))
    if left_out:
        yield f"Not in the short report, but in --sections {command}: {'; '.join(left_out)}."


def _left_out(reasons: Mapping[tuple[str, str], Sequence[str]]) -> Iterator[Grid]:
    """Yield the table of what was left out and why, if anything was; reasons: with the commands that leave it out."""
    rows = [(what, why, ", ".join(dict.fromkeys(words))) for (what, why), words in reasons.items()]
    if rows:
        yield Grid("", ("Part", "Why", "Of"), tuple(rows))


def _without_motion(report: Report, case: Case) -> Report:
    """Return the report on forces without the key values that the section on motion has."""
    ids = set()
    for cylinder in case.cylinders:
        for quantity in cylinder.lists.all_key_values:
            if quantity.commands[:1] == ("forces",):
                ids.add(quantity.id)

    def of_forces(part: Part) -> Part:
        key_values = (key_value for key_value in part.key_values if key_value.id in ids)
        return part._replace(key_values=tuple(key_values))

    return report.changed(of_forces)


def _input(case: Case, key_texts: KeyTexts) -> Iterator[Grid]:
    """Yield the keys of the file with their meanings, and the results of a check of the machine."""
    if key_texts:
        keys_by_path = places_of(key_texts)
        rows = tuple((path, value, meaning(path, keys_by_path)) for path, value in key_texts)
        yield Grid("Given", ("Key", "Value", "Meaning"), rows)
    for part in checked(case).shown_once:
        entries = [entry for entry in part.entries if entry.severity != "warning"]
        if entries and part.title not in ("Limits", "Expected"):
            yield Grid(part.title, ("", ""), tuple((entry.what, entry.text) for entry in entries))


def _energy(case: Case, system: str) -> Iterator[Grid]:
    """Yield the energy balance of every cylinder over a cycle, with its residual by an independent quadrature.

    Identical cylinders are listed once, those without a solution are omitted.
    """
    balances = [(forces.drive.name, _energy_rows(forces, system)) for forces in case.cylinders]
    with_rows = [(name, rows) for name, rows in balances if rows]
    for group in grouped(with_rows, itemgetter(1)):
        _, rows = group[0]
        yield Grid(
            joined_names([name for name, _ in group]), ("Per cycle", "Energy", "Unit"), rows, (1,)
        )


def _energy_rows(forces: CylinderForces, system: str) -> tuple[tuple[FactValue, ...], ...]:
    """Return the rows of an energy balance: each work, what is left of them, and the residual."""
    try:
        left, residual = forces.work_left, forces.energy_residual
        terms = list(_energy_terms(forces))
    except KurbelError:
        return ()
    if left is None:
        return ()
    terms = [(text, work) for text, work in terms if work]
    largest = max((abs(work) for _, work in terms), default=abs(left))
    unit = shown_unit("energy", system, largest)
    terms.append(("Reaches the shaft, 2π R W per turn", left))
    rows = [(text, float(convert(work, "energy", unit)), unit) for text, work in terms]
    is_rounding = residual is not None and abs(residual) < 1e-14
    shown_residual = "below 1e-14" if is_rounding else f"{residual:.2g}"
    return (
        *rows,
        ("Left open by an independent quadrature, over the turnover", shown_residual, ""),
    )


def _energy_terms(forces: CylinderForces) -> Iterator[tuple[str, float]]:
    """Yield what a cylinder takes in and gives off in a cycle, in J."""
    friction = forces.friction_works
    yield "Indicated work of the driving pistons", forces.work_driving
    yield "Indicated work of the driven pistons", forces.work_driven
    for name, (_, joint) in {**SLIDING, **RUBBING}.items():
        yield f"Friction {joint}", -(friction.get(name) or 0.0)
    yield "Friction given as a force", -(friction.get("constant") or 0.0)
    yield "What the output works against", forces.resistance_work
    yield "Load on the output", forces.load_work


# two machines side by side


@np.errstate(all="ignore")
def side_by_side(
    cases: Sequence[Case],
    key_texts: Sequence[KeyTexts],
    system: str,
    progress: OnStep,
    contents: Contents = EVERYTHING,
) -> Document:
    """Return the report on two machines: input that differs, key values with their differences, pictures in pairs.

    contents: what is wanted of it.
    """
    names = [case.machine.name for case in cases]
    if names[0] == names[1]:
        names = [f"{names[0]} (A)", f"{names[1]} (B)"]
    sections = []
    if contents.has(INPUT):
        input_items = tuple(_differing_input(cases, key_texts, names))
        sections.append(Section(INPUT, "What was given differently", input_items))
    for command in REPORTS:
        progress(command.title.lower())
        items = list[SectionItem]()
        if contents.has_pictures(command.word):
            items += _pairs(cases, command.word, names, system)
        if contents.has_answers(command.word):
            items += _key_values(cases, names, command.word, system)
        if items:
            sections.append(Section(command.word, command.title, tuple(items)))
    return Document(
        " and ".join(names),
        tuple(f"{name}: {subtitle_of(case.machine)}" for name, case in zip(names, cases)),
        tuple(_both_first(cases, names, system)),
        tuple(sections),
        tuple(provenance(case.machine) for case in cases),
    )


def _differing_input(
    cases: Sequence[Case], key_texts: Sequence[KeyTexts], names: Sequence[str]
) -> Iterator[SectionItem]:
    """Yield which machine is that of which file, and the keys with other values in both."""
    files = [case.machine.origin.name for case in cases if case.machine.origin]
    if len(files) == len(names):
        texts = [f"{name} is that of {file}" for name, file in zip(names, files)]
        yield "; ".join(texts) + "."
    left, right = map(dict, key_texts)
    rows = []
    for key in dict.fromkeys((*left, *right)):
        if left.get(key) != right.get(key):
            rows.append((key, left.get(key, _NONE), right.get(key, _NONE)))
    if rows:
        yield Grid("Keys", ("Key", *names), tuple(rows))
    else:
        yield "Nothing: both files give the same."


def _pairs(
    cases: Sequence[Case], command: str, names: Sequence[str], system: str
) -> Iterator[Pair]:
    """Yield the pictures of a command of both machines, which have their names in this report."""
    for kind in PICTURES:
        if kind.command != command:
            continue
        drawn = [_drawn(case, kind, system, name) for case, name in zip(cases, names)]
        for left, right in zip_longest(*drawn):
            left_picture = left if isinstance(left, Picture) else None
            right_picture = right if isinstance(right, Picture) else None
            if left_picture or right_picture:
                yield Pair(left_picture, right_picture)


def _both_first(cases: Sequence[Case], names: Sequence[str], system: str) -> Iterator[SectionItem]:
    """Yield both mechanisms, the key values that say most with their differences, verdicts and warnings of each."""
    yield from _pairs(cases, "", names, system)

    # the same facts of both, in the order of the first
    ids = dict[str, None]()
    for case in cases:
        ids |= dict.fromkeys(facts_of(case))
    titles: dict[Quantity, str] = {}
    numbers = []
    for case in cases:
        facts = facts_of(case, ids).values()
        titles |= {fact.quantity: fact.title for fact in facts}
        numbers.append({fact.quantity: fact.value for fact in facts})
    yield Grid("", _heads(names), _compared(numbers, system, titles), (1, 2, 4))

    for case, name in zip(cases, names):
        warnings = [Notice(text, "warning") for text in of_machine(case)]
        items = [*limit_verdicts(case), *warnings]
        if items:
            yield f"{name}:"
            yield from items
        if not warnings:
            yield Notice(f"{name}: no warnings.", "good")


def _heads(names: Sequence[str]) -> tuple[str, ...]:
    return "Symbol", *names, "Unit", "Difference", "Meaning"


def _key_values(
    cases: Sequence[Case], names: Sequence[str], command: str, system: str
) -> Iterator[Grid]:
    """Yield the key values of both machines, cylinder by cylinder, identical ones once."""
    subjects = []
    for case in cases:
        of_case = results_if_any(partial(subjects_of, case, command))
        subjects.append([subject for subject in of_case if subject.results])
    pairs = list(zip_longest(*subjects))

    compared = []
    for pair in pairs:
        numbers = [_numbers(subject, command) for subject in pair]
        meanings = {quantity: quantity.text for quantity in chain(*numbers)}
        compared.append(((pair[0] or pair[1]).name, _compared(numbers, system, meanings)))
    for group in grouped(compared, itemgetter(1)):
        _, rows = group[0]
        title = joined_names([name for name, _ in group]) if len(pairs) > 1 else "Key values"
        if rows:
            yield Grid(title, _heads(names), rows, (1, 2, 4))


def _numbers(subject: Subject | None, command: str) -> dict[Quantity, float]:
    """Return the key values of a subject in SI, without lists and residuals."""
    if not subject:
        return {}
    numbers = {}
    for quantity, value in results_if_any(partial(subject.key_values, command)):
        number = number_of(value)
        if isinstance(number, (int, float)) and not quantity.residual:
            numbers[quantity] = number
    return numbers


def _compared(
    numbers: Sequence[dict[Quantity, float]], system: str, meanings: dict[Quantity, str]
) -> tuple[tuple[FactValue, ...], ...]:
    """Return a row for each key value of two machines: symbol, both values, unit, difference, meaning."""
    left, right = numbers
    pairs = {quantity: (left.get(quantity), right.get(quantity)) for quantity in (*left, *right)}
    sizes = [
        (quantity.kind, quantity.family, max(map(size_of, pair)))
        for quantity, pair in pairs.items()
    ]
    rows = []
    for (quantity, pair), unit in zip(pairs.items(), units_of(sizes, system)):
        shown = list[FactValue]()
        for value in pair:
            in_unit = None if value is None else float(convert(value, quantity.kind, unit))
            shown.append(_NONE if in_unit is None else in_unit)
        marked = quantity.marked(unit)
        rows.append((quantity.symbol, *shown, marked, _difference(*pair), meanings[quantity]))
    return tuple(rows)


def _difference(first: float | None, second: float | None) -> str:
    """Return by how many percent the second value differs from the first."""
    if first is None or second is None:
        return _NONE
    if not first:
        return _NONE if second else "0 %"
    percent = 100 * (second - first) / abs(first)
    if not percent:
        return "0 %"
    if abs(percent) < 100:
        return f"{percent:+.2f} %"
    return f"{percent:+.0f} %"
