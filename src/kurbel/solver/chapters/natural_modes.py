"""The table of Holzer on a shaft line, and its natural frequencies and modes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property
from itertools import chain
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.machine.shaft_line import GROUNDED
from kurbel.solver.chapters.chain import (
    Chain,
    RootwardSegment,
    ShaftTree,
    not_zero,
    sinc,
    tree_from_first,
)

_AT_REST = 1e-6
"""A first mass that moves less than this, over the largest motion, is not used as the reference of the others."""
_ROUNDING = 1e-12
"""Of the largest motion: less than this is none in a line with branches, of which a whole part may be at rest."""
_LAST_PLACES = 1e-15
"""Of the highest natural frequency: by how much one that is guessed by singular values is uncertain."""
_SHARES = np.linspace(0, 1, 17)[:, None]
"""Where an interval that holds a natural frequency is cut into parts."""
_LEAST_GUESS = 1e-9
"""Of the highest natural frequency: what an eigenvalue solver finds below it is rounding."""


class Holzer(NamedTuple):
    """Holzer's table of a mode: amplitudes Θ (n,), and torques (segments,) in N m per radian of the first mass.

    Where the first mass is nearly at rest, they are per radian of the mass that moves most. torques, torques_behind: at
    the end before and at that behind a segment, which differ if it has inertia; residual: what is left of the torque at
    the root, over the largest one.
    """

    angles: Array
    torques: Array
    torques_behind: Array
    residual: float


class _Bars:
    """The segments of a chain at angular frequencies ω (m,): angle and torque at the far end from those at the near end.

    θ₂ = θ₁ cos α − (T₁/k) sinc α        T₂ = T₁ cos α + ω² J_s θ₁ sinc α        α = ω √(J_s/k)
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
        return -self._springs[segment] * self._cos[segment] / not_zero(self._sinc[segment])

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
                self.arriving[mass] = torque / not_zero(ratio)

    @property
    def nodes(self) -> Array:
        """How many points of the segments are at rest, (m,)."""
        tree, bars = self._tree, self._bars
        linked = [mass for mass, link in enumerate(tree.links) if link is not None]
        segments = [link.segment for link in tree.links if link is not None]
        fixed = list(chain.from_iterable(tree.fixed))
        return bars.nodes(segments, self.ratios[linked]) + bars.nodes_from_ground(fixed)

    def fill_branches(self, angles: Array, torques: _Torques, on_path: set[int]) -> None:
        """Fill in the angles (n,) of masses off a path to the root, and the torques, outward from it; of one ω.

        The angles of the masses on the path are those already there.
        """
        tree, bars = self._tree, self._bars
        for mass in reversed(tree.leaves_first):
            link = tree.links[mass]
            if mass not in on_path and link is not None:
                angles[mass] = angles[link.parent] / not_zero(self.ratios[mass])[0]
                at_mass = self.at[mass][0] * angles[mass]
                _, at_parent = bars.onward(link.segment, angles[mass], at_mass)
                torques.set(link, at_mass, float(at_parent[0]))
            for segment in tree.fixed[mass]:
                torques.set_fixed(segment, bars, angles[mass])


class _Torques:
    """The torques at both ends of the segments of a chain, filled in segment by segment; as in `Holzer`."""

    def __init__(self, chain: Chain) -> None:
        self._joins = chain.joins
        self.before, self.behind = np.zeros((2, len(chain.joins)))

    def set(self, link: RootwardSegment, at_mass: float, at_parent: float) -> None:
        """Take the torques toward the root at the ends of the segment of a link."""
        if link.onward:
            self.before[link.segment], self.behind[link.segment] = at_mass, at_parent
        else:
            self.before[link.segment], self.behind[link.segment] = -at_parent, -at_mass

    def set_fixed(self, segment: int, bars: _Bars, angle: float) -> None:
        """Take the torques in a segment between a fixed end and a mass at this angle, away from the root."""
        from_ground = float(bars.from_ground(segment)[0]) * angle
        # read from the mass to the ground
        _, at_ground = bars.onward(segment, angle, -from_ground)
        mass_is_before = self._joins[segment][1] == GROUNDED
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
    quotients.fill_branches(angles, torques, on_path)
    return Holzer(angles, torques.before, torques.behind, left)


class Modes:
    """The natural vibrations of a chain, the lowest first; of a free one the first is the rotation of the whole.

    Holzer's table as quotients, from the leaves of the tree to its root. Each step uses one mass and one segment, so
    that rounding acts as a change of that J and k in the last digit. The number of points at rest is that of the modes
    below ω (Sturm; Wittrick and Williams of segments with inertia). A symmetric eigenproblem alone would lose the low
    modes of a chain of very unequal masses.
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
                from_root[child] = torque / not_zero(ratio)

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
                torques.set_fixed(link.segment, bars, angles[mass])
                break
            ratio, torque = bars.onward(link.segment, 1.0, of_rest[mass])
            angles[link.parent] = angles[mass] / not_zero(ratio)[0]
            at_parent = -of_rest[mass][0] * angles[link.parent]
            torques.set(link, -float(torque[0]) * angles[link.parent], at_parent)
        inward.fill_branches(angles, torques, on_path)

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
