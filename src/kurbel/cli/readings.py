"""How the text behind an option is read; what cannot be read is told with the option that it stands behind."""

from collections.abc import Callable
from typing import TypeVar

import click

from kurbel.errors import UnitError

Value = TypeVar("Value")
_MOST_STEPS = 10_000


def _told(read: Callable[[str], Value], text: str) -> Value:
    """Return what is read; what the units refuse is told as click tells it."""
    try:
        return read(text)
    except UnitError as error:
        raise click.BadParameter(str(error)) from None


def number(text: str | float) -> float:
    """Return a finite number with a decimal point, also 10/3 or 75 %."""
    if not isinstance(text, str):  # what stands for it where it is not given
        return text
    from kurbel.declared.numerals import parse_ratio

    return _told(parse_ratio, text)


def numbers(text: str) -> tuple[float, ...]:
    """Return numbers separated by commas, in the order given; or from, to, by steps: `0.5:12:0.5`."""
    found = tuple(map(number, text.replace(":", ",").split(",")))
    if ":" not in text:
        return found
    # 3 · 0.1 is written 0.3
    return tuple(float(f"{one:.15g}") for one in _stepped(found, text, "0.5:12:0.5"))


def words(text: str) -> tuple[str, ...]:
    """Return words separated by commas, in the order given, without those that are empty, one at least."""
    found = tuple(word.strip() for word in text.split(",") if word.strip())
    if not found:
        raise click.BadParameter(f"'{text}' names no column; leave the option out, or name one")
    return found


def columns(text: str) -> tuple[str, ...]:
    """Return the ids of columns by id or printed symbol, separated by commas, in the order given."""
    from kurbel.quantities import every_quantity
    from kurbel.quantity import ambiguity, called, joined

    named = words(text)
    known = [column for column in every_quantity().all_columns if column.commands]

    def only(name: str) -> str:
        found = called(name, known)
        if wrong := ambiguity(name, found):
            raise click.BadParameter(wrong)
        return found[0] if found else name  # the report knows what this machine has

    return tuple(map(only, joined(named, known)))


def speeds(text: str) -> tuple[float, ...]:
    """Return speeds in revolutions per second, in the order given.

    They have one unit or each its own: `300, 350 rpm`; or they go from, to, by steps: `300:1500:10 rpm`.
    """
    from kurbel.declared.units import parse_quantity, written_unit

    each = text.replace(":", ",").split(",")
    unit = written_unit(each[-1])
    found = tuple(
        _told(lambda one: parse_quantity(one, "speed"), one if written_unit(one) else f"{one} {unit}".strip())
        for one in each
    )
    if ":" in text:
        found = _stepped(found, text, "300:1500:10 rpm")
    if not all(speed > 0 for speed in found):
        raise click.BadParameter(f"'{text}': a speed is more than 0")
    return found


def _stepped(found: tuple[float, ...], text: str, sample: str) -> tuple[float, ...]:
    if len(found) != 3 or "," in text or not found[2] > 0 or found[1] < found[0]:
        raise click.BadParameter(f"'{text}': write from, to and step as '{sample}'")
    low, high, step = found
    count = (high - low) / step
    if count > _MOST_STEPS:
        raise click.BadParameter(f"'{text}': more than {_MOST_STEPS} steps; take larger ones")
    return tuple(low + step * index for index in range(int(count + 1e-9) + 1))


def spread(text: str) -> tuple[str, str]:
    """Return a dotted key with its standard uncertainty as a text."""
    from kurbel.declared.forms.uncertainties import spread_text

    key, _, size = text.partition("=")
    if not (key.strip() and spread_text(size)):
        raise click.UsageError(f"--uncertainty {text}: write KEY=SPREAD, above 0, such as bore='0.2 mm'.")
    return key.strip(), spread_text(size)
