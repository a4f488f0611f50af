"""Zusammenstellung 112: the factors of the straight slider-crank over the crank angle, for any L/R.

The printed figures are those of F. Rötscher, Die Maschinenelemente (1927), p. 602 f., read from the scan.
"""

import math
from array import array
from collections.abc import Sequence
from pathlib import Path

from kurbel import crank_formulas as formulas
from kurbel.crank_angle import CrankAngle
from kurbel.errors import UsageError
from kurbel.near_words import did_you_mean
from kurbel.quantity import PHI, Quantity, by_id, called
from kurbel.tables.tables import Column, Part, PlaceTable, Report

_EACH = (
    ("b", Quantity("acceleration_factor", "cos φ + R/L cos 2φ", "ratio", "b over v²/R")),
    ("c", Quantity("velocity_factor", "sin(φ+ψ)/cos ψ", "ratio", "c over v, and T over P")),
    ("x", Quantity("displacement_factor", "x/R", "ratio", "x over R")),
    ("psi", Quantity("psi", "ψ", "angle", "Angle between connecting rod and stroke line")),
    ("S", Quantity("rod_force_factor", "S/P", "ratio", "Rod force over piston force, 1/cos ψ (R 300)")),
    ("N", Quantity("guide_force_factor", "N/P", "ratio", "Guide force over piston force, tan ψ (R 301)")),
    ("D", Quantity("radial_force_factor", "D/P", "ratio", "Radial over piston force, cos(φ+ψ)/cos ψ (R 302)")),
    (
        "T_b",
        Quantity(
            "inertia_torque_factor",
            "T_b/(m R ω²)",
            "ratio",
            "Tangential inertia force, −(b R/v²)(c/v) (Tolle, R p. 614)",
        ),
    ),
    ("x/s", Quantity("stroke_share", "x/s", "ratio", "Share of the stroke")),
)
FACTORS = by_id(*(quantity for _, quantity in _EACH))
"""Rows of Zusammenstellung 112, by id."""
ROWS = {word: quantity.id for word, quantity in _EACH}
"""What `--rows` calls a row -> its id."""
RATIOS = (5.0, 4.5, 4.0)
_ODD = "velocity_factor", "psi", "guide_force_factor", "inertia_torque_factor"
"""Rows that change their sign on the return stroke."""


ROOTS = by_id(
    Quantity("phi_b_zero", "φ_b=0", "angle", "Crank angle at which the acceleration is zero, on the outstroke"),
    Quantity("phi_b_zero_book", "φ_b0=0", "angle", "The same by the acceleration of first order (R 291)"),
)
"""Of one L/R, by id."""

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
    ids: list[str] = []
    for row in rows:
        found = (ROWS[row],) if row in ROWS else called(row, FACTORS.values())
        if len(found) != 1:
            near = did_you_mean(row, (*ROWS, *ROWS.values()))
            raise UsageError(f"--rows: no row '{row}'{near} (known: {', '.join(ROWS)})")
        ids += found
    ratios, parts = tuple(dict.fromkeys(ratios)), list[Part]()
    for ratio in ratios:
        if not ratio > 1:
            raise UsageError(f"--ratio: L/R must be larger than 1 for the crank to turn, got {ratio:g}")
        every = {id: array("d") for id in dict.fromkeys(ids)}
        for degrees in angles:
            factors = _factors(CrankAngle.of(degrees), ratio, formula)
            for id, values in every.items():
                values.append(factors[id])
        columns = [Column("phi", PHI.symbol, PHI.ascii_symbol, "deg", angles, PHI.text)]
        for id, values in every.items():
            symbols = _OTHER_SYMBOLS.get((formula, id), (FACTORS[id].symbol, FACTORS[id].ascii_symbol))
            columns.append(Column(id, *symbols, "deg" if id == "psi" else "", values, FACTORS[id].text))
        parts.append(Part(ratio, tuple(columns)))

    shown = [column.symbol for column in parts[0].columns[1:]]
    title = f"Zusammenstellung 112. Werte für {' und '.join(shown)} am geraden Kurbeltrieb."
    mirrored = ""
    if min(angles) >= 0 and max(angles) <= 180:
        odd = [column.symbol for column in parts[0].columns if column.id in _ODD]
        changes = f"{' and '.join(odd)} {'has' if len(odd) == 1 else 'have'} the opposite sign" if odd else ""
        mirrored = f"On the return stroke (360° − φ) {changes or 'the values are the same'}."
    whole = Part("", (), place_tables=(_roots(ratios),)) if "acceleration_factor" in ids else None
    report = Report(title, "table", None, "ratios", tuple(parts), whole, mirrored)
    return _with_printed(report, formula) if compare else report


