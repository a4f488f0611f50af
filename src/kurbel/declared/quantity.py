"""Until every module imports `kurbel.quantity` itself."""

from kurbel.quantity import GREEK, NOISE_POWER, Lists, Quantity, ambiguity, by_id, called, joined, placed

__all__ = ["GREEK", "NOISE_POWER", "Lists", "Quantity", "ambiguity", "by_id", "called", "joined", "placed"]
