"""The JSON Schema and records made in Python accept and refuse what the reader does."""

import re
from collections.abc import Iterator
from functools import cache
from typing import Any

import jsonschema
import numpy as np
import pytest
import yaml

from good_machines import ALL
from kurbel.declared.forms.structures import RecordForm, records
from kurbel.declared.keys import Key
from kurbel.declared.unit_systems import SI
from kurbel.declared.units import kind_example, parse_quantity, unit_names
from kurbel.errors import RuleError, UnitError
from kurbel.machine_file.reader import ROOT
from kurbel.machine_file.schema import describe, json_schema
from kurbel.traces.correct import Trace
from representative import law_of_each

whole_schema = cache(json_schema)
"""Made once: that takes a third of a second."""


@pytest.fixture(scope="module")
def validator() -> Any:
    schema = whole_schema()
    jsonschema.Draft7Validator.check_schema(schema)
    return jsonschema.Draft7Validator(schema)


@pytest.mark.parametrize("text", ALL.values(), ids=ALL)
def test_accepts_what_the_reader_accepts(text: str, validator: Any) -> None:
    assert [error.message for error in validator.iter_errors(yaml.safe_load(text))] == []


SLIDER = {"crank": "400 mm", "rod": "2 m"}


@pytest.mark.parametrize(
    "machine",
    [
        *({**SLIDER, "crank": wrong} for wrong in (400, "400 kg", "0,4 m")),
        *(
            {**SLIDER, **more}
            for more in ({"colour": "green"}, {"rocker": "1 m"}, {"efficiency": 85})
        ),
        *(
            {**SLIDER, **more}
            for more in (
                {"cycle": "six-stroke"},
                {"head_end_rod": "20 mm"},
                {"limits": {"cmax": "6 m/s"}},
            )
        ),
        {**SLIDER, "flywheel": {"inertia": "1 kg m2", "gd2": "4 kg m2"}},
        *({"crank": "400 mm", "rod_ratio": wrong} for wrong in ("5:1", "10/")),
        *(
            {"mechanism": "four-bar", "crank": "400 mm"},
            {"mechanism": "gearwheel"},
            {"cylinders": []},
        ),
        {"bore": "400 mm", "cylinders": [SLIDER]},
        {"cylinders": {"count": 4}},
        {"cylinders": [{"like": "A", "boore": "5 m"}]},
        {"effort": {"unit": "N m", "points": [[0, 1, 5], [360, 2]]}},
    ],
)
def test_refuses_what_the_reader_refuses(machine: dict[str, Any], validator: Any) -> None:
    assert not validator.is_valid(machine)


FEET_AND_INCHES = ("12 ft 6 in", "5' 6\"", "5'-6 1/2\"", "1 3/4 in", "3 feet 1 inch", '9"', "3'")


@pytest.mark.parametrize("kind", [kind for kind in SI if kind != "ratio"])
def test_patterns_know_every_unit(kind: str) -> None:
    definitions = whole_schema()["definitions"]
    if f"quantity_{kind}" not in definitions:
        pytest.skip("no key of this kind")
    pattern = definitions[f"quantity_{kind}"]["pattern"]
    for unit in unit_names(kind):
        powers = re.sub("2(?!O)", "²", unit), re.sub("(?<=m)2", "^2", unit)
        for spelt in (unit, *powers, unit.replace(" ", "·"), re.sub("(?=Hg|H2O)", " ", unit)):
            assert re.search(pattern, f"1.5e3 {spelt}"), spelt
            assert parse_quantity(f"1.5e3 {spelt}", kind) > 0
    assert re.search(pattern, kind_example(kind))
    if kind == "length":
        for text in FEET_AND_INCHES:
            assert re.search(pattern, text)
            assert parse_quantity(text, kind) > 0
    for text in ("1.5", "1,5 mm", "010 mm", "mm", "5", "1_0 mm"):
        assert not re.search(pattern, text)
        with pytest.raises(UnitError):
            parse_quantity(text, kind)


def test_figures_may_be_named_by_their_symbols(validator: Any) -> None:
    machine = {"crank": "400 mm", "rod": "2 m"}
    good = {"b_max": "13.16 m/s2 ± 0.5 %", "φ_o": ["179 deg", "181 deg"], "dA/A": "0 +- 1e-9"}
    assert validator.is_valid(machine | {"limits": {"A_H": "1 m2", "ΔA/A": 1e-9}, "expect": good})
    for bad in (
        {"b_max": "13.16 m/s2"},
        {"bmax": "1 m/s2 ± 1 %"},
        {"φ_b=0": "1 deg ± 1 deg"},
        {"b_max": ["1 m/s2"]},
    ):
        assert not validator.is_valid(machine | {"expect": bad})


# what keys say of one another holds alike for the file, for the schema and for records made in Python


def all_records() -> Iterator[RecordForm]:
    """Every record that the keys of a machine lead to."""
    results = {ROOT.record: ROOT}
    waiting = [ROOT]
    while waiting:
        record = waiting.pop()
        for name, key in record.keys.items():
            for _, inner in records(key.form, name):
                if inner.record not in results:
                    results[inner.record] = inner
                    waiting.append(inner)
    return iter(results.values())


def declared(field: str) -> list[Any]:
    return [
        (record, name, key)
        for record in all_records()
        for name, key in record.keys.items()
        if getattr(key, field)
    ]


def allowed_by_schema(record: RecordForm, *names: str) -> bool:
    """Whether the rules between keys let these stand together, whatever their values."""
    return rules_of(record).is_valid(dict.fromkeys(names, 1))


@cache
def rules_of(record: RecordForm) -> jsonschema.Draft7Validator:
    rules: list[dict[str, Any]] = []
    describe(record, {}, rules, whole_schema()["definitions"])
    return jsonschema.Draft7Validator({"allOf": rules})


@law_of_each(declared("instead"))
def test_two_keys_that_say_the_same_thing_are_a_contradiction(
    record: RecordForm, name: str, key: Key
) -> None:
    if key.compared:
        assert allowed_by_schema(record, name, key.instead)
        return
    with pytest.raises(RuleError, match=f"{name}: '{key.instead}' and '{name}' mean the same"):
        record.record.from_keys(**{name: 1.5, key.instead: 1.5})
    assert not allowed_by_schema(record, name, key.instead)


@law_of_each(declared("needs"))
def test_a_key_needs_the_one_that_goes_with_it(record: RecordForm, name: str, key: Key) -> None:
    with pytest.raises(RuleError, match=f"{name}: '{name}' needs '{key.needs}' beside it"):
        record.record.from_keys(**{name: 1.5})
    assert not allowed_by_schema(record, name)


@pytest.mark.parametrize(
    ("angles", "pressures", "message"),
    [
        ([0, 180], [1, 2], "rise over one whole cycle"),
        ([0, 200, 180, 360], [1, 2, 3, 1], "rise over one whole cycle"),
        ([0, 180, 360], [1, np.nan, 1], "finite pressures"),
        ([0, 180, 360], [1, 2], "as many finite pressures as angles"),
        ([0], [1], "rise over one whole cycle"),
    ],
)
def test_a_trace_is_one_cycle_at_birth(
    angles: list[float], pressures: list[float], message: str
) -> None:
    with pytest.raises(RuleError, match=message):
        Trace(np.array(angles, dtype=float), np.array([pressures], dtype=float))
