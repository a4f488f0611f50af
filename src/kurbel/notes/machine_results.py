"""Warnings on results of the whole machine: turning effort and speed, the shells of the crank pin, the bearings."""

import math
from collections.abc import Iterator
from itertools import pairwise

from kurbel.declared.unit_systems import convert, requested_system, rounded_text, show
from kurbel.solver.case import Case

_BEYOND = 1e308
"""Floquet multiplier that is as large as a float can be."""
_SLOWLY = 0.01
"""Growth of a disturbance in a cycle below which it is written as a share, since "1 times" is uninformative."""
_LINEAR = 0.1
"""δ up to which the cranks are close enough to uniform rotation."""


def turning_warnings(case: Case) -> Iterator[str]:
    """Yield what looks wrong in the turning effort and the speed of the whole machine."""
    machine = case.machine
    if machine.efficiency == 1 and not any((machine.flywheel, machine.load, machine.coupling)):
        return
    flywheel = case.flywheel

    # the effort
    if flywheel.deficit is not None:
        word = "more" if flywheel.deficit > 0 else "less"
        effort = show(flywheel.M_mean, "torque")
        resistance = show(flywheel.M_mean - flywheel.deficit, "torque")
        difference = show(abs(flywheel.deficit), "torque")
        yield (
            f"mean effort {effort} and mean resistance {resistance} differ: "
            "the machine does not run steadily; "
            f"E and ω assume {difference} {word} resistance throughout"
        )
    if machine.efficiency != 1 and any(cylinder.friction for cylinder in machine.cylinders):
        yield "both 'efficiency' and 'friction' are given: friction is counted twice"

    # the speed
    has_delta = flywheel.J_needed is not None and flywheel.delta_needed is not None
    if has_delta and flywheel.misses_wanted_delta:
        advice = ""
        if flywheel.J_exact is not None:
            advice = f"; J = {show(flywheel.J_exact, 'inertia')} gives the wanted one"
        yield (
            f"with J = ΔE/(δ ω²) = {show(flywheel.J_needed, 'inertia')} of the books "
            f"the speed line has δ = {flywheel.delta_needed:.4g}{advice}"
        )
    multiplier = flywheel.multiplier
    if multiplier is not None and multiplier > 1:
        growth = f"{multiplier:.4g} times"
        if multiplier - 1 < _SLOWLY:
            growth = f"by {multiplier - 1:.2g} of itself"
        elif multiplier > _BEYOND:
            growth = f"at least {growth}"
        yield f"unstable: a disturbance of the speed grows {growth} in every cycle"
    if flywheel.load_ignored:
        yield (
            "the mean torque is zero, so that a load proportional to it "
            "does not govern the speed; it is left out"
        )

    # the coupling
    elastic = flywheel.elastic
    if elastic:
        for resonance in elastic.resonances:
            yield (
                f"resonance: harmonic {resonance.order:g} of the torque "
                f"({show(resonance.amplitude, 'torque')}) is "
                f"{100 * abs(resonance.distance):.2g} % from the natural order "
                f"{elastic.natural_order:.4g} and is "
                f"amplified {resonance.amplification:.3g} times"
            )
        if elastic.delta > _LINEAR:
            yield (
                "the speed varies so much that the coupling, "
                "computed at nearly uniform rotation, is only a rough guide"
            )

    # the rim
    rim = machine.flywheel.rim if machine.flywheel else None
    stress = flywheel.rim_stress
    allowable = rim.allowable_tension if rim else None
    if stress and allowable and stress > allowable:
        yield (
            f"the hoop stress of the rim, {show(stress, 'stress')}, exceeds the allowable "
            f"{show(allowable, 'stress')}"
        )


