"""Types of arrays, said without numpy.typing, which would be one module more at every start."""

from typing import Any, TypeVar, Union

import numpy as np

Array = np.ndarray[tuple[Any, ...], np.dtype[np.float64]]
ComplexArray = np.ndarray[tuple[Any, ...], np.dtype[np.complex128]]
Flags = np.ndarray[tuple[Any, ...], np.dtype[np.bool_]]
Indices = np.ndarray[tuple[Any, ...], np.dtype[np.intp]]
Number = Union[float, Array]
"""A number of one machine, or of many machines, (machines,)."""
N = TypeVar("N", float, Array, Number)
"""Of floats a float, of arrays an array, of both a `Number`."""
Truth = Union[bool, Flags]
"""Whether something holds for one machine, or for each of many, (machines,)."""


class Indivisible:
    """A record whose arrays are its own: no numbers of many machines."""
