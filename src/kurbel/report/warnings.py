"""What looks wrong in measurements and results: said as warnings, the same whichever command computes them."""

import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from kurbel.declared.unit_systems import convert, show
from kurbel.errors import KurbelError, NoSolutionError
from kurbel.machine import Machine
from kurbel.report.guide import guide_warnings
from kurbel.report.notes import LARGEST_PEAK
from kurbel.solver.case import Case
from kurbel.solver.forces import Brake, CylinderForces
from kurbel.solver.trace import TracePressure
from kurbel.traces.checks import doubt

if TYPE_CHECKING:
    from kurbel.solver.flywheel import MachineTurning
    from kurbel.solver.stress import CrankshaftStrength


def as_far_as_solved(found: Iterable[str], command: str) -> tuple[str, ...]:
    """Return the warnings; where there is no solution, why; what a command refuses is for that command to tell."""
    try:
        return tuple(found)
    except NoSolutionError as error:
        return (f"{error}. kurbel {command} ends with status {error.exit_status}",)
    except (KurbelError, OverflowError):
        return ()


_BEYOND = 1e308
"""Floquet multiplier that is as large as a float can be."""
_SLOWLY = 0.01
"""Growth of a disturbance in a cycle below which it is told as a share, since "1 times" says nothing."""
_LINEAR = 0.1
"""δ up to which the cranks stand near enough where uniform rotation would have them."""
_CLOSED = 1e-9
"""An energy residual beyond this is no rounding."""
_COARSE = 0.01
"""An energy residual beyond this is more than an indicator may miss by its spacing."""


def cylinder_warnings(forces: CylinderForces) -> Iterable[str]:
    """Yield what looks wrong in the forces of a cylinder."""
    forces.refuse_locking()  # first, with an angle that does not depend on the step
    yield from _balance_warnings(forces)
    yield from _bound_warnings(forces)
    yield from _pressure_warnings(forces)
    yield from _reversal_warnings(forces)
    yield from guide_warnings(forces)


def _balance_warnings(forces: CylinderForces) -> Iterable[str]:
    residual = forces.energy_residual or 0.0
    if any(gas.traced for gas in forces.drive.gas):
        # with a measured trace it shows the spacing of the samples
        if abs(residual) > _COARSE:
            yield (
                "the samples stand too far apart: the indicated work, by the trapezoid rule, and that of T, by "
                f"straight lines between them, differ by {abs(residual):.1%} of what goes to and fro"
            )
    elif abs(residual) > _CLOSED:
        yield f"the energy balance of the cycle does not close (residual {residual:.1e}); trust no figure beyond that"


def _bound_warnings(forces: CylinderForces) -> Iterable[str]:
    """Yield what of the mechanism's own key values is above that to which the sources let it go."""
    for offer in forces.drive.mechanism.KEY_OFFERS:
        quantity, bound = offer.quantity, offer.bound
        found = offer.of(forces) if bound else None
        if bound and found and found.value > bound:
            shown, most = show(found.value, quantity.kind), show(bound, quantity.kind)
            yield f"{quantity.text[0].lower()}{quantity.text[1:]}: {shown} is above {most}"


def _pressure_warnings(forces: CylinderForces) -> Iterable[str]:
    """Yield a pressure that no engine has had; pumps and compressors have more, and traces are judged by themselves."""
    highest, traced = forces.p_max, any(gas.traced for gas in forces.drive.gas)
    if highest and not traced and highest.value > LARGEST_PEAK and (forces.mean_pressure or 0.0) > 0:
        yield (
            f"a pressure of {show(highest.value, 'pressure')} is more than engines have, at most "
            f"{show(LARGEST_PEAK, 'pressure')}; is its unit right?"
        )


_LEAST_REVERSAL = 15.0, 0.03
"""Degrees of crank angle, and share of the larger load, that API 618 asks of the reversed rod load."""


def _reversal_warnings(forces: CylinderForces) -> Iterable[str]:
    load = forces
    if load.no_compressor:
        return
    angle, ratio = load.reversal_longest, load.reversal_ratio
    if angle is None or ratio is None:
        return
    if not angle:
        yield "the rod load never reverses: no oil comes between crosshead pin and bush on the loaded side"
    elif angle < _LEAST_REVERSAL[0] or ratio < _LEAST_REVERSAL[1]:
        yield (
            f"the rod load reverses over {angle:.3g} deg, to {ratio:.2%} of the larger load; API 618 asks for 15 deg "
            "and 3 %"
        )


def turning_warnings(case: Case) -> Iterable[str]:
    """Yield what looks wrong in the turning effort and the speed of the whole machine."""
    machine = case.machine
    if machine.efficiency == 1 and not any((machine.flywheel, machine.load, machine.coupling)):
        return
    turning = case.flywheel
    if turning.deficit is not None:
        word = "more" if turning.deficit > 0 else "less"
        yield (
            f"mean effort {show(turning.M_mean, 'torque')} and mean resistance "
            f"{show(turning.M_mean - turning.deficit, 'torque')} differ: the machine does not run steadily like this; "
            f"E and ω count {show(abs(turning.deficit), 'torque')} {word} resistance all the time"
        )
    if machine.efficiency != 1 and any(cylinder.friction for cylinder in machine.cylinders):
        yield "both 'efficiency' and 'friction' are given: friction is taken off twice"
    yield from _wish_warnings(turning)
    if turning.multiplier is not None and turning.multiplier > 1:
        more, least = turning.multiplier - 1, "at least " if turning.multiplier > _BEYOND else ""
        grows = f"by {more:.2g} of itself" if more < _SLOWLY else f"{least}{turning.multiplier:.4g} times"
        yield f"unstable: a disturbance of the speed grows {grows} in every cycle"
    if turning.load_ignored:
        yield "the mean torque is zero, so that a load in proportion to it does not hold the speed; it is left out"
    yield from _coupling_warnings(turning)
    yield from _rim_warnings(turning)


