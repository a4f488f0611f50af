"""What every card of a chamber answers, drawn or ideal; a measured `Trace` answers the same."""

from typing import Any, ClassVar, Literal


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

    def loaded(self) -> Any:
        """Return the card with its valves at work."""
        return self
