"""Periodic solutions of y′ = f(φ, y) by collocation: Radau nodes on the pieces of the cycles of many machines at once.

Radau IIA is L-stable: what relaxes within a hair of a turn is damped out, where Gauss or trapezium rules would ring.
The whole cycle is solved at once, so that it does not matter how many turns a marching method would need to settle.
Every machine takes its own share of Newton's step and is done by itself; pieces on which its solution is no polynomial
yet are halved.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple, Protocol

import numpy as np

from kurbel.arrays import Array, Flags
from kurbel.numerics.lobatto import chebyshev, integral_of_series, rule, series_at
from kurbel.numerics.pieces import Pieces, joined

_TOLERANCE = 1e-13
"""Of the swing of an unknown: what the last two coefficients on a piece may be."""
_NARROWEST = 1e-10
"""Degrees of a piece that is halved no more."""
_FEWEST = 11
"""Nodes of a piece, where its torques need less: what follows a kink needs them."""
_ROUNDS = 60
_MOST_PIECES = 20_000
_TAMEST = 12
"""Hundredfolds of the depth of the floor that are tried for a first solution."""
_STEP, _SHORTEST = 0.1, 0.998
"""Largest and smallest cut of that depth, on the way back."""
_MOST_STEPS = 60
_STANDING = 0.05
"""y − floor, over that of y = 0, that counts as standing still where the way back ends."""
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
    """y falls to its floor near an angle in degrees; enough: see `Unsettled`."""

    def __init__(self, degrees: float, enough: float | None = None) -> None:
        super().__init__(enough)
        self.degrees = degrees


class Equation(Protocol):
    """y′ = f(φ, y), per radian, with m unknowns y of about one size for each of many machines.

    eased (machines,): makes the equation tamer, from 0 on without end: the floor is lower by so much, and y moves f
    less. noise (machines,): in y it is not looked into.
    """

    unknowns: int
    noise: Array

    def known(self, pieces: Pieces) -> Array:
        """Return what depends on the angle alone at the Lobatto nodes of pieces, (…, nodes, pieces)."""
        ...

    def rate(self, known: Array, y: Array, pieces: Pieces, eased: Array) -> tuple[Array, Array]:
        """Return f (m, k, pieces) and ∂f/∂y (m, m, k, pieces) at y (m, k, pieces), where `known` is (…, k, pieces)."""
        ...

    def floor(self, known: Array, pieces: Pieces, eased: Array) -> Array:
        """Return what y must stay above, (m, k, pieces); −∞ where nothing bounds it."""
        ...

    def also(self, known: Array, y: Array, pieces: Pieces, eased: Array) -> Array:
        """Return what else must be a polynomial on every piece, (…, nodes, pieces), at y (m, nodes, pieces)."""
        ...


class Radau:
    """Radau nodes in (−1, 1], as many as the pieces have Lobatto nodes, and the matrices of a start and these nodes.

    area (k, k): values into integrals from −1 to every node; series (k + 1, k + 1): start and values into Chebyshev
    coefficients; from_lobatto (k, k): samples into values at the nodes; to_lobatto (k, k + 1): start and values back.
    """

    def __init__(self, count: int) -> None:
        # Golub: Jacobi matrix of the Legendre polynomials whose last entry puts an eigenvalue at 1
        n = np.arange(count)
        off = n[1:] / np.sqrt(4.0 * n[1:] ** 2 - 1)
        last = np.where(n == count - 1, count / (2 * count - 1), 0.0)
        nodes = np.linalg.eigvalsh(np.diag(last) + np.diag(off, 1) + np.diag(off, -1))
        self.nodes = np.append(nodes[:-1], 1.0)
        at_nodes = chebyshev(self.nodes, count + 1)
        self.area = at_nodes @ integral_of_series(count) @ np.linalg.inv(at_nodes[:, :count])
        self.places = np.append(-1.0, self.nodes)
        self.series = np.linalg.inv(chebyshev(self.places, count + 1))
        self.from_lobatto = at_nodes[:, :count] @ rule(count).series
        self.to_lobatto = chebyshev(rule(count).nodes, count + 1) @ self.series


radau = lru_cache(Radau)
"""The rule of so many nodes."""


class Periodic(NamedTuple):
    """Periodic solutions: y (m, k + 1, pieces) at the starts of the pieces and their Radau nodes.

    failed (machines,): which have none; stands: degrees where y falls to its floor, enough: how far to ease for one,
    (machines,), nan where not known.
    """

    pieces: Pieces
    y: Array
    failed: Flags
    stands: Array
    enough: Array

    @property
    def samples(self) -> Array:
        """y at the Lobatto nodes of the pieces, (m, nodes, pieces)."""
        return np.asarray(radau(len(self.pieces.rule.nodes)).to_lobatto @ self.y)

    def refuse(self) -> None:
        """Raise Standstill or Unsettled where the only machine has no solution."""
        if self.failed[0]:
            enough = None if np.isnan(self.enough[0]) else float(self.enough[0])
            raise Unsettled(enough) if np.isnan(self.stands[0]) else Standstill(float(self.stands[0]), enough)


def periodic(equation: Equation, pieces: Pieces) -> Periodic:
    """Return the solutions of y′ = f(φ, y) with the periods of the machines.

    Newton's method starts from y = 0; where that leads nowhere, from a solution of an eased equation, which is followed
    back to the given one. What a linear equation leaves open is as small as can be.
    """
    count, nodes = pieces.count, max(_FEWEST, len(pieces.rule.nodes))
    pieces = pieces.with_nodes(nodes)
    still = np.zeros((equation.unknowns, nodes + 1, len(pieces.half)))
    with np.errstate(all="ignore"):  # a step too far may overflow; it is taken back
        found, y, good = _settled(equation, pieces, still, np.zeros(count))
        if good.all():
            return Periodic(found, y, ~good, np.full(count, np.nan), np.full(count, np.nan))
        more = _followed(equation, *_of(pieces, still, ~good))
        whole, y = _put(found, y, more.pieces, more.y, ~good)
        return Periodic(whole, y, more.failed & ~good, more.stands, more.enough)


def growth(equation: Equation, found: Periodic) -> Array:
    """Return the logarithms of what is left of small disturbances after a cycle (Floquet), (machines,)."""
    pieces, none = found.pieces, np.zeros(found.pieces.count)
    chain = _Chain(equation, pieces, none)
    y = np.where(found.failed[pieces.machine], 0.0, found.y)
    stiffness = chain.half * equation.rate(chain.known, y[:, 1:], pieces, none)[1]
    if equation.unknowns == 1:  # ∮ ∂f/∂y dφ, which holds however fast a disturbance dies
        each = chain.rule.area[-1] @ stiffness[0, 0]
        return np.asarray(np.bincount(pieces.machine, each, minlength=pieces.count), dtype=float)
    gains = chain.padded(chain.answers(stiffness, np.zeros_like(y[:, 1:]))[1][-1], np.eye(equation.unknowns))
    size = np.zeros(pieces.count)
    while gains.shape[1] > 1:
        if gains.shape[1] % 2:
            unit = np.broadcast_to(np.eye(equation.unknowns), gains[:, :1].shape)
            gains = np.concatenate((gains, unit), axis=1)
        gains = gains[:, 1::2] @ gains[:, ::2]
        largest = np.maximum(np.abs(gains).max(axis=(2, 3), keepdims=True), 1e-300)
        gains, size = gains / largest, size + np.log(largest).sum(axis=(1, 2, 3))
    return np.asarray(size + np.log(np.maximum(np.abs(np.linalg.eigvals(gains[:, 0])).max(axis=-1), 5e-324)))


# some of the machines in one row


def _of(pieces: Pieces, y: Array, which: Flags) -> tuple[Pieces, Array]:
    """Return the pieces of these machines with what is known on them."""
    rows = which[pieces.machine]
    return pieces.taken(rows), y[..., rows]


def _put(pieces: Pieces, y: Array, other: Pieces, y_other: Array, which: Flags) -> tuple[Pieces, Array]:
    """Return pieces with those of these machines taken from others."""
    kept, put = _of(pieces, y, ~which), _of(other, y_other, which)
    return joined([kept[0], put[0]], [kept[1], put[1]])


def _largest(pieces: Pieces, values: Array) -> Array:
    """Return the largest of values (…, pieces) of every machine (machines,), −∞ of one that has no pieces here."""
    found = np.full(pieces.count, -np.inf)
    np.maximum.at(found, pieces.machine, values.reshape(-1, len(pieces.machine)).max(axis=0))
    return found


# Newton's method, and halving


def _settled(equation: Equation, pieces: Pieces, y: Array, eased: Array) -> tuple[Pieces, Array, Flags]:
    """Solve and refine until every piece is smooth, and return which machines have settled.

    A machine that is smooth is done with; the others go on without it.
    """
    settled, done = np.zeros(pieces.count, dtype=bool), []
    for _ in range(_ROUNDS):
        chain = _Chain(equation, pieces, eased)
        y, good = _newton(chain, y)
        rough = _rough(chain, y) & good[pieces.machine]
        many = np.bincount(pieces.machine, minlength=pieces.count) > _MOST_PIECES
        unsmooth = np.bincount(pieces.machine[rough], minlength=pieces.count) > 0
        settled |= good & ~unsmooth
        going = good & unsmooth & ~many
        done.append(_of(pieces, y, ~going))
        if not going.any():
            break
        rough, (pieces, y) = rough[going[pieces.machine]], _of(pieces, y, going)
        pieces, y = _halved(chain, pieces, y, rough)
    else:
        done.append((pieces, y))
    return (*joined([one for one, _ in done], [values for _, values in done]), settled)


def _rough(chain: _Chain, y: Array) -> Flags:
    """Return on which pieces y, or what else must be, is no polynomial yet."""
    pieces, swing = chain.pieces, []
    for one in y:
        swing.append(_largest(pieces, one) + _largest(pieces, -one))
    tails = np.abs(chain.rule.series[-2:] @ y).sum(axis=1)
    least = _TOLERANCE * np.array(swing) + 4e-15 * _largest(pieces, np.abs(y)) + chain.equation.noise
    rough = (tails > least[:, pieces.machine]).any(axis=0)
    for one in chain.equation.also(chain.sampled, chain.rule.to_lobatto @ y, pieces, chain.eased):
        rough |= np.abs(pieces.rule.series[-2:] @ one).sum(axis=0) > _TOLERANCE * _largest(pieces, one)[pieces.machine]
    return np.asarray(rough & (pieces.half > _NARROWEST / 2))


def _halved(chain: _Chain, pieces: Pieces, y: Array, rough: Flags) -> tuple[Pieces, Array]:
    """Halve the rough pieces; y on the halves comes from the polynomials, and stays above its floor."""
    halves, series = pieces.halved(rough), chain.rule.series @ y[..., rough]
    side = np.tile((-0.5, 0.5), int(rough.sum()))
    places = side + chain.rule.places[:, None] / 2
    twice = np.repeat(np.moveaxis(series, 1, 0), 2, axis=-1)[:, :, None]
    new = series_at(twice, np.broadcast_to(places, (len(y), *places.shape)))
    floor = _Chain(chain.equation, halves, chain.eased).floor
    new[:, 1:] = np.maximum(new[:, 1:], np.where(np.isfinite(floor), 0.99 * floor, floor))
    return joined([pieces.taken(~rough), halves], [y[..., ~rough], new])


class _Chain:
    """The collocation equations on a row of pieces: those inside of each, and those that join it to the next."""

    def __init__(self, equation: Equation, pieces: Pieces, eased: Array) -> None:
        self.equation, self.pieces, self.eased = equation, pieces, eased
        self.rule = radau(len(pieces.rule.nodes))
        self.half = np.radians(pieces.half)
        self.sampled = equation.known(pieces)
        self.known = self.rule.from_lobatto @ self.sampled
        self.floor = equation.floor(self.known, pieces, eased)
        begins = np.flatnonzero(np.diff(pieces.machine, prepend=-1))
        self._whose = pieces.machine[begins]
        lengths = np.diff(np.append(begins, len(pieces.machine)))
        self._row = np.repeat(np.arange(len(begins)), lengths)
        self._place = np.arange(len(pieces.machine)) - np.repeat(begins, lengths)
        self._longest = int(lengths.max())
        self.after = np.arange(1, len(pieces.machine) + 1)
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
        response, gain = self.answers(stiffness, lack)
        more = response[-1] + jump[:, self.after].T
        ends, unit = self.padded(gain[-1], np.eye(len(jump))), np.eye(len(jump))
        start = joined_around(-ends, np.broadcast_to(unit, ends.shape), self.padded(more, np.zeros(len(jump))))
        start = start[self._row, self._place]
        inside = response + (gain @ start[:, :, None])[..., 0]
        return np.asarray(np.concatenate((start[None], inside)).transpose(2, 0, 1))

    def answers(self, stiffness: Array, lack: Array) -> tuple[Array, Array]:
        """Return the changes at the nodes (k, pieces, m) that make up a lack, and those per change at the start."""
        m, k, count = lack.shape
        response, gain = np.empty((k, count, m)), np.empty((k, count, m, m))
        chunk = max(1, _AT_ONCE // (m * k) ** 2)
        unit = np.tile(np.eye(m), (k, 1))
        for start in range(0, count, chunk):
            some = np.s_[start : start + chunk]
            slopes = stiffness[..., some].transpose(3, 0, 2, 1)[:, None]
            width = len(slopes)
            systems = np.eye(m * k) - (self.rule.area[None, :, None, :, None] * slopes).reshape(width, m * k, m * k)
            sides = np.empty((width, m * k, m + 1))
            sides[..., 0] = lack[..., some].transpose(2, 1, 0).reshape(width, m * k)
            sides[..., 1:] = unit
            found = _solved(systems, sides).reshape(width, k, m, m + 1).swapaxes(0, 1)
            response[:, some], gain[:, some] = found[..., 0], found[..., 1:]
        return response, gain

    def padded(self, values: Array, rest: Array) -> Array:
        """Return what each piece has (pieces, …) as (rows of machines, longest, …), filled up with `rest` (…)."""
        found = np.empty((len(self._whose), self._longest, *rest.shape))
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


def joined_around(before: Array, after: Array, sides: Array) -> Array:
    """Return x (n, k, m) with before_i x_i + after_i x_{i+1} = sides_i, x_k being x_0; matrices (n, k, m, m).

    Every second x is eliminated by rotations, which do not mind whether a solution grows or dies on its way, until one
    is left. What the equations leave open there is taken as small as can be. Of what is not finite it is not a number.
    """
    finite = np.asarray(np.isfinite(before).all(axis=(1, 2, 3)) & np.isfinite(sides).all(axis=(1, 2)))
    found = _eliminated(
        *(np.where(finite.reshape(-1, *(1,) * (one.ndim - 1)), one, 0) for one in (before, after, sides))
    )
    return np.where(finite[:, None, None], found, np.nan)


def _eliminated(before: Array, after: Array, sides: Array) -> Array:
    count, size = sides.shape[1:]
    if count == 1:
        whole = before[:, 0] + after[:, 0]
        return np.asarray(np.linalg.pinv(whole, rcond=_OPEN) @ sides[:, 0, :, None])[:, None, :, 0]
    even, odd = np.s_[:, 0 : count - 1 : 2], np.s_[:, 1:count:2]
    turn, upper = np.linalg.qr(np.concatenate((after[even], before[odd]), axis=2), mode="complete")
    rows = np.zeros((*turn.shape[:2], 2 * size, 2 * size + 1))
    rows[:, :, :size, :size], rows[:, :, :size, -1] = before[even], sides[even]
    rows[:, :, size:, size:-1], rows[:, :, size:, -1] = after[odd], sides[odd]
    rows = np.swapaxes(turn, 2, 3) @ rows
    parts = rows[:, :, size:, :size], rows[:, :, size:, size:-1], rows[:, :, size:, -1]
    left = [
        np.concatenate((part, one[:, 2 * part.shape[1] :]), axis=1) for part, one in zip(parts, (before, after, sides))
    ]
    found = np.empty_like(sides)
    found[:, ::2] = _eliminated(*left)
    following = np.roll(found[:, ::2], -1, axis=1)[:, : turn.shape[1]]
    ends = np.concatenate((found[even], following), axis=2)
    rest = rows[:, :, :size, -1:] - rows[:, :, :size, :-1] @ ends[..., None]
    found[odd] = _solved(upper[:, :, :size].reshape(-1, size, size), rest.reshape(-1, size, 1)).reshape(
        found[odd].shape
    )
    return found


def _newton(chain: _Chain, y: Array) -> tuple[Array, Flags]:
    """Solve the collocation equations by Newton's method, and return which machines have settled.

    A machine that has settled, or fails, stays as it is. Steps are halved until less is lacking.
    """
    pieces, of = chain.pieces, chain.pieces.machine
    going = np.zeros(pieces.count, dtype=bool)
    going[of] = True
    good, previous = np.zeros_like(going), np.full(pieces.count, np.inf)
    least = np.maximum(_largest(pieces, np.where(np.isfinite(chain.floor), -chain.floor, 0.0)), 0.0)
    lacking = chain.lacking(y)
    for _ in range(100):
        now = chain.size(*lacking[:2])
        going &= np.isfinite(now)
        if not going.any():
            break
        step = chain.step(*lacking)
        size = _largest(pieces, np.abs(step))
        going &= np.isfinite(size)
        step[..., ~going[of]] = 0.0
        ahead = y + step
        swing = np.max([_largest(pieces, one) + _largest(pieces, -one) for one in ahead], axis=0)
        # high above its floor y is moved as a whole by rounding, though by nothing beside that height
        near = np.maximum(1e-9 * swing, 1e-14 * least)
        fall = -step[:, 1:] / (0.9 * (y[:, 1:] - chain.floor))
        share = 1 / np.maximum(_largest(pieces, fall), 1.0)
        y, lacking, after, share = _damped(chain, y, step, share, going & (size > near), now)
        # the next step makes up what is still lacking: for a linear equation only rounding
        left = np.where(now > 0, size * after / now, 0.0)
        small = (size <= 1e-6 * near) | (left <= 1e-5 * near) | ((size <= near) & (size >= previous / 4))
        good |= going & (share == 1) & small
        going &= ~good & (share > 1e-6)
        previous = np.where(share == 1, size, np.inf)
    return y, good


def _damped(
    chain: _Chain, y: Array, step: Array, share: Array, halving: Flags, now: Array
) -> tuple[Array, tuple[Array, Array, Array], Array, Array]:
    """Return y after a share of the step, what is then lacking, its size, and the share.

    Of these machines it is halved until less is lacking than now.
    """
    of = chain.pieces.machine
    while True:
        new = y + share[of] * step
        lacking = chain.lacking(new)
        after = chain.size(*lacking[:2])
        poor = halving & ~(after <= (1 - share / 8) * now) & (share > 1e-6)
        if not poor.any():
            return new, lacking, after, share
        share = np.where(poor, share / 2, share)


# from an eased equation back to the given one


def _followed(equation: Equation, pieces: Pieces, y: Array) -> Periodic:
    """Follow the solutions of these machines from a deep floor up to that of the equation."""
    none = np.zeros(pieces.count)
    here = np.zeros(pieces.count, dtype=bool)
    here[pieces.machine] = True
    own = np.where(here, -_largest(pieces, _Chain(equation, pieces, none).floor), 0.0)
    running = here & np.isfinite(own)
    depth, tame = np.full(pieces.count, np.nan), running.copy()
    first = pieces, y
    for hundredfolds in range(1, _TAMEST + 1):
        if not tame.any():
            break
        deep = own * 100.0**hundredfolds
        finer, values, good = _settled(equation, *_of(*first, tame), np.where(tame, deep - own, 0.0))
        pieces, y = _put(pieces, y, finer, values, good)
        depth, tame = np.where(good, deep, depth), tame & ~good
    running &= np.isfinite(depth)
    factor = np.full(pieces.count, _STEP)
    for _ in range(_MOST_STEPS):
        running &= (depth > own) & (factor <= _SHORTEST)
        if not running.any():
            break
        nearer = np.maximum(depth * factor, own)
        finer, values, good = _settled(equation, *_of(pieces, y, running), np.where(running, nearer - own, 0.0))
        pieces, y = _put(pieces, y, finer, values, good)
        depth = np.where(good, nearer, depth)
        factor = np.where(good, np.maximum(factor**1.5, _STEP), np.where(running, np.sqrt(factor), factor))
    failed = here & ~(depth <= own)
    return Periodic(pieces, y, failed, *_ends(equation, pieces, y, np.where(failed, depth - own, np.nan)))


def _ends(equation: Equation, pieces: Pieces, y: Array, eased: Array) -> tuple[Array, Array]:
    """Return where machines stand still whose way back ends so far from their equations, and that distance."""
    stands = np.full(pieces.count, np.nan)
    chain = _Chain(equation, pieces, np.nan_to_num(eased))
    share = (1 - y[:, 1:] / chain.floor).min(axis=0)
    for machine in np.flatnonzero(np.isfinite(eased)):
        rows = pieces.machine == machine
        if share[:, rows].min() <= _STANDING:
            degrees = pieces.low[rows] + pieces.half[rows] * (1 + chain.rule.nodes[:, None])
            stands[machine] = degrees.T.ravel()[np.argmin(share[:, rows].T)]
    return stands, eased
