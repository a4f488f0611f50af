"""What may stand under a key of the machine file; each form reads and describes itself."""

from kurbel.declared.forms.figures import EXPECTATIONS, LIMITS, SETTINGS, UNCERTAINTIES
from kurbel.declared.forms.structures import Inline, Keyed, Listing, OneOf, RecordForm, Variant
from kurbel.declared.forms.values import COLUMN_RANGE, FILE_PATH, FIRING_ORDER, TEXT, Choice, Number, Points, unit_name

__all__ = [
    "COLUMN_RANGE",
    "EXPECTATIONS",
    "FILE_PATH",
    "FIRING_ORDER",
    "LIMITS",
    "SETTINGS",
    "TEXT",
    "UNCERTAINTIES",
    "Choice",
    "Inline",
    "Keyed",
    "Listing",
    "Number",
    "OneOf",
    "Points",
    "RecordForm",
    "Variant",
    "unit_name",
]
