"""Forces and work: masses of any size, cards without area, jumps, noisy traces, friction up to self-locking."""

from decimal import Decimal

from kurbel.accuracy.decimals import pi
from kurbel.accuracy.extremes import Absent, Oracle, Probe, Refusal
from kurbel.accuracy.scenes import STEAM

_TRAIN = "speed: 60 rpm, crank: 400 mm, rod: 2000 mm, bore: 450 mm"
_JUMPS = (
    "{unit: bar, expansion: [[0, 9], [0.5, 9], [0.5, 2], [1, 2]], compression: [[1, 1], [0.2, 1], [0.2, 8], [0, 8]]}"
)
_POLYTROPIC = (
    "{unit: bar, interpolate: polytropic, clearance: 0.07, "
    "expansion: [[0, 9], [0.3, 8.5], [1, 2]], compression: [[1, 1], [0.3, 1], [0, 9]]}"
)


def _double(card: str, more: str = "", train: str = _TRAIN) -> str:
    return f"{{{train}, indicator: {{head_end: {card}, crank_end: mirrored}}{more}}}"


def _single(card: str, more: str = "", train: str = _TRAIN) -> str:
    return f"{{{train}, indicator: {{head_end: {card}}}{more}}}"


def _flat(out: str, back: str) -> str:
    return f"{{unit: bar, expansion: {out}, compression: {back}}}"


def _driven(ratio: str, f: str) -> str:
    card = "{constant: {expansion: 0 bar, compression: 5 bar}}"
    train = f"speed: 60 rpm, crank: 400 mm, rod_ratio: {ratio}, bore: 450 mm"
    return f"{{{train}, indicator: {{head_end: {card}}}, friction: {{crosshead: {f}}}}}"


_CRANK, _BORE = 0.4, 0.45
_SAMPLES = 100_000
_WAVE = 0.5e6
_NOISE = 0.005 * 1e6


