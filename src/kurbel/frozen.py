"""Objects that cannot be changed, with one constructor for all: code made for each class would be slow to load."""

from dataclasses import MISSING, Field, dataclass, fields
from typing import TYPE_CHECKING, ClassVar

if TYPE_CHECKING:
    from typing_extensions import dataclass_transform
else:  # typing has it from Python 3.11 on

    def dataclass_transform(**_):
        """Return a decorator that changes nothing."""
        return lambda made: made


@dataclass_transform(frozen_default=True, eq_default=False)
class Frozen:
    """Named values, declared as those of a dataclass, which every subclass is; compared by identity."""

    __dataclass_fields__: ClassVar[dict[str, Field[object]]]
    _defaults: ClassVar[dict[str, object]]

    def __init_subclass__(cls) -> None:
        dataclass(init=False, repr=False, eq=False)(cls)
        cls._defaults = {one.name: one.default for one in in_order(cls)}

    def __init__(self, *values: object, **named: object) -> None:
        defaults = self._defaults
        given = {**dict(zip(defaults, values)), **named}
        wrong = [name for name in given if name not in defaults]
        wrong += [name for name, default in defaults.items() if default is MISSING and name not in given]
        if wrong or len(given) < len(values) + len(named):
            raise TypeError(f"{type(self).__name__} takes the values {', '.join(defaults)}; see {', '.join(wrong)}")
        vars(self).update(defaults | given)
        self._check()

    def _check(self) -> None:
        """Raise an error for values that are none together."""

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"a {type(self).__name__} cannot be changed; make another one by dataclasses.replace")

    def __repr__(self) -> str:
        """Return the call that makes the object, without what has its default value: a machine has many of these."""
        known = vars(self)
        given = [f"{one.name}={known[one.name]!r}" for one in fields(self) if known[one.name] is not one.default]
        return f"{type(self).__name__}({', '.join(given)})"


def in_order(kind: type[Frozen]) -> list[Field[object]]:
    """Return the values in the order of positional arguments: first those without a default."""
    return sorted(fields(kind), key=lambda one: one.default is not MISSING)
