"""What may stand under a key of the machine file; each form reads, explains and describes itself."""

from kurbel.declared.forms.alike import Alike
from kurbel.declared.forms.figures import Expectations, Limits
from kurbel.declared.forms.points import Points
from kurbel.declared.forms.records import Record, Variant
from kurbel.declared.forms.scalars import Choice, Count, Number, Physical, Truth, UnitName
from kurbel.declared.forms.structures import Inline, Keyed, Listing, OneOf
from kurbel.declared.forms.texts import ColumnRange, FilePath, FiringOrder, Text
from kurbel.declared.forms.uncertainties import Settings, Uncertainties

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