def noisy_trace() -> str:
    """Return 1e5 samples 1e6 Pa + 0.5e6 Pa sin φ, with noise that is the same on both strokes.

    What is even in φ does no work; with an infinite rod ∮ sin φ dx = π R.
    """
    from math import radians, sin
    from random import Random

    random = Random(1932)
    half = [random.gauss(0.0, _NOISE) for _ in range(_SAMPLES // 2 + 1)]
    points = []
    for k in range(_SAMPLES):
        even = half[min(k, _SAMPLES - k)]
        points.append(f"[{360 * k / _SAMPLES!r}, {1e6 + _WAVE * sin(radians(360 * k / _SAMPLES)) + even!r}]")
    trace = f"{{trace: {{unit: Pa, points: [{', '.join(points)}]}}}}"
    return f"{{speed: 60 rpm, crank: 400 mm, rod: infinite, bore: 450 mm, indicator: {{head_end: {trace}}}}}"


def _work_of_wave() -> Decimal:
    return pi() / 4 * Decimal(_BORE) ** 2 * pi() * Decimal(_CRANK) * Decimal(_WAVE)


def _masses(mass: str) -> str:
    return f", masses: {{piston: {mass}}}"


def _rubs(coefficient: str) -> str:
    return f", friction: {{crosshead: {coefficient}}}"


def _nearly(pressure: str) -> str:
    return _flat("[[0, 7], [0.3, 10], [1, 10]]", f"[[1, 10], [0.3, {pressure}], [0, 7]]")


_EVEN = _flat("[[0, 5], [1, 5]]", "[[1, 5], [0, 5]]")
_DRIVING = _flat("[[0, 5], [1, 5]]", "[[1, 0], [0, 0]]")
_AT_REST = _TRAIN.replace("60 rpm", "0 rpm")
_SHORT_ROD, _ENDLESS = (_TRAIN.replace("rod: 2000 mm", rod) for rod in ("rod_ratio: 1.01", "rod: infinite"))
CASES = [
    Probe("steam card", _double(STEAM), "forces work", Oracle(), 2),
    Probe("steam card", _double(STEAM), "forces T_max", Oracle()),
    Probe("vertical jumps", _double(_JUMPS), "forces work", Oracle(), 2),
    Probe("vertical jumps", _double(_JUMPS, _masses("200 kg")), "forces T_max", Oracle()),
    Probe("vertical jumps", _double(_JUMPS, _masses("200 kg")), "forces T_min", Oracle()),
    Probe("polytropic card", _double(_POLYTROPIC), "forces work", Oracle(), 8),
    Probe("polytropic card", _double(_POLYTROPIC), "forces T_max", Oracle()),
    Probe("card without area", _single(_EVEN), "forces work", 0),
    Probe("card without area", _single(_EVEN), "forces W", 0),
    Probe("no loss as a share of no work", _single(_EVEN, _rubs("0.06")), "forces loss_crosshead", Absent()),
    Probe("card that cancels but for 1e-12", _single(_nearly("10.00000000001")), "forces work", Oracle(60), 2),
    Probe("card that cancels but for 1e-15", _single(_nearly("10.000000000000002")), "forces work", Oracle(60), 2),
    Probe("driven: negative area", _single(_flat("[[0, 1], [1, 1]]", "[[1, 1], [0, 7]]")), "forces work", Oracle(), 2),
    Probe("1e5 noisy samples", noisy_trace, "forces work", _work_of_wave, 64),
    Probe("1e10 bar", _single(_flat("[[0, 1e10], [1, 1e10]]", "[[1, 0], [0, 0]]")), "forces work", Oracle(), 4),
    Probe("1e308 bar", _single(_flat("[[0, 1e308], [1, 1]]", "[[1, 1], [0, 1]]")), "forces work", Refusal("too large")),
    Probe("mass 0", f"{{{_TRAIN}{_masses('0 kg')}}}", "forces P_inertia_max", 0),
    Probe("mass 0", f"{{{_TRAIN}{_masses('0 kg')}}}", "forces T_max", 0),
    Probe("mass 1e-12 kg", f"{{{_TRAIN}{_masses('1e-12 kg')}}}", "forces T_max", Oracle()),
    Probe("mass 1e18 kg", f"{{{_TRAIN}{_masses('1e18 kg')}}}", "forces T_max", Oracle()),
    Probe("mass 1e308 kg", f"{{{_TRAIN}{_masses('1e308 kg')}}}", "forces T_max", Refusal("too large")),
    Probe("no masses", _double(STEAM), "forces P_inertia_max", Absent()),
    Probe("power at rest", _double(STEAM, train=_AT_REST), "forces power", Absent()),
    Probe("work at rest", _double(STEAM, train=_AT_REST), "forces work", Oracle(), 2),
    Probe("friction 0", _double(STEAM, _rubs("0")), "forces friction_work", 0),
    Probe("friction 1e-15", _double(STEAM, _rubs("1e-15")), "forces friction_work", Oracle(), 16),
    Probe("friction 0.06", _double(STEAM, _rubs("0.06")), "forces friction_work", Oracle(), 16),
    Probe("friction, L/R = 1.01", _double(STEAM, _rubs("0.06"), _SHORT_ROD), "forces friction_work", Oracle(60), 256),
    Probe("driving, friction 10", _single(_DRIVING, _rubs("10")), "forces friction_work", Oracle(), 64),
    Probe("driven, just before it locks", _driven("1.4143", "1"), "forces friction_work", Oracle(60), 1e6),
    Probe("driven, locked", _driven("1.4142", "1"), "forces friction_work", Refusal("locks itself", 3)),
    Probe("driven, locked by f = 20", _driven("5", "20"), "forces N_max", Refusal("locks itself", 3)),
    Probe("infinite rod has no side force", _double(STEAM, train=_ENDLESS), "forces N_max", 0),
]
