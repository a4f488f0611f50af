"""Zusammenstellung 112: the factors of the straight slider-crank over the crank angle, for any L/R.

The printed figures are those of F. Rötscher, Die Maschinenelemente (1927), p. 602 f., read from the scan.
"""

import math
from array import array
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from kurbel import crank_formulas as formulas
from kurbel.crank_angle import CrankAngle
from kurbel.declared.unit_systems import shown_unit
from kurbel.errors import UsageError
from kurbel.near_words import did_you_mean
from kurbel.quantity import PHI, Quantity, by_id, called
from kurbel.tables.tables import CellValue, Column, Part, PlaceTable, Report

_EACH = (
    ("b", Quantity("acceleration_factor", "cos φ + R/L cos 2φ", "ratio", "b over v²/R")),
    ("c", Quantity("velocity_factor", "sin(φ+ψ)/cos ψ", "ratio", "c over v, and T over P")),
    ("x", Quantity("displacement_factor", "x/R", "ratio", "x over R")),
    ("psi", Quantity("psi", "ψ", "angle", "Angle between connecting rod and stroke line")),
    (
        "S",
        Quantity(
            "rod_force_factor", "S/P", "ratio", "Rod force over piston force, 1/cos ψ (R 300)"
        ),
    ),
    (
        "N",
        Quantity(
            "guide_force_factor", "N/P", "ratio", "Guide force over piston force, tan ψ (R 301)"
        ),
    ),
    (
        "D",
        Quantity(
            "radial_force_factor",
            "D/P",
            "ratio",
            "Radial over piston force, cos(φ+ψ)/cos ψ (R 302)",
        ),
    ),
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
    Quantity(
        "phi_b_zero",
        "φ_b=0",
        "angle",
        "Crank angle of b = 0 and of the largest c, on the outstroke",
    ),
    Quantity("x_b_zero", "x/R", "ratio", "x over R there"),
    Quantity("c_max_factor", "c_max/v", "ratio", "Largest c over v"),
    Quantity("phi_b_zero_book", "φ_b0=0", "angle", "Crank angle of b = 0 by first order (R 291)"),
    Quantity(
        "x_b_zero_book", "x_0/R", "ratio", "x over R there, by first order (B 22, example 33)"
    ),
    Quantity(
        "phi_square",
        "φ_⊥",
        "angle",
        "Crank angle at which the rod is square to the crank",
        "phi_square",
    ),
)
"""Of one L/R, by id."""

_OTHER_SYMBOLS = {
    ("exact", "acceleration_factor"): ("b R/v²", "b R/v^2"),
    ("first-order", "velocity_factor"): ("sin φ + ½ R/L sin 2φ", "sin phi + 1/2 R/L sin 2phi"),
    ("first-order", "displacement_factor"): (
        "1 − cos φ + ½ R/L sin² φ",
        "1 - cos phi + 1/2 R/L sin^2 phi",
    ),
}
"""Symbols of rows whose formula is not the book's."""
_PRINTED_SYMBOLS = {
    "acceleration_factor": ("cos φ ± R/L cos 2φ", "cos phi +- R/L cos 2phi"),
    "velocity_factor": ("sin(φ±ψ)/cos ψ", "sin(phi+-psi)/cos psi"),
}
"""Symbols as the book prints them, with one sign for each stroke."""


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
    ids = _ids_of(rows)
    ratios = tuple(dict.fromkeys(ratios))
    symbols = {id: (FACTORS[id].symbol, FACTORS[id].ascii_symbol) for id in ids}
    symbols |= {id: _OTHER_SYMBOLS[formula, id] for id in ids if (formula, id) in _OTHER_SYMBOLS}
    if compare:
        symbols |= {id: _PRINTED_SYMBOLS[id] for id in ids if id in _PRINTED_SYMBOLS}
    parts = tuple(_part(ratio, symbols, angles, formula) for ratio in ratios)

    names = " und ".join(symbol for symbol, _ in symbols.values())
    title = f"Zusammenstellung 112. Werte für {names} am geraden Kurbeltrieb."
    has_return_stroke = min(angles) >= 0 and max(angles) <= 180
    mirrored = _on_return_stroke(symbols) if has_return_stroke else ""
    has_motion = "acceleration_factor" in ids or "velocity_factor" in ids
    root_table = Part("", (), place_tables=(_roots(ratios),)) if has_motion else None
    report = Report(title, "table", None, "ratios", parts, root_table, mirrored)
    if not compare:
        return report
    return _with_printed(report, formula)


