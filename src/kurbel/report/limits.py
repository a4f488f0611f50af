"""How key values compare with the limits and the expectations of a machine file."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple, Union

import numpy as np

from kurbel.declared.forms.figures import MACHINE, Expected, scoped
from kurbel.declared.unit_systems import SI, convert
from kurbel.errors import KurbelError, Path, UsageError, path_text
from kurbel.numerics.extreme import Extreme, number_of
from kurbel.quantities import every_quantity
from kurbel.quantity import NOISE_POWER, Quantity, by_id
from kurbel.report.alike import grouped, together
from kurbel.report.commands import subjects_of
from kurbel.report.frame import Subject, too_large
from kurbel.solver.case import Case

_ROUNDING = 1e-9
"""A bound is no more exact than what is printed of it: a stroke of 110 mm does not break a limit of 110 mm."""


class Entry(NamedTuple):
    """One line of a section of a check.

    severity: `error` of a limit that is broken or a figure that is off, `warning`, `info`, or '' of a plain statement;
    path: of what it is about in the machine file.
    """

    what: str
    text: str
    severity: str = ""
    path: Path = ()


class Comparison(NamedTuple):
    """A limit or an expectation: its path in the file, the value in SI, the bound, whose value it is, if it holds."""

    path: Path
    quantity: Quantity
    value: float
    bound: float | Expected
    where: str
    ok: bool


class Unjudged(NamedTuple):
    """A limit or an expectation that cannot be compared, and why; the error names its path, too."""

    path: Path
    error: KurbelError


Found = Union[list[tuple[str, float]], KurbelError]
"""Who has a key value, with the values in SI; or what keeps them from being computed."""


@np.errstate(all="ignore")
def judged(case: Case) -> Iterator[Entry | Unjudged]:
    """Yield how each limit and then each expectation compares, or why it cannot be compared."""
    machine = case.machine
    if not machine.limits and not machine.expect:
        return
    declared = by_id(*every_quantity().all_key_values)
    found = {
        name: _values(case, name) for name in dict.fromkeys(name for name, _ in (*machine.limits, *machine.expect))
    }
    for name, bound in machine.limits:
        verdicts = _compared_all("limits", name, bound, declared, found[name])
        yield from map(_entry, verdicts)
        if all(isinstance(one, Comparison) and one.ok for one in verdicts):
            yield from _beyond_by_sign(case, name, bound, declared)
    for name, figure in machine.expect:
        yield from map(_entry, _compared_all("expect", name, figure, declared, found[name]))


def _compared_all(
    key: str, name: str, bound: float | Expected, declared: Mapping[str, Quantity], found: Found
) -> list[Comparison | Unjudged]:
    """Compare the values of all that a figure applies to with it, those equal to nine digits once."""
    quantity, path = declared[scoped(name)[1]], _path(key, name, bound)
    if isinstance(found, KurbelError):
        return [Unjudged(path, type(found)(f"{path_text(path)}: {found}"))]
    if not found:
        text = f"{without(str(path[-1]), quantity.id)}: {quantity.text[:1].lower()}{quantity.text[1:]}"
        return [Unjudged(path, UsageError(f"{path_text(path)}: {text}"))]
    return [
        compared(path, quantity, bound, together([where for where, _ in equal]), equal[0][1])
        for equal in grouped(found, lambda one: f"{one[1]:.9g}")
    ]


def _path(key: str, id: str, bound: float | Expected) -> Path:
    """Return where a figure is in the file, under the name that is written there."""
    return (key, getattr(bound, "name", "") or id)


def without(name: str, id: str) -> str:
    """Return that the machine, or the part of it that a figure is for, does not have this key value."""
    scope = {"": "this machine", MACHINE: "the whole machine"}.get(scoped(name)[0], scoped(name)[0])
    return f"{scope} has no {id}"


def compared(
    path: Path, quantity: Quantity, bound: float | Expected, where: str, value: float
) -> Comparison | Unjudged:
    """Compare a value in SI with its bound or expectation; what is not finite cannot be compared."""
    if not math.isfinite(value):
        return Unjudged(path, UsageError(f"{path_text(path)} ({where}): {too_large(quantity)}"))
    if isinstance(bound, Expected):
        ok = max(bound.low - value, value - bound.high) <= _ROUNDING * max(abs(bound.low), abs(bound.high))
    else:
        ok = not breaks(quantity, bound, value)
    return Comparison(path, quantity, value, bound, where, ok)


def breaks(quantity: Quantity, bound: float, value: float) -> bool:
    """Return whether a key value breaks its bound: is below one from below, above any other; a residual, in size."""
    magnitude = abs(value) if _in_size(quantity) else value
    excess = bound - value if quantity.bounded_below else magnitude - bound
    return excess > _ROUNDING * abs(bound)


def _in_size(quantity: Quantity) -> bool:
    return quantity.id.endswith("_residual")


def _entry(one: Comparison | Unjudged) -> Entry | Unjudged:
    if isinstance(one, Unjudged):
        return one
    figure, quantity, unit = one.bound, one.quantity, getattr(one.bound, "unit", "")
    size = f"< 1e{NOISE_POWER}" if quantity.is_noise(one.value) else _shown(one.value, quantity.kind, unit)
    if isinstance(figure, Expected):
        low, high = figure.low - one.value, one.value - figure.high
        off = f"OFF, {_shown(max(low, high), quantity.kind, unit)} too {'small' if low > high else 'large'}"
        wanted = figure.text or f"{_shown(figure.low, quantity.kind, '')} to {_shown(figure.high, quantity.kind, '')}"
        text = f"{size}, expected {wanted}  {'met' if one.ok else off}"
    else:
        size = f"|{size}|" if _in_size(quantity) and not quantity.is_noise(one.value) else size
        sign = ("≥" if one.ok else "<") if quantity.bounded_below else ("≤" if one.ok else ">")
        text = f"{size} {sign} {_shown(figure, quantity.kind, unit)}  {'kept' if one.ok else 'BROKEN'}"
    return Entry(str(one.path[-1]), f"{text}  ({one.where})", "info" if one.ok else "error", one.path)


def _shown(value: float, kind: str, unit: str) -> str:
    """Return a value with its unit, in that of the file if one is written there."""
    if unit == "%":
        return f"{100 * value:.9g} %"
    return f"{convert(value, kind, unit):.9g} {unit or SI[kind]}".rstrip()


def _beyond_by_sign(case: Case, name: str, bound: float, declared: Mapping[str, Quantity]) -> Iterator[Entry]:
    """Yield where a value of the other sign passes the magnitude of a limit, which the limit does not see."""
    base, _, end = name.rpartition("_")
    other = f"{base}_{'min' if end == 'max' else 'max'}" if end in ("max", "min") else ""
    quantity, upward = declared.get(scoped(other)[1]), 1 if end == "max" else -1
    if quantity is None or bound * upward <= 0 or any(other == limited for limited, _ in case.machine.limits):
        return
    found, peak = _values(case, other), f"{base}_peak"
    advice = f"'{peak}' bounds the magnitude" if scoped(peak)[1] in declared else f"bound '{other}' too"
    for where, value in found if not isinstance(found, KurbelError) else ():
        if -value * upward > abs(bound) * (1 + _ROUNDING):
            size = _shown(value, quantity.kind, getattr(bound, "unit", ""))
            text = f"{other} = {size} is beyond it with the other sign; {advice}  ({where})"
            path = _path("limits", name, bound)
            yield Entry(str(path[-1]), text, "warning", path)


# whose key values the limits and expectations are for


class Holder(NamedTuple):
    """Who has a key value, and the command that prints it."""

    subject: Subject
    quantity: Quantity
    command: str


def _values(case: Case, name: str) -> Found:
    """Return the values of a key value that a limit of this name is for, or what keeps them from being computed."""
    try:
        values = [(one.subject.name, one.subject.answer(one.quantity)) for one in holders(case, name)]
    except KurbelError as error:
        return error
    return [(where, number_of(value)) for where, value in values if isinstance(value, (Extreme, float))]


def holders(case: Case, name: str) -> list[Holder]:
    """Return whose key value a figure is for: of the machine or a cylinder that its name is scoped to.

    Without a scope, of each cylinder that has it, else of the machine.
    """
    scope, id = scoped(name)
    cylinders = [one.name for one in case.machine.cylinders]
    first, *others = every_quantity().commands_of(id)
    # what the only cylinder does not have, the machine does not have
    whole = [one for one in others if one == "flywheel"] if scope or len(cylinders) != 1 else []
    of_machine: list[Holder] = []
    for command in (first, *whole):
        listed = ((one, one.lists.key_values(command).get(id)) for one in subjects_of(case, command))
        found = [Holder(subject, quantity, command) for subject, quantity in listed if quantity]
        if scope:
            own = [one for one in found if _owner(one.subject, cylinders) == scope]
        else:
            own = [one for one in found if one.subject.name in cylinders and _has_it(one)]
        if own:
            return own
        of_machine += [one for one in found if one.subject.name not in cylinders]
    return [] if scope else of_machine


def _owner(subject: Subject, cylinders: Sequence[str]) -> str:
    """Return what a subject belongs to: a cylinder, as its pins do, or the machine."""
    return subject.name if subject.name in cylinders else subject.of or MACHINE


def _has_it(one: Holder) -> bool:
    """Whether there is a value, or what keeps it from being computed."""
    try:
        return one.subject.answer(one.quantity) is not None
    except KurbelError:
        return True
