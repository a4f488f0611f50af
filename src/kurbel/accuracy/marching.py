"""The speed line by the usual methods: marching turn after turn until nothing changes, or an implicit periodic rule.

Each method returns ω (n,) in rad/s at every 30° of the last turn, and says in `state` what went wrong.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from kurbel.accuracy.given import Given
from kurbel.accuracy.periodic import SAMPLE_STEP, around
from kurbel.accuracy.textbook import Moved, TextbookMachine
from kurbel.arrays import Array
from kurbel.machine import Machine

OK, BLOW_UP, NEGATIVE, OPEN = "ok", "blow-up", "negative energy", "not periodic"
_SAME = 1e-9
"""What all further cycles may still change ω by, as a share of its swing, for a line to count as periodic."""


def _settled(change: float, before: float, swing: float, noise: float) -> bool:
    """Whether the changes of this and the last cycle, followed as a geometric series, come to nothing that matters.

    noise: what the method itself cannot tell from nothing, in rad/s.
    """
    if math.isinf(before):
        return False
    rest = 1 - abs(change / before) if before else 1.0
    return abs(change) <= max(_SAME * swing * rest, noise * min(rest * 10, 1))


class March(NamedTuple):
    """What a method found: ω at every 30°, None after a failure; the state; evaluations of the torque."""

    omega: Array | None
    state: str
    evaluations: int


class SpeedProblem:
    """dω/dφ = (M − M_load(ω) − ½ J′ ω²)/(J ω), written down as the textbooks do; K = ½ J ω².

    mean: of the effort in N m, exact, so that the error of a speed line is its own.
    """

    def __init__(self, machine: Machine, mean: float) -> None:
        assert machine.speed is not None
        assert machine.flywheel is not None
        assert machine.load is not None
        self.omega = 2 * math.pi * machine.speed
        self.cycle = 2 * math.pi * machine.revolutions
        self.samples = 360 // SAMPLE_STEP * machine.revolutions
        self._machine = machine
        self._load = machine.load
        self._flywheel = machine.flywheel.inertia or 0.0
        self._textbook = TextbookMachine(machine)
        self.mean = mean

    def _moving(self, phi: Array) -> tuple[Array, Array]:
        """Return Σ (m x′² + (1 − s) m_r R²), with the rod's share s, and Σ m x′ x″ in kg m²."""
        square, product = np.zeros_like(phi), np.zeros_like(phi)
        for cylinder in self._machine.cylinders:
            given = Given(self._machine, cylinder, float)
            at = Moved(cylinder.mechanism, phi - math.radians(cylinder.crank_position))
            square += given.mass * at.slope**2 + given.turning_inertia
            product += given.mass * at.slope * at.curvature
        return square, product

    def effort(self, phi: Array) -> Array:
        """Return the turning effort without inertia in N m."""
        product = self._moving(phi)[1]
        return self._machine.efficiency * (self._textbook.torque(phi) + product * self.omega**2)

    def inertia(self, phi: Array) -> Array:
        """Return J(φ) in kg m²."""
        return self._flywheel + self._moving(phi)[0]

    def load(self, omega: Any) -> Any:
        """Return the torque of the load in N m."""
        if self._load.slip is not None:
            return self.mean + abs(self.mean) * (omega / self.omega - 1) / self._load.slip
        return self.mean * (omega / self.omega) ** (self._load.power or 0.0)

    def load_slope(self, omega: Any) -> Any:
        """Return dM_load/dω in N m s."""
        if self._load.slip is not None:
            return abs(self.mean) / (self._load.slip * self.omega) * np.ones_like(omega)
        power = self._load.power or 0.0
        return power * self.mean / self.omega * (omega / self.omega) ** (power - 1)


def _steps(count: int, cycle: float) -> Array:
    return np.asarray(np.arange(count) * (cycle / count))


