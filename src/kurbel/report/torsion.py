"""The report of `kurbel torsion`: natural vibrations, Holzer's table, critical speeds, and forced vibration."""

import math
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from kurbel.declared.unit_systems import show
from kurbel.errors import NoSolutionError
from kurbel.report.frame import Frame, Subject
from kurbel.report.notes import machine_notes, of_machine
from kurbel.report.orders import orders_of
from kurbel.report.tables import LeftOut, PlaceTable, Report
from kurbel.report.torsion_tables import critical_table, holzer_table, modes_table, pieces_table, speeds_table
from kurbel.solver.case import Case
from kurbel.solver.torsion.vibration import Critical, ShaftVibration

_HIGHEST = 12
"""Order up to which critical speeds are told unless orders are asked for."""


class Wanted(NamedTuple):
    """What is asked of torsion: orders, how many modes, whose Holzer table, and speeds in revolutions per second."""

    orders: Sequence[float] | None = None
    modes: int = 3
    mode: int = 1
    speeds: Sequence[float] | None = None


def torsion_report(
    case: Case, wanted: Wanted, angles: Sequence[float], columns: Sequence[str] | None, system: str
) -> Report:
    """Return the torsional vibration of the shaft line; angles, columns, system: see `Frame`.

    columns: of the pieces over the crank angle; without them only tables are told. Raises UsageError without a shaft
    line, NoSolutionError where an undamped resonance has no end.
    """
    with np.errstate(all="ignore"):  # what overflows is refused, by name
        found = case.torsion_of(orders_of(case.machine, wanted.orders))
        critical = found.critical_speeds(wanted.modes, _HIGHEST if wanted.orders is None else math.inf)
        (whole,) = subjects(case, found, critical)
        whole = whole._replace(place_tables=tuple(_tables(found, critical, wanted, system)))
        pieces = found.pieces if columns else ()
        each = [Subject(one.name, (), one.at) for one in pieces]
    frame = Frame("torsion", angles, columns, system)
    return frame.report(case.machine, "Drehschwingungen", each, whole, _notes(found, wanted))


def subjects(
    case: Case, asked: ShaftVibration | None = None, critical: tuple[Critical, ...] | None = None
) -> Iterable[Subject]:
    """Yield the shaft line; asked: by other than the usual orders; critical: the critical speeds to warn of."""
    found = asked or case.torsion
    if found.vibration is not None and found.vibration.endless.any():
        raise NoSolutionError("an order of the torque meets a natural vibration that nothing damps: give it 'damping'")
    yield Subject(
        "shaft line",
        (found,),
        left_out=lambda: torsion_left_out(found),
        warnings=lambda: (
            *_warnings(found, critical or ()),
            *of_machine(machine_notes(case.machine, case), case.machine),
        ),
    )


def _tables(found: ShaftVibration, critical: tuple[Critical, ...], wanted: Wanted, system: str) -> Iterable[PlaceTable]:
    yield modes_table(found, system)
    yield holzer_table(found, wanted.mode, system)
    yield critical_table(found, critical, system)
    if found.pieces:
        yield pieces_table(found, system)
    if wanted.speeds is not None and not found.obstacle:
        yield speeds_table(found, wanted.speeds, system)


def torsion_left_out(found: ShaftVibration) -> Iterable[LeftOut]:
    """Yield what torsional vibration leaves out, with the reason."""
    if found.obstacle:
        yield LeftOut("forced vibration, torques and stresses", found.obstacle)
    elif not all(piece.sections for piece in found.line.pieces):
        bare = [found.piece_name(i) for i, piece in enumerate(found.line.pieces) if not piece.sections]
        yield LeftOut(f"stress in {', '.join(bare)}", "no diameter given")
    if found.machine.cylinders:
        yield LeftOut("change of the inertia over the turn", "the mean counts; what its change excites is not told")


def _warnings(found: ShaftVibration, critical: tuple[Critical, ...]) -> Iterable[str]:
    """Yield, mode by mode, the critical speeds beside the working speed, the strongest first."""
    speed = found.machine.speed
    for mode in sorted({one.mode for one in critical}):
        near = sorted((one for one in critical if one.mode == mode and one.near), key=lambda one: -one.phase_sum)
        if not near or speed is None:
            continue
        listed = ", ".join(f"{one.order:g} ({100 * (one.distance or 0.0):+.3g} %)" for one in near)
        plural = "s" if len(near) > 1 else ""
        yield (
            f"mode {mode}: critical speed{plural} of order{plural} {listed} within 10 % of the working speed "
            f"{show(speed, 'speed')}"
        )


def _listed(orders: Sequence[str]) -> str:
    """Return orders in words: few of them by name, many by their first and last."""
    if len(orders) > 4:
        return f"{len(orders)} orders from {orders[0]} to {orders[-1]}"
    return f"order{'s' if len(orders) > 1 else ''} {', '.join(orders)}"


def _notes(found: ShaftVibration, wanted: Wanted) -> Iterable[str]:
    if wanted.orders is None:
        yield f"Critical speeds of orders up to {_HIGHEST}; --orders tells others, --modes of more modes."
    if any(piece.ratio != 1 for piece in found.line.pieces):
        yield "Masses and stiffnesses beyond the gear are referred to the cranks' shaft by u²; torques are true ones."
    if not found.machine.cylinders and found.machine.effort:
        yield f"The effort acts on {found.line.masses[0].name}, the first mass."
    if found.pieces:
        orders = f"{_listed([f'{order:g}' for order in found.orders])} together"
        orders = "all orders together" if found.steady else orders
        if found.remainder is not None:
            orders += f" (higher ones add about {show(found.remainder, 'torque')} or less)"
        taker = "what holds it" if found.chain.ground else found.line.masses[found.line.load].name
        yield f"Forced vibration: {orders}, about uniform rotation; the mean torque goes to {taker}."
