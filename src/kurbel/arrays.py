"""Types of arrays, declared without numpy.typing, whose import would slow down every start."""

from typing import TypeVar, Union

import numpy as np

Array = np.ndarray[tuple[int, ...], np.dtype[np.float64]]
ComplexArray = np.ndarray[tuple[int, ...], np.dtype[np.complex128]]
Flags = np.ndarray[tuple[int, ...], np.dtype[np.bool_]]
Indices = np.ndarray[tuple[int, ...], np.dtype[np.intp]]
Number = Union[float, Array]
"""A number of one machine, or an array (machines,) of many."""
N = TypeVar("N", float, Array, Number)
"""Of floats a float, of arrays an array, of both a `Number`."""
Truth = Union[bool, Flags]
"""Whether something holds for one machine, or for each of many, (machines,)."""


class Indivisible:
    """A record of one machine that itself contains arrays; no index of them is that of a machine."""
