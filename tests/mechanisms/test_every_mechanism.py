"""Laws that hold for every mechanism; a new one joins by its line in MACHINES, and by its free body in `statics`."""

import dataclasses
import math

import mpmath as mp
import numpy as np
import pytest
from precise import by_radian, exact_angle
from statics import FREE_BODIES

from kurbel.crank_angle import CrankAngle
from kurbel.errors import RuleError
from kurbel.machine import Cylinder, Machine
from kurbel.machine.parts import Moment, RamForce
from kurbel.mechanisms import Mechanism
from kurbel.mechanisms.four_bar import FourBar
from kurbel.mechanisms.kinds import MECHANISMS
from kurbel.mechanisms.oscillating_cylinder import OscillatingCylinder
from kurbel.mechanisms.parallel_crank import ParallelCrank
from kurbel.mechanisms.scotch_yoke import ScotchYoke
from kurbel.mechanisms.slider_crank import SliderCrank, YokeFrame
from kurbel.mechanisms.slotted_lever import SlottedLever
from kurbel.report.commands import report_of
from kurbel.solver.case import Case
from kurbel.tables.frame import Frame
from representative import law_of_each

MACHINES = {
    "straight": SliderCrank(0.4, 2.0),
    "short rod": SliderCrank(0.4, 0.41),
    "infinite rod": SliderCrank(0.4, math.inf),
    "offset": SliderCrank(0.3, 0.5, 0.1),
    "offset to the other side": SliderCrank(0.3, 1.2, -0.2),
    "scotch yoke": ScotchYoke(0.25),
    "scotch yoke, guides and pin": ScotchYoke(0.25, 0.9, 0.05, 0.06),
    "yoke frame": YokeFrame(0.1, 0.5),
    "yoke frame, gland": YokeFrame(0.1, 0.3, gland=0.2),
    "shaper": SlottedLever(0.3, 0.8, 1.3),
    "shaper with pin": SlottedLever(0.3, 0.8, 1.3, pin_diameter=0.05, pin_length=0.07),
    "shaper with link": SlottedLever(0.3, 0.8, 1.3, link=0.5),
    "shaper, ram above": SlottedLever(0.3, 0.8, 1.3, link=0.8, ram_height=1.4),
    "pin close to the pivot": SlottedLever(0.3, 0.301, 0.7),
    "Whitworth": SlottedLever(0.15, 0.1, 0.2),
    "Whitworth with link": SlottedLever(0.15, 0.1, 0.2, link=0.6),
    "Whitworth, ram beside": SlottedLever(0.15, 0.1, 0.2, link=0.6, ram_height=-0.07),
    "slotted lever alone": SlottedLever(0.3, 0.8),
    "Whitworth lever alone": SlottedLever(0.15, 0.1),
    "four-bar": FourBar(0.04, 0.15, 0.08, 0.15),
    "four-bar, nearly flat": FourBar(0.1, 0.3, 0.25, 0.4499),
    "four-bar, long rocker": FourBar(0.1, 0.5, 9.0, 9.0),
    "four-bar, slow back": FourBar(0.04, 0.08, 0.15, 0.15),
    "drag link": FourBar(0.3, 0.25, 0.3, 0.1),
    "drag link, nearly flat": FourBar(0.3, 0.25, 0.2, 0.1499),
    "drag link, long coupler": FourBar(0.2, 2.0, 1.9, 0.05),
    "oscillating cylinder": OscillatingCylinder(0.01, 0.04),
    "oscillating cylinder, trunnions near": OscillatingCylinder(0.3, 0.301),
    "parallel crank": ParallelCrank(0.3, 2.0),
    "parallel crank, heavy coupler": ParallelCrank(0.3, 2.0, 140.0),
}
STROKES = {name: machine for name, machine in MACHINES.items() if not machine.turns}
TURNING = {name: machine for name, machine in MACHINES.items() if machine.turns}
DIRECTIONS = {
    "four-bar": lambda machine, angle: machine.closed_at(angle)[:2],
    "slotted-lever": lambda machine, angle: machine._lever_at(angle)[:2],
    "oscillating-cylinder": lambda machine, angle: machine._direction(angle),
}
"""(sin θ, cos θ) of the member that swings."""
MOVED = {
    name: machine
    for name, machine in MACHINES.items()
    if machine.slides or machine.name in DIRECTIONS
}
SEARCHED = Mechanism.crank_angles_at
ANGLES = (3.0, 47.0, 90.0, 118.0, 177.0, 181.0, 233.0, 291.0, 352.0)


def every(machines=MACHINES):
    return law_of_each(machines.values())


def exact_coordinate(machine):
    """The coordinate as a function for mpmath: an angle by its sine and cosine, a path as it stands."""
    if machine.slides:
        return machine.coordinate
    return lambda angle: mp.atan2(*DIRECTIONS[machine.name](machine, angle))


