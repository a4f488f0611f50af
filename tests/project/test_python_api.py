"""What Python may be used for stays: public names with their signatures, and every attribute that the docs name.

Figures are those of the command line: the same machine, the same quantity, whichever way it is computed.
"""

import math
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import kurbel
from command import answer
from representative import CONFIGS, case_of

WATERWORKS = CONFIGS["waterworks"]

NAMES = "Case Cylinder Machine Piston SliderCrank draw find load loads solve sweep"
"""Their signatures stand in docs/reference/python.md, which is held against the code."""
CLASSES_ALONE = {"KurbelError": Exception, "Mechanism": object}
"""Classes that are not called by users, and what they come from."""


def printed(command: str, machine: str, *options: str) -> dict[str, Any]:
    """Return what the command line prints of a shipped machine as JSON, in SI."""
    return answer(command, CONFIGS[machine], *options)


def solved(machine: str) -> kurbel.Case:
    return kurbel.solve(kurbel.load(CONFIGS[machine]))


def test_public_names() -> None:
    assert sorted(kurbel.__all__) == sorted([*NAMES.split(), *CLASSES_ALONE])
    assert kurbel.__version__
    assert all(issubclass(getattr(kurbel, name), base) for name, base in CLASSES_ALONE.items())


def same(found: Any, printed: dict[str, Any]) -> None:
    """A key value of Python is that of the command line: value, unit and angle."""
    value = list(found.value) if isinstance(printed["value"], list) else found.value
    assert value == printed["value"]
    assert (found.unit, found.degrees) == (printed["unit"], printed.get("at_deg"))
    assert (found.quantity.id, found.quantity.symbol) == (printed["id"], printed["symbol"])


@pytest.mark.parametrize(
    ("command", "machine"),
    [
        *(("forces", name) for name in ("waterworks", "gas-engine", "crank-rocker")),
        *(
            ("flywheel", "waterworks"),
            ("balance", "waterworks"),
            ("stress", "gas-engine"),
            ("torsion", "coupled-blower"),
        ),
    ],
)
def test_key_values_by_id_by_symbol_and_as_attributes(command: str, machine: str) -> None:
    case, parsed = solved(machine), printed(command, machine, "--key-values")
    results = case.cylinders[0] if command == "forces" else getattr(case, command)
    reported = (
        parsed["cylinders"][0]["key_values"]
        if command == "forces"
        else parsed["machine_key_values"]
    )
    assert set(results.key_values()) >= {one["id"] for one in reported}
    for one in reported:
        same(results[one["id"]], one)
        same(results[one["symbol"]], one)
        # what only some mechanisms have is no attribute, but is found by its name
        if "at_deg" in one and hasattr(results, one["id"]):
            extreme = getattr(results, one["id"])
            assert (extreme.value, extreme.degrees) == (one["value"], one["at_deg"])
        if one["id"] in {"dE", "J", "delta", "F_free_max", "sigma_pin_max", "natural_frequency"}:
            same(case[one["id"]], one)


def test_machines_made_and_changed() -> None:
    file = str(CONFIGS["waterworks"])
    faster = kurbel.load(file, ["speed=100 rpm"])
    assert faster.speed == 2 * kurbel.load(file).speed
    assert isinstance(faster, kurbel.Machine)
    assert (
        kurbel.loads("{crank: 1 m, rod: 5 m}", overrides=["crank=2 m"])
        .cylinders[0]
        .mechanism.stroke
        == 4.0
    )
    built = kurbel.Machine(
        (kurbel.Cylinder(kurbel.SliderCrank(crank=0.4, rod=2.0), pistons=(kurbel.Piston(0.45),)),)
    )
    assert isinstance(built.cylinders[0].mechanism, kurbel.Mechanism)
    assert kurbel.solve(built)["stroke"].value == 0.8
    with pytest.raises(kurbel.KurbelError):
        kurbel.SliderCrank(crank=0.4, rod=0.3)


