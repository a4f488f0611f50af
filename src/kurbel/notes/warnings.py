"""Warnings on a machine: on its input, on measurements, and on results.

These are warnings, not errors, since the file may be right. Every command shows those that concern it.
"""

import math
from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import pairwise
from operator import itemgetter
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.declared.unit_systems import convert, show
from kurbel.errors import KurbelError, NoSolutionError
from kurbel.machine import Cylinder, Machine
from kurbel.machine.cylinder import pin_lag
from kurbel.machine.indicator import Card, CardLine
from kurbel.notes.plausible import cylinder_doubts, machine_doubts
from kurbel.solver.case import Case
from kurbel.solver.forces import Brake, CylinderForces
from kurbel.tables.tables import grouped, together


class Note(NamedTuple):
    """A sentence, and the name of the cylinder that it is about; None for the whole machine.

    command: whose results alone it concerns, '' for those of every command.
    """

    cylinder: str | None
    text: str
    command: str = ""


def machine_notes(case: Case, of_forces: bool = False) -> tuple[Note, ...]:
    """Return all warnings on a machine, each once: on what was given, on measurements, and on results.

    of_forces: leave out those on the speed line and on strength, which take far longer to compute than forces.
    """
    machine, found = case.machine, list[Note]()

    def add(texts: Iterable[str], cylinder: str | None = None, command: str = "") -> None:
        found.extend(Note(cylinder, text, command) for text in texts)

    for cylinder in machine.cylinders:
        add(_card_warnings(cylinder), cylinder.name)
    if machine.effort:
        add(f"effort: {text}" for text in machine.effort.notes)
    add(machine_doubts(machine))
    add(_fluctuation_warnings(machine), command="flywheel")
    for cylinder in machine.cylinders:
        add(cylinder_doubts(machine, cylinder), cylinder.name)
    add(pin_warnings(machine))
    if machine.effort or any(
        one.pistons or one.masses or one.ram_force or one.moment for one in machine.cylinders
    ):
        with np.errstate(all="ignore"):
            for forces in case.cylinders:
                add(_trace_warnings(forces), forces.drive.name)
            add(_brake_warnings(case))
            for forces in case.cylinders:
                add(as_far_as_solved(cylinder_warnings(forces), "forces"), forces.drive.name)
            if not of_forces:
                add(as_far_as_solved(_turning_warnings(case), "flywheel"), command="flywheel")
                add(as_far_as_solved(_strength_warnings(case), "stress"), command="stress")
    return tuple(dict.fromkeys(found))


def as_far_as_solved(found: Iterable[str], command: str) -> list[str]:
    """Return the warnings; without a solution, the reason; what a command refuses only that command reports."""
    try:
        return list(found)
    except NoSolutionError as error:
        return [f"{error}. kurbel {command} ends with status {error.exit_status}"]
    except (KurbelError, OverflowError):
        return []


def by_cylinder(case: Case) -> dict[str, list[str]]:
    """Return the warnings on the forces of each cylinder by its name; those on all of them are with the last one."""
    found: dict[str, list[str]] = {cylinder.name: [] for cylinder in case.machine.cylinders}
    last = case.machine.cylinders[-1].name
    for note in machine_notes(case, of_forces=True):
        if note.command in ("", "forces"):
            found[note.cylinder or last].append(note.text)
    return found


def of_machine(case: Case) -> Iterator[str]:
    """Yield all warnings on a machine, each after the names of its cylinders if there are several."""
    for notes in grouped(machine_notes(case), itemgetter(1)):
        names = [note.cylinder for note in notes if note.cylinder is not None]
        text = notes[0].text
        yield f"{together(names)}: {text}" if names and len(case.machine.cylinders) > 1 else text


# what was given: sizes and speeds

_LARGEST_FLUCTUATION = 0.25  # the largest that the books permit is 1/5, for crushers and hammers


