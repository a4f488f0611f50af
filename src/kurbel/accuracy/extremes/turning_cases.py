"""Turning effort and speed: no flywheel, or an enormous one; loads up to a slip of 1e-9; machines that stall."""

from decimal import Decimal

from kurbel.accuracy.decimals import pi
from kurbel.accuracy.extremes import Absent, Oracle, Probe, Refusal
from kurbel.accuracy.scenes import STEAM

_TRAIN = "crank: 400 mm, rod: 2000 mm, bore: 450 mm"


def _engine(more: str, masses: str = "200 kg") -> str:
    heavy = f"masses: {{piston: {masses}}}, " if masses else ""
    return f"{{speed: 50 rpm, {_TRAIN}, indicator: {{head_end: {STEAM}, crank_end: mirrored}}, {heavy}{more}}}"


def _loaded(inertia: str, load: str, masses: str = "") -> str:
    return _engine(f"flywheel: {{inertia: {inertia} kg m2}}, load: {load}", masses)


def _given(points: str, more: str = "") -> str:
    return f"{{speed: 60 rpm, effort: {{unit: N m, points: {points}}}{more}}}"


_BLOCK = "[[0, 200], [180, 200], [180, 0], [360, 0]]"
_HEAVY = 1e15
_WHEEL = ", flywheel: {inertia: 1e15 kg m2}"


def _delta_of_block() -> Decimal:
    """ΔE = 100 N m · π, δ = ΔE/(J ω²) where δ² no longer shows."""
    return 100 * pi() / (Decimal(_HEAVY) * (2 * pi()) ** 2)


def _twins(position: int) -> str:
    cylinder = f"{_TRAIN}, indicator: {{head_end: {STEAM}, crank_end: mirrored}}"
    other = f"{cylinder}, crank_position: {position} deg"
    return f"{{speed: 50 rpm, cylinders: [{{name: a, {cylinder}}}, {{name: b, {other}}}]}}"


_FAN = "{power_law: 2}"
_FALLING = "load that falls as 1/ω, ∮ dφ/ω as at the nominal speed"
_STOPS = Refusal("the machine stops near", 3)
CASES = [
    Probe("no flywheel", _engine("inclination: 0 deg"), "flywheel dE", Oracle()),
    Probe("no flywheel", _engine("inclination: 0 deg"), "flywheel delta", Absent()),
    Probe("two cranks at 90°", _twins(90), "flywheel dE", Oracle(), 32),
    Probe("two cranks at 180°", _twins(180), "flywheel dE", Oracle(), 32),
    Probe("uniform effort", _given("[[0, 100], [360, 100]]"), "flywheel dE", 0),
    Probe("effort in a block", _given(_BLOCK), "flywheel dE", lambda: 100 * pi(), 4),
    Probe("J = 1e15 kg m²", _given(_BLOCK, _WHEEL), "flywheel delta", _delta_of_block, 16),
    *(
        Probe(f"slip {slip}", _loaded("900", f"{{slip: {slip}}}", "200 kg"), f"flywheel {asked}", Oracle(), 16)
        for slip in ("0.1", "1e-3", "1e-6", "1e-9")
        for asked in ("omega@60", "omega@270")
    ),
    *(
        Probe(f"fan, J = {inertia} kg m2", _loaded(inertia, _FAN, "200 kg"), "flywheel omega@60", Oracle(), 24)
        for inertia in ("1e3", "1e6", "1e12")
    ),
    Probe("power law 30", _loaded("900", "{power_law: 30}", "200 kg"), "flywheel omega@60", Oracle(), 16),
    Probe("J varying tenfold", _loaded("4", "{slip: 0.05}", "300 kg"), "flywheel omega@90", Oracle(), 24),
    Probe("hardly a flywheel, slip 1e-6", _loaded("1", "{slip: 1e-6}"), "flywheel omega@60", Oracle(), 16),
    Probe("flywheel of no inertia", _loaded("0", "constant"), "flywheel delta", Refusal("any inertia")),
    Probe("stalls under a constant load", _loaded("30", "constant"), "flywheel delta", _STOPS),
    Probe(_FALLING, _loaded("300", "{power_law: -1}"), "flywheel omega_mean", lambda: 100 * pi() / 60, 16),
    Probe("no speed, no speed line", _given(_BLOCK, _WHEEL).replace("speed: 60 rpm, ", ""), "flywheel delta", Absent()),
    Probe("nothing turns the shaft", f"{{speed: 50 rpm, {_TRAIN}}}", "flywheel dE", Refusal("no force acts")),
]
