"""The report of `kurbel torsion`: natural vibrations, Holzer's table, critical speeds, forced vibration."""

import math
from collections.abc import Iterable, Iterator, Sequence
from itertools import chain

from kurbel.declared.unit_systems import show
from kurbel.errors import NoSolutionError, UsageError
from kurbel.machine.shaft_line import GROUNDED
from kurbel.notes.warnings import of_machine
from kurbel.quantity import Quantity, by_id
from kurbel.report.harmonics import TORQUE_ORDERS, requested_orders
from kurbel.solver.case import Case
from kurbel.solver.chapters.chain import tree_from_first
from kurbel.solver.chapters.natural_modes import Holzer, holzer_at
from kurbel.solver.chapters.torsion import RUN_UP, Critical, SegmentTorque, ShaftVibration, stress
from kurbel.tables.frame import CommandReport, Frame, Subject
from kurbel.tables.shown import PlaceRow, Places
from kurbel.tables.tables import LeftOut

MODES = by_id(
    Quantity("mode", "i", "ratio", "Mode number; 0 is rigid-body rotation"),
    Quantity("frequency", "f", "frequency", "Natural frequency"),
    Quantity("omega_natural", "ω_e", "angular_velocity", "Natural angular frequency"),
)
"""Of one natural vibration, by id."""

PIECES = by_id(
    Quantity("M_shaft_mean", "M_w,m", "torque", "Mean torque in the shaft segment"),
    Quantity(
        "M_shaft_max",
        "M_w,max",
        "torque",
        "Largest torque in the shaft segment, all orders together",
    ),
    Quantity("M_shaft_min", "M_w,min", "torque", "Smallest torque in the shaft segment"),
    Quantity("M_vibratory", "M_w,a", "torque", "Vibratory torque amplitude (half peak-to-peak)"),
    Quantity(
        "tau_mean",
        "τ_m",
        "stress",
        "Stress of the mean torque at the smallest section of the segment",
    ),
    Quantity("tau_vibratory", "τ_a", "stress", "Vibratory stress amplitude (half peak-to-peak)"),
)
"""Of one piece of shaft at the working speed, by id."""

CRITICAL_SPEEDS = by_id(
    TORQUE_ORDERS["order"],
    MODES["mode"],
    Quantity("speed", "n_k", "speed", "Critical speed, at which the order excites the mode"),
    Quantity(
        "phase_sum", "|ΣΘ|", "ratio", "Phase vector sum of the cranks, with Θ of the Holzer table"
    ),
    Quantity("distance", "Δn/n", "ratio", "Separation from the working speed, relative to it"),
    Quantity(
        "M_vibratory",
        "M_w,a",
        "torque",
        "Largest vibratory torque of any shaft segment when running there",
    ),
    Quantity(
        "tau_vibratory",
        "τ_a",
        "stress",
        "Largest vibratory stress of any shaft segment when running there",
    ),
)
"""Of one critical speed, by id."""

HOLZER = by_id(
    Quantity("inertia", "J", "inertia", "Moment of inertia of the mass"),
    Quantity("theta", "Θ", "ratio", "Amplitude of the mass, relative to the first mass"),
    Quantity(
        "inertia_torque",
        "ω²JΘ",
        "torque",
        "Inertia torque of the mass per radian of the first mass",
        "w2 J Theta",
    ),
    Quantity(
        "torque_sum",
        "Σω²JΘ",
        "torque",
        "Torque in the segment after the mass, per radian of the first mass",
        "sum",
    ),
    Quantity("stiffness", "k", "stiffness", "Stiffness of the segment after the mass"),
    Quantity("twist", "ΔΘ", "ratio", "Twist of the segment after the mass"),
)
"""Of one mass in Holzer's table, by id."""

SPEEDS = by_id(TORQUE_ORDERS["speed"], PIECES["M_vibratory"], PIECES["tau_vibratory"])
"""Of one piece at one speed, by id."""


_HIGHEST_CRITICAL = 12
"""Order up to which critical speeds are listed unless orders are requested."""
_MODES = 3
"""Modes whose critical speeds are listed unless others are requested."""


def _limited(vibration: ShaftVibration) -> ShaftVibration:
    """Return the vibration; raises NoSolutionError if it grows without limit."""
    if vibration.vibration is not None and vibration.vibration.endless.any():
        raise NoSolutionError(
            "an order of the torque meets a natural vibration that is hardly damped: give 'damping'; or segments of "
            "the shaft are too unequal to compute with: check the units of their stiffnesses"
        )
    return vibration


