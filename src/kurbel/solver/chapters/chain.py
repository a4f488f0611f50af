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

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from typing import Any, NamedTuple, TypeVar

import numpy as np

from kurbel.arrays import Array, ComplexArray
from kurbel.machine.shaft_line import GROUNDED, ShaftLine

Q = TypeVar("Q", Array, ComplexArray)
"""Quotients, real or complex."""
_NOTHING = 1e-40
"""In place of a quotient of Holzer's table that is exactly zero: there a mass is at rest."""


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
        ratios[mass] = not_zero(1 - by_angle[mass] / springs[link.segment])
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


def not_zero(quotient: Q) -> Q:
    return np.where(quotient == 0, _NOTHING, quotient)