def exact_swing(machine):
    return lambda angle: mp.atan2(*DIRECTIONS[machine.name](machine, angle))


@every(MOVED)
def test_slope_and_curvature_are_the_derivatives_of_the_coordinate(machine):
    function, size = exact_coordinate(machine), machine.stroke
    for degrees in ANGLES:
        exact = exact_angle(degrees)
        slope, curvature = machine.slope(exact), machine.curvature(exact)
        assert abs(by_radian(function, degrees) - slope) < 1e-14 * (size + abs(slope)), degrees
        assert abs(by_radian(machine.slope, degrees) - curvature) < 1e-14 * (
            size + abs(curvature)
        ), degrees


@every({name: machine for name, machine in MACHINES.items() if machine.name in DIRECTIONS})
def test_the_swing_has_the_derivatives_of_its_angle(machine):
    swing = machine.swing_at(CrankAngle.of(np.array(ANGLES)))
    slopes, curvatures = (
        [by_radian(exact_swing(machine), angle, order) for angle in ANGLES] for order in (1, 2)
    )
    assert list(map(float, slopes)) == pytest.approx(swing.slope, rel=1e-12, abs=1e-14)
    assert list(map(float, curvatures)) == pytest.approx(swing.curvature, rel=1e-11, abs=1e-13)


@every(TURNING)
def test_what_turns_fully_comes_round_with_the_crank(machine):
    """Without a jump, forward all the way, from `start` by `stroke` = 2π, one turn a turn."""
    angles = np.arange(0.0, 360.5, 0.5)
    theta = machine.coordinate(CrankAngle.of(angles))
    assert machine.stroke == math.tau
    assert theta[0] == pytest.approx(machine.start, abs=1e-15)
    assert theta[-1] - theta[0] == pytest.approx(math.tau, rel=1e-14)
    mean = (
        machine.slope(CrankAngle.of(angles))[1:] + machine.slope(CrankAngle.of(angles))[:-1]
    ) / 2
    assert np.diff(theta) == pytest.approx(mean * math.radians(0.5), rel=0.05)
    assert (mean > 0).all()
    assert machine.coordinate(CrankAngle.of(angles - 720.0)) == pytest.approx(
        theta - 4 * math.pi, abs=1e-14
    )
    assert np.degrees(theta) == pytest.approx(
        machine.swing_at(CrankAngle.of(angles)).degrees, abs=1e-12
    )


@every(STROKES)
def test_the_stroke_runs_from_dead_centre_to_dead_centre(machine):
    inner, outer = machine.dead_centres()
    assert 0 < outer - inner < 360
    ends = machine.coordinate(CrankAngle.of(np.array([inner, outer])))
    rounding = 3e-15 * max(machine.stroke, abs(machine.start))
    assert ends == pytest.approx([machine.start, machine.start + machine.stroke], abs=rounding)
    assert machine.slope(CrankAngle.of(np.array([inner, outer]))) == pytest.approx(
        [0, 0], abs=2e-14 * machine.stroke
    )
    out = machine.slope(CrankAngle.of(np.linspace(inner, outer, 91)[1:-1]))
    back = machine.slope(CrankAngle.of(np.linspace(outer, inner + 360, 91)[1:-1]))
    assert (out > 0).all()
    assert (back < 0).all()


INVERSES = [(machine, is_searched) for machine in STROKES.values() for is_searched in (True, False)]
"""By the search that any mechanism has, and by its own formula where it has one."""


@law_of_each(
    (machine, is_searched, outstroke)
    for machine, is_searched in INVERSES
    for outstroke in (True, False)
)
def test_crank_angles_at_is_the_inverse_of_the_coordinate(machine, is_searched, outstroke):
    inverse = SEARCHED if is_searched else type(machine).crank_angles_at
    way = machine.stroke * np.array([0.0, 1e-12, 1e-6, 0.01, 0.3, 0.5, 0.77, 0.999, 1 - 1e-9, 1.0])
    angles = inverse(machine, way, outstroke)
    inner, outer = machine.dead_centres()
    low, high = (inner, outer) if outstroke else (outer, inner + 360)
    assert sorted((angles[0], angles[-1])) == pytest.approx([low, high], abs=1e-9)
    assert ((low - 1e-5 <= angles) & (angles <= high + 1e-5)).all()
    angle = CrankAngle.of(angles)
    # what the rounding of the angle, and that of the coordinate, leave open
    rounding = 3e-15 * max(machine.stroke, abs(machine.start)) + 4e-15 * abs(machine.slope(angle))
    assert (abs(machine.coordinate(angle) - machine.start - way) <= rounding).all()


def test_every_mechanism_is_under_the_laws():
    registered = {record.record for record in MECHANISMS.values()}
    assert {type(machine) for machine in MACHINES.values()} == registered
    assert set(FREE_BODIES) == registered


