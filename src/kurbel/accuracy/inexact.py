"""Errors that no arithmetic removes: those of a simpler model, and those of what was measured.

Both are differences between two calculations that are alike otherwise, relative to the exact one.
"""

import math
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kurbel.accuracy.oracle import why_no_motion, why_not
from kurbel.accuracy.rivals import summed_excess, trapezoid
from kurbel.accuracy.textbook import TextbookCylinder, TextbookMachine, moved
from kurbel.machine import Cylinder, Machine
from kurbel.solver.cylinder.friction import mean_friction_over_rod_angle, redtenbacher_logarithm, redtenbacher_loss

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
    for formula in _FORMULAS:
        approximate = TextbookCylinder(machine, cylinder, formula[1]).torque(phi)
        yield from _of_largest(formula[0], approximate, TextbookCylinder(machine, cylinder).torque(phi))
    for formula in _FORMULAS:
        yield from _of_excess(formula[0], TextbookMachine(machine, formula[1]), TextbookMachine(machine), phi)


def _massless(machine: Machine) -> Iterator[Difference]:
    phi = _turn(machine)
    first, cause = machine.cylinders[0], "inertia left out"
    without = TextbookCylinder(machine, first, massless=True).torque(phi)
    yield from _of_largest(cause, without, TextbookCylinder(machine, first).torque(phi))
    yield from _of_excess(cause, TextbookMachine(machine, massless=True), TextbookMachine(machine), phi)


def _of_largest(cause: str, torque: Array, exact: Array) -> Iterator[Difference]:
    largest = float(exact.max())
    yield from _relative("T_max", cause, float(torque.max()) - largest, largest, float(np.abs(exact).max()))


def _of_excess(cause: str, textbook: TextbookMachine, exact: TextbookMachine, phi: Array) -> Iterator[Difference]:
    swing = summed_excess(exact, _COUNT)
    yield from _relative("ΔE", cause, summed_excess(textbook, _COUNT) - swing, swing, _turnover(exact.torque(phi)))


_ZERO = 1e-12


def _relative(quantity: str, cause: str, missed: float, exact: float, scale: float) -> Iterator[Difference]:
    """Yield a relative error; none where the exact value, beside what it is the sum of, is but a rounding of zero."""
    if abs(exact) > _ZERO * scale:
        yield Difference(quantity, cause, abs(missed / exact))


def _turnover(torque: Array) -> float:
    """Return the work that goes to and fro at most in a turn, in J."""
    return 2 * math.pi * float(np.abs(torque).max())


def _of_friction(machine: Machine, cylinder: Cylinder) -> Iterator[Difference]:
    """Redtenbacher's means over the rod angle against each other, and against the work truly lost."""
    from kurbel.solver.cylinder.forces import CylinderForces

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

    textbook, torque = TextbookCylinder(machine, first), TextbookMachine(machine).torque(phi)
    for quantity, value, scale in (
        ("A_i", work, _turnover(textbook.gas_power(phi))),
        ("T_max", largest, float(np.abs(textbook.torque(phi)).max())),
        ("ΔE", excess, _turnover(torque)),
    ):
        exact = value()
        late = value(shift=math.radians(SHIFT)) - exact
        yield from _relative(quantity, f"dead centre {SHIFT:g}° late", late, exact, scale)
        scattered = [value(noise=_noise(seed)) for seed in range(_DRAWS)]
        spread = math.sqrt(float(np.mean((np.array(scattered) - exact) ** 2)))
        yield from _relative(quantity, f"noise {NOISE:.1%} of the pressure", spread, exact, scale)


def _noise(seed: int) -> Callable[[Array], Array]:
    random = np.random.default_rng(seed)
    return lambda pressure: random.normal(0.0, NOISE * float(np.abs(pressure).max()), pressure.shape)


def _turn(machine: Machine) -> Array:
    return np.asarray(np.arange(_COUNT * machine.revolutions) * (2 * math.pi / _COUNT))
