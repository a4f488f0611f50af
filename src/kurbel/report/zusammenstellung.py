"""Zusammenstellung 112: the factors of the straight slider-crank over the crank angle, for any L/R. Needs no numpy."""

import math
from array import array
from collections.abc import Callable, Sequence

from kurbel import crank_formulas as formulas
from kurbel.crank_angle import CrankAngle
from kurbel.declared.factors import FACTORS, PHI
from kurbel.declared.quantity import Quantity, called
from kurbel.errors import UsageError
from kurbel.near_words import did_you_mean
from kurbel.report.tables import Column, Part, Report, Value

RATIOS = (5.0, 4.5, 4.0)
ROWS = {
    "b": "acceleration_factor",
    "c": "velocity_factor",
    "x": "displacement_factor",
    "psi": "psi",
    "S": "rod_force_factor",
    "N": "guide_force_factor",
    "D": "radial_force_factor",
}
"""What `--rows` calls a row -> its id."""

_ODD = ("velocity_factor", "psi", "guide_force_factor")  # they change their sign on the return stroke


Factor = Callable[[float, float, float, float, float], float]
"""Of sine and cosine of the crank angle, cos ψ, R/L, and ρ = 1 − (R/L)² without its cancellation."""


def _guide(sin: float, cos: float, kappa: float, lam: float, rho: float) -> float:
    """Return N/P = tan ψ, R 301."""
    return lam * sin / kappa


_EXACT: dict[str, Factor] = {
    "acceleration_factor": formulas.acceleration_factor,
    "velocity_factor": formulas.velocity_factor,
    "displacement_factor": formulas.displacement_factor,
    "psi": lambda *known: math.degrees(math.atan(_guide(*known))),
    "rod_force_factor": lambda sin, cos, kappa, *_: 1 / kappa,
    "guide_force_factor": _guide,
    "radial_force_factor": formulas.radial_factor,
}
_BOOK = _EXACT | {"acceleration_factor": lambda sin, cos, _, lam, __: formulas.first_order_acceleration(sin, cos, lam)}
_FIRST_ORDER = _BOOK | {
    "velocity_factor": lambda sin, cos, _, lam, __: formulas.first_order_velocity(sin, cos, lam),
    "displacement_factor": lambda sin, cos, _, lam, __: formulas.first_order_displacement(sin, cos, lam),
}
_FACTORS = {"book": _BOOK, "exact": _EXACT, "first-order": _FIRST_ORDER}

_OTHER_SYMBOLS = {
    ("exact", "acceleration_factor"): ("b R/v²", "b R/v^2"),
    ("first-order", "velocity_factor"): ("sin φ + ½ R/L sin 2φ", "sin phi + 1/2 R/L sin 2phi"),
    ("first-order", "displacement_factor"): ("1 − cos φ + ½ R/L sin² φ", "1 - cos phi + 1/2 R/L sin^2 phi"),
}
"""Symbols of rows whose formula is not the book's."""


def zusammenstellung(
    ratios: tuple[float, ...] = RATIOS,
    rows: tuple[str, ...] = ("b", "c"),
    angles: Sequence[float] = tuple(range(0, 181, 10)),
    formula: str = "book",
    compare: bool = False,
) -> Report:
    """Return the table for these L/R, rows (names or ids of ROWS), crank angles in degrees, and formula.

    formula: `book`: acceleration of first order (R 291), all else exact; `exact`; or `first-order`: x, c and b
    (R 286, B 25, R 291), while ψ and the forces have no such form and stay exact. `compare` sets the printed figures
    below the computed ones and marks the misprints. Raises UsageError for L/R that do not turn and unknown rows.
    """
    ids = tuple(dict.fromkeys(_row_id(row) for row in rows))
    ratios = tuple(dict.fromkeys(ratios))
    parts = tuple(_part(ratio, ids, angles, formula) for ratio in ratios)
    symbols = [column.symbol for column in parts[0].columns[1:]]
    title = f"Zusammenstellung 112. Werte für {_listed(symbols, 'und')} am geraden Kurbeltrieb."
    report = Report(title, "table", None, "ratios", parts, mirrored=_mirrored(parts[0], angles))
    if not compare:
        return report
    from kurbel.report.misprints import compared

    return compared(report, formula)


def _row_id(row: str) -> str:
    if row in ROWS:
        return ROWS[row]
    if len(found := called(row, FACTORS.values())) == 1:
        return found[0]
    known = tuple(ROWS)
    raise UsageError(f"--rows: no row '{row}'{did_you_mean(row, (*known, *ROWS.values()))} (known: {', '.join(known)})")


def _part(ratio: float, ids: tuple[str, ...], angles: Sequence[float], formula: str) -> Part:
    if not ratio > 1:
        raise UsageError(f"--ratio: L/R must be larger than 1 for the crank to turn, got {ratio:g}")
    lam, rho = 1 / ratio, 1.0 if math.isinf(ratio) else (ratio - 1) / ratio * ((ratio + 1) / ratio)
    factors = [_FACTORS[formula][id] for id in ids]
    values = [array("d") for _ in ids]
    for angle in map(CrankAngle.of, angles):
        known = angle.sin, angle.cos, formulas.cos_rod_angle(angle.sin, angle.cos, rho), lam, rho
        for column, factor in zip(values, factors):
            column.append(factor(*known))
    columns = (_column(FACTORS[id], column, formula) for id, column in zip(ids, values))
    return Part(ratio, (_column(PHI, angles, formula), *columns))


def _column(quantity: Quantity, values: Sequence[Value], formula: str) -> Column:
    symbols = _OTHER_SYMBOLS.get((formula, quantity.id), (quantity.symbol, quantity.ascii_symbol))
    return Column(quantity.id, *symbols, "deg" if quantity.kind == "angle" else "", values, quantity.text)


def _mirrored(part: Part, angles: Sequence[float]) -> str:
    if min(angles) < 0 or max(angles) > 180:
        return ""
    odd = [column.symbol for column in part.columns if column.id in _ODD]
    if not odd:
        return "On the return stroke (360° − φ) the values are the same."
    return (
        f"On the return stroke (360° − φ) {_listed(odd, 'and')} {'has' if len(odd) == 1 else 'have'} the opposite sign."
    )


def _listed(words: list[str], last: str) -> str:
    return f" {last} ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)
