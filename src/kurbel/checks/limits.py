"""How key values compare with limits and expectations of a machine file, and in a table of load cases."""

import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from typing import NamedTuple

import numpy as np

from kurbel.declared.forms.figures import MACHINE, Bound, Expected, scoped
from kurbel.declared.reading import text_in_one_line
from kurbel.declared.unit_systems import SI, convert
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
from kurbel.tables.tables import Report, grouped, together

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


def compared_entries(case: Case, cases: Sequence[Case] = ()) -> list[CheckEntry]:
    """Return how limits and expectations of a machine compare, in its load cases, too."""
    found = [*judged(case)]
    for one in cases:
        of_case = f", {one.machine.origin.case}" if one.machine.origin else ""
        found += [entry._replace(what=entry.what + of_case) for entry in judged(one)]
    return found


@np.errstate(all="ignore")
def judged(case: Case) -> Iterator[CheckEntry]:
    """Yield how each limit and then each expectation compares, or why it cannot be compared.

    Values that are equal to nine digits are compared once.
    """
    machine, declared = case.machine, KEY_VALUES
    figures = [("limits", *limit) for limit in machine.limits] + [
        ("expect", *one) for one in machine.expect
    ]
    for key, name, figure in figures:
        bound = figure if isinstance(figure, (Bound, Expected)) else Bound(figure)
        quantity, path = declared[scoped(name)[1]], (key, bound.name or name)
        try:
            found = _values(case, name)
            if not found:
                text = f"{quantity.text[:1].lower()}{quantity.text[1:]}"
                raise UsageError(f"{no_such_value(path[1], quantity.id)}: {text}")
        except KurbelError as error:
            yield CheckEntry(name, "", path=path, error=type(error)(f"{path_text(path)}: {error}"))
            continue
        verdicts = [
            _compared(path, quantity, bound, together([where for where, _ in equal]), equal[0][1])
            for equal in grouped(found, lambda one: f"{one[1]:.9g}")
        ]
        yield from verdicts
        is_within = all(verdict.severity == "info" for verdict in verdicts)
        if is_within and not isinstance(bound, Expected):
            siblings = declared.of_chapter_with(quantity.id)
            yield from _beyond_by_sign(case, name, bound, path, siblings)


def no_such_value(name: str, id: str) -> str:
    """Return the message that the machine, or the part of it with this name, does not have a key value."""
    scope = {"": "this machine", MACHINE: "the whole machine"}.get(scoped(name)[0], scoped(name)[0])
    return f"{scope} has no {id}"


def _compared(
    path: Path, quantity: Quantity, bound: Bound | Expected, where: str, value: float
) -> CheckEntry:
    """Compare a value in SI with its bound or expectation; a value that is not finite cannot be compared."""
    if not math.isfinite(value):
        error = UsageError(f"{path_text(path)} ({where}): {too_large(quantity)}")
        return CheckEntry(str(path[-1]), "", path=path, error=error)
    kind, unit, noise = quantity.kind, bound.unit, quantity.is_noise(value)
    size = f"< 1e{NOISE_POWER}" if noise else _shown(value, kind, unit)
    if isinstance(bound, Expected):
        low, high = bound.low - value, value - bound.high
        ok = max(low, high) <= _ROUNDING * max(abs(bound.low), abs(bound.high))
        limit = bound.text or f"{_shown(bound.low, kind, '')} to {_shown(bound.high, kind, '')}"
        off = f", {_shown(max(low, high), kind, unit)} too {'small' if low > high else 'large'}"
        text = f"{size}, expected {limit}  {'PASS' if ok else 'FAIL' + off}"
    else:
        ok, (sign, broken) = (
            not breaks(quantity, bound, value),
            "≥<" if quantity.bounded_below else "≤>",
        )
        limit = f"{sign} {_shown(bound, kind, unit)}"
        size = f"|{size}|" if quantity.id.endswith("_residual") and not noise else size
        text = f"{size} {limit}  PASS" if ok else f"{size} {broken}{limit[1:]}  FAIL"
    number = 100 * value if unit == "%" else float(convert(value, kind, unit))
    severity, text = "info" if ok else "error", f"{text}  ({where})"
    return CheckEntry(
        str(path[-1]), text, severity, path, number, unit or SI[kind], limit, where, quantity
    )


def breaks(quantity: Quantity, bound: float, value: float) -> bool:
    """Return whether a key value is below a lower bound or above an upper one; of a residual its magnitude counts."""
    magnitude = abs(value) if quantity.id.endswith("_residual") else value
    excess = bound - value if quantity.bounded_below else magnitude - bound
    return excess > _ROUNDING * abs(bound)


