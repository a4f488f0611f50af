"""What is drawn of a mechanism stands where the mechanism says it does: stiff links, sliders on their lines."""

import math

import numpy as np
import pytest
from test_every_mechanism import MACHINES

from kurbel.crank_angle import CrankAngle
from kurbel.mechanisms import PIN, SHAFT, Mechanism, Sketch
from kurbel.mechanisms.slotted_lever import SlottedLever
from representative import law_of_each

DEGREES = np.linspace(0.0, 360.0, 73)
DRAWN = {name: one for name, one in MACHINES.items() if one.sketch(CrankAngle.of(0.0)) is not None}


def test_every_mechanism_has_a_picture() -> None:
    for name in MACHINES.keys() - DRAWN.keys():
        mechanism = type(MACHINES[name]).__name__
        pytest.fail(f"{mechanism} ({name}) has no picture: give it a method 'sketch'")


def sketch_of(mechanism: Mechanism) -> dict[str, complex]:
    sketch = mechanism.sketch(CrankAngle.of(DEGREES))
    return {
        name: np.broadcast_to(x + 1j * np.asarray(y), DEGREES.shape)
        for name, (x, y) in sketch.joints.items()
    }


def whole(mechanism: Mechanism) -> Sketch:
    sketch = mechanism.sketch(CrankAngle.of(DEGREES))
    return sketch


@law_of_each(DRAWN)
def test_the_crank_is_where_the_crank_angle_is(name: str) -> None:
    joints = sketch_of(DRAWN[name])
    turn = np.exp(1j * np.radians(DEGREES))
    assert np.allclose(joints[PIN], DRAWN[name].crank * turn, rtol=0, atol=1e-14)
    assert (joints[SHAFT] == 0).all()


@law_of_each(DRAWN)
def test_links_are_stiff_unless_something_slides_on_them(name: str) -> None:
    mechanism, joints, sketch = DRAWN[name], sketch_of(DRAWN[name]), whole(DRAWN[name])
    fork = isinstance(mechanism, SlottedLever) and math.isinf(mechanism.link)
    for start, end in sketch.links:
        if fork and (start, end) == ("end", "ram"):
            assert np.allclose(
                joints[start].imag, joints[end].imag, atol=1e-12
            )  # the fork slides along the ram
            continue
        length = abs(joints[start] - joints[end])
        assert np.ptp(length) <= 1e-9 * length.max()
    for joint, (start, end) in sketch.blocks:
        along = joints[end] - joints[start]
        assert (
            np.abs(((joints[joint] - joints[start]) * along.conj()).imag).max() <= 1e-12
        )  # on the line of its slot
    for fixed in sketch.fixed:
        assert np.ptp(abs(joints[fixed])) == 0


@law_of_each(name for name, one in DRAWN.items() if one.swings_cylinder)
def test_the_piston_moves_in_its_cylinder_as_x_does(name: str) -> None:
    mechanism, joints = DRAWN[name], sketch_of(DRAWN[name])
    outward = (joints["trunnion"] - joints["pin"]) / abs(joints["trunnion"] - joints["pin"])
    place = ((joints["piston"] - joints["trunnion"]) * outward.conj()).real
    x = np.asarray(mechanism.coordinate(CrankAngle.of(DEGREES)))
    assert np.allclose(place - place[0], x[0] - x, atol=1e-12)


@law_of_each(name for name, one in DRAWN.items() if one.slides and not one.swings_cylinder)
def test_the_output_moves_as_x_does(name: str) -> None:
    mechanism, joints, sketch = DRAWN[name], sketch_of(DRAWN[name]), whole(DRAWN[name])
    toward = complex(*sketch.toward)
    place = (joints[sketch.output] * toward.conjugate()).real
    x = np.asarray(mechanism.coordinate(CrankAngle.of(DEGREES)))
    assert np.allclose(place - place[0], x - x[0], atol=1e-12)
    ends = [complex(*map(float, end)) for guide in sketch.guides for end in guide]
    assert min((e * toward.conjugate()).real for e in ends) <= place.min() + 1e-9
    assert max((e * toward.conjugate()).real for e in ends) >= place.max() - 1e-9
