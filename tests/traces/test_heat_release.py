"""Heat release of traces whose combustion is known: pressures by quadrature with the integrating factor, made here."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from command import run
from indicated import columns_file, fraction
from kurbel.errors import MachineFileError
from kurbel.machine_file import loads
from kurbel.solver.case import Case

CLEARANCE = 1 / 9
KAPPA = 1.4
HEAT = 1500.0
"""J"""
AREA = np.pi / 4 * 0.09**2
STROKE = 0.1


def burnt(degrees: Any, start: float, duration: float) -> Any:
    """Wiebe's function with a = 5 and exponent 3; it ends with its duration at 1 − e⁻⁵."""
    share = np.clip((np.asarray(degrees) - start) / duration, 0.0, 1.0)
    return 1 - np.exp(-5.0 * share**3)


def volume(degrees: Any) -> Any:
    return (fraction(degrees) + CLEARANCE) * AREA * STROKE


def fired(start: float, duration: float, step: float) -> tuple[Any, Any]:
    """Angles, and pressures in bar of a two-stroke cycle that burns by Wiebe's function.

    p V^κ = p₁ V₁^κ + (κ − 1) Q ∫ V^(κ−1) dx_b, integrated over steps of 0.001° and begun at 1 bar.
    """
    fine = np.arange(-180.0, 180.0 + 5e-4, 1e-3)
    x = burnt(fine, start, duration)
    V = volume(fine)
    middle = volume((fine[1:] + fine[:-1]) / 2)
    added = np.concatenate(([0.0], np.cumsum(middle ** (KAPPA - 1) * np.diff(x))))
    p = (1e5 * V[0] ** KAPPA + (KAPPA - 1) * HEAT * added) / V**KAPPA
    every = round(step / 1e-3)
    return fine[::every][:-1], p[::every][:-1] / 1e5


def machine_text(folder: Path, columns: Any, keys: str) -> str:
    columns_file(folder / "p.csv", np.column_stack(columns), "%.10g")
    return (
        "cycle: two-stroke\nspeed: 1500 rpm\nstroke: 100 mm\nrod_ratio: 4\nbore: 90 mm\n"
        f"indicator: {{pressures: absolute, head_end: {{trace: {{file: '{folder / 'p.csv'}', "
        f"unit: bar{keys}}}}}}}\n"
    )


def angle_of(share: float, start: float, duration: float) -> float:
    """Where so much of what burns in all has burnt, in closed form."""
    return float(start + duration * (-np.log(1 - share * (1 - np.exp(-5.0))) / 5.0) ** (1 / 3))


@pytest.mark.parametrize(("start", "duration"), [(-20.0, 40.0), (-10.0, 40.0), (0.0, 40.0)])
def test_heat_release_gives_the_function_of_wiebe_back(
    tmp_path: Path, start: float, duration: float
) -> None:
    columns = fired(start, duration, 0.1)
    keys = f", clearance: {CLEARANCE}, heat: {{exponent: {KAPPA}}}"
    forces = Case(loads(machine_text(tmp_path, columns, keys))).cylinders[0]
    total = HEAT * (1 - np.exp(-5.0))
    assert forces["heat_released"].value == pytest.approx(total, rel=1e-5)
    for id, share in (("phi_burnt_05", 0.05), ("phi_burnt_50", 0.5), ("phi_burnt_90", 0.9)):
        assert forces[id].value == pytest.approx(angle_of(share, start, duration), abs=2e-3)
    fine = np.arange(start, start + duration, 1e-3)
    rates = HEAT * (burnt(fine + 0.5, start, duration) - burnt(fine - 0.5, start, duration))
    top = int(np.argmax(rates))
    assert forces["heat_rate_max"].value == pytest.approx(float(rates[top]), rel=1e-3)
    apart = (forces["heat_rate_max"].degrees - float(fine[top]) + 180) % 360 - 180
    assert abs(apart) < 0.3

    # over the angle, at samples and between them, before and after combustion
    degrees = np.arange(-60.05, 100.0, 0.55)
    columns = forces.columns(degrees, "x_b", "dQ")
    assert columns["x_b"] == pytest.approx(
        burnt(degrees, start, duration) / burnt(100.0, start, duration), abs=1e-4
    )
    chords = burnt(degrees + 0.5, start, duration) - burnt(degrees - 0.5, start, duration)
    assert columns["dQ"] == pytest.approx(HEAT * chords, abs=0.02)


def test_the_pressures_of_these_tests_are_those_of_another_integrator() -> None:
    """dp = ((κ − 1) dQ − κ p dV)/V by an explicit Runge-Kutta method of order 8."""
    angles, pressures = fired(-10.0, 40.0, 1.0)

    def slope(degrees: float, p: Any) -> Any:
        width = 1e-4
        dV = (volume(degrees + width) - volume(degrees - width)) / (2 * width)
        dx = (burnt(degrees + width, -10.0, 40.0) - burnt(degrees - width, -10.0, 40.0)) / (
            2 * width
        )
        return ((KAPPA - 1) * HEAT * dx - KAPPA * p * dV) / volume(degrees)

    p = np.array([1e5])
    for begin, end in ((-180.0, -10.0), (-10.0, 30.0), (30.0, 90.0)):
        p = solve_ivp(slope, (begin, end), p, "DOP853", rtol=1e-10, atol=1e-3).y[:, -1]
    at = int(np.argmin(np.abs(angles - 90.0)))
    assert p[0] / 1e5 == pytest.approx(float(pressures[at]), rel=1e-7)


def test_heat_is_printed_where_it_is_asked_for_alone(tmp_path: Path) -> None:
    columns = fired(-10.0, 40.0, 0.5)
    path = tmp_path / "m.yaml"
    path.write_text(machine_text(tmp_path, columns, f", clearance: {CLEARANCE}, heat: {{}}"))
    printed = run("forces", str(path), "--key-values", "heat_released phi_burnt_50").output
    assert "Heat released per cycle" in printed
    table = run("forces", str(path), "--columns", "dQ,x_b", "-f", "csv", "--step", "5").output
    assert table.splitlines()[0] == "phi_deg,dQ_J/deg,x_b"
    path.write_text(machine_text(tmp_path, columns, f", clearance: {CLEARANCE}"))
    refused = run("forces", str(path), "--key-values", "heat_released")
    assert refused.exit_code != 0
    assert "heat_released" in refused.output
    refused = run("forces", str(path), "--columns", "x_b")
    assert refused.exit_code != 0
    assert "x_b" in refused.output


def test_heat_needs_a_clearance(tmp_path: Path) -> None:
    with pytest.raises(MachineFileError, match="heat needs the volumes"):
        loads(machine_text(tmp_path, fired(-10.0, 40.0, 1.0), ", heat: {exponent: 1.35}"))
