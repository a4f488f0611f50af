"""The oil film of a pin or main bearing over the cycle, by the mobility method (Booker 1971, Moes).

Complex numbers are seen from the shell, in the sense of rotation. ε is how far the journal is out
of the middle of the shell, over the radial clearance c; f is the direction in which the load F
presses it, and ξ + iη = ε e^{−i arg f}. In a frame that turns with the mean speed of both surfaces
the film is squeezed alone; hence, per radian of the crank,

    ε′ = K |F| (M_ξ + i M_η) f + ½ i τ ε
    K = (2c/D)²/(μ L D ω)                     τ = (ω_journal − ω_shell)/ω
    M_ξ = (1−ξ)^{3/2} (1−ξ + 0.6 Λ)/(π λ²)    M_η = −4 η (1−ξ)^{1/2} (1−ξ + 0.28 Λ)/(π² λ²)
    λ = L/D of one land                       Λ = λ²/(1 + λ/4), of the short bearing 0

0.6, 0.28 and 1/4 are fitted to solutions of Reynolds' equation for finite length
(docs/oil-film.md). The unknown is y = ε/√(1−ε²): every y is inside the shell, and no digit is lost
near the wall.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, ComplexArray
from kurbel.numerics.arithmetic import where
from kurbel.numerics.collocation import Periodic, followed, periodic
from kurbel.numerics.extreme import Extreme
from kurbel.numerics.pieces import Pieces, highest, refined
from kurbel.quantity import ValuesById, value
from kurbel.solver.figures import Results, result

if TYPE_CHECKING:
    from kurbel.machine.oil_film import OilFilms

_ALONG = 0.6
"""Share of Λ in the mobility along the load."""
_ACROSS = 0.28
"""Share of Λ in the mobility across the load."""
_FROM_MIDDLE = 300.0
"""Largest K |F| that is solved from a journal in the middle; heavier loads follow lighter ones."""
_STEP = 1e-30
"""A complex step: the imaginary part of what it gives, over the step, is the derivative."""
_BISECTIONS = 54
_FARTHEST = 1e6
"""Largest y of a film, 5e-13 of the clearance thick; beyond, the journal only nears the wall."""


class FilmShape(NamedTuple):
    """Oil and bearing in SI: numbers, or arrays of many machines or pieces.

    length: of all lands together.
    """

    clearance: Any
    diameter: Any
    length: Any
    viscosity: Any
    lands: int = 1
    is_short: bool = False

    @classmethod
    def of_bearing(cls, films: OilFilms, key: str, diameter: Any, length: Any) -> FilmShape:
        """Return the shape of the bearing with this key; sizes: of its pin, where it has none."""
        bearing = films.bearings[key]
        diameter = diameter if bearing.diameter is None else bearing.diameter
        length = length if bearing.length is None else bearing.length
        viscosity = films.viscosity if bearing.viscosity is None else bearing.viscosity
        lands = 1
        if bearing.groove is not None:
            length = where(length > bearing.groove, length - bearing.groove, np.nan)
            lands = 2
        is_short = films.theory == "short"
        return cls(bearing.clearance, diameter, length, viscosity, lands, is_short)

    def of(self, pieces: Pieces) -> FilmShape:
        """Return the numbers of every piece."""
        return self._replace(
            clearance=pieces.of(self.clearance),
            diameter=pieces.of(self.diameter),
            length=pieces.of(self.length),
            viscosity=pieces.of(self.viscosity),
        )

    @property
    def lam(self) -> Any:
        """λ, length over diameter of one land."""
        return self.length / (self.lands * self.diameter)

    @property
    def finite(self) -> Any:
        """Λ, by which a film of this length differs from a short one."""
        if self.is_short:
            return 0.0 * self.lam
        return self.lam**2 / (1 + self.lam / 4)

    def mobility_number(self, omega: Any) -> Any:
        """Return K in 1/N at an angular velocity in rad/s."""
        ratio = 2 * self.clearance / self.diameter
        return ratio**2 / (self.viscosity * self.length * self.diameter * omega)

    def pressure(self, y: Array, pressed: ComplexArray) -> Array:
        """Return the largest pressure in Pa of a film at y (2, …) under a load in N (…)."""
        seen = along_load(y, pressed)
        short_peak = np.abs(pressed) / (self.length * self.diameter) * peak_factor(seen)
        if self.is_short:
            return np.asarray(short_peak)
        gap = gap_of(seen.real, seen.imag)
        u = 0.21 * (self.lam**2 / gap) ** (2 / 3)
        return np.asarray(short_peak * (1 + u) / (1 + 2 * u))


def along_load(y: Array, pressed: ComplexArray) -> ComplexArray:
    """Return p + iq = y e^{−i arg f} from y (2, …); 0 where there is no load."""
    size = np.abs(pressed)
    turn = np.conj(pressed) / np.where(size > 0, size, 1.0)
    return np.asarray((y[0] + 1j * y[1]) * turn)


def gap_of(p: Any, q: Any) -> Any:
    """Return 1 − ξ, the film toward the load over c, at p + iq; no digit is lost near the wall."""
    root = np.sqrt(1 + p * p + q * q)
    return np.where(p.real > 0, (1 + q * q) / (root * (root + p)), 1 - p / root)


def mobility(p: Any, q: Any, lam: Any, finite: Any) -> tuple[Any, Any]:
    """Return M_ξ and M_η at p + iq, for λ and Λ; p and q may be complex themselves."""
    gap = gap_of(p, q)
    root_gap = np.sqrt(gap)
    eta = q / np.sqrt(1 + p * p + q * q)
    along = gap * root_gap * (gap + _ALONG * finite) / (np.pi * lam**2)
    across = -4 * eta * root_gap * (gap + _ACROSS * finite) / (np.pi * lam) ** 2
    return along, across


def peak_factor(seen: ComplexArray) -> Array:
    """Return P, the largest pressure of a short film over F/(L D), at p + iq.

    P = 6 (m·n)/(1 − ε·n)³ at its largest over the directions n, with m = λ² (M_ξ, M_η) of the short
    film. Seen from m with ε = a + ib, n = e^{iα} and b (1 + 2 cos²α) = sin α (1 + 2a cos α), which
    has one solution on the side of b.
    """
    along, across = mobility(seen.real, seen.imag, 1.0, 0.0)
    strength = np.hypot(along, across)
    eccentricity = seen / np.sqrt(1 + np.abs(seen) ** 2)
    from_m = eccentricity * (along - 1j * across) / strength
    a = from_m.real
    b = from_m.imag
    low = np.where(b > 0, 0.0, -np.pi / 2)
    high = low + np.pi / 2
    for _ in range(_BISECTIONS):
        alpha = (low + high) / 2
        cos = np.cos(alpha)
        is_before = b * (1 + 2 * cos * cos) > np.sin(alpha) * (1 + 2 * a * cos)
        low = np.where(is_before, alpha, low)
        high = np.where(is_before, high, alpha)
    cos = np.cos(low)
    return np.asarray(6 * strength * cos / (1 - a * cos - b * np.sin(low)) ** 3)


class FilmEquation:
    """y′ of the oil film, for `kurbel.numerics.collocation`.

    course: both parts of K F toward where the journal is pressed, and τ, (3, nodes, pieces); share
    (machines,): of the load that acts.
    """

    unknowns = 2
    bounded: int | None = None
    modal = None

    def __init__(self, shape: FilmShape, pieces: Pieces, course: Array) -> None:
        self._pieces = pieces
        self._course = course
        self._lam = shape.lam
        self._finite = shape.finite
        self.noise: Array = np.zeros(pieces.count)
        self.share = np.ones(pieces.count)

    def known(self, pieces: Pieces) -> Array:
        """Return both parts of K F, and τ."""
        course = pieces.resampled(self._course, self._pieces)
        load_share = pieces.of(self.share)
        return course * np.stack((load_share, load_share, np.ones_like(load_share)))[:, None]

    def rate(self, course: Array, y: Array, pieces: Pieces) -> tuple[Array, Array]:
        """Return y′ = |K F| (M + y (y·M)) √(1 + y²) + ½ i τ y, and its derivative by y."""
        size = np.hypot(course[0], course[1])
        cos, sin = course[:2] / np.where(size > 0, size, 1.0)
        half_turning = course[2] / 2
        # along and across the load, with a complex step of either
        step = 1j * _STEP * np.eye(2)[:, :, None, None]
        p = cos * y[0] + sin * y[1] + step[0]
        q = cos * y[1] - sin * y[0] + step[1]
        M_along, M_across = mobility(p, q, pieces.of(self._lam), pieces.of(self._finite))
        product = p * M_along + q * M_across
        factor = size * np.sqrt(1 + p * p + q * q)
        along = factor * (M_along + p * product)
        across = factor * (M_across + q * product)
        # back in the frame of the shell
        squeezed = np.stack((cos * along - sin * across, sin * along + cos * across))
        by_p, by_q = squeezed.imag.swapaxes(0, 1) / _STEP
        slope = np.stack((by_p * cos - by_q * sin, by_p * sin + by_q * cos), axis=1)
        slope[0, 1] -= half_turning
        slope[1, 0] += half_turning
        return squeezed[:, 0].real + half_turning * np.stack((-y[1], y[0])), slope


def orbit_of(equation: FilmEquation, pieces: Pieces, largest: Array) -> Periodic:
    """Return the orbits. Heavy loads are raised to their size by factors of ten.

    largest (machines,): K |F|.
    """
    tens = np.ceil(np.log10(np.maximum(np.nan_to_num(largest) / _FROM_MIDDLE, 1.0)))
    equation.share = 10.0**-tens
    orbit = periodic(equation, pieces)
    while tens.any():
        is_heavy = tens > 0
        tens = np.maximum(tens - 1, 0.0)
        equation.share = 10.0**-tens
        orbit = followed(equation, orbit, is_heavy)
    return orbit


class FilmAtAngles(NamedTuple):
    """The film at y (2, n) under a load in N (n,), toward where it presses; columns in SI (n,)."""

    shape: FilmShape
    y: Array
    pressed: ComplexArray

    @property
    def eccentricity(self) -> Array:
        """|ε|."""
        distance = np.hypot(*self.y)
        return np.asarray(distance / np.hypot(1.0, distance))

    @property
    def thickness(self) -> Array:
        """c (1 − |ε|)."""
        square = self.y[0] ** 2 + self.y[1] ** 2
        return np.asarray(self.shape.clearance / ((1 + square) * (1 + self.eccentricity)))

    @property
    def direction(self) -> Array:
        """Direction of ε in degrees."""
        return np.asarray(np.degrees(np.arctan2(self.y[1], self.y[0])))

    @property
    def pressure(self) -> Array:
        """The largest pressure."""
        return self.shape.pressure(self.y, self.pressed)


class OilFilm(Results):
    """The oil film of one bearing over the cycle; key values in SI, of many machines (machines,).

    pressed: the load in N, seen from the shell, toward where it presses the journal; turning: τ,
    (nodes, pieces) each; omega: of the crank in rad/s. Of machines whose film does not repeat
    values are nan; of the only one there are none.
    """

    command = "bearings"
    shape_of = FilmShape.of_bearing
    film_thickness_min = value("h_0,min", "film", "Smallest thickness of the oil film")
    eccentricity_max = value("e_r,max", "ratio", "Largest eccentricity over the radial clearance")
    film_pressure_max = value("p_F,max", "pressure", "Largest pressure in the oil film")
    film_loss = value(
        "N_F",
        "power",
        "Mean friction power of the oil film as if it were full all round, an upper bound; not "
        "part of T and M",
    )
    side_flow = value(
        "q_F",
        "flow",
        "Mean flow that the film presses out of the ends, without that of the feed pressure",
    )

    def __init__(
        self,
        shape: FilmShape,
        pieces: Pieces,
        pressed: ComplexArray,
        turning: Array,
        omega: Any,
        count: int | None,
    ) -> None:
        self.shape = shape
        self._omega = omega
        self._count = count
        self._source = pieces
        self._course = np.stack((pressed.real, pressed.imag, turning))
        scaled = pieces.of(shape.mobility_number(omega)) * pressed
        equation = FilmEquation(shape, pieces, np.stack((scaled.real, scaled.imag, turning)))
        orbit = orbit_of(equation, pieces, pieces.largest(np.abs(scaled)))
        self.pieces = orbit.pieces
        self._failed = orbit.failed | (self.pieces.largest(orbit.samples).max(axis=0) > _FARTHEST)
        self.y = np.where(self.pieces.of(self._failed), 0.0, orbit.samples)

    @property
    def obstacle(self) -> str:
        """Why the only machine has no film, or an empty text."""
        if not self._failed[0]:
            return ""
        if np.isnan(self.shape.length):
            return "the groove leaves no land of the length of a rod"
        return "the load turns with the oil or never leaves its side; no film repeats"

    def at_angles(self, degrees: Array, pressed: ComplexArray) -> FilmAtAngles | None:
        """Return the film of the only machine, if it repeats.

        degrees: crank angles (n,); pressed: the load there, as in the class.
        """
        if self.obstacle:
            return None
        machine = np.zeros(len(degrees), dtype=np.intp)
        y = np.stack([self.pieces.at(part, machine, degrees) for part in self.y])
        return FilmAtAngles(self.shape, y, pressed)

    @cached_property
    def answers(self) -> ValuesById:
        """The key values by id."""
        if self._count is None and self.obstacle:
            return {}
        # the extremes
        parts = np.concatenate((self.y, self.pieces.resampled(self._course, self._source)))
        largest, degrees = highest(self.pieces, parts, self._peaks)
        square = largest[0]
        eccentricity = np.sqrt(square / (1 + square))
        thickness = self.shape.clearance / ((1 + square) * (1 + eccentricity))
        # the means
        fine, rates = refined(self.pieces, self._rates)
        loss, flow = fine.mean(np.asarray(rates))
        return {
            "film_thickness_min": self._extreme(thickness, degrees[0]),
            "eccentricity_max": self._extreme(eccentricity, degrees[0]),
            "film_pressure_max": self._extreme(largest[1], degrees[1]),
            "film_loss": self._result(loss),
            "side_flow": self._result(flow),
        }

    def _result(self, values: Array) -> Any:
        return result(np.where(self._failed, np.nan, values), self._count)

    def _extreme(self, values: Array, degrees: Array) -> Extreme:
        return Extreme(self._result(values), self._result(degrees))

    def _peaks(self, pieces: Pieces, parts: Array) -> tuple[Array, Array]:
        """Return |y|² and the largest pressure in Pa at the nodes of pieces."""
        y = parts[:2]
        pressed = parts[2] + 1j * parts[3]
        return y[0] ** 2 + y[1] ** 2, self.shape.of(pieces).pressure(y, pressed)

    def _rates(self, pieces: Pieces) -> tuple[Array, Array]:
        """Return friction power in W and side flow in m³/s at the nodes of pieces."""
        shape = self.shape.of(pieces)
        omega = pieces.of(self._omega)
        y = pieces.resampled(self.y, self.pieces)
        real, imaginary, turning = pieces.resampled(self._course, self._source)
        pressed = real + 1j * imaginary
        seen = along_load(y, pressed)
        along, across = mobility(seen.real, seen.imag, shape.lam, shape.finite)
        # the load moves with the velocity of the squeezed film
        load = np.abs(pressed)
        mobility_number = shape.mobility_number(omega)
        squeeze_speed = shape.clearance * omega * mobility_number * load
        squeezing = load * squeeze_speed * along
        # the oil is sheared all round, Couette's 2π/√(1 − ε²)
        radius = shape.diameter / 2
        sliding = radius * omega * turning
        round_the_film = 2 * np.pi * np.sqrt(1 + y[0] ** 2 + y[1] ** 2)
        shearing = shape.viscosity * sliding**2 * radius * shape.length / shape.clearance
        # the oil is squeezed out of the ends; of two lands half goes back into the groove
        shortness = 1.0 if shape.is_short else 1 / (1 + shape.lam**2 / 4)
        squeezed_out = shape.diameter * shape.length * squeeze_speed * np.hypot(along, across)
        flow = squeezed_out * shortness / shape.lands
        return squeezing + shearing * round_the_film, flow
