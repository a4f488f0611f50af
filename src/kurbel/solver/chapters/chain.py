"""A shaft line as masses joined by shaft segments: natural vibrations, response to torques, periodic motion.

          k₀, d₀        k₁, d₁                    T_i = k_i (θ_i − θ_{i+1}) + d_i (θ̇_i − θ̇_{i+1})
    J₀ ═══════════ J₁ ═══════════ J₂              J_i θ̈_i = M_i − c_i θ̇_i + T_{i−1} − T_i
    │      T₀      │      T₁      │
    c₀             c₁             c₂              θ: vibration about uniform rotation, all referred to one shaft

A segment carries the torque T from the mass before it to the mass behind it; at a fixed end one of these is the ground.
The masses are a row or, with branches, a tree. A segment may have an inertia J_s of its own, uniform along it; at the
share x of its length, between the angles θ₁ and θ₂ of its ends, it carries

    T(x) = k (θ₁ cos α(1 − x) − θ₂ cos αx)/sinc α        α = ω √(J_s/k),  sinc α = sin α/α

which is exact at every frequency, and without inertia (α = 0) the torque of a spring.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from typing import Any, NamedTuple, TypeVar

import numpy as np

from kurbel.arrays import Array, ComplexArray, Indices
from kurbel.machine.shaft_line import GROUNDED, ShaftLine
from kurbel.numerics.collocation import Modal
from kurbel.numerics.pieces import Pieces
from kurbel.solver.speed import SpeedLaw

Q = TypeVar("Q", Array, ComplexArray)
"""Quotients, real or complex."""
_NOTHING = 1e-40
"""In place of a quotient of Holzer's table that is exactly zero: there a mass is at rest."""
_AT_REST = 1e-6
"""A first mass that moves less than this, over the largest motion, is not what the others are referred to."""
_ROUNDING = 1e-12
"""Of the largest motion: less than this is none in a line with branches, of which a whole part may be at rest."""
_LAST_PLACES = 1e-15
"""Of the highest natural frequency: by how much one that is guessed by singular values is uncertain."""
_SHARES = np.linspace(0, 1, 17)[:, None]
"""Where an interval that holds a natural frequency is cut into parts."""
_LEAST_GUESS = 1e-9
"""Of the highest natural frequency: what an eigenvalue solver finds below it is rounding."""


def row_of_joins(masses: int, ground: str = "") -> tuple[tuple[int, int], ...]:
    """Return the ends of the segments of a row of masses, held `before` or `after` it, at `both` ends, or free.

    >>> row_of_joins(2, "after")
    ((0, 1), (1, -1))
    """
    before = ((GROUNDED, 0),) if ground in ("before", "both") else ()
    after = ((masses - 1, GROUNDED),) if ground in ("after", "both") else ()
    return (*before, *((mass, mass + 1) for mass in range(masses - 1)), *after)