def _ids_of(rows: Iterable[str]) -> list[str]:
    """Return the ids of rows, each once. Raises UsageError for an unknown row."""
    ids: list[str] = []
    for row in rows:
        called_so = (ROWS[row],) if row in ROWS else called(row, FACTORS.values())
        if len(called_so) != 1:
            near = did_you_mean(row, (*ROWS, *ROWS.values()))
            raise UsageError(f"--rows: no row '{row}'{near} (known: {', '.join(ROWS)})")
        ids += called_so
    return [*dict.fromkeys(ids)]


def _part(
    ratio: float, symbols: Mapping[str, tuple[str, str]], angles: Sequence[float], formula: str
) -> Part:
    """Return the table of one L/R. The rows of the book are columns here, over the crank angle.

    symbols: of the columns by their ids, in Greek letters and in ASCII.

    Raises UsageError if the crank cannot turn.
    """
    if not ratio > 1:
        raise UsageError(f"--ratio: L/R must be larger than 1 for the crank to turn, got {ratio:g}")
    values_by_id = {id: array("d") for id in symbols}
    for degrees in angles:
        factors = _factors(CrankAngle.of(degrees), ratio, formula)
        for id, values in values_by_id.items():
            values.append(factors[id])
    columns = [Column("phi", PHI.symbol, PHI.ascii_symbol, "deg", angles, PHI.text)]
    for id, values in values_by_id.items():
        unit = shown_unit(FACTORS[id].kind, "si")
        columns.append(Column(id, *symbols[id], unit, values, FACTORS[id].text))
    return Part(ratio, tuple(columns))


def _on_return_stroke(symbols: Mapping[str, tuple[str, str]]) -> str:
    """Return the sentence on the angles 360° − φ; symbols: of the rows by their ids."""
    odd = [symbol for id, (symbol, _) in symbols.items() if id in _ODD]
    if not odd:
        return "On the return stroke (360° − φ) the values are the same."
    verb = "has" if len(odd) == 1 else "have"
    return f"On the return stroke (360° − φ) {' and '.join(odd)} {verb} the opposite sign."


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
    factors["inertia_torque_factor"] = (
        -factors["acceleration_factor"] * factors["velocity_factor"] + 0.0
    )
    factors["stroke_share"] = factors["displacement_factor"] / 2
    return factors


def _roots(ratios: tuple[float, ...]) -> PlaceTable:
    """Return where b is zero and c is largest on the outstroke, exactly and by first order (B example 33).

    The rod is square to the crank, tan φ = L/R, near the largest c (R p. 604).
    """
    values_by_id = {id: array("d") for id in ROOTS}
    for ratio in ratios:
        lam = 1 / ratio
        exact = _angle_of_zero_acceleration(ratio)
        first_order = math.degrees(math.acos(2 * lam / (1 + math.sqrt(1 + 8 * lam * lam))))
        there = _factors(CrankAngle.of(exact), ratio, "exact")
        by_book = _factors(CrankAngle.of(first_order), ratio, "first-order")
        values_by_id["phi_b_zero"].append(exact)
        values_by_id["x_b_zero"].append(there["displacement_factor"])
        values_by_id["c_max_factor"].append(there["velocity_factor"])
        values_by_id["phi_b_zero_book"].append(first_order)
        values_by_id["x_b_zero_book"].append(by_book["displacement_factor"])
        values_by_id["phi_square"].append(math.degrees(math.atan(ratio)))
    columns = []
    for quantity in ROOTS.values():
        unit = shown_unit(quantity.kind, "si")
        symbols = quantity.symbol, quantity.ascii_symbol
        values = values_by_id[quantity.id]
        alone = _DIGITS.get(quantity.id, 0)
        columns.append(Column(quantity.id, *symbols, unit, values, quantity.text, alone=alone))
    names = tuple((f"L/R_=_{ratio:g}",) for ratio in ratios)
    title = (
        "Where b = 0 and c is largest: exactly, by first order, and by the rod square to the crank"
    )
    return PlaceTable("roots", title, ("ratio",), names, tuple(columns))