def test_what_a_notebook_shows(tmp_path: Path) -> None:
    case = solved("gas-engine")
    for shown in (case, case.cylinders[0], case.flywheel):
        assert shown._repr_html_().count("<table") >= 1
        assert repr(shown).startswith("<kurbel ")
    drawing = kurbel.draw(case, "effort")
    assert drawing._repr_svg_().startswith("<svg")
    assert [mark.figure.name.symbol for mark in drawing.pictures[0].panels[0].marks] == [
        "T_max",
        "T_min",
    ]
    drawing.save(str(tmp_path / "effort.svg"))
    assert (tmp_path / "effort.svg").read_text(encoding="utf-8").lstrip().startswith("<")
    assert len(kurbel.draw(case, "mechanism", angles=(30.0,), units="si").pictures) == 1


# results by name

PLAIN = "{speed: 60 rpm, crank: 400 mm, rod: 2 m, masses: {piston: 100 kg}%s}"
PRESSURE = (
    ", bore: 450 mm, indicator: {head_end: {constant: {expansion: 5 bar, compression: 1 bar}}}"
)


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("T_mx", "no key value 'T_mx'; did you mean 'T_max'"),
        ("e_K", "this machine has no loss_cross"),
    ],
)
def test_a_name_that_is_not_there_is_reported(name: str, message: str) -> None:
    (cylinder,) = kurbel.solve(kurbel.loads(PLAIN % PRESSURE)).cylinders
    with pytest.raises(kurbel.KurbelError, match=message):
        _ = cylinder[name]


def test_of_several_cylinders_each_has_its_own() -> None:
    case = kurbel.solve(kurbel.load(CONFIGS["waterworks-two-cranks"]))
    assert case["T_max"].value == case.flywheel.T_max.value
    with pytest.raises(kurbel.KurbelError, match="each cylinder has its own P_max"):
        _ = case["P_max"]
    assert case.cylinders[1]["P_max"].value > 0


@pytest.mark.parametrize("degrees", ["abc", "", [float("nan")], [0.0, math.inf], None, {"phi": 1}])
def test_angles_that_are_none_are_refused_by_the_root_class(degrees: object) -> None:
    case = case_of("gas-engine")
    for results in (case.cylinders[0], case.flywheel, case.stress):
        for ask in (results.columns, results.at):
            with pytest.raises(kurbel.KurbelError, match="crank angles are"):
                ask(degrees)


def test_results_without_columns_say_so() -> None:
    case = case_of("compressor-two-stage")
    for results in (case.delivery.stages[0], case.cylinders[0].rod_loads):
        with pytest.raises(kurbel.KurbelError, match="no columns over the crank angle"):
            results.at([0.0])


def test_notebooks_show_tables_that_are_escaped() -> None:
    text = "{name: '<b>A&B</b>', " + (PLAIN % PRESSURE)[1:]
    case = kurbel.solve(kurbel.loads(text))
    page = case._repr_html_()
    assert "<h3>&lt;b&gt;A&amp;B&lt;/b&gt;</h3>" in page
    assert "<b>" not in page
    assert (
        '<th scope="row">c<sub>max</sub></th><td class="r">2.563</td><td>m/s</td>' in page
    )  # 2π · 0.4 · 1.0198331
    assert "&lt; 10⁻¹⁴</td>" in page
    locked = kurbel.loads((PLAIN % PRESSURE)[:-1] + ", friction: {crosshead: 20}}")
    assert "<p>" in kurbel.solve(locked).cylinders[0]._repr_html_()


# a machine as a text or a path, scalars, and how a figure prints

FLAT = "{speed: 60 rpm, stroke: 1 m, rod_ratio: 5}"
TAKEN = {
    "a path": WATERWORKS,
    "a path as a text": str(WATERWORKS),
    "a text": WATERWORKS.read_text(encoding="utf-8"),
}


