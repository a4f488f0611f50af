"""What may stand under a key of the machine file; each form reads, explains and describes itself."""

from __future__ import annotations

from kurbel.declared.forms.figures import Expectations, Limits
from kurbel.declared.forms.points import Points
from kurbel.declared.forms.records import Inline, Record, Variant
from kurbel.declared.forms.scalars import Choice, Count, FilePath, Number, Physical, Text, UnitName
from kurbel.declared.forms.structures import Keyed, Listing, OneOf

__all__ = [
    "Choice",
    "Count",
    "Expectations",
    "FilePath",
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
    "UnitName",
    "Variant",
]
