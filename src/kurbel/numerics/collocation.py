"""Periodic solutions of y′ = f(φ, y) by collocation: Radau nodes on the pieces of the cycles of many machines at once.

Radau IIA is L-stable: what relaxes within a hair of a turn is damped out, where Gauss or trapezium rules would ring.
The whole cycle is solved at once, so that it does not matter how many turns a marching method would need to settle.
Every machine takes its own share of Newton's step and is done by itself; pieces on which its solution is no polynomial
yet are halved.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple, Protocol

import numpy as np

from kurbel.arrays import Array, Flags
from kurbel.numerics.lobatto import chebyshev, integral_of_series, rule
from kurbel.numerics.pieces import TAIL, Pieces, joined

_NARROWEST = 1e-10
"""Degrees of a piece that is halved no more."""
_FEWEST = 11
"""Nodes of a piece, where its torques need less: what follows a kink needs them."""
_ROUNDS, _MOST_PIECES = 60, 20_000
_ENDLESS = 1e24
"""Times the kinetic energy: with so much any load is followed."""
_STEP, _SHORTEST, _MOST_STEPS = 1e-4, 0.998, 80
"""Largest and smallest cut of that energy on the way back, and number of cuts."""
_STANDING = 0.05
"""Of the kinetic energy at y = 0: less than this counts as standing still where the way back ends."""
_AT_ONCE = 4_000_000
"""Numbers of the matrices of the pieces that are solved together."""
_OPEN = 1e-11
"""A singular value that is smaller leaves a direction open: that of rounding is 1e-13."""


class Unsettled(Exception):
    """No solution is found; enough: how far to ease the equation for one, in the unit of y, or None if not known."""

    def __init__(self, enough: float | None = None) -> None:
        super().__init__("no periodic solution found")
        self.enough = enough


class Standstill(Unsettled):
    """The machine stops near an angle in degrees; enough: see `Unsettled`."""

    def __init__(self, degrees: float, enough: float | None = None) -> None:
        super().__init__(enough)
        self.degrees = degrees


class Equation(Protocol):
    """y′ = f(φ, y), per radian, with m unknowns y of about one size for each of many machines.

    bounded: the unknown that must stay above −height. noise (machines,): smaller parts of y are not refined. eased
    (machines,), from 0 on: is added to the height, and makes the equation the tamer the more y moves f less.
    """

    unknowns: int
    bounded: int
    noise: Array

    def known(self, pieces: Pieces) -> Array:
        """Return what depends on the angle alone at the Lobatto nodes of pieces, (…, nodes, pieces)."""
        ...

    def rate(self, known: Array, y: Array, pieces: Pieces, eased: Array) -> tuple[Array, Array]:
        """Return f (m, k, pieces) and ∂f/∂y (m, m, k, pieces) at y (m, k, pieces), where `known` is (…, k, pieces)."""
        ...

    def height(self, known: Array, pieces: Pieces, eased: Array) -> Array:
        """Return how far the bounded unknown may fall below 0, (k, pieces) or (pieces,); ∞ where nothing bounds it."""
        ...


class Radau:
    """Radau nodes in (−1, 1], as many as the pieces have Lobatto nodes, and the matrices of a start and these nodes.

    area (k, k): values into integrals from −1 to every node; series (k + 1, k + 1): start and values into Chebyshev
    coefficients; halving (2k + 2, k + 1): start and values into those of both halves; from_lobatto (k, k): samples into
    values at the nodes; to_lobatto (k, k + 1): start and values back.
    """

    def __init__(self, count: int) -> None:
        # Golub: Jacobi matrix of the Legendre polynomials whose last entry puts an eigenvalue at 1
        n = np.arange(count)
        off = n[1:] / np.sqrt(4.0 * n[1:] ** 2 - 1)
        last = np.where(n == count - 1, count / (2 * count - 1), 0.0)
        self.nodes = np.append(np.linalg.eigvalsh(np.diag(last) + np.diag(off, 1) + np.diag(off, -1))[:-1], 1.0)
        at_nodes = chebyshev(self.nodes, count + 1)
        self.area = at_nodes @ integral_of_series(count) @ np.linalg.inv(at_nodes[:, :count])
        places = np.append(-1.0, self.nodes)
        self.series = np.linalg.inv(chebyshev(places, count + 1))
        self.halving = chebyshev(np.concatenate((places - 1, places + 1)) / 2, count + 1) @ self.series
        self.from_lobatto = at_nodes[:, :count] @ rule(count).series
        self.to_lobatto = chebyshev(rule(count).nodes, count + 1) @ self.series


radau = lru_cache(Radau)
"""The rule of so many nodes."""


class Periodic(NamedTuple):
    """Periodic solutions: y (m, k + 1, pieces) at the starts of the pieces and their Radau nodes.

    failed (machines,): which have none; short (machines,): how much they must be eased for one, nan where not known.
    """

    equation: Equation
    pieces: Pieces
    y: Array
    failed: Flags
    short: Array

    @property
    def samples(self) -> Array:
        """y at the Lobatto nodes of the pieces, (m, nodes, pieces); 0 of machines that have no solution."""
        y = np.where(self.pieces.of(self.failed), 0.0, self.y)
        return np.asarray(radau(len(self.pieces.rule.nodes)).to_lobatto @ y)

    def refuse(self) -> None:
        """Raise Standstill or Unsettled where the only machine has no solution."""
        if not self.failed[0]:
            return
        if np.isnan(self.short[0]):
            raise Unsettled
        system = _System(self.equation, self.pieces, self.short)
        share = (1 + self.y[self.equation.bounded, 1:] / system.height).T
        if share.min() > _STANDING:
            raise Unsettled(float(self.short[0]))
        degrees = self.pieces.low + self.pieces.half * (1 + system.rule.nodes[:, None])
        raise Standstill(float(degrees.T.ravel()[np.argmin(share)]), float(self.short[0]))

    @property
    def growth(self) -> Array:
        """Logarithms of what is left of small disturbances after a cycle (Floquet), (machines,)."""
        y = np.where(self.pieces.of(self.failed), 0.0, self.y)
        system = _System(self.equation, self.pieces, np.zeros(self.pieces.count))
        _, lack, stiffness = system.lacking(y)
        unit, size = np.eye(len(y)), np.zeros(self.pieces.count)
        whole = np.broadcast_to(unit, (len(size), *unit.shape))
        for gain in np.swapaxes(system.padded(system.inside(lack, stiffness)[1][-1], unit), 0, 1):
            whole = gain @ whole
            largest = np.maximum(np.abs(whole).max(axis=(1, 2)), 1e-300)
            whole, size = whole / largest[:, None, None], size + np.log(largest)
        return np.asarray(size + np.log(np.maximum(np.abs(np.linalg.eigvals(whole)).max(axis=-1), 5e-324)))


def periodic(equation: Equation, pieces: Pieces) -> Periodic:
    """Return the solutions of y′ = f(φ, y) with the periods of the machines.

    Newton's method starts from y = 0; where that leads nowhere, from a solution of an eased equation, which is followed
    back to the given one. What a linear equation leaves open is as small as can be.
    """
    pieces = pieces.with_nodes(max(_FEWEST, len(pieces.rule.nodes)))
    still = _Solution(pieces, np.zeros((equation.unknowns, len(pieces.rule.nodes) + 1, len(pieces.half))))
    with np.errstate(all="ignore"):  # a step too far may overflow; it is taken back
        found, good = _settled(equation, still, np.zeros(pieces.count))
        short = np.full(pieces.count, np.nan)
        if not good.all():
            more, later, short = _followed(equation, still.of(~good))
            found, good = found.replaced(more, ~good), good | later
    return Periodic(equation, found.pieces, found.y, ~good, short)


class _Solution(NamedTuple):
    """What is known of the unknowns on a row of pieces, (m, k + 1, pieces)."""

    pieces: Pieces
    y: Array

    def of(self, machines: Flags) -> _Solution:
        """Return that of these machines."""
        rows = machines[self.pieces.machine]
        return _Solution(self.pieces.taken(rows), self.y[..., rows])

    def replaced(self, other: _Solution, machines: Flags) -> _Solution:
        """Return it with that of these machines taken from another one."""
        return _joined([self.of(~machines), other.of(machines)])


def _joined(parts: Sequence[_Solution]) -> _Solution:
    return _Solution(*joined([one.pieces for one in parts], [one.y for one in parts]))


def _largest(pieces: Pieces, values: Array) -> Array:
    """Return the largest of values (…, pieces) of every machine (machines,), −∞ of one that has no pieces here."""
    found = np.full(pieces.count, -np.inf)
    np.maximum.at(found, pieces.machine, values.reshape(-1, len(pieces.machine)).max(axis=0))
    return found


def _swing(pieces: Pieces, y: Array) -> Array:
    """Return the range of each unknown (m, …, pieces) in every machine, (m, machines)."""
    return np.array([_largest(pieces, one) + _largest(pieces, -one) for one in y])


# Newton's method, and halving


def _settled(equation: Equation, start: _Solution, eased: Array) -> tuple[_Solution, Flags]:
    """Solve and refine until every piece is smooth, and return which machines have settled.

    A machine that is smooth is done with; the others go on without it.
    """
    count = start.pieces.count
    settled, done, left = np.zeros(count, dtype=bool), [], start
    for _ in range(_ROUNDS):
        system = _System(equation, left.pieces, eased)
        y, good = _newton(system, left.y)
        rough = _rough(system, y) & good[left.pieces.machine]
        unsmooth = np.bincount(left.pieces.machine[rough], minlength=count) > 0
        settled |= good & ~unsmooth
        going = good & unsmooth & (np.bincount(left.pieces.machine, minlength=count) <= _MOST_PIECES)
        left, rough = _Solution(left.pieces, y), rough[going[left.pieces.machine]]
        done.append(left.of(~going))
        left = left.of(going)
        if not len(rough):
            break
        left = _halved(system, left, rough)
    else:
        done.append(left)
    return _joined(done), settled


def _rough(system: _System, y: Array) -> Flags:
    """Return on which pieces y is no polynomial yet."""
    pieces = system.pieces
    tails = np.abs(system.rule.series[-2:] @ y).sum(axis=1)
    least = TAIL * _swing(pieces, y) + 4e-15 * _largest(pieces, np.abs(y)) + system.equation.noise
    return np.asarray((tails > least[:, pieces.machine]).any(axis=0) & (pieces.half > _NARROWEST / 2))


def _halved(system: _System, found: _Solution, rough: Flags) -> _Solution:
    """Halve the rough pieces; y on the halves comes from the polynomials, and stays above its bound."""
    halves, (m, nodes, _) = found.pieces.halved(rough), found.y.shape
    y = (system.rule.halving @ found.y[..., rough]).reshape(m, 2, nodes, -1).transpose(0, 2, 3, 1).reshape(m, nodes, -1)
    bounded = y[system.equation.bounded, 1:]
    np.maximum(bounded, -0.99 * _System(system.equation, halves, system.eased).height, out=bounded)
    return _joined([_Solution(found.pieces.taken(~rough), found.y[..., ~rough]), _Solution(halves, y)])


class _System:
    """The collocation equations on a row of pieces: those inside of each, and those that join it to the next."""

    def __init__(self, equation: Equation, pieces: Pieces, eased: Array) -> None:
        self.equation, self.pieces, self.eased = equation, pieces, eased
        self.rule, self.half = radau(len(pieces.rule.nodes)), np.radians(pieces.half)
        self.known = self.rule.from_lobatto @ equation.known(pieces)
        self.height = equation.height(self.known, pieces, eased)
        _, self._row, lengths = np.unique(pieces.machine, return_inverse=True, return_counts=True)
        begins = np.cumsum(lengths) - lengths
        self._place = np.arange(len(self._row)) - begins[self._row]
        self._shape = len(lengths), int(lengths.max(initial=0))
        self.after = np.arange(1, len(self._row) + 1)
        self.after[begins + lengths - 1] = begins

    def lacking(self, y: Array) -> tuple[Array, Array, Array]:
        """Return what the equations lack at starts (m, pieces) and nodes (m, k, pieces), and half ∂f/∂y there.

        At the start of a piece that is what the end before it has more, at its nodes what the rate makes of the start.
        """
        rate, slope = self.equation.rate(self.known, y[:, 1:], self.pieces, self.eased)
        jump = np.empty_like(y[:, 0])
        jump[:, self.after] = y[:, -1] - y[:, 0, self.after]
        return jump, y[:, :1] + self.half * (self.rule.area @ rate) - y[:, 1:], self.half * slope

    def size(self, jump: Array, lack: Array) -> Array:
        """Return the size of what is lacking, (machines,); not a number where the rate overflows."""
        squares = np.square(jump).sum(axis=0) + np.square(lack).sum(axis=(0, 1))
        return np.asarray(np.sqrt(np.bincount(self.pieces.machine, squares, minlength=self.pieces.count)))

    def step(self, jump: Array, lack: Array, stiffness: Array) -> Array:
        """Return Newton's step of y: in a piece δ = response + gain δ_start, its last node starts the next one."""
        response, gain = self.inside(lack, stiffness)
        ends, more = gain[-1], response[-1] + jump[:, self.after].T
        start = around_the_cycle(self.padded(ends, np.eye(len(jump))), self.padded(more, np.zeros(len(jump))))
        start = start[self._row, self._place]
        inside = response + (gain @ start[:, :, None])[..., 0]
        return np.asarray(np.concatenate((start[None], inside)).transpose(2, 0, 1))

    def inside(self, lack: Array, stiffness: Array) -> tuple[Array, Array]:
        """Return the changes at the nodes (k, pieces, m) that make up a lack, and those per change at the start."""
        m, k, count = lack.shape
        found = np.empty((k, count, m, m + 1))
        chunk = max(1, _AT_ONCE // (m * k) ** 2)
        for start in range(0, count, chunk):
            some = np.s_[start : start + chunk]
            slopes = stiffness[..., some].transpose(3, 0, 2, 1)[:, None]
            systems = np.eye(m * k) - (self.rule.area[:, None, :, None] * slopes).reshape(-1, m * k, m * k)
            sides = np.empty((len(systems), k, m, m + 1))
            sides[..., 0], sides[..., 1:] = lack[..., some].transpose(2, 1, 0), np.eye(m)
            solved = _solved(systems, sides.reshape(-1, m * k, m + 1))
            found[:, some] = solved.reshape(sides.shape).swapaxes(0, 1)
        return found[..., 0], found[..., 1:]

    def padded(self, values: Array, rest: Array) -> Array:
        """Return what each piece has (pieces, …) as (rows of machines, longest, …), filled up with `rest` (…)."""
        found = np.empty((*self._shape, *rest.shape))
        found[:] = rest
        found[self._row, self._place] = values
        return found


def _solved(systems: Array, sides: Array) -> Array:
    """Return the solutions of systems (n, …); not a number where one is singular."""
    try:
        return np.asarray(np.linalg.solve(systems, sides))
    except np.linalg.LinAlgError:
        if len(systems) == 1:
            return np.full_like(sides, np.nan)
        return np.concatenate([_solved(systems[k : k + 1], sides[k : k + 1]) for k in range(len(systems))])


def around_the_cycle(gain: Array, more: Array) -> Array:
    """Return x (n, k, m) with x_{i+1} = gain_i x_i + more_i, x_k being x_0; gain (n, k, m, m), more (n, k, m).

    A single unknown that grows along the cycle is followed backward, where it decays. What the equations leave open is
    taken as small as can be. Of what is not finite it is not a number.
    """
    finite = np.asarray(np.isfinite(gain).all(axis=(1, 2, 3)) & np.isfinite(more).all(axis=(1, 2)))[:, None, None]
    gain, more = np.where(finite[..., None], gain, 0.0), np.where(finite, more, 0.0)
    if more.shape[2] > 1:
        return np.where(finite, _paired(gain, more), np.nan)
    grows = (np.log(np.maximum(np.abs(gain[..., 0]), 1e-300)).sum(axis=1) > 0)[:, None]
    back = 1 / np.where(grows, gain[:, ::-1, :, 0], 1.0)
    found = _paired(np.where(grows, back, gain[..., 0])[..., None], np.where(grows, -more[:, ::-1] * back, more))
    return np.where(finite, np.where(grows, np.roll(found[:, ::-1], 1, axis=1), found), np.nan)


def _paired(gain: Array, more: Array) -> Array:
    """Return the same, forward: pieces are joined in pairs until one is left, whose start is its end."""
    count, size = more.shape[1:]
    if count == 1:
        closed = np.linalg.pinv(np.eye(size) - gain[:, 0], rcond=_OPEN)
        return np.asarray(closed @ more[:, 0, :, None])[:, None, :, 0]
    if count % 2:  # a piece on which nothing changes
        unit = np.broadcast_to(np.eye(size), gain[:, :1].shape)
        gain, more = np.concatenate((gain, unit), axis=1), np.concatenate((more, 0 * more[:, :1]), axis=1)
    (first, second), (early, late) = (gain[:, ::2], gain[:, 1::2]), (more[:, ::2], more[:, 1::2])
    starts = _paired(second @ first, (second @ early[..., None])[..., 0] + late)
    middles = (first @ starts[..., None])[..., 0] + early
    return np.stack((starts, middles), axis=2).reshape(more.shape)[:, :count]


def _newton(system: _System, y: Array) -> tuple[Array, Flags]:
    """Solve the collocation equations by Newton's method, and return which machines have settled.

    A machine that has settled, or fails, stays as it is. Steps are halved until less is lacking.
    """
    pieces, of, bounded = system.pieces, system.pieces.machine, system.equation.bounded
    going = np.bincount(of, minlength=pieces.count) > 0
    good, previous = np.zeros_like(going), np.full(pieces.count, np.inf)
    highest = _largest(pieces, np.where(np.isfinite(system.height), system.height, 0.0))
    lacking = system.lacking(y)
    for _ in range(100):
        now = system.size(*lacking[:2])
        going &= np.isfinite(now)
        if not going.any():
            break
        step = system.step(*lacking)
        size = _largest(pieces, np.abs(step))
        going &= np.isfinite(size)
        step[..., ~going[of]] = 0.0
        # far above its bound y is moved as a whole by rounding, though by nothing relative to that height
        near = np.maximum(1e-9 * _swing(pieces, y + step).max(axis=0), 1e-14 * highest)
        fall = -step[bounded, 1:] / (0.9 * (y[bounded, 1:] + system.height))
        share = 1 / np.maximum(_largest(pieces, fall), 1.0)
        while True:
            new = y + share[of] * step
            lacking = system.lacking(new)
            after = system.size(*lacking[:2])
            poor = going & (size > near) & ~(after <= (1 - share / 8) * now) & (share > 1e-6)
            if not poor.any():
                break
            share = np.where(poor, share / 2, share)
        y = new
        # the next step makes up what is still lacking: for a linear equation only rounding
        left = np.where(now > 0, size * after / now, 0.0)
        small = (size <= 1e-6 * near) | (left <= 1e-5 * near) | ((size <= near) & (size >= previous / 4))
        good |= going & (share == 1) & small
        going &= ~good & (share > 1e-6)
        previous = np.where(share == 1, size, np.inf)
    return y, good


# from an eased equation back to the given one


def _followed(equation: Equation, start: _Solution) -> tuple[_Solution, Flags, Array]:
    """Follow the solutions of these machines from an endless kinetic energy down to their own.

    Returned with them: which machines have settled, and how much more energy the others needed last.
    """
    none = np.zeros(start.pieces.count)
    own = np.maximum(_largest(start.pieces, _System(equation, start.pieces, none).height), 0.0)
    running = np.isfinite(own) & (own > 0)
    found, energy, target, share = start, np.full_like(own, np.nan), own * _ENDLESS, np.full_like(own, _STEP)
    for _ in range(_MOST_STEPS):
        running = running & ~(energy <= own) & (share <= _SHORTEST)
        if not running.any():
            break
        finer, good = _settled(equation, found.of(running), np.where(running, target - own, 0.0))
        found, energy = found.replaced(finer, good), np.where(good, target, energy)
        share = np.where(good, np.maximum(share**1.5, _STEP), np.where(running, np.sqrt(share), share))
        target = np.maximum(energy * share, own)
    return found, energy <= own, energy - own
