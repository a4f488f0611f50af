"""Oil films: figures of another solver, closed forms, a second integrator, planted errors."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from scipy.integrate import DOP853

from kurbel import sweep
from kurbel.errors import MachineFileError
from kurbel.machine.oil_film import OilFilms
from kurbel.machine_file import loads
from kurbel.numerics.pieces import NOWHERE, Pieces
from kurbel.solver.case import Case
from kurbel.solver.chapters import bearings, oil_film
from kurbel.solver.chapters.bearing import Bearing
from kurbel.solver.chapters.bearings import RodPin
from kurbel.solver.chapters.oil_film import FilmEquation, FilmShape, OilFilm
from representative import CONFIGS

FILMS: dict[str, Any] = {
    film["name"]: film
    for film in yaml.safe_load(
        Path(__file__).with_name("oil_films.yaml").read_text(encoding="utf-8")
    )
}
ENGINE, SHORT, GROOVED, COMPRESSOR = FILMS
TOLERANCE = 1e-9
"""Relative, of the figures."""
TOLERANCE_AT = 1e-4
"""Degrees, of the angle of an extreme."""


def text_of(name: str, **changes: Any) -> str:
    """Return the machine file of a film; changes: other values of its keys, None for none."""
    film = FILMS[name]
    machine = yaml.safe_load(CONFIGS[film["file"]].read_text(encoding="utf-8"))
    machine |= film.get("instead", {})
    machine["oil_film"] = without_gaps(film["oil_film"] | changes)
    return str(yaml.safe_dump(without_gaps(machine), sort_keys=False))


def without_gaps(keys: dict[str, Any]) -> dict[str, Any]:
    """Return the keys that have a value."""
    return {key: value for key, value in keys.items() if value is not None}


@cache
def bearings_of(text: str) -> dict[str, Bearing]:
    """Return the bearings of a machine by name."""
    return {bearing.name: bearing for bearing in Case(loads(text)).bearings.parts}


def misses(name: str, bearings: dict[str, Bearing]) -> list[str]:
    """Return the figures that the bearings of a machine do not have."""
    missed = []
    for figure in FILMS[name]["expect"]:
        bearing = bearings[figure["bearing"]]
        if "at" in figure:
            column = figure["id"]
            value = bearing.columns([figure["at"]], column)[column][0]
            degrees = None
        else:
            value, _, degrees, _ = bearing[figure["id"]]
        is_near = value == pytest.approx(figure["value"], rel=TOLERANCE)
        if "at_deg" in figure:
            is_near &= abs(degrees - figure["at_deg"]) <= TOLERANCE_AT
        if not is_near:
            missed.append(f"{figure['bearing']}: {figure['id']}")
    return missed


@pytest.mark.parametrize("name", FILMS)
def test_figures_of_an_independent_solver(name: str) -> None:
    assert misses(name, bearings_of(text_of(name))) == []


# the kernel

MOBILITIES = [
    # theory, ε, its angle from the load, L/D, M_ξ and M_η by mpmath
    ("finite", 0.0, 0.0, 0.5, 1.4430048173665178, 0.0),
    ("finite", 0.5, 30.0, 0.5, 0.38068611263074453, -0.19201811232866323),
    ("finite", 0.9, -20.0, 0.8, 0.014293946493682807, 0.02324559084071456),
    ("short", 0.95, 120.0, 0.25, 13.457059131674033, -9.557020026246787),
]
PEAKS = [
    # ε, its angle from the load, largest pressure of a short film over F/(L D) by mpmath
    (0.0, 0.0, 1.909859317102744),
    (0.5, 30.0, 2.7604955588236235),
    (0.9, -20.0, 6.660201663455662),
    (0.95, 120.0, 2.7102602296792986),
]
STEADY = [
    # L/D, ε, Sommerfeld number F (2c/D)²/(L D μ ω), angle from load to ε
    (0.25, 0.6, 0.15051794528611562, 47.42775740354538),
    (0.5, 0.9, 5.722488499769839, 25.977392747126462),
    (1.0, 0.95, 19.79220107965272, 24.862306468058083),
]


def shape(slenderness: float, theory: str = "finite") -> FilmShape:
    """Return a bearing with L = 1 m, in which K = 1/N at 1 rad/s."""
    diameter = 1 / slenderness
    return FilmShape(
        clearance=diameter / 2,
        diameter=diameter,
        length=1.0,
        viscosity=slenderness,
        is_short=theory == "short",
    )


def seen_from_load(eccentricity: float, degrees: float) -> complex:
    """Return p + iq, ε/√(1 − ε²) in the frame of the load."""
    turn = complex(math.cos(math.radians(degrees)), math.sin(math.radians(degrees)))
    return eccentricity / math.sqrt(1 - eccentricity**2) * turn


@pytest.mark.parametrize(
    ("theory", "epsilon", "angle", "slenderness", "along", "across"), MOBILITIES
)
def test_mobility(
    theory: str, epsilon: float, angle: float, slenderness: float, along: float, across: float
) -> None:
    seen = seen_from_load(epsilon, angle)
    bearing = shape(slenderness, theory)
    p, q = np.array(seen.real), np.array(seen.imag)
    mobilities = oil_film.mobility(p, q, bearing.lam, bearing.finite)
    assert mobilities == pytest.approx((along, across), rel=1e-13)


@pytest.mark.parametrize(("epsilon", "angle", "peak"), PEAKS)
def test_largest_pressure_of_a_short_film(epsilon: float, angle: float, peak: float) -> None:
    seen = np.array([seen_from_load(epsilon, angle)])
    assert oil_film.peak_factor(seen) == pytest.approx(peak, rel=1e-13)


def film_under(load: Callable[[np.ndarray], Any], turning: float, of_shape: FilmShape) -> OilFilm:
    """Return the film of a shaft with 1 rad/s under a load (n,) at crank angles in radians."""
    pieces = Pieces.between(NOWHERE, 1, 360.0)
    phi = np.radians(pieces.degrees)
    pressed = np.asarray(load(phi) + np.zeros_like(phi), complex)
    return OilFilm(of_shape, pieces, pressed, np.full_like(phi, turning), 1.0, None)


@pytest.mark.parametrize(("slenderness", "epsilon", "sommerfeld", "attitude"), STEADY)
def test_steady_load(
    slenderness: float, epsilon: float, sommerfeld: float, attitude: float
) -> None:
    """K F is the Sommerfeld number."""
    film = film_under(lambda phi: sommerfeld, 1.0, shape(slenderness))
    assert film.eccentricity_max.value == pytest.approx(epsilon, rel=1e-12)
    columns = film.at_angles(np.array([10.0]), np.array([sommerfeld + 0j]))
    assert columns
    assert columns.direction[0] == pytest.approx(attitude, abs=1e-9)


@pytest.mark.parametrize(
    ("ocvirk", "fitted"),
    [(0.3, 0.2990), (0.5, 0.4976), (0.7, 0.6975), (0.9, 0.8988), (0.95, 0.9494)],
)
def test_short_bearing_is_that_of_ocvirk_within_its_fit(ocvirk: float, fitted: float) -> None:
    """NACA TN 2808, a steady load: F = μ ω L³ R/(4 c²) · ε/(1 − ε²)² √(π² (1 − ε²) + 16 ε²)."""
    rest = 1 - ocvirk**2
    lam = 0.25
    load = ocvirk / rest**2 * math.sqrt(math.pi**2 * rest + 16 * ocvirk**2)
    # K F = F (2c/D)²/(μ L D ω)
    film = film_under(lambda phi: lam**2 / 2 * load, 1.0, shape(lam, "short"))
    assert film.eccentricity_max.value == pytest.approx(fitted, abs=5.1e-5)


@pytest.mark.parametrize(
    ("load", "gap"), [(1.0, 0.37794889757840894), (300.0, 0.009130088426614044)]
)
def test_squeezed_along_a_line(load: float, gap: float) -> None:
    """Nothing turns: (1 − ε)^(−3/2) − (1 + ε)^(−3/2) = 3 K F/(π λ²) after half a turn."""
    film = film_under(lambda phi: load * np.sin(phi), 0.0, shape(0.5, "short"))
    end = film.at_angles(np.array([180.0]), np.array([0j]))
    assert end
    assert end.eccentricity[0] == pytest.approx(1 - gap, rel=1e-12)
    closed = (1 - end.eccentricity[0]) ** -1.5 - (1 + end.eccentricity[0]) ** -1.5
    assert closed == pytest.approx(3 * load / (math.pi * 0.25), rel=1e-10)


def test_no_load_leaves_the_journal_in_the_middle() -> None:
    film = film_under(lambda phi: 0.0, 1.0, shape(0.5))
    assert film.film_thickness_min.value == film.shape.clearance
    assert film.film_pressure_max.value == 0.0
    # Petroff: μ (D/2)³ L ω² 2π/c
    radius = film.shape.diameter / 2
    petroff = film.shape.viscosity * radius**3 * 2 * math.pi / film.shape.clearance
    assert film.film_loss == pytest.approx(petroff, rel=1e-14)
    assert film.side_flow == 0.0


@pytest.mark.parametrize("size", [1e-5, 1e-2, 1e4, 1e8])
def test_orbits_from_hardly_any_load_to_the_wall(size: float) -> None:
    film = film_under(lambda phi: size * (1 + 0.5 * np.cos(phi)), 1.0, shape(0.5))
    assert not film.obstacle
    assert 0 < film.film_thickness_min.value < film.shape.clearance


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e4])
def test_a_load_that_turns_with_half_the_speed_has_no_film_that_repeats(size: float) -> None:
    """Seen from the oil it stands still and squeezes it out (The Tribology Handbook, A11.3)."""
    pieces = Pieces.between(NOWHERE, 1, 720.0)
    turning = size * np.exp(0.5j * np.radians(pieces.degrees))
    film = OilFilm(shape(0.5), pieces, turning, np.ones_like(turning.real), 1.0, None)
    assert "no film repeats" in film.obstacle
    assert film.film_thickness_min is None


# marched by a second integrator, in three frames

STEPS = 40
"""Of the Runge–Kutta method of order 8 on each smooth piece."""


def marched(bearing: Bearing, frame: str) -> tuple[np.ndarray, np.ndarray]:
    """Return crank angles, and ε seen from the shell, marched through a cycle in a frame.

    It starts at the orbit of the film.
    """
    film = bearing.film
    assert film
    K = film.shape.mobility_number(bearing.omega)

    # the angles of all steps and stages, and the load there
    nodes = DOP853.C[: DOP853.n_stages]
    ends = film.pieces.ends
    widths = np.repeat(np.diff(ends) / STEPS, STEPS)
    starts = np.concatenate(
        [low + width * np.arange(STEPS) for low, width in zip(ends, widths[::STEPS])]
    )
    degrees = starts[:, None] + nodes * widths[:, None]
    middles = np.broadcast_to(starts[:, None] + widths[:, None] / 2, degrees.shape)
    frames = bearing._frames(degrees.ravel(), middles.ravel())
    sign = -1.0 if bearing.of_rod else 1.0
    load = sign * K * frames[frame].reshape(degrees.shape)

    # how fast the frame turns, and how the shell is seen from it
    shell = {"crank_pin": "rod", "crosshead_pin": "rod", "journals": "engine"}[bearing.key]
    psi_slope = _swing(bearing, degrees) if bearing.of_rod else np.zeros_like(degrees)
    speed = {"throw": np.ones_like(degrees), "engine": np.zeros_like(degrees), "rod": -psi_slope}
    journal = {"crank_pin": 1.0, "crosshead_pin": 0.0, "journals": 1.0}[bearing.key]
    entrainment = 1j * ((journal + speed[shell]) / 2 - speed[frame])
    to_shell = frames[shell] / frames[frame]
    to_shell = to_shell.reshape(degrees.shape)[:, 0]

    y = film.at_angles(ends[:1], np.array([1.0 + 0j]))
    assert y
    start = complex(*y.y[:, 0]) / math.hypot(1.0, *y.y[:, 0]) / to_shell[0]
    return starts, _marched(start, load, entrainment, np.radians(widths), film.shape) * to_shell


def _swing(bearing: Bearing, degrees: np.ndarray) -> np.ndarray:
    """Return dψ/dφ."""
    mechanism = bearing.cylinders[0].drive.mechanism
    sin = mechanism.lam * np.sin(np.radians(degrees))
    return np.asarray(mechanism.lam * np.cos(np.radians(degrees)) / np.sqrt(1 - sin**2))


def _marched(
    epsilon: complex,
    load: np.ndarray,
    entrainment: np.ndarray,
    widths: np.ndarray,
    film_shape: FilmShape,
) -> np.ndarray:
    """Return ε at the starts of steps; load: K F, and entrainment, (steps, stages) each."""
    lam = film_shape.lam
    finite = film_shape.finite
    stages = DOP853.A
    weights = DOP853.B
    path = []
    for step, width in enumerate(widths.tolist()):
        path.append(epsilon)
        rates: list[complex] = []
        for stage in range(DOP853.n_stages):
            inner = epsilon + width * sum(a * rate for a, rate in zip(stages[stage], rates))
            force = complex(load[step, stage])
            size = abs(force)
            direction = force / size if size else 1.0
            seen = inner * complex(direction).conjugate()
            gap = 1 - seen.real
            along = gap**1.5 * (gap + 0.6 * finite) / (math.pi * lam**2)
            across = -4 * seen.imag * gap**0.5 * (gap + 0.28 * finite) / (math.pi * lam) ** 2
            squeeze = size * complex(along, across) * direction
            rates.append(squeeze + complex(entrainment[step, stage]) * inner)
        epsilon = epsilon + width * sum(b * rate for b, rate in zip(weights, rates))
    return np.array(path)


@pytest.mark.parametrize(
    ("name", "bearing", "frame"),
    [
        (ENGINE, "crank pin", "rod"),
        (ENGINE, "crank pin", "throw"),
        (ENGINE, "crosshead pin", "engine"),
        (ENGINE, "bearing A", "throw"),
        (GROOVED, "crank pin", "engine"),
        (COMPRESSOR, "crosshead pin", "rod"),
    ],
)
def test_orbit_by_a_second_integrator(name: str, bearing: str, frame: str) -> None:
    part = bearings_of(text_of(name))[bearing]
    degrees, epsilon = marched(part, frame)
    columns = part.columns(degrees, "eccentricity", "film_direction")
    orbit = columns["eccentricity"] * np.exp(1j * np.radians(columns["film_direction"]))
    assert np.abs(orbit - epsilon).max() <= 1e-10


# lands, rods, batches


def test_two_lands_are_two_bearings_of_half_the_load() -> None:
    """Of the oil that they squeeze out, half flows into the groove and stays in the bearing."""
    land = shape(0.4)
    both = land._replace(length=2 * land.length, lands=2)

    def load(phi: np.ndarray) -> np.ndarray:
        return 3 + np.exp(1j * phi)

    half = film_under(load, 1.0, land)
    whole = film_under(lambda phi: 2 * load(phi), 1.0, both)
    assert whole.film_thickness_min.value == pytest.approx(half.film_thickness_min.value, rel=1e-12)
    assert whole.film_pressure_max.value == pytest.approx(half.film_pressure_max.value, rel=1e-12)
    assert whole.film_loss == pytest.approx(2 * half.film_loss, rel=1e-12)
    assert whole.side_flow == pytest.approx(half.side_flow, rel=1e-12)


VEE = """
speed: 1800 rpm
cycle: four-stroke
crankshaft: {a: 60 mm, b: 60 mm, web_distance: 30 mm, web_thickness: 15 mm, web_width: 60 mm,
             pin_diameter: 50 mm, pin_length: 40 mm, journal_diameter: 55 mm, journal_length: 24 mm}
