"""Strength of every throw: own free bodies, equal to a 3-D frame of beams with hinges in the bearings to 6e-11.

The frame of beams, its machines and its figures are independent of kurbel: bending and torsion of every place of a
four-cylinder engine, a V8 with rods side by side and as fork and blade, and a three-cylinder two-stroke engine.
"""

from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from command import answer, run
from kurbel.errors import KurbelError
from kurbel.machine_file import loads
from kurbel.solver.case import Case
from kurbel.solver.chapters.stress import CrankshaftStrength

FOUR = """
name: Four in line with crankshaft
speed: 4000 rpm
cycle: four-stroke
cylinders:
  count: 4
  firing_order: 1-3-4-2
  spacing: 96 mm
  each:
    stroke: 90 mm
    rod: 144 mm
    bore: 84 mm
    indicator:
      head_end:
        otto: {intake: -0.1 bar, exhaust: 0.2 bar, peak: 70 bar, compression_ratio: 10, exponent: 1.32}
    masses: {piston: 0.46 kg, connecting_rod: {mass: 0.58 kg, share: 0.31}}
crankshaft:
  a: 48 mm
  b: 48 mm
  web_distance: 24 mm
  web_thickness: 20 mm
  web_width: 72 mm
  pin_diameter: 48 mm
  pin_length: 28 mm
  journal_diameter: 58 mm
  journal_length: 28 mm
  flywheel_mass: 12 kg
  flywheel_position: 40 mm
"""

V8 = """
name: V8 with crankshaft
speed: 5000 rpm
cycle: four-stroke
firing_order: 1-2-7-5-6-3-4-8
cylinders:
  - name: left 1
    axial_position: 0 mm
    stroke: 90 mm
    rod: 155 mm
    bore: 94 mm
    indicator:
      head_end:
        otto: {intake: -0.1 bar, exhaust: 0.2 bar, peak: 65 bar, compression_ratio: 10, exponent: 1.32}
    masses: {piston: 0.52 kg, connecting_rod: {mass: 0.6 kg, share: 0.3}}
  - {like: left 1, name: right 1, bank_angle: 90 deg}
  - {like: left 1, name: left 2, axial_position: 110 mm}
  - {like: right 1, name: right 2, axial_position: 110 mm}
  - {like: left 1, name: left 3, axial_position: 220 mm}
  - {like: right 1, name: right 3, axial_position: 220 mm}
  - {like: left 1, name: left 4, axial_position: 330 mm}
  - {like: right 1, name: right 4, axial_position: 330 mm}
crankshaft:
  a: 55 mm
  b: 55 mm
  web_distance: 33 mm
  web_thickness: 22 mm
  web_width: 82 mm
  pin_diameter: 54 mm
  pin_length: 44 mm
  journal_diameter: 64 mm
  journal_length: 22 mm
"""

THREE = """
name: Three-cylinder two-stroke
speed: 3000 rpm
cylinders:
  count: 3
  crank_positions: [0 deg, 120 deg, 240 deg]
  spacing: 110 mm
  each:
    inclination: 90 deg
    stroke: 76 mm
    rod: 140 mm
    bore: 80 mm
    indicator:
      head_end:
        unit: bar
        compression: [[1, 0.1], [0.8, 0.3], [0.5, 1.1], [0.25, 3.0], [0.1, 7.5], [0, 14]]
        expansion:   [[0, 38], [0.05, 45], [0.12, 33], [0.3, 14], [0.55, 6.5], [0.8, 3.2], [0.9, 1.2], [1, 0.1]]
    masses: {piston: 0.42 kg, connecting_rod: {mass: 0.5 kg, center_of_gravity: 96 mm, inertia: 0.0021 kg m2}}
crankshaft:
  a: 52 mm
  b: 58 mm
  web_distance: 25 mm
  web_thickness: 20 mm
  web_width: 66 mm
  pin_diameter: 46 mm
  pin_length: 30 mm
  journal_diameter: 54 mm
  journal_length: 26 mm
  flywheel_mass: 15 kg
  flywheel_position: 50 mm
  allowable_bending: 120 N/mm2
  allowable_torsion: 60 N/mm2
"""

FORKED = V8.rstrip() + "\n  rod_spacing: 0 mm\n"

