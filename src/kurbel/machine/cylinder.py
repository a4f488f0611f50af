"""One cylinder with its mechanism, and which parts fit it: no piston on a swinging output, no rod without a piston."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import fields, is_dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from kurbel.arrays import Truth
from kurbel.crank_angle import CYCLES, CrankAngle
from kurbel.declared.forms.structures import (
    Inline,
    Listing,
    OneOf,
    ReadMapping,
    RecordForm,
    Variant,
)
from kurbel.declared.forms.values import NumberForm
from kurbel.declared.reading import REFUSED
from kurbel.declared.record import (
    FieldValue,
    Record,
    Rule,
    ValuesByKey,
    alternative,
    field,
    first_of,
)
from kurbel.errors import Path
from kurbel.machine.parts import (
    ConnectingRod,
    Friction,
    GasOnRings,
    Masses,
    Moment,
    Piston,
    RamForce,
    RodPoint,
    TandemPiston,
)
from kurbel.mechanisms import Mechanism
from kurbel.mechanisms.kinds import MECHANISMS
from kurbel.numerics.arithmetic import sqrt, where

if TYPE_CHECKING:
    from kurbel.machine.crankshaft import Counterweight, SharedCounterweights
    from kurbel.machine.link_rod import LinkRod
    from kurbel.machine.load import OutputForce
    from kurbel.machine.valve import Valve
    from kurbel.traces.correct import Strokes

MOST_TURNS = 100
"""Turns of the shaft after which everything repeats, at most."""
_SLIDING = ("inclination", "masses", "friction", "ram_force")
"""Keys, apart from those of pistons, of a cylinder whose output slides."""

_OTHER_NAMES = {
    **dict.fromkeys(
        ("whitworth", "shaper", "quick-return", "crank-shaper", "slotted-link"), "slotted-lever"
    ),
    **dict.fromkeys(("crank-rocker", "four-bar-linkage", "4-bar"), "four-bar"),
    **dict.fromkeys(("crank-slider", "crosshead", "trunk-piston"), "slider-crank"),
    "parallelogram": "parallel-crank",
    **dict.fromkeys(
        ("wobbler", "trunnion-engine", "oscillating-engine", "oscillating"), "oscillating-cylinder"
    ),
}
"""Common name of a mechanism -> the word of the machine file."""


_SPRING = "a spring on what slides or swings is written 'force: {spring: 50 N/mm, preload: 1 kN}'"
_PIN_OFFSET = (
    "the angle between the two halves of a split crank pin is 'throw_angle'; a piston pin beside the middle of its "
    "piston is an 'offset', a length, negative toward the thrust side"
)
_SEVERAL = "equal cylinders are written 'cylinders: {count: 4, firing_order: 1-3-4-2, each: {…}}'"
_MASSES = "masses are written 'masses: {piston: 1.2 kg, connecting_rod: 1.5 kg}'"
_NO_KEYS = {
    "pin_offset": _PIN_OFFSET,
    **dict.fromkeys(("number_of_cylinders", "cylinder_count"), _SEVERAL),
    **dict.fromkeys(("piston_mass", "conrod_mass", "rod_mass", "reciprocating_mass"), _MASSES),
    **dict.fromkeys(("spring", "spring_rate", "spring_stiffness"), _SPRING),
}
"""Word for what a cylinder may have, but no key describes -> what to write instead."""


def _link_rod() -> type[LinkRod]:
    from kurbel.machine.link_rod import LinkRod

    return LinkRod


def _valve() -> type[Valve]:
    from kurbel.machine.valve import Valve

    return Valve


def _force() -> type[OutputForce]:
    from kurbel.machine.load import OutputForce

    return OutputForce


def _constant_force(force: float) -> OutputForce:
    """Return the load of one constant force in N."""
    return _force()(constant=force)


def _shared_counterweights() -> type[SharedCounterweights]:
    from kurbel.machine.crankshaft import SharedCounterweights

    return SharedCounterweights


def _counterweight() -> type[Counterweight]:
    from kurbel.machine.crankshaft import Counterweight

    return Counterweight


def counterweights() -> FieldValue:
    """Return the field of the counterweights of a cylinder, next to its throw, or of the whole machine."""
    return field(
        OneOf(RecordForm(_shared_counterweights), Listing(RecordForm(_counterweight))),
        "Counterweights on the crank: a share of the reciprocating mass, or a list of them",
        default=(),
    )


class Cylinder(Record):
    """One cylinder with its crank mechanism and all that is on the same rod.

    pistons: its own first, then the tandem ones; inclination in degrees against the horizontal, None where the weight
    is left out; crank_position: degrees by which its inner dead centre follows that of cylinder 1, None in a cylinder
    from a file that gives none, until the machine sets it; throw_angle: degrees by which its pin lags that of cylinder
    1, None where the file does not give it; bank_angle: degrees from the stroke line of cylinder 1 to
    its own, in the sense of rotation; axial_position: place along the shaft in m, None where it is not known;
    ram_force, moment: what the output works against, where it slides or only swings; force: what acts on either. Raises
    RuleError for parts that the mechanism cannot have.
    """

    UNWRITTEN = _NO_KEYS

    mechanism: Mechanism = field(
        Variant("slider-crank", MECHANISMS, _OTHER_NAMES),
        "Kind of crank mechanism",
        absent="slider-crank",
    )
    name: str = field(
        str, "Name of the cylinder", default="cylinder 1", absent="cylinder 1, cylinder 2, …"
    )
    _like = alternative(
        str,
        "Name of an earlier cylinder that this one copies, except for the keys given here",
        absent="none",
        also=("<<",),
    )
    _piston = alternative(Inline(Piston), "The cylinder's own piston")
    _tandem = alternative(
        [RecordForm(TandemPiston, inline_too=True)],
        "Further pistons on the same rod, such as a pump, or driven by a rocker; their two-stroke cards run twice in "
        "720°",
        absent="none",
    )
    pistons: tuple[Piston, ...] = ()
    masses: Masses | None = field(Masses, "Masses of the moving parts", absent="no inertia")
    friction: Friction | None = field(
        Friction,
        "Friction of crosshead, piston rings, pins and journals, or a force",
        absent="no friction",
    )
    inclination: float | None = field(
        "angle",
        "Angle of the stroke line from the horizontal: 0 deg horizontal, 90 deg cylinder above the shaft, more than "
        "90 deg beyond the vertical",
        least=-180,
        most=180,
        absent="weight left out",
    )
    crank_position: float = field(
        "angle",
        "Crank angle by which the inner dead centre of this cylinder follows that of cylinder 1",
        default=0.0,
        absent="0 deg; 360 deg in a four-stroke cycle where the firing intervals are then more even",
    )
    _throw_angle = alternative(
        "angle",
        "Angle by which its crank pin, as the shaft is built, lags that of cylinder 1; a `firing_order` then only "
        "gives the turn in which a four-stroke cylinder fires",
        instead="crank_position",
        absent="from `crank_position`",
        example="120 deg",
        also=("pin_angle", "split_pin", "crank_pin_angle", "splay_angle", "throw"),
    )
    throw_angle: float | None = None
    bank_angle: float = field(
        "angle",
        "Angle from the stroke line of cylinder 1 to this one, in the sense of rotation",
        "γ",
        default=0.0,
        least=-360,
        most=360,
        absent="0 deg",
    )
    axial_position: float | None = field(
        "length", "Position along the shaft", "z", absent=("unbalanced moments left out")
    )
    counterweights: SharedCounterweights | tuple[Counterweight, ...] = counterweights()
    ram_force: RamForce | None = field(
        RamForce, "Force opposing the motion of a ram, constant on each stroke", absent="none"
    )
    moment: Moment | None = field(
        Moment, "Resisting moment of a mechanism whose output swings or rotates", absent="none"
    )
    force: OutputForce | None = field(
        OneOf(
            NumberForm("force", becomes=lambda force, _: _constant_force(force)),
            RecordForm(_force),
        ),
        "Load on what slides or swings, positive where x or θ rises (toward the shaft): a constant force, or a mapping",
        absent="none",
        example="{spring: 50 N/mm, preload: 1 kN}",
    )
    cycle: str | None = field(
        tuple(CYCLES), "Working cycle of this cylinder, among others", absent="that of the machine"
    )
    point: RodPoint | None = field(
        RodPoint,
        "A point of the connecting rod or coupler, whose position, velocity and acceleration are printed",
        absent="none",
    )
    valve: Valve | None = field(
        _valve,
        "Slide or piston valve driven by an eccentric, which sets the events of `steam` cards",
        absent="none",
    )

    link_rod: LinkRod | None = field(
        _link_rod,
        "Rod on a knuckle pin of the master rod of an earlier cylinder, instead of the crank pin",
        absent="the rod is on the crank pin",
        also=("master", "master_rod", "articulated_rod", "slave_rod", "knuckle_pin"),
    )

    @classmethod
    def rules_of_keys(cls, values: ValuesByKey) -> Iterator[Rule]:
        like = "'like' is for a list of 'cylinders', after another cylinder"
        yield Rule("like", "like" in values, like)
        alone = "a tandem piston is in addition to the cylinder's own one; give its 'bore'"
        yield Rule("tandem", bool(values.get("tandem")) and "piston" not in values, alone)

    @classmethod
    def completed(
        cls, values: dict[str, object], made: Callable[[object], Any]
    ) -> dict[str, object]:
        """Return values by key with the bore of a displacement and a stroke, or the stroke of the first two."""
        piston = values.get("piston")
        tandem = values.get("tandem")
        pistons = [piston, *(tandem if isinstance(tandem, tuple) else ())]
        if not any(_has_displacement(mapping) for mapping in pistons):
            return values
        mechanism = values["mechanism"]
        if isinstance(mechanism, ReadMapping) and isinstance(piston, ReadMapping):
            mechanism = made(_with_stroke(mechanism, piston))
        stroke = mechanism.stroke if isinstance(mechanism, Mechanism) else REFUSED
        sized = [_with_bore(mapping, stroke) for mapping in pistons]
        values = {**values, "mechanism": mechanism, "piston": sized[0]}
        if tandem is not None:
            values["tandem"] = tuple(sized[1:]) if isinstance(tandem, tuple) else tandem
        return values

    @classmethod
    def of_keys(
        cls,
        piston: Piston | None = None,
        tandem: tuple[Piston, ...] = (),
        like: str = "",
        throw_angle: float | None = None,
        **keys: Any,
    ) -> Cylinder:
        """Return the cylinder that these keys of a machine file describe; the machine names it where they do not."""
        pistons = () if piston is None else (piston, *tandem)
        values = {"name": "", "crank_position": None, "throw_angle": throw_angle, **keys}
        return cls(pistons=pistons, **values)

    @cached_property
    def timed_pistons(self) -> tuple[Piston, ...]:
        """Its pistons, with the events of the valve in the steam cards of its own one."""
        if self.valve is None or not self.pistons:
            return self.pistons
        timed = self.valve.timed(self.pistons[0], self.mechanism)
        return timed, *self.pistons[1:]

    def hangs_on(self, master: str) -> bool:
        """Return whether its link rod is on the master rod of the cylinder with this name."""
        return self.link_rod is not None and self.link_rod.master == master

    def rules(self) -> Iterator[Rule]:
        """Yield which parts do not fit the mechanism, and steam cards whose events are missing, or set twice."""
        if self.valve:
            yield from (rule.below("valve") for rule in self.valve.rules_on(self.mechanism))
        yield from _of_events(self)
        yield from _of_strokes(self)
        yield from _of_displacements(self)
        yield from _of_measured_strokes(self)
        at_point = (
            [rule.below("point") for rule in self.point.rules_on(self.mechanism)]
            if self.point
            else []
        )
        yield from at_point
        if not any(rule.broken for rule in at_point):
            yield from _of_output(self)
            rod = self.masses.connecting_rod if self.masses else None
            if self.friction and self.mechanism.slides:
                yield from (rule.below("friction") for rule in _of_friction(self.friction, self))
            if rod and self.mechanism.slides:
                yield from (
                    rule.below("masses", "connecting_rod") for rule in _of_rod(rod, self.mechanism)
                )


def names_of(cylinders: Sequence[Cylinder]) -> list[str]:
    """Return the names of cylinders; those without one are named by their numbers."""
    return [cylinder.name or f"cylinder {number}" for number, cylinder in enumerate(cylinders, 1)]


def crank_lag(cylinder: Cylinder, first: Cylinder) -> float:
    """Return δ = β + φ_i,1 − φ_i in degrees, by which the own crank angle of a cylinder lags that of the first.

    β counts from inner dead centre to inner dead centre, the crank angle from where the pin passes the stroke line.
    """
    inner = cylinder.mechanism.dead_centres()[0]
    first_inner = first.mechanism.dead_centres()[0]
    return cylinder.crank_position + (first_inner - inner)


def pin_lag(cylinder: Cylinder, first: Cylinder) -> float:
    """Return ζ = δ − γ in degrees, by which the crank pin of a cylinder lags that of the first on the shaft."""
    return crank_lag(cylinder, first) - (cylinder.bank_angle - first.bank_angle)


def crowded(cylinders: Sequence[Cylinder]) -> Iterator[Rule]:
    """Yield the rule that no two cylinders are at the same place along the shaft and on the same stroke line."""
    message = "is at the place of '{other}', {place:length} along the shaft, on the same stroke line; give another"
    for index, cylinder in enumerate(cylinders):
        rules = []
        for other in cylinders[:index]:
            if cylinder.axial_position is not None and other.axial_position is not None:
                same = np.abs(cylinder.axial_position - other.axial_position) < 1e-9
                same = same & np.equal(
                    np.round(cylinder.bank_angle - other.bank_angle, 6) % 360.0, 0
                )
                numbers = {"other": other.name, "place": cylinder.axial_position}
                path = ("cylinders", index, "axial_position")
                rules.append(
                    Rule(path, same, f"{message} 'axial_position' or 'bank_angle'", numbers)
                )
        yield from first_of(iter(rules))


def may_lock(cylinder: Cylinder) -> Truth:
    """Return whether the friction of the crosshead is great enough to lock it where it is driven: f tan ψ ≥ 1."""
    coefficient = cylinder.friction.crosshead if cylinder.friction else None
    locking: Truth = False
    if coefficient is None:
        return locking
    widest = [
        rod
        for centre in (90.0, 270.0)
        if (rod := cylinder.mechanism.rod_angle(CrankAngle.of(centre)))
    ]
    for sin, cos in widest:
        locking = locking | (coefficient * np.abs(sin) >= cos)
    return locking & (coefficient > 0)


def with_article(kind: str) -> str:
    """Return the word of a mechanism with its article.

    >>> with_article("oscillating-cylinder")
    'an oscillating-cylinder'
    """
    if kind[0] in "aeiou":
        return f"an {kind}"
    return f"a {kind}"


def _of_output(cylinder: Cylinder) -> Iterator[Rule]:
    kind, moment = cylinder.mechanism.name, cylinder.moment
    if cylinder.mechanism.swings_cylinder:
        message = "the cylinder swings with its piston; kurbel takes no masses there"
        yield Rule("masses", cylinder.masses is not None, message)
        yield Rule("inclination", cylinder.inclination is not None, message)
    if cylinder.force is not None:
        yield from (rule.below("force") for rule in cylinder.force.rules_on(cylinder.mechanism))
    if cylinder.mechanism.slides:
        to_and_fro = (
            f"{with_article(kind)} moves its output to and fro; give 'ram_force' or 'force' instead"
        )
        yield Rule("moment", moment is not None, to_and_fro)
        return
    values_by_key = {
        "bore": cylinder.pistons or None,
        **{key: vars(cylinder)[key] for key in _SLIDING},
    }
    for key, value in values_by_key.items():
        yield Rule(
            key,
            value is not None,
            f"nothing slides in a {kind}; leave '{key}' out{_INSTEAD.get(key, '')}",
        )
    returns = bool(cylinder.mechanism.turns and moment and np.any(moment.back))
    message = (
        f"the output of a {kind} rotates continuously and has no return stroke; give 'work' alone"
    )
    yield Rule(("moment", "return"), returns, message)


_INSTEAD = {
    "bore": ", with the indicator, or choose a mechanism with a piston",
    "ram_force": "; the resistance of a swinging output is a 'moment'",
}
"""What else to do where nothing slides that could have this key."""


def _of_friction(friction: Friction, cylinder: Cylinder) -> Iterator[Rule]:
    """A crosshead needs a side force and a guide, rings a bore, pins a rod; a yoke must not lock."""
    mechanism, pistons, rings = cylinder.mechanism, cylinder.pistons, friction.rings
    kind = with_article(mechanism.name)
    has_rod = mechanism.has_rod
    yield Rule(
        "rings",
        rings is not None and not pistons,
        "rings rub on the bore; give the cylinder a 'bore'",
    )
    by_gas = rings is not None and isinstance(rings.pressure, GasOnRings)
    without = by_gas and bool(pistons) and pistons[0].indicator is None
    yield Rule(("rings", "pressure"), without, "the gas presses on no ring without an 'indicator'")
    reason = "crosshead guide" if has_rod else "connecting rod to press a crosshead on its guide"
    unguided = friction.crosshead is not None and not (has_rod and mechanism.guided)
    yield Rule("crosshead", unguided, f"{kind} has no {reason}; leave 'crosshead' out")
    for key in friction.of_pins:
        without = not has_rod and (key == "crosshead_pin" or not mechanism.rubs)
        yield Rule(key, without, f"{kind} has no connecting rod; leave '{key}' out")
    for key, coefficient in (("block", friction.block), ("guides", friction.guides)):
        without = coefficient is not None and not mechanism.rubs
        yield Rule(key, without, f"{kind} is no scotch-yoke; leave '{key}' out")
    if mechanism.rubs and friction.guides is not None:
        apart = mechanism.guide_distance
        yield Rule("guides", apart is None, "'guides' needs their distance; give 'guide_length'")
        locks = apart is not None and 2 * friction.guides * mechanism.crank >= apart
        message = (
            "with this coefficient the guides lock the yoke: 2 f R must be less than 'guide_length'"
        )
        yield Rule("guides", locks, message)


def _has_displacement(mapping: object) -> bool:
    return isinstance(mapping, ReadMapping) and "displacement" in mapping.values


def _with_stroke(mechanism: ReadMapping, piston: ReadMapping) -> ReadMapping:
    """Return a mechanism with the stroke that a piston of this bore and displacement has, if it has none."""
    keys = mechanism.form.keys
    has_stroke = "crank" in mechanism.values or "stroke" in mechanism.values
    bore: Any = piston.values.get("bore")
    displacement: Any = piston.values.get("displacement")
    if has_stroke or "stroke" not in keys or bore is None or displacement is None:
        return mechanism
    if bore is REFUSED or displacement is REFUSED:
        return mechanism.with_value("stroke", REFUSED)
    # s = 4 V/(π d²)
    return mechanism.with_value("stroke", displacement / (math.pi / 4 * bore**2))


def _with_bore(mapping: object, stroke: Any) -> object:
    """Return a piston with the bore that its displacement and a stroke in m have, if it has none."""
    if not isinstance(mapping, ReadMapping) or not _has_displacement(mapping):
        return mapping
    if "bore" in mapping.values:
        return mapping
    displacement: Any = mapping.values["displacement"]
    ratio: Any = mapping.values.get("lever_ratio", 1.0)
    if REFUSED in (stroke, displacement, ratio):
        return mapping.with_value("bore", REFUSED)
    # d = √(4 V/(π s))
    area = displacement / (stroke * np.abs(ratio))
    return mapping.with_value("bore", sqrt(area / (math.pi / 4)))


def _of_displacements(cylinder: Cylinder) -> Iterator[Rule]:
    """A displacement is that of bore and stroke."""
    for number, piston in enumerate(cylinder.pistons):
        path = ("tandem", number - 1) if number else ()
        stroke = cylinder.mechanism.stroke * np.abs(piston.lever_ratio)
        yield from (rule.below(*path) for rule in piston.displacement_rules(stroke))


_SAME_STROKE = 0.03
"""Relative difference of the range of a measured volume from the volume that a piston sweeps."""


def _of_measured_strokes(cylinder: Cylinder) -> Iterator[Rule]:
    """A trace over volumes or displacements runs over those that its piston sweeps."""
    for number, piston in enumerate(cylinder.pistons):
        path = ("tandem", number - 1, "indicator") if number else ("indicator",)
        areas = {"head_end": piston.head_area, "crank_end": piston.crank_area}
        chambers = piston.chambers
        if chambers.get("crank_end") is chambers.get("head_end"):  # mirrored
            chambers.pop("crank_end", None)
        for end, chamber in chambers.items():
            if not chamber.traced or chamber.strokes is None:
                continue
            swept = cylinder.mechanism.stroke * np.abs(piston.lever_ratio)
            if chamber.strokes.kind == "volume":
                swept = swept * areas[end]
            place = (*path, end, "trace")
            yield from _of_measured_range(chamber.strokes, swept, place)
            yield from _of_measured_clearance(chamber.strokes, chamber.clearance, place)


def _of_measured_range(strokes: Strokes, swept: float, path: Path) -> Iterator[Rule]:
    """Yield that the range of a measured volume or displacement is not what the piston sweeps, in m³ or m."""
    ratio = strokes.swept / swept
    is_unit = max(ratio, 1 / ratio) > _OTHER_UNIT
    is_different = not is_unit and abs(ratio - 1) > _SAME_STROKE
    form = "volume"
    cause = "bore, rod or stroke"
    if strokes.kind == "displacement":
        form = "length"
        cause = "stroke"
    message = f"the {strokes.kind}s run over {{run:{form}}}, the piston sweeps {{swept:{form}}}: "
    numbers = {"run": strokes.swept, "swept": swept}
    place = (*path, f"{strokes.kind}_unit")
    yield Rule(place, is_unit, f"{message}is '{strokes.kind}_unit' right?", numbers)
    percent = round(100 * (ratio - 1), 1)
    message = f"{message}{percent:g} %; correct {cause}, or cut the file"
    yield Rule(place, is_different, message, numbers)


def _of_measured_clearance(strokes: Strokes, clearance: float | None, path: Path) -> Iterator[Rule]:
    """Yield that a clearance is another one than that of the smallest volume; 0 in volumes that are displaced alone."""
    if clearance is None or strokes.kind != "volume":
        return
    measured = strokes.smallest / strokes.swept
    has_clearance = measured > _LEAST_MEASURED
    is_different = has_clearance and abs(measured / clearance - 1) > _SAME_CLEARANCE
    message = (
        f"the smallest volume is {measured:.4g} of the stroke volume, the clearance {clearance:.4g}; "
        "leave 'clearance' out, or correct it"
    )
    yield Rule((*path, "volume_column"), is_different, message)


_LEAST_MEASURED = 0.002
"""Smallest over swept volume below which a file has the displaced volume alone."""
_SAME_CLEARANCE = 0.03
"""Relative difference of two clearances through rounding."""
_OTHER_UNIT = 2.0
"""Ratio of two volumes from which on one has another unit."""


def _of_events(cylinder: Cylinder) -> Iterator[Rule]:
    """A steam card has its events from the valve, or its own; the valve is that of the cylinder's own piston."""
    for number, piston in enumerate(cylinder.pistons):
        path = ("tandem", number - 1, "indicator") if number else ("indicator",)
        chambers = piston.chambers
        if chambers.get("crank_end") is chambers.get("head_end"):  # mirrored
            chambers.pop("crank_end", None)
        for end, card in chambers.items():
            valve = None if number else cylinder.valve
            shuts_early = None if valve is None else valve.compresses
            yield from (rule.below(*path, end) for rule in card.rules_of_events(shuts_early))