def _fluctuation_warnings(machine: Machine) -> Iterator[str]:
    """Yield a warning on a required δ that is hardly a limit."""
    wanted = machine.flywheel.fluctuation if machine.flywheel else None
    if wanted is not None and wanted > _LARGEST_FLUCTUATION:
        yield (
            f"a wanted fluctuation of {wanted:g} lets the speed vary between {1 - wanted / 2:g} and {1 + wanted / 2:g} "
            "times its mean; those of the books are 1/5 to 1/300: is it right?"
        )


_SAME_PLACE = 1e-9  # m
_SAME_ANGLE = 1e-6  # degrees


def pin_warnings(machine: Machine) -> Iterator[str]:
    """Yield warnings on cylinders at one place along the shaft that share no crank pin.

    Not where the file gives the throws, as of split pins.
    """
    placed = [
        (cylinder.axial_position, cylinder)
        for cylinder in machine.cylinders
        if cylinder.axial_position is not None
    ]
    for (z, one), (next_z, other) in pairwise(sorted(placed, key=lambda pair: pair[0])):
        # the throws at φ = 0
        first = machine.cylinders[0]
        apart = abs(math.remainder(pin_lag(other, first) - pin_lag(one, first), 360.0))
        is_given = one.throw_angle is not None or other.throw_angle is not None
        if next_z - z <= _SAME_PLACE and apart > _SAME_ANGLE and not is_given:
            yield (
                f"{one.name} and {other.name} are at one place along the shaft, but their throws are "
                f"{show(apart, 'angle')} apart: they share no crank pin. Two on one pin have crank positions that "
                "differ as their bank angles do; throws of their own need an 'axial_position' each"
            )


# what was given: cards

_EXPONENTS = 0.9, 1.7  # wet steam that dries as it expands; a monatomic gas without heat
_PLAIN = 0.02
"""Asymmetry of a card below which neither end has the high pressure; with half a stroke of admission it is ¼."""
_STROKE = np.linspace(0.0, 1.0, 101)
"""Fractions of the stroke from the smallest volume on, at which a card is read."""


def _card_warnings(cylinder: Cylinder) -> Iterator[str]:
    """Yield notes on corrections, and warnings on cards from the wrong dead centre and exponents of no gas."""
    for piston in cylinder.pistons:
        for end, chamber in piston.chambers.items():
            place = f"{piston.name}, {end.replace('_', ' ')}"
            yield from (f"{place}: {text}" for text in chamber.notes)
            least, most = _EXPONENTS
            for value in set(chamber.exponents):
                if not least <= value <= most:
                    yield f"{place}: an exponent of {value:g} is none of gas or steam, {least} to {most}; is it right?"
        asymmetries = [
            _asymmetry(card) for card in piston.chambers.values() if isinstance(card, Card)
        ]
        # a high pressure on the same side, at the same crank angle: drawn from the same dead centre?
        if len(asymmetries) == 2 and min(asymmetries) < -_PLAIN and max(asymmetries) > _PLAIN:
            end, centre = ("crank end", "outer") if asymmetries[1] < 0 else ("head end", "inner")
            yield (
                f"{piston.name}, {end}: both ends have their high pressure at the same crank angle; a card counts from "
                f"its own dead centre, that of the {end} from the {centre} one: is it drawn from the other?"
            )


def _asymmetry(card: Card) -> float:
    """Return the mean of p (1 − 2z) over both strokes by the range of p: positive if p is high at small volumes."""
    pressures = np.array([_pressures(line) for line in card.lines])
    return float(np.mean(pressures * (1 - 2 * _STROKE)) / (np.ptp(pressures) or 1.0))


def _pressures(line: CardLine) -> Array:
    """Return the pressures of a line of a card, whichever way it is drawn, at `_STROKE` (n,)."""
    order = np.argsort(line.fractions, kind="stable")
    pressures: Array = np.interp(
        _STROKE, np.take(line.fractions, order), np.take(line.pressures, order)
    )
    return pressures


# measured traces and the brake, which only the person who measured can judge

_LEAST_OF_SEVERAL = 1.1
"""Brake over indicated power of one cylinder from which others are probably missing."""
_TAKEN = 0.3, 1.0
"""Indicated over brake power of a machine that is driven."""
_LEAST_EFFICIENCY = 0.05
"""Brake over indicated power below which a size or a unit is wrong, rather than the engine idle."""
_GOOD = 0.85
"""Mechanical efficiency assumed for the number of cylinders that the brake power needs."""