def _shown(value: float, kind: str, unit: str) -> str:
    """Return a value with its unit, which is that of the file if it has one."""
    if unit == "%":
        return f"{100 * value:.9g} %"
    return f"{convert(value, kind, unit):.9g} {unit or SI[kind]}".rstrip()


def _beyond_by_sign(
    case: Case, name: str, bound: Bound, path: Path, declared: Mapping[str, Quantity]
) -> Iterator[CheckEntry]:
    """Yield a note if the extreme of the other sign has a larger magnitude than a limit, which does not apply to it.

    declared: the key values of the chapter that has this one.
    """
    base, _, end = name.rpartition("_")
    other, upward = (f"{base}_min", 1) if end == "max" else (f"{base}_max", -1)
    quantity = declared.get(scoped(other)[1]) if end in ("max", "min") else None
    if quantity is None or bound * upward <= 0 or other in dict(case.machine.limits):
        return
    peak = f"{base}_peak"
    advice = (
        f"'{peak}' bounds the magnitude" if scoped(peak)[1] in declared else f"bound '{other}' too"
    )
    with suppress(KurbelError):
        for where, value in _values(case, other):
            if -value * upward > abs(bound) * (1 + _ROUNDING):
                size = _shown(value, quantity.kind, bound.unit)
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
    values = [
        (holder.subject.name, holder.subject.answer(holder.quantity))
        for holder in holders(case, name)
    ]
    return [
        (where, number_of(value)) for where, value in values if isinstance(value, (Extreme, float))
    ]


def holders(case: Case, name: str) -> list[Holder]:
    """Return whose key value a figure is for: of the machine or a cylinder that its name is scoped to.

    Without a scope, of each cylinder that has it, or would have it but for an error; else of the machine.
    """

    def has_it(one: Holder) -> bool:
        try:
            return one.subject.answer(one.quantity) is not None
        except KurbelError:
            return True

    scope, id = scoped(name)
    cylinders = [cylinder.name for cylinder in case.machine.cylinders]
    first = next(KEY_VALUES.commands_of(id))
    # what the only cylinder does not have, the machine does not have
    may_be_of_whole = bool(scope) or len(cylinders) != 1
    whole = ["flywheel"] if may_be_of_whole and id in key_values_of_chapters("flywheel") else []
    of_machine: list[Holder] = []
    for command in dict.fromkeys((first, *whole)):
        own = []
        for subject in subjects_of(case, command, pistons=bool(scope)):
            quantity = subject.lists.key_values(command).get(id)
            # of the throws of a crankshaft the worst counts, unless one is named
            is_in_worst = command == "stress" and not subject.whole and subject.name != scope
            if quantity is None or is_in_worst:
                continue
            one, of_cylinder = Holder(subject, quantity, command), subject.name in cylinders
            owner = subject.name if of_cylinder or subject.name == scope else subject.of or MACHINE
            if owner == scope or (not scope and of_cylinder and has_it(one)):
                own.append(one)
            elif not scope and not of_cylinder:
                of_machine.append(one)
        if own:
            return own
    return of_machine


# load cases: a row for each, of the key values of a command


def name_of(case: Case) -> str:
    """Return the name of a load case, or of the machine itself."""
    return case.machine.origin.case if case.machine.origin else case.machine.name


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
    wanted = names or COMMANDS[command].in_cases.split()
    declared = key_values_of(command, wanted)
    known = {name: called(name, declared.values()) for name in wanted}
    for name in (name for name, ids in known.items() if not ids):
        near = did_you_mean(name, tuple(declared))
        raise UsageError(
            f"--columns: '{text_in_one_line(name)}' is no key value of kurbel {command}{near}"
        )
    ids = [ids[0] for ids in known.values()]
    rows: dict[str, list[PlaceRow]] = {}
    notes: list[str] = []
    for case in cases:
        try:
            for subject in subjects_of(case, command):
                answers = {id: number_of(subject.answer(declared[id])) for id in ids}
                values = {id: one for id, one in answers.items() if isinstance(one, float)}
                if values:
                    rows.setdefault(subject.name, []).append(((name_of(case),), values))
        except KurbelError as error:
            notes.append(f"{name_of(case)}: {error}")
    if not rows:
        raise UsageError("; ".join(notes) or f"{base.name}: no case has any of {', '.join(ids)}")
    chosen = {id: declared[id] for id in ids}

    parts = []
    for name, of_part in rows.items():
        title = f"Load cases: {name}" if len(rows) > 1 else "Load cases"
        parts.append(
            Subject(name, tables=[Places("cases", title, ("case",), chosen, of_part, headed=True)])
        )
    return report_on(Frame(command, (), None, system), base, "Load cases", parts, notes)
