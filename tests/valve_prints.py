"""Valve gears in print, 1859 to 1892: what each source gives, what it prints, and which figure of kurbel it is.

The test of these figures and the page of validation both read them here. All of Dingler's Polytechnisches Journal is in
the repository deutschestextarchiv/dingler; Bourne's Catechism is Gutenberg 10998.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import kurbel
from kurbel.solver.forces import CylinderForces

Of = Callable[[CylinderForces], float]


class Print(NamedTuple):
    """A printed figure: of what, the valve and the crank as lines of a machine file, and what of the results it is.

    tolerance: half a unit of its last digit, or how well the source reads its drawing; why: what the source does
    otherwise where the figure differs by more.
    """

    source: str
    of: str
    valve: str
    figure: Of
    printed: str
    unit: str
    tolerance: float
    crank: str = "crank: 300 mm, rod: infinite"
    why: str = ""

    @property
    def computed(self) -> float:
        """The figure of kurbel."""
        return self.figure(kurbel.solve(f"{{{self.crank}, valve: {{{self.valve}}}}}").cylinders[0])

    @property
    def agrees(self) -> bool:
        """Whether the print is right, as far as it can be read."""
        return abs(self.computed - float(self.printed)) <= self.tolerance


def key(id: str, scale: float = 1.0) -> Of:
    """Return a key value over a scale."""
    return lambda results: float(results[id].value) / scale


def angle(id: str) -> Of:
    """Return the crank angle of an event."""
    return lambda results: float(results[id].degrees or 0.0)


def mean(event: str) -> Of:
    """Return the mean of an event at both ends."""
    return lambda results: (
        float(results[f"{event}_head"].value + results[f"{event}_crank"].value) / 2
    )


def rest(id: str) -> Of:
    """Return what part of the stroke the piston has passed where a key value counts the rest, in percent."""
    return lambda results: 100 - 100 * float(results[id].value)


def percent(id: str) -> Of:
    return lambda results: 100 * float(results[id].value)


def _fuhst() -> list[Print]:
    """Link motion by notches; he reads the compression from his diagram, which the steam lap does not change."""
    prints = []
    printed = {
        "open": ("S. 323", ("0.60", "0.40", "0.26", "0.17", "0.10")),
        "crossed": ("S. 327", ("0.650", "0.385", "0.210", "0.130", "0.100")),
    }
    for rods, (page, figures) in printed.items():
        for notch, figure in enumerate(figures):
            valve = (
                "eccentricity: 60 mm, steam_lap: 24 mm, exhaust_lap: 7 mm, angle_of_advance: 30 deg, "
                f"eccentric_rod: 1400 mm, link: {{half_length: 150 mm, position: {notch}/4, rods: {rods}}}"
            )
            of = f"{rods} rods, notch {notch}: compression"
            source = f"Fuhst, Dingler 154 (1859), {page}"
            prints.append(
                Print(
                    source,
                    of,
                    valve,
                    key("compression_head"),
                    figure,
                    "",
                    0.018,
                    why="read off a diagram",
                )
            )
    return prints


def _watzka() -> list[Print]:
    """An eccentric that is set across the shaft in a slot: A = 16.5 lines stays, and the lead is 2 lines."""
    prints = []
    slots = (
        ("35°37′", 35 + 37 / 60, "0.7", "13.9", ""),
        ("48°41′", 48 + 41 / 60, "0.5", "7.5", ""),
        ("62°26′", 62 + 26 / 60, "0.40", "4.1", "misprint; 0.30 with this slot"),
    )
    source = "Watzka, Dingler 179 (1866), S. 174"
    for slot, degrees, cut_off, opening, why in slots:
        r = 16.5 / math.sin(math.radians(degrees))
        valve = f"eccentricity: {r!r} mm, steam_lap: 14.5 mm, angle_of_advance: {degrees!r} deg"
        of_cut_off = f"slot {slot}: cut-off"
        prints.append(
            Print(source, of_cut_off, valve, key("cut_off_head"), cut_off, "", 0.0005, why=why)
        )
        wide = "rounded up" if opening == "13.9" else ""
        of_opening = f"slot {slot}: opening"
        prints.append(
            Print(
                source,
                of_opening,
                valve,
                key("opening_head", 1e-3),
                opening,
                "lines",
                0.05,
                why=wide,
            )
        )
    return prints


def _bochkoltz() -> list[Print]:
    """Ratios of the eccentricity: S = ⅔ r, E = r/10, δ = 60°; percent of the stroke."""
    valve = "eccentricity: 60 mm, steam_lap: 40 mm, exhaust_lap: 6 mm, angle_of_advance: 60 deg"
    figures = (
        ("cut-off", percent("cut_off_head"), "40", 0.5),
        ("compression", rest("compression_head"), "70", 0.6),
        ("release", percent("release_head"), "79", 0.5),
        ("admission", rest("admission_head"), "97.5", 0.05),
    )
    source = "Bochkoltz, Dingler 195 (1870), S. 10"
    return [
        Print(source, of, valve, figure, printed, "%", within)
        for of, figure, printed, within in figures
    ]


def _mueller_melchiors() -> list[Print]:
    """A 25, S 20, B by notches; the third and second are read off his diagram."""
    prints = []
    for B, printed in ((0, "10"), (13, "33"), (27, "60"), (43, "80")):
        valve = f"eccentricity: {math.hypot(25, B)!r} mm, steam_lap: 20 mm, lead: 5 mm"
        source = "Müller-Melchiors, Dingler 219 (1876), S. 5"
        why = "read off a diagram"
        prints.append(
            Print(
                source,
                f"B = {B}: cut-off",
                valve,
                percent("cut_off_head"),
                printed,
                "%",
                2.4,
                why=why,
            )
        )
    return prints


_TRIANGLE = "travel: 80 mm, steam_lap: 20 mm, lead: 0 mm"
_BOURNE = "travel: 4.125 in, steam_lap: 1 in, exhaust_lap: 0.125 in, lead: 0.25 in"
_FRANKFURT = "eccentricity: 25.5 mm, steam_lap: 13.5 mm, exhaust_lap: -1 mm, lead: 4.5 mm"
_RADIAL = "of a radial gear, whose ends differ less"

PRINTS = (
    *_fuhst(),
    Print(
        "Fuhst, Dingler 151 (1859), S. 243",
        "r = 2 S, no lead, L/R = 5: crank at cut-off",
        _TRIANGLE,
        angle("cut_off_head"),
        "120",
        "°",
        0.5,
        "crank: 300 mm, rod_ratio: 5",
    ),
    Print(
        "Fuhst, Dingler 151 (1859), S. 243",
        "the same: cut-off, head end",
        _TRIANGLE,
        key("cut_off_head"),
        "0.8",
        "",
        0.05,
        "crank: 300 mm, rod_ratio: 5",
    ),
    *_watzka(),
    *_bochkoltz(),
    *_mueller_melchiors(),
    Print(
        "Bourne, Catechism, Q. 190, 661",
        "cut-off by his rule S = r √(1 − x) − v/2",
        _BOURNE,
        key("cut_off_head"),
        "0.7025",
        "",
        0.00005,
        why="half the lead for the small angle of the lead",
    ),
    Print(
        "Bourne, Catechism, Q. 191",
        "compression by his rule, with cosine for his sine",
        _BOURNE,
        key("compression_head"),
        "0.1214",
        "",
        0.00005,
    ),
    Print(
        "Bourne, Catechism, Q. 192",
        "release before the end, with half the stroke for his stroke",
        _BOURNE,
        lambda results: 1 - float(results["release_head"].value),
        "0.0847",
        "",
        0.00005,
    ),
    Print(
        "Frankfurt 1891, Dingler 283 (1892), S. 179",
        "opening to steam",
        _FRANKFURT,
        key("opening_head", 1e-3),
        "12",
        "mm",
        0.5,
        "crank: 300 mm, rod_ratio: 4.5",
    ),
    Print(
        "Frankfurt 1891, Dingler 283 (1892), S. 179",
        "exhaust lead",
        _FRANKFURT,
        key("exhaust_lead_head", 1e-3),
        "18.5",
        "mm",
        0.51,
        "crank: 300 mm, rod_ratio: 4.5",
        _RADIAL,
    ),
    Print(
        "Frankfurt 1891, Dingler 283 (1892), S. 179",
        "release, mean of both ends",
        _FRANKFURT,
        mean("release"),
        "0.8375",
        "",
        0.003,
        "crank: 300 mm, rod_ratio: 4.5",
        _RADIAL,
    ),
    Print(
        "Frankfurt 1891, Dingler 283 (1892), S. 179",
        "compression, mean of both ends",
        _FRANKFURT,
        mean("compression"),
        "0.1275",
        "",
        0.006,
        "crank: 300 mm, rod_ratio: 4.5",
        _RADIAL,
    ),
    Print(
        "Frankfurt 1891, Dingler 283 (1892), S. 179",
        "cut-off, mean of both ends",
        _FRANKFURT,
        mean("cut_off"),
        "0.55",
        "",
        0.07,
        "crank: 300 mm, rod_ratio: 4.5",
        _RADIAL,
    ),
)