def _torsion(
    case: Case,
    frame: Frame,
    orders: Sequence[float] | None = None,
    modes: int = _MODES,
    mode: int | None = None,
    speeds: Sequence[float] | None = None,
    at: float | None = None,
) -> tuple[list[Subject], Iterator[str]]:
    """Return the torsional vibration of the shaft line; columns over the crank angle only if the frame has some.

    orders: those to count, None for the usual ones; modes: how many have critical speeds; mode, at: of Holzer's table,
    or a frequency in Hz in its place; speeds: in revolutions per second, at which amplitudes are listed. Raises
    UsageError without a shaft line, NoSolutionError if an undamped resonance has no limit.
    """
    if mode is not None and at is not None:
        raise UsageError(
            "--mode and --at: Holzer's table is that of a mode or at a frequency; leave one of them out"
        )
    vibration = case.torsion_of(requested_orders(case.machine, orders))
    critical = vibration.critical_speeds(modes, _HIGHEST_CRITICAL if orders is None else math.inf)
    _limited(vibration)
    rows = _critical_rows(vibration, critical)
    tables = [
        _modes_table(vibration),
        _holzer_table(vibration, mode or 1, at),
        Places("critical_speeds", "Critical speeds", ("note",), CRITICAL_SPEEDS, rows),
    ]
    if vibration.segments:
        determiner = "" if vibration.steady else "these "
        title = f"Torques and stresses at the working speed, all {determiner}orders together"
        of_segments: list[PlaceRow] = [
            ((segment.name,), _of_piece(segment)) for segment in vibration.segments
        ]
        tables.append(Places("pieces", title, ("piece",), PIECES, of_segments))
    if speeds is not None and not vibration.obstacle:
        tables.append(_speeds_table(vibration, speeds))

    subjects = []
    if frame.columns:
        subjects = [Subject(segment.name, at=segment.at) for segment in vibration.segments]
    machine_subject = Subject(
        "shaft line",
        vibration,
        left_out=torsion_left_out(vibration),
        warnings=chain(_near_speeds(vibration, critical), of_machine(case)),
        tables=tables,
        whole=True,
    )
    with_torque = ["M_vibratory" in values for _, values in rows]
    are_some_hidden = any(with_torque) and not all(with_torque)
    notes = _torsion_notes(vibration, orders is None, are_some_hidden)
    return [*subjects, machine_subject], notes


TORSION = CommandReport(
    "Torsional vibration",
    lambda case: [Subject("shaft line", _limited(case.torsion))],
    subjects_and_notes=_torsion,
)


def _critical_rows(vibration: ShaftVibration, critical: Sequence[Critical]) -> list[PlaceRow]:
    """Return critical speeds, with the largest amplitudes of all segments where one is reached and damped."""
    reached = [speed for speed in critical if vibration.met(speed)]
    at_reached = _at_speeds(vibration, [speed.speed for speed in reached])
    amplitudes_of = dict(zip(reached, at_reached))
    rows: list[PlaceRow] = []
    for speed in critical:
        values = {id: float(value) for id, value in speed._asdict().items() if value is not None}
        for amplitudes in amplitudes_of.get(speed, ()):
            for id, amplitude in amplitudes.items():
                values[id] = max(values.get(id, 0.0), amplitude)
        rows.append((("near" if speed.near else "",), values))
    return rows


def _modes_table(vibration: ShaftVibration) -> Places:
    """Return the natural frequencies, with how many nodes each mode has, and where if they are few."""
    rows: list[PlaceRow] = []
    for index, omega in enumerate(vibration.modes.omegas.tolist()):
        mode = vibration.first + index
        text = _nodes_text(vibration, index) if mode else "rotation"
        values = {"mode": float(mode), "frequency": omega / (2 * math.pi), "omega_natural": omega}
        rows.append(((text,), values))
    return Places("modes", "Natural frequencies", ("nodes",), MODES, rows)


