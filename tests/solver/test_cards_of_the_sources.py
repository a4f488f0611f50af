"""Lead and diagram factor of ideal cards, metals of shells, a shaper by its stroke, the rod of a yoke frame, L/R."""

import math

import numpy as np
import pytest

import kurbel

STEAM = """
stroke: 500 mm
rod_ratio: %s
speed: 120 rpm
bore: 300 mm
indicator: {head_end: {steam: {admission: 8 bar, exhaust: 0.2 bar, cut_off: 0.3, clearance: 0.07, release: 0.9,
  compression: 0.2%s}%s}}
"""
CONSTANTS = {
    "otto": "peak: 35 bar, intake: 0 bar, exhaust: 0.1 bar, compression_ratio: 6",
    "diesel": "cut_off: 0.06, intake: 0 bar, compression_ratio: 15",
}


def steam(more: str = "", beside: str = "", ratio: str = "5") -> str:
    return STEAM % (ratio, more, beside)


def test_lead_raises_the_pressure_evenly_to_that_of_admission() -> None:
    """Without it the compression line runs to the dead centre; what it adds to ∮ p dz is by hand."""
    plain, led = (kurbel.solve(steam(one)).cylinders[0] for one in ("", ", lead: 0.02"))
    degrees = np.array([345.0, 350.0, 355.0, 359.9])
    z = led.at(degrees).x / 0.5
    begin = (0.2e5 + 1.01325e5) * 0.27 / 0.09 - 1.01325e5  # hyperbola from 0.2 to 0.02, absolute
    straight = 8e5 + (begin - 8e5) * z / 0.02
    assert led.at(degrees).p_head[z < 0.02] == pytest.approx(straight[z < 0.02], rel=1e-9)
    assert led.at(degrees).p_head[z >= 0.02] == pytest.approx(
        plain.at(degrees).p_head[z >= 0.02], rel=1e-12
    )
    grown = (0.2e5 + 1.01325e5) * 0.27 * math.log(0.09 / 0.07) - 1.01325e5 * 0.02
    lost = (begin + 8e5) / 2 * 0.02 - grown
    assert plain.mean_pressure - led.mean_pressure == pytest.approx(lost, rel=1e-10)


@pytest.mark.parametrize("kind", ["steam", *CONSTANTS])
def test_diagram_factor_takes_its_share_of_the_work(kind: str) -> None:
    """p_i is κ_d times the theoretical one, and the pressures are drawn about the back pressure."""
    if kind == "steam":
        texts = [steam(beside=one) for one in ("", ", diagram_factor: 0.8")]
        back = 0.2e5
    else:
        head = "cycle: four-stroke\nstroke: 500 mm\nrod_ratio: 5\nspeed: 120 rpm\nbore: 300 mm\n"
        card = f"{head}indicator: {{head_end: {{{kind}: {{{CONSTANTS[kind]}}}%s}}}}\n"
        texts = [card % one for one in ("", ", diagram_factor: 0.8")]
        back = 0.1e5 if kind == "otto" else 0.0
    plain, real = (kurbel.solve(text).cylinders[0] for text in texts)
    assert real.mean_pressure == pytest.approx(0.8 * plain.mean_pressure, rel=1e-12)
    degrees = np.arange(5.0, 360.0, 23.0)
    lowered = back + 0.8 * (plain.at(degrees).p_head - back)
    assert real.at(degrees).p_head == pytest.approx(lowered, rel=1e-11, abs=1e-4)
    assert abs(real.energy_residual) < 1e-12
    result = kurbel.sweep(
        texts[1], {"indicator.head_end.diagram_factor": [0.7, 0.8, 0.9, 1.0]}, ["mean_pressure"]
    )
    assert result["mean_pressure"] == pytest.approx(
        np.array([0.7, 0.8, 0.9, 1]) * plain.mean_pressure, rel=1e-12
    )