OF_FOUR: dict[str, Any] = {
    "worst": {
        "sigma_pin_max": 64109008.10605283,
        "sigma_web_A_max": 84072908.29124895,
        "sigma_web_B_max": 88284043.6785654,
        "sigma_journal_A_max": 14424884.537182756,
        "sigma_journal_B_max": 16326610.633790016,
        "mises_pin_max": 64109008.10605282,
        "mises_web_A_max": 84072908.29124895,
        "mises_web_B_max": 88284043.6785654,
        "mises_journal_A_max": 18109612.8368398,
        "mises_journal_B_max": 18955217.41463968,
        "sigma_pin_dc": 85750000.00000001,
        "sigma_web_A_dc": 110450543.7185832,
        "sigma_web_B_dc": 110450543.71858323,
        "sigma_journal_A_dc": 14176226.987576364,
        "sigma_journal_B_dc": 14176226.987576354,
        "P_dc": 38792.38608652677,
    },
    "throw 1": {
        "sigma_pin_max": 64109008.10605283,
        "sigma_web_A_max": 84072908.29124895,
        "sigma_web_B_max": 88284043.6785654,
        "sigma_journal_A_max": 10598528.873000324,
        "sigma_journal_B_max": 16326610.633790016,
        "mises_pin_max": 64109008.10605282,
        "mises_web_A_max": 84072908.29124895,
        "mises_web_B_max": 88284043.6785654,
        "mises_journal_A_max": 10598528.873000324,
        "mises_journal_B_max": 18955217.41463968,
        "A_max": 14501.11600043309,
        "B_max": 14501.11600043309,
        "M_B_peak": 396.8142834362884,
    },
    "throw 2": {
        "sigma_pin_max": 64109008.10605283,
        "sigma_web_A_max": 83758969.26770106,
        "sigma_web_B_max": 87671873.82728183,
        "sigma_journal_A_max": 14424884.537182756,
        "sigma_journal_B_max": 15298623.41000182,
        "mises_pin_max": 64109008.10605282,
        "mises_web_A_max": 83758969.26770106,
        "mises_web_B_max": 87671873.82728183,
        "mises_journal_A_max": 18109612.8368398,
        "mises_journal_B_max": 17455030.23317394,
        "A_max": 14501.11600043309,
        "B_max": 14501.11600043309,
        "M_B_peak": 357.906505694378,
    },
    "throw 4": {
        "sigma_pin_max": 64109008.10605283,
        "sigma_web_A_max": 83209470.53543998,
        "sigma_web_B_max": 85237457.75417094,
        "sigma_journal_A_max": 12587148.050302016,
        "sigma_journal_B_max": 14813690.479805395,
        "mises_pin_max": 64109008.10605282,
        "mises_web_A_max": 83209470.53543998,
        "mises_web_B_max": 85237457.75417094,
        "mises_journal_A_max": 16153104.501331586,
        "mises_journal_B_max": 18418295.686336447,
        "A_max": 14501.11600043309,
        "B_max": 14501.11600043309,
        "M_B_peak": 402.105250965037,
    },
    "bearings": [
        14501.11600043309,
        17872.967513718468,
        9578.330110398134,
        17872.967513718468,
        14501.11600043309,
    ],
}

OF_V8: dict[str, Any] = {
    "worst": {
        "sigma_pin_max": 45762635.88531543,
        "sigma_web_A_max": 72892752.70352645,
        "sigma_web_B_max": 75018865.95567943,
        "sigma_journal_A_max": 21296955.79667629,
        "sigma_journal_B_max": 21644308.78228901,
        "mises_pin_max": 50756404.18222963,
        "mises_web_A_max": 72892752.70352645,
        "mises_web_B_max": 75018865.95567943,
        "mises_journal_A_max": 26897646.797723323,
        "mises_journal_B_max": 26997945.551799852,
        "sigma_pin_dc": 77033866.7885993,
        "sigma_web_A_dc": 105019924.66163522,
        "sigma_web_B_dc": 105019924.66163519,
        "sigma_journal_A_dc": 11568127.441406254,
        "sigma_journal_B_dc": 11568127.441406239,
        "P_dc": 45108.558116569046,
    },
    "throw 1": {
        "sigma_pin_max": 42791492.42175961,
        "sigma_web_A_max": 59778965.927881375,
        "sigma_web_B_max": 69969156.33482166,
        "sigma_journal_A_max": 6356510.092726948,
        "sigma_journal_B_max": 18593158.47166526,
        "mises_pin_max": 42976858.14016695,
        "mises_web_A_max": 59778965.92788138,
        "mises_web_B_max": 69969156.33482166,
        "mises_journal_A_max": 6356510.092726948,
        "mises_journal_B_max": 23009550.043340158,
        "A_max": 14871.879985174603,
        "B_max": 14670.720496852704,
        "M_B_peak": 674.1119613327479,
    },
    "throw 2": {
        "sigma_pin_max": 44662841.91819358,
        "sigma_web_A_max": 70088741.9266705,
        "sigma_web_B_max": 75018865.95567943,
        "sigma_journal_A_max": 18954183.31168346,
        "sigma_journal_B_max": 21644308.78228901,
        "mises_pin_max": 45236664.5625642,
        "mises_web_A_max": 70088741.9266705,
        "mises_web_B_max": 75018865.95567943,
        "mises_journal_A_max": 23169905.490194477,
        "mises_journal_B_max": 26997945.551799852,
        "A_max": 14871.879985174603,
        "B_max": 14670.720496852706,
        "M_B_peak": 793.3782646613755,
    },
    "throw 4": {
        "sigma_pin_max": 45518502.303504124,
        "sigma_web_A_max": 72892752.70352645,
        "sigma_web_B_max": 71236293.18920806,
        "sigma_journal_A_max": 21052116.313167557,
        "sigma_journal_B_max": 16314046.884143127,
        "mises_pin_max": 47687517.51501794,
        "mises_web_A_max": 72892752.70352645,
        "mises_web_B_max": 71236293.18920806,
        "mises_journal_A_max": 25971399.8619581,
        "mises_journal_B_max": 19444318.590682678,
        "A_max": 14903.840733660767,
        "B_max": 14923.112334660567,
        "M_B_peak": 555.9695899214734,
    },
    "bearings": [
        14871.879985174603,
        19954.786815049974,
        23067.966818313005,
        20194.6118648495,
        14923.112334660567,
    ],
}