_DIGITS = {"x_b_zero": 4, "c_max_factor": 5, "x_b_zero_book": 4}
"""Significant digits of the factors where b is zero; four would leave c_max/v but three decimals."""


def _angle_of_zero_acceleration(ratio: float) -> float:
    """Return the angle in degrees at which the exact b passes zero on the outstroke, by bisection."""
    low, high = 0.0, 90.0
    while low < (middle := (low + high) / 2) < high:
        is_behind = _factors(CrankAngle.of(middle), ratio, "exact")["acceleration_factor"] < 0
        if is_behind:
            high = middle
        else:
            low = middle
    return high


# the printed figures


_HALF_UNIT = 0.0005
"""Half a unit of the last printed decimal: what rounding may differ by."""


def _printed() -> dict[tuple[str, float], list[float | None]]:
    """Return the figures as printed for φ = 0, 10, … 180° by the id of the row and L/R.

    None is illegible: 70° and 80° lie in the fold between the two pages.
    """
    figures: dict[tuple[str, float], list[float | None]] = {}
    with open(Path(__file__).parent / "zusammenstellung.tsv", encoding="utf-8") as file:
        for line in file:
            id, ratio, *texts = line.split()
            figures[id, float(ratio)] = [None if text == "-" else float(text) for text in texts]
    return figures


def _with_printed(report: Report, formula: str) -> Report:
    """Return the table with the printed figures below the computed ones, those marked that rounding cannot explain.

    All factors have the three decimals of the book. Raises UsageError if the book prints no such table.
    """
    printed = _printed()
    wanted = set[tuple[str, str | float | None]]()
    for part in report.parts:
        wanted.update((column.id, part.name) for column in part.columns[1:])
    has_book_angles = [*report.parts[0].columns[0].values] == [*range(0, 181, 10)]
    if wanted - {*printed} or formula != "book" or not has_book_angles:
        only = "only b and c by --formula book, for L/R = 5, 4.5 and 4, every 10 degrees"
        raise UsageError(f"--compare: the book prints {only}")

    parts: list[Part] = []
    notes = [_SIGNS, _MISPRINTS]
    for part in report.parts:
        phi, *columns = part.columns
        rows = [phi]
        for column in columns:
            figures = printed[column.id, float(part.name)]
            misprints = _misprints(column.values, figures)
            for index in misprints:
                where = f"L/R = {part.name:g}, φ = {phi.values[index]:g}°"
                value, figure = column.values[index], figures[index]
                notes.append(f"{where}: {column.symbol} is {value:.3f}, printed {figure:.3f}")
            name, text = "  printed", f"{column.text}, as printed"
            rows.append(column._replace(decimals=3))
            rows.append(Column(f"{column.id}_printed", name, name, "", figures, text, 3, misprints))
        parts.append(part._replace(columns=tuple(rows)))
    with_roots = report.whole and report.whole._replace(
        place_tables=tuple(map(_with_three_decimals, report.whole.place_tables))
    )
    return report._replace(parts=tuple(parts), whole=with_roots, notes=tuple(notes))


_SIGNS = "±: + on the outstroke, − on the return stroke, as the book prints it."
_MISPRINTS = "* misprint: off the book's own formula by more than half a unit of the last decimal; blank: illegible."


def _misprints(values: Sequence[CellValue], figures: Sequence[CellValue]) -> tuple[int, ...]:
    """Return the indices of the printed figures that are not the values rounded to three decimals."""
    largest = _HALF_UNIT * (1 + 1e-9)  # a figure may round a tie the other way
    return tuple(
        index
        for index, (value, figure) in enumerate(zip(values, figures))
        if value is not None and figure is not None and abs(value - figure) > largest
    )


def _with_three_decimals(table: PlaceTable) -> PlaceTable:
    """Return a table of places whose factors have the decimals of the book; its angles stay as they are."""
    columns = [column if column.unit else column._replace(decimals=3) for column in table.columns]
    return table._replace(columns=tuple(columns))
