"""Periodic solutions of y′ = f(φ, y) by collocation: Radau nodes on the pieces of the cycles of many machines at once.

Radau IIA is L-stable: what relaxes within a hair of a turn is damped out, where Gauss or trapezium rules would ring.
The whole cycle is solved at once, so that it does not matter how many turns a marching method would need to settle.
Every machine takes its own share of Newton's step and is done by itself; pieces on which its solution is no polynomial
yet are halved.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property, lru_cache
from typing import NamedTuple, Protocol, TypeVar

import numpy as np

from kurbel.arrays import Array, ComplexArray, Flags
from kurbel.numerics.lobatto import chebyshev, integral_of_series, rule
from kurbel.numerics.pieces import TAIL, Pieces, joined_pieces

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
"""Share of the kinetic energy at y = 0 below which the body is at rest at the end of its return."""
_AT_ONCE = 4_000_000
"""Numbers of the matrices of the pieces that are solved together."""
_CONSTANT = 1e-13
"""Of the largest eigenvalue of a matrix: one that is smaller is zero but for rounding."""
_OPEN = 1e-11
"""A singular value that is smaller leaves a direction open: that of rounding is 1e-13."""


R = TypeVar("R", Array, ComplexArray)
"""Rows of numbers, real or complex."""


class Unsettled(Exception):
    """No solution is found.

    enough: how far to ease the equation for one, in the unit of y, or None if not known; degrees: the angle near which
    the machine stops, or None where it does not come to a stop.
    """

    def __init__(self, enough: float | None = None, degrees: float | None = None) -> None:
        super().__init__("no periodic solution found")
        self.enough, self.degrees = enough, degrees


class Modal(NamedTuple):
    """The modes of a real matrix A (m, m), of each conjugate pair one: A = Re columns · diag(eigenvalues) · rows.

    eigenvalues (q,), per radian; columns (m, q); rows (q, m). What the modes have is z = rows · y, y = Re columns · z.
    """

    eigenvalues: ComplexArray
    columns: ComplexArray
    rows: ComplexArray

    @classmethod
    def of(cls, matrix: Array, sizes: Array) -> Modal:
        """Return those of a matrix; sizes (m,): of the unknowns in which it is nearly skew, and its modes orthogonal.

        Raises LinAlgError where it has not enough of them.
        """
        eigenvalues, vectors = np.linalg.eig(matrix * sizes / sizes[:, None])
        columns = np.asarray(sizes[:, None] * vectors, dtype=complex)
        rows = np.asarray(np.linalg.inv(vectors) / sizes, dtype=complex)
        # of a pair with z and its conjugate the real part of one counts twice
        is_upper = eigenvalues.imag >= 0
        pairs = np.where(eigenvalues.imag > 0, 2.0, 1.0)
        # what neither swings nor decays, such as rotation, is exactly constant
        is_constant = np.abs(eigenvalues) <= _CONSTANT * np.abs(eigenvalues).max()
        kept = np.asarray(eigenvalues, dtype=complex)
        kept[is_constant] = 0.0
        counted = np.asarray(columns * pairs, dtype=complex)
        return cls(kept[is_upper], counted[:, is_upper], rows[is_upper])


class Equation(Protocol):
    """y′ = f(φ, y), per radian, with m unknowns y of about one size for each of many machines.

    bounded: the unknown that must stay above −height; the equation is the tamer the larger the height. None where
    nothing bounds one. noise (machines,): smaller parts of y are not refined. modal: the modes of ∂f/∂y at y = 0, of
    one machine whose ∂f/∂y hardly varies; None where each piece is solved for all unknowns together.
    """

    unknowns: int
    bounded: int | None
    noise: Array

    @property
    def modal(self) -> Modal | None:
        """The modes, or None."""
        ...

    def known(self, pieces: Pieces) -> Array:
        """Return what depends on the angle alone at the Lobatto nodes, (q, nodes, pieces), the height last."""
        ...

    def rate(self, known: Array, y: Array, pieces: Pieces) -> tuple[Array, Array | None]:
        """Return f (m, k, pieces) and ∂f/∂y (m, m, k, pieces) at y (m, k, pieces), where `known` is (q, k, pieces).

        The second is not needed, and may be None, where the modes of the equation are known.
        """
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
        beside_diagonal = n[1:] / np.sqrt(4.0 * n[1:] ** 2 - 1)
        diagonal = np.where(n == count - 1, count / (2 * count - 1), 0.0)
        jacobi = np.diag(diagonal) + np.diag(beside_diagonal, 1) + np.diag(beside_diagonal, -1)
        self.nodes = np.append(np.linalg.eigvalsh(jacobi)[:-1], 1.0)

        # values at the nodes alone
        at_nodes = chebyshev(self.nodes, count + 1)
        self.area = at_nodes @ integral_of_series(count) @ np.linalg.inv(at_nodes[:, :count])
        self.from_lobatto = at_nodes[:, :count] @ rule(count).series

        # the start and the values at the nodes
        positions = np.append(-1.0, self.nodes)
        self.series = np.linalg.inv(chebyshev(positions, count + 1))
        of_halves = np.concatenate((positions - 1, positions + 1)) / 2
        self.halving = chebyshev(of_halves, count + 1) @ self.series
        self.to_lobatto = chebyshev(rule(count).nodes, count + 1) @ self.series

    @cached_property
    def modes(self) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
        """The eigenvalues of `area` (k,), the vectors in columns (k, k), and the inverse of these."""
        eigenvalues, vectors = np.linalg.eig(self.area)
        return eigenvalues, vectors, np.linalg.inv(vectors)


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
        return radau(len(self.pieces.rule.nodes)).to_lobatto @ y

    def refuse(self) -> None:
        """Raise Unsettled where the only machine has no solution."""
        if not self.failed[0]:
            return
        if np.isnan(self.short[0]):
            raise Unsettled
        # the share of the height that is left at every node, in order of the angle
        system = _System(self.equation, self.pieces, self.short)
        share = (1 + self.y[self.equation.bounded, 1:] / system.height).T
        is_at_rest = share.min() <= _STANDING
        if not is_at_rest:
            raise Unsettled(float(self.short[0]))
        degrees = (self.pieces.low + self.pieces.half * (1 + system.rule.nodes[:, None])).T
        raise Unsettled(float(self.short[0]), float(degrees.ravel()[np.argmin(share)]))

    @property
    def growth(self) -> Array:
        """Logarithms of what is left of small disturbances after a cycle (Floquet), (machines,)."""
        # what each piece makes of a disturbance at its start
        y = np.where(self.pieces.of(self.failed), 0.0, self.y)
        system = _System(self.equation, self.pieces, np.zeros(self.pieces.count))
        _, lack, stiffness = system.lacking(y)
        assert stiffness is not None
        _, gains = system.inside(lack, stiffness)
        unit = np.eye(len(y))
        padded_gains = system.padded(gains[-1], unit)

        # their product over the cycle, with its size apart so that nothing overflows
        size = np.zeros(self.pieces.count)
        product = np.broadcast_to(unit, (len(size), *unit.shape))
        for gain in np.swapaxes(padded_gains, 0, 1):
            product = gain @ product
            largest = np.maximum(np.abs(product).max(axis=(1, 2)), 1e-300)
            product = product / largest[:, None, None]
            size = size + np.log(largest)
        multipliers = np.abs(np.linalg.eigvals(product)).max(axis=-1)
        return size + np.log(np.maximum(multipliers, 5e-324))


def periodic(equation: Equation, pieces: Pieces) -> Periodic:
    """Return the solutions of y′ = f(φ, y) with the periods of the machines.

    Newton's method starts from y = 0; where that leads nowhere, from the solution with an endless height, which is
    followed down to the given one. What a linear equation leaves open is as small as can be.
    """
    pieces = replace(pieces, rule=rule(max(_FEWEST, len(pieces.rule.nodes))))
    not_eased = np.zeros(pieces.count)
    start = np.zeros((equation.unknowns, len(pieces.rule.nodes) + 1, len(pieces.half)))
    still = _Solution(pieces, start)
    with np.errstate(all="ignore"):  # a step too far may overflow; it is taken back
        solution, is_settled = _settled(equation, still, not_eased)
        if is_settled.all() or equation.bounded is None:
            return Periodic(equation, *solution, ~is_settled, np.full(pieces.count, np.nan))

        # the other machines start again from y = 0, with an endless height
        heights = _System(equation, pieces, not_eased).height
        least_height = np.maximum(_largest(pieces, heights), 0.0)
        solution = _joined([solution.of(is_settled), still.of(~is_settled)])
        is_running = ~is_settled & np.isfinite(least_height) & (least_height > 0)
        height = np.where(is_settled, least_height, np.nan)
        target = least_height * _ENDLESS
        share = np.full_like(least_height, _STEP)
        for _ in range(_MOST_STEPS):
            is_running = is_running & ~(height <= least_height) & (share <= _SHORTEST)
            if not is_running.any():
                break
            # solve at the lower height; where that fails, keep the solution and cut the height by less
            eased = np.where(is_running, target - least_height, 0.0)
            lower, is_solved = _settled(equation, solution.of(is_running), eased)
            solution = _joined([solution.of(~is_solved), lower.of(is_solved)])
            height = np.where(is_solved, target, height)
            smaller_cut = np.where(is_running, np.sqrt(share), share)
            larger_cut = np.maximum(share**1.5, _STEP)
            share = np.where(is_solved, larger_cut, smaller_cut)
            target = np.maximum(height * share, least_height)
    has_failed = ~(height <= least_height)
    return Periodic(equation, *solution, has_failed, height - least_height)


def followed(equation: Equation, start: Periodic, changed: Flags) -> Periodic:
    """Return the solutions of an equation that has changed a little for some machines; the others keep theirs.

    equation: without a bound; start: the solutions before; changed: (machines,).
    """
    is_followed = changed & ~start.failed
    if not is_followed.any():
        return start
    begun = _Solution(start.pieces, start.y)
    with np.errstate(all="ignore"):
        ahead, is_settled = _settled(equation, begun.of(is_followed), np.zeros(len(changed)))
    solution = _joined([begun.of(~is_followed), ahead])
    has_failed = np.where(is_followed, ~is_settled, start.failed)
    return Periodic(equation, *solution, has_failed, start.short)


class _Solution(NamedTuple):
    """What is known of the unknowns on a row of pieces, (m, k + 1, pieces)."""

    pieces: Pieces
    y: Array

    def of(self, machines: Flags) -> _Solution:
        """Return that of these machines."""
        rows = machines[self.pieces.machine]
        return _Solution(self.pieces.taken(rows), self.y[..., rows])


def _joined(parts: Sequence[_Solution]) -> _Solution:
    """Return solutions on different pieces as one."""
    taken = [(part.pieces, np.arange(len(part.pieces.half)), [part.y]) for part in parts]
    pieces, (y,) = joined_pieces(taken)
    return _Solution(pieces, y)


def _largest(pieces: Pieces, values: Array) -> Array:
    """Return the largest of values (…, pieces) of every machine (machines,), −∞ of one that has no pieces here."""
    of_piece = values.reshape(-1, len(pieces.machine)).max(axis=0)
    largest = np.full(pieces.count, -np.inf)
    np.maximum.at(largest, pieces.machine, of_piece)
    return largest


def _swing(pieces: Pieces, y: Array) -> Array:
    """Return the range of each unknown (m, …, pieces) in every machine, (m, machines)."""
    return np.array([_largest(pieces, unknown) + _largest(pieces, -unknown) for unknown in y])


def _settled(equation: Equation, left: _Solution, eased: Array) -> tuple[_Solution, Flags]:
    """Solve, and halve pieces until y is a polynomial on every one; return which machines have settled.

    A machine that is smooth is done with; the others go on without it.
    """
    count = left.pieces.count
    settled = np.zeros(count, dtype=bool)
    done = []
    for _ in range(_ROUNDS):
        pieces = left.pieces
        machine = pieces.machine
        system = _System(equation, pieces, eased)
        y, is_solved = system.solved(left.y)

        # pieces are rough on which the last two coefficients are more than rounding and noise
        tails = np.abs(system.rule.series[-2:] @ y).sum(axis=1)
        rounding = TAIL * _swing(pieces, y) + 4e-15 * _largest(pieces, np.abs(y))
        least = rounding + equation.noise
        is_rough = (tails > least[:, machine]).any(axis=0) & (pieces.half > _NARROWEST / 2)
        is_rough &= is_solved[machine]
        has_rough = np.bincount(machine[is_rough], minlength=count) > 0
        settled |= is_solved & ~has_rough

        # machines that have any go on, if they have not too many pieces
        goes_on = has_rough & (np.bincount(machine, minlength=count) <= _MOST_PIECES)
        is_rough = is_rough[goes_on[machine]]
        done.append(_Solution(pieces, y).of(~goes_on))
        left = _Solution(pieces, y).of(goes_on)
        if not len(is_rough):
            break

        # halve the rough pieces
        halves = left.pieces.halved(is_rough)
        m, nodes, _ = y.shape
        fine = (system.rule.halving @ left.y[..., is_rough]).reshape(m, 2, nodes, -1)
        fine = fine.transpose(0, 2, 3, 1).reshape(m, nodes, -1)
        if equation.bounded is not None:  # a polynomial may fall below the bound between its nodes
            bounded = fine[equation.bounded, 1:]
            height = _System(equation, halves, eased).height
            np.maximum(bounded, -0.99 * height, out=bounded)
        smooth = _Solution(left.pieces.taken(~is_rough), left.y[..., ~is_rough])
        left = _joined([smooth, _Solution(halves, fine)])
    else:
        done.append(left)
    return _joined(done), settled


class _System:
    """The collocation equations on a row of pieces: those inside of each, and those that join it to the next.

    eased (machines,): is added to the height.
    """

    def __init__(self, equation: Equation, pieces: Pieces, eased: Array) -> None:
        self.equation = equation
        self.pieces = pieces
        self.rule = radau(len(pieces.rule.nodes))
        self.half = np.radians(pieces.half)
        # what depends on the angle alone, with the height last
        self.known = self.rule.from_lobatto @ equation.known(pieces)
        self.known[-1] += pieces.of(eased)
        self.height = self.known[-1]
        # machine by machine: which row it is, the number of each piece in it, and the piece after each
        _, self._row, lengths = np.unique(pieces.machine, return_inverse=True, return_counts=True)
        starts = np.cumsum(lengths) - lengths
        self._number = np.arange(len(self._row)) - starts[self._row]
        self._shape = len(lengths), int(lengths.max(initial=0))
        self.after = np.arange(1, len(self._row) + 1)
        self.after[starts + lengths - 1] = starts

    def lacking(self, y: Array) -> tuple[Array, Array, Array | None]:
        """Return what the equations lack at starts (m, pieces) and nodes (m, k, pieces), and half ∂f/∂y there, if given.

        At the start of a piece that is what the end before it has more, at its nodes what the rate makes of the start.
        """
        start = y[:, 0]
        rate, slope = self.equation.rate(self.known, y[:, 1:], self.pieces)
        jump = np.empty_like(start)
        jump[:, self.after] = y[:, -1] - start[:, self.after]
        lack = y[:, :1] + self.half * (self.rule.area @ rate) - y[:, 1:]
        stiffness = None if slope is None else self.half * slope
        return jump, lack, stiffness

    def inside(self, lack: Array, stiffness: Array) -> tuple[Array, Array]:
        """Return the changes at the nodes (k, pieces, m) that make up a lack, and those per change at the start."""
        m, k, count = lack.shape
        changes = np.empty((k, count, m, m + 1))
        at_once = max(1, _AT_ONCE // (m * k) ** 2)
        minus_area = -self.rule.area[:, None, :, None]
        for first in range(0, count, at_once):
            chunk = np.s_[first : first + at_once]
            # (1 − half · area · ∂f/∂y) of every piece, over all its nodes and unknowns
            slopes = np.ascontiguousarray(stiffness[..., chunk].transpose(3, 0, 2, 1))
            entries = (minus_area * slopes[:, None]).reshape(-1, (m * k) ** 2)
            entries[:, :: m * k + 1] += 1.0
            systems = entries.reshape(-1, m * k, m * k)
            # right sides: the lack, and a unit change of each unknown at the start
            sides = np.empty((len(systems), k, m, m + 1))
            sides[..., 0] = lack[..., chunk].transpose(2, 1, 0)
            sides[..., 1:] = np.eye(m)
            columns = sides.reshape(-1, m * k, m + 1)
            try:
                solved = np.linalg.solve(systems, columns)
            except np.linalg.LinAlgError:
                # a system is exactly singular: its step becomes too long, and is taken back
                solved = np.linalg.solve(systems + 1e-14 * np.eye(m * k), columns)
            changes[:, chunk] = solved.reshape(sides.shape).swapaxes(0, 1)
        return changes[..., 0], changes[..., 1:]

    def padded(self, values: Array, rest: Array) -> Array:
        """Return what each piece has (pieces, …) as (rows of machines, longest, …), filled up with `rest` (…)."""
        rows = np.empty((*self._shape, *rest.shape))
        rows[:] = rest
        rows[self._row, self._number] = values
        return rows

    def solved(self, y: Array) -> tuple[Array, Flags]:
        """Solve the collocation equations by Newton's method, and return which machines have settled.

        A machine that has settled, or fails, stays as it is. Steps are halved until less is lacking.
        """
        pieces = self.pieces
        machine = pieces.machine
        bounded = self.equation.bounded
        is_running = np.bincount(machine, minlength=pieces.count) > 0
        is_settled = np.zeros_like(is_running)
        previous = np.full(pieces.count, np.inf)
        highest = 0.0 if bounded is None else _largest(pieces, self.height)

        lacking = self.lacking(y)
        for _ in range(100):
            now = self._size_of_lack(lacking)
            is_running &= np.isfinite(now)
            if not is_running.any():
                break
            step = self._newton_step(y, lacking)
            size = _largest(pieces, np.abs(step))
            is_running &= np.isfinite(size)
            step[..., ~is_running[machine]] = 0.0

            # far above its bound, or where it hardly varies, y is moved as a whole by rounding, though by nothing
            # relative to its size
            largest = np.maximum(highest, _largest(pieces, np.abs(y + step)))
            near = np.maximum(1e-9 * _swing(pieces, y + step).max(axis=0), 1e-14 * largest)
            # not beyond 9/10 of the way to the bound
            share = np.ones(pieces.count)
            if bounded is not None:
                room = 0.9 * (y[bounded, 1:] + self.height)
                share /= np.maximum(_largest(pieces, -step[bounded, 1:] / room), 1.0)
            # halved until less is lacking
            while True:
                new = y + share[machine] * step
                lacking = self.lacking(new)
                after = self._size_of_lack(lacking)
                is_better = after <= (1 - share / 8) * now
                is_poor = is_running & (size > near) & ~is_better & (share > 1e-6)
                if not is_poor.any():
                    break
                share = np.where(is_poor, share / 2, share)
            y = new

            # the next step makes up what is still lacking: for a linear equation only rounding
            left = np.where(now > 0, size * after / now, 0.0)
            is_tiny = (size <= 1e-6 * near) | (left <= 1e-5 * near)
            stays_small = (size <= near) & (size >= previous / 4)
            is_settled |= is_running & (share == 1) & (is_tiny | stays_small)
            is_running &= ~is_settled & (share > 1e-6)
            previous = np.where(share == 1, size, np.inf)
        return y, is_settled

    def _size_of_lack(self, lacking: tuple[Array, Array, Array | None]) -> Array:
        """Return the root of the sum of the squares of what the equations of every machine lack, (machines,)."""
        jump, lack, _ = lacking
        squares = np.square(jump).sum(axis=0) + np.square(lack).sum(axis=(0, 1))
        return np.sqrt(np.bincount(self.pieces.machine, squares, minlength=self.pieces.count))

    def _newton_step(self, y: Array, lacking: tuple[Array, Array, Array | None]) -> Array:
        """Return Newton's step of y, (m, k + 1, pieces)."""
        jump, lack, stiffness = lacking
        if self.equation.modal:
            return self._modal_step(self.equation.modal, jump, lack)
        assert stiffness is not None
        # in a piece step = response + gain · step at its start; its last node starts the next piece
        response, gain = self.inside(lack, stiffness)
        more = self.padded(response[-1] + jump[:, self.after].T, np.zeros(len(y)))
        gains = self.padded(gain[-1], np.eye(len(y)))
        start = around_the_cycle(gains, more)[self._row, self._number]
        nodes = response + (gain @ start[:, :, None])[..., 0]
        return np.concatenate((start[None], nodes)).transpose(2, 0, 1)

    def _modal_step(self, modal: Modal, jump: Array, lack: Array) -> Array:
        """Return Newton's step with ∂f/∂y at y = 0, mode by mode; each is an equation of one unknown."""
        # (1 − half λ area)⁻¹ of a mode and a piece, in the eigenvectors of the area
        areas, vectors, inverse = self.rule.modes
        shares = np.multiply.outer(np.multiply.outer(modal.eigenvalues, areas), self.half)
        resolvent = 1 / (1 - shares)
        lack_of_modes = (modal.rows @ lack.reshape(len(lack), -1)).reshape(shares.shape)
        response = vectors @ (resolvent * (inverse @ lack_of_modes))
        gain = vectors @ (resolvent * inverse.sum(axis=1)[:, None])

        # the starts, each mode as a machine of its own
        more = response[:, -1] + (modal.rows @ jump)[:, self.after]
        start = around_the_cycle(gain[:, -1, :, None, None], more[:, :, None])[..., 0]
        nodes = response + gain * start[:, None]
        changes = np.concatenate((start[:, None], nodes), axis=1)
        step = (modal.columns @ changes.reshape(len(changes), -1)).real
        return step.reshape(len(lack), *changes.shape[1:])