OF_FORKED: dict[str, Any] = {
    "worst": {
        "sigma_pin_max": 50276345.19396117,
        "sigma_web_A_max": 69096287.53741746,
        "sigma_web_B_max": 69106280.15617537,
        "sigma_journal_A_max": 21409127.218839917,
        "sigma_journal_B_max": 21366264.159628104,
        "mises_pin_max": 52442619.148689754,
        "mises_web_A_max": 69096287.53741746,
        "mises_web_B_max": 69106280.15617537,
        "mises_journal_A_max": 26931350.66674743,
        "mises_journal_B_max": 26915672.79210823,
        "sigma_pin_dc": 80243611.23812427,
        "sigma_web_A_dc": 87516603.88469604,
        "sigma_web_B_dc": 87516603.88469602,
        "sigma_journal_A_dc": 9640106.201171877,
        "sigma_journal_B_dc": 9640106.201171886,
        "P_dc": 45108.558116569046,
    },
    "throw 2": {
        "sigma_pin_max": 46921654.95048483,
        "sigma_web_A_max": 66210890.5377211,
        "sigma_web_B_max": 62862201.78296249,
        "sigma_journal_A_max": 18754923.925969362,
        "sigma_journal_B_max": 21366264.159628104,
        "mises_pin_max": 49005008.84167503,
        "mises_web_A_max": 66210890.53772109,
        "mises_web_B_max": 62862201.78296249,
        "mises_journal_A_max": 23085851.97322805,
        "mises_journal_B_max": 26915672.79210823,
        "A_max": 11442.671940160732,
        "B_max": 11442.671940160724,
        "M_B_peak": 793.3782646613755,
    },
    "bearings": [
        11442.671940160732,
        17996.942689259726,
        21071.524763834095,
        18366.51712336215,
        12268.987613980928,
    ],
}