@dataclass(frozen=True, eq=False)
class Chain:
    """n masses and the segments that join them; joins: of each segment the mass before and behind it, or GROUNDED.

    inertias in kg m² (n,), stiffnesses in N m/rad; segment_damping, mass_damping in N m s/rad, of a twist and against
    uniform rotation; loss: loss factors η of the segments, with k (1 + iη); segment_inertias: J_s in kg m².
    """

    inertias: Array
    stiffnesses: Array
    segment_damping: Array
    mass_damping: Array
    loss: Array
    joins: tuple[tuple[int, int], ...]
    segment_inertias: Array

    @classmethod
    def of(cls, line: ShaftLine, inertias: Sequence[float]) -> Chain:
        """Return the chain of a shaft line; inertias: those of its masses in kg m², with all that turns there."""
        return cls(
            inertias=np.array(inertias),
            stiffnesses=np.array([segment.stiffness for segment in line.segments]),
            segment_damping=np.array([segment.damping for segment in line.segments]),
            mass_damping=np.array([mass.damping for mass in line.masses]),
            loss=np.array([segment.loss_factor for segment in line.segments]),
            joins=tuple((segment.before, segment.behind) for segment in line.segments),
            segment_inertias=np.array([segment.inertia for segment in line.segments]),
        )

    @cached_property
    def ends(self) -> tuple[Array, Array]:
        """The matrices (segments, n) that take from the angles of the masses those before and behind the segments."""
        before, behind = np.zeros((2, len(self.joins), len(self.inertias)))
        for segment, (mass, other) in enumerate(self.joins):
            if mass != GROUNDED:
                before[segment, mass] = 1.0
            if other != GROUNDED:
                behind[segment, other] = 1.0
        return before, behind

    @cached_property
    def twists(self) -> Array:
        """The matrix (segments, n) that turns angles of the masses into twists, that before less that behind."""
        before, behind = self.ends
        return before - behind

    @property
    def fixed_segments(self) -> list[int]:
        """The segments to a fixed end."""
        return [segment for segment, join in enumerate(self.joins) if GROUNDED in join]

    @property
    def is_held(self) -> bool:
        """Whether an end is fixed."""
        return bool(self.fixed_segments)

    @cached_property
    def has_branches(self) -> bool:
        """Whether more than two segments begin or end at a mass."""
        ends = Counter(chain.from_iterable(self.joins))
        del ends[GROUNDED]
        return max(ends.values(), default=0) > 2

    @property
    def lumped(self) -> Array:
        """The inertias of the masses, each with half of those of its segments, in kg m² (n,)."""
        return self.inertias + np.abs(self.twists).T @ self.segment_inertias / 2

    def springs(self, frequencies: Array) -> ComplexArray:
        """Return k (1 + iη) + iΩ d of the segments at angular frequencies Ω (…) in rad/s, (segments, …)."""
        still = (self.stiffnesses * (1 + 1j * self.loss)).reshape(-1, *(1,) * frequencies.ndim)
        return still + 1j * np.multiply.outer(self.segment_damping, frequencies)

    def waves(self, frequencies: Array, springs: Any) -> Any:
        """Return α = Ω √(J_s/k) of the segments with these springs k at angular frequencies Ω (…), (segments, …)."""
        inertias = self.segment_inertias.reshape(-1, *(1,) * frequencies.ndim)
        return frequencies * np.sqrt(inertias / springs)


def sinc(alpha: Any) -> Any:
    """Return sin α/α, 1 for 0; real or complex arrays."""
    divisor = np.where(alpha == 0, 1.0, alpha)
    return np.where(alpha == 0, 1.0, np.sin(alpha) / divisor)


# response to torques of one frequency


def response(
    chain: Chain, frequencies: Array, torques: ComplexArray, load_damping: Array | float = 0.0
) -> ComplexArray:
    """Return the complex amplitudes in rad (n, …) under torques (n, …) in N m at angular frequencies Ω (…) in rad/s.

    (K (1 + iη) + iΩ C − Ω² J) θ = M; load_damping: of the masses in addition to their own, (n, …) in N m s/rad. A
    segment with inertia is a spring k/sinc α with the inertia (J_s/2) sinc(α/2)/cos(α/2) at each end. A resonance that
    nothing damps has no answer: it is not finite.
    """
    omegas, sides = frequencies.ravel(), torques.reshape(len(torques), -1)
    added = np.broadcast_to(load_damping, torques.shape).reshape(sides.shape)
    damping = chain.mass_damping[:, None] + added
    twists, springs = chain.twists, chain.springs(omegas)
    # what a segment has of inertia at its ends
    alpha = chain.waves(omegas, springs)
    springs = springs / sinc(alpha)
    at_ends = chain.segment_inertias[:, None] / 2 * sinc(alpha / 2) / np.cos(alpha / 2)
    inertias = chain.inertias[:, None] + np.abs(twists).T @ at_ends
    # a pivot of exactly zero is none: it ends as inf
    of_masses = 1j * (damping * omegas + np.finfo(float).tiny) - inertias * omegas**2

    angles = _angles(chain, springs, of_masses, sides)
    # what is left over by the masses and the twists makes up for the digits that the first pass has lost
    left = sides - of_masses * angles - twists.T @ (springs * (twists @ angles))
    more = _angles(chain, springs, of_masses, left)
    return (angles + more).reshape(torques.shape)


