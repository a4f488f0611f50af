"""The pictures of a measured trace: its cycles over the crank angle, and its lines of compression and expansion."""

import math
from collections.abc import Iterator, Sequence

import numpy as np

from kurbel.arrays import Array
from kurbel.pictures.heat import after_dead_centre, at_dead_centres
from kurbel.pictures.picture import Axis, Curve, Mark, PageFigure, Panel, Words
from kurbel.pictures.picture_source import NO_NAME, telling
from kurbel.solver.gas import PistonGas
from kurbel.traces.correct import Exponent
from kurbel.traces.pressure import TracePressure
from kurbel.traces.reading import TraceReading

_MOST_CYCLES = 60
"""Cycles that are drawn at most, evenly chosen: more are one grey area."""
_STRETCHES = 1000
"""Stretches of a line that are drawn with their lowest and highest points, at most."""
_STRETCHES_OF_ALL = 7000
"""The same of all cycles together."""
_OF_PEAK = 1e-3
"""Share of the peak below which an absolute pressure is noise, which has no logarithm."""


class TracedEnd:
    """One end of a piston with its measured trace; area: in m²; title: which of several it is, else nothing.

    after: degrees (n,) after the chamber's own (firing) dead centre, in order over a cycle, both its ends included;
    cycles: pressures (m, n) in Pa there of every cycle, gauge or absolute as in the file; p (n,): their mean.
    """

    def __init__(self, pressure: TracePressure, area: float, title: str) -> None:
        self.pressure = pressure
        self.setting = pressure.setting
        self.area = area
        self.title = title

        # the closing sample is the first one again; the cycle begins half a cycle before its dead centre
        after = pressure.trace.from_dead_centre(self.setting)[:-1]
        order = np.argsort(after, kind="stable")
        closed = np.append(order, order[0])
        self.after: Array = after[closed]
        self.after[-1] += self.setting.cycle
        self.cycles: Array = pressure.each[:, closed]
        self.p: Array = pressure.pressures[closed]

    # over the crank angle

    def over_angle(self) -> Panel:
        """Return the panel of the pressure over the crank angle."""
        rows = telling(self.p[np.newaxis], _STRETCHES)
        mean = Curve(Words("p"), self.after[rows], self.p[rows])
        curves = [*at_dead_centres(self.setting, self.after, self.cycles), mean]
        title = self.title
        count = len(self.cycles)
        if count > 1:
            drawn = min(count, _MOST_CYCLES)
            curves.insert(0, self._every_cycle(drawn))
            shown = f"{drawn} of {count} cycles" if drawn < count else f"{count} cycles"
            title = f"{title}, {shown}" if title else shown
        words = "absolute pressure" if self.setting.absolute else "pressure"
        up = Axis(Words("p", words=words), "pressure")
        top = int(np.argmax(self.p))
        highest = PageFigure(Words("p_max"), float(self.p[top]), at_deg=float(self.after[top]))
        marks = (Mark(float(self.after[top]), float(self.p[top]), highest),)
        return Panel(after_dead_centre(self.setting), up, tuple(curves), marks=marks, title=title)

    def _every_cycle(self, count: int) -> Curve:
        """Return so many of the cycles as one curve, with gaps between them."""
        stretches = _STRETCHES_OF_ALL // count
        numbers = np.linspace(0, len(self.cycles) - 1, count).round().astype(int)
        gap = np.full(2, np.nan)
        across: list[Array] = []
        up: list[Array] = []
        for number in numbers.tolist():
            pressures = self.cycles[number]
            rows = telling(pressures[np.newaxis], stretches)
            across += [gap, self.after[rows]]
            up += [gap, pressures[rows]]
        return Curve(NO_NAME, np.concatenate(across[1:]), np.concatenate(up[1:]), "cycles")

    # over the volume

    def logarithmic(self, role: str | None) -> Panel | None:
        """Return the panel of pressure over volume by powers of ten; None where the volume is not known."""
        clearance = self.pressure.trace.clearance
        if not clearance:
            return None
        # what is not above the vacuum has no logarithm
        absolute = self.p + self.setting.lift
        peak = float(absolute.max())
        is_pressure = absolute > _OF_PEAK * peak
        if np.count_nonzero(is_pressure) < 2:
            return None
        pressures = absolute[is_pressure]
        volumes = self.setting.stroke_fraction(self.after[is_pressure]) + clearance
        stroke_volume = self.area * self.setting.mechanism.stroke
        rows = telling(pressures[np.newaxis], _STRETCHES)
        curves = [Curve(Words("p"), volumes[rows] * stroke_volume, pressures[rows])]

        # both lines, as far as there are pressures like theirs
        marks = []
        reading = TraceReading(self.pressure.trace, self.setting, self.pressure.each, role)
        least = float(pressures.min())
        for name, line in zip(("n_c", "n_d"), reading.stroke_lines()):
            if line is None:
                continue
            ends = _line_between(line, (clearance, 1 + clearance), (least, peak))
            curves.append(Curve(NO_NAME, ends[0] * stroke_volume, ends[1], "faint"))
            volume = math.exp(line.log_volume) * stroke_volume
            figure = PageFigure(Words(name), line.value, kind="ratio")
            marks.append(Mark(volume, math.exp(line.log_pressure), figure))
        across = Axis(Words("V", words="volume"), "volume", log=True)
        up = Axis(Words("p", words="absolute pressure"), "pressure", log=True)
        return Panel(across, up, tuple(curves), marks=tuple(marks), title=self.title)


def _line_between(
    line: Exponent, volumes: tuple[float, float], pressures: tuple[float, float]
) -> tuple[Array, Array]:
    """Return volumes and pressures at both ends of a line p V^n = const, which leaves neither range."""
    log_volumes = np.log(volumes)
    log_pressures = line.log_pressure - line.value * (log_volumes - line.log_volume)
    if line.value:
        log_pressures = np.clip(log_pressures, *np.log(pressures))
        log_volumes = line.log_volume - (log_pressures - line.log_pressure) / line.value
    return np.exp(log_volumes), np.exp(log_pressures)


class TracePictures:
    """The pictures of all traces of a cylinder, each end of a piston in a panel of its own."""

    def __init__(self, gases: Sequence[PistonGas]) -> None:
        self.gases = gases

    def over_angle(self) -> Iterator[Panel]:
        """Yield the cycles of each end over the crank angle."""
        for gas in self.gases:
            for end in self._ends(gas):
                yield end.over_angle()

    def logarithmic(self) -> Iterator[Panel]:
        """Yield each end over its volume, where that is known."""
        for gas in self.gases:
            indicator = gas.piston.indicator
            role = indicator.role if indicator else None
            for end in self._ends(gas):
                panel = end.logarithmic(role)
                if panel:
                    yield panel

    def _ends(self, gas: PistonGas) -> Iterator[TracedEnd]:
        """Yield the ends of a piston that have a trace of their own."""
        ends = zip(("head end", "crank end"), (gas.head, gas.crank), gas.areas)
        for name, pressure, area in ends:
            if not isinstance(pressure, TracePressure) or pressure.setting.mirrored:
                continue
            titles = []
            if len(self.gases) > 1:
                titles.append(gas.piston.name)
            if gas.head and gas.crank:
                titles.append(name)
            yield TracedEnd(pressure, float(area), ", ".join(titles))
