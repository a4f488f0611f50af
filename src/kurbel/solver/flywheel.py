"""Flywheel of the whole machine: key values and columns of `kurbel flywheel`, of one machine or of many.

    ΔE = E_max − E_min              fluctuation of the excess work E of torque over load (R p. 612)
    J_δ = ΔE/(δ ω²)                 flywheel required for the coefficient of speed fluctuation δ, by the textbook
    GD² = 4 J                       flywheel effect as mass times diameter squared
    A_K = 4 J/(π ρ D (D² + h²))     section of a rim of height h and mean diameter D that has J

The textbook formula takes the moment of inertia as constant and the load as independent of the speed. The speed line
(`kurbel.solver.speed`, with an elastic coupling `kurbel.solver.chapters.coupling`) assumes neither.
"""

from __future__ import annotations

import math
from functools import cache, cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from kurbel.arrays import Array, Indices, Number
from kurbel.declared.unit_systems import show
from kurbel.errors import NoSolutionError, UsageError
from kurbel.numerics.arithmetic import every, some, where
from kurbel.numerics.collocation import Unsettled
from kurbel.numerics.extreme import Extremes
from kurbel.numerics.pieces import Pieces, refined
from kurbel.quantity import Computed, Heading, key_value, value
from kurbel.solver.cycle import Where, where_is
from kurbel.solver.effort import TurningEffort
from kurbel.solver.figures import AtAngles, ExtremesOfColumns, Results, part
from kurbel.solver.piston_works import Brake
from kurbel.solver.speed import RigidLine, SpeedLaw, SpeedLine, SwingLine
from kurbel.solver.total_work import TotalWork

if TYPE_CHECKING:
    from kurbel.solver.chapters.coupling import CouplingTorque, ElasticCoupling


RIGID_ABOVE = 100.0
"""Natural order above which a coupling counts as rigid: it amplifies the order ν by (ν/n_e)², 1 in 10⁴ for the first."""
_MISSED = 1e-3
"""Relative deviation from the required δ above which there is a warning."""
_LARGEST_EXPONENT = 709.7
"""exp of it is just below the largest float."""


_DOUBLINGS, _TRIALS = 30, 20
"""Largest numbers of doublings in the search for a flywheel that turns, and of secant steps for one with a given δ."""
_CLOSE = 1e-13
"""Relative tolerance of δ in the search for the flywheel that gives it."""
_IDLE = 0.01
"""Share of what δ misses: a step of the search that gains less gains nothing."""


def _coupling_torque() -> type[CouplingTorque]:
    from kurbel.solver.chapters.coupling import CouplingTorque

    return CouplingTorque


def _elastic_coupling() -> type[ElasticCoupling]:
    from kurbel.solver.chapters.coupling import ElasticCoupling

    return ElasticCoupling


def _over_the_angle(
    id: str, symbol: str, kind: str, text: str, **words: Any
) -> Computed[Array | None]:
    """Return a column whose samples are those of `MachineTurning.samples_of`."""
    return value(symbol, kind, text, lambda state: state.course(id), **words)


class TurningState(AtAngles):
    """Columns of the whole machine at crank angles φ (n,) in degrees; at a jump, on the side of the angles `within`."""

    commands = ("flywheel",)
    T = _over_the_angle(
        "T",
        "T",
        "force",
        "Tangential force at the crank pin, positive when it drives",
        called="tangential force",
        peak=True,
        extremes=("flywheel",),
    )
    T_inertia = _over_the_angle(
        "T_inertia",
        "T_b",
        "force",
        "Part of T due to the inertia forces, at uniform rotation (Tolle)",
    )
    M = _over_the_angle(
        "M", "M", "torque", "Torque on the shaft", called="torque", extremes=("flywheel",)
    )
    E = _over_the_angle(
        "E", "E", "energy", "Excess work: work of M minus work of the resistance since angle 0"
    )
    omega = _over_the_angle("omega", "ω", "angular_velocity", "Angular velocity of the shaft")
    alpha = _over_the_angle(
        "alpha",
        "α",
        "angular_acceleration",
        "Angular acceleration of the shaft; at a jump, the value after it",
        called="angular acceleration of the shaft",
        extremes=("flywheel",),
    )
    M_coupling = _over_the_angle("M_coupling", "M_K", "torque", "Torque in the elastic coupling")

    def __init__(
        self, turning: MachineTurning, phi: Array, within: Array, machine: Indices | None = None
    ) -> None:
        """Take the results, the angles, and the machine of each (n,), where there are many."""
        self._turning, self.phi, self.within, self._machine = turning, phi, within, machine

    def __getitem__(self, id: str) -> Array | None:
        """Return a column by its id, or the load `M_load` in N m at the nominal speed; None for another name."""
        if id == "M_load":
            return self.course(id)
        return super().__getitem__(id)

    def course(self, id: str) -> Array | None:
        """Return a quantity of `MachineTurning.samples_of` at the angles, (n,); None for what is left out."""
        samples = self._turning.samples_of(id)
        if samples is None:
            return None
        pieces, values = samples
        return self._turning.effort.at(pieces, values, self.phi, self.within, self._machine)