def _trace_warnings(forces: CylinderForces) -> Iterator[str]:
    """Yield the warnings on each trace of a cylinder, the strongest first."""
    for gas in forces.drive.gas:
        for end, pressure in (("head end", gas.head), ("crank end", gas.crank)):
            if pressure and pressure.traced:
                from kurbel.traces.checks import doubts

                indicator = gas.piston.indicator
                role = indicator.role if indicator else None
                for text in doubts(pressure.trace, pressure.setting, pressure.each, role):
                    yield f"{gas.piston.name}, {end}: {text}"


def _brake_warnings(case: Case) -> Iterator[str]:
    """Yield a contradiction of brake and indicator."""
    brake, indicated = case.machine.brake_power, Brake(case.machine, case.cylinders).indicated
    if not brake or indicated is None:
        return
    shown, taken = f"the indicated power, {show(indicated, 'power')}, is", show(brake, "power")
    if indicated < 0 and not _TAKEN[0] <= -indicated / brake <= _TAKEN[1]:
        much = "more than" if -indicated > brake else "far below what"
        yield f"{shown} {much} the driven shaft takes, {taken}: check angle_zero, units and areas"
    if 0 <= indicated < brake:
        times, several = brake / indicated if indicated else math.inf, ""
        if len(case.machine.cylinders) == 1 and _LEAST_OF_SEVERAL < times < 100:
            count = max(2, math.ceil(times / _GOOD - 0.3))
            several = (
                f"; or is this one cylinder of {count}, say? Then write all of them: 'cylinders: {{count: {count}, "
                "each: …}' with a firing order"
            )
        yield f"{shown} below the brake power, {taken}: check angle_zero, units and areas{several}"
    if indicated > 0 and brake / indicated < _LEAST_EFFICIENCY:
        yield (
            f"the brake power, {taken}, is {100 * brake / indicated:.2g} % of the indicated power, "
            f"{show(indicated, 'power')}: check bore, units and areas"
        )


# results of a cylinder

_CLOSED = 1e-9
"""An energy residual beyond this is no rounding."""
_COARSE = 0.01
"""An energy residual beyond this is more than an indicator may miss by its spacing."""
_LARGEST_PEAK = 300e5  # Pa; of combustion engines
_LEAST_REVERSAL = 15.0, 0.03
"""Degrees of crank angle, and share of the larger load, that API 618 requires of the reversed rod load."""


def valve_warnings(forces: CylinderForces) -> Iterator[str]:
    """Yield what a reader should know about the valve of a cylinder."""
    if forces.valve_gear:
        yield from forces.valve_gear.notes