def loaded(machine):
    """Return the cylinder that works against 900 on the outstroke or working swing and 200 on the other, at 90 rpm."""
    if machine.slides:
        part = {"ram_force": RamForce(900, 200)}
    else:
        part = {"moment": Moment(900) if machine.turns else Moment(900, 200)}
    return Case(Machine((Cylinder(machine, **part),), speed=1.5))


@every()
def test_forces_and_speeds_are_those_of_the_free_body(machine):
    degrees = np.array([*ANGLES, 10.0, 200.0])
    state = loaded(machine).cylinders[0].at(degrees)
    load_ = state.P if machine.slides else state.M_out
    expected = FREE_BODIES[type(machine)](machine, np.exp(1j * np.radians(degrees)), load_)
    per_angle = {"c_block": 1, "theta_dot": 1, "bx_coupler": 2, "by_coupler": 2}
    for id, values in expected.items():
        result = state[id] / (3 * math.pi) ** per_angle.get(id, 0)
        if id == "x":
            result, values = result - result[0], values - values[0]
        if id == "theta":
            result = np.remainder(result - values + 180, 360) + values - 180
        assert result == pytest.approx(values, rel=1e-10, abs=1e-10 * abs(values).max()), id


@every()
def test_of_a_ram_no_sentence_says_piston(machine):
    if not machine.slides:
        return
    forces = loaded(machine).cylinders[0]
    assert forces.rows.key_values["stroke"].of(forces)
    state = forces.at(ANGLES)
    rows = [row for row in forces.rows.key_values.values() if row.of(forces) is not None]
    rows += [row for row in forces.rows.columns.values() if row.of(state) is not None]
    for quantity in (row.quantity for row in rows):
        text = quantity.text if machine.guided else quantity.text.replace("piston rod", "rod")
        assert "piston" not in text, (
            f"the sentence of {quantity.id} says 'piston', and a machine that drives a ram has none: "
            f"add the words for a ram to _OF_RAM of kurbel.quantity, or write it without: {quantity.text}"
        )


@every()
def test_the_force_on_the_pin_has_the_parts_t_and_d(machine):
    """|F| = |P| hypot(q′/R, D/P): what pushes the pin is one force, of the block or of the rod."""
    degrees = np.array(ANGLES)
    state = loaded(machine).cylinders[0].at(degrees)
    offered = [force for id in ("F_pin", "S") if (force := state[id]) is not None]
    assert len(offered) == (state.D is not None)
    if not offered:
        return
    parts = np.hypot(machine.slope(CrankAngle.of(degrees)) / machine.crank, state.D / state.P)
    assert abs(offered[0] / state.P) == pytest.approx(parts, rel=1e-13)


@every(MOVED)
def test_lengths_must_be_positive_and_finite(machine):
    fields = {field.name: getattr(machine, field.name) for field in dataclasses.fields(machine)}
    for wrong in (0.0, -1.0, math.inf, math.nan):
        with pytest.raises(RuleError, match=r"too small|finite|positive|reach|meet|no number"):
            type(machine)(**{**fields, "crank": wrong})


def resized(machine, scale):
    """Return the mechanism with all its lengths, and nothing else, times the scale."""
    fields = {field.name: getattr(machine, field.name) for field in dataclasses.fields(machine)}
    lengths = {key for key, one in machine.KEYS.items() if one.form.kind == "length"}
    return type(machine)(
        **{
            key: value * scale if value and key in lengths else value
            for key, value in fields.items()
        }
    )


POWERS = {"m": 1, "m/s": 1, "m/s^2": 1, "N m": 1, "J": 1, "W": 1, "Pa": -2}
"""Unit -> the power of a length in it where forces stay; angles and ratios stay with them."""
POWERS_OF_A_MOMENT = {**POWERS, "N": -1, "N m": 0, "J": 0, "W": 0}
"""The same where moments stay."""


@law_of_each((machine, word) for machine in MACHINES.values() for word in ("motion", "forces"))
def test_every_answer_grows_with_the_lengths_as_its_unit_demands(machine, command):
    """Twice as large: the same angles and forces, twice the lengths and moments, a quarter of the pressure."""
    frame = Frame(command, (0.0, 33.0, 118.0, 291.0), None, "si")
    parts = [report_of(loaded(one), frame).parts[0] for one in (machine, resized(machine, 2.0))]
    powers = POWERS if machine.slides else POWERS_OF_A_MOMENT
    small, large = (
        {column.id: (column.unit, column.values) for column in part.columns}
        | {key_value.id: (key_value.unit, key_value.value) for key_value in part.key_values}
        for part in parts
    )
    assert list(small) == list(large)
    assert {"x", "theta", "M"} & set(small)
    for id, (unit, values) in small.items():
        power = 1 if id == "coupler_inertia" else powers.get(unit, 0)  # of a mass, which stays
        before, after = (np.array(each, dtype=float) for each in (values, large[id][1]))
        assert after == pytest.approx(
            before * 2.0**power, rel=1e-12, abs=1e-12 * abs(before).max()
        ), id
