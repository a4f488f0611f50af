"""How rods and couplers turn, and how their points move: against mpmath, which knows the two pins alone."""

import math

import numpy as np
import pytest
from mpmath import mp

from kurbel.machine_file import load, loads
from kurbel.solver.case import Case
from kurbel.solver.forces import CylinderForces
from representative import CONFIGS

RPM = 90
OMEGA = 2 * mp.pi * RPM / 60
HEAD = f"speed: {RPM} rpm\n"
POINT = "point: {from: crank_pin, along: 500 mm, across: 120 mm}\n"
SLIDERS = {
    "straight": (HEAD + "crank: 300 mm\nrod: 1300 mm\n", 0.0),
    "offset": (HEAD + "crank: 300 mm\nrod: 1300 mm\noffset: 200 mm\n", 0.2),
    "yoke frame": (HEAD + "mechanism: yoke-frame\ncrank: 300 mm\nrod: 1300 mm\n", 0.0),
}
FOUR_BAR = (
    HEAD + "mechanism: four-bar\ncrank: 100 mm\ncoupler: 300 mm\nrocker: 250 mm\nframe: 330 mm\n"
)
ANGLES = (0.0, 17.0, 90.0, 133.0, 180.0, 251.0, 333.0)


def cylinder(text: str) -> CylinderForces:
    return Case(loads(text)).cylinders[0]


def crosshead_of(offset: float) -> object:
    """Where the crosshead pin stands, from the lengths: L from the crank pin, on its line."""

    def far(phi: mp.mpf) -> tuple[mp.mpf, mp.mpf]:
        rise = mp.mpf(offset) - mp.mpf("0.3") * mp.sin(phi)
        return mp.mpf("0.3") * mp.cos(phi) + mp.sqrt(mp.mpf("1.3") ** 2 - rise**2), mp.mpf(offset)

    return far


def rocker_joint(phi: mp.mpf) -> tuple[mp.mpf, mp.mpf]:
    """Where two circles round crank pin and rocker pivot meet, on the left of the way from the first to the second."""
    a, b, c, d = (mp.mpf(n) / 1000 for n in (100, 300, 250, 330))
    x, y = a * mp.cos(phi), a * mp.sin(phi)
    line = mp.hypot(d - x, y)
    ux, uy = (d - x) / line, -y / line
    foot = (line**2 + b**2 - c**2) / (2 * line)
    height = mp.sqrt(b**2 - foot**2)
    return x + foot * ux - height * uy, y + foot * uy + height * ux


def expected(
    far: object, crank: str, along: mp.mpf, across: mp.mpf, degrees: float
) -> tuple[float, ...]:
    """x, y, v, b of a point of the rod and angle, velocity, acceleration of the rod, by numerical derivatives."""
    R = mp.mpf(crank)

    def line(phi: mp.mpf) -> mp.mpc:
        return mp.mpc(*far(phi)) - R * mp.expj(phi)

    def place(phi: mp.mpf) -> mp.mpc:
        return R * mp.expj(phi) + mp.mpc(along, across) * line(phi) / abs(line(phi))

    def angle(phi: mp.mpf) -> mp.mpf:
        return mp.arg(line(phi))

    with mp.workdps(40):
        phi = mp.mpf(degrees) * mp.pi / 180
        v, b = abs(mp.diff(place, phi)) * OMEGA, abs(mp.diff(place, phi, 2)) * OMEGA**2
        turn = (
            mp.degrees(angle(phi)),
            mp.diff(angle, phi) * OMEGA,
            mp.diff(angle, phi, 2) * OMEGA**2,
        )
        return tuple(float(one) for one in (place(phi).real, place(phi).imag, v, b, *turn))


@pytest.mark.parametrize("name", SLIDERS)
def test_the_rod_and_a_point_of_it(name: str) -> None:
    text, offset = SLIDERS[name]
    s = cylinder(text + POINT).at(ANGLES)
    result = np.array(
        [s.x_point, s.y_point, s.v_point, s.b_point, -s.psi, -s["psi_dot"], -s["psi_ddot"]]
    ).T
    for row, degrees in zip(result, ANGLES):
        along, across = mp.mpf("0.5"), mp.mpf("0.12")
        assert row == pytest.approx(
            expected(crosshead_of(offset), "0.3", along, across, degrees), rel=1e-12, abs=1e-12
        )


def test_the_coupler_of_the_four_bar_and_a_point_of_it() -> None:
    s = cylinder(FOUR_BAR + "point: {from: rocker_pin, along: 50 mm, across: -80 mm}\n").at(ANGLES)
    turn = [s["theta_coupler"], s["theta_coupler_dot"], s["theta_coupler_ddot"]]
    result = np.array([s.x_point, s.y_point, s.v_point, s.b_point, *turn]).T
    for row, degrees in zip(result, ANGLES):
        along, across = mp.mpf("0.25"), mp.mpf("-0.08")
        assert row == pytest.approx(
            expected(rocker_joint, "0.1", along, across, degrees), rel=1e-12, abs=1e-12
        )


def test_mean_speeds_of_the_strokes_after_redtenbacher() -> None:
    """c_a : c_r = β : α (R p. 615), and each is the stroke over its time."""
    motion = Case(load(CONFIGS["shaper"])).cylinders[0].motion
    assert motion.c_return_m / motion.c_work_m == pytest.approx(motion.time_ratio, rel=1e-14)
    assert motion.stroke / motion.c_work_m + motion.stroke / motion.c_return_m == pytest.approx(
        1 / motion.speed
    )
    alpha = math.radians(motion.phi_work) / 2
    assert motion.c_work_m == pytest.approx(
        motion.stroke * motion.speed * math.pi / alpha, rel=1e-14
    )