def test_shaper_by_its_stroke() -> None:
    """Fork head: s = 2 R_l r/e; a connecting link of equal ends keeps it."""
    shaper = (
        "mechanism: slotted-lever\nframe: 400 mm\nlever: 700 mm\nspeed: 40 rpm\nstroke: 350 mm\n"
    )
    for link in ("", "link: 250 mm\n"):
        machine = kurbel.loads(shaper + link)
        assert machine.cylinders[0].mechanism.crank == pytest.approx(0.1, rel=1e-15)
        assert kurbel.solve(machine).cylinders[0].motion.stroke == pytest.approx(0.35, rel=1e-12)
    result = kurbel.sweep(shaper, {"stroke": [0.2, 0.35]}, ["time_ratio"])
    assert result["time_ratio"][1] == pytest.approx(
        (90 + math.degrees(math.asin(0.25))) / (90 - math.degrees(math.asin(0.25)))
    )


def test_piston_rod_of_a_yoke_frame_is_bent_and_pushed() -> None:
    text = (
        "mechanism: yoke-frame\nstroke: 400 mm\nrod_ratio: 5\nspeed: 60 rpm\nbore: 250 mm\ncrank_end_rod: 60 mm\n"
        "gland: 300 mm\nindicator: {head_end: 5 bar}\n"
    )
    state = kurbel.solve(text).cylinders[0].at([40.0, 90.0, 130.0])
    bending = state["M_bend"] / (math.pi * 0.06**3 / 32)
    push = state.P / (math.pi / 4 * 0.06**2)
    assert state["sigma_bend"] == pytest.approx(bending, rel=1e-13)
    assert state["sigma_rod"] == pytest.approx(push + bending, rel=1e-13)
    assert state["sigma_rod_other"] == pytest.approx(push - bending, rel=1e-13)
    result = kurbel.sweep(text, {"gland": [0.2, 0.3, 0.4, 0.5]}, ["sigma_rod_max"])
    assert result["sigma_rod_max"][1] == pytest.approx(
        kurbel.solve(text).cylinders[0]["sigma_rod_max"].value, rel=1e-12
    )


@pytest.mark.parametrize(("written", "k"), [("gas", 1.0), ("{gas: 0.4}", 0.4)])
def test_rings_pressed_by_the_gas(written: str, k: float) -> None:
    """Friction f π d h k |Δp| against the motion; its work over the cycle by a fine sum."""
    rings = "friction: {rings: {count: 3, height: 10 mm, coefficient: 0.08, pressure: %s}}\n"
    text = f"{steam()}ambient: 1 bar\n{rings % written}"
    cylinder = kurbel.solve(text).cylinders[0]
    surface = 0.08 * math.pi * 0.3 * 0.03 * k
    state = cylinder.at([20.0, 130.0, 200.0, 340.0])
    assert state.F_friction == pytest.approx(
        -np.sign(state.c) * surface * np.abs(state.p_head), rel=1e-12
    )
    degrees = (np.arange(200_000) + 0.5) * 360 / 200_000
    fine = cylinder.at(degrees)
    work = float(np.sum(surface * np.abs(fine.p_head) * np.abs(fine.slope)) * 2 * math.pi / 200_000)
    assert cylinder.friction_works["rings"] == pytest.approx(
        work, rel=1e-5
    )  # p jumps within a cell of the sum
    assert abs(cylinder.energy_residual) < 1e-12
    many = kurbel.sweep(
        text, {"indicator.head_end.steam.cut_off": [0.2, 0.3, 0.4, 0.5]}, ["friction_work", "T_max"]
    )
    assert many["friction_work"][1] == pytest.approx(cylinder.friction_work, rel=1e-12)
    assert many["T_max"][1] == pytest.approx(cylinder.T_max.value, rel=1e-12)


@pytest.mark.parametrize(
    ("metal", "k_v", "cool", "words"),
    [
        ("gunmetal", 24.0, True, "permissible for gun metal (25)"),
        ("gunmetal", 26.0, False, "more than gun metal (25) permits"),
        ("white-metal", 29.0, True, "permissible for white metal (30 to 35)"),
        ("white-metal", 34.0, False, "only for the best white metal"),
        ("white-metal", 36.0, False, "more than white metal (30 to 35) permits"),
    ],
)
def test_metal_of_the_shells(metal: str, k_v: float, cool: bool, words: str) -> None:
    """G: 25 for gun metal, 30 to 35 for white metal, in kgf m/(cm² s)."""
    from kurbel.notes.machine_results import shell_verdict

    result, sentence = shell_verdict(k_v * 98066.5, metal)
    assert result == cool
    assert words in sentence