def _angles(
    chain: Chain, springs: ComplexArray, of_masses: ComplexArray, sides: ComplexArray
) -> ComplexArray:
    """Return the angles (n, m) under torques (n, m), of springs (segments, m) and iΩ c − Ω² J of the masses (n, m).

    From the leaves of the tree to its root each mass passes on the torque T = r θ + t; over the spring the angle
    becomes s θ − t/k, s = 1 − r/k, and the torque (r/s) θ′ + t/s. Then the angles follow from the root outward.
    """
    fixed = chain.fixed_segments
    tree = ShaftTree(chain, fixed[-1] if fixed else None)
    by_angle, free = -of_masses, sides.astype(complex)
    ratios = np.ones(free.shape, complex)
    for mass in tree.leaves_first:
        for segment in tree.fixed[mass]:
            by_angle[mass] -= springs[segment]
        link = tree.links[mass]
        if link is None:
            continue
        ratios[mass] = _not_zero(1 - by_angle[mass] / springs[link.segment])
        if link.parent != GROUNDED:
            by_angle[link.parent] += by_angle[mass] / ratios[mass]
            free[link.parent] += free[mass] / ratios[mass]

    angles = np.empty(free.shape, complex)
    for mass in reversed(tree.leaves_first):
        link = tree.links[mass]
        if link is None:
            with np.errstate(all="ignore"):  # the resonance of a line that nothing damps
                angles[mass] = -free[mass] / by_angle[mass]
            continue
        beyond = 0.0 if link.parent == GROUNDED else angles[link.parent]
        angles[mass] = (beyond + free[mass] / springs[link.segment]) / ratios[mass]
    return angles


def passing(
    chain: Chain, frequencies: Array, angles: ComplexArray, sections: Sequence[tuple[int, float]]
) -> ComplexArray:
    """Return the torques (sections, …) in N m that springs and dampers carry; angles (n, …): see `response`.

    sections: of each its segment, and the share x of the length before it.
    """
    segments = [segment for segment, _ in sections]
    shares = np.array([share for _, share in sections]).reshape(-1, *(1,) * frequencies.ndim)
    springs = chain.springs(frequencies)
    alpha = chain.waves(frequencies, springs)[segments]
    before, behind = (np.tensordot(matrix[segments], angles, 1) for matrix in chain.ends)
    twists = np.cos(alpha * (1 - shares)) * before - np.cos(alpha * shares) * behind
    return springs[segments] / sinc(alpha) * twists


def loss(chain: Chain, frequencies: Array, angles: ComplexArray) -> Array:
    """Return the mean power in W that each segment dissipates at angular frequencies Ω (…) in rad/s, (segments, …).

    Without inertia Ω² d |Δθ|²/2 and Ω k η |Δθ|²/2; with inertia what enters at one end less what leaves at the other.
    """
    of_springs = (
        chain.springs(frequencies).imag
        * frequencies
        * np.abs(np.tensordot(chain.twists, angles, 1)) ** 2
    )
    heavy = np.flatnonzero(chain.segment_inertias).tolist()
    before, behind = (np.tensordot(matrix[heavy], angles, 1) for matrix in chain.ends)
    entering = passing(chain, frequencies, angles, [(segment, 0.0) for segment in heavy])
    leaving = passing(chain, frequencies, angles, [(segment, 1.0) for segment in heavy])
    of_springs[heavy] = (
        1j * frequencies * (entering.conj() * before - leaving.conj() * behind)
    ).real
    return of_springs / 2


# the tree of the masses


class RootwardSegment(NamedTuple):
    """The segment from a mass to the one next to it toward the root, or to the ground there.

    onward: whether the mass is before the segment, so that the torque toward the root is T.
    """

    segment: int
    parent: int
    onward: bool


class ShaftTree:
    """The masses of a chain as seen from a root: its fixed end, or its last mass.

    links: of each mass toward the root, None of a root that is a mass; leaves_first: the masses, each before its
    parent; children: of each mass those that have it as parent; fixed: of each mass the segments to other fixed ends.
    """

    def __init__(self, chain: Chain, root_segment: int | None) -> None:
        count = len(chain.inertias)
        self.links: list[RootwardSegment | None] = [None] * count
        self.children: list[list[int]] = [[] for _ in range(count)]
        self.fixed: list[list[int]] = [[] for _ in range(count)]
        neighbours: list[list[RootwardSegment]] = [[] for _ in range(count)]
        for segment, (before, behind) in enumerate(chain.joins):
            if before != GROUNDED:
                neighbours[before].append(RootwardSegment(segment, behind, True))
            if behind != GROUNDED:
                neighbours[behind].append(RootwardSegment(segment, before, False))

        # from the root outward
        root = count - 1
        if root_segment is not None:
            root = max(chain.joins[root_segment])
            self.links[root] = next(
                link for link in neighbours[root] if link.segment == root_segment
            )
        self.root, self.root_segment = root, root_segment
        outward = [root]
        for mass in outward:
            toward_root = self.links[mass]
            for segment, other, onward in neighbours[mass]:
                if toward_root is not None and segment == toward_root.segment:
                    continue
                if other == GROUNDED:
                    self.fixed[mass].append(segment)
                    continue
                self.links[other] = RootwardSegment(segment, mass, not onward)
                self.children[mass].append(other)
                outward.append(other)
        self.leaves_first = outward[::-1]

    def path_to_root(self, mass: int) -> Iterator[tuple[int, RootwardSegment | None]]:
        """Yield a mass and all from there to the root, each with its link."""
        while True:
            link = self.links[mass]
            yield mass, link
            if link is None or link.parent == GROUNDED:
                return
            mass = link.parent