_SHELLS = {
    "": (
        (25.0, "permissible for bronze shells ({bronze})"),
        (
            30.0,
            "too much for bronze shells ({bronze}), permissible for white metal ({white_metal})",
        ),
        (35.0, "permissible for the best white metal only ({white_metal})"),
        (math.inf, "more than permissible for white metal ({white_metal})"),
    ),
    "gunmetal": (
        (25.0, "permissible for gun metal ({bronze})"),
        (math.inf, "more than gun metal ({bronze}) permits"),
    ),
    "white-metal": (
        (30.0, "permissible for white metal ({white_metal})"),
        (35.0, "permissible only for the best white metal ({white_metal})"),
        (math.inf, "more than white metal ({white_metal}) permits"),
    ),
}
"""Metal of the shells, "" if unknown -> p_m v of the crank pin in kgf m/(cm² s), and the assessment up to it (G)."""


def shell_verdict(pressure_velocity: float | None, metal: str | None = None) -> tuple[bool, str]:
    """Return whether the shells permit p_m v of the crank pin, and a sentence (G), "" if it is not known.

    metal: of the shells, None if unknown.
    """
    if pressure_velocity is None:
        return True, ""
    in_units_of_book = convert(pressure_velocity, "pressure_velocity", "kgf m/s/cm2")
    shells = _SHELLS[metal or ""]
    bound, verdict = next(shell for shell in shells if in_units_of_book <= shell[0])
    is_permitted = bound == shells[0][0]

    # in the units of the book, or in those of the trade
    scale = 1.0
    unit = "kgf m/(cm² s)"
    if requested_system() == "imperial":
        unit = "psi ft/s"
        scale = float(convert(pressure_velocity, "pressure_velocity", unit)) / in_units_of_book
    least, middle, most = (rounded_text(scale * size, 3) for size in (25, 30, 35))
    verdict = verdict.format(bronze=least, white_metal=f"{middle} to {most}")
    symbol = "k_v = p_m v" if metal else "p_m v"
    return (
        is_permitted,
        f"Crank pin: {symbol} = {rounded_text(in_units_of_book * scale, 3)} {unit}; {verdict}.",
    )


def shells(case: Case) -> tuple[bool, str]:
    """Return the verdict on the shells of a machine whose crankshaft is examined."""
    shaft = case.machine.crankshaft
    metal = shaft.bearing_metal if shaft else None
    return shell_verdict(case.stress.pressure_velocity("pin"), metal)


def rods_on_pin(spacing: float | None) -> str:
    """Return the note on where several rods load one pin; spacing: `rod_spacing` in m."""
    first = "that of the cylinder which is first in the file farthest from bearing B"
    if spacing is None:
        return f"Rods on one pin are side by side, each on an equal part of its length, {first}."
    if spacing == 0:
        return "Rods on one pin all load it in its middle, as fork and blade."
    return f"Rods on one pin are {show(spacing, 'length')} apart, {first}."


def strength_warnings(case: Case) -> Iterator[str]:
    """Yield that the shells of the crank pin are loaded more than their metal permits."""
    if case.machine.strength_obstacle:
        return
    from kurbel.solver.shaft import strength_obstacle

    if not strength_obstacle(case.machine):
        is_permitted, verdict = shells(case)
        if not is_permitted:
            yield verdict


_ROUNDED = 0.05
"""By how much distances of throws may contradict their crankshaft, over what they should be."""


def bearing_warnings(case: Case) -> Iterator[str]:
    """Yield that the throws are not as far apart as their bearings put them."""
    shaft = case.machine.crankshaft
    if shaft is None or shaft.overhung:
        return
    if any(cylinder.axial_position is None for cylinder in case.machine.cylinders):
        return
    throws = case.bearings.line.throws if case.bearings.line else ()
    fitting = shaft.a + shaft.b
    for throw, next_throw in pairwise(throws):
        distance = float(next_throw.place - throw.place)
        if abs(distance - fitting) > _ROUNDED * fitting:
            yield (
                f"throws {show(distance, 'length')} apart along the shaft do not fit "
                "bearings between them, by which they are "
                f"a + b = {show(fitting, 'length')} apart; the loads are those of a and b"
            )
            return