def _factors(angle: CrankAngle, ratio: float, formula: str) -> dict[str, float]:
    """Return all factors at a crank angle by their ids; ψ and the forces have no form of first order."""
    sin, cos, lam = float(angle.sin), float(angle.cos), 1 / ratio
    # ρ = 1 − (R/L)² without its cancellation
    rho = 1.0 if math.isinf(ratio) else (ratio - 1) / ratio * ((ratio + 1) / ratio)
    kappa = math.sqrt(cos * cos + rho * (sin * sin))
    guide = lam * sin / kappa  # N/P = tan ψ, R 301
    factors = {
        "acceleration_factor": cos - sin * guide + lam * cos * cos / kappa**3,
        "velocity_factor": sin + cos * guide,
        "displacement_factor": float(angle.versine) + lam * sin * sin / (1 + kappa),
        "psi": math.degrees(math.atan(guide)),
        "rod_force_factor": 1 / kappa,
        "guide_force_factor": guide,
        "radial_force_factor": cos - sin * guide,
    }
    if formula != "exact":
        factors["acceleration_factor"] = formulas.first_order_acceleration(sin, cos, lam)
    if formula == "first-order":
        factors["velocity_factor"] = formulas.first_order_velocity(sin, cos, lam)
        factors["displacement_factor"] = formulas.first_order_displacement(sin, cos, lam)
    factors["inertia_torque_factor"] = -factors["acceleration_factor"] * factors["velocity_factor"] + 0.0
    factors["stroke_share"] = factors["displacement_factor"] / 2
    return factors


def _roots(ratios: tuple[float, ...]) -> PlaceTable:
    """Return where b is zero on the outstroke, exactly and by the acceleration of first order, B example 33."""
    exact, first_order = array("d"), array("d")
    for ratio in ratios:
        lam, low, high = 1 / ratio, 0.0, 90.0
        first_order.append(math.degrees(math.acos(2 * lam / (1 + math.sqrt(1 + 8 * lam * lam)))))
        while low < (middle := (low + high) / 2) < high:
            behind = _factors(CrankAngle.of(middle), ratio, "exact")["acceleration_factor"] < 0
            low, high = (low, middle) if behind else (middle, high)
        exact.append(high)
    columns = [
        Column(one.id, one.symbol, one.ascii_symbol, "deg", values, one.text)
        for one, values in zip(ROOTS.values(), (exact, first_order))
    ]
    names = tuple((f"L/R_=_{ratio:g}",) for ratio in ratios)
    return PlaceTable("roots", "Where b = 0: exactly, and by first order", ("ratio",), names, tuple(columns))


# the printed figures


_HALF_UNIT = 0.0005
"""Half a unit of the last printed decimal: what rounding may differ by."""


def _printed() -> dict[tuple[str, float], list[float | None]]:
    """Return the figures as printed for φ = 0, 10, … 180° by the id of the row and L/R.

    None is illegible: 70° and 80° lie in the fold between the two pages.
    """
    with open(Path(__file__).parent / "zusammenstellung.tsv", encoding="utf-8") as file:
        rows = [line.split() for line in file]
    return {(id, float(ratio)): [None if one == "-" else float(one) for one in of] for id, ratio, *of in rows}


def _with_printed(report: Report, formula: str) -> Report:
    """Return the table with the printed figures below the computed ones, those marked that rounding cannot explain.

    Raises UsageError if the book prints no such table.
    """
    printed = _printed()
    wanted = {(column.id, part.name) for part in report.parts for column in part.columns[1:]}
    if wanted - {*printed} or formula != "book" or [*report.parts[0].columns[0].values] != [*range(0, 181, 10)]:
        only = "only b and c by --formula book, for L/R = 5, 4.5 and 4, every 10 degrees"
        raise UsageError(f"--compare: the book prints {only}")
    parts = []
    notes = ["* misprint: off the book's own formula by more than half a unit of the last decimal; blank: illegible."]
    for part in report.parts:
        phi, *columns = part.columns
        shown = [phi]
        for column in columns:
            figures, misprints = printed[column.id, float(part.name)], []
            for index, (angle, value, figure) in enumerate(zip(phi.values, column.values, figures)):
                # the small margin keeps a figure that rounds a tie the other way
                if value is not None and figure is not None and abs(value - figure) > _HALF_UNIT * (1 + 1e-9):
                    misprints.append(index)
                    where = f"L/R = {part.name:g}, φ = {angle:g}°"
                    notes.append(f"{where}: {column.symbol} is {value:.3f}, printed {figure:.3f}")
            id, text, name = f"{column.id}_printed", f"{column.text}, as printed", "  printed"
            shown += [column, Column(id, name, name, "", figures, text, 3, tuple(misprints))]
        parts.append(part._replace(columns=tuple(shown)))
    return report._replace(parts=tuple(parts), notes=tuple(notes))
