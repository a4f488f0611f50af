"""What statics says of every mechanism, from where its joints stand: points and forces are complex numbers.

The shaft is at 0 and the crank pin at R e^(iφ), so that i e^(iφ) points ahead of the pin. Nothing here knows a formula
of the package: a force is where it acts, a rod carries along its line, a block pushes square to its slot.
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from kurbel.mechanisms.four_bar import FourBar
from kurbel.mechanisms.oscillating_cylinder import OscillatingCylinder
from kurbel.mechanisms.parallel_crank import ParallelCrank
from kurbel.mechanisms.scotch_yoke import ScotchYoke
from kurbel.mechanisms.slider_crank import SliderCrank, YokeFrame
from kurbel.mechanisms.slotted_lever import SlottedLever

Expected = dict[str, Any]
"""Id of a column -> its values (n,); c_block and the like over ω, accelerations over ω²."""


def along(force: Any, direction: Any) -> Any:
    """Return the part of a force along a direction of length 1."""
    return (force * np.conj(direction)).real


def moment(arm: Any, force: Any) -> Any:
    """Return the moment of a force on an arm, positive in the sense of rotation."""
    return (np.conj(arm) * force).imag


def on_pin(turn: Any, force: Any) -> Expected:
    """Return T and D of the force on the pin: ahead of it, and toward the shaft."""
    return {"T": along(force, 1j * turn), "D": -along(force, turn)}


def slider_crank(machine: SliderCrank, turn: Any, load: Any) -> Expected:
    """The cylinder stands at the right of the shaft: P pushes to the left, and the guide pushes up or down."""
    pin = machine.crank * turn
    if math.isinf(machine.rod):
        return {**on_pin(turn, -load), "x": -pin.real, "S": load, "N": 0 * load, "psi": 0 * load}
    rise = pin.imag - machine.offset
    crosshead = pin.real + np.sqrt(machine.rod**2 - rise**2) + 1j * machine.offset
    rod = (pin - crosshead) / machine.rod
    thrust = -load / rod.real
    side = thrust * rod.imag
    psi = np.degrees(np.arctan2(rod.imag, -rod.real))
    return {**on_pin(turn, thrust * rod), "x": -crosshead.real, "S": thrust, "N": side, "psi": psi}


def yoke_frame(machine: YokeFrame, turn: Any, load: Any) -> Expected:
    """N bends the piston rod where the stuffing box holds it, gland beyond the crosshead pin at φ = 0."""
    expected = slider_crank(machine, turn, load)
    if machine.gland is None:
        return expected
    box = machine.crank + machine.rod + machine.gland
    return {**expected, "M_bend": expected["N"] * (box + expected["x"])}


def scotch_yoke(machine: ScotchYoke, turn: Any, load: Any) -> Expected:
    """The yoke is upright: its block pushes along the stroke, and slides as fast as the pin rises."""
    pin = machine.crank * turn
    expected = {
        **on_pin(turn, -load),
        "x": -pin.real,
        "F_pin": load,
        "c_block": along(1j * pin, 1j),
    }
    if machine.guide_length is not None:
        expected["N_pair"] = moment(pin, -load) / machine.guide_length
    return expected


def slotted_lever(machine: SlottedLever, turn: Any, load: Any) -> Expected:
    """The lever's pivot stands left of the shaft, and the ram moves upward on a line square to both.

    Without a ram the load is a moment on the lever.
    """
    pin = machine.crank * turn
    reach = abs(pin + machine.frame)
    lever = (pin + machine.frame) / reach
    ahead = 1j * lever
    turning = along(1j * pin, ahead) / reach
    moved = {
        "theta": np.degrees(np.angle(lever)),
        "theta_dot": turning,
        "c_block": along(1j * pin, lever),
    }
    if machine.lever is None:
        return {**moved, "T": on_pin(turn, load / reach * ahead)["T"]}
    end = machine.lever * lever
    ram, push = end.imag, 1j * load
    if not math.isinf(machine.link):
        low = (
            0.0
            if machine.frame < machine.crank
            else math.sqrt(1 - (machine.crank / machine.frame) ** 2)
        )
        middle = machine.lever * (1 + low) / 2 if low else 0.0
        height = middle if machine.ram_height is None else machine.ram_height
        ram = end.imag + np.sqrt(machine.link**2 - (height - end.real) ** 2)
        link = (height + 1j * ram - end) / machine.link
        push = load / link.imag * link
    force = machine.lever * along(push, ahead) / reach
    return {**on_pin(turn, force * ahead), **moved, "x": ram, "F_pin": force}


def four_bar(machine: FourBar, turn: Any, load: Any) -> Expected:
    """The coupler carries along its line, to the joint on the left of the way from the pin to the rocker's pivot."""
    pin = machine.crank * turn
    diagonal = machine.frame - pin
    length = abs(diagonal)
    foot = (length**2 + machine.coupler**2 - machine.rocker**2) / (2 * length)
    coupler = (
        diagonal / length * (foot + 1j * np.sqrt(machine.coupler**2 - foot**2)) / machine.coupler
    )
    rocker = pin + machine.coupler * coupler - machine.frame
    thrust = -load / moment(rocker, coupler)
    # of two points of one rod, the parts of the speeds along it are equal
    turning = along(1j * pin, coupler) / along(1j * rocker, coupler)
    swing = {"theta": np.degrees(np.angle(rocker)), "theta_dot": turning}
    return {"T": on_pin(turn, -thrust * coupler)["T"], **swing, "F_coupler": thrust}


def parallel_crank(machine: ParallelCrank, turn: Any, load: Any) -> Expected:
    """Two elastic couplers at 90°, each as much strained as the second crank would lead there."""
    pin = machine.crank * turn
    pairs = pin, 1j * pin
    strain = [moment(arm, 1.0) for arm in pairs]
    thrust = [-load * each / (strain[0] ** 2 + strain[1] ** 2) for each in strain]
    torque = sum(moment(arm, -force) for arm, force in zip(pairs, thrust))
    way = pin - machine.crank
    point = {
        "x_coupler": way.real,
        "y_coupler": way.imag,
        "bx_coupler": -pin.real,
        "by_coupler": -pin.imag,
    }
    return {
        **point,
        "T": torque / machine.crank,
        "theta": np.degrees(np.angle(turn)),
        "F_coupler": thrust[0],
    }


def oscillating_cylinder(machine: OscillatingCylinder, turn: Any, load: Any) -> Expected:
    """The trunnions stand at the right of the shaft; the piston is pushed along the line from them to the pin."""
    pin = machine.crank * turn
    reach = abs(machine.trunnion - pin)
    cylinder = (machine.trunnion - pin) / reach
    turning = -along(1j * pin, 1j * cylinder) / reach
    return {
        **on_pin(turn, -load * cylinder),
        "x": reach,
        "F_pin": load,
        "theta": np.degrees(np.angle(cylinder)),
        "theta_dot": turning,
    }


FREE_BODIES: dict[type, Callable[[Any, Any, Any], Expected]] = {
    OscillatingCylinder: oscillating_cylinder,
    SliderCrank: slider_crank,
    YokeFrame: yoke_frame,
    ScotchYoke: scotch_yoke,
    SlottedLever: slotted_lever,
    FourBar: four_bar,
    ParallelCrank: parallel_crank,
}
