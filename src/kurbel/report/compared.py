"""How key values stand against the limits and the expectations of a machine file."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple, Union

from kurbel.declared.forms.figures import MACHINE, Expected, scoped
from kurbel.declared.quantity import NOISE_POWER, Quantity, by_id
from kurbel.declared.unit_systems import SI, convert
from kurbel.errors import KurbelError, Path, UsageError, path_text
from kurbel.machine import Machine
from kurbel.numerics.extreme import Extreme, number_of
from kurbel.quantities import every_quantity
from kurbel.report.alike import grouped, together
from kurbel.report.notes import Solved

if TYPE_CHECKING:
    from kurbel.report.frame import Subject
    from kurbel.solver.case import Case

Found = tuple[str, float]
"""What a key value belongs to, and its value in SI."""


class Entry(NamedTuple):
    """One line of a section of a check: what, and what is to be said of it.

    severity: `error` of a limit that is broken or a figure that is off, `warning`, `info`, or '' of a plain statement;
    path: of what it is about in the machine file.
    """

    what: str
    text: str
    severity: str = ""
    path: Path = ()


class Unjudged(NamedTuple):
    """Why a figure of the file cannot be compared; the error tells its path, too."""

    path: Path
    error: KurbelError


Judged = Union[Entry, Unjudged]
Values = Union[list[Found], KurbelError]
_ROUNDING = 1e-9
"""A bound is no more exact than what is printed of it: a stroke of 110 mm does not break a limit of 110 mm."""


def judged(machine: Machine, solved: Solved) -> Iterator[Judged]:
    """Yield how each limit and then each expectation stands, or why that cannot be told."""
    if not machine.limits and not machine.expect:
        return
    declared = by_id(*every_quantity().all_key_values)
    opposites = [other for name, _ in machine.limits if scoped(other := _opposite(name))[1] in declared]
    asked = (*(name for name, _ in (*machine.limits, *machine.expect)), *opposites)
    values = limited_values(solved(), dict.fromkeys(asked))
    for name, bound in machine.limits:
        found = tuple(_all_of(_path("limits", name, bound), declared[scoped(name)[1]], bound, values[name]))
        yield from found
        if all(isinstance(one, Entry) and one.severity == "info" for one in found):
            yield from _beyond_by_sign(machine, name, bound, values, declared)
    for name, figure in machine.expect:
        yield from _all_of(_path("expect", name, figure), declared[scoped(name)[1]], figure, values[name])


def _path(key: str, id: str, figure: float | Expected) -> Path:
    """Return where a figure stands in the file, under the name that is written there."""
    return (key, getattr(figure, "name", "") or id)


def _all_of(path: Path, quantity: Quantity, figure: float | Expected, found: Values) -> Iterator[Judged]:
    """Yield how the values of those that a figure is put on stand against it."""
    if isinstance(found, KurbelError):
        yield Unjudged(path, type(found)(f"{path_text(path)}: {found}"))
    elif not found:
        text = f"{without(str(path[-1]), quantity.id)}: {quantity.text[:1].lower()}{quantity.text[1:]}"
        yield Unjudged(path, UsageError(f"{path_text(path)}: {text}"))
    else:
        for equal in grouped(found, lambda one: one[1]):
            yield compared(path, quantity, figure, together([where for where, _ in equal]), equal[0][1])


def without(name: str, id: str) -> str:
    """Return that nobody has the key value of a figure: the machine, or the one that its name is scoped to."""
    scope = {"": "this machine", MACHINE: "the whole machine"}.get(scoped(name)[0], scoped(name)[0])
    return f"{scope} has no {id}"


def compared(path: Path, quantity: Quantity, figure: float | Expected, where: str, value: float) -> Judged:
    """Compare a value with its bound or expectation. What is not finite cannot be compared."""
    if not math.isfinite(value):
        from kurbel.report.shown import too_large

        return Unjudged(path, UsageError(f"{path_text(path)} ({where}): {too_large(quantity)}"))
    judge = _met if isinstance(figure, Expected) else _kept
    text, verdict, good = judge(quantity, figure, value)  # type: ignore[arg-type]
    return Entry(str(path[-1]), f"{text}  {verdict}  ({where})", "info" if good else "error", path)


def _kept(quantity: Quantity, bound: float, value: float) -> tuple[str, str, bool]:
    """Judge by a bound, from below or from above; of a residual the size counts."""
    unit = getattr(bound, "unit", "")
    lower, bars = quantity.bounded_below, "|" if quantity.id.endswith("_residual") else ""
    broken = breaks(quantity, bound, value)
    relation = ("<" if broken else "≥") if lower else (">" if broken else "≤")
    size = f"< 1e{NOISE_POWER}" if quantity.is_noise(value) else f"{bars}{_shown(value, quantity.kind, unit)}{bars}"
    text = f"{size} {relation} {_shown(bound, quantity.kind, unit)}"
    return text, "BROKEN" if broken else "kept", not broken


def breaks(quantity: Quantity, bound: float, value: float) -> bool:
    """Return whether a key value breaks its bound: falls below one from below, exceeds any other."""
    magnitude = abs(value) if quantity.id.endswith("_residual") else value
    excess = bound - value if quantity.bounded_below else magnitude - bound
    return excess > _ROUNDING * abs(bound)


def _met(quantity: Quantity, figure: Expected, value: float) -> tuple[str, str, bool]:
    """Judge by an expectation: the value may stand between its ends."""
    kind, slack = quantity.kind, _ROUNDING * max(abs(figure.low), abs(figure.high))
    low, high = figure.low - value, value - figure.high
    verdict = "met"
    if max(low, high) > slack:
        verdict = f"OFF, {_shown(max(low, high), kind, figure.unit)} too {'small' if low > high else 'large'}"
    wanted = figure.text or f"{_shown(figure.low, kind, '')} to {_shown(figure.high, kind, '')}"
    size = f"< 1e{NOISE_POWER}" if quantity.is_noise(value) else _shown(value, kind, figure.unit)
    return f"{size}, expected {wanted}", verdict, verdict == "met"


def _opposite(name: str) -> str:
    """Return the id of the extreme on the other side, '' where there is none."""
    base, _, end = name.rpartition("_")
    return f"{base}_{'min' if end == 'max' else 'max'}" if end in ("max", "min") else ""


def _beyond_by_sign(
    machine: Machine, name: str, bound: float, values: Mapping[str, Values], declared: Mapping[str, Quantity]
) -> Iterator[Entry]:
    """Yield where the magnitude of a limit is passed by the other sign, which the limit does not see."""
    other = _opposite(name)
    found = values.get(other, [])
    upward = 1 if name.endswith("_max") else -1
    if bound * upward <= 0 or isinstance(found, KurbelError) or any(other == limited for limited, _ in machine.limits):
        return
    peak, quantity = f"{name[:-4]}_peak", declared.get(scoped(other)[1])
    way = f"'{peak}' bounds the magnitude" if scoped(peak)[1] in declared else f"bound '{other}' too"
    for where, value in found:
        if quantity and -value * upward > abs(bound) * (1 + _ROUNDING):
            size = _shown(value, quantity.kind, getattr(bound, "unit", ""))
            text = f"{other} = {size} is beyond it with the other sign; {way}  ({where})"
            path = _path("limits", name, bound)
            yield Entry(str(path[-1]), text, "warning", path)


def _shown(value: float, kind: str, unit: str) -> str:
    """Return a value with its unit, in that of the file where one is written there."""
    if unit == "%":
        return f"{100 * value:.9g} %"
    return f"{convert(value, kind, unit):.9g} {unit or SI[kind]}".rstrip()


# the values, computed only as far as they are asked for


def limited_values(case: "Case", names: Iterable[str]) -> dict[str, Values]:
    """Return by id what the machine has of these key values, or what keeps them from being computed."""
    import numpy as np

    found: dict[str, Values] = {}
    with np.errstate(all="ignore"):
        for name in names:
            try:
                found[name] = list(_values(case, name))
            except KurbelError as error:
                found[name] = error
    return found


class Holder(NamedTuple):
    """Who has a key value, and the command that prints it."""

    subject: "Subject"
    quantity: Quantity
    command: str

    @property
    def has_it(self) -> bool:
        """Whether there is a value, or what keeps it from being computed."""
        try:
            return self.subject.answer(self.quantity) is not None
        except KurbelError:
            return True


def holders(case: "Case", name: str) -> list[Holder]:
    """Return whose key value a figure is put on: of the machine or a cylinder that its name is scoped to.

    Where it is not, of each cylinder that has it, else of the machine.
    """
    from kurbel.report.commands import subjects_of

    scope, id = scoped(name)
    cylinders = [one.name for one in case.machine.cylinders]
    of_machine: list[Holder] = []
    first, *others = every_quantity().commands_of(id)
    # what the only cylinder has not, the machine has not
    whole = [one for one in others if one == "flywheel"] if scope or len(cylinders) != 1 else []
    for command in (first, *whole):
        listed = ((one, one.lists.key_values(command).get(id)) for one in subjects_of(case, command))
        found = [Holder(subject, quantity, command) for subject, quantity in listed if quantity]
        if scope and (own := [one for one in found if _owner(one.subject, cylinders) == scope]):
            return own
        if not scope and (own := [one for one in found if one.subject.name in cylinders and one.has_it]):
            return own
        of_machine += [one for one in found if one.subject.name not in cylinders]
    return [] if scope else of_machine


def _owner(subject: "Subject", cylinders: Sequence[str]) -> str:
    """Return whose parts a subject is of: a cylinder, as one of its pins, or the machine."""
    return subject.name if subject.name in cylinders else subject.of or MACHINE


def _values(case: "Case", name: str) -> Iterator[Found]:
    for subject, quantity, _ in holders(case, name):
        value = subject.answer(quantity)
        if isinstance(value, (Extreme, float)):
            yield subject.name, number_of(value)