def runge_kutta(problem: SpeedProblem, steps: int, turns: int) -> March:
    """March K with the classical Runge-Kutta rule, so many steps to a turn, for at most so many cycles."""
    march = _Marching(problem, steps * problem.samples * SAMPLE_STEP // 360)
    kinetic = march.inertia[0] * problem.omega**2 / 2
    change = math.inf
    try:
        for _ in range(turns):
            line, kinetic = march.cycle(kinetic)
            before, change = change, math.sqrt(2 * kinetic / march.inertia[-1]) - line[0]
            if _settled(change, before, max(line) - min(line), 1e-13 * problem.omega):
                return March(np.array(line), OK, march.used)
    except _Stopped as end:
        return March(None, str(end), march.used)
    except OverflowError:
        return March(None, BLOW_UP, march.used)
    return March(np.array(line), OPEN, march.used)


class _Marching:
    """One cycle of Runge-Kutta: effort and inertia at the ends and middles of so many steps; used: evaluations."""

    def __init__(self, problem: SpeedProblem, count: int) -> None:
        half = np.append(_steps(2 * count, problem.cycle), problem.cycle)
        self._effort: list[float] = problem.effort(half).tolist()
        self.inertia: list[float] = problem.inertia(half).tolist()
        self._count, self._width, self._every = count, problem.cycle / count, count // problem.samples
        self._problem = problem
        self.used = 0

    def cycle(self, kinetic: float) -> tuple[list[float], float]:
        """Return ω at every 30° and K at the end. Raises _Stopped, OverflowError."""
        line: list[float] = []
        for i in range(self._count):
            if i % self._every == 0:
                line.append(math.sqrt(2 * kinetic / self.inertia[2 * i]))
            kinetic = self._step(2 * i, kinetic)
        return line, kinetic

    def _step(self, at: int, kinetic: float) -> float:
        width = self._width
        k1 = self._rate(at, kinetic)
        k2 = self._rate(at + 1, kinetic + width / 2 * k1)
        k3 = self._rate(at + 1, kinetic + width / 2 * k2)
        k4 = self._rate(at + 2, kinetic + width * k3)
        kinetic += width / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        if kinetic <= 0:
            raise _Stopped(NEGATIVE)
        return kinetic

    def _rate(self, at: int, kinetic: float) -> float:
        self.used += 1
        if kinetic <= 0:
            raise _Stopped(NEGATIVE)
        if not kinetic < 1e300:
            raise _Stopped(BLOW_UP)
        return float(self._effort[at] - self._problem.load(math.sqrt(2 * kinetic / self.inertia[at])))


class _Stopped(Exception):
    """The marching came to a bad end, named by the text."""


def implicit_trapezoid(problem: SpeedProblem, steps: int) -> March:
    """Solve the trapezium rule for K over the whole cycle at once, by Newton with the cycle closed."""
    count = steps * problem.samples * SAMPLE_STEP // 360
    phi = _steps(count, problem.cycle)
    effort, inertia = problem.effort(phi), problem.inertia(phi)
    half = problem.cycle / count / 2
    kinetic = inertia * problem.omega**2 / 2
    used = 0
    for _ in range(60):
        omega = np.sqrt(2 * kinetic / inertia)
        rate = effort - problem.load(omega)
        slope = -problem.load_slope(omega) / (inertia * omega)
        used += count
        left = np.roll(kinetic, -1) - kinetic - half * (rate + np.roll(rate, -1))
        step = _cyclic(1 + half * slope, 1 - half * np.roll(slope, -1), left)
        while (kinetic + step <= 0).any():
            step = step / 2
        kinetic = kinetic + step
        if np.abs(step / kinetic).max() < 1e-15:
            break
    else:
        if np.abs(step / kinetic).max() > 1e-9:
            return March(None, BLOW_UP, used)
    return March(np.sqrt(2 * kinetic / inertia)[:: count // problem.samples], OK, used)


def _cyclic(before: Array, after: Array, left: Array) -> Array:
    """Solve after_i d_(i+1) − before_i d_i = −left_i around the cycle."""
    moves = zip((-left / after).tolist(), (before / after).tolist())
    return np.roll([end for (end,) in around([[move] for move in moves])], 1)


def scipy_march(problem: SpeedProblem, method: str, tolerance: float, turns: int) -> March:
    """March ω with scipy's solve_ivp, started anew each cycle, without restarts at the jumps, as most people would."""
    from scipy.integrate import solve_ivp  # type: ignore[import-untyped, unused-ignore]

    begin = problem.omega
    wanted = np.arange(problem.samples + 1) * (problem.cycle / problem.samples)
    wanted[-1] = problem.cycle
    step = 1e-6
    change, used = math.inf, 0

    def rate(phi: float, state: Array) -> Array:
        at = np.array([phi, phi - step, phi + step])
        inertia = problem.inertia(at)
        bend = (inertia[2] - inertia[1]) / (4 * step)
        omega = state[0]
        drive = problem.effort(at[:1])[0] - problem.load(omega) - bend * omega**2
        return np.array([drive / (inertia[0] * omega)])

    for _ in range(turns):
        with np.errstate(all="ignore"):
            try:
                solution = solve_ivp(
                    rate, (0, problem.cycle), [begin], method, wanted, rtol=tolerance, atol=tolerance * problem.omega
                )
            except (ValueError, FloatingPointError):
                return March(None, BLOW_UP, used)
        used += solution.nfev
        if not solution.success or len(solution.y[0]) < len(wanted):
            return March(None, BLOW_UP, used)
        line, end = solution.y[0][:-1], float(solution.y[0][-1])
        before, change = change, end - begin
        if _settled(change, before, float(np.ptp(line)), tolerance * problem.omega):
            return March(line, OK, used)
        begin = end
    return March(line, OPEN, used)