def _speeds_table(vibration: ShaftVibration, speeds: Sequence[float]) -> Places:
    """Return the amplitudes of every segment over the speed."""
    at_speeds = list(_at_speeds(vibration, speeds))
    rows: list[PlaceRow] = []
    for number in range(len(vibration.line.segments)):
        name = vibration.segment_name(number)
        for speed, amplitudes in zip(speeds, at_speeds):
            rows.append(((name,), {"speed": speed, **amplitudes[number]}))
    title = "Vibratory torque over the speed, all these orders together"
    return Places("speeds", title, ("piece",), SPEEDS, rows)


def _nodes_text(vibration: ShaftVibration, index: int) -> str:
    """Return how many nodes a mode has, counted from 0, and where if they are few."""
    where = ["at the ground"] * len(vibration.chain.fixed_segments)
    for segment, share in vibration.modes.nodes(index):
        before = vibration.line.segments[segment].before
        name = "ground" if before == GROUNDED else vibration.line.masses[before].name
        if not share:
            where.append(name)
        elif vibration.chain.has_branches:
            where.append(f"{vibration.segment_name(segment)} at {share:.2f}")
        else:
            where.append(f"{name} + {share:.2f}")
    count = "1 node" if len(where) == 1 else f"{len(where)} nodes"
    return f"{count}: {', '.join(where)}" if 0 < len(where) <= 2 else count


def _holzer_table(vibration: ShaftVibration, mode: int, at: float | None) -> Places:
    """Return Holzer's table of a mode, or at a frequency in Hz: each mass with the segment after it.

    With branches that is the segment toward the last mass of the line. At a frequency that is not a natural one the
    last row has what is left: a torque, or the angle of a fixed end.
    """
    chain, left = vibration.chain, 0.0
    if at is None:
        table, omega = vibration.holzer(mode), float(vibration.modes.omegas[mode - vibration.first])
        of = f"of mode {mode}, f = {omega / (2 * math.pi):.6g} Hz"
    else:
        table, omega = holzer_at(chain, 2 * math.pi * at), 2 * math.pi * at
        of, left = f"at f = {at:.6g} Hz", table.residual

    tree = tree_from_first(chain)
    rows: list[tuple[tuple[str, ...], dict[str, float]]] = []
    for number, mass in enumerate(vibration.line.masses):
        for segment in tree.fixed[number]:
            is_before = chain.joins[segment][0] == GROUNDED
            of_segment = _holzer_segment(vibration, table, segment, is_before)
            rows.append((("ground", vibration.segment_name(segment)), {"theta": 0.0} | of_segment))
        inertia, theta = float(chain.inertias[number]), float(table.angles[number])
        values = {"inertia": inertia, "theta": theta, "inertia_torque": omega**2 * inertia * theta}
        link, piece = tree.links[number], ""
        if link is not None:
            values |= _holzer_segment(vibration, table, link.segment, link.onward)
            piece = vibration.segment_name(link.segment)
        rows.append(((mass.name, piece), values))
    if tree.root_segment is not None:
        rows.append((("ground", ""), {"theta": left}))
    elif at is not None:
        rows[-1][1]["torque_sum"] = left

    labels: tuple[str, ...] = ("mass", "piece")
    if not chain.has_branches:  # the segment is between the mass of its row and that of the next
        labels = ("mass",)
        rows = [(texts[:1], values) for texts, values in rows]
    return Places("holzer", f"Holzer's table {of}, ω² = {omega**2:.6g} 1/s²", labels, HOLZER, rows)


def _holzer_segment(
    vibration: ShaftVibration, table: Holzer, segment: int, onward: bool
) -> dict[str, float]:
    """Return the values of a segment in Holzer's table; onward: whether the mass of the row is before it."""
    chain = vibration.chain
    torque = float(table.torques[segment] if onward else -table.torques_behind[segment])
    stiffness = float(chain.stiffnesses[segment])
    if chain.segment_inertias[segment]:
        twist = float(chain.twists[segment] @ table.angles) * (1 if onward else -1)
    else:
        twist = torque / stiffness
    return {"torque_sum": torque, "stiffness": stiffness, "twist": twist}


def _at_speeds(
    vibration: ShaftVibration, speeds: Sequence[float]
) -> Iterator[list[dict[str, float]]]:
    """Yield for each speed vibratory torque and stress of every segment, nothing at an undamped resonance."""
    if not speeds:
        return
    forced = vibration.forced(speeds)
    factors = [stress(vibration.line, number) for number in range(len(vibration.line.segments))]
    for torques, is_endless in zip(forced.vibratory.T.tolist(), forced.endless):
        amplitudes = []
        for torque, factor in zip(torques, factors):
            values = {} if is_endless else {"M_vibratory": torque}
            if factor is not None and not is_endless:
                values["tau_vibratory"] = factor * torque
            amplitudes.append(values)
        yield amplitudes


