"""The oil film of pins and main bearings: `oil_film` of the machine file."""

from __future__ import annotations

import functools
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kurbel.arrays import Number
from kurbel.declared.record import Record, Rule, alternative, field
from kurbel.machine.parts import Friction

if TYPE_CHECKING:
    from kurbel.machine.crankshaft import Crankshaft

_WIDEST = 1 / 20
"""Radial clearance over diameter from which on the formulas of a thin film do not hold."""


class PinDimension(NamedTuple):
    """A diameter or length of a pin in m, and the key and record that give it."""

    value: Number
    key: str
    record: str


_ELSEWHERE = {
    "crank_pin": ("crank_pin_diameter", "pin_diameter", "", "pin_length"),
    "crosshead_pin": ("crosshead_pin_diameter", "", "crosshead_pin_length", ""),
    "journals": ("journal_diameter", "journal_diameter", "", "journal_length"),
}
"""Key -> keys of the diameter in `friction` and `crankshaft`, and of the length in both, or ''."""


_WARM = (
    "give the 'viscosity' at that temperature, such as '20 mPa s', which oils of ISO VG 100 have "
    "at about 75 °C"
)
_NO_KEYS = dict.fromkeys(("temperature", "oil_temperature", "grade", "oil"), _WARM)
"""Words that people try -> what to write instead."""


class FilmBearing(Record):
    """The bearing of a pin or of all journals; lengths in m, viscosity in Pa s."""

    UNWRITTEN = _NO_KEYS

    clearance: float = field(
        "length",
        "Radial clearance: half the difference of the diameters of shell and pin",
        "c",
        above=0,
        example="0.1 mm",
    )
    _diametral_clearance = alternative(
        "length",
        "Difference of the diameters of shell and pin, twice the radial clearance",
        "2c",
        above=0,
        instead="clearance",
        example="0.2 mm",
        gives=lambda keys: {"clearance": keys["diametral_clearance"] / 2},
        usual="about 1/1000 of the diameter",
    )
    diameter: float | None = field(
        "length",
        "Diameter of the pin or journal",
        "D",
        above=0,
        absent="that of `crankshaft` or `friction`",
        example="210 mm",
    )
    length: float | None = field(
        "length",
        "Width of the shell of one rod, or of one main bearing",
        "L",
        above=0,
        absent="that of the pin, over the number of rods on it, or of the journal",
        example="160 mm",
    )
    groove: float | None = field(
        "length",
        "Width of a groove all round in the middle of the shell",
        "g",
        above=0,
        absent="none",
        example="10 mm",
    )
    viscosity: float | None = field(
        "viscosity",
        "Dynamic viscosity of the oil in the film, at its temperature there",
        "μ",
        above=0,
        absent="that of `oil_film`",
    )


class OilFilms(Record):
    """What oil there is between pins and shells; a pin or bearing that is not named has no film."""

    UNWRITTEN = _NO_KEYS

    viscosity: float | None = field(
        "viscosity",
        "Dynamic viscosity of the oil in the film, at its temperature there",
        "μ",
        above=0,
        absent="each bearing has its own",
    )
    crank_pin: FilmBearing | None = field(
        FilmBearing, "Bearing of each connecting rod on its crank pin", absent="no film there"
    )
    crosshead_pin: FilmBearing | None = field(
        FilmBearing, "Bearing of each connecting rod on its crosshead pin", absent="no film there"
    )
    journals: FilmBearing | None = field(
        FilmBearing, "Main bearings, all alike", absent="no film there"
    )
    theory: str = field(
        ("finite", "short"),
        "Mobility of a film of finite length, or of a short bearing to compare with books: its "
        "films are too thick",
        default="finite",
        absent="finite",
    )

    @property
    def bearings(self) -> dict[str, FilmBearing]:
        """The bearings that have a film, by key."""
        bearings = {
            "crank_pin": self.crank_pin,
            "crosshead_pin": self.crosshead_pin,
            "journals": self.journals,
        }
        return {key: bearing for key, bearing in bearings.items() if bearing is not None}

    def rules(self) -> Iterator[Rule]:
        yield Rule((), not self.bearings, "give 'crank_pin', 'crosshead_pin' or 'journals'")
        for key, bearing in self.bearings.items():
            has_none = bearing.viscosity is None and self.viscosity is None
            needed = f"'{key}' needs a 'viscosity', here or in 'oil_film', such as '30 mPa s'"
            yield Rule(key, has_none, needed)

    def rules_beside(
        self, shaft: Crankshaft | None, frictions: Iterable[Friction | None]
    ) -> Iterator[Rule]:
        """Yield the rules on sizes of bearings, which `crankshaft` or `friction` may give."""
        records: list[tuple[str, Record]] = [
            ("friction", friction) for friction in frictions if friction
        ]
        if shaft:
            records.append(("crankshaft", shaft))
        for key, bearing in self.bearings.items():
            in_friction, in_shaft, length_in_friction, length_in_shaft = _ELSEWHERE[key]
            diameters = list(_sizes_in(records, in_friction, in_shaft))
            lengths = list(_sizes_in(records, length_in_friction, length_in_shaft))
            for rule in _rules_of(bearing, diameters, lengths):
                yield rule.below(key)


def _sizes_in(
    records: Iterable[tuple[str, Record]], in_friction: str, in_shaft: str
) -> Iterator[PinDimension]:
    """Yield the sizes with these keys that records give."""
    keys = {"friction": in_friction, "crankshaft": in_shaft}
    for name, record in records:
        key = keys[name]
        size = vars(record)[key] if key else None
        if size is not None:
            yield PinDimension(size, key, name)


def _rules_of(
    bearing: FilmBearing, diameters: list[PinDimension], lengths: list[PinDimension]
) -> Iterator[Rule]:
    """Yield the rules on a bearing whose pin has these sizes elsewhere."""
    for size in diameters[:1]:
        same = f"'{size.key}' in '{size.record}' gives the same; leave one of them out"
        yield Rule("diameter", bearing.diameter is not None, same)
    for size in lengths:
        if bearing.length is not None:
            longer = "{length:length} is longer than the pin ({pin:length} by '%s' in '%s')"
            numbers = {"length": bearing.length, "pin": size.value}
            sentence = longer % (size.key, size.record)
            yield Rule("length", bearing.length > size.value, sentence, numbers)

    diameter: Number | None = bearing.diameter
    if diameter is None and diameters:
        diameter = diameters[0].value
    if diameter is not None:
        wide = (
            "a radial clearance of {clearance:length} is too much for a diameter of "
            "{diameter:length}; usual is about 1/2000 of it"
        )
        numbers = {"clearance": bearing.clearance, "diameter": diameter}
        yield Rule("clearance", bearing.clearance >= _WIDEST * diameter, wide, numbers)
    length: Number | None = bearing.length
    if length is None and lengths:
        length = functools.reduce(np.minimum, [size.value for size in lengths])
    if bearing.groove is not None and length is not None:
        numbers = {"groove": bearing.groove, "length": length}
        no_land = "a groove of {groove:length} leaves no land of a length of {length:length}"
        yield Rule("groove", bearing.groove >= length, no_land, numbers)
