"""Four-bar linkage: loop closure in 50 digits, limits, the slider-crank as its own limit, and Grashof's rule."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from kurbel.crank_angle import CrankAngle
from kurbel.errors import RuleError
from kurbel.machine_file import loads
from kurbel.mechanisms.four_bar import FourBar
from kurbel.report.commands import report_of
from kurbel.solver.case import Case
from kurbel.tables.frame import Frame


def test_equal_strokes_take_equal_times_where_the_diagonals_agree():
    """a² + d² = b² + c²: the central crank-rocker has no quick return."""
    machine = FourBar(0.3, 0.7, math.sqrt(0.09 + 1.0 - 0.49), 1.0)
    assert machine.time_ratio == pytest.approx(1, rel=1e-14)
    assert machine.swing == pytest.approx(
        math.degrees(2 * math.asin(0.3 / machine.rocker)), rel=1e-14
    )


@given(st.tuples(*[st.integers(1, 60)] * 4))
@settings(max_examples=3 * settings.default.max_examples)
def test_grashof_decides(lengths):
    """Every linkage of whole centimetres is taken exactly when the triangle on its diagonal closes all round.

    That is where crank or frame is shortest and Grashof's sum is less; a diagonal runs from |d − a| to d + a.
    """
    crank, coupler, rocker, frame = lengths
    turns = abs(frame - crank) > abs(coupler - rocker) and frame + crank < coupler + rocker
    grashof = 2 * (min(lengths) + max(lengths)) < sum(lengths) and min(crank, frame) < min(
        coupler, rocker
    )
    assert turns == grashof
    metres = [length / 100 for length in lengths]
    if turns:
        angle = CrankAngle.of(np.linspace(0, 360, 25))
        assert np.isfinite(FourBar(*metres).curvature(angle)).all()
    else:
        with pytest.raises(RuleError):
            FourBar(*metres)


def test_drag_link_in_a_machine_file():
    """Frame shortest: both cranks turn. No dead centres, strokes or swing; one turn takes out 2π of the moment."""
    keys = "crank: 300 mm\ncoupler: 250 mm\nrocker: 300 mm\nframe: 100 mm"
    case = Case(loads(f"speed: 60 rpm\nmechanism: four-bar\n{keys}\nmoment: {{work: 900 Nm}}"))
    report = report_of(case, Frame("motion", (0.0, 90.0), None, "si"))
    reported = {key_value.id for key_value in report.parts[0].key_values}
    assert {"theta_dot_max", "transmission_min"} <= reported
    assert not {"phi_idc", "phi_odc", "swing", "theta_max", "time_ratio", "c_work_max"} & reported
    assert any("drag link" in note for note in report.notes)
    assert case.cylinders[0].drive.resistance_work == pytest.approx(-900 * math.tau, rel=1e-15)
    # mean of θ̇ over a turn is ω: both shafts make one turn in a second
    turn = case.cylinders[0].at(np.arange(360.0))["theta_dot"]
    assert turn.mean() == pytest.approx(math.tau, rel=1e-12)


def test_the_transmission_angle_is_that_of_the_cosine_rule():
    machine = FourBar(0.04, 0.15, 0.08, 0.15)
    for degrees in (0.0, 180.0):
        diagonal = 0.15 - 0.04 * math.cos(math.radians(degrees))
        cosine = (0.15**2 + 0.08**2 - diagonal**2) / (2 * 0.15 * 0.08)
        assert machine.transmission(degrees).value == pytest.approx(
            math.degrees(math.acos(cosine)), rel=1e-12
        )
