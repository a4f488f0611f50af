"""Valve gears: figures of an independent calculation, laws, refusals, and errors that the figures would catch."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

import kurbel
from command import run
from kurbel.crank_angle import CrankAngle
from kurbel.errors import MachineFileError
from kurbel.machine.valve import Eccentric, Link, Valve, ValveEnd
from kurbel.solver.forces import CylinderForces

GEARS: dict[str, Any] = yaml.safe_load(
    Path(__file__).with_name("valve_gears.yaml").read_text(encoding="utf-8")
)
EQUAL_LEADS = GEARS["equal-leads"]["machine"]
NAMES = [
    (gear, command)
    for gear, parts in GEARS.items()
    for command in parts
    if command not in ("machine", "columns")
]


def with_key(text: str, key: str, value: str) -> str:
    """Return a machine file in which a key, such as `valve.lead`, has another value."""
    machine = yaml.safe_load(text)
    *outer, name = key.split(".")
    mapping = machine
    for word in outer:
        mapping = mapping[word]
    mapping[name] = yaml.safe_load(value)
    return str(yaml.safe_dump(machine))


def changed(gear: str, **keys: str) -> str:
    """Return a machine file in which these keys of the valve have other values."""
    text: str = GEARS[gear]["machine"]
    for key, value in keys.items():
        text = with_key(text, f"valve.{key}", value)
    return text


def cylinder(text: str) -> CylinderForces:
    return kurbel.solve(text).cylinders[0]


def events(text: str, *ids: str) -> list[float]:
    results = cylinder(text)
    return [results[id].value for id in ids]


@pytest.mark.parametrize(("gear", "command"), NAMES)
def test_key_values_are_those_of_the_independent_calculation(gear: str, command: str) -> None:
    case = kurbel.solve(GEARS[gear]["machine"])
    wrong = {}
    for id, expected in GEARS[gear][command].items():
        value, degrees = expected if isinstance(expected, list) else (expected, None)
        figure = case[id]
        near = figure.value == pytest.approx(value, rel=1e-9, abs=1e-11)
        there = degrees is None or figure.degrees == pytest.approx(degrees, abs=1e-7)
        if not (near and there):
            wrong[id] = figure, expected
    assert not wrong


@pytest.mark.parametrize("gear", [gear for gear, parts in GEARS.items() if "columns" in parts])
def test_columns_are_those_of_the_independent_calculation(gear: str) -> None:
    results = cylinder(GEARS[gear]["machine"])
    for id, expected in GEARS[gear]["columns"].items():
        values = results.columns(list(expected), id)[id]
        assert values == pytest.approx(list(expected.values()), abs=1e-12), id


def test_all_figures_are_held() -> None:
    figures = [
        parts[command]
        for parts in GEARS.values()
        for command in parts
        if command not in ("machine", "columns")
    ]
    columns = [values for parts in GEARS.values() for values in parts.get("columns", {}).values()]
    assert sum(map(len, figures)) + sum(map(len, columns)) == 138


REFUSED = {
    "valve.steam_lap=43 mm": "lap and lead (46 mm) are more than half the travel (45 mm)",
    "valve.lead=-1 mm": "opens to steam only after the dead centre",
    "valve.exhaust_lap=-25 mm": "open to steam and exhaust at once, since the laps together are -3 mm",
    "indicator.head_end.steam.cut_off=0.4": "the 'valve' sets cut_off",
    "indicator.head_end.steam.release=1.0": "the 'valve' sets cut_off",
    "offset=20 mm": "dead centres at 0° and 180°",
}


@pytest.mark.parametrize(("change", "says"), REFUSED.items())
def test_what_a_valve_cannot_be_is_refused(change: str, says: str) -> None:
    result = run("forces", "-", "--set", change, text=EQUAL_LEADS)
    assert result.exit_code == 2, result.output
    assert says in result.stderr


MORE_REFUSED = {
    "valve.steam_lap=-1 mm": "head end: a steam lap is not negative",
    "valve.exhaust_lap=46 mm": "head end: never opens to the exhaust; its lap must be less than half the travel",
    "valve.exhaust_lap=26 mm": "head end: opens to the exhaust only after the dead centre, where it overlaps by 1 mm",
    "valve.eccentric_rod=45 mm": "45 mm is no longer than the eccentricity (45 mm)",
    "valve.angle_of_advance=30 deg": "'lead' and 'angle_of_advance' mean the same",
    "valve.link={half_length: 150 mm, position: 0.5}": "of a link the lead follows; give 'angle_of_advance' instead",
    "indicator.head_end.steam.clearance=0": "compression needs a final volume; give 'clearance'",
    "valve.lead=3 deg": "deg",
    "tandem=[{bore: 500 mm, indicator: {head_end: {steam: {admission: 2 at, exhaust: 0 at, clearance: 0.1}}}}]": (
        "tandem[0].indicator.head_end.steam: 'cut_off' is missing"
    ),
}


@pytest.mark.parametrize(("change", "says"), MORE_REFUSED.items())
def test_more_that_a_valve_cannot_be(change: str, says: str) -> None:
    result = run("forces", "-", "--set", change, text=EQUAL_LEADS)
    assert result.exit_code == 2, result.output
    assert says in result.stderr


def test_a_valve_that_is_not_set_and_a_card_without_events_are_refused() -> None:
    with pytest.raises(MachineFileError, match="how is the valve set"):
        kurbel.solve(EQUAL_LEADS.replace("  lead: 3 mm\n", ""))
    with pytest.raises(
        MachineFileError, match="'cut_off' is missing; give it here, or the cylinder a 'valve'"
    ):
        kurbel.solve(EQUAL_LEADS.partition("valve:")[0])


def test_a_machine_without_laps_and_lead_neither_expands_nor_compresses() -> None:
    """The engines before the lap: steam is admitted and leaves over the whole strokes."""
    text = changed("zeuner", steam_lap="0 mm", exhaust_lap="0 mm", lead="0 mm")
    names = [
        f"{event}_{end}"
        for end in ("head", "crank")
        for event in ("cut_off", "release", "compression", "admission")
    ]
    assert events(text, *names) == [1, 1, 0, 0] * 2
    area = math.pi / 4 * (2 * 0.35**2 - 0.06**2)
    assert cylinder(text).work == pytest.approx((9 - 0.15) * 98066.5 * area * 0.6, rel=1e-12)


# laws


@pytest.mark.parametrize("seed", range(12))
def test_an_event_is_where_an_edge_of_the_valve_passes_that_of_the_port(seed: int) -> None:
    """For random valves; w is that of the eccentric as a slider-crank of kurbel, with another formula."""
    random = np.random.default_rng(seed)
    S_H, S_C = random.uniform(10, 25, 2)
    E_H, E_C = random.uniform(-3, 4, 2)
    v_H, v_C = random.uniform(0, 5, 2)
    r, length = random.uniform(32, 60), random.uniform(62, 900)
    inside, rocker = (bool(integer) for integer in random.integers(0, 2, 2))
    gear = {
        "eccentricity": f"{r} mm",
        "steam_lap": {"head_end": f"{S_H} mm", "crank_end": f"{S_C} mm"},
        "exhaust_lap": {"head_end": f"{E_H} mm", "crank_end": f"{E_C} mm"},
        "lead": {"head_end": f"{v_H} mm", "crank_end": f"{v_C} mm"},
        "eccentric_rod": f"{length} mm",
        "admission": "inside" if inside else "outside",
        "reversing_rocker": str(rocker).lower(),
    }
    results = cylinder(yaml.safe_dump({"stroke": "600 mm", "rod": "1500 mm", "valve": gear}))
    wanted = {
        "admission": (S_H, -S_C),
        "cut_off": (S_H, -S_C),
        "release": (-E_H, E_C),
        "compression": (-E_H, E_C),
    }
    for event, edges in wanted.items():
        for end, edge in zip(("head", "crank"), edges):
            degrees = results[f"{event}_{end}"].degrees
            assert degrees is not None
            assert results.at([degrees]).valve[0] == pytest.approx(1e-3 * edge, abs=1e-15)
    delta, shift = results["advance"].value, results["valve_shift"].value
    eccentric = kurbel.solve(f"{{crank: {r} mm, rod: {length} mm}}").cylinders[0]
    phi = np.arange(0.0, 360.0, 7.0)
    if (
        inside == rocker
    ):  # a quarter turn and δ ahead of the crank; the head end opens toward the shaft
        w = eccentric.at(phi + 90 + delta).x - 1e-3 * r
    else:
        w = 1e-3 * r - eccentric.at(phi - 90 + delta).x
    assert results.at(phi).valve == pytest.approx(w + shift, abs=1e-15)


def test_the_cards_have_the_events_of_their_own_ends() -> None:
    """The same machine with these fractions written into two cards has the same forces."""
    steam = "{{admission: 9 at, exhaust: 0.15 at, clearance: 0.06, cut_off: {}, release: {}, compression: {}, lead: {}}}"
    names = ("cut_off", "release", "compression", "admission")
    by_valve = cylinder(EQUAL_LEADS)
    written = (
        EQUAL_LEADS.partition("indicator:")[0] + "masses: {reciprocating: 200 kg}\nindicator:\n"
    )
    for end in ("head", "crank"):
        fractions = (repr(by_valve[f"{name}_{end}"].value) for name in names)
        written += f"  {end}_end: {{steam: {steam.format(*fractions)}}}\n"
    by_hand = cylinder(written)
    phi = np.arange(0.0, 360.0, 3.0)
    for id in ("p_head", "p_crank", "T", "N"):
        assert by_valve.at(phi)[id] == pytest.approx(by_hand.at(phi)[id], rel=1e-12, abs=1e-6), id
    assert by_valve.work == by_hand.work


def test_a_machine_without_bore_has_events_alone() -> None:
    case = kurbel.solve(GEARS["unequal-laps"]["machine"])
    assert case["cut_off_head"].value == pytest.approx(0.810638130483175)
    assert case.cylinders[0].valve_gear.steam_speed_head is None  # type: ignore[union-attr]


def test_turned_twice_the_valve_is_as_it_was() -> None:
    names = ("cut_off_head", "cut_off_crank", "valve_shift")
    assert events(changed("inside", reversing_rocker="true"), *names) == events(EQUAL_LEADS, *names)


def test_an_eccentric_rod_nearly_as_short_as_the_eccentricity() -> None:
    """Up to l = r the closed form holds."""
    results = cylinder(
        changed(
            "equal-leads", eccentric_rod="45.0000001 mm", lead="{head_end: 3 mm, crank_end: 3 mm}"
        )
    )
    degrees = results["cut_off_crank"].degrees
    assert degrees is not None
    assert results.at([degrees]).valve[0] == pytest.approx(-0.022, abs=1e-13)


def test_find_names_the_lap_of_a_cut_off() -> None:
    solutions = kurbel.find(
        EQUAL_LEADS, {"valve.steam_lap": ("5 mm", "35 mm")}, "cut_off_head = 0.6"
    )
    assert solutions.found[0].values[0] == pytest.approx(0.02869349641, rel=1e-9)


# batches

VARIED = {
    "valve.steam_lap": ["12 mm", "22 mm", "31 mm"],
    "valve.travel": ["70 mm", "90 mm", "120 mm"],
    "valve.lead": ["0 mm", "1 mm", "3 mm"],
    "valve.eccentric_rod": ["200 mm", "1200 mm"],
    "valve.port_width": ["10 mm", "30 mm"],
    "rod": ["900 mm", "1500 mm", "3000 mm"],
    "speed": ["60 rpm", "90 rpm"],
}
IDS = [
    "cut_off_head",
    "compression_crank",
    "valve_shift",
    "opening_crank",
    "steam_speed_max_head",
    "work",
    "T_max",
]


@pytest.mark.parametrize("key", VARIED)
def test_machines_of_a_sweep_are_as_each_by_itself(key: str) -> None:
    rows = kurbel.sweep(EQUAL_LEADS, {key: VARIED[key]}, IDS)
    for row, text in enumerate(VARIED[key]):
        alone = cylinder(with_key(EQUAL_LEADS, key, text))
        for id in IDS:
            assert rows[id][row] == pytest.approx(alone[id].value, rel=1e-12), (id, text)


@pytest.mark.parametrize("key", ["valve.steam_lap.crank_end", "valve.lead.head_end"])
def test_each_end_has_its_own_lap_in_a_sweep(key: str) -> None:
    text = GEARS["unequal-laps"]["machine"]
    rows = kurbel.sweep(text, {key: ["1 mm", "3 mm"]}, ["cut_off_head", "cut_off_crank"])
    for row, length in enumerate(("1 mm", "3 mm")):
        alone = kurbel.solve(with_key(text, key, length))
        assert rows["cut_off_head"][row] == pytest.approx(alone["cut_off_head"].value, rel=1e-13)
        assert rows["cut_off_crank"][row] == pytest.approx(alone["cut_off_crank"].value, rel=1e-13)


def test_notches_of_a_link_in_a_sweep() -> None:
    text = GEARS["link-open"]["machine"]
    positions = ["0", "0.25", "0.5", "1"]
    rows = kurbel.sweep(text, {"valve.link.position": positions}, ["cut_off_head", "valve_travel"])
    for row, position in enumerate(positions):
        alone = kurbel.solve(with_key(text, "valve.link.position", position))
        assert rows["cut_off_head"][row] == pytest.approx(alone["cut_off_head"].value, rel=1e-13)
        assert rows["valve_travel"][row] == pytest.approx(alone["valve_travel"].value, rel=1e-13)


def test_rows_of_a_sweep_that_no_valve_can_have_say_why() -> None:
    rows = kurbel.sweep(
        EQUAL_LEADS, {"valve.steam_lap": ["22 mm", "43 mm", "30 mm"]}, ["cut_off_head"]
    )
    assert np.isnan(rows["cut_off_head"]).tolist() == [False, True, False]


# errors that the figures would catch; the wrong values are of the independent calculation, to their printed digits


def _turned_sense(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Valve, "sense", -1.0)


def _no_shift(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Valve, "shift", 0.0)


def _mean_for_middle(monkeypatch: pytest.MonkeyPatch) -> None:
    """The mean position over a turn on the ports, which is r²/4l off the middle of the travel."""
    monkeypatch.setattr(Valve, "shift", -(0.045**2) / (4 * 1.2))


def _senses_of_the_head(monkeypatch: pytest.MonkeyPatch) -> None:
    """The crank end with σ and ε of the head end."""
    made = Valve._end

    def wrong(valve: Valve, key: str, number: int) -> ValveEnd:
        return made(valve, key, number)._replace(sense=valve.sense, shift=valve.shift)

    monkeypatch.setattr(Valve, "_end", wrong)


def _piston_of_the_head(monkeypatch: pytest.MonkeyPatch) -> None:
    """The crank end with the displacement from the inner dead centre."""

    def wrong(end: ValveEnd, degrees: float, mechanism: Any) -> Any:
        return mechanism.coordinate(CrankAngle.of(degrees - end.dead_centre)) / mechanism.stroke

    monkeypatch.setattr(ValveEnd, "_away", wrong)


def _straight_parabola(monkeypatch: pytest.MonkeyPatch) -> None:
    """(1 − κ) for (1 − κ²)."""
    made = Link.eccentric

    def wrong(link: Link, radius: float, advance: float, rod: float) -> Eccentric:
        kappa, sin_cos = link.position, CrankAngle.of(advance)
        _, _, B, _ = made(link, radius, advance, rod)
        A = radius * (sin_cos.sin + (1 - kappa) * link.half_length / rod * sin_cos.cos)
        return Eccentric(math.hypot(A, B), A, B, 0.0)

    monkeypatch.setattr(Link, "eccentric", wrong)


PLANTED = [
    ("equal-leads", _turned_sense, "cut_off_head", 0.76630),
    ("equal-leads", _no_shift, "cut_off_head", 0.77356),
    ("equal-leads", _mean_for_middle, "cut_off_head", 0.76920),
    ("equal-leads", _mean_for_middle, "cut_off_crank", 0.68415),
    ("equal-leads", _senses_of_the_head, "cut_off_crank", 0.68758),
    ("equal-leads", _piston_of_the_head, "cut_off_crank", 0.76630),
    ("link-open", _straight_parabola, "compression_head", 0.41512),
]


@pytest.mark.parametrize(("gear", "plant", "id", "wrong"), PLANTED)
def test_a_planted_error_gives_another_figure(
    gear: str, plant: Any, id: str, wrong: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    right = GEARS[gear]["motion"][id][0]
    plant(monkeypatch)
    result = kurbel.solve(GEARS[gear]["machine"])[id].value
    assert result == pytest.approx(wrong, abs=6e-6)
    assert abs(result - right) > 1e-3


MISREAD = [
    ("equal-leads", {"exhaust_lap": "-2 mm"}, "release_head", 0.92199),
    ("link-open", {"link.rods": "crossed"}, "compression_head", 0.38603),
    (
        "centred",
        {"travel": "180 mm", "lead": "3 mm", "angle_of_advance": "null"},
        "cut_off_head",
        None,
    ),
    ("unequal-laps", {"steam_lap": "24 mm"}, "cut_off_crank", None),
]


@pytest.mark.parametrize(("gear", "keys", "id", "wrong"), MISREAD)
def test_a_key_that_is_misread_gives_another_figure(
    gear: str, keys: dict[str, str], id: str, wrong: float | None
) -> None:
    """The sign of the exhaust lap, the rods of the link, the travel taken for r, one lap for both ends."""
    text: str = GEARS[gear]["machine"]
    for key, value in keys.items():
        text = with_key(text, f"valve.{key}", value)
    machine = yaml.safe_load(text)
    machine["valve"] = {key: value for key, value in machine["valve"].items() if value is not None}
    (result,) = events(yaml.safe_dump(machine), id)
    assert abs(result - GEARS[gear]["motion"][id][0]) > 1e-3
    assert wrong is None or result == pytest.approx(wrong, abs=6e-6)


def test_openings_end_at_the_port() -> None:
    wide = cylinder(EQUAL_LEADS.replace("  port_width: 30 mm\n  port_length: 280 mm\n", ""))
    narrow = cylinder(EQUAL_LEADS)
    assert narrow.at([240.0]).port_head[0] == pytest.approx(-0.030, abs=1e-15)
    assert wide.at([240.0]).port_head[0] == pytest.approx(-0.04348, abs=6e-6)


def test_the_events_follow_the_connecting_rod() -> None:
    """In a file and in a sweep, where the valve is the same."""
    longer = events(with_key(EQUAL_LEADS, "rod", "3000 mm"), "cut_off_head", "cut_off_crank")
    shorter = events(EQUAL_LEADS, "cut_off_head", "cut_off_crank")
    assert shorter[0] - longer[0] > 0.01
    assert longer[1] - shorter[1] > 0.01
