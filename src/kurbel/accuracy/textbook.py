"""References: cylinders and machines as textbooks write them, in mpmath's numbers.

Nothing is shared with the solver: pressures are found and signs of friction chosen anew, and every member is a free
body. Differences of nearly equal numbers are left as they are in the books; the digits pay for them. Angles are in
degrees, all else in SI. `within` is any angle of a piece between corners: it selects the side of a corner.

The cylinder is on the left, the shaft on the right, and the crank pin above the stroke line on the outstroke:

    crosshead    Q − s f |N| − H_x = 0          N − G − H_y = 0
    rod          Z = H + W − m_r a_G            L (sin ψ H_x − cos ψ H_y) + τ − C = I ψ̈    about the crank pin
    crank        M = Z × R − friction in the crank pin and the journals

Q has gas, inertia and weight of what slides, less the friction of rings; s is the sense of the stroke, H the force on
the rod's crosshead pin, Z that on the crank pin, τ the moment of weight and inertia of the rod, C the friction of both
pins. Friction in pins is that under the loads without it, as by the friction circles of the books.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cache, cached_property
from typing import TYPE_CHECKING, Any, NamedTuple, Union

import numpy as np

from kurbel.accuracy.cards import (
    KNOWN_CARDS,
    CardProcess,
    Fractions,
    StrokeLine,
    drawn,
    of_liquid,
)
from kurbel.accuracy.jets import Jet
from kurbel.accuracy.linkages import (
    LinkMotion,
    RodMotion,
    Stance,
    TextbookMotion,
    moment,
    motion_of,
)
from kurbel.accuracy.loads import TextbookLoads
from kurbel.accuracy.methods import (
    Precise,
    integrals,
    merged,
    mp,
    mpf,
    roots_inside,
)
from kurbel.accuracy.valves import events_of
from kurbel.arrays import Array
from kurbel.machine import CYCLES, Cylinder, Machine
from kurbel.machine.ideal_cards import Steam
from kurbel.machine.parts import Friction, GasOnRings, Piston
from kurbel.mechanisms.scotch_yoke import ScotchYoke
from kurbel.mechanisms.setting import Setting

if TYPE_CHECKING:
    from kurbel.accuracy.traced import TracedChamber

DIGITS = 40
STEPS = 24
"""Equal steps of a piece, at which roots are looked for."""
GRAVITY = "9.80665"
_FINEST = mpf(10) ** 33
"""Parts of a degree: angles that differ by less are equal."""
IDLE = mpf("1e-9")
"""Work over the stroke in N, below which a piston neither drives nor is driven."""


# chambers


class TextbookChamber(NamedTuple):
    """One end of a piston: its card, whether it grows on the outstroke (sign 1) or the return (−1), its area in m²."""

    card: CardProcess
    sign: int
    area: Precise
    strokes: int

    @property
    def corners(self) -> list[Precise]:
        """No crank angles: a card bends at shares of a stroke."""
        return []

    def lines(self, stroke: int) -> list[StrokeLine]:
        """Return the card's lines on a stroke of the cycle."""
        number = (stroke - (self.sign < 0)) % self.strokes
        return [line for line in self.card.lines if line.stroke == number]

    def shares(self, stroke: int) -> set[Precise]:
        """Return the shares of the crosshead's stroke at which the lines of a stroke begin."""
        return {self.fraction(line.begin) for line in self.lines(stroke)}

    def fraction(self, share: Precise) -> Precise:
        """Return z of the card at a share of the crosshead's stroke, or that share at z."""
        return share if self.sign > 0 else 1 - share

    def line_at(self, stroke: int, share: Precise, within: Precise) -> StrokeLine:
        """Return the line on which the gas is at a share of the crosshead's stroke."""
        z = self.fraction(share)
        return next(line for line in self.lines(stroke) if (line.begin - z) * (line.end - z) < 0)

    def pressure(self, line: StrokeLine, share: Precise, phi: Precise) -> Precise:
        """Return the absolute pressure at a share of the crosshead's stroke, on one of the lines."""
        return self.card.at(line, self.fraction(share))

    @property
    def work(self) -> Precise:
        """The work in J over the stroke in m, of one process: A ∮ p dz."""
        areas = mpf(0)
        for line in self.card.lines:
            pressure = np.frompyfunc(lambda z, _, line=line: self.card.at(line, z), 2, 1)
            low, high = sorted((line.begin, line.end))
            area = integrals(pressure, np.array([low, high]), STEPS).sum()
            areas += area if line.end > line.begin else -area
        return self.area * areas


