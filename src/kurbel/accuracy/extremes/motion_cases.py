"""Motion: rods from infinite to just longer than the crank, offsets to their limit, lengths and angles of any size."""

from collections.abc import Iterator
from decimal import Decimal
from functools import partial

from kurbel.accuracy.decimals import pi, sin_cos
from kurbel.accuracy.extremes import Absent, Oracle, Probe, Refusal

_SHORT, _LONG = 0.1, 0.4
_CRANK = "{speed: 60 rpm, crank: 400 mm, "
_RATIOS = ("1e15", "1e14", "1e12", "1e6", "5", "1.01", "1.000001", "1.000000000001", "1.0000000000000002")
_ASKED = (("x@0.001", 8.0), ("c@179.999", 8.0), ("b@100", 10.0), ("c_max", 8.0))


def _rods() -> Iterator[Probe]:
    for ratio in _RATIOS:
        # where λ² shows only after hundreds of digits, the textbook formulas need them
        digits = 40 + (700 if float(ratio) > 1e12 else 60)
        for asked, ulp in _ASKED:
            if asked == "c_max" and float(ratio) > 1e12:
                continue  # the place of the peak is 90° to all digits of any bracket
            yield Probe(f"L/R = {ratio}", f"{_CRANK}rod_ratio: {ratio}}}", f"motion {asked}", Oracle(digits), ulp)


def _sized(crank: str, rod: str) -> str:
    return f"{{speed: 60 rpm, crank: {crank}, rod: {rod}}}"


def _offset(offset: str) -> str:
    return f"{_CRANK}rod: 2000 mm, offset: {offset}}}"


def _slotted(frame: str) -> str:
    return f"{{speed: 60 rpm, mechanism: slotted-lever, crank: 100 mm, frame: {frame}, lever: 400 mm}}"


def _lever_speed(sign: int, frame: float) -> Decimal:
    """v R_l/(e ± r), R 304 and 305."""
    crank = Decimal(_SHORT)
    return 2 * pi() * crank * Decimal(_LONG) / (Decimal(frame) + sign * crank)


def _lever_way(frame: float, degrees: int) -> Decimal:
    """R_l sin θ with tan θ = r sin φ/(e + r cos φ)."""
    sin, cos = sin_cos(Decimal(degrees))
    across, along = Decimal(_SHORT) * sin, Decimal(frame) + Decimal(_SHORT) * cos
    return Decimal(_LONG) * across / (across**2 + along**2).sqrt()


def _levers() -> Iterator[Probe]:
    for frame, length in (("100.0001 mm", 100.0001 / 1000), ("300 mm", 0.3), ("1e12 mm", 1e9)):
        name, text = f"slotted lever, frame {frame}", _slotted(frame)
        yield Probe(name, text, "motion x@175", partial(_lever_way, length, 175))
        yield Probe(name, text, "motion c_work_max", partial(_lever_speed, 1, length))
        yield Probe(name, text, "motion c_return_max", partial(_lever_speed, -1, length))


def _four_bar(crank: int, coupler: int, rocker: int, frame: int) -> str:
    lengths = f"crank: {crank} mm, coupler: {coupler} mm, rocker: {rocker} mm, frame: {frame} mm"
    return f"{{speed: 60 rpm, mechanism: four-bar, {lengths}}}"


CASES = [
    *_rods(),
    Probe("infinite rod", f"{_CRANK}rod: infinite}}", "motion x@60", lambda: Decimal(_LONG) / 2, 4),
    Probe("infinite rod", f"{_CRANK}rod_ratio: infinite}}", "motion b@60", Oracle(), 4),
    Probe("exact zero at the dead centre", f"{_CRANK}rod_ratio: 5}}", "motion c@180", 0),
    Probe("exact zero after 1e6 turns", f"{_CRANK}rod_ratio: 5}}", "motion c@360000180", 0),
    Probe("1e6 turns", f"{_CRANK}rod_ratio: 5}}", "motion x@360000030", Oracle(60)),
    Probe("1e6 turns", f"{_CRANK}rod_ratio: 5}}", "motion c@360000179.5", Oracle(60)),
    Probe("φ = 1e22°", f"{_CRANK}rod_ratio: 5}}", "motion x@1e22", Oracle(80)),
    Probe("φ = 1e-300°", f"{_CRANK}rod_ratio: 5}}", "motion c@1e-300", Oracle(40)),
    Probe("L/R = 1", f"{_CRANK}rod_ratio: 1}}", "motion x@30", Refusal("must be more than 1")),
    Probe("L/R = 1 − 2^-53", f"{_CRANK}rod_ratio: 0.9999999999999999}}", "motion x@30", Refusal("must be more than 1")),
    Probe("rod as long as the crank", f"{_CRANK}rod: 400 mm}}", "motion x@30", Refusal("is no longer than the crank")),
    Probe("rod shorter than the crank", f"{_CRANK}rod: 300 mm}}", "motion x@30", Refusal("is shorter than the crank")),
    *(
        Probe(f"offset {offset}", _offset(offset), f"motion {asked}", Oracle(), ulp)
        for offset in ("1 um", "800 mm", "1599 mm", "1599.9999 mm", "1599.999999999 mm")
        for asked, ulp in (("x@200", 24.0), ("stroke", 8.0))
    ),
    Probe("offset at its limit", _offset("1600 mm"), "motion x@30", Refusal("longer than crank and offset together")),
    Probe("offset beyond its limit", _offset("-1700 mm"), "motion x@30", Refusal("longer than crank and offset")),
    *(
        Probe(f"crank {crank}", _sized(crank, rod), f"motion {asked}", Oracle(60 if rod != "2e8 m" else 800))
        for crank, rod in (("1e-9 m", "1.5e-9 m"), ("6e8 m", "9e8 m"), ("4e-9 m", "2e8 m"))
        for asked in ("x@60", "c@120")
        if not (rod == "2e8 m" and asked == "c@120")
    ),
    Probe("crank too large", _sized("1e308 m", "1.5e308 m"), "motion x@180", Refusal("too large")),
    Probe("length too large for a float", _sized("1e400 m", "2 m"), "motion x@30", Refusal("too large")),
    Probe("crank of no length", _sized("0 mm", "2 m"), "motion x@30", Refusal("must be more than 0")),
    Probe("speed 0", "{speed: 0 rpm, crank: 400 mm, rod_ratio: 5}", "motion c@30", 0),
    Probe("no speed", "{crank: 400 mm, rod_ratio: 5}", "motion c@30", Absent()),
    Probe("speed 1e-6 rpm", "{speed: 1e-6 rpm, crank: 400 mm, rod_ratio: 5}", "motion c@30", Oracle()),
    Probe("speed 1e200 rpm", "{speed: 1e200 rpm, crank: 400 mm, rod_ratio: 5}", "motion b@30", Refusal("too large")),
    Probe("scotch yoke", "{mechanism: scotch-yoke, crank: 400 mm, speed: 60 rpm}", "motion b@60", Oracle(), 4),
    Probe("lever's pivot in the pin's circle", _slotted("100 mm"), "motion x@30", Refusal("would pass through")),
    *_levers(),
    Probe("change-point linkage", _four_bar(100, 200, 250, 350), "motion theta@30", Refusal("change")),
    Probe("linkage that cannot turn", _four_bar(200, 150, 300, 300), "motion theta@30", Refusal("crank")),
]
