"""Records that stay as they were born, declared as dataclasses are."""

from __future__ import annotations

from dataclasses import MISSING, FrozenInstanceError, dataclass, fields
from typing import TYPE_CHECKING, Any, NoReturn, TypeVar

if TYPE_CHECKING:
    from inspect import Signature

    from typing_extensions import dataclass_transform
else:

    def dataclass_transform(**_: bool) -> Any:
        """Return what leaves a decorator as it is; what it tells is for type checkers alone."""
        return lambda decorator: decorator


Record = TypeVar("Record")


@dataclass_transform(frozen_default=True, eq_default=False)
def frozen(record: type[Record]) -> type[Record]:
    """Make a class an immutable dataclass, equal to itself alone.

    @dataclass(frozen=True) writes methods for every class and has their text compiled, which is dear where a run is
    short; these ask the fields.
    """
    own = fields(dataclass(init=False, repr=False, eq=False, match_args=False)(record))  # type: ignore[arg-type]
    names = tuple(one.name for one in own)
    defaults = {one.name: one.default for one in own if one.default is not MISSING}
    known = set(names)
    has_rules = hasattr(record, "__post_init__")

    def born(self: Any, *values: Any, **named: Any) -> None:
        given = dict(zip(names, values), **named)
        held = defaults | given
        if len(given) < len(values) + len(named) or held.keys() != known:
            raise TypeError(f"{record.__name__}{_Signature.of(record)} does not take {values} {named}")
        vars(self).update(held)
        if has_rules:
            self.__post_init__()

    methods = {"__init__": born, "__repr__": _shown, "__setattr__": _refuse, "__delattr__": _refuse}
    for name, method in (methods | {"__signature__": _Signature(), "__match_args__": names}).items():
        setattr(record, name, method)
    return record


def values_of(record: Any) -> dict[str, Any]:
    """Return the values that a record was born with, by the names of its fields: it may hold what it found of them."""
    held = vars(record)
    return {name: held[name] for name in record.__match_args__}


class _Signature:
    """How a record is called, for `help`: made when it is asked for."""

    def __get__(self, record: object, kind: Any) -> Signature:
        return self.of(kind)

    @staticmethod
    def of(kind: Any) -> Signature:
        """Return it."""
        from inspect import Parameter, Signature

        own = {one.name: (Parameter.empty if one.default is MISSING else one.default, one.type) for one in fields(kind)}
        return Signature(
            [
                Parameter(name, Parameter.POSITIONAL_OR_KEYWORD, default=default, annotation=type)
                for name, (default, type) in own.items()
            ]
        )


def _shown(self: Any) -> str:
    """Return what was given to the record."""
    given = (one.name for one in fields(self) if getattr(self, one.name) is not one.default)
    return f"{type(self).__name__}({', '.join(f'{name}={getattr(self, name)!r}' for name in given)})"


def _refuse(self: Any, name: str, *value: Any) -> NoReturn:
    raise FrozenInstanceError(f"cannot change '{name}' of a {type(self).__name__}; make another one")