OF_THREE: dict[str, Any] = {
    "worst": {
        "sigma_pin_max": 58524087.596278995,
        "sigma_web_A_max": 82732310.2933058,
        "sigma_web_B_max": 92711445.69397578,
        "sigma_journal_A_max": 18865465.466907512,
        "sigma_journal_B_max": 24365921.11367379,
        "mises_pin_max": 59086982.07889045,
        "mises_web_A_max": 76069517.55930533,
        "mises_web_B_max": 92711445.69397578,
        "mises_journal_A_max": 24643587.461608082,
        "mises_journal_B_max": 27362641.24665309,
        "sigma_pin_dc": 64916677.96644287,
        "sigma_web_A_dc": 82242024.80001508,
        "sigma_web_B_dc": 88319021.70642015,
        "sigma_journal_A_dc": 13118799.074856741,
        "sigma_journal_B_dc": 15912863.786540233,
        "P_dc": 22625.126943846513,
        "safety_pin_min": 1.8485234266305361,
        "safety_web_A_min": 1.450461126669512,
        "safety_web_B_min": 1.2943385695451126,
        "safety_journal_A_min": 6.360829008459699,
        "safety_journal_B_min": 4.924911290657417,
    },
    "throw 1": {
        "sigma_pin_max": 57585952.25168193,
        "sigma_web_A_max": 82732310.2933058,
        "sigma_web_B_max": 90205762.75886856,
        "sigma_journal_A_max": 11143915.265698079,
        "sigma_journal_B_max": 23169655.797671184,
        "mises_pin_max": 57984423.1075858,
        "mises_web_A_max": 73563834.62419799,
        "mises_web_B_max": 90205762.75886856,
        "mises_journal_A_max": 11143915.265698079,
        "mises_journal_B_max": 25900425.213328544,
        "A_max": 10133.746911764345,
        "B_max": 9085.428265719755,
        "M_B_peak": 412.9575184595169,
    },
    "throw 2": {
        "sigma_pin_max": 58524087.596278995,
        "sigma_web_A_max": 82732310.29330578,
        "sigma_web_B_max": 92711445.69397578,
        "sigma_journal_A_max": 17757565.1211353,
        "sigma_journal_B_max": 24365921.11367379,
        "mises_pin_max": 59086982.07889045,
        "mises_web_A_max": 76069517.55930533,
        "mises_web_B_max": 92711445.69397578,
        "mises_journal_A_max": 23159578.2576645,
        "mises_journal_B_max": 27362641.24665309,
        "A_max": 10133.746911764345,
        "B_max": 9085.428265719753,
        "M_B_peak": 439.48914839736386,
    },
    "throw 3": {
        "sigma_pin_max": 57006807.63691443,
        "sigma_web_A_max": 82223421.07967594,
        "sigma_web_B_max": 88558287.09877566,
        "sigma_journal_A_max": 18865465.466907512,
        "sigma_journal_B_max": 22480926.715194274,
        "mises_pin_max": 57367912.01475473,
        "mises_web_A_max": 72454376.4913681,
        "mises_web_B_max": 88558287.09877566,
        "mises_journal_A_max": 24643587.461608082,
        "mises_journal_B_max": 25088542.669866294,
        "A_max": 10067.528296088114,
        "B_max": 9297.388341510332,
        "M_B_peak": 399.14376233953567,
    },
    "bearings": [10133.746911764345, 11643.457799870605, 11577.518717058745, 9297.388341510332],
}


def figure(value: Any) -> float:
    return float(getattr(value, "value", value))


def strength(text: str) -> CrankshaftStrength:
    return Case(loads(text)).stress


@pytest.mark.parametrize(
    ("text", "figures"),
    [(FOUR, OF_FOUR), (V8, OF_V8), (FORKED, OF_FORKED), (THREE, OF_THREE)],
    ids=["four in line", "V8", "V8, fork and blade", "three"],
)
def test_figures_of_every_throw(text: str, figures: dict[str, Any]) -> None:
    case = Case(loads(text))
    for part, wanted in figures.items():
        if part == "bearings":
            loads_of = [
                bearing.answers["load_max"].value
                for bearing in case.bearings.parts
                if not bearing.of_rod
            ]
            assert loads_of == pytest.approx(wanted, rel=1e-12)
            continue
        results = case.stress if part == "worst" else case.stress.throws[int(part.split()[1]) - 1]
        for id, value in wanted.items():
            result = results.peak_torque if id == "M_B_peak" else results.answers[id]
            assert abs(figure(result)) == pytest.approx(value, rel=1e-12), (part, id)
    assert case.stress.equilibrium_residual <= 1e-14


def test_torque_goes_through_to_the_flywheel() -> None:
    """What leaves a throw enters the next one; behind the last one it is the torque of the whole engine."""
    case = Case(loads(FOUR))
    angles = np.linspace(0, 720, 50)
    columns = [throw.at(angles) for throw in case.stress.throws]
    assert not columns[0].M_A.any()
    for before, behind in pairwise(columns):
        assert pytest.approx(before.M_B, abs=1e-10) == behind.M_A
    assert pytest.approx(case.flywheel.at(angles).M, abs=1e-9) == columns[-1].M_B


def test_the_order_along_the_shaft_counts_not_that_of_the_file() -> None:
    """Cylinders listed from the flywheel on: the same throws, numbered from the free end."""
    head, _, rest = V8.partition("cylinders:")
    items, shaft = rest.split("crankshaft:")
    turned = items
    for place, other in (("0 mm", "A"), ("110 mm", "B"), ("220 mm", "C"), ("330 mm", "D")):
        turned = turned.replace(f"axial_position: {place}", f"axial_position: {other}")
    for other, place in (("A", "330 mm"), ("B", "220 mm"), ("C", "110 mm"), ("D", "0 mm")):
        turned = turned.replace(f"axial_position: {other}", f"axial_position: {place}")
    backward = strength(f"{head}cylinders:{turned}crankshaft:{shaft}")
    assert [throw.throw.cylinders for throw in backward.throws] == [(6, 7), (4, 5), (2, 3), (0, 1)]