def _of_piece(piece: SegmentTorque) -> dict[str, float]:
    torques = piece.M_shaft_mean, piece.M_shaft_max, piece.M_shaft_min, piece.M_vibratory
    values = zip(PIECES, (*torques, piece.tau_mean, piece.tau_vibratory))
    return {id: value for id, value in values if value is not None}


def torsion_left_out(vibration: ShaftVibration) -> Iterator[LeftOut]:
    """Yield what torsional vibration leaves out."""
    if vibration.obstacle:
        yield LeftOut("forced vibration, torques and stresses", vibration.obstacle)
    else:
        names = [
            vibration.segment_name(number)
            for number, segment in enumerate(vibration.line.segments)
            if not segment.sections
        ]
        if names:
            yield LeftOut(f"stress in {', '.join(names)}", "no diameter given")
    if vibration.machine.cylinders:
        why = "the mean is used; parametric excitation is not computed"
        yield LeftOut("change of the inertia over the turn", why)


def torsion_warnings(case: Case) -> Iterator[str]:
    """Yield which of the usual critical speeds are near the working speed; raises as the report does."""
    yield from _near_speeds(
        _limited(case.torsion), case.torsion.critical_speeds(_MODES, _HIGHEST_CRITICAL)
    )


def _near_speeds(vibration: ShaftVibration, critical: Sequence[Critical]) -> Iterator[str]:
    """Yield, mode by mode, the critical speeds near the working speed, the strongest first."""
    working = vibration.machine.speed
    if working is None:
        return
    for mode in sorted({speed.mode for speed in critical}):
        near = [speed for speed in critical if speed.mode == mode and speed.near]
        near.sort(key=lambda speed: -speed.share)
        if near:
            percents = [f"{100 * (speed.distance or 0.0):+.3g} %" for speed in near]
            texts = [f"{speed.order:g} ({percent})" for speed, percent in zip(near, percents)]
            plural = "s" if len(near) > 1 else ""
            yield (
                f"mode {mode}: critical speed{plural} of order{plural} {', '.join(texts)} within 10 % of the "
                f"working speed {show(working, 'speed')}"
            )


def _torsion_notes(vibration: ShaftVibration, usual: bool, hidden: bool) -> Iterator[str]:
    """Yield the notes; usual: no orders are requested; hidden: some critical speeds have no amplitude, others have."""
    line = vibration.line
    if usual:
        yield f"Critical speeds of orders up to {_HIGHEST_CRITICAL}; --orders lists others, --modes more modes."
    if hidden:
        yield (
            "Torques and stresses at a critical speed include all orders, when running there; – marks a speed that the "
            f"machine does not reach, beyond {RUN_UP:g} times the working speed, and a mode that is hardly damped."
        )
    if vibration.chain.segment_inertias.any():
        yield "Segments have inertia of their own; Σω²JΘ does not add up row by row."
    ratios = {segment.ratio for segment in line.segments} - {1.0}
    if ratios:
        gear = "gear" if len(ratios) == 1 else "gears"
        yield (
            f"Masses and stiffnesses beyond the {gear} are referred to the cranks' shaft by u²; "
            "torques are true ones."
        )
    if not vibration.machine.cylinders and vibration.machine.effort:
        yield f"The effort acts on {line.masses[0].name}, the first mass."
    if vibration.segments:
        orders = "all orders" if vibration.summed is None else _listed_orders(vibration.summed)
        more = ""
        if vibration.remainder is not None:
            remainder = show(vibration.remainder, "torque", figures=2)
            more = f" (higher ones add about {remainder} or less)"
        taker = "what holds it" if vibration.chain.is_held else line.masses[line.load].name
        yield f"Forced vibration: {orders} together{more}, about uniform rotation; the mean torque goes to {taker}."


def _listed_orders(orders: Iterable[float]) -> str:
    """Return the orders that are summed, of many the first and the last."""
    names = [f"{order:g}" for order in orders]
    if len(names) > 4:
        return f"{len(names)} orders from {names[0]} to {names[-1]}"
    return f"order{'s' if len(names) > 1 else ''} {', '.join(names)}"
