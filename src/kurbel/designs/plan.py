"""Which designs there are: a grid of all values, or values side by side, each with every point of the sample."""

import math
from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING

from kurbel.designs.inputs import Input
from kurbel.errors import UsageError

if TYPE_CHECKING:
    from kurbel.arrays import Array

MOST_ROWS = 10_000_000
"""Rows that are computed without being asked whether they are meant."""


class Plan:
    """The rows of a sweep, by their number from 0 on; the last key of a grid runs fastest.

    side_by_side: the first values of all keys make the first row, the second ones the second, … sample, seed, sobol:
    size, seed and kind of the sample of the distributions. Raises UsageError for lists that do not fit together.
    """

    def __init__(
        self,
        inputs: Sequence[Input],
        side_by_side: bool = False,
        sample: int | None = None,
        seed: int = 0,
        sobol: bool = False,
    ) -> None:
        self.inputs = tuple(inputs)
        self._sample, self._seed, self._sobol = sample, seed, sobol
        self._side_by_side = side_by_side
        self._listed = [one for one in inputs if one.distribution is None]
        self._drawn = [one for one in inputs if one.distribution is not None]
        self._refuse()
        lengths = [len(one.texts) for one in self._listed]
        self._combinations = (lengths or [1])[0] if side_by_side else math.prod(lengths)
        self.rows = self._combinations * (sample or 1)

    def _refuse(self) -> None:
        keys = [one.key for one in self.inputs]
        if twice := next((key for place, key in enumerate(keys) if key in keys[:place]), ""):
            raise UsageError(f"--vary {twice}: this key is varied twice")
        if self._drawn and not self._sample:
            raise UsageError(f"--vary {self._drawn[0].key}: a distribution needs --sample N, such as --sample 1000")
        if self._sample and not self._drawn:
            raise UsageError("--sample: no key has a distribution, such as bore=normal(450 mm, 0.2 mm)")
        lengths = {one.key: len(one.texts) for one in self._listed}
        if self._side_by_side and len(set(lengths.values())) > 1:
            each = ", ".join(f"{key} has {count}" for key, count in lengths.items())
            raise UsageError(f"--zip: the lists must be of one length; {each}")

    @cached_property
    def _points(self) -> "Array":
        from kurbel.designs.sampling import latin_hypercube, sobol

        return (sobol if self._sobol else latin_hypercube)(self._sample or 0, len(self._drawn), self._seed)

    def texts(self, row: int) -> tuple[str, ...]:
        """Return the texts of the keys in a row, in the order of the inputs."""
        combination, point = divmod(row, self._sample or 1)
        found = {}
        for one in reversed(self._listed):
            combination, place = (
                (combination, combination) if self._side_by_side else divmod(combination, len(one.texts))
            )
            found[one.key] = one.texts[place]
        for column, one in enumerate(self._drawn):
            found[one.key] = one.text(float(self._points[point, column]))
        return tuple(found[one.key] for one in self.inputs)


def shard(text: str, rows: int) -> range:
    """Return the rows of one shard of many, `2/8`; one after another they are all rows. Raises UsageError.

    >>> [shard(f"{k}/3", 8) for k in (1, 2, 3)]
    [range(0, 2), range(2, 5), range(5, 8)]
    """
    number, slash, count = text.partition("/")
    if not (slash and number.isdecimal() and count.isdecimal() and 1 <= int(number) <= int(count)):
        raise UsageError(f"--shard {text}: write K/N, such as 2/8, K from 1 to N")
    return range(rows * (int(number) - 1) // int(count), rows * int(number) // int(count))
