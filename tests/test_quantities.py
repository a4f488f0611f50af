"""Declared quantities: each has one definition, and what mechanisms offer joins the lists of their commands."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from kurbel import loads
from kurbel.cli import kurbel
from kurbel.errors import KurbelError, UsageError
from kurbel.machine import Cylinder, Machine
from kurbel.machine.parts import Masses
from kurbel.mechanisms import Mechanism
from kurbel.mechanisms.scotch_yoke import ScotchYoke
from kurbel.quantities import every_quantity
from kurbel.quantity import Quantity, ambiguity, by_id, called, key_value, placed, values_for
from kurbel.report.crank import forces_report
from kurbel.report.frame import Frame
from kurbel.report.whole import report_of
from kurbel.solver.case import Case
from kurbel.solver.figures import Results, part
from representative import case_of
from toy_mechanism import HarmonicCam

pytestmark = pytest.mark.usefixtures("solved_once")

CONFIGS = Path(__file__).parent.parent / "configs"


def test_every_quantity_stands_in_the_list_of_a_command() -> None:
    every = every_quantity()
    assert [one.id for one in every.all_key_values if not one.commands] == []
    assert [one.id for one in every.all_columns if not one.commands and not one.extremes] == []


def test_extremes_derive_from_the_column() -> None:
    found = by_id(*every_quantity().all_key_values)
    assert found["S_max"][:4] == ("S_max", "S_max", "force", "Largest rod force")
    assert found["P_start_min"].symbol == "P_0,min"
    assert found["M_max"].commands == ("flywheel",)


def test_rows_are_attributes_that_are_computed_once() -> None:
    class Pump(Results):
        """Whatever."""

        command, calls = "forces", 0

        @key_value("V_s", "volume", unless=lambda pump: pump.calls > 1)
        def swept(self) -> float:
            """Volume that the piston of an own pump
            sweeps.

            Not in the sentence.
            """
            self.calls += 1
            return 0.5

    class Plant(Results):
        """A part brings its rows to its place."""

        command = "flywheel"

        @key_value("n_1", "ratio")
        def first(self) -> float:
            """First."""
            return 1.0

        @part(Pump)
        def pump(self) -> Pump | None:
            """A pump."""
            return Pump() if self.first else None

        side = values_for(
            {"left": ("l", "on the left"), "right": ("r", "on the right")},
            "n_*",
            "ν_*",
            "ratio",
            "Number of what is *",
            of=lambda plant, which: len(which),
        )

    plant = Plant()
    assert list(plant.rows.key_values) == ["first", "swept", "n_left", "n_right"]
    assert [plant["V_s"].value, plant["n_left"].value, plant["n_right"].value] == [0.5, 4, 5]
    assert plant["V_s"].quantity.text == "Volume that the piston of an own pump sweeps"
    assert plant["V_s"].quantity.commands == ("forces", "flywheel")
    assert plant["ν_r"].quantity.text == "Number of what is on the right"
    assert plant.swept == plant.pump.swept == 0.5  # type: ignore[attr-defined, union-attr]
    assert plant.pump is not None
    assert plant.pump.calls == 1
    plant.pump.calls = 2
    assert plant.rows.key_values["swept"].unless(plant)  # type: ignore[misc]


def test_what_stands_after_another_keeps_its_order() -> None:
    one, two, three = (Quantity(id, id, "force", "", after="a" if id in "bc" else "") for id in "cba")
    assert [quantity.id for quantity in placed((one, two, three))] == ["a", "c", "b"]


class TestACamFromOutside:
    machine = Machine((Cylinder(HarmonicCam(0.02, 0.002), masses=Masses(2.0)),), speed=10.0)

    def test_its_own_column_and_its_extremes(self) -> None:
        (part,) = forces_report(
            Case(self.machine), Frame("forces", np.arange(0.0, 361.0, 1.0).tolist(), None, "si")
        ).parts
        columns = {column.id: column.values for column in part.columns}
        values = {value.id: value.value for value in part.key_values}
        ids = [column.id for column in part.columns]
        assert ids.index("M_tilt") == ids.index("P") + 1
        omega = 20 * np.pi
        for degrees in (30, 200):  # −m x″ω² x′
            phi = np.radians(degrees)
            slope = 0.02 * np.sin(phi) + 0.002 * np.sin(2 * phi)
            bend = 0.02 * np.cos(phi) + 0.004 * np.cos(2 * phi)
            assert columns["M_tilt"][degrees] == pytest.approx(-2.0 * bend * slope * omega**2, rel=1e-12)
        assert values["M_tilt_max"] == pytest.approx(max(columns["M_tilt"]), rel=1e-3)
        assert values["M_tilt_max"] >= max(columns["M_tilt"])

    @pytest.mark.parametrize("outstroke", [True, False])
    def test_the_inverse_that_it_did_not_supply(self, outstroke: bool) -> None:
        """x = a (1 − u) + k (1 − u²) with u = cos φ is a quadratic in u."""
        way = np.array([0.0, 1e-9, 0.003, 0.02, 0.0399, 0.04])
        u = (-0.02 + np.sqrt(0.02**2 + 4 * 0.002 * (0.022 - way))) / 0.004
        exact = np.degrees(np.arccos(np.clip(u, -1, 1)))
        found = HarmonicCam(0.02, 0.002).crank_angles_at(way, outstroke)
        assert found == pytest.approx(exact if outstroke else 360 - exact, abs=1e-6)


@pytest.mark.parametrize("missing", ["name", "crank", "stroke", "dead_centres", "coordinate", "curvature"])
def test_a_mechanism_that_forgets_something_is_refused_by_name(missing: str) -> None:
    members = {"name": "x", "crank": 1.0, "stroke": 2.0, "dead_centres": None}
    members |= {"coordinate": None, "slope": None, "curvature": None}
    with pytest.raises(UsageError, match=rf"mechanism Half does not define {missing}$"):
        type("Half", (Mechanism,), {name: value for name, value in members.items() if name != missing})


def test_weight_on_the_guide_of_an_inclined_yoke() -> None:
    """There is no connecting rod, but the yoke lies on its guide: m g cos 30°."""
    for inclination, weight in ((30.0, 100 * 9.80665 * np.sqrt(3) / 2), (None, None)):
        cylinder = Cylinder(ScotchYoke(0.2), masses=Masses(100.0), inclination=inclination)
        forces = Case(Machine((cylinder,), speed=1.0)).cylinders[0]
        found = forces.at([0.0, 77.0]).N
        assert found is None if weight is None else found == pytest.approx([weight] * 2, rel=1e-14)
        assert forces.at([0.0]).S is None


# printed symbols as names

ENGINE = "{speed: 60 rpm, crank: 400 mm, rod: 2 m, bore: 450 mm, indicator: {head_end: {constant: %s}}, %s}"
PRESSURE = "{expansion: 5 bar, compression: 1 bar}"


def test_columns_take_printed_symbols() -> None:
    for names in ("phi,psi,p_head,P_inertia", "φ,ψ,p_H,P_b", "phi,psi,p_H,P_b"):
        arguments = ["forces", "-", "-f", "csv", "--angles", "30", "--columns", names]
        printed = CliRunner().invoke(kurbel, arguments, input=ENGINE % (PRESSURE, "masses: {piston: 5 kg}"))
        assert printed.stdout.splitlines()[0] == "phi_deg,psi_deg,p_head_Pa,P_inertia_N"
    assert (
        CliRunner()
        .invoke(kurbel, ["table", "--rows", "ψ,x/R,S/P,c", "-f", "csv"])
        .stdout.startswith("rod_ratio,phi_deg,psi_deg,displacement_factor,rod_force_factor,velocity_factor")
    )


def test_symbols_with_commas_are_names_too() -> None:
    text = (CONFIGS / "gas-engine.yaml").read_text(encoding="utf-8")
    arguments = ["stress", "-", "-f", "csv", "--angles", "0", "--columns", "σ_v,w,A,T,σ_w,A"]
    head = CliRunner().invoke(kurbel, arguments, input=text).stdout.splitlines()[0]
    assert head == "phi_deg,mises_web_A_Pa,T_N,sigma_web_A_Pa"


def test_figures_take_printed_symbols_and_each_quantity_once() -> None:
    figures = "limits: {A_H: 1 m2, T_max: 1 MN, dA/A: 1e-9}, expect: {φ_o: 180 deg ± 1 deg, phi_i: 0 deg ± 1 deg}"
    machine = loads(ENGINE % (PRESSURE, figures))
    assert [id for id, _ in machine.limits] == ["A_head", "T_max", "energy_residual"]
    assert [id for id, _ in machine.expect] == ["phi_odc", "phi_idc"]
    with pytest.raises(KurbelError, match=r"limits.ΔA/A: 'ΔA/A' is the symbol of energy_residual, which is given"):
        loads(ENGINE % (PRESSURE, "limits: {dA/A: 1e-9, ΔA/A: 1e-9}"))
    with pytest.raises(KurbelError, match="'φ_b=0' is a list of values; no bound can be put on it"):
        loads(ENGINE % (PRESSURE, "limits: {φ_b=0: 90 deg}"))


def test_a_symbol_of_two_quantities_is_told() -> None:
    twins = [Quantity(id, "F_x", "force", "Force") for id in ("F_free", "F_bearing")]
    found = called("F_x", twins)
    assert ambiguity("F_x", found) == "'F_x' is the symbol of F_free and of F_bearing; write which"
    assert called("F_free", [*twins, Quantity("G", "F_free", "force", "Force")]) == ("F_free",)


@pytest.mark.parametrize(
    ("command", "name", "part", "units"),
    [
        ("forces", "shaper", 0, {"P_start_max": "kN", "P_start_min": "kN", "P_peak": "kN"}),
        ("flywheel", "compressor-two-stage", 0, {"E_max": "kJ", "E_min": "kJ", "M_mean": "kN m", "M_max": "kN m"}),
        ("bearings", "boxer", 1, {"load_max": "kN", "load_min": "kN", "load_mean": "kN"}),
    ],
)
def test_the_largest_and_the_smallest_share_a_unit(command: str, name: str, part: int, units: dict[str, str]) -> None:
    """P_0,max = 600.0 N stood above P_0,min = −6.000 kN."""
    shown = [
        report_of(case_of(name), Frame(command, (0.0,), (), system)).all_parts[part] for system in ("metric", "si")
    ]
    told, in_si = ({one.id: one for one in one.key_values} for one in shown)
    assert {id: told[id].unit for id in units} == units
    for id in units:
        assert told[id].value * 1000 == pytest.approx(in_si[id].value, rel=1e-15)  # type: ignore[operator]
