"""A small report of two cylinders and the whole machine, with everything that a renderer must cope with."""

from typing import Any
from unicodedata import category

from hypothesis import strategies as st

from kurbel.tables.tables import Column, KeyValue, LeftOut, Part, Report


def texts(*without: str, **sizes: Any) -> st.SearchStrategy[str]:
    """Any text without characters of these categories; for `st.text` a table of all Unicode is made, for seconds."""
    codes = st.integers(0, 0x2FF) | st.integers(0x300, 0xD7FF) | st.integers(0xE000, 0x10FFFF)
    return st.lists(codes.map(chr).filter(lambda one: category(one) not in without), **sizes).map(
        "".join
    )


PHI = Column("phi", "φ", "phi", "deg", tuple(range(0, 361, 30)))


def column(id: str, unit: str, largest: float, symbol: str = "", ascii_symbol: str = "") -> Column:
    values = tuple(largest * (6 - index) / 6 for index in range(len(PHI.values)))
    return Column(id, symbol or id, ascii_symbol or symbol or id, unit, values)


ALIKE = (
    Column("psi", "ψ", "psi", "deg", (0.0, 5.7391, *[None] * 11)),
    column("b", "m/s^2", 13.16),
    column("P", "N", 154_321.0),
    column("M", "N m", 2.4e7),
)

HIGH = Part(
    'HP [side], "Käfer" φ|ψ',
    (PHI, *ALIKE),
    (
        KeyValue("stroke", "s", "s", "m", 0.8, "Stroke"),
        KeyValue(
            "c_max", "c_max", "c_max", "m/s", 2.1359, "Largest velocity toward the shaft", 79.10014
        ),
        KeyValue("P_max", "P_max", "P_max", "N", 2.4e7, "Largest piston force, about v²/R"),
        KeyValue(
            "phi_b_zero",
            "φ_b=0",
            "phi_b=0",
            "deg",
            (79.10014, 280.89986),
            "Where the acceleration passes zero",
        ),
        KeyValue("phi_reversal", "φ_P=0", "phi_P=0", "deg", (), "Druckwechsel"),
        KeyValue("delta", "δ", "delta", "", 1.1e-16, "Coefficient of speed fluctuation"),
        KeyValue("dE", "ΔE", "dE", "J", None, "Largest swing of the excess work"),
    ),
    (
        LeftOut("weight", "no inclination given"),
        LeftOut("friction", "no friction given, see [docs]"),
    ),
    ("the card does not close: 1.2 at against 1.3 at",),
)
LOW = Part("LP", (PHI, *ALIKE[:2], Column("F_friction", "F_f", "F_f", "N", (-0.0,) * 13)))
WHOLE = Part(
    "machine",
    (PHI, column("T", "N", 1e-7)),
    (KeyValue("W", "W", "W", "N", 1.5, "Mean resistance"),),
)

REPORT = Report("Kräfte [im] Kurbeltriebe", "forces", "Demo", "cylinders", (HIGH, LOW), WHOLE)
ONE = REPORT._replace(parts=(HIGH._replace(name="cylinder 1"),), whole=None)
