"""What every card of a chamber answers, drawn or ideal; a measured `Trace` answers the same."""

from collections.abc import Iterator
from typing import Any, ClassVar, Literal

from kurbel.arrays import Truth
from kurbel.declared.keys import Rule


class ChamberCard:
    """A card: what it is like, so that nobody asks for its class, which may be behind a door.

    files: those it was read from; burns: whether it is that of a combustion engine; by_steam: of a steam engine;
    compresses: of a compressor; traced: whether it is measured; exponents: those of its lines p V^n = const.
    """

    files: ClassVar[tuple[str, ...]] = ()
    burns: ClassVar[bool] = False
    by_steam: ClassVar[bool] = False
    compresses: ClassVar[bool] = False
    traced: ClassVar[Literal[False]] = False
    exponents: ClassVar[Any] = ()

    def rules_of_events(self, valve_compresses: Truth | None) -> Iterator[Rule]:
        """Yield what is wrong with the events of a card that a valve sets.

        valve_compresses: whether the valve of the piston shuts the exhaust before the dead centre; None without one.
        """
        return iter(())

    def loaded(self) -> Any:
        """Return the card with its valves at work."""
        return self


class StrokeCard(ChamberCard):
    """A card that gives the pressure over the stroke; another one over the crank angle."""

    by_stroke: ClassVar[Literal[True]] = True