@pytest.mark.parametrize("given", TAKEN)
@pytest.mark.parametrize("take", [kurbel.solve, kurbel.Case])
def test_a_machine_may_be_a_text_or_a_path(take: Any, given: str) -> None:
    assert (
        take(TAKEN[given]).cylinders[0]["T_max"]
        == kurbel.solve(kurbel.load(WATERWORKS)).cylinders[0]["T_max"]
    )


@pytest.mark.parametrize("speed", [2.0, "120 rpm", np.float64(2)])
def test_a_scalar_holds_for_every_row(speed: Any) -> None:
    """b_max of a slider-crank is R ω² (1 + R/L), at the inner dead centre."""
    result = kurbel.sweep(kurbel.loads(FLAT), {"rod_ratio": [4, 5], "speed": speed}, ["b_max"])
    ratios = np.array([1 / 4, 1 / 5])
    assert result["b_max"] == pytest.approx(0.5 * (2 * math.pi * 2) ** 2 * (1 + ratios), rel=1e-12)


def test_a_figure_prints_as_people_read_it() -> None:
    """10 bar on 0.01 m2 of a Scotch yoke: 10 kN · sin φ at the crank pin, and 10 kN · 0.8 m in every second."""
    text = (
        "{speed: 60 rpm, mechanism: scotch-yoke, crank: 400 mm, bore: 112.8379167 mm, "
        "indicator: {head_end: {constant: {expansion: 10 bar, compression: 0 bar}}}}"
    )
    case = kurbel.solve(kurbel.loads(text))
    assert str(case["T_max"]) == "10.00 kN at 90.00°"
    assert str(case["power"]) == "8.000 kW"
    assert str(case["stroke"]) == "800.0 mm"


# messages, and numbers that are not in SI

WRONG: dict[str, Callable[[], object]] = {
    "'overrides' crank=4: crank: 4 has no unit": lambda: kurbel.load(WATERWORKS, ["crank=4"]),
    "units: there is no 'inch'; there are si, metric, technical, imperial": lambda: kurbel.draw(
        solved("waterworks"), units="inch"
    ),
    "'overrides' crank: write KEY=VALUE": lambda: kurbel.loads("{crank: 1 m}", "m", ["crank"]),
    "'case' x: no such load case": lambda: kurbel.load(WATERWORKS, case="x"),
    "'columns': no key value 'zzz'": lambda: kurbel.sweep(WATERWORKS, {"bore": [0.4]}, "zzz"),
    "zzz: the file has no value": lambda: kurbel.sweep(WATERWORKS, {"zzz": [0.4]}),
    "inputs['limits.c_max']: limits are the same": lambda: kurbel.sweep(
        "{crank: 1 m, rod: 5 m, speed: 1 rps, limits: {c_max: 9 m/s}}", {"limits.c_max": [5.0]}
    ),
    "give vary={KEY: (low, high)} and wanted='KEY_VALUE = value'": lambda: kurbel.find(
        WATERWORKS, {"bore": (0.4, 0.5)}
    ),
    "vary['bore']: the range goes from 0.5 m up to 0.4 m": lambda: kurbel.find(
        WATERWORKS, {"bore": (0.5, 0.4)}, "T_max = 90 kN"
    ),
    "'where' c_max < 5: ": lambda: kurbel.find(
        WATERWORKS, {"bore": (0.4, 0.5)}, "T_max = 90 kN", where="c_max < 5"
    ),
    "a bound has 'where'": lambda: kurbel.find(WATERWORKS, {"bore": (0.4, 0.5)}, "T_max < 9 kN"),
    "'where' leaves out 1 that has it": lambda: kurbel.find(
        WATERWORKS, {"bore": (0.4, 0.5)}, "T_max = 90 kN", where="c_max < 1 m/s"
    ),
}


@pytest.mark.parametrize("message", WRONG)
def test_messages_name_parameters_and_no_options(message: str) -> None:
    with pytest.raises(kurbel.KurbelError) as caught:
        WRONG[message]()
    assert message in str(caught.value)
    assert "--" not in str(caught.value)