def cylinder_warnings(forces: CylinderForces) -> Iterator[str]:
    """Yield what looks wrong in the forces of a cylinder; raises NoSolutionError if its friction locks it."""
    forces.refuse_locking()  # first, with an angle that does not depend on the step
    yield from valve_warnings(forces)
    residual, traced = forces.energy_residual or 0.0, any(gas.traced for gas in forces.drive.gas)
    if traced and abs(residual) > _COARSE:  # it shows the spacing of the samples
        yield (
            "the samples are too far apart: the indicated work, by the trapezoid rule, and that of T, by "
            f"straight lines between them, differ by {abs(residual):.1%} of the energy exchanged"
        )
    if not traced and abs(residual) > _CLOSED:
        yield f"the energy balance of the cycle does not close (residual {residual:.1e}); trust no figure beyond that"
    for offer in forces.drive.mechanism.KEY_OFFERS:
        quantity, bound = offer.quantity, offer.bound
        found = offer.of(forces) if bound else None
        if bound and found and found.value > bound:
            shown, most = show(found.value, quantity.kind), show(bound, quantity.kind)
            yield f"{quantity.text[0].lower()}{quantity.text[1:]}: {shown} is above {most}"
    peak = forces.p_max.value if forces.p_max else 0.0
    # pumps and compressors have more, and traces are judged on their own
    if peak > _LARGEST_PEAK and not traced and (forces.mean_pressure or 0.0) > 0:
        most = show(_LARGEST_PEAK, "pressure")
        yield f"a pressure of {show(peak, 'pressure')} is more than engines have, at most {most}; is its unit right?"
    loads = None if forces.no_compressor else forces.rod_loads
    angle, ratio = (loads.reversal_longest, loads.reversal_ratio) if loads else (None, None)
    if angle == 0:
        yield "the rod load never reverses: no oil reaches the loaded side of the crosshead pin"
    elif (
        angle is not None
        and ratio is not None
        and (angle < _LEAST_REVERSAL[0] or ratio < _LEAST_REVERSAL[1])
    ):
        yield (
            f"the rod load reverses over {angle:.3g} deg, to {100 * ratio:.3g} % of the larger load; API 618 "
            "requires 15 deg and 3 %"
        )
    machine = forces.drive.machine
    if machine.rotation and forces.lifted:
        other = "under" if machine.rotation == "over" else "over"
        turning_back = CylinderForces(replace(machine, rotation=other), forces.drive.cylinder)
        turned = f"turning {other} it would {_on_guide(turning_back, 'rest', 'lift')}"
        yield f"Turning {machine.rotation}, the crosshead {_on_guide(forces, 'rests', 'lifts')}; {turned} (R p. 602)"


# the guide of a horizontal machine of known sense of rotation, R p. 602

_MOST_SPANS = 4


def guide_notes(case: Case) -> Iterator[str]:
    """Yield of which cylinders the crosshead rests on the lower guide."""
    sense, resting = case.machine.rotation, list[str]()
    for forces in case.cylinders if sense else ():
        drive = forces.drive
        guided = drive.down and drive.mechanism.guided and drive.mechanism.has_rod
        if guided and forces.extremes_of("N") is not None and not forces.lifted:
            resting.append(drive.name)
    if resting:
        name = f"{together(resting)}: " if len(case.cylinders) > 1 else ""
        yield f"{name}Turning {sense}, the crosshead rests on the lower guide all round (R p. 602)."


def _on_guide(forces: CylinderForces, rests: str, lifts: str) -> str:
    """Return on which guide the crosshead rests, or where it lifts off the lower one."""
    lifted, cycle = forces.lifted, forces.drive.cycle
    if not lifted or lifted[0][1] - lifted[0][0] >= cycle:
        return f"{rests} on the {'upper' if lifted else 'lower'} guide all round"
    spans = ", ".join(f"from {start:.4g} to {end % cycle:.4g} deg" for start, end in lifted)
    return f"{lifts} off the lower guide {spans if len(lifted) <= _MOST_SPANS else f'{len(lifted)} times a cycle'}"


_USUAL_RATIO = 4.0, 5.0
_STILL = 1.2
"""Over the exhaust pressure: so far it may rise before compression has begun."""


def rod_ratio_notes(case: Case) -> Iterator[str]:
    """Yield L/R of machines beyond the 4 to 5 of the books for their kind (R Zusammenstellung 112, Blau)."""
    least, most = _USUAL_RATIO
    for forces in (
        case.cylinders if not case.machine.locomotive else ()
    ):  # Redtenbacher has 6 for locomotives
        mechanism = forces.drive.mechanism
        ratio = 1 / mechanism.lam if mechanism.has_rod and mechanism.lam > 0 else math.inf
        if (
            not least - 1e-9 <= ratio <= most + 1e-9
            and ratio < math.inf
            and (kind := _kind_of(forces))
        ):
            locomotives = (
                "; locomotives have 6 to 11" if kind == "steam engines" and ratio > most else ""
            )
            yield f"{forces.drive.name}: L/R = {ratio:.3g} is beyond the 4 to 5 usual in {kind}{locomotives}."


