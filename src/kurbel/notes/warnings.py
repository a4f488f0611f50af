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
from kurbel.declared.unit_systems import show
from kurbel.errors import KurbelError, NoSolutionError
from kurbel.machine import Cylinder, Machine
from kurbel.machine.cylinder import pin_lag
from kurbel.machine.indicator import Card, CardLine, Chamber
from kurbel.notes.machine_results import strength_warnings, turning_warnings
from kurbel.notes.plausible import cylinder_doubts, machine_doubts
from kurbel.solver.case import Case
from kurbel.solver.forces import CylinderForces
from kurbel.solver.piston_works import Brake
from kurbel.solver.rod_load import LEAST_REVERSAL
from kurbel.tables.tables import grouped, joined_names


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
    machine = case.machine
    notes: list[Note] = []

    def add(texts: Iterable[str], cylinder: str | None = None, command: str = "") -> None:
        notes.extend(Note(cylinder, text, command) for text in texts)

    # what was given
    for cylinder in machine.cylinders:
        add(_card_warnings(cylinder), cylinder.name)
    if machine.effort:
        add(f"effort: {text}" for text in machine.effort.notes)
    add(machine_doubts(machine))
    add(_fluctuation_warnings(machine), command="flywheel")
    for cylinder in machine.cylinders:
        add(cylinder_doubts(machine, cylinder), cylinder.name)
        add(_link_rod_warnings(machine, cylinder), cylinder.name)
    add(pin_warnings(machine))

    # measurements and results, where there are forces
    has_forces = machine.effort is not None or any(map(_has_force, machine.cylinders))
    if not has_forces:
        return tuple(dict.fromkeys(notes))
    with np.errstate(all="ignore"):
        for forces in case.cylinders:
            add(_trace_warnings(forces), forces.drive.name)
        add(_brake_warnings(case))
        for forces in case.cylinders:
            add(as_far_as_solved(cylinder_warnings(forces), "forces"), forces.drive.name)
        if not of_forces:
            add(as_far_as_solved(turning_warnings(case), "flywheel"), command="flywheel")
            add(as_far_as_solved(strength_warnings(case), "stress"), command="stress")
    return tuple(dict.fromkeys(notes))


def _has_force(cylinder: Cylinder) -> bool:
    """Return whether something acts on the mechanism of a cylinder."""
    loads = (cylinder.ram_force, cylinder.moment, cylinder.force)
    has_load = any(load is not None for load in loads)
    return bool(cylinder.pistons or cylinder.masses or has_load)


def as_far_as_solved(warnings: Iterable[str], command: str) -> list[str]:
    """Return the warnings; without a solution, the reason; what a command refuses only that command reports."""
    try:
        return list(warnings)
    except NoSolutionError as error:
        return [f"{error}. kurbel {command} ends with status {error.exit_status}"]
    except (KurbelError, OverflowError):
        return []


def by_cylinder(case: Case) -> dict[str, list[str]]:
    """Return the warnings on the forces of each cylinder by its name; those on all of them are with the last one."""
    warnings: dict[str, list[str]] = {cylinder.name: [] for cylinder in case.machine.cylinders}
    last = case.machine.cylinders[-1].name
    for note in machine_notes(case, of_forces=True):
        if note.command in ("", "forces"):
            warnings[note.cylinder or last].append(note.text)
    return warnings


def of_machine(case: Case) -> Iterator[str]:
    """Yield all warnings on a machine, each after the names of its cylinders if there are several."""
    for notes in grouped(machine_notes(case), itemgetter(1)):
        names = [note.cylinder for note in notes if note.cylinder is not None]
        is_named = names and len(case.machine.cylinders) > 1
        prefix = f"{joined_names(names)}: " if is_named else ""
        yield prefix + notes[0].text


# what was given: sizes and speeds

_LARGEST_FLUCTUATION = 0.25  # the largest that the books permit is 1/5, for crushers and hammers