def tree_from_first(chain: Chain) -> ShaftTree:
    """Return the tree that Holzer's table is read along, from the first mass to the last, or to a fixed end behind."""
    ends = [segment for segment, (_, behind) in enumerate(chain.joins) if behind == GROUNDED]
    return ShaftTree(chain, ends[-1] if ends else None)


# natural vibrations


class Holzer(NamedTuple):
    """Holzer's table of a mode: amplitudes Θ (n,), and torques (segments,) in N m per radian of the first mass.

    torques, torques_behind: at the end before and at that behind a segment, which differ if it has inertia; residual:
    what is left of the torque at the root, over the largest one.
    """

    angles: Array
    torques: Array
    torques_behind: Array
    residual: float


class _Bars:
    """The segments of a chain at angular frequencies ω (m,): what one makes of angle and torque at its near end.

    θ′ = θ cos α − (T/k) sinc α        T′ = T cos α + ω² J_s θ sinc α
    """

    def __init__(self, chain: Chain, omegas: Array) -> None:
        self._springs = chain.stiffnesses
        self._alpha = np.zeros((len(chain.joins), len(omegas)))
        self._cos, self._sinc = np.ones((2, *self._alpha.shape))
        heavy = np.flatnonzero(chain.segment_inertias)
        if len(heavy):
            self._alpha[heavy] = chain.waves(omegas, chain.stiffnesses[:, None])[heavy]
            self._cos[heavy], self._sinc[heavy] = (
                np.cos(self._alpha[heavy]),
                sinc(self._alpha[heavy]),
            )
        self._inertias = omegas * omegas * chain.segment_inertias[:, None] * self._sinc

    def onward(self, segment: int, angle: Any, torque: Any) -> tuple[Any, Any]:
        """Return angle and torque at the far end; torque: that from the near end to the far one."""
        cos, wave = self._cos[segment], self._sinc[segment]
        far_angle = angle * cos - torque / self._springs[segment] * wave
        return far_angle, torque * cos + self._inertias[segment] * angle

    def from_ground(self, segment: int) -> Array:
        """Return the torque over the angle at the far end of a segment whose near end is fixed: −k cos α/sinc α."""
        return -self._springs[segment] * self._cos[segment] / _not_zero(self._sinc[segment])

    def nodes(self, segments: Sequence[int], ratios: Array) -> Array:
        """Return how many points of these segments are at rest, (m,); ratios: the angle of the far ends over the near.

        Each half wave of a segment has one, and the rest of it one more if it turns the sign of the angle.
        """
        half_waves = np.floor(self._alpha[segments] / math.pi)
        is_odd = half_waves % 2 == 1
        return half_waves.sum(axis=0) + ((ratios < 0) != is_odd).sum(axis=0)

    def nodes_from_ground(self, segments: Sequence[int]) -> Array:
        """Return how many points of these segments are at rest beyond their fixed ends, (m,)."""
        return np.floor(self._alpha[segments] / math.pi).sum(axis=0)


class _Quotients:
    """Holzer's quotients of a tree at ω (m,), from the leaves to the root; by mass, (n, m).

    own: ω² J; at: r, the torque that leaves a mass toward the root over its angle: its own and all that arrives;
    ratios: s, the angle of the parent over that of the mass; arriving: r of its segment at the parent.
    Without inertia of the segment s = 1 − r/k, and r/s arrives.
    """

    def __init__(self, chain: Chain, tree: ShaftTree, bars: _Bars, omegas: Array) -> None:
        self._tree, self._bars = tree, bars
        self.own = omegas * omegas * chain.inertias[:, None]
        self.at = self.own.copy()
        self.ratios = np.ones(self.own.shape)
        self.arriving = np.zeros(self.own.shape)
        for mass in tree.leaves_first:
            at_mass = self.at[mass]
            for segment in tree.fixed[mass]:
                at_mass += bars.from_ground(segment)
            for child in tree.children[mass]:
                at_mass += self.arriving[child]
            link = tree.links[mass]
            if link is not None:
                ratio, torque = bars.onward(link.segment, 1.0, at_mass)
                self.ratios[mass] = ratio
                self.arriving[mass] = torque / _not_zero(ratio)

    @property
    def nodes(self) -> Array:
        """How many points of the segments are at rest, (m,)."""
        tree, bars = self._tree, self._bars
        linked = [mass for mass, link in enumerate(tree.links) if link is not None]
        segments = [link.segment for link in tree.links if link is not None]
        fixed = list(chain.from_iterable(tree.fixed))
        return bars.nodes(segments, self.ratios[linked]) + bars.nodes_from_ground(fixed)


