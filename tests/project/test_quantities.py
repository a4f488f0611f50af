"""Declared quantities: each has one definition, and what mechanisms offer joins the lists of their commands."""

import pytest

from kurbel import loads, quantities
from kurbel.mechanisms import Mechanism
from kurbel.quantity import value
from kurbel.report.commands import report_of
from kurbel.solver.case import CHAPTERS, Chapter
from kurbel.solver.figures import AtAngles, Results, result_rows
from kurbel.tables.frame import Frame
from representative import case_of


@pytest.mark.parametrize("missing", ["dead_centres", "coordinate", "slope", "curvature"])
def test_a_mechanism_that_forgets_something_is_refused_by_name(missing: str) -> None:
    members = dict.fromkeys(("dead_centres", "coordinate", "slope", "curvature"))
    half = type(
        "Half", (Mechanism,), {name: value for name, value in members.items() if name != missing}
    )
    with pytest.raises(TypeError, match=rf"abstract class Half .*{missing}"):
        half()


# one id, one meaning


class Wear(Results):
    """What a new chapter may have: an id that the guide force has as well."""

    command = "wear"
    N_max = value("N_max", "power", "Largest power of wear")


class WearColumns(AtAngles):
    """What a new chapter may have: a column with the id of the guide force, and its largest value."""

    commands = ("wear",)
    N = value("N", "power", "Power of wear", extremes=("wear",), called="power of wear")


class WearOverAngle(Results):
    """The results with these columns."""

    command, state = "wear", WearColumns


@pytest.mark.parametrize(
    ("kind", "message"),
    [
        (Wear, "'N_max' of Wear has the kind 'power', but 'force' in CylinderForces"),
        (WearOverAngle, "'N' of WearOverAngle has the kind 'power', but 'force' in CylinderForces"),
    ],
)
def test_an_id_with_two_meanings_is_refused_by_name(
    monkeypatch: pytest.MonkeyPatch, kind: type[Results], message: str
) -> None:
    wear = Chapter("wear", lambda: kind, lambda case: [])
    monkeypatch.setattr(quantities, "CHAPTERS", (*CHAPTERS, wear))
    with pytest.raises(TypeError, match=rf"^{message}: give it another id$"):
        quantities.every_quantity.__wrapped__()


def test_a_class_that_declares_an_id_twice_is_refused_when_it_is_made() -> None:
    largest = value("N_max", "force", "Largest power of wear")
    members = {"command": "wear", "state": WearColumns, "N_max": largest}
    with pytest.raises(TypeError, match="'N_max' of Twice has the kind 'power', but 'force'"):
        type("Twice", (Results,), members)


# printed symbols as names

ENGINE = "{speed: 60 rpm, crank: 400 mm, rod: 2 m, bore: 450 mm, indicator: {head_end: {constant: %s}}, %s}"
PRESSURE = "{expansion: 5 bar, compression: 1 bar}"


def test_where_key_values_are_in_groups_every_one_is_in_a_group() -> None:
    """A key value without a heading would be printed below that of another one."""
    for kind in (chapter.kind for chapter in CHAPTERS):
        headings = {row.quantity.heading for row in result_rows(kind).key_values.values()}
        assert ("" in headings) == (headings == {""}), kind


def test_figures_take_printed_symbols() -> None:
    figures = "limits: {A_H: 1 m2, T_max: 1 MN, dA/A: 1e-9}, expect: {φ_o: 180 deg ± 1 deg, phi_i: 0 deg ± 1 deg}"
    machine = loads(ENGINE % (PRESSURE, figures))
    assert [id for id, _ in machine.limits] == ["A_head", "T_max", "energy_residual"]
    assert [id for id, _ in machine.expect] == ["phi_odc", "phi_idc"]


@pytest.mark.parametrize(
    ("command", "name", "part", "units"),
    [
        ("forces", "shaper", 0, {"P_start_max": "kN", "P_start_min": "kN", "P_peak": "kN"}),
        (
            "flywheel",
            "compressor-two-stage",
            0,
            {"E_max": "kJ", "E_min": "kJ", "M_mean": "kN m", "M_max": "kN m"},
        ),
        ("bearings", "boxer", 1, {"load_max": "kN", "load_min": "kN", "load_mean": "kN"}),
    ],
)
def test_the_largest_and_the_smallest_share_a_unit(
    command: str, name: str, part: int, units: dict[str, str]
) -> None:
    """P_0,max = 600.0 N stood above P_0,min = −6.000 kN."""
    shown = [
        report_of(case_of(name), Frame(command, (0.0,), (), system)).all_parts[part]
        for system in ("metric", "si")
    ]
    reported, in_si = ({key_value.id: key_value for key_value in one.key_values} for one in shown)
    assert {id: reported[id].unit for id in units} == units
    for id in units:
        assert reported[id].value * 1000 == pytest.approx(in_si[id].value, rel=1e-15)