def _kind_of(forces: CylinderForces) -> str:
    """Return the kind of machine, if it is one that the books on L/R have; '' for compressors and trunk pistons."""
    pistons, ambient = forces.drive.cylinder.pistons, forces.drive.machine.ambient
    chambers = [chamber for piston in pistons for chamber in piston.chambers.values()]
    lifts = [
        0.0 if one.indicator and one.indicator.absolute else ambient
        for one in pistons
        for _ in one.chambers
    ]
    if any(one.by_steam or _drawn_by_steam(one, lift) for one, lift in zip(chambers, lifts)):
        return "steam engines"
    if (forces.work or 0.0) < 0:
        return (
            "pumps"
            if all(isinstance(chamber, Card) and chamber.flat for chamber in chambers)
            else ""
        )
    crosshead = any(one.crank_end_rod or "crank_end" in one.chambers for one in pistons)
    burns = any(chamber.burns or forces.drive.cycle > 360 for chamber in chambers)
    return "gas engines with a crosshead" if crosshead and burns else ""


def _drawn_by_steam(card: object, lift: float) -> bool:
    """Return whether a drawn card is that of a steam engine; lift: what makes its pressures absolute.

    Pressure is held while steam is admitted, over the first twentieth of the stroke at least, and then falls. Half the
    way back the cylinder still exhausts, where an engine that burns has compressed for long.
    """
    if not isinstance(card, Card) or len(card.lines) != 2 or card.flat:
        return False
    outward, back = (_pressures(line) + lift for line in card.lines)
    most, exhaust = max(card.lines[0].pressures) + lift, card.lines[1].pressures[0] + lift
    held, released, halfway = outward[5], outward[-1], back[50]
    return bool(max(0.85 * most, released, _STILL * exhaust) < held and halfway < _STILL * exhaust)


# results of the whole machine

_BEYOND = 1e308
"""Floquet multiplier that is as large as a float can be."""
_SLOWLY = 0.01
"""Growth of a disturbance in a cycle below which it is written as a share, since "1 times" is uninformative."""
_LINEAR = 0.1
"""δ up to which the cranks are close enough to uniform rotation."""


def _turning_warnings(case: Case) -> Iterator[str]:
    """Yield what looks wrong in the turning effort and the speed of the whole machine."""
    machine = case.machine
    if machine.efficiency == 1 and not any((machine.flywheel, machine.load, machine.coupling)):
        return
    turning = case.flywheel
    if turning.deficit is not None:
        word = "more" if turning.deficit > 0 else "less"
        yield (
            f"mean effort {show(turning.M_mean, 'torque')} and mean resistance "
            f"{show(turning.M_mean - turning.deficit, 'torque')} differ: the machine does not run steadily; "
            f"E and ω assume {show(abs(turning.deficit), 'torque')} {word} resistance throughout"
        )
    if machine.efficiency != 1 and any(cylinder.friction for cylinder in machine.cylinders):
        yield "both 'efficiency' and 'friction' are given: friction is counted twice"
    if (
        turning.J_needed is not None
        and turning.delta_needed is not None
        and turning.misses_wanted_delta
    ):
        better = (
            ""
            if turning.J_exact is None
            else f"; J = {show(turning.J_exact, 'inertia')} gives the wanted one"
        )
        yield (
            f"with J = ΔE/(δ ω²) = {show(turning.J_needed, 'inertia')} of the books the speed line has δ = "
            f"{turning.delta_needed:.4g}{better}"
        )
    if turning.multiplier is not None and turning.multiplier > 1:
        more, least = turning.multiplier - 1, "at least " if turning.multiplier > _BEYOND else ""
        grows = (
            f"by {more:.2g} of itself"
            if more < _SLOWLY
            else f"{least}{turning.multiplier:.4g} times"
        )
        yield f"unstable: a disturbance of the speed grows {grows} in every cycle"
    if turning.load_ignored:
        yield "the mean torque is zero, so that a load proportional to it does not govern the speed; it is left out"
    if turning.elastic:
        for near in turning.elastic.resonances:
            yield (
                f"resonance: harmonic {near.order:g} of the torque ({show(near.amplitude, 'torque')}) is "
                f"{100 * abs(near.distance):.2g} % from the natural order {turning.elastic.natural_order:.4g} and is "
                f"amplified {near.amplification:.3g} times"
            )
    if turning.elastic and turning.elastic.delta > _LINEAR:
        yield "the speed varies so much that the coupling, computed at nearly uniform rotation, is only a rough guide"
    rim = machine.flywheel.rim if machine.flywheel else None
    if (
        rim
        and rim.allowable_tension
        and turning.rim_stress
        and turning.rim_stress > rim.allowable_tension
    ):
        yield (
            f"the hoop stress of the rim, {show(turning.rim_stress, 'stress')}, exceeds the allowable "
            f"{show(rim.allowable_tension, 'stress')}"
        )


