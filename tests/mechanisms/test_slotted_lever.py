"""Slotted lever: R 304, 305, its limits, the connecting link, and the lever that turns fully."""

import math

import pytest

from kurbel.errors import KurbelError
from kurbel.machine_file import loads
from kurbel.mechanisms.slotted_lever import SlottedLever
from kurbel.report.commands import report_of
from kurbel.solver.case import Case
from kurbel.tables.frame import Frame


@pytest.mark.parametrize(
    ("crank", "frame", "ratio", "swing"),
    [(120, 240, 2.0, 60.0), (75, 50, 2.735, None)],
)
def test_angles_and_times_need_no_lever(crank, frame, ratio, swing):
    """R. S. Khurmi & J. K. Gupta, Theory of Machines, ex. 5.2 (30° to either side, ratio 2) and 5.4 (Whitworth, 2.735).

    The two strokes part the turn at cos β = r/e, or e/r (R p. 615); no ram, so no x, c, b and stroke.
    """
    case = Case(
        loads(f"speed: 60 rpm\nmechanism: slotted-lever\ncrank: {crank} mm\nframe: {frame} mm")
    )
    report = report_of(case, Frame("motion", (0.0, 90.0), None, "si"))
    reported = {key_value.id: key_value.value for key_value in report.parts[0].key_values}
    # the book rounds the angle of the return stroke to 96.4°
    assert reported["time_ratio"] == pytest.approx(ratio, abs=2e-3)
    half = math.degrees(math.acos(min(crank, frame) / max(crank, frame)))
    assert reported["phi_return"] == pytest.approx(2 * half, rel=1e-14)
    assert reported.get("swing") == (swing and pytest.approx(swing, rel=1e-14))
    assert not {"stroke", "c_m", "c_work_max", "b_max"} & set(reported)
    assert not {"x", "c", "b"} & {column.id for column in report.parts[0].columns}
    assert any("Whitworth" in note for note in report.notes) == (swing is None)


def test_a_slot_that_ends_before_the_pin_does_is_reported() -> None:
    """The pin is MD + r from the pivot at the farthest: 240 + 120 = 360 mm."""
    (reported,) = SlottedLever(0.12, 0.24, 0.3).notes
    assert reported.startswith(
        "The pin slides as far as 360 mm from the lever's pivot, past its end at 300 mm"
    )
    assert SlottedLever(0.12, 0.24, 0.36).notes == ()


@pytest.mark.parametrize(
    ("link", "refused"),
    [
        (0.1416, "does not reach the ram"),
        (0.1418, "gets into line"),
        (0.1546, "gets into line"),
        (0.1547, ""),
    ],
)
def test_a_link_that_is_long_enough(link: float, refused: str) -> None:
    """sin θ = r/e = 0.4 at the ends of the swing, where the end of the lever is R_l √0.84 = 0.4583 m up.

    The ram at h = 0.6 m is 0.1417 m above; lever and link are in line where l cos θ = h − R_l cos θ, l = 0.1547 m.
    """
    lengths = {"crank": 0.1, "frame": 0.25, "lever": 0.5, "ram_height": 0.6}
    assert 0.6 - 0.5 * math.sqrt(0.84) == pytest.approx(0.14174, abs=1e-5)
    assert 0.6 / math.sqrt(0.84) - 0.5 == pytest.approx(0.15465, abs=1e-5)
    if not refused:
        assert SlottedLever(**lengths, link=link).link == link
        return
    with pytest.raises(KurbelError, match=refused):
        SlottedLever(**lengths, link=link)


def test_a_link_below_the_end_of_the_lever() -> None:
    """In the middle of the swing the end is R_l − h = 0.05 m above a ram at h = 0.45 m: there it must reach."""
    lengths = {"crank": 0.1, "frame": 0.25, "lever": 0.5, "ram_height": 0.45}
    assert SlottedLever(**lengths, link=0.0501).link == 0.0501
    with pytest.raises(KurbelError, match="does not reach the ram"):
        SlottedLever(**lengths, link=0.0499)