def _fluctuation_warnings(machine: Machine) -> Iterator[str]:
    """Yield a warning on a required δ that is hardly a limit."""
    delta = machine.flywheel.fluctuation if machine.flywheel else None
    if delta is not None and delta > _LARGEST_FLUCTUATION:
        yield (
            f"a wanted fluctuation of {delta:g} lets the speed vary "
            f"between {1 - delta / 2:g} and {1 + delta / 2:g} "
            "times its mean; those of the books are 1/5 to 1/300: is it right?"
        )


_LARGEST_LINK_DIFFERENCE = 0.15
"""Of the master rod, by which link rod and knuckle radius together may be longer or shorter."""


def _link_rod_warnings(machine: Machine, cylinder: Cylinder) -> Iterator[str]:
    """Yield a warning on a link rod that puts its piston far from where that of the master is."""
    link_rod = cylinder.link_rod
    if link_rod is None or link_rod.length is None:
        return
    (master,) = (other for other in machine.cylinders if other.name == link_rod.master)
    L = master.mechanism.rod_length
    reach = link_rod.length + link_rod.knuckle_radius
    if abs(reach - L) > _LARGEST_LINK_DIFFERENCE * L:
        yield (
            f"link rod and knuckle radius together are {show(reach, 'length')}, "
            f"the master rod {show(L, 'length')}: is 'length' the link rod's own?"
        )


_SAME_POSITION = 1e-9  # m
_SAME_ANGLE = 1e-6  # degrees


def pin_warnings(machine: Machine) -> Iterator[str]:
    """Yield warnings on cylinders at one place along the shaft that share no crank pin.

    Not where the file gives the throws, as of split pins.
    """
    positions = []
    for cylinder in machine.cylinders:
        if cylinder.axial_position is not None:
            positions.append((cylinder.axial_position, cylinder))
    positions.sort(key=itemgetter(0))
    for (z, cylinder), (next_z, neighbour) in pairwise(positions):
        # the angle between their throws at φ = 0
        first = machine.cylinders[0]
        difference = pin_lag(neighbour, first) - pin_lag(cylinder, first)
        angle = abs(math.remainder(difference, 360.0))
        has_throw = cylinder.throw_angle is not None or neighbour.throw_angle is not None
        if next_z - z <= _SAME_POSITION and angle > _SAME_ANGLE and not has_throw:
            yield (
                f"{cylinder.name} and {neighbour.name} are at one place along the shaft, "
                f"but their throws are {show(angle, 'angle')} apart: they share no crank pin. "
                "Two on one pin have crank positions that differ as their bank angles do; "
                "throws of their own need an 'axial_position' each"
            )


# what was given: cards

_EXPONENTS = 0.9, 1.7  # wet steam that dries as it expands; a monatomic gas without heat
_PLAIN = 0.02
"""Asymmetry of a card below which neither end has the high pressure; with half a stroke of admission it is ¼."""
_STROKE = np.linspace(0.0, 1.0, 101)
"""Fractions of the stroke from the smallest volume on, at which a card is read."""


def _card_warnings(cylinder: Cylinder) -> Iterator[str]:
    """Yield notes on corrections, and warnings on cards from the wrong dead centre and exponents of no gas."""
    least, most = _EXPONENTS
    for piston in cylinder.pistons:
        for end, chamber in piston.chambers.items():
            name = f"{piston.name}, {end.replace('_', ' ')}"
            for text in chamber.notes:
                yield f"{name}: {text}"
            for exponent in set(chamber.exponents):
                if not least <= exponent <= most:
                    yield (
                        f"{name}: an exponent of {exponent:g} is none of gas or steam, "
                        f"{least} to {most}; is it right?"
                    )
        cards = [chamber for chamber in piston.chambers.values() if isinstance(chamber, Card)]
        if len(cards) == 2:
            yield from _dead_centre_warnings(piston.name, *cards)


def _dead_centre_warnings(piston: str, head_card: Card, crank_card: Card) -> Iterator[str]:
    """Yield a warning if both cards have their high pressure at the same crank angle: one is drawn from the other's end."""
    asymmetries = [_asymmetry(head_card), _asymmetry(crank_card)]
    are_opposite = min(asymmetries) < -_PLAIN and max(asymmetries) > _PLAIN
    if not are_opposite:
        return
    end, centre = "head end", "inner"
    if asymmetries[1] < 0:
        end, centre = "crank end", "outer"
    yield (
        f"{piston}, {end}: both ends have their high pressure at the same crank angle; "
        f"a card counts from its own dead centre, that of the {end} from the {centre} one: "
        "is it drawn from the other?"
    )