@pytest.mark.parametrize(
    ("key", "numbers", "message"),
    [
        ("bore", [68.0], "bore = 68 m, as numbers are in SI: a bore of 68 m is beyond"),
        ("bore", [0.44, 450.0], "bore = 450 m, as numbers are in SI: "),
        ("speed", [3000.0], "speed = 3000 rps, as numbers are in SI: a speed of 180000 rpm"),
        ("crank", [400.0], "crank = 400 m, as numbers are in SI: a stroke of 800 m"),
        ("masses.reciprocating", [8.3e5], "= 830000 kg, as numbers are in SI: a mass of 830 t"),
        ("ambient", [1.01325], "ambient = 1.01325 Pa, as numbers are in SI: an ambient"),
    ],
)
def test_numbers_in_other_units_are_doubted(key: str, numbers: list[float], message: str) -> None:
    machine = (
        "{speed: 50 rpm, crank: 400 mm, rod: 900 m, bore: 450 mm, ambient: 1 bar, "
        "masses: {reciprocating: 830 kg}, indicator: {head_end: 5 bar}}"
    )
    with pytest.warns(UserWarning, match="numbers are in SI") as caught:
        kurbel.sweep(machine, {key: numbers}, "stroke")
    (warning,) = caught
    assert message in str(warning.message)
    assert warning.filename == __file__


def test_numbers_near_those_of_the_file_are_not_doubted() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        kurbel.sweep(WATERWORKS, {"bore": np.linspace(0.1, 1.5, 4)}, "stroke")
        kurbel.find(WATERWORKS, {"bore": (0.4, 0.5)}, "T_max = 90 kN")


def test_ranges_and_machines_in_other_units_are_doubted() -> None:
    with pytest.warns(UserWarning, match="bore = 400 m, as numbers are in SI: a bore of 400 m"):
        kurbel.find(WATERWORKS, {"bore": (400, 500)}, "A_head = 150000 m2")
    piston = kurbel.Piston(bore=450.0)
    machine = kurbel.Machine((kurbel.Cylinder(kurbel.SliderCrank(0.4, 2.0), pistons=(piston,)),))
    with pytest.warns(UserWarning, match="numbers are in SI: .*a bore of 450 m is beyond"):
        kurbel.solve(machine)


def test_orders_may_be_a_list() -> None:
    case = solved("coupled-blower")
    assert case.harmonics([1, 2]).orders.tolist() == [1.0, 2.0]
    assert case.harmonics([1, 2]) is case.harmonics(np.array([1.0, 2.0]))


def test_results_are_shown_in_a_line() -> None:
    case = solved("waterworks")
    assert repr(case["T_max"]) == "<T_max = 87697.8014 N at 67.3035°>"
    solutions = kurbel.find(WATERWORKS, {"bore": ("400 mm", "500 mm")}, "T_max = 90 kN")
    assert repr(solutions) == "<kurbel find of bore for T_max = 90 kN: 1 solution in .found>"
    assert str(solutions) == "bore = 454.079 mm, T_max = 90 kN"
    drawing = kurbel.draw(case, "effort")
    assert repr(drawing) == "<kurbel drawing of effort: .save('NAME.svg'), .pictures>"
    for shown in (*drawing.pictures, case, case.flywheel, case.bearings, case.cylinders[0].at([0])):
        assert len(repr(shown)) < 120
        assert " object at 0x" not in repr(shown)


def test_what_a_notebook_shows_of_a_machine_and_of_a_slip() -> None:
    """A text is not a path, a file of a picture no option, and a machine is shown without its file."""
    with pytest.raises(kurbel.KurbelError, match=r"crank: 1 m rod: 5 m: .* read by kurbel.loads"):
        kurbel.load("crank: 1 m\nrod: 5 m")
    machine = kurbel.load(CONFIGS["waterworks"])
    assert f"origin=Origin('{WATERWORKS}')" in repr(machine)
    drawing = kurbel.draw(kurbel.solve(machine), "card")
    with pytest.raises(kurbel.KurbelError, match=r"^card.bmp: the name of a picture ends in"):
        drawing.save("card.bmp")
