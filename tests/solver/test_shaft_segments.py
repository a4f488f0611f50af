"""Shaft segments with inertia of their own: natural and forced vibrations, against the wave equation with 40 digits.

Figures without another source are solutions of the transcendental equation of the line with 30 digits.
"""

import math
from functools import partial
from typing import Any

import mpmath
import numpy as np
import pytest

from kurbel.errors import KurbelError
from kurbel.machine_file import loads
from kurbel.solver.case import Case
from kurbel.solver.chapters.torsion import ShaftVibration


def solved(text: str) -> ShaftVibration:
    return Case(loads(text)).torsion


def shaft(*items: str) -> ShaftVibration:
    return solved("name: Line\nshaft:\n" + "".join(f"  - {{{item}}}\n" for item in items))


def frequencies(vibration: ShaftVibration) -> Any:
    """Elastic natural frequencies in Hz."""
    return vibration.modes.omegas[1 - vibration.first :] / (2 * math.pi)


DISC, TUBE = "inertia: 0.5 kg m2", "diameter: 320 mm, bore: 287 mm"


def test_two_discs_on_a_heavy_tube() -> None:
    """409.287 Hz by 400 finite elements; massless it would be 915.7 Hz."""
    line = shaft(DISC, f"{TUBE}, length: 3600 mm", DISC)
    assert frequencies(line) == pytest.approx([409.2864162482708], rel=1e-15)
    assert line.chain.segment_inertias[0] == pytest.approx(10.268423954729565, rel=1e-15)
    massless = shaft(DISC, f"{TUBE}, length: 3600 mm, density: 0 kg/m3", DISC)
    assert frequencies(massless) == pytest.approx([915.7388089530182], rel=1e-15)
    by_stiffness = shaft(
        DISC, f"stiffness: {float(massless.chain.stiffnesses[0])!r} N m/rad, {TUBE}", DISC
    )
    assert by_stiffness.modes.omegas.tolist() == massless.modes.omegas.tolist()


def test_a_divided_shaft_is_the_whole_one() -> None:
    """Two halves without a mass between them: a joint, one mode more; with dampers they could not be combined."""
    half = f"{TUBE}, length: 1800 mm"
    line = shaft(DISC, half, half, DISC)
    assert frequencies(line) == pytest.approx([409.2864162482708, 819.9167096900991], rel=1e-15)
    assert [mass.name for mass in line.line.masses] == ["mass 1", "joint 1", "mass 2"]
    assert [len(line.modes.nodes(mode)) for mode in range(3)] == [0, 1, 2]
    assert line.modes.nodes(1) == ((1, 0.0),)
    assert len(shaft(DISC, f"{half}, damping: 1 N m s/rad", half, DISC).line.segments) == 2


def test_friswell_9_9() -> None:
    """Friswell et al., Dynamics of Rotating Machines, ex. 9.9: 50 elements give 1.9106, 3.8232, 5.7394, 7.6613 Hz."""
    piece = (
        "diameter: 780 mm, bore: 650 mm, length: 200 m, shear_modulus: 75 GPa, density: 8000 kg/m3"
    )
    line = shaft("inertia: 200 kg m2", piece, piece, piece, piece, "inertia: 10 kg m2")
    exact = [1.9103322936176652, 3.820664759125108, 5.73099756835631, 7.64133089303371]
    assert frequencies(line) == pytest.approx(exact, rel=1e-14)
    assert frequencies(line) == pytest.approx([1.9106, 3.8232, 5.7394, 7.6613], rel=3e-3)
    assert [len(line.modes.nodes(mode)) for mode in range(5)] == [0, 1, 2, 3, 4]


def test_more_than_half_a_wave_in_one_segment() -> None:
    """α = 2.86 and 5.73; without the whole half waves the count of modes would lead to 50 kHz."""
    coupling = "inertia: 0.01 kg m2"
    line = shaft(DISC, "stiffness: 1e9 N m/rad", coupling, f"{TUBE}, length: 3600 mm", DISC)
    assert frequencies(line) == pytest.approx([408.8710402545139, 818.786021991402], rel=1e-15)
    assert [len(line.modes.nodes(mode)) for mode in range(3)] == [0, 1, 2]


