"""What may stand under a key of the machine file; each form reads, explains and describes itself."""

from kurbel.declared.forms.alike import Alike
from kurbel.declared.forms.column_range import ColumnRange
from kurbel.declared.forms.figures import Expectations, Limits
from kurbel.declared.forms.firing_order import FiringOrder
from kurbel.declared.forms.points import Points
from kurbel.declared.forms.records import Record, Variant
from kurbel.declared.forms.scalars import (
    Choice,
    Count,
    Number,
    Physical,
    Text,
    Truth,
    UnitName,
    not_negative,
    positive,
)
from kurbel.declared.forms.structures import Inline, Keyed, Listing, OneOf
from kurbel.declared.forms.uncertainties import Uncertainties

__all__ = [
    "Alike",
    "Choice",
    "ColumnRange",
    "Count",
    "Expectations",
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
    "Text",
    "Truth",
    "Uncertainties",
    "UnitName",
    "Variant",
    "not_negative",
    "positive",
]