class MachineTurning(Results):
    """Key values of torque, flywheel and speed of the whole machine; `at(degrees)` gives the columns.

    Attributes are named by the ids of the key values, in SI; None where the machine does not have one. Forces T are
    referred to the radius of crank 1. Key values of many machines are arrays (machines,), nan where a machine has none.
    has_speed: a speed is given that is not 0. Raises UsageError where no torque acts, NoSolutionError where the machine
    cannot run.
    """

    command, state = "flywheel", TurningState

    def __init__(self, effort: TurningEffort) -> None:
        self.effort, self.machine, self.excess = effort, effort.machine, effort.excess
        self.omega = effort.omega
        self.has_speed = effort.omega is not None and some(effort.omega != 0)
        cylinders = self.machine.cylinders
        self.crank = cylinders[0].mechanism.crank if cylinders else None
        self._extremes: dict[str, Extremes | None] = {}
        wheel = self.machine.flywheel
        self._given = wheel.inertia if wheel else None
        self._wanted = wheel.fluctuation if wheel else None
        self.rim = wheel.rim if wheel else None
        self.law = SpeedLaw.of(effort)
        if effort.count is not None:
            _ = self.natural_order  # refuses machines of a batch before any result is read

    # over the crank angle

    def _columns(self, phi: Array, within: Array) -> TurningState:
        return self.state(self, phi, within)

    def samples_of(self, column: str) -> tuple[Pieces, Array] | None:
        """Return a column at the nodes of pieces; None for one that is left out."""
        effort = self.effort
        if effort.swing is not None:
            return None
        match column:
            case "M":
                return effort.pieces, effort.M
            case "T":
                return self._at_crank(effort.M)
            case "T_inertia":
                if not effort.inertia_terms:
                    return None
                return self._at_crank(effort.sampled(effort.inertia_terms))
            case "E":
                return effort.pieces, self.excess.E
            case "M_load":
                return effort.pieces, effort.load
            case "omega":
                if self.speed is None:
                    return None
                return self.speed.omega
            case "alpha":
                if self.speed is None:
                    return None
                return self.speed.alpha
            case "M_coupling":
                if self.coupled is None:
                    return None
                return self.coupled.torque
        return self._from_others(column)

    def _at_crank(self, torque: Array) -> tuple[Pieces, Array] | None:
        """Return the force of a torque at the radius of crank 1; None without a crank."""
        pieces = self.effort.pieces
        if self.crank is None:
            return None
        return (pieces, torque / pieces.of(self.crank))

    def _from_others(self, column: str) -> tuple[Pieces, Array] | None:
        """Return a column that is computed from other columns, on pieces halved until it is a polynomial."""
        row = self.rows.columns.get(column)
        start = np.zeros(1)
        if row is None or row.of(self.state(self, start, start)) is None:
            return None

        def sample(pieces: Pieces) -> Array:
            shape = pieces.degrees.shape
            machine = np.tile(pieces.machine, len(pieces.degrees))
            within = np.broadcast_to(pieces.middle, shape).ravel()
            state = self.state(self, pieces.degrees.ravel(), within, machine)
            return row.of(state).reshape(1, *shape)

        coarse = self.effort.pieces if self.speed is None else self.speed.pieces
        pieces, (values,) = refined(coarse, sample)
        return pieces, values

    @property
    def breaks(self) -> Array:
        """Crank angles in degrees of the only machine between which every quantity is smooth."""
        return self.effort.pieces.ends

    def angles_where(self, column: str, value: float) -> Where | None:
        """Return where in the cycle a column has a value in SI; None for a column that is left out."""
        samples = self.samples_of(column)
        if samples is None:
            return None
        return where_is(*samples, value)

    def extremes_of(self, column: str) -> Extremes | None:
        """Return the extremes in SI of a column that is declared to have them; None for one that is left out."""
        if column not in self._extremes:
            samples = self.samples_of(column)
            result = self.speed.result if column == "alpha" and self.speed else self.effort.result
            extremes = None
            if samples is not None:
                pieces, values = samples
                extremes = pieces.extremes(values[None]).each(result)[0]
            self._extremes[column] = extremes
        return self._extremes[column]

    # turning effort

    _turning = Heading("Turning effort")

    @part(Brake)
    def brake(self) -> Brake:
        """Key values of the brake."""
        return Brake(self.machine, self.effort.cylinders)

    W = value(
        "W",
        "force",
        "Mean tangential force over the cycle: the resistance",
        lambda turning: None if turning.crank is None else turning.M_mean / turning.crank,
    )
    M_mean = value(
        "M_m",
        "torque",
        "Mean torque of the turning effort, equal to the resistance",
        lambda turning: turning.effort.result(turning.effort.mean) if turning.knows_mean else None,
    )
    work_shaft = value(
        "A",
        "energy",
        "Work of the turning effort per cycle",
        lambda turning: (
            turning.M_mean * math.radians(turning.effort.cycle) if turning.knows_mean else None
        ),
    )
    power_shaft = value(
        "N_e",
        "power",
        "Power at the shaft, mean torque times nominal angular velocity",
        lambda turning: (
            turning.M_mean * turning.omega if turning.has_speed and turning.knows_mean else None
        ),
    )

    @part(TotalWork)
    def total_work(self) -> TotalWork:
        """Work of all pistons, and the mechanical efficiency."""
        effort = self.effort
        return TotalWork(self.machine, effort.cylinders, lambda: effort.result(effort.mean))

    _searched = ExtremesOfColumns()

    @property
    def knows_mean(self) -> bool:
        """Whether the mean torque is known: of an effort given by its fluctuation of energy alone it is not."""
        return (
            not (self.machine.effort and self.machine.effort.alone)
            or self.machine.effort.mean is not None
        )

    @property
    def deficit(self) -> Any:
        """Mean torque less the mean of a load torque given by points, in N m; None where they agree."""
        deficit = self.effort.deficit
        if not deficit.any():
            return None
        return self.effort.result(np.where(deficit == 0, np.nan, deficit))

    # excess work

    _excess = Heading("Excess work")
    phi_crossing = value(
        "φ_T=W",
        "angle",
        "Crank angles at which the effort crosses the resistance",
        lambda turning: turning.of_crossings(turning.excess.crossings.degrees),
        listed=True,
    )
    lobes = value(
        "A_1, A_2, …",
        "energy",
        "Excess work of each lobe, from crossing to crossing",
        lambda turning: turning.of_crossings(turning.excess.lobes),
        plain="A_1, ...",
        listed=True,
    )
    E_max = value(
        "E_max",
        "energy",
        "Largest excess work since angle 0",
        lambda turning: turning.summits and turning.summits.largest,
    )
    E_min = value(
        "E_min",
        "energy",
        "Smallest excess work since angle 0",
        lambda turning: turning.summits and turning.summits.smallest,
    )
    dE = value(
        "ΔE",
        "energy",
        "Fluctuation of energy: largest minus smallest excess work",
        lambda turning: turning.effort.result(turning.excess.dE),
    )

    @key_value("ΔE/A", "ratio")
    def energy_fluctuation(self) -> Number | None:
        """Coefficient of fluctuation of energy.

        None where no work is done, nan for such a machine of many.
        """
        work = self.work_shaft if self.knows_mean else 0.0
        if not some(work > 0):
            return None
        return self.dE / where(work > 0, work, math.nan)

    def of_crossings(self, values: Array) -> Any:
        """Return one value per crossing of torque and load as a tuple, or a tuple per machine; None where not known."""
        if self.effort.swing is not None:
            return None
        return self.excess.crossings._replace(degrees=values).listed(self.effort.count)

    @cached_property
    def summits(self) -> Extremes | None:
        """Largest and smallest excess work with their angles; None where the only machine has none."""
        if not self.excess.torque.any():
            return None
        return self.excess.summits.each(self.effort.result)[0]

    # flywheel

    _flywheel = Heading("Flywheel")
    J = value(
        "J",
        "inertia",
        "Moment of inertia of the flywheel: as given, else as required for the given δ",
        lambda turning: turning.J_needed if turning._given is None else turning._given,
    )
    GD2 = value(
        "GD²",
        "gd2",
        "Flywheel effect GD² = 4J, mass times diameter squared; in kgf m² the same number",
        lambda turning: None if turning.J is None else 4 * turning.J,
        plain="GD2",
    )
    J_needed = value(
        "J_δ",
        "inertia",
        "Moment of inertia required for δ, ΔE/(δ ω²)",
        lambda turning: turning.textbook_inertia(),
        unless=lambda turning: turning.is_the_needed,
    )
    GD2_needed = value(
        "GD²_δ",
        "gd2",
        "The same as flywheel effect GD² = 4J_δ",
        lambda turning: None if turning.J_needed is None else 4 * turning.J_needed,
        plain="GD2_delta",
        unless=lambda turning: turning.is_the_needed,
    )

    @key_value("A_K", "area")
    def rim_section(self) -> Number | None:
        """Cross-section of the rim required for δ, or for J: 4 J/(π ρ D (D² + h²))."""
        inertia = self.J if self.J_needed is None else self.J_needed
        if self.rim is None or inertia is None:
            return None
        return self.rim.section(inertia)

    rim_speed = value(
        "v_K",
        "velocity",
        "Rim speed at the mean diameter",
        lambda turning: (
            turning.rim.speed(turning.omega) if turning.rim and turning.has_speed else None
        ),
    )
    rim_stress = value(
        "σ_K",
        "stress",
        "Hoop stress of the rim, ρ v²",
        lambda turning: (
            turning.rim.stress(turning.omega) if turning.rim and turning.has_speed else None
        ),
    )

    @property
    def is_the_needed(self) -> bool:
        """Whether J is J_δ: no other moment of inertia is given."""
        if self._given is None:
            return True
        return self.J_needed is not None and every(self.J_needed == self._given)

    def textbook_inertia(self) -> Number | None:
        """Return ΔE/(δ ω²) in kg m², less the inertia beyond a rigid coupling; None without a required δ or a speed."""
        if self._wanted is None or not self.has_speed:
            return None
        needed = self.excess.dE / (self._wanted * self.omega**2)
        return self.effort.result(np.maximum(needed - self._driven_inertia, 0.0))

    @property
    def _driven_inertia(self) -> Number:
        """Inertia beyond a rigid coupling in kg m², which turns with the flywheel; 0 without one."""
        coupling = self.machine.coupling
        return coupling.inertia if coupling and self.rigid else 0.0

    # speed line

    _speed = Heading("Speed")

    @part(SpeedLine)
    def speed(self) -> SpeedLine | None:
        """Speed of the crankshaft over the cycle; None without a flywheel or a speed.

        Raises NoSolutionError where the machine stalls.
        """
        if self.J is None or not self.has_speed:
            return None
        try:
            return self._line(1.0 if self._needs_no_inertia else self.J)
        except Unsettled as stop:
            raise self._stalled(self.J, stop) from None

    @key_value("δ_0", "ratio", after="delta")
    def delta_book(self) -> Number | None:
        """The same by the textbook formula, ΔE/(J ω²)."""
        inertia = (0.0 if self.J is None else self.J) + self._driven_inertia
        if not self.has_speed or not some(inertia != 0):
            return None
        return self.dE / (where(inertia == 0, math.nan, inertia) * self.omega**2)

    @key_value("μ", "ratio")
    def multiplier(self) -> Number | None:
        """Floquet multiplier: part of a disturbance that remains after one cycle; stable below 1.

        μ = exp(−∮ ∂M_load/∂ω/(J ω) dφ), or the largest float; None where the load does not depend on the speed.
        """
        if self.law is None or not self.speed:
            return None
        multiplier = np.exp(np.minimum(self.speed.growth, _LARGEST_EXPONENT))
        if self.effort.count is not None:
            return multiplier
        return float(multiplier)

    @property
    def load_ignored(self) -> bool:
        """Whether a load that depends on the speed has no effect, being proportional to a mean torque of zero."""
        load = self.machine.load
        return load is not None and (load.slip is not None or bool(load.power)) and self.law is None

    @property
    def _needs_no_inertia(self) -> bool:
        """Whether the torque is uniform, so that the required δ needs no flywheel: the speed is then constant."""
        uniform = not self.effort.inertia_terms and not self.excess.dE.any()
        return self._wanted is not None and uniform and not some(self.J != 0)

    def _line(self, flywheel: Number) -> SpeedLine:
        """Return the speed line with a flywheel in kg m²; raises Unsettled, NoSolutionError, UsageError."""
        coupling, effort = self.machine.coupling, self.effort
        if effort.swing is not None:
            return SwingLine(effort, self.excess.dE, flywheel)
        if coupling and not self._needs_no_inertia:
            from kurbel.solver.chapters.coupling import ElasticCoupling, natural_order

            ahead = np.asarray(flywheel + effort.pieces.mean(effort.J_moving))
            if effort.count is None and not ahead[0]:
                raise UsageError(
                    "nothing ahead of the coupling has inertia: give 'flywheel' an inertia"
                )
            if some(natural_order(coupling, ahead, self.omega) <= RIGID_ABOVE):
                return ElasticCoupling(effort, ahead, self.law)
        turning = np.asarray(flywheel + (coupling.inertia if coupling else 0.0), dtype=float)
        return RigidLine(effort, self.law, np.broadcast_to(turning, effort.mean.shape))

    def _delta_with(self, flywheel: float) -> float:
        """Return δ of the speed line with a flywheel in kg m²; inf where the machine stalls."""
        try:
            return float(self._line(flywheel).delta)
        except (Unsettled, NoSolutionError, UsageError):
            return math.inf

    def _stalled(self, flywheel: float, stop: Unsettled) -> NoSolutionError:
        """Return a message: at which angle the machine stalls, and the smallest flywheel found with which it runs."""
        is_elastic = self.natural_order is not None and not self.rigid
        with_this = f"with J = {show(flywheel, 'inertia')}"
        if is_elastic:
            with_this += " and the elastic coupling"
        message = f"{with_this} no periodic motion is found under this load"
        if stop.degrees is not None:
            message = f"the machine stops near φ = {stop.degrees:.0f}°: {with_this} its kinetic energy is used up"

        def remedy() -> str:
            enough = self._enough(flywheel, stop.enough)
            if enough is None:
                return "; no flywheel is found with which it runs: check effort, load and speed"
            inertia, gd2 = show(enough, "inertia"), show(4 * enough, "gd2")
            return f"; it runs with a flywheel from J = {inertia} (GD2 = {gd2}) upward"

        return NoSolutionError(message, cache(remedy))

    def _enough(self, flywheel: float, more: float | None) -> float | None:
        """Return the smallest flywheel in kg m² with which the machine runs, to 2 %, in three digits; None without any.

        flywheel: one with which it stalls; more: additional kinetic energy in J that is just enough, if known.
        """

        def rounded_up(inertia: float) -> float:
            digit = 10.0 ** (math.floor(math.log10(inertia)) - 2)
            return math.ceil(inertia / digit) * digit

        moving = float(self.effort.pieces.mean(self.effort.J_moving)[0])
        least = max(flywheel, 1e-6 * moving, 1e-300)
        if more:
            enough = flywheel + 2 * more / self.omega**2
        else:
            enough = least + self.dE / self.omega**2
        for _ in range(_DOUBLINGS):
            if math.isfinite(self._delta_with(rounded_up(enough))):
                break
            least, enough = enough, 2 * enough
        else:
            return None
        while not more and enough > 1.02 * max(least, enough / 1000):
            middle = math.sqrt(max(least, enough / 4) * enough)
            if math.isfinite(self._delta_with(rounded_up(middle))):
                enough = middle
            else:
                least = middle
        return rounded_up(enough)

    # coupling

    @key_value("n_e", "ratio")
    def natural_order(self) -> Number | None:
        """Natural frequency of the coupled masses, relative to the angular velocity."""
        coupling = self.machine.coupling
        has_inertia = self._given is not None or self._wanted is not None
        if coupling is None or not self.has_speed or not has_inertia:
            return None
        flywheel = self._given
        if flywheel is None:
            flywheel = self.excess.dE / (self._wanted * self.omega**2)
        ahead = np.asarray(flywheel + self.effort.pieces.mean(self.effort.J_moving))
        if not every(ahead != 0):
            return None
        from kurbel.solver.chapters.coupling import natural_order

        order = natural_order(coupling, ahead, self.omega)
        if not every(order > RIGID_ABOVE):  # in a batch machines with a rigid coupling are left out
            self.effort.refused |= order > RIGID_ABOVE
        return self.effort.result(order)

    @property
    def rigid(self) -> bool:
        """Whether the coupling counts as rigid, n_e > 100; of many machines, whether all do."""
        return self.natural_order is not None and not some(self.natural_order <= RIGID_ABOVE)

    @part(_coupling_torque, there=lambda turning: turning.machine.coupling is not None)
    def coupled(self) -> CouplingTorque | None:
        """The torque in the coupling; None without one, and without a speed line.

        Raises NoSolutionError where no periodic motion is found.
        """
        coupling, line = self.machine.coupling, self.speed
        if coupling and self.rigid and isinstance(line, RigidLine):
            from kurbel.solver.chapters.coupling import StiffCoupling

            return StiffCoupling(line, coupling.inertia)
        return self.elastic

    @part(_elastic_coupling, there=lambda turning: turning.machine.coupling is not None)
    def elastic(self) -> ElasticCoupling | None:
        """The elastic coupling; None for a rigid one, and without a speed line.

        Raises NoSolutionError where no periodic motion is found.
        """
        if self.machine.coupling is None or self.rigid:
            return None
        if not isinstance(self.speed, _elastic_coupling()):
            return None
        return self.speed

    # the required δ, compared with the speed line

    @cached_property
    def delta_needed(self) -> Any:
        """δ of the speed line with the flywheel J_δ; None where the machine stalls with it."""
        if self.J_needed is None or not self.has_speed or self._needs_no_inertia:
            return None
        if self.is_the_needed:
            return self.speed and self.speed.delta
        if self.effort.count is not None:
            return self._line(self.J_needed).delta
        delta = self._delta_with(self.J_needed)
        return delta if math.isfinite(delta) else None

    @property
    def misses_wanted_delta(self) -> bool:
        """Whether δ with the flywheel J_δ differs noticeably from the required one; of many machines, for any."""
        if self._wanted is None or self.delta_needed is None:
            return False
        missed_by = abs(self.delta_needed / self._wanted - 1)
        return some((self.delta_needed != 0) & (missed_by > _MISSED))

    @key_value("J_δ,ω", "inertia", after="rim_stress", heading="Flywheel")
    def J_exact(self) -> Any:
        """Moment of inertia with which the computed speed has the required δ.

        None where J_δ has it, and where none is found; nan for many machines, as each would need a search of its own.
        """
        if not self.misses_wanted_delta or self._wanted is None or not some(self.J_needed != 0):
            return None
        if self.effort.count is not None:
            return np.full(self.effort.count, np.nan)
        # secant method: required δ/δ − 1 is nearly J/J_δ − 1
        inertia = self.J_needed
        missed = self._wanted / self.delta_needed - 1
        slope = 1 / inertia
        for _ in range(_TRIALS):
            tried = min(max(inertia - missed / slope, inertia / 4), 4 * inertia)
            delta = self._delta_with(tried)
            left = self._wanted / delta - 1 if delta else math.inf
            if tried == inertia or not math.isfinite(left):
                return None
            # where the load alone holds the speed of a rigid shaft, a quarter of the flywheel changes next to nothing
            is_bound = tried in (inertia / 4, 4 * inertia)
            changes_nothing = abs(left - missed) < _IDLE * abs(left)
            if is_bound and changes_nothing and self.machine.coupling is None:
                return None
            rise = (left - missed) / (tried - inertia)
            slope = rise if rise > 0 else 1 / tried
            is_close = abs(left * missed) <= _CLOSE
            inertia, missed = tried, left
            if is_close:
                return inertia - missed / slope
        return None
