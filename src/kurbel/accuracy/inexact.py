"""Errors that no arithmetic removes: those of a simpler model, and those of what was measured.

Both are differences between two calculations that are alike otherwise, relative to the exact one.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kurbel.accuracy.oracle import why_no_motion, why_not
from kurbel.accuracy.rivals import summed_excess, trapezoid
from kurbel.accuracy.textbook import TextbookCylinder, TextbookMachine, moved
from kurbel.machine import Cylinder, Machine
from kurbel.solver.friction import mean_friction_over_rod_angle, redtenbacher_logarithm, redtenbacher_loss

Array = NDArray[np.float64]
SHIFT = 0.1
"""Degrees by which a dead centre may be found wrong."""
NOISE = 0.005
"""Standard deviation of the noise over the largest pressure of the chamber."""
_DRAWS = 20
_COUNT = 3600
"""Divisions of a turn: a sample every tenth of a degree, as an indicator takes them."""


class Difference(NamedTuple):
    """What is left of the truth or added to it, and how much that changes a quantity, relatively."""

    quantity: str
    cause: str
    error: float


def model_errors(machine: Machine) -> Iterator[Difference]:
    """Yield what the book's approximations change in the first cylinder and in the machine."""
    if not machine.cylinders or why_no_motion(machine.cylinders[0]):
        return
    first = machine.cylinders[0]
    if not math.isinf(getattr(first.mechanism, "rod", math.inf)):
        yield from _of_motion(first)
        if _has_torque(machine, first):
            yield from _of_torque(machine, first)
    if _has_torque(machine, first) and any(cylinder.masses for cylinder in machine.cylinders) and machine.speed:
        yield from _massless(machine)
    yield from _of_friction(machine, first)


_FORMULAS = (("first-order formulas", "first-order"), ("infinite rod", "infinite"))


def _of_motion(cylinder: Cylinder) -> Iterator[Difference]:
    phi = np.radians(np.arange(361.0))
    exact = moved(cylinder.mechanism, phi)
    for index, quantity in enumerate(("x", "c", "b")):
        for cause, formula in _FORMULAS:
            missed = np.abs(moved(cylinder.mechanism, phi, formula)[index] - exact[index]).max()
            yield Difference(quantity, cause, float(missed / np.abs(exact[index]).max()))


def _has_torque(machine: Machine, cylinder: Cylinder) -> bool:
    has_gas = any(piston.indicator for piston in cylinder.pistons)
    return has_gas and not any(why_not(machine, one) for one in machine.cylinders)


def _of_torque(machine: Machine, cylinder: Cylinder) -> Iterator[Difference]:
    phi = _turn(machine)

    def largest(formula: str) -> float:
        return float(TextbookCylinder(machine, cylinder, formula).torque(phi).max())

    def excess(formula: str) -> float:
        return summed_excess(TextbookMachine(machine, formula), _COUNT)

    for quantity, value in (("T_max", largest), ("ΔE", excess)):
        exact = value("exact")
        for cause, formula in _FORMULAS:
            yield Difference(quantity, cause, abs(value(formula) / exact - 1))


def _massless(machine: Machine) -> Iterator[Difference]:
    phi = _turn(machine)
    first = machine.cylinders[0]
    with_masses, without = (
        float(TextbookCylinder(machine, first, massless=massless).torque(phi).max()) for massless in (False, True)
    )
    yield Difference("T_max", "inertia left out", abs(without / with_masses - 1))
    swings = [summed_excess(TextbookMachine(machine, massless=massless), _COUNT) for massless in (False, True)]
    yield Difference("ΔE", "inertia left out", abs(swings[1] / swings[0] - 1))


def _of_friction(machine: Machine, cylinder: Cylinder) -> Iterator[Difference]:
    """Redtenbacher's means over the rod angle against each other, and against the work truly lost."""
    from kurbel.solver.forces import CylinderForces

    mechanism: Any = cylinder.mechanism
    lam = getattr(mechanism, "lam", None)
    f = cylinder.friction.crosshead if cylinder.friction else None
    offset: float = getattr(mechanism, "offset", 0.0)
    if not f or not lam or offset:
        return
    true_mean = mean_friction_over_rod_angle(math.asin(lam), f)
    yield Difference("F_m", "Redtenbacher's logarithm, D 5", abs(redtenbacher_logarithm(lam, f) / true_mean - 1))
    yield Difference("F_m", "Redtenbacher's ½ λ f, D 6", abs(redtenbacher_loss(lam, f) / true_mean - 1))
    loss = CylinderForces(machine, cylinder).loss_crosshead
    if loss:
        yield Difference("e_K", "½ λ f for the work lost, D 7", abs(redtenbacher_loss(lam, f) / loss - 1))


def data_errors(machine: Machine) -> Iterator[Difference]:
    """Yield what 0.1° of dead centre and 0.5 % noise of the pressure change, with a sample every 0.1°.

    Noise: the standard deviation over 20 draws, the same in every run.
    """
    if not machine.cylinders or not _has_torque(machine, machine.cylinders[0]):
        return
    first, phi = machine.cylinders[0], _turn(machine)

    def work(**disturbed: Any) -> float:
        textbook = TextbookCylinder(machine, first)
        return trapezoid(lambda angles: textbook.gas_power(angles, **disturbed), _COUNT, textbook.turns)

    def largest(**disturbed: Any) -> float:
        return float(TextbookCylinder(machine, first).torque(phi, **disturbed).max())

    def excess(**disturbed: Any) -> float:
        return summed_excess(TextbookMachine(machine), _COUNT, **disturbed)

    for quantity, value in (("A_i", work), ("T_max", largest), ("ΔE", excess)):
        exact = value()
        if not exact:
            continue
        yield Difference(quantity, f"dead centre {SHIFT:g}° late", abs(value(shift=math.radians(SHIFT)) / exact - 1))
        scattered = [value(noise=_noise(seed)) for seed in range(_DRAWS)]
        spread = math.sqrt(float(np.mean((np.array(scattered) - exact) ** 2)))
        yield Difference(quantity, f"noise {NOISE:.1%} of the pressure", spread / abs(exact))


def _noise(seed: int) -> Callable[[Array], Array]:
    random = np.random.default_rng(seed)
    return lambda pressure: random.normal(0.0, NOISE * float(np.abs(pressure).max()), pressure.shape)


def _turn(machine: Machine) -> Array:
    return np.asarray(np.arange(_COUNT * machine.revolutions) * (2 * math.pi / _COUNT))