class _Torques:
    """The torques at both ends of the segments of a chain, filled in segment by segment; as in `Holzer`."""

    def __init__(self, chain: Chain) -> None:
        self.before, self.behind = np.zeros((2, len(chain.joins)))

    def set(self, link: RootwardSegment, at_mass: float, at_parent: float) -> None:
        """Take the torques toward the root at the ends of the segment of a link."""
        if link.onward:
            self.before[link.segment], self.behind[link.segment] = at_mass, at_parent
        else:
            self.before[link.segment], self.behind[link.segment] = -at_parent, -at_mass

    def set_fixed(self, chain: Chain, segment: int, bars: _Bars, angle: float) -> None:
        """Take the torques in a segment between a fixed end and a mass at this angle, away from the root."""
        from_ground = float(bars.from_ground(segment)[0]) * angle
        # read from the mass to the ground
        _, at_ground = bars.onward(segment, angle, -from_ground)
        mass_is_before = chain.joins[segment][1] == GROUNDED
        self.set(
            RootwardSegment(segment, GROUNDED, mass_is_before), -from_ground, float(at_ground[0])
        )


def holzer_at(chain: Chain, omega: float) -> Holzer:
    """Return Holzer's table at any angular frequency in rad/s, from the first mass on; branches follow their mass.

    residual: the torque left behind the last mass in N m, or at a fixed end behind it the angle left in rad, both per
    radian of the first mass: at a natural frequency it is zero.
    """
    tree = tree_from_first(chain)
    bars = _Bars(chain, np.array([omega]))
    quotients = _Quotients(chain, tree, bars, np.array([omega]))
    angles, torques = np.zeros(len(chain.inertias)), _Torques(chain)

    # from the first mass to the root; fixed ends and branches at a mass add their torques
    angle, torque, left = 1.0, 0.0, 0.0
    on_path = set[int]()
    for mass, link in tree.path_to_root(0):
        angles[mass] = angle
        arriving = [bars.from_ground(segment) for segment in tree.fixed[mass]]
        arriving += [
            quotients.arriving[child] for child in tree.children[mass] if child not in on_path
        ]
        torque += (
            sum(float(quotient[0]) for quotient in arriving) * angle
            + float(quotients.own[mass][0]) * angle
        )
        on_path.add(mass)
        if link is None:
            left = torque
            break
        far, beyond = bars.onward(link.segment, angle, torque)
        torques.set(link, torque, float(beyond[0]))
        angle, torque = float(far[0]), float(beyond[0])
        left = angle

    # from there outward into the branches
    for mass in reversed(tree.leaves_first):
        link = tree.links[mass]
        if mass not in on_path and link is not None:
            angles[mass] = angles[link.parent] / _not_zero(quotients.ratios[mass])[0]
            at_mass = quotients.at[mass][0] * angles[mass]
            torques.set(
                link, at_mass, float(bars.onward(link.segment, angles[mass], at_mass)[1][0])
            )
        for segment in tree.fixed[mass]:
            torques.set_fixed(chain, segment, bars, angles[mass])
    return Holzer(angles, torques.before, torques.behind, left)


