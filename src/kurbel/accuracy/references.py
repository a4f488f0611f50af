"""The reference of every quantity, with high precision and by another method than kurbel's own.

Angles are in degrees, all else in SI; the results are Decimals. Each function computes in the current decimal context.
"""

from collections.abc import Iterator, Sequence
from decimal import Decimal
from fractions import Fraction
from functools import cache, cached_property
from itertools import pairwise

from kurbel.accuracy.decimals import integral, largest, pi, root
from kurbel.accuracy.oracle import Chamber, CrankMotion, CylinderOracle, Segment, apart, sign_changes
from kurbel.machine import Machine


def motion_at(motion: CrankMotion, degrees: Sequence[float], asked: str) -> list[Decimal]:
    """Return the `coordinate`, `slope` or `curvature` in m at crank angles (n,)."""
    return [getattr(motion.at(Decimal(angle)), asked) for angle in degrees]


def largest_slope(motion: CrankMotion) -> Decimal:
    """Return the largest dx/dφ in m on the outstroke: where d²x/dφ² is zero."""
    inner, outer = motion.dead_centres
    return motion.at(root(lambda degrees: motion.at(degrees).curvature, inner, outer)).slope


def work(cylinder: CylinderOracle) -> Decimal:
    """Return the indicated work in J per cycle: areas of polygons as fractions, of polytropic segments by Gauss."""
    areas = [_area(chamber) * chamber.area for chamber in cylinder.chambers]
    return cylinder.motion.stroke * sum(areas, Decimal(0))


def _area(chamber: Chamber) -> Decimal:
    straight, curved = Fraction(0), Decimal(0)
    for segment in (segment for line in chamber.lines for segment in line):
        if segment.exponent is None:
            p, next_p, z, next_z = map(Fraction, (segment.p, segment.next_p, segment.z, segment.next_z))
            straight += (p + next_p) * (next_z - z) / 2
        else:
            curved += _curved_area(chamber, segment)
    return Decimal(straight.numerator) / Decimal(straight.denominator) + curved


def _curved_area(chamber: Chamber, segment: Segment) -> Decimal:
    low, high = sorted((segment.z, segment.next_z))
    area = integral(lambda z: chamber.on(segment, z), low, high)
    return area if segment.z == low else -area


def tangential_extremes(cylinder: CylinderOracle) -> tuple[Decimal, Decimal]:
    """Return the largest and the smallest T in N: golden sections between samples of every piece, ends included."""
    crank = cylinder.motion.crank
    found = []
    for sign in (1, -1):
        hills = [top for low, high in pairwise(cylinder.breaks) for top in _hills(cylinder, low, high, sign)]
        found.append(sign * max(hills) / crank)
    return found[0], found[1]


def _hills(cylinder: CylinderOracle, low: Decimal, high: Decimal, sign: int, parts: int = 24) -> Iterator[Decimal]:
    """Yield the values at the ends of a piece, and at every hill between its samples."""
    within = (low + high) / 2
    ends = [low + (high - low) * k / parts for k in range(parts + 1)]

    def height(degrees: Decimal) -> Decimal:
        return sign * cylinder.torque(degrees, within)

    heights = [height(end) for end in ends]
    top = max(heights)
    yield top
    for k in range(1, parts):
        # a hill that stays more than a tenth of the range below the top cannot reach it between two samples
        near = heights[k] > top - (top - min(heights)) / 10
        if near and heights[k] >= heights[k - 1] and heights[k] >= heights[k + 1]:
            yield largest(height, ends[k - 1], ends[k + 1])
    for first, second, end in ((ends[0], ends[1], 0), (ends[-2], ends[-1], -1)):
        if heights[end] == top:
            yield largest(height, first, second)


def friction_work(cylinder: CylinderOracle) -> Decimal:
    """Return ∮ (f |N| + rings) |dx| in J per cycle."""
    total = Decimal(0)
    for low, high in pairwise(cylinder.breaks):
        within = (low + high) / 2

        def power(degrees: Decimal, within: Decimal = within) -> Decimal:
            return (cylinder.drag(degrees, within) + cylinder.rings) * abs(cylinder.motion.at(degrees).slope)

        total += integral(power, low, high)
    return total * pi() / 180


class MachineOracle:
    """The turning effort of a whole machine over its common cycle, at the crank angles of crank 1."""

    def __init__(self, machine: Machine) -> None:
        self.cycle = Decimal(360 * machine.revolutions)
        self.efficiency = Decimal(machine.efficiency)
        self.cylinders = tuple(
            (CylinderOracle(machine, cylinder), Decimal(cylinder.crank_position)) for cylinder in machine.cylinders
        )

    def torque(self, degrees: Decimal, within: Decimal) -> Decimal:
        """Return M in N m, inertia at uniform rotation included."""
        return sum((one.torque(degrees - position, within - position) for one, position in self.cylinders), Decimal(0))

    @cached_property
    def breaks(self) -> tuple[Decimal, ...]:
        """Angles from 0 to the cycle at which the effort bends or jumps."""
        found = {Decimal(0), self.cycle}
        for one, position in self.cylinders:
            own = one.breaks[:-1]
            period = 360 * one.turns
            for repeat in range(int(self.cycle) // period):
                found |= {(angle + position + repeat * period) % self.cycle for angle in own}
        return apart(sorted(angle + self.cycle if angle < 0 else angle for angle in found))

    @cache  # noqa: B019, an oracle lives for one question, and is asked most pieces twice
    def work(self, low: Decimal, high: Decimal) -> Decimal:
        """Return ∫ M dφ in J within one piece, from low to high in degrees."""
        within = (low + high) / 2
        return integral(lambda degrees: self.torque(degrees, within), low, high) * pi() / 180

    @cached_property
    def mean(self) -> Decimal:
        """Return the mean of M in N m."""
        return sum((self.work(low, high) for low, high in pairwise(self.breaks)), Decimal(0)) / (
            self.cycle * pi() / 180
        )


def excess_energy(machine: Machine) -> Decimal:
    """Return ΔE in J, the largest swing of ∫ (M − its mean) dφ."""
    oracle = MachineOracle(machine)
    mean = oracle.mean
    points = sorted({*oracle.breaks, *_crossings(oracle, mean)})
    height, heights = Decimal(0), [Decimal(0)]
    for low, high in pairwise(points):
        height += oracle.work(low, high) - mean * (high - low) * pi() / 180
        heights.append(height)
    return max(heights) - min(heights)


def _crossings(oracle: MachineOracle, mean: Decimal) -> Iterator[Decimal]:
    for low, high in pairwise(oracle.breaks):
        yield from sign_changes(lambda degrees, within: oracle.torque(degrees, within) - mean, low, high)
