"""Errors that no arithmetic removes: those of a simpler model, and those of what was measured.

Both are differences between two calculations that are alike otherwise, relative to the exact one.
"""

import math
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np

from kurbel.accuracy.oracle import why_no_motion, why_not
from kurbel.accuracy.rivals import MOTIONS, summed_excess, trapezoid
from kurbel.accuracy.textbook import Moved, TextbookCylinder, TextbookMachine
from kurbel.arrays import Array
from kurbel.machine import Cylinder, Machine
from kurbel.solver.friction import mean_friction_over_rod_angle, redtenbacher_logarithm, redtenbacher_loss

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
    if not math.isinf(first.mechanism.rod_length):
        yield from _of_motion(first)
        if _has_torque(machine, first):
            yield from _of_torque(machine, {cause: {"formula": formula} for cause, formula in _FORMULAS.items()})
    if _has_torque(machine, first) and any(cylinder.masses for cylinder in machine.cylinders) and machine.speed:
        yield from _of_torque(machine, {"inertia left out": {"massless": True}})
    yield from _of_friction(machine, first)


_FORMULAS = {"first-order formulas": "first-order", "infinite rod": "infinite"}


def _of_motion(cylinder: Cylinder) -> Iterator[Difference]:
    exact, *others = (
        Moved(cylinder.mechanism, np.radians(np.arange(361.0)), how) for how in ("exact", *_FORMULAS.values())
    )
    for quantity, asked in MOTIONS.items():
        truth = getattr(exact, asked)
        for cause, approximate in zip(_FORMULAS, others):
            missed = np.abs(getattr(approximate, asked) - truth).max()
            yield Difference(quantity, cause, float(missed / np.abs(truth).max()))


def _has_torque(machine: Machine, cylinder: Cylinder) -> bool:
    has_gas = any(piston.indicator for piston in cylinder.pistons)
    return has_gas and not any(why_not(one) for one in machine.cylinders)


def _of_torque(machine: Machine, causes: dict[str, dict[str, Any]]) -> Iterator[Difference]:
    """Yield by how much simpler calculations miss the largest torque of the first cylinder, and ΔE."""
    phi, first = _turn(machine), machine.cylinders[0]
    exact, whole = TextbookCylinder(machine, first).torque(phi), TextbookMachine(machine)
    largest, swing = float(exact.max()), summed_excess(whole, _COUNT)
    for cause, simpler in causes.items():
        missed = float(TextbookCylinder(machine, first, **simpler).torque(phi).max()) - largest
        yield from _relative("T_max", cause, missed, largest, float(np.abs(exact).max()))
    for cause, simpler in causes.items():
        missed = summed_excess(TextbookMachine(machine, **simpler), _COUNT) - swing
        yield from _relative("ΔE", cause, missed, swing, _turnover(whole.torque(phi)))


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
    from kurbel.solver.forces import CylinderForces

    lam, f = cylinder.mechanism.lam, cylinder.friction.crosshead if cylinder.friction else None
    if not f or not lam or cylinder.mechanism.offset:
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