def _asymmetry(card: Card) -> float:
    """Return the mean of p (1 − 2z) over both strokes by the range of p: positive if p is high at small volumes."""
    pressures = np.array([_pressures(line) for line in card.lines])
    return float(np.mean(pressures * (1 - 2 * _STROKE)) / (np.ptp(pressures) or 1.0))


def _pressures(line: CardLine) -> Array:
    """Return the pressures of a line of a card, whichever way it is drawn, at `_STROKE` (n,)."""
    order = np.argsort(line.fractions, kind="stable")
    fractions = np.take(line.fractions, order)
    pressures: Array = np.interp(_STROKE, fractions, np.take(line.pressures, order))
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
                chambers = gas.piston.chambers.values()
                recorded = {text for chamber in chambers for text in chamber.notes}
                # what its cycle adds to the notes on its samples
                for text in pressure.trace.notes:
                    if text not in recorded:
                        yield f"{gas.piston.name}, {end}: {text}"
                for text in doubts(pressure.trace, pressure.setting, pressure.each, role):
                    yield f"{gas.piston.name}, {end}: {text}"


def _brake_warnings(case: Case) -> Iterator[str]:
    """Yield a contradiction of brake and indicator."""
    brake = case.machine.brake_power
    indicated = Brake(case.machine, case.cylinders).indicated
    if not brake or indicated is None:
        return
    brake_text = show(brake, "power")
    indicated_text = show(indicated, "power")
    subject = f"the indicated power, {indicated_text}, is"
    advice = "check angle_zero, units and areas"
    # a machine that is driven
    least, most = _TAKEN
    is_plausible = least <= -indicated / brake <= most
    if indicated < 0 and not is_plausible:
        size = "more than" if -indicated > brake else "far below what"
        yield f"{subject} {size} the driven shaft takes, {brake_text}: {advice}"
    # an engine that gives more than it has, or hardly anything of it
    if 0 <= indicated < brake:
        ratio = brake / indicated if indicated else math.inf
        several = ""
        if len(case.machine.cylinders) == 1 and _LEAST_OF_SEVERAL < ratio < 100:
            count = max(2, math.ceil(ratio / _GOOD - 0.3))
            several = (
                f"; or is this one cylinder of {count}, say? "
                f"Then write all of them: 'cylinders: {{count: {count}, each: …}}' "
                "with a firing order"
            )
        yield f"{subject} below the brake power, {brake_text}: {advice}{several}"
    if indicated > 0 and brake / indicated < _LEAST_EFFICIENCY:
        percent = f"{100 * brake / indicated:.2g} %"
        yield (
            f"the brake power, {brake_text}, is {percent} of the indicated power, "
            f"{indicated_text}: check bore, units and areas"
        )


# results of a cylinder

_CLOSED = 1e-9
"""An energy residual beyond this is no rounding."""
_COARSE = 0.01
"""An energy residual beyond this is more than an indicator may miss by its spacing."""
_LARGEST_PEAK = 300e5  # Pa; of combustion engines


def valve_warnings(forces: CylinderForces) -> Iterator[str]:
    """Yield what a reader should know about the valve of a cylinder."""
    if forces.valve_gear:
        yield from forces.valve_gear.notes