class Modes:
    """The natural vibrations of a chain, the lowest first; of a free one the first is the rotation of the whole.

    Holzer's table as quotients, from the leaves of the tree to its root. No step loses digits by cancellation but
    through the figures of its own mass and segment, so that the points at rest that it counts, which are the modes
    below ω (Sturm; Wittrick and Williams of segments with inertia), are those of a chain whose J and k differ by
    rounding. A symmetric eigenproblem alone would lose the low modes of a chain of very unequal masses.
    """

    def __init__(self, chain: Chain) -> None:
        self.chain = chain
        fixed = chain.fixed_segments
        self._tree = ShaftTree(chain, fixed[-1] if fixed else None)  # read toward a fixed end

    @cached_property
    def omegas(self) -> Array:
        """Natural angular frequencies in rad/s (n,), of a free chain the first exactly 0.

        Those of the elastic modes are the first numbers below which there are so many modes, to the last digit.
        """
        guessed = self._guessed()
        frequencies = guessed.copy()
        # a singular value is known to a few units in the last place of the largest one
        margin = np.minimum(_LAST_PLACES * guessed[-1] / guessed, 0.5)
        low, high = guessed / (1 + margin), guessed * (1 + margin)
        left = np.arange(len(guessed))
        while len(left):
            # the intervals are cut into parts, and the part that holds the mode is kept
            steps = low + (high - low) * _SHARES
            tried = np.where(high > 2 * low, low * (high / low) ** _SHARES, steps)
            tried[-1] = high
            has_more = self._below(tried.ravel()).reshape(tried.shape) > left
            first = has_more.argmax(axis=0)
            indices = np.arange(len(left))
            inner_low, inner_high = tried[first - 1, indices], tried[first, indices]
            # one that does not hold it is widened
            is_outside = has_more[0] | ~has_more[-1]
            margin = np.where(is_outside, 100 * margin, margin)
            low = np.where(is_outside, guessed[left] / (1 + margin), inner_low)
            high = np.where(is_outside, guessed[left] * (1 + margin), inner_high)
            # until nothing is between its ends
            is_found = ~is_outside & (np.nextafter(low, high) == high)
            frequencies[left[is_found]] = high[is_found]
            left, low, high, margin = (row[~is_found] for row in (left, low, high, margin))
        if self.chain.is_held:
            return frequencies
        return np.append(0.0, frequencies)

    def _guessed(self) -> Array:
        """Return the elastic natural frequencies about, singular values of K^½ J^{−½}, inertias lumped."""
        chain = self.chain
        scaled = chain.twists * np.sqrt(chain.stiffnesses)[:, None] / np.sqrt(chain.lumped)
        guessed = np.linalg.svd(scaled, compute_uv=False)[::-1]
        # of a free chain with as many masses as segments and one more, there is none for the rotation
        elastic = guessed[-self._elastic :]
        return np.maximum(elastic, _LEAST_GUESS * guessed[-1])

    @property
    def _elastic(self) -> int:
        """How many elastic modes there are."""
        return len(self.chain.inertias) - (0 if self.chain.is_held else 1)

    def _below(self, omegas: Array) -> Array:
        """Return how many elastic modes are below each ω (m,)."""
        quotients = _Quotients(self.chain, self._tree, _Bars(self.chain, omegas), omegas)
        if self.chain.is_held:
            return quotients.nodes
        # at a free end the torque is zero, and the rotation of the whole is no elastic mode
        return quotients.nodes + (quotients.at[self._tree.root] > 0) - 1

    def holzer(self, mode: int) -> Holzer:
        """Return the table of a mode, counted from 0.

        From the mass at which the quotients from the leaves and from the root meet best it is computed outward, where
        no error grows.
        """
        tree, chain = self._tree, self.chain
        omega = self.omegas[mode : mode + 1]
        bars = _Bars(chain, omega)
        inward = _Quotients(chain, tree, bars, omega)

        # the quotients from the root: of each mass r of all that is beyond its link, and of its parent but for it
        from_root: list[Array] = [np.zeros(1)] * len(chain.inertias)
        of_rest: list[Array] = [np.zeros(1)] * len(chain.inertias)
        root_link = tree.links[tree.root]
        if root_link is not None:
            from_root[tree.root] = bars.from_ground(root_link.segment)
        for mass in reversed(tree.leaves_first):
            fixed = sum(
                (bars.from_ground(segment) for segment in tree.fixed[mass]), start=np.zeros(1)
            )
            for child in tree.children[mass]:
                # the sum without the child; the whole less the child would cancel
                others = [inward.arriving[other] for other in tree.children[mass] if other != child]
                of_rest[child] = sum(others, start=from_root[mass] + fixed) + inward.own[mass]
                link = tree.links[child]
                assert link is not None
                ratio, torque = bars.onward(link.segment, 1.0, of_rest[child])
                from_root[child] = torque / _not_zero(ratio)

        gaps = np.array(
            [float((inward.at[mass] + from_root[mass])[0]) for mass in range(len(chain.inertias))]
        )
        meeting = int(np.argmin(np.abs(gaps) / chain.lumped))

        # from there outward: to the root, then to the leaves
        angles, torques = np.zeros(len(chain.inertias)), _Torques(chain)
        angles[meeting] = 1.0
        on_path = set[int]()
        for mass, link in tree.path_to_root(meeting):
            on_path.add(mass)
            if link is None:
                break
            if link.parent == GROUNDED:
                torques.set_fixed(chain, link.segment, bars, angles[mass])
                break
            ratio, torque = bars.onward(link.segment, 1.0, of_rest[mass])
            angles[link.parent] = angles[mass] / _not_zero(ratio)[0]
            at_parent = -of_rest[mass][0] * angles[link.parent]
            torques.set(link, -float(torque[0]) * angles[link.parent], at_parent)
        for mass in reversed(tree.leaves_first):
            link = tree.links[mass]
            if mass not in on_path and link is not None:
                angles[mass] = angles[link.parent] / _not_zero(inward.ratios[mass])[0]
                at_mass = inward.at[mass][0] * angles[mass]
                torques.set(
                    link, at_mass, float(bars.onward(link.segment, angles[mass], at_mass)[1][0])
                )
            for segment in tree.fixed[mass]:
                torques.set_fixed(chain, segment, bars, angles[mass])

        largest = float(np.abs((torques.before, torques.behind)).max(initial=0.0))
        residual = abs(float(gaps[meeting])) / max(largest, float(inward.own[meeting][0]), 1e-300)
        first_moves = abs(angles[0]) > _AT_REST * np.abs(angles).max()
        unit = angles[0] if first_moves else angles[np.argmax(np.abs(angles))]
        return Holzer(angles / unit, torques.before / unit, torques.behind / unit, residual)

    def nodes(self, mode: int) -> tuple[tuple[int, float], ...]:
        """Return where a mode has no motion between the ends: the segment, and the share of it up to there.

        A mass at rest is at the beginning of a segment behind it.
        """
        table, chain = self.holzer(mode), self.chain
        may_rest = chain.has_branches or chain.segment_inertias.any()
        least = _ROUNDING * np.abs(table.angles).max() if may_rest else 0.0
        angles = np.where(np.abs(table.angles) <= least, 0.0, table.angles)
        waves = chain.waves(self.omegas[mode : mode + 1], chain.stiffnesses[:, None])[:, 0]
        found, at_rest = list[tuple[int, float]](), set[int]()
        for segment, (before, behind) in enumerate(chain.joins):
            # a fixed end is no node between the ends
            angle = 0.0 if before == GROUNDED else float(angles[before])
            far = 0.0 if behind == GROUNDED else float(angles[behind])
            if before != GROUNDED and angle == 0 != far and before not in at_rest:
                at_rest.add(before)
                found.append((segment, 0.0))
            alpha = float(waves[segment])
            if alpha > 0:
                # θ₁ cos αx − T₁/(k α) sin αx, whose zeros are half a wave apart
                first = math.atan2(
                    angle, table.torques[segment] / (chain.stiffnesses[segment] * alpha)
                )
                shares = [
                    (first + number * math.pi) / alpha
                    for number in range(-1, math.ceil(alpha / math.pi) + 2)
                ]
            else:
                shares = [angle / (angle - far)] if angle * far < 0 else []
            last = 1 - _ROUNDING if far == 0 else 1.0
            found += [(segment, share) for share in shares if 0 < share < last]
        return tuple(found)


