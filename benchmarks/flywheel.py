"""Periodic speed of a machine: error against run time beside marching by scipy's Radau, BDF, LSODA and explicit RK4.

python benchmarks/flywheel.py

A turning effort with jumps drives a fan, whose torque goes with the square of the speed: the kinetic energy then has a
closed solution, computed here with 60 digits. The relaxation time says how fast the speed forgets, in revolutions.
Errors are relative in the energy, the largest at twelve angles; times are ratios to kurbel's in the same run. The
marching methods start at the nominal speed and run until they repeat, 15 turns at the most, as a plain user would have
them do. Needs mpmath; scipy is left out where it is missing.
"""

from __future__ import annotations

import importlib.util
import math
import statistics
import sys
import time
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import mpmath
import numpy as np

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))
sys.path.insert(0, str(Path(__file__).parent.parent / "tests" / "solver"))

from kurbel.machine import Cylinder, Machine
from kurbel.machine.indicator import Indicator
from kurbel.machine.parts import Masses, Piston
from kurbel.machine.shaft_side import Flywheel, Load
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.solver.case import Case
from machines import STEAM_CARD
from turning_machines import of_points

POINTS = [
    (0, 500),
    (40, 1500),
    (40, 900),
    (120, 200),
    (200, 300),
    (200, 1300),
    (290, 100),
    (360, 250),
]
ANGLES = np.arange(12) * 30.0 + 1.5
RPM, OMEGA, MOST_TURNS, PATIENCE = 60.0, 2 * math.pi, 15, 3.0
RELAXATIONS = (1e3, 1.0, 1e-1, 1e-3, 1e-5, 1e-7, 1e-9, 1e-11)


def inertia_for(relaxation: float) -> float:
    """J in kg m² for a relaxation time in revolutions."""
    return 4 * math.pi * relaxation * of_points(POINTS, RPM).M_mean / OMEGA**2


def truth(inertia: float) -> np.ndarray:
    """Kinetic energy in J at ANGLES: E′ = M − a E over straight pieces, closed, with 60 digits."""
    with mpmath.workdps(60):
        mp = mpmath.mp
        pieces = [
            (mp.radians(a0), mp.radians(a1), mp.mpf(m0), (mp.mpf(m1) - m0) / mp.radians(a1 - a0))
            for (a0, m0), (a1, m1) in pairwise(POINTS)
            if a1 > a0
        ]
        mean = sum((high - low) * (m + r * (high - low) / 2) for low, high, m, r in pieces) / (
            2 * mp.pi
        )
        rate = mean / (mp.mpf(inertia) / 2 * (2 * mp.pi) ** 2)

        def after(energy: Any, upto: Any) -> Any:
            for low, high, m, r in pieces:
                way = min(high, upto) - low
                if way <= 0:
                    break
                base = m / rate - r / rate**2
                energy = (energy - base) * mp.exp(-rate * way) + base + r * way / rate
            return energy

        start = after(mp.mpf(0), 2 * mp.pi) / (1 - mp.exp(-2 * mp.pi * rate))
        return np.array([float(after(start, mp.radians(mp.mpf(a)))) for a in ANGLES])


def by_kurbel(inertia: float) -> np.ndarray:
    """The periodic state by collocation."""
    omega = of_points(POINTS, RPM, inertia=inertia, load=Load(power=2.0)).at(ANGLES).omega
    return inertia / 2 * omega**2


def slope_of(inertia: float) -> tuple[Callable[[float, Any], Any], float]:
    """dE/dφ over φ in radians, and the energy at the nominal speed."""
    angles, torques = zip(*POINTS)
    nominal = inertia / 2 * OMEGA**2
    mean = of_points(POINTS, RPM).M_mean
    end = time.perf_counter() + PATIENCE

    def slope(phi: float, energy: Any) -> Any:
        if time.perf_counter() > end:
            raise TimeoutError
        return np.interp(math.degrees(phi) % 360, angles, torques) - mean * energy / nominal

    return slope, nominal


