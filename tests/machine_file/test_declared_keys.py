"""What keys say of one another holds alike for the file, for the schema and for records made in Python."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import Any

import jsonschema
import numpy as np
import pytest

from kurbel.declared.forms.structures import RecordForm, records
from kurbel.declared.keys import Key
from kurbel.errors import RuleError
from kurbel.machine_file.reader import ROOT
from kurbel.machine_file.schema import describe
from kurbel.traces.correct import Trace
from representative import law_of_each
from schemas import whole_schema


def all_records() -> Iterator[RecordForm]:
    """Every record that the keys of a machine lead to."""
    found = {ROOT.record: ROOT}
    waiting = [ROOT]
    while waiting:
        record = waiting.pop()
        for name, key in record.keys.items():
            for _, inner in records(key.form, name):
                if inner.record not in found:
                    found[inner.record] = inner
                    waiting.append(inner)
    return iter(found.values())


def declared(field: str) -> list[Any]:
    return [(record, name, key) for record in all_records() for name, key in record.keys.items() if getattr(key, field)]


def allowed_by_schema(record: RecordForm, *names: str) -> bool:
    """Whether the rules between keys let these stand together, whatever their values."""
    return rules_of(record).is_valid(dict.fromkeys(names, 1))


@cache
def rules_of(record: RecordForm) -> jsonschema.Draft7Validator:
    rules: list[dict[str, Any]] = []
    describe(record, {}, rules, whole_schema()["definitions"])
    return jsonschema.Draft7Validator({"allOf": rules})


@law_of_each(declared("instead"))
def test_two_keys_that_say_the_same_thing_are_a_contradiction(record: RecordForm, name: str, key: Key) -> None:
    with pytest.raises(RuleError, match=f"{name}: '{key.instead}' and '{name}' say the same thing"):
        record.record.from_keys(**{name: 1.5, key.instead: 1.5})
    assert not allowed_by_schema(record, name, key.instead)


@law_of_each(declared("needs"))
def test_a_key_needs_the_one_beside_it(record: RecordForm, name: str, key: Key) -> None:
    with pytest.raises(RuleError, match=f"{name}: '{name}' needs '{key.needs}' beside it"):
        record.record.from_keys(**{name: 1.5})
    assert not allowed_by_schema(record, name)


@pytest.mark.parametrize(
    ("angles", "pressures", "message"),
    [
        ([0, 180], [1, 2], "rise over one whole cycle"),
        ([0, 200, 180, 360], [1, 2, 3, 1], "rise over one whole cycle"),
        ([0, 180, 360], [1, np.nan, 1], "finite samples"),
        ([0, 180, 360], [1, 2], "as many pressures as angles"),
        ([0], [1], "two or more"),
    ],
)
def test_a_trace_is_one_cycle_at_birth(angles: list[float], pressures: list[float], message: str) -> None:
    with pytest.raises(RuleError, match=message):
        Trace(np.array(angles, dtype=float), np.array([pressures], dtype=float))
