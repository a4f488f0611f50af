"""The book's constructions at chosen angles, and its pictures of what each crank and each piston does."""

from dataclasses import replace

import numpy as np
import pytest
from drawn import curve_of, drawn, ids_of

from kurbel.declared.unit_systems import convert
from kurbel.machine_file import loads
from kurbel.pictures.picture import Panel, Picture
from kurbel.pictures.picture_source import PictureOptions
from kurbel.pictures.pictures import pictures
from kurbel.solver.case import Case
from representative import case_of

ANGLES = (0.0, 37.0, 90.0, 145.0, 222.5, 300.0)


def constructed(name: str, id: str) -> tuple[Picture, Case]:
    case = case_of(name)
    (picture,) = pictures(case, (id,), PictureOptions(system="si", angles=ANGLES))
    return picture, case


def places(panel: Panel) -> dict[str, complex]:
    return {mark.figure.name.symbol: complex(mark.x, mark.y) for mark in panel.marks}


@pytest.mark.parametrize("name", ["waterworks", "offset-engine", "yoke-frame-pump"])
def test_ruler_and_compasses_give_what_the_solver_computes(name: str) -> None:
    """R Abb. 1047: x = AG = CE; 1048: c = v_s/cos ψ; 1049: c = MF, the foot G at v sin(φ + ψ)."""
    picture, case = constructed(name, "construction")
    state, v = case.cylinders[0].at(ANGLES), case.cylinders[0].motion.v
    psi = np.radians(np.asarray(state.psi))
    for number in range(len(ANGLES)):
        way, parts, polar = (places(panel) for panel in picture.panels[3 * number : 3 * number + 3])
        x, c = float(state.x[number]), float(state.c[number])
        assert (way["A"] - way["G, x"]).real == pytest.approx(x, abs=1e-12)
        assert (way["E"] - way["C"]).real == pytest.approx(x, abs=1e-12)
        # half a turn later the way from the other dead centre: outward the longer one (R p. 602)
        later = case.cylinders[0].at([ANGLES[number] + 180.0])
        back = case.cylinders[0].motion.stroke - float(later.x[0])
        lengths = {
            mark.figure.name.symbol: mark.figure.value for mark in picture.panels[3 * number].marks
        }
        assert way["D"] == pytest.approx(-way["C"], abs=1e-12)
        assert lengths["x_D"] == pytest.approx(back, abs=1e-12)
        assert (way["x_D"] - way["B"]).real == pytest.approx(back, abs=1e-12)
        assert way["F"].real == way["C"].real
        if name == "waterworks" and x > 1e-9:
            assert lengths["G, x"] >= lengths["x_D"] * (1 - 1e-12)
        figures = {
            mark.figure.name.symbol: mark.figure.value
            for mark in picture.panels[3 * number + 1].marks
        }
        assert figures["v"] == pytest.approx(v)
        assert figures["c"] == pytest.approx(c, abs=1e-12)
        assert figures["v_s"] == pytest.approx(
            v * np.sin(np.radians(ANGLES[number]) + psi[number]), abs=1e-12
        )
        assert polar["F, c"] - polar["M"] == pytest.approx(1j * c, abs=1e-12)
        assert abs(polar["G"]) == pytest.approx(abs(figures["v_s"]), abs=1e-12)
        # the tips of both components and of v lie square to the rod
        rod = np.exp(-1j * psi[number])
        assert ((parts["v"] - parts["v_s"]) * rod.conjugate()).real == pytest.approx(0.0, abs=1e-12)


def test_the_parallel_through_the_foot_gives_the_velocity_of_the_ram() -> None:
    """R Abb. 1071: c = v GH/r, F on the circle over MD, FH parallel to CG.

    Largest velocities v R/(e + r) and v R/(e - r) (R 304, 305); the extreme positions touch the crank circle.
    """
    picture, case = constructed("shaper", "construction")
    for panel, c in zip(picture.panels, case.cylinders[0].at(ANGLES).c):
        at = places(panel)
        assert (at["G"] - at["H"]).real == pytest.approx(float(c), abs=1e-12)
        assert ((at["C"] - at["G"]) * (at["F"] - at["H"]).conjugate()).imag == pytest.approx(
            0.0, abs=1e-12
        )
        assert abs(at["F"] - at["D"] / 2) == pytest.approx(abs(at["D"]) / 2)
        figures = {mark.figure.name.symbol: mark.figure.value for mark in panel.marks}
        lever, frame = abs(at["E"] - at["D"]), abs(at["D"] - at["M"])
        crank = abs(at["C"] - at["M"])
        assert figures["c_1"] == pytest.approx(crank * lever / (frame + crank))
        assert figures["c_2"] == pytest.approx(-crank * lever / (frame - crank))
        for end in (at["A"], at["B"]):
            assert abs(end - at["D"]) == pytest.approx(lever)
            along = (end - at["D"]) / lever
            assert abs(((at["M"] - at["D"]) * along.conjugate()).imag) == pytest.approx(crank)


@pytest.mark.parametrize("name", ["waterworks", "offset-engine", "scotch-yoke-pump"])
def test_the_tangential_force_is_found_on_the_vertical(name: str) -> None:
    """R Abb. 1063; a block that rubs would push the pin across the stroke, too."""
    machine = case_of(name).machine
    without = [
        replace(cylinder, friction=None) if "yoke" in name else cylinder
        for cylinder in machine.cylinders
    ]
    case = Case(replace(machine, cylinders=tuple(without)))
    (picture,) = pictures(case, ("force-polar",), PictureOptions(system="si", angles=ANGLES))
    for panel, force in zip(picture.panels, case.cylinders[0].at(ANGLES).T):
        size = float(np.nanmax(np.abs(panel.curves[0].x)))
        assert places(panel)["T"] == pytest.approx(1j * float(force), abs=1e-12 * size)


