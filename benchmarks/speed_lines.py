"""Speed of the shaft of the extreme machines: kurbel's and its time, against collocation in 40 digits of mpmath.

python benchmarks/speed_lines.py [MOST]

The references that the table of `kurbel accuracy --extremes` has of ω were computed so. The torque is that of the
textbook, in pieces between the corners of the cards; pieces on which the solution is no polynomial are halved until
floats and 14 nodes agree to 1e-12. MOST: of the machines of the table; a few seconds each.
"""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import mpmath
import numpy as np
from numpy.polynomial import chebyshev

from kurbel import loads
from kurbel.accuracy.extremes import all_cases
from kurbel.accuracy.methods import integrals, merged
from kurbel.accuracy.textbook import DIGITS, STEPS, TextbookMachine
from kurbel.machine import Cylinder, Machine
from kurbel.solver.case import Case

mp, mpf = mpmath.mp, mpmath.mpf
MPF, SQRT, RADIANS = (np.frompyfunc(one, 1, 1) for one in (mp.mpf, mp.sqrt, mp.radians))
Array = np.ndarray
Function = Callable[[Array, Array], Array]


def turning_inertia(cylinder: Cylinder) -> Any:
    """Return what turns with the crank pin of a connecting rod, in kg m²."""
    rod = cylinder.masses.connecting_rod if cylinder.masses else None
    return (
        mpf(rod.mass) * (1 - mpf(rod.share)) * mpf(cylinder.mechanism.crank) ** 2 if rod else mpf(0)
    )


def speed_line(machine: Machine) -> dict[float, Any]:
    """Return ω in rad/s by the angle in degrees, at 30°, 60°, … of the cycle."""
    whole, load, wheel = TextbookMachine(machine, machine.cylinders), machine.load, machine.flywheel
    omega, rigid = (
        2 * mp.pi * mpf(machine.speed),
        mpf(wheel.inertia) + sum(map(turning_inertia, machine.cylinders)),
    )

    def drive(degrees: Any, within: Any) -> Any:
        """M without inertia in N m."""
        total = mpf(0)
        for one, place in whole.cylinders:
            motion = one.motion.at(degrees - place)
            total += (
                one.at(degrees - place, within - place).M
                + one.mass * omega**2 * motion.slope * motion.curvature
            )
        return total

    def inertia(degrees: Any, _: Any) -> Any:
        slopes = [
            (one.mass, one.motion.at(degrees - place).slope) for one, place in whole.cylinders
        ]
        return rigid + sum(mass * slope**2 for mass, slope in slopes)

    work = integrals(np.frompyfunc(drive, 2, 1), whole.edges, STEPS).sum()
    mean = work / (whole.edges[-1] - whole.edges[0])

    def torque(speed: Any, mean: Any, omega: Any) -> tuple[Any, Any]:
        if load.slip is not None:
            steepness = abs(mean) / load.slip / omega
            return mean + steepness * (speed - omega), steepness + 0 * speed
        return mean * (speed / omega) ** load.power, mean * load.power / omega * (
            speed / omega
        ) ** (load.power - 1)

    both = [
        np.frompyfunc(lambda *at, one=one: one(*map(mp.degrees, at)), 2, 1)
        for one in (drive, inertia)
    ]
    precise = Motor(*both, lambda speed: torque(speed, mean, omega), omega)
    rough = Motor(
        *(lambda phi, at, one=one: np.asarray(one(MPF(phi), at), dtype=float) for one in both),
        lambda speed: torque(speed, float(mean), float(omega)),
        float(omega),
    )
    degrees = range(30, 360 * machine.revolutions + 1, 30)
    edges = merged(RADIANS(np.append(whole.edges, [mpf(degree) for degree in degrees])))
    kept, found = np.asarray(edges[1:], dtype=float), np.full(len(edges) - 1, math.inf)
    while len(edges) < 1000:
        floats, before = np.asarray(edges, dtype=float), found
        omegas, long = periodic(rough, floats, 14, precise=False)
        found = omegas[np.searchsorted(floats[1:], kept)]
        if not long.any() or np.abs(found / before - 1).max() < 1e-12:
            break
        edges = np.sort([*edges, *((edges[1:] + edges[:-1]) / 2)[long]])
    omegas, _ = periodic(precise, edges, 20, precise=True)
    return {
        degree: omegas[np.abs(edges[1:] - mp.radians(mpf(degree))).argmin()] for degree in degrees
    }


def spread(edges: Array, shares: Array) -> Array:
    """Return the angles at shares (m,) of the width of each piece, (n, m)."""
    return np.asarray(edges[:-1, None] + np.diff(edges)[:, None] * shares)


def within(edges: Array) -> Array:
    """Return the middle of each piece, (n, 1)."""
    return np.asarray((edges[1:] + edges[:-1]) / 2)[:, None]


