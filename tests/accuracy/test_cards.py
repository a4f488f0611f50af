"""Cards as processes, the references of ideal cards: areas by closed forms, and kurbel on shipped machines."""

import mpmath
import pytest

from kurbel import loads
from kurbel.accuracy.cards import CardProcess, drawn
from kurbel.accuracy.methods import mp
from kurbel.accuracy.references import Textbook
from kurbel.accuracy.textbook import DIGITS
from kurbel.machine.ideal_cards import Compressor, Diesel, Otto, Steam
from kurbel.solver.case import Case

mpf = mpmath.mpf


def area(drawing: CardProcess) -> mpmath.mpf:
    """Work over the stroke volume: the integral of p by z, forward and back."""
    return sum(
        mp.quad(lambda z, line=line: drawing.at(line, z), [line.begin, line.end])
        for line in drawing.lines
    )


def polytrope(
    pressure: float, volume: mpmath.mpf, next_volume: mpmath.mpf, n: mpmath.mpf
) -> mpmath.mpf:
    """Work of p V^n from one volume to another."""
    return mpf(pressure) * volume * (1 - (volume / next_volume) ** (n - 1)) / (n - 1)


def test_otto() -> None:
    card = Otto(intake=1e5, peak=25e5, clearance=0.2, exponent=1.35, expansion_exponent=1.3)
    small, large = mpf(0.2), 1 + mpf(0.2)
    work = polytrope(25e5, small, large, mpf(1.3)) + polytrope(1e5, large, small, mpf(1.35))
    assert float(area(drawn(card, 0, False)) / work) == pytest.approx(1, abs=1e-14)


def test_diesel_of_four_strokes_and_diagram_factor() -> None:
    """The strokes that change the gas take the difference of their pressures."""
    words = {
        "intake": 1e5,
        "exhaust": 1.1e5,
        "clearance": 0.07,
        "exponent": 1.4,
        "expansion_exponent": 1.3,
    }
    card = Diesel(**words, peak=50e5, cut_off=0.05)
    small, cut_off, large = mpf(0.07), mpf(0.05) + mpf(0.07), 1 + mpf(0.07)
    burning = mpf(50e5) * mpf(0.05) + polytrope(50e5, cut_off, large, mpf(1.3))
    work = burning + polytrope(1e5, large, small, mpf(1.4)) + mpf(1e5) - mpf(1.1e5)
    assert float(area(drawn(card, 0, True)) / work) == pytest.approx(1, abs=1e-14)
    lowered = Diesel(**words, peak=50e5, cut_off=0.05, diagram_factor=0.9)
    assert float(area(drawn(lowered, 0, True)) / work) == pytest.approx(0.9, abs=1e-14)


def test_compressor_opens_its_valves_where_the_curves_meet() -> None:
    """W = n/(n − 1) p₁ V_s (r^((n−1)/n) − 1) for one exponent, V_s the volume that is drawn in."""
    card = Compressor(suction=1e5, delivery=6e5, clearance=0.07, exponent=1.3)
    n, c, ratio = mpf(1.3), mpf(0.07), mpf(6)
    drawn_in = 1 + c - c * ratio ** (1 / n)
    work = -n / (n - 1) * mpf(1e5) * drawn_in * (ratio ** ((n - 1) / n) - 1)
    assert float(area(drawn(card, 0, False)) / work) == pytest.approx(1, abs=1e-14)


def test_steam_against_a_hyperbola() -> None:
    card = Steam(admission=8e5, exhaust=0.1e5, cut_off=0.3, clearance=0.05, compression=0.2)
    high, low, c = mpf(8e5), mpf(0.1e5), mpf(0.05)
    expansion = high * (mpf(0.3) + c) * mp.log((1 + c) / (mpf(0.3) + c))
    compression = low * (mpf(0.2) + c) * mp.log((mpf(0.2) + c) / c)
    work = high * mpf(0.3) + expansion - low * mpf(0.8) - compression
    assert float(area(drawn(card, 0, False)) / work) == pytest.approx(1, abs=1e-14)


ENGINE = """
{speed: 60 rpm, crank: 400 mm, rod: 2000 mm, bore: 450 mm, crank_end_rod: 80 mm, indicator: {head_end: {steam:
 {admission: 8 bar, exhaust: 0.2 bar, cut_off: 0.3, clearance: 0.06, compression: 0.2, lead: 0.01, release: 0.9}},
 crank_end: mirrored}}
"""


def test_kurbel_has_the_work_of_both_ends() -> None:
    with mp.workdps(DIGITS):
        work = Textbook(loads(ENGINE)).reference("A_i")
    assert Case(loads(ENGINE)).cylinders[0].work == pytest.approx(float(work), rel=4e-15)