def by_scipy(method: str, tolerance: float) -> Callable[[float], np.ndarray]:
    """Marching by a method of scipy."""

    def solve(inertia: float) -> np.ndarray:
        from scipy.integrate import solve_ivp

        slope, nominal = slope_of(inertia)
        energy = np.array([nominal])
        for _ in range(MOST_TURNS):
            out = solve_ivp(
                slope,
                (0, 2 * math.pi),
                energy,
                method,
                np.radians([*ANGLES, 360.0]),
                rtol=tolerance,
                atol=1e-300,
            )
            if not out.success or not np.isfinite(out.y).all():
                raise ArithmeticError
            settled = abs(out.y[0, -1] / energy[0] - 1) < tolerance
            energy = out.y[:, -1]
            if settled:
                break
        return np.asarray(out.y[0, :-1])

    return solve


def by_rk4(steps: int) -> Callable[[float], np.ndarray]:
    """Marching by the classical Runge-Kutta method with equal steps."""

    def solve(inertia: float) -> np.ndarray:
        slope, energy = slope_of(inertia)
        h = 2 * math.pi / steps
        for _ in range(MOST_TURNS):
            line = [energy]
            for i in range(steps):
                phi = i * h
                k1 = slope(phi, energy)
                k2 = slope(phi + h / 2, energy + h / 2 * k1)
                k3 = slope(phi + h / 2, energy + h / 2 * k2)
                k4 = slope(phi + h, energy + h * k3)
                energy += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
                if not 0 < energy < 1e300:
                    raise ArithmeticError
                line.append(energy)
            if abs(line[-1] / line[0] - 1) < 1e-12:
                break
        return np.interp(np.radians(ANGLES), np.linspace(0, 2 * math.pi, steps + 1), line)

    return solve


def timed(solve: Callable[[float], np.ndarray], inertia: float) -> tuple[np.ndarray, float]:
    """The solution and its median time in s, single runs kept where they are long."""
    times, found = [], None
    for _ in range(7):
        begin = time.perf_counter()
        found = solve(inertia)
        times.append(time.perf_counter() - begin)
        if times[-1] > 0.3:
            break
    assert found is not None
    return found, statistics.median(times)


def two_cylinders(slip: float) -> float:
    """Seconds for everything that kurbel flywheel answers for a two-cylinder engine with this slip."""
    from kurbel.report.commands import report_of
    from kurbel.tables.frame import Frame

    card = Piston(0.45, 0.075, 0.1, Indicator(STEAM_CARD, STEAM_CARD))
    both = tuple(
        Cylinder(
            SliderCrank(0.4, 2.0), f"cylinder {i}", (card,), Masses(826.0), crank_position=90.0 * i
        )
        for i in range(2)
    )
    machine = Machine(both, speed=50 / 60, flywheel=Flywheel(9000.0), load=Load(slip=slip))
    angles = [10.0 * i for i in range(37)]
    times = []
    for _ in range(20):
        begin = time.perf_counter()
        report_of(Case(machine), Frame("flywheel", angles, None, "si"))
        times.append(time.perf_counter() - begin)
    return statistics.median(times)


def main() -> None:
    """Print both tables."""
    methods: dict[str, Callable[[float], np.ndarray]] = {
        "kurbel": by_kurbel,
        "RK4, 3600 steps": by_rk4(3600),
    }
    if importlib.util.find_spec("scipy"):
        for name in ("Radau", "BDF", "LSODA"):
            methods |= {
                f"scipy {name} 1e-6": by_scipy(name, 1e-6),
                f"scipy {name} 1e-10": by_scipy(name, 1e-10),
            }
    print("largest relative error of the energy (time over kurbel's)\n")
    print(
        f"{'relaxation, revolutions':<24}"
        + "".join(f"{relaxation:>18g}" for relaxation in RELAXATIONS)
    )
    base: dict[float, float] = {}
    for name, solve in methods.items():
        cells = []
        for relaxation in RELAXATIONS:
            inertia = inertia_for(relaxation)
            try:
                found, seconds = timed(solve, inertia)
            except (ArithmeticError, TimeoutError) as failure:
                cells.append("blows up" if isinstance(failure, ArithmeticError) else "> 3 s")
                continue
            base.setdefault(relaxation, seconds)
            error = np.abs(found / truth(inertia) - 1).max()
            cells.append(f"{error:.0e} ({seconds / base[relaxation]:.3g})")
        print(f"{name:<24}" + "".join(f"{cell:>18}" for cell in cells))
    print("\ntwo-cylinder engine, the whole report in the process")
    for slip in (1.0, 1e-2, 1e-5, 1e-9):
        print(f"  slip {slip:<8g}{two_cylinders(slip) * 1e3:8.1f} ms")


if __name__ == "__main__":
    main()
