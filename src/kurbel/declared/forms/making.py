"""The second pass over a machine file: from mappings of numbers, words and lists to records, which check themselves."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from kurbel.arrays import Indivisible, Truth
from kurbel.declared.forms.structures import ReadMapping, RecordForm
from kurbel.declared.keys import TOO_EXTREME, Record
from kurbel.declared.reading import REFUSED, Reading, has_refused
from kurbel.errors import NotANumber, RuleError, refused
from kurbel.numerics.arithmetic import is_number


def too_extreme(record: object, values: Mapping[str, object]) -> Truth:
    """Return whether a number of a record has overflowed, for many machines as an array (machines,).

    values: of its keys. A number may be infinite if one of these is, as `rod: infinite`, or by default.
    """
    defaults = [vars(type(record)).get(name) for name in vars(record)]
    numbers = filter(is_number, (*values.values(), *defaults))
    may_be_infinite = any(number == math.inf for number in numbers)
    has_arrays = not isinstance(record, Indivisible)
    is_extreme: Truth = False
    for value in vars(record).values():
        is_array = has_arrays and isinstance(value, np.ndarray)
        if is_number(value) or is_array:
            is_allowed = np.isfinite(value) | (may_be_infinite & (value == math.inf))
            is_extreme = is_extreme | ~is_allowed
    return is_extreme


class Maker:
    """The second pass: makes records of what was read, and reports what is wrong with them.

    broken: which of many machines, whose numbers are arrays (count,), break a rule.
    """

    def __init__(self, reading: Reading, count: int = 0) -> None:
        self.reading = reading
        self.broken = np.zeros(count, dtype=bool)

    def made(self, value: object) -> Any:
        """Return the record, tuple or value that was read; REFUSED after reporting what is wrong with it."""
        if isinstance(value, tuple):
            has_mapping = any(isinstance(item, ReadMapping) for item in value)
            if not has_mapping:
                return value
            return tuple(map(self.made, value))
        if not isinstance(value, ReadMapping):
            return value
        completed = value.form.record.completed(value.values, self.made)
        values = {name: self.made(node) for name, node in completed.items()}
        try:
            value.made = self._record(value.form, values)
        except ArithmeticError:
            value.made = self.reading.fault(value.path, TOO_EXTREME)
        except RuleError as error:
            flattened = value.form.flattened(error, value.mapping)
            value.made = self.reading.refuse(value.path, flattened)
        return value.made

    def _record(self, form: RecordForm, values: dict[str, object]) -> object:
        """Return the record of values by key; REFUSED if one could not be read, after judging the others.

        For that the rules get `Form.unread` in its place, a nan, which breaks no rule.
        """
        # what could not be read, with what is in its place
        unread: dict[str, object] = {}
        for name, value in values.items():
            has_refused_item = isinstance(value, tuple) and has_refused(value)
            if value is REFUSED or has_refused_item:
                unread[name] = form.keys[name].form.unread
        if None in unread.values():  # nothing can be in place of a word or a mapping
            raise RuleError(*form.record.faults_of_some(values))
        # the record, which checks itself
        try:
            record = form.record.from_keys(**(values | unread))
        except RuleError as error:
            faults = error.faults
            if unread:
                faults = tuple(fault for fault in faults if not isinstance(fault, NotANumber))
            raise RuleError(*faults) from None
        except (ArithmeticError, ValueError):
            if not unread:  # else a formula takes no nan
                raise
        if unread:
            return REFUSED
        # its numbers and, for many machines, which of these break a rule
        is_extreme = too_extreme(record, values)
        if len(self.broken) == 0:
            if is_extreme:
                refused(TOO_EXTREME)
            return record
        self.broken = self.broken | is_extreme
        for rule in form.record.rules_of_keys(values):
            self.broken = np.logical_or(self.broken, rule.broken)
        if isinstance(record, Record):
            for rule in record.rules():
                self.broken = np.logical_or(self.broken, rule.broken)
        return record