def around_the_cycle(gain: R, more: R) -> R:
    """Return x (n, k, m) with x_{i+1} = gain_i x_i + more_i, x_k being x_0; gain (n, k, m, m), more (n, k, m).

    A single unknown that grows along the cycle is followed backward, where it decays. What the equations leave open is
    taken as small as can be. Of what is not finite it is not a number.
    """
    has_finite_gain = np.isfinite(gain).all(axis=(1, 2, 3))
    has_finite_more = np.isfinite(more).all(axis=(1, 2))
    is_finite = np.asarray(has_finite_gain & has_finite_more)[:, None, None]
    gain = np.where(is_finite[..., None], gain, 0.0)
    more = np.where(is_finite, more, 0.0)
    # backward: x_i = (x_{i+1} − more_i)/gain_i
    grows = np.zeros(())
    if more.shape[2] == 1:
        logarithms = np.log(np.maximum(np.abs(gain), 1e-300))
        grows = (logarithms.sum(axis=(1, 2, 3)) > 0)[:, None, None]
        inverse = 1 / np.where(grows[..., None], gain[:, ::-1], 1.0)
        gain = np.where(grows[..., None], inverse, gain)
        more = np.where(grows, -more[:, ::-1] * inverse[..., 0], more)
    forward = _paired(gain, more)
    backward = np.roll(forward[:, ::-1], 1, axis=1)
    return np.where(is_finite, np.where(grows, backward, forward), np.nan)


def _paired(gain: R, more: R) -> R:
    """Return the same, forward: pieces are joined in pairs until one is left, whose start is its end."""
    count, size = more.shape[1:]
    if count == 1:
        closed = np.linalg.pinv(np.eye(size) - gain[:, 0], rcond=_OPEN)
        return (closed @ more[:, 0, :, None])[:, None, :, 0]
    if count % 2:  # a piece on which nothing changes
        unit = np.broadcast_to(np.eye(size), gain[:, :1].shape)
        gain = np.concatenate((gain, unit), axis=1)
        more = np.concatenate((more, 0 * more[:, :1]), axis=1)
    first_gain = gain[:, ::2]
    second_gain = gain[:, 1::2]
    first_more = more[:, ::2]
    second_more = more[:, 1::2]
    pair_more = (second_gain @ first_more[..., None])[..., 0] + second_more
    starts = _paired(second_gain @ first_gain, pair_more)
    middles = (first_gain @ starts[..., None])[..., 0] + first_more
    return np.stack((starts, middles), axis=2).reshape(more.shape)[:, :count]
