"""What may stand under a key of the machine file; each form reads, explains and describes itself."""

from kurbel.declared.forms.figures import Expectations, Limits
from kurbel.declared.forms.structures import Alike, Inline, Keyed, Listing, OneOf, Record, Variant
from kurbel.declared.forms.values import (
    Choice,
    ColumnRange,
    Count,
    FilePath,
    FiringOrder,
    Number,
    Physical,
    Points,
    Settings,
    Text,
    Truth,
    Uncertainties,
    UnitName,
)

__all__ = [
    "Alike",
    "Choice",
    "ColumnRange",
    "Count",
    "Expectations",
    "FilePath",
    "FiringOrder",
    "Inline",
    "Keyed",
    "Limits",
    "Listing",
    "Number",
    "OneOf",
    "Physical",
    "Points",
    "Record",
    "Settings",
    "Text",
    "Truth",
    "Uncertainties",
    "UnitName",
    "Variant",
]
