"""Results by name: key values by id or printed symbol, and all columns at once."""

from collections.abc import Callable, Iterable, Mapping
from typing import Any, ClassVar, NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.declared.quantities import COMMON, Lists
from kurbel.declared.quantity import Quantity, ambiguity, called
from kurbel.declared.reading import shown
from kurbel.declared.unit_systems import SI, convert, shown_unit
from kurbel.errors import UsageError
from kurbel.near_words import did_you_mean
from kurbel.numerics.extreme import Extreme


class Figure(NamedTuple):
    """A key value: a number, or a tuple of them, in its SI unit, and the angle in degrees of an extreme, else None."""

    value: Any
    unit: str
    degrees: float | None
    quantity: Quantity

    def __str__(self) -> str:
        """Return it as people read it, with four digits in metric units.

        >>> str(Figure(10000.0, "N", 90.0, Quantity("T_max", "T_max", "force", "Largest tangential force")))
        '10.00 kN at 90.00°'
        """
        values = self.value if isinstance(self.value, tuple) else (self.value,)
        kind = self.quantity.kind
        unit = shown_unit(kind, "metric", max(map(abs, values), default=0.0))
        numbers = ", ".join(f"{convert(one, kind, unit):#.4g}".rstrip(".") for one in values)
        where = "" if self.degrees is None else f" at {self.degrees:.2f}°"
        return f"{numbers} {self.quantity.marked(unit)}".rstrip() + where


class Shown:
    """What a notebook shows; `kurbel.notebook` puts in how, since tables and pictures are made far above the solver."""

    as_html: ClassVar[Callable[[Any], str] | None] = None

    def _repr_html_(self) -> str | None:
        return Shown.as_html(self) if Shown.as_html else None


class Columns:
    """Columns at crank angles φ (n,) in degrees: attributes by their ids, in SI, each (n,), computed on first use.

    formulas: what computes each column; None comes of one that the machine does not have.
    """

    def __init__(self, phi: Array, formulas: Mapping[str, Callable[[], Any]]) -> None:
        self.phi, self.formulas = phi, formulas

    def __getattr__(self, id: str) -> Any:
        if id == "formulas" or id not in self.formulas:
            raise AttributeError(f"no column is called {id}")
        self.__dict__[id] = self.formulas[id]()
        return self.__dict__[id]


class Results(Shown):
    """Key values and columns of a command: attributes named by their ids, or what `Quantity.asks` names."""

    command: ClassVar[str]

    @property
    def lists(self) -> Lists:
        """The quantities that there may be."""
        return COMMON

    @property
    def answering(self) -> Iterable[Any]:
        """The objects that have key values, searched in this order."""
        return (self,)

    def __getattr__(self, id: str) -> Any:
        """Return a key value that is no attribute here: an extreme, or one that another of `answering` has."""
        quantity = None if id.startswith("_") else self._known.get(id)
        if quantity is None:
            raise AttributeError(f"no key value is called {id}")
        return answered(self.answering, quantity)

    def __getitem__(self, name: str) -> Figure:
        """Return a key value by its id or printed symbol; raises UsageError where there is none."""
        quantity = self._known[_only(name, self._known, "key value")]
        value = answered(self.answering, quantity)
        if value is None:
            raise UsageError(f"this machine has no {quantity.id}: {quantity.text}")
        return _figure(quantity, value)

    def key_values(self) -> dict[str, Figure]:
        """Return every key value that there is by its id, in the order in which they are printed."""
        found = {quantity: answered(self.answering, quantity) for quantity in self._known.values()}
        return {quantity.id: _figure(quantity, value) for quantity, value in found.items() if value is not None}

    @property
    def _known(self) -> dict[str, Quantity]:
        return self.lists.key_values(self.command)

    def columns(self, degrees: Any, *names: str) -> dict[str, Array]:
        """Return φ and these columns (n,), or all that there are, in SI by id, at crank angles (n,) in degrees.

        names: ids or printed symbols. Raises UsageError for angles that are no numbers and for what is no column here.
        """
        angles = np.atleast_1d(crank_angles(degrees))
        state = self.at(angles)
        known = self.lists.columns(self.command)
        ids = [_only(name, known, "column") for name in names] if names else list(known)
        found = {id: getattr(state, id, None) for id in ids if id != "phi"}
        for id, values in found.items() if names else ():
            if values is None:
                raise UsageError(f"this machine has no {id}: {known[id].text}")
        return {"phi": angles, **{id: np.asarray(one, float) for id, one in found.items() if one is not None}}

    def at(self, degrees: Any, within: Array | None = None) -> Any:
        """Return every column at crank angles (n,) in degrees; of the whole machine those of crank 1.

        At a jump the value on the side that holds `within` (n,) is meant, just after it where that is not given.
        """
        angles = crank_angles(degrees)
        return self._columns(angles, angles if within is None else within)

    def _columns(self, phi: Array, within: Array) -> Columns:
        """Return the columns at crank angles (n,) in degrees, on the sides of jumps that hold `within`."""
        return Columns(phi, {})

    @property
    def _of(self) -> str:
        """What the results are of."""
        return "the whole machine"

    def __repr__(self) -> str:
        return f"<kurbel {self.command} of {self._of}: ['id'], key_values(), columns(degrees)>"


def passed_on(part: str, name: str, text: str) -> Any:
    """Return a key value that a part of the results has under this name; None where there is no such part."""

    def answer(results: Any) -> Any:
        one = getattr(results, part)
        return None if one is None else getattr(one, name)

    return property(answer, doc=text)


def crank_angles(degrees: Any) -> Array:
    """Return crank angles in degrees as an array; raises UsageError for what are no finite numbers."""
    try:
        angles = np.asarray(degrees, dtype=float)
    except (TypeError, ValueError):
        raise UsageError(f"crank angles are numbers of degrees, not {shown(repr(degrees))}") from None
    if not np.isfinite(angles).all():
        raise UsageError("crank angles are finite numbers of degrees, not nan or inf")
    return angles


def _only(name: str, known: dict[str, Quantity], what: str) -> str:
    """Return the one id that a name means; raises UsageError for none and for several."""
    found = called(name, known.values())
    if not found or ambiguity(name, found):
        raise UsageError(ambiguity(name, found) or f"no {what} '{shown(name)}'{did_you_mean(name, tuple(known))}")
    return found[0]


def answered(results: Iterable[Any], quantity: Quantity) -> Any:
    """Return what the results have for a key value, in SI; None where they have none."""
    for one in results:
        if quantity.asks and hasattr(type(one), quantity.asks[0]):
            return _asked(one, *quantity.asks)
        if hasattr(type(one), quantity.id):
            return getattr(one, quantity.id)
    return None


def _asked(results: Any, name: str, argument: str = "", part: str = "") -> Any:
    found = getattr(results, name)
    found = found(argument) if argument else found
    return getattr(found, part) if part and found is not None else found


def _figure(quantity: Quantity, value: Any) -> Figure:
    number, degrees = value if isinstance(value, Extreme) else (value, None)
    return Figure(number, quantity.marked(SI[quantity.kind]), degrees, quantity)