def test_one_throw_of_several_is_that_throw_alone_but_for_the_torque() -> None:
    """Throw 1 of the four carries no torque of others and no flywheel: the single engine without a flywheel."""
    one = (
        FOUR.replace("count: 4", "count: 1")
        .replace("  firing_order: 1-3-4-2\n", "")
        .replace("  spacing: 96 mm\n", "")
    )
    alone = strength(
        one.replace("  flywheel_mass: 12 kg\n", "").replace("  flywheel_position: 40 mm\n", "")
    )
    first = strength(FOUR).throws[0]
    for id, value in alone.answers.items():
        if (
            id in first.answers
            and value is not None
            and not id.startswith(("p_journal", "k_journal"))
        ):
            assert figure(first.answers[id]) == pytest.approx(figure(value), rel=1e-12), id


MILL = """
speed: 75 rpm
cylinders:
  - stroke: 800 mm
    rod_ratio: 5
    bore: 400 mm
    indicator: {head_end: {steam: {admission: 8 bar, cut_off: 0.3, exhaust: 1.2 bar, clearance: 0.05}}}
    axial_position: 0 m
  - {like: cylinder 1, crank_position: 90 deg, axial_position: 3 m}
crankshaft: {overhung: true, a: 300 mm, b: 2.7 m, web_distance: 150 mm, web_thickness: 90 mm, web_width: 240 mm,
             pin_diameter: 120 mm, pin_length: 160 mm, journal_diameter: 200 mm, journal_length: 200 mm,
             flywheel_mass: 6 t, flywheel_position: -1.1 m}
"""


def test_cranks_at_both_ends_of_a_shaft() -> None:
    """Statics anew: the section at the flywheel by the forces on the side of throw 1, in one fixed frame."""
    two = strength(MILL)
    assert [{place.part for place in throw.at_dead_centre} for throw in two.throws] == [
        {"pin", "web_A", "journal_A", "journal_B"},
        {"pin", "web_A", "journal_A"},
    ]
    first, second = two.throws
    angle = 37.0
    state = [throw.at(np.array([angle])) for throw in two.throws]
    # forces on the shaft in the frame of crank 1, x outward along it: −(D − iT) e^{iγ} with γ of the throw
    pins = [
        -np.conj(state[0].D[0] + 1j * state[0].T[0]),
        -np.conj(state[1].D[0] + 1j * state[1].T[0]) * np.exp(1j * np.radians(second.throw.angle)),
    ]
    a, b, f = 0.3, 2.7, -1.1
    # along the shaft from pin 1: bearings at a and b, pin 2 at a + b, flywheel at b + f
    reaction = -(pins[0] * b + pins[1] * (-a)) / (
        b - a
    )  # of the bearing at a, moments about that at b
    moment = pins[0] * (b + f) + reaction * (b + f - a)
    place = next(
        place for place in first._places(*first._next_to([angle])) if place.part == "journal_B"
    )
    section = np.pi * 0.2**3 / 32
    assert place.normal[0] * section == pytest.approx(abs(moment), rel=1e-6)
    torques = [abs(columns.T[0]) * 0.4 for columns in state]
    assert place.torsion[0] * 2 * section == pytest.approx(max(torques), rel=1e-6)


def test_rod_spacing() -> None:
    with pytest.raises(
        KurbelError, match="rod_spacing: 44 mm is not less than the length of the pin"
    ):
        loads(V8.rstrip() + "\n  rod_spacing: 44 mm\n")
    as_default = strength(V8.rstrip() + "\n  rod_spacing: 22 mm\n")
    assert figure(as_default.answers["sigma_web_A_max"]) == pytest.approx(
        OF_V8["worst"]["sigma_web_A_max"], rel=1e-12
    )


def test_report_and_limits() -> None:
    text = THREE + "limits: {safety_pin_min: 1, throw 2.safety_pin_min: 1.5}\n"
    result = answer("stress", "-", text=text)
    assert [part["name"] for part in result["throws"]] == ["throw 1", "throw 2", "throw 3"]
    assert [column["id"] for column in result["throws"][1]["columns"]][7:9] == ["M_A", "M_B"]
    checked = run("check", "-", text=text)
    assert checked.exit_code == 0, checked.stdout
    printed = run("stress", "-", "--places", "--width", "80", text=text).stdout
    assert max(map(len, printed.splitlines())) <= 80