def _not_zero(quotient: Q) -> Q:
    return np.where(quotient == 0, _NOTHING, quotient)


# periodic motion over the angle, with all its orders

_SWING = 200.0
"""Degrees of the fastest natural vibration that a piece may hold at first, …"""
_MOST_PARTS = 8000
"""… though one is cut into no more parts than these."""


class ChainEquation:
    """y′ = A y + driving − rise: vibrations of chains without loss factors about uniform rotation at ω_n.

    Numbers of the chain are (n,), or (n, machines); order: the largest natural one, omega: ω_n in rad/s, numbers or
    (machines,); driving: torques on the masses less their means in N m, (n, nodes, pieces). law: how the load on the
    mass `loaded` rises with the speed; by_modes: of one machine, whether its modes are solved one by one.
    The unknowns are, in N m and of one size: for each segment the torque of its spring less its mean, over `order`, and
    for each mass J ω_n (ω − ω_n).
    """

    noise: Array
    modal: Modal | None = None

    def __init__(
        self,
        chain: Chain,
        order: Any,
        omega: Any,
        pieces: Pieces,
        driving: Array,
        law: SpeedLaw | None = None,
        loaded: int = 0,
        by_modes: bool = False,
    ) -> None:
        self._source = pieces
        self._driving = driving
        self._law = law
        self.noise = np.zeros(pieces.count)
        self._order, omega = (np.broadcast_to(one, pieces.count) for one in (order, omega))
        parts = np.ceil(2 * pieces.half * self._order[pieces.machine] / _SWING).clip(1, _MOST_PARTS)
        self.pieces = pieces.parted(parts.astype(int))

        numbers = (chain.inertias, chain.stiffnesses, chain.segment_damping, chain.mass_damping)
        inertias, stiffnesses, self._damping, self._against = (
            number.reshape(len(number), -1) for number in numbers
        )
        self._twists, self._speeds = chain.twists, 1 / (inertias * omega)
        self._springs = stiffnesses / (omega * self._order)
        self.unknowns = sum(chain.twists.shape)
        self.bounded = len(chain.stiffnesses) + loaded if law else None
        self._height = inertias[loaded] * omega**2
        unit = np.broadcast_to(
            np.eye(self.unknowns)[..., None], (self.unknowns, self.unknowns, pieces.count)
        )
        self._matrix = self._flow(unit, np.arange(pieces.count))[1]
        self.modal = self._modes(chain) if by_modes else None

    def _modes(self, chain: Chain) -> Modal:
        """Return the modes of the only machine, under a load that rises as at the nominal speed.

        Of unknowns whose squares are energies the matrix is skew but for the damping. Raises LinAlgError.
        """
        matrix = self._matrix[..., 0].copy()
        if self._law:
            matrix[self.bounded, self.bounded] -= self._law.steepness[0] / self._height[0]
        springs = np.sqrt(chain.stiffnesses) / self._order[0]
        masses = np.sqrt(chain.inertias) / (chain.inertias * self._speeds[:, 0])
        return Modal.of(matrix, np.concatenate((springs, masses)))

    def _flow(self, y: Array, machine: Indices) -> tuple[Array, Array]:
        """Return the torques in the segments (segments, k, n), and A y, at y (m, k, n) of these machines (n,)."""
        segments = len(self._springs)
        speeds = y[segments:] * self._speeds[:, None, machine]
        apart = np.tensordot(self._twists, speeds, 1)
        torques = self._order[machine] * y[:segments] + self._damping[:, None, machine] * apart
        masses = (
            -np.tensordot(self._twists.T, torques, 1) - self._against[:, None, machine] * speeds
        )
        return torques, np.concatenate((self._springs[:, None, machine] * apart, masses))

    def known(self, pieces: Pieces) -> Array:
        """Return the torques on the masses, and J ω_n² of the one under the load: less by so much, it stands still."""
        torques = pieces.carried(self._driving, self._source)
        return np.concatenate(
            (torques, np.broadcast_to(pieces.of(self._height), (1, *torques.shape[1:])))
        )

    def rate(self, known: Array, y: Array, pieces: Pieces) -> tuple[Array, Array | None]:
        """Return y′ and its derivative by y, None where the modes are known."""
        torques, height = known[:-1], known[-1]
        rate = self._flow(y, pieces.machine)[1]
        rate[-len(torques) :] += torques
        slope = None
        if self.modal is None:
            slope = self._matrix[:, :, None, pieces.machine].repeat(y.shape[1], axis=2)
        if self._law:
            # with u = (ω − ω_n)/ω_n the square of the speed is 1 + u (2 + u) of the nominal one
            u = y[self.bounded] / height
            rise, by_square = self._law.rise(u * (2 + u), pieces)
            rate[self.bounded] -= rise
            if slope is not None:
                slope[self.bounded, self.bounded] -= by_square * 2 * (1 + u) / height
        return rate, slope

    def torques(self, y: Array, pieces: Pieces) -> Array:
        """Return the torques in the segments less their means in N m, (segments, nodes, pieces)."""
        return self._flow(y, pieces.machine)[0]

    def vibration(self, y: Array, pieces: Pieces) -> Array:
        """Return ω − ω_n of the masses in rad/s, (n, nodes, pieces)."""
        speeds = y[len(self._springs) :] * self._speeds[:, None, pieces.machine]
        return np.asarray(speeds)