AnyChamber = Union[TextbookChamber, "TracedChamber"]
Line = Any
"""A line of a card, or the number of the sample at which one of a trace begins."""


class PistonProcess(NamedTuple):
    """The chambers of a piston; is_own: whether it is the cylinder's own one; drives: by the work of its gas."""

    chambers: tuple[AnyChamber, ...]
    is_own: bool
    work: Precise


# the forces


class RodBody(NamedTuple):
    """A rod as a rigid body: its mass in kg, its centre of gravity from the crosshead pin in m, its inertia in kg m².

    One given by the share that reciprocates is a mass at the crosshead pin, and one that turns with the crank pin,
    whose weight the books leave out: pin_mass.
    """

    mass: Precise
    gravity_center: Precise
    inertia: Precise
    pin_mass: Precise


class GasForces(NamedTuple):
    """Force of the gas in N, that on the driving pistons, and the pressure difference in Pa across the own piston."""

    force: Precise
    driving: Precise
    difference: Precise


class PinLoads(NamedTuple):
    """Friction in N along the stroke line; forces (x, y) in N on the crosshead pin and the crank pin.

    kinks: what changes its sign where the friction turns round.
    """

    drag: Precise
    H: tuple[Precise, Precise]
    Z: tuple[Precise, Precise]
    kinks: tuple[Precise, ...]


class Forces(NamedTuple):
    """dx/dφ in m; in N the gas force, that on driving pistons, friction along x and T; M in N m.

    losses: in N m, in pins, journals and the block of a yoke. The names are those of the columns of the solver; inertia
    is that at uniform speed. kinks: as of `PinLoads`. on_master: moment in N m of a link rod on its master rod about the
    crank pin.
    """

    slope: Precise
    P_gas: Precise
    P_driving: Precise
    F_friction: Precise
    losses: dict[str, Precise]
    T: Precise
    M: Precise
    kinks: tuple[Precise, ...]
    on_master: Precise = mpf(0)


