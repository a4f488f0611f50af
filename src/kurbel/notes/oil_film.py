"""Warnings on oil films: too thin, under too much pressure, and of sizes that were not checked."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from kurbel.declared.unit_systems import show, show_range
from kurbel.solver.case import Case
from kurbel.solver.chapters.bearing import Bearing
from kurbel.solver.chapters.oil_film import FilmShape

_THINNEST = {"crank_pin": 2.0e-6, "journals": 2.5e-6}
"""Key -> the thinnest computed film in m that is known to run well (Tribology Handbook, A11.4)."""
_WHITE_METAL = 14e6
"""Largest load over d l in Pa of tin white metal (The Tribology Handbook, A11.2)."""
_CLEARANCES = (1 / 5000, 1 / 200)
"""Usual diametral clearances over the diameter."""
_SLENDER = (1 / 8, 1.6)
"""L/D of one land within which the films were compared with solutions of Reynolds' equation."""


def film_warnings(case: Case) -> Iterator[str]:
    """Yield what looks wrong in the oil films; of bearings with one key in the thinnest film."""
    films = case.machine.oil_film
    if films is None:
        return
    for key in films.bearings:
        bearings = [
            bearing
            for bearing in case.bearings.parts
            if bearing.key == key and bearing.film and bearing.film_thickness_min is not None
        ]
        if bearings:
            yield from _of_equal_bearings(key, bearings, case)


def _of_equal_bearings(key: str, bearings: Sequence[Bearing], case: Case) -> Iterator[str]:
    thinnest = min(bearings, key=lambda bearing: bearing.film_thickness_min.value)
    assert thinnest.film
    yield from _of_shape(f"oil_film.{key}", thinnest.film.shape)

    # the results
    thickness = thinnest.film_thickness_min
    if thickness.value < _THINNEST.get(key, 0.0):
        yield (
            f"{thinnest.name}: the oil film of {show(thickness.value, 'film', 3)} at "
            f"{thickness.degrees:.4g}° is thinner than any computed one that is known to run well "
            f"(big ends {show_range(2e-6, 4e-6, 'film')}, "
            f"main bearings {show_range(2.5e-6, 4.2e-6, 'film')}; The Tribology Handbook, A11.4: "
            "a guide for comparison, no proof)"
        )
    shaft = case.machine.crankshaft
    loaded = [bearing for bearing in bearings if bearing.pressure_max is not None]
    is_white_metal = shaft is not None and shaft.bearing_metal == "white-metal"
    if not is_white_metal or key == "crosshead_pin" or not loaded:
        return
    heaviest = max(loaded, key=lambda bearing: bearing.pressure_max.value)
    pressure = heaviest.pressure_max.value
    if pressure > _WHITE_METAL:
        yield (
            f"{heaviest.name}: a load of {show(pressure, 'stress', 3)} over d l is more than the "
            f"guidance limit of tin white metal, {show_range(12e6, 14e6, 'stress')}, "
            f"of linings up to {show(1e-4, 'length', 3)} {show_range(14e6, 17e6, 'stress')} "
            "(The Tribology Handbook, A11.2)"
        )


def _of_shape(key: str, shape: FilmShape) -> Iterator[str]:
    """Yield doubts on clearance and length of the bearings with a key."""
    relative = 2 * shape.clearance / shape.diameter
    narrow, wide = _CLEARANCES
    if not narrow <= relative <= wide:
        yield (
            f"{key}: a radial clearance of {show(shape.clearance, 'length', 3)} makes 2c/D = "
            f"1/{1 / relative:.0f}; usual is about 1/1000 (MAHLE: 0.001 in per inch): is it the "
            "diametral one, or another unit?"
        )
    short, long = _SLENDER
    if not short <= shape.lam <= long:
        yield (
            f"{key}: L/D = {shape.lam:.3g} of a land is not within 1/8 to 1.6, where oil films "
            "were compared with Reynolds' equation"
        )