def test_the_infinite_rod_is_an_ellipse_and_a_straight_line() -> None:
    """R 289, 295: c′ = v sin φ, b′ = v²/R cos φ over x′ = R(1 − cos φ)."""
    velocity, acceleration = drawn("waterworks", "motion-way")[0].panels
    v = 2 * np.pi * 50 / 60 * 0.4
    ellipse, line = curve_of(velocity, "c, L/R = ∞"), curve_of(acceleration, "b, L/R = ∞")
    from_middle = 1 - ellipse.x / 400
    assert ellipse.y**2 + (v * from_middle) ** 2 == pytest.approx(np.full(len(ellipse.y), v * v))
    assert line.y == pytest.approx(v * v / 0.4 * (1 - line.x / 400), abs=1e-12)
    assert len(drawn("waterworks", "motion")[0].panels[1].curves) == 2
    assert len(drawn("scotch-yoke-pump", "motion")[0].panels[1].curves) == 1


def test_the_pump_is_laid_over_the_steam() -> None:
    """R p. 613: 3490 kg on the outstroke, 3710 kg on the return stroke; with losses only the steam is less."""
    for eta in (1.0, 0.9):
        text = case_of("waterworks").machine.origin.text + f"\nefficiency: {eta}\n"
        case = Case(loads(text))
        (picture,) = pictures(case, ("piston-force-crank",), PictureOptions(system="technical"))
        for panel, pump in zip(picture.panels, (3490.0, -3710.0)):
            assert curve_of(panel, "−P_driven").y == pytest.approx(pump, rel=1e-3)
        out = picture.panels[0]
        symbol = "P_driving" if eta == 1 else "η P_driving"
        x, steam = curve_of(out, symbol).x, curve_of(out, symbol).y
        rest = np.interp(x, curve_of(out, "−P_driven − P_b").x, curve_of(out, "−P_driven − P_b").y)
        P = convert(
            np.asarray(
                case.cylinders[0]
                .at(case.cylinders[0].drive.mechanism.crank_angles_at(x / 1e3, True))
                .P
            ),
            "force",
            "kgf",
        )
        assert (steam / eta - rest)[1:-1] == pytest.approx(P[1:-1], abs=1e-3 * np.ptp(P))
    assert "piston-force-crank" not in ids_of("gas-engine")


@pytest.mark.parametrize("efficiency", ["", "efficiency: 0.9\n"])
def test_cranks_and_sides_add_up_to_the_turning_effort(efficiency: str) -> None:
    """R Abb. 1064 and 1067: the cranks give the sum, the driving side less the pumps gives the effort."""
    case = Case(loads(case_of("waterworks-two-cranks").machine.origin.text + efficiency))
    cranks, sides = (
        next(pictures(case, (id,), PictureOptions(system="si"))).panels[0]
        for id in ("effort-cranks", "effort-sides")
    )
    phi = np.linspace(1.3, 358.7, 200)

    def at(panel: Panel, symbol: str) -> np.ndarray:
        curve = curve_of(panel, symbol)
        return np.interp(phi, curve.x, curve.y)

    size = 1e-3 * np.ptp(curve_of(cranks, "T").y)
    whole = np.asarray(case.flywheel.at(phi).T)
    each = at(cranks, "high pressure"), at(cranks, "low pressure")
    assert sum(each) == pytest.approx(at(cranks, "T"), abs=3 * size)
    assert each[1] == pytest.approx(np.asarray(case.cylinders[1].at(phi + 90.0).T), abs=2 * size)
    assert at(cranks, "T with η" if efficiency else "T") == pytest.approx(whole, abs=2 * size)
    assert at(sides, "T_driving") - at(sides, "−T_driven") == pytest.approx(whole, abs=3 * size)
    assert (curve_of(sides, "−T_driven").y > 0).all()
    assert [mark.figure.at_deg for mark in cranks.marks] == [
        case.flywheel.T_max.degrees,
        case.flywheel.T_min.degrees,
    ]


def test_reversal_of_the_piston_force_and_zero_of_the_acceleration_are_marked() -> None:
    """R Abb. 1055 has J where the force reverses, Abb. 1050 the point where b is 0 and c largest."""
    case = case_of("waterworks")
    options = PictureOptions(system="si")
    (over_stroke,) = pictures(case, ("piston-force-way",), options)
    reversals = [
        m.figure.at_deg for p in over_stroke.panels for m in p.marks if m.figure.name.symbol == "J"
    ]
    assert reversals == pytest.approx(case.cylinders[0].phi_reversal)
    (motion,) = pictures(case, ("motion-way",), options)
    (zero,) = [mark for mark in motion.panels[1].marks if mark.figure.name.symbol == "b = 0"]
    assert zero.figure.at_deg == pytest.approx(case["c_max"].degrees, abs=1e-9)
    assert zero.y == 0.0


@pytest.mark.parametrize(("efficiency", "symbol"), [("1", "P_driving"), ("0.9", "η P_driving")])
def test_efficiency_is_in_a_label_only_where_the_file_has_one(efficiency: str, symbol: str) -> None:
    case = case_of("waterworks")
    case = Case(replace(case.machine, efficiency=float(efficiency)))
    (picture,) = pictures(case, ("piston-force-crank",), PictureOptions(system="si"))
    assert picture.panels[0].curves[0].name.symbol == symbol
