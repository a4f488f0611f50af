"""Forces in a plane."""

from typing import Any, NamedTuple

from kurbel.arrays import Number

Force = Any
"""A force D + iT in N, or the moments of such forces in N m: complex, a number or an array (…). mypy has no one type
for it: the sum of a complex128 and a float is to it a complex number of any precision."""


class PinForce(NamedTuple):
    """The force of a rod on the crank pin in N, radially along D and tangentially along T."""

    D: Number
    T: Number

    @property
    def complex(self) -> Force:
        """D + iT."""
        return self.D + 1j * self.T


class CrossheadForce(NamedTuple):
    """The force of the crosshead on its pin in N, along the stroke line as P counts, and across it as N counts."""

    along: Number
    across: Number