class Motor(NamedTuple):
    """Kinetic energy K = ½ J ω² of a shaft in J, fed by drive − load per radian.

    drive: torque without inertia in N m; inertia: J in kg m²; load: takes ω, returns the torque and its slope by ω.
    """

    drive: Function
    inertia: Function
    load: Callable[[Any], tuple[Any, Any]]
    omega: Any


@cache
def _collocation(count: int) -> tuple[Array, Array]:
    """Return Chebyshev nodes (s,) on 0 … 1, the last of them 1, and the matrix (s, s) that integrates to them."""
    with mp.workdps(DIGITS):
        nodes = [(1 + mp.cos(2 * mp.pi * k / (2 * count - 1))) / 2 for k in reversed(range(count))]
        powers, integrals = mp.matrix(count), mp.matrix(count)
        for i, node in enumerate(nodes):
            for k in range(count):
                powers[i, k], integrals[i, k] = node**k, node ** (k + 1) / (k + 1)
        return np.array(nodes), np.array((integrals * powers**-1).tolist())


def periodic(motor: Motor, edges: Array, count: int, precise: bool) -> tuple[Array, Array]:
    """Return ω in rad/s at the ends of the elements, (n,), and which of them are too long, (n,).

    Collocation with Newton's method over the whole cycle. Corrections are floats: in mpmath's numbers each gains a
    dozen digits. Raises ArithmeticError.
    """
    of, sqrt, rounding = (MPF, SQRT, 1e-30) if precise else (np.float64, np.sqrt, 1e-15)
    nodes, matrix = (of(one) for one in _collocation(count))
    phi, widths = spread(edges, nodes), np.diff(edges)[:, None]
    drive, inertia = motor.drive(phi, within(edges)), motor.inertia(phi, within(edges))
    kinetic = nominal = inertia * motor.omega**2 / 2
    lengths, rigid, size = (
        np.asarray(widths, dtype=float),
        np.asarray(nominal, dtype=float),
        math.inf,
    )
    for _ in range(80):
        omega = sqrt(2 * kinetic / inertia)
        load, slope = motor.load(omega)
        rate, before = drive - load, np.roll(kinetic[:, -1], 1)[:, None]
        missing = np.asarray(before + widths * (rate @ matrix.T) - kinetic, dtype=float)
        stiffness = lengths * np.asarray(slope / (inertia * omega), dtype=float)
        system = np.eye(count) + np.asarray(matrix, dtype=float) * stiffness[:, None, :]
        own, passed = np.moveaxis(
            np.linalg.solve(system, np.stack((missing, np.ones_like(missing)), axis=2)), 2, 0
        )
        step = own + passed * _arriving(own[:, -1], passed[:, -1])[:, None]
        step *= min(1.0, 0.5 / max(1e-9, float((-step / np.asarray(kinetic, dtype=float)).max())))
        kinetic, last, size = kinetic + step, size, float(np.abs(step / rigid).max())
        if not size < 1e300:
            break
        if size < rounding or (size < 1e-9 and size > last / 2):
            tail = (
                np.asarray(rate, dtype=float)
                @ np.linalg.inv(
                    chebyshev.chebvander(np.asarray(2 * nodes - 1, dtype=float), count - 1)
                ).T
            )
            least = np.asarray(kinetic, dtype=float).min(axis=1)
            rough = np.abs(lengths * tail[:, -2:]).max(axis=1) > 1e-14 * least
            return sqrt(2 * kinetic / inertia)[:, -1], rough
    raise ArithmeticError("no solution")


def _arriving(own: Array, passed: Array) -> Array:
    """Return what arrives at each element (n,) if each sends on own + passed · arriving, the last one to the first."""
    alpha, beta = 1.0, 0.0
    for part, share in zip(own, passed):
        alpha, beta = share * alpha, share * beta + part
    found = [beta / (1 - alpha)]
    for part, share in zip(own[:-1], passed[:-1]):
        found.append(part + share * found[-1])
    return np.array(found)


def main() -> None:
    most = int(sys.argv[1]) if len(sys.argv) > 1 else 100
    cases = [case for case in all_cases() if case.asked.startswith("flywheel omega@")]
    print(f"{'machine':<34}{'at':>5}  {'reference':<34}{'of the table':>14}{'kurbel':>10}{'ms':>8}")
    with mp.workdps(DIGITS):
        for text in list(dict.fromkeys(case.machine for case in cases))[:most]:
            machine = loads(text)
            line = speed_line(machine)
            for case in (one for one in cases if one.machine == text):
                at = float(case.asked.partition("@")[2])
                begin = time.perf_counter()
                own = Case(machine).flywheel.at([at]).omega[0]
                spent, truth = 1e3 * (time.perf_counter() - begin), line[int(at)]
                off, missed = (
                    float(abs(one / truth - 1)) for one in (mpf(case.expected), mpf(float(own)))
                )
                print(
                    f"{case.case:<34}{at:>5g}  {mp.nstr(truth, 30):<34}{off:>14.0e}{missed:>10.0e}{spent:>8.1f}"
                )


if __name__ == "__main__":
    main()