cylinders:
  count: 2
  bank_angles: [0 deg, 90 deg]
  each:
    crank: 45 mm
    rod: 150 mm
    bore: 90 mm
    indicator: {head_end: {diesel: {intake: 0 bar, compression_ratio: 18, cut_off: 0.06}}}
    masses: {piston: 1.2 kg, rotating: 0.9 kg, connecting_rod: {mass: 2 kg, share: 0.4}}
oil_film: {viscosity: 15 mPa s, crank_pin: {clearance: 25 um}}
"""


def thinnest(text: str, bearing: str = "crank pin") -> float:
    return float(bearings_of(text)[bearing].film_thickness_min.value)


def test_two_rods_on_a_pin_have_half_its_length_each() -> None:
    name = "crank pin of cylinder 2"
    of_half = VEE.replace("25 um", "25 um, length: 20 mm")
    of_whole = VEE.replace("25 um", "25 um, length: 40 mm")
    assert thinnest(VEE, name) == thinnest(of_half, name)
    assert thinnest(of_whole, name) > 1.5 * thinnest(VEE, name)


def test_many_machines_are_as_one_by_one(tmp_path: Path) -> None:
    file = tmp_path / "engine.yaml"
    viscosities = ["0.3 mPa s", "30 mPa s", "10 Pa s"]
    ids = ("film_thickness_min", "film_pressure_max", "film_loss", "side_flow")
    file.write_text(text_of(ENGINE), encoding="utf-8")
    rows = sweep(file, {"oil_film.viscosity": viscosities}, ids)
    for row, viscosity in enumerate(viscosities):
        alone = bearings_of(text_of(ENGINE, viscosity=viscosity))
        for name, bearing in alone.items():
            for id in ids:
                assert rows[f"{name}.{id}"][row] == pytest.approx(bearing[id].value, rel=1e-9)


# what is left out, and what is refused


def test_without_a_speed_there_is_no_film() -> None:
    text = text_of(ENGINE).replace("speed: 200 rpm\n", "")
    bearing = bearings_of(text)["crank pin"]
    assert bearing.film is None
    assert bearing.film_obstacle == "no speed given"
    assert bearing.at([0.0]).eccentricity is None


def test_a_bearing_without_sizes_has_no_film_and_one_that_is_not_named_none_either() -> None:
    text = text_of(ENGINE, crosshead_pin={"clearance": "0.06 mm"}, journals=None)
    parts = bearings_of(text)
    assert parts["crosshead pin"].film_obstacle == "no diameter and length given"
    assert parts["bearing A"].film is None
    assert parts["bearing A"].film_obstacle == ""


def test_a_machine_without_the_key_leaves_nothing_out() -> None:
    text = CONFIGS["waterworks"].read_text(encoding="utf-8")
    for bearing in bearings_of(text).values():
        assert (bearing.film, bearing.film_obstacle) == (None, "")


def test_a_groove_as_wide_as_the_shell_of_a_rod_leaves_no_film() -> None:
    bearing = bearings_of(VEE.replace("25 um", "25 um, groove: 20 mm"))["crank pin of cylinder 1"]
    assert bearing.film_obstacle == "the groove leaves no land of the length of a rod"
    assert bearing.film_thickness_min is None
    assert bearing.at([0.0]).film_thickness is None


REFUSED = [
    ({"crank_pin": None, "crosshead_pin": None, "journals": None}, "give 'crank_pin'"),
    ({"viscosity": None}, "'crank_pin' needs a 'viscosity'"),
    ({"viscosity": "100 mm2/s"}, "100 mm2/s · 0.88 kg/dm3 = 88 mPa s"),
    ({"crank_pin": {"clearance": "11 mm"}}, "a radial clearance of 11 mm is too much"),
    (
        {"crank_pin": {"clearance": "0.1 mm", "diameter": "210 mm"}},
        "'pin_diameter' in 'crankshaft' gives the same",
    ),
    (
        {"crank_pin": {"clearance": "0.1 mm", "length": "170 mm"}},
        "170 mm is longer than the pin (160 mm by 'pin_length' in 'crankshaft')",
    ),
    (
        {"journals": {"clearance": "0.1 mm", "groove": "320 mm"}},
        "a groove of 320 mm leaves no land of a length of 320 mm",
    ),
    (
        {"journals": {"clearance": "0.1 mm", "diametral_clearance": "0.2 mm"}},
        "'clearance' and 'diametral_clearance' mean the same",
    ),
    ({"temperature": "70 °C"}, "give the 'viscosity' at that temperature"),
    ({"theory": "long"}, "'finite' or 'short'"),
]


@pytest.mark.parametrize(("changes", "message"), REFUSED)
def test_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(MachineFileError) as error:
        loads(text_of(ENGINE, **changes))
    assert message in str(error.value)


def test_diametral_clearance_is_twice_the_radial_one() -> None:
    text = text_of(ENGINE, crank_pin={"diametral_clearance": "0.2 mm"})
    assert thinnest(text) == thinnest(text_of(ENGINE))


# errors that the figures catch

Wrong = Callable[..., Any]


def plain_turning(bearing: RodPin) -> np.ndarray:
    return np.ones_like(bearing._common.degrees)


def twice_entrained(equation: FilmEquation, pieces: Pieces) -> np.ndarray:
    known = pieces.resampled(equation._course, equation._pieces)
    return known * np.array([1.0, 1.0, 2.0])[:, None, None]


def seen_from_the_throw(bearing: Bearing) -> tuple[Pieces, np.ndarray, np.ndarray]:
    pieces, size, surfaces = bearings.with_magnitude(bearing._common, bearing._samples())
    return pieces, size, surfaces[::-1]


def mean_of_first_turn(pieces: Pieces, values: np.ndarray) -> np.ndarray:
    is_first = pieces.middle < 360.0
    return pieces.integral(np.where(is_first, values, 0.0)) / (2 * math.pi)


RATES = OilFilm._rates
NUMBER = FilmShape.mobility_number
LAM = FilmShape.lam.fget
assert LAM


def without_groove(films: OilFilms, key: str, diameter: float, length: float) -> FilmShape:
    bearing = films.bearings[key]
    right = FilmShape.of_bearing(films, key, diameter, length)
    return right._replace(length=right.length + bearing.groove, lands=1)


def flow_of_both_sides(film: OilFilm, pieces: Pieces) -> tuple[np.ndarray, np.ndarray]:
    loss, flow = RATES(film, pieces)
    return loss, flow * film.shape.lands


PLANTED: dict[str, tuple[str, object, str, object, float | None]] = {
    # film, where, its name, the wrong one, thinnest film in µm with it
    "the rod does not turn": (ENGINE, RodPin, "_turning", plain_turning, 13.983),
    "whole speed": (ENGINE, FilmEquation, "known", twice_entrained, 10.051),
    "diametral": (
        ENGINE,
        FilmShape,
        "mobility_number",
        lambda of, omega: 4 * NUMBER(of, omega),
        3.153,
    ),
    "radius": (ENGINE, FilmShape, "mobility_number", lambda of, omega: NUMBER(of, omega) / 4, 34.8),
    "frame of the throw": (ENGINE, Bearing, "_cycle", property(seen_from_the_throw), 21.5),
    "λ for λ²": (ENGINE, FilmShape, "lam", property(lambda of: LAM(of) ** 0.5), 14.66),
    "contact": (ENGINE, RodPin, "contact", 0.0, None),
    "groove": (GROOVED, OilFilm, "shape_of", staticmethod(without_groove), 7.448),
    "flow out of both sides": (GROOVED, OilFilm, "_rates", flow_of_both_sides, None),
    "mean of 360°": (ENGINE, Pieces, "mean", mean_of_first_turn, None),
}


@pytest.mark.parametrize("error", PLANTED)
def test_figures_catch(error: str, monkeypatch: pytest.MonkeyPatch) -> None:
    name, owner, attribute, wrong, thickness = PLANTED[error]
    monkeypatch.setattr(owner, attribute, wrong)
    parts = {part.name: part for part in Case(loads(text_of(name))).bearings.parts}
    assert misses(name, parts)
    if thickness is not None:
        micrometres = 1e6 * parts["crank pin"].film_thickness_min.value
        assert micrometres == pytest.approx(thickness, rel=2e-3)


def test_figures_catch_constants_that_are_swapped(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(oil_film, "_ALONG", 0.28)
    monkeypatch.setattr(oil_film, "_ACROSS", 0.6)
    parts = {part.name: part for part in Case(loads(text_of(ENGINE))).bearings.parts}
    assert 1e6 * parts["crank pin"].film_thickness_min.value == pytest.approx(18.6, rel=2e-3)