def cylinder_warnings(forces: CylinderForces) -> Iterator[str]:
    """Yield what looks wrong in the forces of a cylinder; raises NoSolutionError if its friction locks it."""
    forces.refuse_locking()  # first, with an angle that does not depend on the step
    yield from valve_warnings(forces)
    is_traced = any(gas.traced for gas in forces.drive.gas)
    yield from _energy_warnings(forces, is_traced)

    # key values of the mechanism that have a bound
    for offer in forces.drive.mechanism.KEY_OFFERS:
        if not offer.bound:
            continue
        quantity = offer.quantity
        extreme = offer.of(forces)
        if extreme and extreme.value > offer.bound:
            value = show(extreme.value, quantity.kind)
            bound = show(offer.bound, quantity.kind)
            yield f"{quantity.text[0].lower()}{quantity.text[1:]}: {value} is above {bound}"

    # a pressure that no engine has; pumps and compressors have more, and traces are judged on their own
    peak = forces.p_max.value if forces.p_max else 0.0
    is_engine = (forces.mean_pressure or 0.0) > 0
    if peak > _LARGEST_PEAK and is_engine and not is_traced:
        most = show(_LARGEST_PEAK, "pressure")
        yield (
            f"a pressure of {show(peak, 'pressure')} is more than engines have, at most {most}; "
            "is its unit right?"
        )
    yield from _heat_warnings(forces)
    if not forces.no_compressor:
        yield from _reversal_warnings(forces)
    yield from _lifting_warnings(forces)


def _heat_warnings(forces: CylinderForces) -> Iterator[str]:
    """Yield that a card does more work than its fuel has heat, which polytropes with other exponents than κ add."""
    release = forces.heat_release
    efficiency = release.answers.get("indicated_efficiency") if release else None
    if isinstance(efficiency, float) and efficiency > 1:
        yield (
            f"an indicated efficiency of {efficiency:.3g} is more than all heat of the fuel: with exponents other than "
            "'heat_ratio' the gas takes up heat that is not of the fuel"
        )


def _energy_warnings(forces: CylinderForces, is_traced: bool) -> Iterator[str]:
    """Yield that work and energy of a cycle differ; is_traced: the spacing of samples may be the reason."""
    residual = forces.energy_residual or 0.0
    if is_traced and abs(residual) > _COARSE:
        yield (
            "the samples are too far apart: the indicated work, by the trapezoid rule, "
            "and that of T, by straight lines between them, "
            f"differ by {abs(residual):.1%} of the energy exchanged"
        )
    if not is_traced and abs(residual) > _CLOSED:
        yield (
            f"the energy balance of the cycle does not close (residual {residual:.1e}); "
            "trust no figure beyond that"
        )


def _reversal_warnings(forces: CylinderForces) -> Iterator[str]:
    """Yield that the rod load of a compressor does not reverse as long and as far as API 618 requires."""
    loads = forces.rod_loads
    if loads is None:
        return
    angle = loads.reversal_longest
    ratio = loads.reversal_ratio
    if angle == 0:
        yield "the rod load never reverses: no oil reaches the loaded side of the crosshead pin"
        return
    if angle is None or ratio is None:
        return
    least_angle, least_ratio = LEAST_REVERSAL
    if angle < least_angle or ratio < least_ratio:
        yield (
            f"the rod load reverses over {angle:.3g} deg, to {100 * ratio:.3g} % "
            "of the larger load; API 618 requires 15 deg and 3 %"
        )


def _lifting_warnings(forces: CylinderForces) -> Iterator[str]:
    """Yield that the crosshead lifts off the lower guide, and what the other sense of rotation would do."""
    machine = forces.drive.machine
    if not machine.rotation or not forces.lifted:
        return
    reverse = "under" if machine.rotation == "over" else "over"
    reversed_forces = CylinderForces(replace(machine, rotation=reverse), forces.drive.cylinder)
    yield (
        f"Turning {machine.rotation}, the crosshead {_on_guide(forces, 'rests', 'lifts')}; "
        f"turning {reverse} it would {_on_guide(reversed_forces, 'rest', 'lift')} (R p. 602)"
    )


# the guide of a horizontal machine of known sense of rotation, R p. 602

_MOST_SPANS = 4


def guide_notes(case: Case) -> Iterator[str]:
    """Yield of which cylinders the crosshead rests on the lower guide."""
    rotation = case.machine.rotation
    if not rotation:
        return
    resting = []
    for forces in case.cylinders:
        drive = forces.drive
        has_lower_guide = drive.down and drive.mechanism.guided and drive.mechanism.has_rod
        if has_lower_guide and forces.extremes_of("N") is not None and not forces.lifted:
            resting.append(drive.name)
    if resting:
        name = f"{joined_names(resting)}: " if len(case.cylinders) > 1 else ""
        yield (
            f"{name}Turning {rotation}, "
            "the crosshead rests on the lower guide all round (R p. 602)."
        )


