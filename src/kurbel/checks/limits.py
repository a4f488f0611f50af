"""How key values compare with limits and expectations of a machine file, and in a table of load cases."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import NamedTuple

import numpy as np

from kurbel.declared.forms.figures import MACHINE, Bound, Expected, scoped
from kurbel.declared.reading import text_in_one_line
from kurbel.declared.unit_systems import SI, convert, requested_system, shown_unit
from kurbel.errors import KurbelError, Path, UsageError, path_text
from kurbel.machine import Machine
from kurbel.near_words import did_you_mean
from kurbel.numerics.extreme import Extreme, number_of
from kurbel.quantities import KEY_VALUES, key_values_of, key_values_of_chapters
from kurbel.quantity import NOISE_POWER, Quantity, called
from kurbel.report.commands import COMMANDS, subjects_of
from kurbel.solver.case import Case
from kurbel.tables.frame import Frame, Subject, report_on
from kurbel.tables.shown import PlaceRow, Places, too_large
from kurbel.tables.tables import Report, grouped, joined_names

_ROUNDING = 1e-9
"""Relative tolerance of a bound: a stroke of 110 mm does not break a limit of 110 mm through rounding."""


class CheckEntry(NamedTuple):
    """One line of a section of a check.

    severity: `error` for a limit or an expectation that FAILs, `warning`, `info`, or '' for a plain statement; path: of
    its subject in the machine file. A verdict also has quantity, value with unit, bound, and where: the owner; a figure
    that cannot be compared has the error, whose message includes the path.
    """

    what: str
    text: str
    severity: str = ""
    path: Path = ()
    value: float | None = None
    unit: str = ""
    bound: str = ""
    where: str = ""
    quantity: Quantity | None = None
    error: KurbelError | None = None
    figure: "JudgedFigure | None" = None


class JudgedFigure(NamedTuple):
    """A value that was compared, in SI, for programs and for the table of margins.

    scope: whose it is; bound: of a limit; or the smallest and the largest value that meet an expectation; margin:
    distance from the bound, or the nearer one, relative to it: negative on a FAIL, None for a bound of 0; case: the load
    case, '' for the machine itself.
    """

    id: str
    scope: str
    value: float
    bound: float | tuple[float, float]
    unit: str
    margin: float | None
    verdict: str
    case: str = ""


def compared_entries(case: Case, cases: Sequence[Case] = ()) -> list[CheckEntry]:
    """Return how limits and expectations of a machine compare, in its load cases, too."""
    entries = [*judged(case)]
    for load_case in cases:
        origin = load_case.machine.origin
        name = origin.case if origin else ""
        suffix = f", {name}" if origin else ""
        for entry in judged(load_case):
            figure = entry.figure and entry.figure._replace(case=name)
            entries.append(entry._replace(what=entry.what + suffix, figure=figure))
    return entries


@np.errstate(all="ignore")
def judged(case: Case) -> Iterator[CheckEntry]:
    """Yield how each limit and then each expectation compares, or why it cannot be compared.

    Values that are equal to nine digits are compared once.
    """
    for name, limit in case.machine.limits:
        bound = limit if isinstance(limit, Bound) else Bound(limit)
        yield from _judged_figure(case, "limits", name, bound)
    for name, expected in case.machine.expect:
        yield from _judged_figure(case, "expect", name, expected)


def _judged_figure(
    case: Case, key: str, name: str, bound: Bound | Expected
) -> Iterator[CheckEntry]:
    """Yield how the values that one limit or expectation is for compare; key: `limits` or `expect`."""
    quantity = KEY_VALUES[scoped(name)[1]]
    path = (key, bound.name or name)
    # the values, with their owners
    try:
        values = _values(case, name)
        if not values:
            meaning = f"{quantity.text[:1].lower()}{quantity.text[1:]}"
            raise UsageError(f"{no_such_value(path[1], quantity.id)}: {meaning}")
    except KurbelError as error:
        yield CheckEntry(name, "", path=path, error=type(error)(f"{path_text(path)}: {error}"))
        return
    # equal ones are compared once
    is_within = True
    for equal in grouped(values, lambda owner_and_value: f"{owner_and_value[1]:.9g}"):
        owners = joined_names([owner for owner, _ in equal])
        _, value = equal[0]
        verdict = _compared(path, quantity, bound, owners, value)
        is_within = is_within and verdict.severity == "info"
        yield verdict
    if is_within and not isinstance(bound, Expected):
        siblings = KEY_VALUES.of_chapter_with(quantity.id)
        yield from _beyond_by_sign(case, name, bound, path, siblings)


def no_such_value(name: str, id: str) -> str:
    """Return the message that the machine, or the part of it with this name, does not have a key value."""
    scope, _ = scoped(name)
    owner = {"": "this machine", MACHINE: "the whole machine"}.get(scope, scope)
    return f"{owner} has no {id}"


def _compared(
    path: Path, quantity: Quantity, bound: Bound | Expected, where: str, value: float
) -> CheckEntry:
    """Compare a value in SI with its bound or expectation; a value that is not finite cannot be compared."""
    name = str(path[-1])
    if not math.isfinite(value):
        error = UsageError(f"{path_text(path)} ({where}): {too_large(quantity)}")
        return CheckEntry(name, "", path=path, error=error)
    if isinstance(bound, Expected):
        text, limit, is_met = _compared_with_expected(quantity, bound, value)
    else:
        text, limit, is_met = _compared_with_bound(quantity, bound, value)
    limits = (bound.low, bound.high) if isinstance(bound, Expected) else float(bound)
    figure = JudgedFigure(
        quantity.id,
        where,
        value,
        limits,
        SI[quantity.kind],
        _margin(quantity, bound, value),
        "PASS" if is_met else "FAIL",
    )
    unit = _unit_of(bound, quantity.kind, value)
    number = 100 * value if unit == "%" else float(convert(value, quantity.kind, unit))
    return CheckEntry(
        name,
        f"{text}  ({where})",
        "info" if is_met else "error",
        path,
        number,
        unit or SI[quantity.kind],
        limit,
        where,
        quantity,
        figure=figure,
    )


def _margin(quantity: Quantity, bound: Bound | Expected, value: float) -> float | None:
    """Return the distance of a value from its bound relative to it, positive where it is met; None for a bound of 0."""
    if isinstance(bound, Expected):
        distance = min(value - bound.low, bound.high - value)
        edge = bound.low if value - bound.low < bound.high - value else bound.high
        if not edge:
            return None
        return distance / abs(edge)
    magnitude = abs(value) if quantity.id.endswith("_residual") else value
    distance = magnitude - bound if quantity.bounded_below else bound - magnitude
    if not bound:
        return None
    return distance / abs(bound)


def margins(entries: Iterable[CheckEntry]) -> dict[str, dict[str, float]]:
    """Return the smallest margin of each limit in each load case, by limit and case; empty without load cases."""
    smallest: dict[str, dict[str, float]] = {}
    for entry in entries:
        figure = entry.figure
        if figure is None or figure.margin is None or entry.path[0] != "limits":
            continue
        of_limit = smallest.setdefault(str(entry.path[-1]), {})
        of_limit[figure.case] = min(figure.margin, of_limit.get(figure.case, figure.margin))
    has_cases = any(load_cases_of(smallest))
    return smallest if has_cases else {}


def load_cases_of(table: Mapping[str, Mapping[str, float]]) -> list[str]:
    """Return the load cases of a table of margins, in the order in which they first occur; '' is the machine itself."""
    cases = dict[str, None]()
    for of_limit in table.values():
        cases |= dict.fromkeys(of_limit)
    return list(cases)


def margin_text(margin: float | None) -> str:
    """Return a margin in percent with its sign.

    >>> margin_text(0.0389), margin_text(-1.7), margin_text(None)
    ('+3.9 %', '-170.0 %', '–')
    """
    if margin is None:
        return "–"
    return f"{100 * margin:+.1f} %"


def _compared_with_expected(
    quantity: Quantity, expected: Expected, value: float
) -> tuple[str, str, bool]:
    """Return the verdict on a value in SI, what is expected, and whether it is met."""
    kind = quantity.kind
    unit = _unit_of(expected, kind, value)
    limit = expected.text
    if not limit or unit != expected.unit:
        limit = f"{_shown(expected.low, kind, unit)} to {_shown(expected.high, kind, unit)}"
    too_small_by = expected.low - value
    too_large_by = value - expected.high
    deviation = max(too_small_by, too_large_by)
    is_met = deviation <= _ROUNDING * max(abs(expected.low), abs(expected.high))
    verdict = "PASS"
    if not is_met:
        size = "small" if too_small_by > too_large_by else "large"
        verdict = f"FAIL, {_shown(deviation, kind, unit, is_difference=True)} too {size}"
    shown = _shown_value(quantity, value, unit)
    return f"{shown}, expected {limit}  {verdict}", limit, is_met


def _compared_with_bound(quantity: Quantity, bound: Bound, value: float) -> tuple[str, str, bool]:
    """Return the verdict on a value in SI, the bound, and whether it is met."""
    unit = _unit_of(bound, quantity.kind, value)
    shown = _shown_value(quantity, value, unit)
    counts_by_magnitude = quantity.id.endswith("_residual")
    if counts_by_magnitude and not quantity.is_noise(value):
        shown = f"|{shown}|"
    shown_bound = _shown(bound, quantity.kind, unit)
    met_sign, broken_sign = ("≥", "<") if quantity.bounded_below else ("≤", ">")
    limit = f"{met_sign} {shown_bound}"
    if breaks(quantity, bound, value):
        return f"{shown} {broken_sign} {shown_bound}  FAIL", limit, False
    return f"{shown} {limit}  PASS", limit, True


def _shown_value(quantity: Quantity, value: float, unit: str) -> str:
    """Return a key value in SI with its unit; of what is only rounding, below which power of ten it is."""
    if quantity.is_noise(value):
        return f"< 1e{NOISE_POWER}"
    return _shown(value, quantity.kind, unit)


def breaks(quantity: Quantity, bound: float, value: float) -> bool:
    """Return whether a key value is below a lower bound or above an upper one; of a residual its magnitude counts."""
    magnitude = abs(value) if quantity.id.endswith("_residual") else value
    excess = bound - value if quantity.bounded_below else magnitude - bound
    return excess > _ROUNDING * abs(bound)


def _unit_of(figure: Bound | Expected, kind: str, value: float) -> str:
    """Return the unit in which a figure is compared: that of the file, or of the unit system that is requested."""
    system = requested_system()
    if not system or figure.unit == "%":
        return figure.unit
    return shown_unit(kind, system, value)


def _shown(value: float, kind: str, unit: str, is_difference: bool = False) -> str:
    """Return a value with its unit, which is that of SI where it is ''."""
    if unit == "%":
        return f"{100 * value:.9g} %"
    return f"{convert(value, kind, unit, is_difference):.9g} {unit or SI[kind]}".rstrip()


def _beyond_by_sign(
    case: Case, name: str, bound: Bound, path: Path, declared: Mapping[str, Quantity]
) -> Iterator[CheckEntry]:
    """Yield a note if the extreme of the other sign has a larger magnitude than a limit, which does not apply to it.

    declared: the key values of the chapter that has this one.
    """
    base, _, extreme = name.rpartition("_")
    if extreme == "max":
        other, sign = f"{base}_min", 1
    elif extreme == "min":
        other, sign = f"{base}_max", -1
    else:
        return
    quantity = declared.get(scoped(other)[1])
    has_limit = other in dict(case.machine.limits)
    if quantity is None or has_limit or bound * sign <= 0:
        return
    # values of the other sign
    peak = f"{base}_peak"
    advice = f"bound '{other}' too"
    if scoped(peak)[1] in declared:
        advice = f"'{peak}' bounds the magnitude"
    with suppress(KurbelError):
        for where, value in _values(case, other):
            if -value * sign > abs(bound) * (1 + _ROUNDING):
                size = _shown(value, quantity.kind, _unit_of(bound, quantity.kind, value))
                text = f"{other} = {size} is beyond it with the other sign; {advice}  ({where})"
                yield CheckEntry(str(path[-1]), text, "warning", path)


# whose key values the limits and expectations are for


class Holder(NamedTuple):
    """Who has a key value, and the command that prints it."""

    subject: Subject
    quantity: Quantity
    command: str


def _values(case: Case, name: str) -> list[tuple[str, float]]:
    """Return who has a key value that a figure of this name is for, with the values in SI; raises KurbelError."""
    values = []
    for holder in holders(case, name):
        value = holder.subject.answer(holder.quantity)
        if isinstance(value, (Extreme, float)):
            values.append((holder.subject.name, number_of(value)))
    return values


def holders(case: Case, name: str) -> list[Holder]:
    """Return whose key value a figure is for: of the machine or a cylinder that its name is scoped to.

    Without a scope, of each cylinder that has it, or would have it but for an error; else of the machine.
    """
    scope, id = scoped(name)
    cylinders = [cylinder.name for cylinder in case.machine.cylinders]
    # what the only cylinder does not have, the machine does not have
    commands = [next(KEY_VALUES.commands_of(id))]
    may_be_of_machine = bool(scope) or len(cylinders) != 1
    if may_be_of_machine and id in key_values_of_chapters("flywheel"):
        commands.append("flywheel")
    of_machine: list[Holder] = []
    for command in dict.fromkeys(commands):
        of_scope = []
        for subject in subjects_of(case, command, pistons=bool(scope)):
            quantity = subject.lists.key_values(command).get(id)
            # of the throws of a crankshaft the worst counts, unless one is named
            is_in_worst = command == "stress" and not subject.whole and subject.name != scope
            if quantity is None or is_in_worst:
                continue
            holder = Holder(subject, quantity, command)
            is_cylinder = subject.name in cylinders
            if scope:
                is_named = subject.name == scope
                if is_named or (not is_cylinder and (subject.of or MACHINE) == scope):
                    of_scope.append(holder)
            elif not is_cylinder:
                of_machine.append(holder)
            elif _has_value(holder):
                of_scope.append(holder)
        if of_scope:
            return of_scope
    return of_machine


def _has_value(holder: Holder) -> bool:
    """Return whether a subject has its key value, or would have it but for an error."""
    try:
        return holder.subject.answer(holder.quantity) is not None
    except KurbelError:
        return True


# load cases: a row for each, of the key values of a command


def name_of(case: Case) -> str:
    """Return the name of a load case, or of the machine itself."""
    machine = case.machine
    if machine.origin:
        return machine.origin.case
    return machine.name


@np.errstate(all="ignore")  # what overflows is refused by name
def cases_report(
    base: Machine,
    cases: Sequence[Case],
    command: str,
    system: str,
    names: Sequence[str] | None = None,
) -> Report:
    """Return the key values of load cases, a row for each, of each part of the machine.

    base: the machine as it is without them; names: ids or symbols of the key values. Raises UsageError for a name that
    is none, and if no case has any.
    """
    # the key values that are wanted
    wanted = names or COMMANDS[command].in_cases.split()
    declared = key_values_of(command, wanted)
    chosen: dict[str, Quantity] = {}
    for name in wanted:
        ids = called(name, declared.values())
        if not ids:
            hint = did_you_mean(name, tuple(declared))
            raise UsageError(
                f"--columns: '{text_in_one_line(name)}' is no key value of kurbel {command}{hint}"
            )
        chosen[ids[0]] = declared[ids[0]]

    # rows by the part of the machine; a case that cannot be computed is a note
    rows: dict[str, list[PlaceRow]] = {}
    notes: list[str] = []
    for case in cases:
        try:
            for subject in subjects_of(case, command):
                quantities = chosen
                if not names:
                    quantities = _printed(subject, chosen)
                values = _numbers(subject, quantities)
                if values:
                    rows.setdefault(subject.name, []).append(((name_of(case),), values))
        except KurbelError as error:
            notes.append(f"{name_of(case)}: {error}")
    if not rows:
        none = f"{base.name}: no case has any of {', '.join(chosen)}"
        raise UsageError("; ".join(notes) or none)

    # a table for each part
    parts = []
    for part, rows_of_part in rows.items():
        title = f"Load cases: {part}" if len(rows) > 1 else "Load cases"
        table = Places("cases", title, ("case",), chosen, rows_of_part, headed=True)
        parts.append(Subject(part, tables=[table]))
    return report_on(Frame(command, (), None, system), base, "Load cases", parts, notes)


def _printed(subject: Subject, quantities: Mapping[str, Quantity]) -> dict[str, Quantity]:
    """Return those of these key values that a part prints, as only compressors have rod loads."""
    return {id: quantity for id, quantity in quantities.items() if subject.is_printed(quantity)}


def _numbers(subject: Subject, quantities: Mapping[str, Quantity]) -> dict[str, float]:
    """Return those of these key values that are numbers, by id."""
    answers = {id: number_of(subject.answer(quantity)) for id, quantity in quantities.items()}
    return {id: answer for id, answer in answers.items() if isinstance(answer, float)}