def _of_strokes(cylinder: Cylinder) -> Iterator[Rule]:
    """Heat that is released over the crank angle fits the strokes of its piston."""
    for number, piston in enumerate(cylinder.pistons):
        path = ("tandem", number - 1, "indicator") if number else ("indicator",)
        areas = {"head_end": piston.head_area, "crank_end": piston.crank_area}
        for end, card in piston.chambers.items():
            if card.by_stroke or card.traced:
                continue
            volume = areas[end] * abs(piston.lever_ratio) * cylinder.mechanism.stroke
            inner, outer = cylinder.mechanism.dead_centres()
            outstroke = outer - inner
            expands_outward = (end == "head_end") != (piston.lever_ratio < 0)
            expansion = where(expands_outward, outstroke, 360.0 - outstroke)
            rules = card.rules_of_strokes(360.0 - expansion, expansion, volume)
            yield from (rule.below(*path, end) for rule in rules)


def _of_rod(rod: ConnectingRod, mechanism: Mechanism) -> Iterator[Rule]:
    """The mass of a rod needs a rod, and its centre of gravity lies on it."""
    kind = with_article(mechanism.name)
    message = f"{kind} has no connecting rod; give the reciprocating mass as 'other'"
    yield Rule((), not mechanism.has_rod, message)
    if mechanism.has_rod and rod.center_of_gravity is not None:
        length = mechanism.rod_length
        endless = (
            "an infinite rod has no centre of gravity; give its 'share', or the length of the rod"
        )
        yield Rule("center_of_gravity", np.isinf(length), endless)
        # a rod that reaches beyond a pin may have it there in theory; a slip of the unit is far more likely
        beyond = "{at:length} from the crosshead pin is beyond the crank pin: the rod is {length:length} long"
        numbers = {"at": rod.center_of_gravity, "length": length}
        yield Rule("center_of_gravity", rod.center_of_gravity > length, beyond, numbers)


_PLACE = (
    "name",
    "crank_position",
    "throw_angle",
    "bank_angle",
    "axial_position",
    "counterweights",
)
"""Keys of a cylinder on its place along the shaft, and on what the shaft carries there."""


def work_alike(cylinder: Cylinder, other: Cylinder) -> bool:
    """Return whether two cylinders have the same motion and forces, at whatever place along the shaft."""
    keys = (field.name for field in fields(Cylinder) if field.name not in _PLACE)
    return all(_same(vars(cylinder)[key], vars(other)[key]) for key in keys)


def _same(value: object, other: object) -> bool:
    if value is other or type(value) is not type(other):
        return value is other
    if is_dataclass(value) and not isinstance(value, type):
        return all(
            _same(vars(value)[field.name], vars(other)[field.name]) for field in fields(value)
        )
    if isinstance(value, tuple) and isinstance(other, tuple):
        return len(value) == len(other) and all(map(_same, value, other))
    return bool(np.array_equal(np.asarray(value), np.asarray(other)))