def test_rods_in_closed_form() -> None:
    """Held at one end, with a tiny disc at the other, and twice that held at both ends: f = c/(4 l)."""
    speed_of_sound = math.sqrt(80e9 / 8000)
    rod = "diameter: 0.1 m, length: 1 m, shear_modulus: 80 GPa, density: 8000 kg/m3"
    items = [f"{{{rod}}}", "{inertia: 1e-15 kg m2}", f"{{{rod}}}"]
    held = solved(f"shaft: [ground, {', '.join(items[:2])}]")
    assert frequencies(held) == pytest.approx([speed_of_sound / 4], rel=1e-12)
    both = solved(f"shaft: [ground, {', '.join(items)}, ground]")
    assert frequencies(both) == pytest.approx([speed_of_sound / 4], rel=1e-12)


FAN = """
name: Fan on a long shaft
speed: 600 rpm
effort: {unit: N m, mean: 1000, harmonics: [[3, 400, 0], [6, 0, 150]]}
shaft:
  - {name: motor, inertia: 0.8 kg m2}
  - {diameter: 60 mm, length: 2.4 m, loss_factor: 0.01}
  - {name: coupling, inertia: 0.15 kg m2}
  - {diameter: 70 mm, bore: 30 mm, length: 1.6 m, loss_factor: 0.02}
  - {name: fan, inertia: 5 kg m2, load: true, damping: 2 N m s/rad}
"""


def test_forced_vibration_of_a_long_shaft() -> None:
    line = solved(FAN)
    assert frequencies(line) == pytest.approx([33.86741274565363, 158.33386479091828], rel=1e-15)
    wanted = [1.0, 0.15769556989761205, -0.16748373836631944]
    assert line.holzer(1).angles == pytest.approx(wanted, rel=1e-13)
    assert [segment.M_vibratory for segment in line.segments] == pytest.approx(
        [1590.3757978235722, 1617.9727489105662], rel=1e-11
    )
    assert [segment.tau_vibratory for segment in line.segments] == pytest.approx(
        [37498691.79219827, 24862876.212961238], rel=1e-11
    )
    assert line.vibration_loss == pytest.approx(99.18127790047033, rel=1e-11)
    massless = solved(
        FAN.replace("length: 2.4 m", "length: 2.4 m, density: 0 kg/m3").replace(
            "length: 1.6 m", "length: 1.6 m, density: 0 kg/m3"
        )
    )
    assert [segment.M_vibratory for segment in massless.segments] == pytest.approx(
        [1532.5469, 1558.4285], rel=1e-7
    )
    assert massless.vibration_loss == pytest.approx(92.54445291532, rel=1e-11)


def test_every_order_of_a_long_shaft_by_transfer_matrices() -> None:
    """Angle and torque carried along the line with 40 digits, T′ = −ω² (J_s/l) θ and θ′ = −T/(k l); also the power."""
    line = solved(FAN)
    vibration = line.vibration
    chain = line.chain
    for order in range(len(vibration.acting.orders)):
        omega = float(vibration.acting.orders[order] * vibration.omegas[0])
        driving = vibration.driving[:, 0, order]
        if not driving.any():
            continue
        with mpmath.workdps(40):
            state, places = (
                mpmath.matrix([[1, 0], [0, 0]]),
                [],
            )  # by the first angle, and a constant part
            for mass in range(3):
                own = omega**2 * mpmath.mpf(float(chain.inertias[mass])) - 1j * omega * float(
                    chain.mass_damping[mass]
                )
                state[1, 0] += own * state[0, 0]
                state[1, 1] += own * state[0, 1] + mpmath.mpc(complex(driving[mass]))
                if mass == 2:
                    break
                spring = mpmath.mpf(float(chain.stiffnesses[mass])) * (
                    1 + 1j * mpmath.mpf(float(chain.loss[mass]))
                )
                alpha = omega * mpmath.sqrt(
                    mpmath.mpf(float(chain.segment_inertias[mass])) / spring
                )
                for share in (0, mpmath.mpf(1) / 2, 1):
                    sin, cos = mpmath.sin(alpha * share), mpmath.cos(alpha * share)
                    along = (
                        mpmath.matrix([[cos, -sin / (spring * alpha)], [spring * alpha * sin, cos]])
                        * state
                    )
                    places.append(along)
                state = along.copy()
            first = -state[1, 1] / state[1, 0]
            exact = np.array([complex(place[1, 0] * first + place[1, 1]) for place in places])
        result = vibration.torques[:, 0, order]
        assert result == pytest.approx(exact, abs=1e-12 * np.abs(exact).max())
    speeds = 1j * vibration.acting.orders * vibration.omegas[0] * vibration.angles[:, 0]
    power = (vibration.driving[:, 0] * speeds.conj()).real.sum() / 2
    assert power == pytest.approx(vibration.loss[0], rel=1e-12)