class TextbookCylinder:
    """Forces of one cylinder; edges: of the pieces of its cycle between the corners of cards and of friction.

    links: the cylinders whose link rods are on its master rod, with the degrees by which their crank angles lag its own.
    """

    def __init__(
        self,
        machine: Machine,
        cylinder: Cylinder,
        links: Sequence[tuple[TextbookCylinder, Precise]] = (),
    ) -> None:
        self.motion: TextbookMotion = motion_of(cylinder.mechanism)
        self._links = links
        self.turns = CYCLES[machine.cycle_of(cylinder)]
        self.omega = 2 * mp.pi * mpf(machine.speed or 0.0)
        self._ambient = mpf(machine.ambient)
        self._cylinder = cylinder
        self._mechanism = cylinder.mechanism
        self._crankshaft = machine.crankshaft
        self._set_masses(machine.inclination_of(cylinder))
        self._set_friction(cylinder.friction)
        link_rod = cylinder.link_rod
        self._knuckle_mass = mpf(link_rod.knuckle_mass if link_rod else 0.0)
        motion = self.motion
        self._loads_on_output = TextbookLoads(
            cylinder, motion.stroke, self.turns, motion.works_out, motion.never_returns
        )
        self.pistons = [self._piston(machine, number) for number in range(len(cylinder.pistons))]
        self._piece = cache(self._piece_of)
        self._states: dict[tuple[int, int], Forces] = {}

    def _set_masses(self, inclination: float | None) -> None:
        """Set the mass of what slides, the rod, and the parts of gravity along and across the stroke line."""
        masses = self._cylinder.masses
        rod = masses.connecting_rod if masses else None
        self._parts = mpf(masses.parts if masses else 0.0)
        self._rod = RodBody(mpf(0), mpf(0), mpf(0), mpf(0))
        if rod is not None and rod.center_of_gravity is not None:
            inertia = mpf(rod.inertia)
            self._rod = RodBody(mpf(rod.mass), mpf(rod.center_of_gravity), inertia, mpf(0))
        elif rod is not None:
            at_crosshead = mpf(rod.mass) * mpf(rod.share)
            self._rod = RodBody(at_crosshead, mpf(0), mpf(0), mpf(rod.mass) - at_crosshead)
        gravity = mpf(0) if inclination is None else mpf(GRAVITY)
        angle = mp.radians(mpf(inclination or 0.0))
        self._g = gravity * mp.sin(angle), -gravity * mp.cos(angle)

    def _set_friction(self, friction: Friction | None) -> None:
        """Set coefficients, and moments of friction over the loads: f r."""
        self._crosshead = self._rings = self._ring_surface = mpf(0)
        self._block = self._guides = mpf(0)
        self._at_crank = self._at_crosshead = self._at_journals = mpf(0)
        if friction is None:
            self._rubs = False
            return
        self._crosshead = mpf((self._mechanism.has_rod and friction.crosshead) or 0.0)
        self._rings = mpf(friction.constant or 0.0)
        rings = friction.rings
        mechanism = self._mechanism
        if rings:
            surface = rings.count * mp.pi * mpf(self._cylinder.pistons[0].bore) * mpf(rings.height)
            pressed = surface * mpf(rings.coefficient)
            if isinstance(rings.pressure, GasOnRings):
                self._ring_surface = pressed * mpf(rings.pressure.gas)
            else:
                self._rings += pressed * mpf(rings.pressure)
        if isinstance(mechanism, ScotchYoke):
            self._block = mpf(friction.block or 0.0)
            self._guides = mpf(friction.guides or 0.0) / mpf(mechanism.guide_length or 1.0)
        self._at_crank = _radius(friction.crank_pin, self._pin_diameter(friction))
        self._at_crosshead = _radius(friction.crosshead_pin, friction.crosshead_pin_diameter)
        self._at_journals = _radius(friction.journals, friction.journal_diameter)
        self._rubs = any(
            (self._crosshead, self._ring_surface, self._block, self._guides, self._pins_rub)
        )

    def _pin_diameter(self, friction: Friction) -> float | None:
        """Return the diameter of the crank pin in m, by the friction, a yoke or the crankshaft."""
        if isinstance(self._mechanism, ScotchYoke) and self._mechanism.pin_diameter is not None:
            return self._mechanism.pin_diameter
        if friction.crank_pin_diameter is None and self._crankshaft is not None:
            return self._crankshaft.pin_diameter
        return friction.crank_pin_diameter

    @property
    def _pins_rub(self) -> bool:
        """Whether pins or journals rub."""
        return any((self._at_crank, self._at_crosshead, self._at_journals))

    def _piston(self, machine: Machine, number: int) -> PistonProcess:
        """Return a piston with its chambers; number: 0 for the cylinder's own one."""
        piston: Piston = self._cylinder.pistons[number]
        is_absolute = piston.indicator is not None and piston.indicator.absolute
        lift = mpf(0) if is_absolute else self._ambient
        turns = CYCLES[machine.cycle_of_piston(self._cylinder, number)]
        valve = None if number else self._cylinder.valve
        chambers: list[AnyChamber] = []
        for end, card in piston.chambers.items():
            is_head = end == "head_end"
            ratio = piston.lever_ratio
            thickness = mpf(piston.head_end_rod if is_head else piston.crank_end_rod)
            area = mp.pi / 4 * (mpf(piston.bore) ** 2 - thickness**2) * abs(mpf(ratio))
            sign = 1 if is_head == (ratio > 0) else -1
            if card.traced:
                setting = Setting(
                    self._mechanism,
                    cycle=360.0 * turns,
                    head_end=sign > 0,
                    ambient=machine.ambient,
                    absolute=is_absolute,
                    mirrored=not is_head and card is piston.chambers.get("head_end"),
                )
                chambers.append(_traced()(card, setting, self.motion, sign, area))
                continue
            assert isinstance(card, KNOWN_CARDS)
            events = None
            if valve is not None and isinstance(card, Steam):
                shares = np.array([self._share(angle) for angle in events_of(valve, end)])
                events = Fractions(*(shares if is_head else 1 - shares))
            drawing = drawn(card, lift, turns == 2, self._ambient, events)
            modulus = machine.pump.liquid.bulk_modulus if machine.pump else None
            if modulus is not None and len(drawing.lines) == 2:
                clearance = mpf(card.clearance or 0.0)
                drawing = of_liquid(drawing, clearance, mpf(modulus))
            strokes = 1 + max(line.stroke for line in drawing.lines)
            chambers.append(TextbookChamber(drawing, sign, area, strokes))
        work = sum((chamber.work for chamber in chambers), mpf(0))
        return PistonProcess(tuple(chambers), number == 0, work)

    # pieces of the cycle

    def _share(self, phi: Precise) -> Precise:
        """Return the share of the stroke that the output is past its inner dead centre."""
        return (self.motion.at(phi).x - self.motion.start) / self.motion.stroke

    def _corners(self) -> Iterator[Precise]:
        """Yield the angles from the first inner dead centre through one cycle at which a card bends or jumps."""
        yield self.motion.ends[0] + 360 * self.turns
        for stroke in range(2 * self.turns):
            turn, back = divmod(stroke, 2)
            begin = self.motion.ends[back]
            end = self.motion.ends[back + 1]
            yield begin + 360 * turn
            if self._block or self._pins_rub:
                square = 90 + 180 * mp.ceil((begin - 90) / 180)
                yield square + 360 * turn
            for share in self._shares(stroke):
                beyond = np.frompyfunc(lambda phi, _, at=share: self._share(phi) - at, 2, 1)
                (angle,), _ = roots_inside(beyond, np.array([begin]), np.array([end]), STEPS)
                yield angle + 360 * turn

        # angles of samples, and of what bends in the links of a master that rubs
        angles: list[Precise] = []
        for piston in self.pistons:
            for chamber in piston.chambers:
                angles += chamber.corners
        if self._crosshead:
            for link, lag in self._links:
                angles += [edge + lag for edge in link.edges]
        first = self.motion.ends[0]
        for angle in angles:
            for turn in range(self.turns):
                yield first + (angle + 360 * turn - first) % (360 * self.turns)

    def _shares(self, stroke: int) -> set[Precise]:
        """Return the shares of the stroke inside it at which a card bends or jumps."""
        shares: set[Precise] = set()
        for piston in self.pistons:
            for chamber in piston.chambers:
                shares |= chamber.shares(stroke)
        shares |= self._loads_on_output.fractions(is_back=stroke % 2 == 1)
        return shares - {0, 1}

    @cached_property
    def edges(self) -> Array:
        """The crank angles of one cycle between which the forces are smooth, its ends included."""
        edges = merged(np.array(list(self._corners())))
        return self._with_kinks(edges) if self._rubs else edges

    def _with_kinks(self, corners: Array) -> Array:
        """Return the edges with the angles at which friction turns round."""
        edges = [corners]
        count = len(self.at(corners[0], (corners[0] + corners[1]) / 2).kinks)
        for number in range(count):
            kink = np.frompyfunc(
                lambda phi, within, number=number: self.at(phi, within).kinks[number], 2, 1
            )
            turned, _ = roots_inside(kink, corners[:-1], corners[1:], STEPS)
            edges.append(turned)
        return merged(np.concatenate(edges))

    def _piece_of(self, within: Precise) -> tuple[int, list[list[Line]]]:
        """Return the sense of the stroke on a piece, and on which line of its card each chamber is."""
        inner, outer, _ = self.motion.ends
        since = (within - inner) % (360 * self.turns)
        turn = int(since / 360)
        back = since - 360 * turn > outer - inner
        share = self._share(within)
        stroke = 2 * turn + back
        lines = []
        for piston in self.pistons:
            lines.append([chamber.line_at(stroke, share, within) for chamber in piston.chambers])
        return -1 if back and not self.motion.never_returns else 1, lines

    # forces

    def at(self, phi: Precise, within: Precise) -> Forces:
        """Return the forces at a crank angle, computed once for all quantities and equal cylinders."""
        cycle = 360 * self.turns
        angle = phi % cycle
        inside = within % cycle
        key = int(mp.nint(angle * _FINEST)), int(mp.nint(inside * _FINEST))
        state = self._states.get(key)
        if state is None:
            state = self._states[key] = self._forces(angle, inside)
        return state

    def _forces(self, phi: Precise, within: Precise) -> Forces:
        """Return the forces at a crank angle, computed anew."""
        pose = self.motion.at(phi)
        sense, lines = self._piece(within)
        gas = self._gas(phi, pose, lines)
        share = (pose.x - self.motion.start) / self.motion.stroke
        load = self._loads_on_output.at(share, self._share(within), sense)
        driving = gas.driving + load if self._loads_on_output.work > IDLE else gas.driving
        steady = self._rings + self._ring_surface * abs(gas.difference)

        # along the stroke line, without a rod
        push = gas.force + load - sense * steady
        push += self._parts * (self._g[0] - self.omega**2 * pose.curvature)
        if isinstance(self.motion, LinkMotion):
            with_loads = gas._replace(driving=driving)
            return self._on_knuckle(phi, pose, sense, push, with_loads, steady)
        if not isinstance(self.motion, RodMotion):
            M = self.motion.torque_of(push, phi)
            friction = -sense * steady
            kinks = (gas.difference,)
            return Forces(pose.slope, gas.force, driving, friction, {}, M / self.motion.r, M, kinks)

        # on the crank pin
        side = mp.sign(mp.cospi(within / 180))
        if self._mechanism.has_rod:
            loads, losses, on_crank = self._on_rod(phi, within, pose, sense, push, side)
        else:
            loads, losses, on_crank = self._on_yoke(phi, sense, push, side)
        T_pin = loads.Z[0] * mp.sinpi(phi / 180) + loads.Z[1] * mp.cospi(phi / 180)
        M = T_pin * self.motion.r - on_crank
        T = M / self.motion.r
        friction = -sense * (loads.drag + steady)
        kinks = (*loads.kinks, gas.difference)
        return Forces(pose.slope, gas.force, driving, friction, losses, T, M, kinks)

    def _gas(self, phi: Precise, pose: Stance, lines: list[list[Line]]) -> GasForces:
        """Return the forces of the gas on all pistons."""
        force = driving = difference = mpf(0)
        if not self.pistons:
            return GasForces(force, driving, difference)
        share = (pose.x - self.motion.start) / self.motion.stroke
        for piston, its_lines in zip(self.pistons, lines):
            on_piston = mpf(0)
            for chamber, line in zip(piston.chambers, its_lines):
                above = chamber.pressure(line, share, phi) - self._ambient
                on_piston += chamber.sign * chamber.area * above
                if piston.is_own:
                    difference += chamber.sign * above
            force += on_piston
            if piston.work > IDLE:
                driving += on_piston
        return GasForces(force, driving, difference)

    def _on_knuckle(
        self,
        phi: Precise,
        pose: Stance,
        sense: int,
        push: Precise,
        gas: GasForces,
        steady: Precise,
    ) -> Forces:
        """Return the forces of a cylinder with a link rod: what reaches the crank pin through its master rod.

        Q = Z − m_k ω² z″          on the knuckle pin, at a from the crank pin
        a × Q + L × n = 0          n: side force on the master's piston pin, square to its stroke line
        M = R × (Q + n)
        """
        assert isinstance(self.motion, LinkMotion)
        loads = self._loads(pose, Jet(mpf(0)), sense, push, mpf(0))
        knuckle = self.motion.knuckle_at(phi)
        force = mp.mpc(-loads.Z[0], loads.Z[1])
        force -= self._knuckle_mass * self.omega**2 * knuckle.place.bend
        on_master = moment(knuckle.arm, force)
        side_force = -on_master / moment(knuckle.rod, knuckle.across) * knuckle.across
        M = moment(knuckle.pin, force + side_force)
        friction = -sense * (loads.drag + steady)
        kinks = (*loads.kinks, gas.difference)
        of_gas = (pose.slope, gas.force, gas.driving)
        return Forces(*of_gas, friction, {}, M / self.motion.r, M, kinks, on_master)

    def _on_rod(
        self,
        phi: Precise,
        within: Precise,
        pose: Stance,
        sense: int,
        push: Precise,
        side: Precise,
    ) -> tuple[PinLoads, dict[str, Precise], Precise]:
        """Return the loads on the pins of a rod, the losses there, and what the shaft loses; side: sign of cos φ."""
        swing = self._swing(phi, pose)
        if self._links:
            return self._on_master_rod(phi, within, pose, sense, push), {}, mpf(0)
        loads = self._loads(pose, swing, sense, push, mpf(0))
        if not self._pins_rub:
            return loads, {}, mpf(0)

        # the loads of the pins, the crank pin's with what turns with it
        outward = self._rod.pin_mass * self.motion.r * self.omega**2
        x = loads.Z[0] - outward * mp.cospi(phi / 180)
        y = loads.Z[1] + outward * mp.sinpi(phi / 180)
        Z = mp.hypot(x, y)
        H = mp.hypot(*loads.H)
        crank = self._at_crank * Z
        crosshead = self._at_crosshead * H
        journals = self._at_journals * Z
        losses = {
            "crank_pin": crank * (1 + swing.rate),
            "crosshead_pin": crosshead * side * swing.rate,
            "journals": journals,
        }
        rubbed = self._loads(pose, swing, sense, push, crank + side * crosshead)
        kinks = (*loads.kinks, *rubbed.kinks)
        return rubbed._replace(kinks=kinks), losses, crank + journals

    def _on_master_rod(
        self, phi: Precise, within: Precise, pose: Stance, sense: int, push: Precise
    ) -> PinLoads:
        """Return the loads on the pins of a master rod, on the crank pin without those of its links."""
        couple = mpf(0)
        for link, lag in self._links:
            couple += link.at(phi - lag, within - lag).on_master
        loads = self._loads(pose, self._swing(phi, pose), sense, push, couple)
        side_force = couple / (mpf(self._mechanism.rod_length) * pose.cos_psi)
        return loads._replace(Z=(loads.Z[0], loads.Z[1] + side_force))

    def _swing(self, phi: Precise, pose: Stance) -> Jet:
        """Return the angle of the rod with its derivatives, from L sin ψ = R sin φ − e."""
        ratio = self.motion.r / mpf(self._mechanism.rod_length)
        rate = ratio * mp.cospi(phi / 180) / pose.cos_psi
        bend = (pose.sin_psi * rate**2 - ratio * mp.sinpi(phi / 180)) / pose.cos_psi
        return Jet(mp.asin(pose.sin_psi), rate, bend)

    def _loads(
        self, pose: Stance, swing: Jet, sense: int, push: Precise, couple: Precise
    ) -> PinLoads:
        """Return N and the forces on the pins of a rod; couple: by friction or by links, in the sense of rotation."""
        sin = pose.sin_psi
        cos = pose.cos_psi
        length = mpf(self._mechanism.rod_length)
        rod = self._rod
        omega = self.omega

        # weight and inertia of the rod
        upward = cos * swing.bend - sin * swing.rate**2
        forward = -sin * swing.bend - cos * swing.rate**2
        x = rod.mass * (self._g[0] - omega**2 * (pose.curvature + rod.gravity_center * forward))
        y = rod.mass * (self._g[1] - omega**2 * rod.gravity_center * upward)

        # moments about the crank pin, over L
        tilt = -(1 - rod.gravity_center / length) * (cos * y - sin * x)
        turning = (couple + rod.inertia * omega**2 * swing.bend) / length
        weight = -self._parts * self._g[1]
        lift = push * sin + weight * cos + tilt - turning
        N = lift / (cos + sense * mp.sign(lift) * self._crosshead * sin)
        drag = self._crosshead * abs(N)
        H = push - sense * drag, N - weight
        return PinLoads(drag, H, (H[0] + x, H[1] + y), (lift,))

    def _on_yoke(
        self, phi: Precise, sense: int, push: Precise, side: Precise
    ) -> tuple[PinLoads, dict[str, Precise], Precise]:
        """Return the loads of a yoke on the crank pin, the losses of its block and of the pin, and the shaft's."""
        rise = self.motion.r * mp.sinpi(phi / 180)
        drag = 2 * self._guides * abs(push * rise)
        along = push - sense * drag
        block = self._block * abs(along)
        Z = along, -side * block
        on_pin = mp.hypot(*Z)
        crank = self._at_crank * on_pin
        journals = self._at_journals * on_pin
        slides = self.motion.r * abs(mp.cospi(phi / 180))
        losses = {"block": block * slides, "crank_pin": crank, "journals": journals}
        return PinLoads(drag, (along, mpf(0)), Z, (push, along)), losses, crank + journals

    def inertia(self, phi: Precise) -> Precise:
        """Return the inertia in kg m² that has the kinetic energy of all moving masses."""
        pose = self.motion.at(phi)
        masses = self._cylinder.masses
        inertia = self._parts * pose.slope**2
        if masses is None:
            return inertia
        if isinstance(self.motion, LinkMotion):
            speed = self.motion.knuckle_at(phi).place.rate
            inertia += self._rod.mass * pose.slope**2 + self._knuckle_mass * abs(speed) ** 2
            return inertia + mpf(masses.rotating) * self.motion.r**2
        if not isinstance(self.motion, RodMotion):
            return inertia
        inertia += (mpf(masses.rotating) + self._rod.pin_mass) * self.motion.r**2
        swing = self._swing(phi, pose)
        x = pose.slope - self._rod.gravity_center * pose.sin_psi * swing.rate
        y = self._rod.gravity_center * pose.cos_psi * swing.rate
        return inertia + self._rod.mass * (x**2 + y**2) + self._rod.inertia * swing.rate**2

    @property
    def is_driven(self) -> bool:
        """Whether a piston is driven, or the output works against its loads."""
        is_moved = self._loads_on_output.work < -IDLE
        return bool(is_moved) or any(piston.work < -IDLE for piston in self.pistons)

    @property
    def drives(self) -> bool:
        """Whether a piston drives, or the loads on the output."""
        is_driving = self._loads_on_output.work > IDLE
        return bool(is_driving) or any(piston.work > IDLE for piston in self.pistons)


def _radius(coefficient: float | None, diameter: float | None) -> Precise:
    """Return the radius of a circle of friction in m, f d/2; 0 where nothing rubs."""
    return mpf(coefficient or 0.0) * mpf(diameter or 0.0) / 2


def _traced() -> type[TracedChamber]:
    from kurbel.accuracy.traced import TracedChamber

    return TracedChamber