_SHELLS = {
    "": (
        (25.0, "permissible for bronze shells (25)"),
        (30.0, "too much for bronze shells (25), permissible for white metal (30)"),
        (35.0, "permissible for the best white metal only (30 to 35)"),
        (math.inf, "more than permissible for white metal (30 to 35)"),
    ),
    "gunmetal": (
        (25.0, "permissible for gun metal (25)"),
        (math.inf, "more than gun metal (25) permits"),
    ),
    "white-metal": (
        (30.0, "permissible for white metal (30 to 35)"),
        (35.0, "permissible only for the best white metal (30 to 35)"),
        (math.inf, "more than white metal (30 to 35) permits"),
    ),
}
"""Metal of the shells, "" if unknown -> p_m v of the crank pin in kgf m/(cm² s), and the assessment up to it (G)."""


def shell_verdict(pressure_velocity: float | None, metal: str | None = None) -> tuple[bool, str]:
    """Return whether the shells permit p_m v of the crank pin, and a sentence (G), "" if it is not known.

    metal: of the shells, None if unknown.
    """
    if pressure_velocity is None:
        return True, ""
    shown, shells = (
        convert(pressure_velocity, "pressure_velocity", "kgf m/s/cm2"),
        _SHELLS[metal or ""],
    )
    bound, verdict = next(shell for shell in shells if shown <= shell[0])
    symbol = "k_v = p_m v" if metal else "p_m v"
    return bound == shells[0][0], f"Crank pin: {symbol} = {shown:.3g} kgf m/(cm² s); {verdict}."


def shells(case: Case) -> tuple[bool, str]:
    """Return the verdict on the shells of a machine whose crankshaft is examined."""
    shaft = case.machine.crankshaft
    return shell_verdict(
        case.stress.pressure_velocity("pin"), shaft.bearing_metal if shaft else None
    )


def rods_on_pin(spacing: float | None) -> str:
    """Return the note on where several rods load one pin; spacing: `rod_spacing` in m."""
    first = "that of the cylinder which is first in the file farthest from bearing B"
    if spacing is None:
        return f"Rods on one pin are side by side, each on an equal part of its length, {first}."
    if spacing == 0:
        return "Rods on one pin all load it in its middle, as fork and blade."
    return f"Rods on one pin are {show(spacing, 'length')} apart, {first}."


def _strength_warnings(case: Case) -> Iterator[str]:
    if case.machine.strength_obstacle:
        return
    from kurbel.solver.shaft import strength_obstacle

    if not strength_obstacle(case.machine):
        cool, verdict = shells(case)
        if not cool:
            yield verdict


_ROUNDED = 0.05
"""By how much distances of throws may contradict their crankshaft, over what they should be."""


def bearing_warnings(case: Case) -> Iterator[str]:
    """Yield that the throws are not as far apart as their bearings put them."""
    shaft, cylinders = case.machine.crankshaft, case.machine.cylinders
    if (
        shaft is None
        or shaft.overhung
        or any(cylinder.axial_position is None for cylinder in cylinders)
    ):
        return
    throws, apart = case.bearings.line.throws if case.bearings.line else (), shaft.a + shaft.b
    given = [float(following.place - one.place) for one, following in pairwise(throws)]
    wrong = [one for one in given if abs(one - apart) > _ROUNDED * apart]
    if wrong:
        yield (
            f"throws {show(wrong[0], 'length')} apart along the shaft do not fit bearings between them, by which they "
            f"are a + b = {show(apart, 'length')} apart; the loads are those of a and b"
        )