def random_line(draw: np.random.Generator, count: int, held: bool) -> tuple[str, list[Any]]:
    """A row of masses and rods as a file, and as figures (J, k, J_s)."""
    items, figures = ["ground"] * held, []
    for number in range(count):
        if number or held:
            stiffness, inertia = 10 ** draw.uniform(3, 5), 10 ** draw.uniform(-3, 1)
            # k = G I/l, J_s = ρ I l with I_p = π/32 d⁴ of d = 1 m
            area = math.pi / 32
            modulus, density = stiffness / area, inertia / area
            items.append(
                f"{{diameter: 1 m, length: 1 m, shear_modulus: {modulus!r} Pa, density: {density!r} kg/m3}}"
            )
            figures.append((stiffness, inertia))
        mass = float(10 ** draw.uniform(-2, 1))
        items.append(f"{{inertia: {mass!r} kg m2}}")
        figures.append(mass)
    return f"shaft: [{', '.join(items)}]", figures


def left_behind(figures: list[Any], held: bool, omega: Any) -> Any:
    """The torque left behind the last mass at ω, by the wave equation along each rod."""
    angle, torque = (mpmath.mpf(0), mpmath.mpf(-1)) if held else (mpmath.mpf(1), mpmath.mpf(0))
    for figure in figures:
        if isinstance(figure, float):
            torque += omega**2 * figure * angle
            continue
        stiffness, inertia = map(mpmath.mpf, figure)
        alpha = omega * mpmath.sqrt(inertia / stiffness)
        sin, cos = mpmath.sin(alpha), mpmath.cos(alpha)
        far = angle * cos - torque * sin / (stiffness * alpha)
        torque = torque * cos + stiffness * alpha * angle * sin
        angle = far
    return torque


@pytest.mark.parametrize("held", [False, True])
@pytest.mark.parametrize("count", [2, 5])
def test_every_frequency_is_a_root_and_none_is_missing(count: int, held: bool) -> None:
    """The torque behind the last mass is zero to 15 digits; of 40 finite elements a rod as many are below."""
    for seed in range(4):
        text, figures = random_line(np.random.default_rng(seed), count, held)
        line = solved(text)
        left = partial(left_behind, figures, held)
        for index, omega in enumerate(line.modes.omegas.tolist()):
            if omega == 0:
                continue
            with mpmath.workdps(40):
                exact = mpmath.findroot(
                    left, (omega * (1 - 1e-9), omega * (1 + 1e-9)), tol=1e-30, verify=False
                )
            assert omega == pytest.approx(float(exact), rel=4e-15)
            assert line.modes.holzer(index).residual < 1e-12
            assert index == below(figures, held, omega * (1 - 5e-3))


def below(figures: list[Any], held: bool, omega: float) -> int:
    """How many modes of the line in finite elements, 40 a rod, are below ω."""
    springs, masses = [], []
    for figure in figures:
        if isinstance(figure, float):
            if not masses and not held:
                masses.append(0.0)
            masses[-1] += figure
        else:
            if not masses:
                masses.append(0.0)
            for _ in range(40):
                springs.append(figure[0] * 40)
                masses[-1] += figure[1] / 80
                masses.append(figure[1] / 80)
    inertias = np.array(masses)
    stiffness = (
        np.diag(np.r_[springs, 0.0] + np.r_[0.0, springs])
        - np.diag(springs, 1)
        - np.diag(springs, -1)
    )
    scaled = stiffness / np.sqrt(np.outer(inertias, inertias))
    if held:
        scaled = scaled[1:, 1:]
    return int((np.linalg.eigvalsh(scaled) < omega**2).sum())


def test_a_heavy_segment_behind_a_gear() -> None:
    """Stiffness and inertia both go with u²: the wave along the segment is as long as without the gear."""
    plain = shaft(DISC, f"{TUBE}, length: 3600 mm", DISC)
    geared = shaft("inertia: 1e-12 kg m2", "gear: 2", DISC, f"{TUBE}, length: 3600 mm", DISC)
    assert geared.chain.segment_inertias == pytest.approx(
        4 * plain.chain.segment_inertias, rel=1e-15
    )
    assert frequencies(geared) == pytest.approx(frequencies(plain), rel=1e-11)


def test_density_needs_a_length() -> None:
    with pytest.raises(KurbelError, match="density"):
        shaft(DISC, "stiffness: 1e5 N m/rad, density: 7850 kg/m3", DISC)


def test_stiffness_per_degree() -> None:
    line = shaft(DISC, "stiffness: 1000 N m/deg", DISC)
    assert line.chain.stiffnesses[0] == pytest.approx(1000 * 180 / math.pi, rel=1e-15)
