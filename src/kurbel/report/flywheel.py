"""The report of `kurbel flywheel`: turning effort, excess work, flywheel and speed line."""

from collections.abc import Iterator

from kurbel.declared.unit_systems import show
from kurbel.solver.case import Case
from kurbel.solver.dead_centre import DeadCentre
from kurbel.tables.frame import CommandReport, Subject
from kurbel.tables.tables import LeftOut


def _left_out(case: Case) -> Iterator[LeftOut]:
    from kurbel.notes.left_out import flywheel_left_out

    yield from flywheel_left_out(case.machine)


def _warnings(case: Case) -> Iterator[str]:
    from kurbel.notes.warnings import of_machine

    yield from of_machine(case)


def _turned(case: Case) -> list[Subject]:
    """Return the dead centres of each cylinder, and the whole machine."""
    turning, effort = case.flywheel, case.flywheel.effort
    subjects = []
    for cylinder in case.cylinders:
        subjects.append(Subject(cylinder.drive.name, DeadCentre(cylinder, effort.cycle)))
    machine_subject = Subject(
        "whole machine",
        turning,
        turning.at if effort.swing is None else None,
        left_out=_left_out(case),
        warnings=_warnings(case),
        whole=True,
    )
    return [*subjects, machine_subject]


def _flywheel_notes(case: Case) -> Iterator[str]:
    turning, effort, efficiency = case.flywheel, case.flywheel.effort, case.machine.efficiency
    if turning.crank is not None:
        over = "over" if any(term.factor > 1 for term in effort.terms) else "with"
        eta = f", {over} the efficiency {efficiency:g}" if efficiency != 1 else ""
        yield f"T and W are referred to the radius of crank 1, {show(turning.crank, 'length')}{eta}; φ is its angle."
    if effort.swing is not None:
        yield "Of the effort its swing of energy alone is known: ω_m is the mean of ω_max and ω_min, δ = ΔE/(J ω_m²)."
    elif (
        turning.J is not None
        and turning.omega
        and not turning.elastic
        and turning.multiplier is None
    ):
        yield "The load does not determine the speed: the mean of ω over time is taken as the nominal speed."
    if efficiency != 1 and any(effort.lost(group) for group in effort.groups):
        yield (
            "Where driving and driven pistons share a rod, the efficiency reduces the force of the driving pistons; "
            "driven pistons, inertia, weight and friction count in full (R p. 613)."
        )
    if (
        efficiency != 1
        and any(term.factor != 1 for term in effort.inertia_terms)
        and turning.speed is not None
    ):
        yield "As in the book the efficiency applies to all of T; in ω the moving masses count in full."
    if turning.rigid:
        yield (
            f"The coupling counts as rigid, its natural order {turning.natural_order:.4g} being above 100: "
            "the driven inertia turns with the flywheel, and M_K is what it and the load take, J₂ α + M_load, without "
            "vibrations of the coupling itself."
        )


FLYWHEEL = CommandReport("Turning effort and flywheel", _turned, _flywheel_notes)