def _on_guide(forces: CylinderForces, rests: str, lifts: str) -> str:
    """Return on which guide the crosshead rests, or where it lifts off the lower one."""
    spans = forces.lifted
    cycle = forces.drive.cycle
    if not spans:
        return f"{rests} on the lower guide all round"
    start, end = spans[0]
    if end - start >= cycle:
        return f"{rests} on the upper guide all round"
    if len(spans) > _MOST_SPANS:
        return f"{lifts} off the lower guide {len(spans)} times a cycle"
    angles = ", ".join(f"from {start:.4g} to {end % cycle:.4g} deg" for start, end in spans)
    return f"{lifts} off the lower guide {angles}"


_USUAL_RATIO = 4.0, 5.0
_STILL = 1.2
"""Over the exhaust pressure: so far it may rise before compression has begun."""


def rod_ratio_notes(case: Case) -> Iterator[str]:
    """Yield L/R of machines beyond the 4 to 5 of the books for their kind (R Zusammenstellung 112, Blau)."""
    if case.machine.locomotive:  # Redtenbacher has 6 for locomotives
        return
    least, most = _USUAL_RATIO
    for forces in case.cylinders:
        mechanism = forces.drive.mechanism
        has_finite_rod = mechanism.has_rod and mechanism.lam > 0
        if not has_finite_rod:
            continue
        ratio = 1 / mechanism.lam
        is_usual = least - 1e-9 <= ratio <= most + 1e-9
        kind = "" if is_usual else _kind_of(forces)
        if not kind:
            continue
        locomotives = ""
        if kind == "steam engines" and ratio > most:
            locomotives = "; locomotives have 6 to 11"
        yield (
            f"{forces.drive.name}: L/R = {ratio:.3g} is beyond the 4 to 5 usual in {kind}"
            f"{locomotives}."
        )


def _kind_of(forces: CylinderForces) -> str:
    """Return the kind of machine, if it is one that the books on L/R have; '' for compressors and trunk pistons."""
    drive = forces.drive
    chambers: list[Chamber] = []
    has_crosshead = False
    for piston in drive.cylinder.pistons:
        has_crosshead = (
            has_crosshead or bool(piston.crank_end_rod) or "crank_end" in piston.chambers
        )
        # what makes its pressures absolute
        is_absolute = piston.indicator is not None and piston.indicator.absolute
        lift = 0.0 if is_absolute else drive.machine.ambient
        for chamber in piston.chambers.values():
            if chamber.by_steam or _drawn_by_steam(chamber, lift):
                return "steam engines"
            chambers.append(chamber)
    if (forces.work or 0.0) < 0:
        are_flat = all(isinstance(chamber, Card) and chamber.flat for chamber in chambers)
        return "pumps" if are_flat else ""
    burns = any(chamber.burns or drive.cycle > 360 for chamber in chambers)
    return "gas engines with a crosshead" if has_crosshead and burns else ""


def _drawn_by_steam(card: object, lift: float) -> bool:
    """Return whether a drawn card is that of a steam engine; lift: what makes its pressures absolute.

    Pressure is held while steam is admitted, over the first twentieth of the stroke at least, and then falls. Half the
    way back the cylinder still exhausts, where an engine that burns has compressed for long.
    """
    if not isinstance(card, Card) or len(card.lines) != 2 or card.flat:
        return False
    outward_line, return_line = card.lines
    # the outstroke: the pressure is held over a twentieth of the stroke, and falls before its end
    outward = _pressures(outward_line) + lift
    most = max(outward_line.pressures) + lift
    exhaust = return_line.pressures[0] + lift
    is_admitted = max(0.85 * most, outward[-1], _STILL * exhaust) < outward[5]
    # the return stroke: half the way back it still exhausts
    halfway = (_pressures(return_line) + lift)[50]
    return bool(is_admitted and halfway < _STILL * exhaust)
