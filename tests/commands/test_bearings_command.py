"""`kurbel bearings` as a user calls it."""

import json

from command import run
from representative import CONFIGS

ENGINE = CONFIGS["gas-engine"].read_text("utf-8")


def test_json_has_one_part_for_each_pin_and_bearing() -> None:
    result, fine = (
        json.loads(run("bearings", "-", "-f", "json", "--step", step, text=ENGINE).stdout)
        for step in ("90", "7")
    )
    # key values do not hang on the step
    assert [part["key_values"] for part in result["bearings"]] == [
        part["key_values"] for part in fine["bearings"]
    ]
    parts = {part["name"]: part for part in result["bearings"]}
    assert list(parts) == ["crank pin", "crosshead pin", "bearing A", "bearing B"]
    columns = {column["id"]: column for column in parts["crank pin"]["columns"]}
    loads = ["phi", "load", "load_throw", "load_engine", "load_rod"]
    film = ["eccentricity", "film_thickness", "film_direction", "film_pressure"]
    assert list(columns) == [*loads, *film]
    assert [columns[id]["unit"] for id in loads] == ["deg", "N", "deg", "deg", "deg"]
    assert [columns[id]["unit"] for id in film] == ["", "m", "deg", "Pa"]
    assert (
        columns["load_throw"]["values"][0] == 180
    )  # in the dead centre the piston presses the pin toward the shaft
    assert [column["id"] for column in parts["bearing A"]["columns"]] == [
        "phi",
        "load",
        "load_throw",
        "load_engine",
        *film,
    ]
    values = {value["id"]: value for value in parts["bearing A"]["key_values"]}
    words = {
        "load_max",
        "load_mean",
        "load_min",
        "unloaded_arc",
        "pressure_max",
        "pressure_velocity",
    }
    assert words <= values.keys()
    assert values["load_max"]["value"] >= max(parts["bearing A"]["columns"][1]["values"])