def _wish_warnings(turning: "MachineTurning") -> Iterable[str]:
    """Yield by how much the flywheel of the books misses the wish, which is for the speed under the true load."""
    if turning.J_needed is None or turning.delta_needed is None or not turning.misses_the_wish:
        return
    better = "" if turning.J_exact is None else f"; J = {show(turning.J_exact, 'inertia')} gives the wanted one"
    yield (
        f"with J = ΔE/(δ ω²) = {show(turning.J_needed, 'inertia')} of the books the speed line has δ = "
        f"{turning.delta_needed:.4g}{better}"
    )


def _rim_warnings(turning: "MachineTurning") -> Iterable[str]:
    rim = turning.machine.flywheel.rim if turning.machine.flywheel else None
    if rim and rim.allowable_tension and turning.rim_stress and turning.rim_stress > rim.allowable_tension:
        yield (
            f"the rim bears a hoop stress of {show(turning.rim_stress, 'stress')}, more than the allowable "
            f"{show(rim.allowable_tension, 'stress')}"
        )


def _coupling_warnings(turning: "MachineTurning") -> Iterable[str]:
    if not turning.elastic:
        return
    for near in turning.elastic.resonances:
        yield (
            f"resonance: harmonic {near.order:g} of the torque ({show(near.amplitude, 'torque')}) lies "
            f"{100 * abs(near.distance):.2g} % from the natural order {turning.elastic.natural_order:.4g} and is "
            f"amplified {near.amplification:.3g} times"
        )
    if turning.elastic.delta > _LINEAR:
        yield "the speed varies so much that the coupling, computed at nearly uniform rotation, is only a rough guide"


def strength_warnings(case: Case) -> Iterable[str]:
    """Yield what looks wrong in the crankshaft."""
    if not case.machine.strength_obstacle:
        cool, verdict = shell_verdict(case.stress)
        yield from () if cool else verdict


_SHELLS = (
    (25, "bronze shells stand it (25)"),
    (30, "too much for bronze shells (25), white metal stands it (30)"),
    (35, "only the best white metal stands it (30 to 35)"),
    (float("inf"), "more than white metal stands (30 to 35)"),
)
"""p_m v of the crank pin in kgf m/(cm² s), and what G says of it up to there."""


def shell_verdict(strength: "CrankshaftStrength") -> tuple[bool, tuple[str, ...]]:
    """Return whether all shells stand p_m v of the crank pin, and a sentence that tells (G); none without a speed."""
    found = strength.pressure_velocity("pin")
    if found is None:
        return True, ()
    shown = convert(found, "pressure_velocity", "kgf m/s/cm2")
    bound, verdict = next((shell for shell in _SHELLS if shown <= shell[0]), _SHELLS[-1])
    return bound == _SHELLS[0][0], (f"Crank pin: p_m v = {shown:.3g} kgf m/(cm² s); {verdict}.",)


# measured traces and the brake, of which only who measured can know

_LEAST_OF_SEVERAL = 1.1
"""Brake over indicated power of one cylinder from which on others are likely to be missing."""
_TAKEN = 0.3, 1.0
"""Indicated over brake power of a machine that is driven."""
_GOOD = 0.85
"""Mechanical efficiency by which the number of cylinders is reckoned that the brake asks for."""


def trace_warnings(forces: CylinderForces) -> Iterable[str]:
    """Yield what is implausible in the traces of a cylinder."""
    for gas in forces.drive.gas:
        for end, pressure in (("head end", gas.head), ("crank end", gas.crank)):
            if isinstance(pressure, TracePressure) and (note := doubt(pressure.trace, pressure.setting, pressure.each)):
                yield f"{gas.piston.name}, {end}: {note}"


def brake_warnings(machine: Machine, cylinders: Sequence[CylinderForces]) -> Iterable[str]:
    """Yield a warning where brake and indicator contradict each other."""
    brake, indicated = machine.brake_power, Brake(machine, cylinders).indicated
    if not brake or indicated is None:
        return
    shown = f"the indicated power, {show(indicated, 'power')}, is"
    if indicated < 0:
        if not _TAKEN[0] <= -indicated / brake <= _TAKEN[1]:
            much = "more than" if -indicated > brake else "far below what"
            yield f"{shown} {much} the driven shaft takes, {show(brake, 'power')}: check angle_zero, units and areas"
        return
    if indicated < brake:
        yield (
            f"{shown} below the brake power, {show(brake, 'power')}: check angle_zero, units and areas"
            f"{_of_several(machine, brake / indicated if indicated else math.inf)}"
        )


def _of_several(machine: Machine, times: float) -> str:
    if len(machine.cylinders) != 1 or not _LEAST_OF_SEVERAL < times < 100:
        return ""
    count = max(2, math.ceil(times / _GOOD - 0.3))
    return (
        f"; or is this one cylinder of {count}, say? Then write all of them: 'cylinders: {{count: {count}, each: …}}' "
        "with a firing order"
    )
