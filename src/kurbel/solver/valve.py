"""Key values of the valve gear of a cylinder: how it is set, its events, leads and openings, the speed of the steam.

The speed of the steam is that of the piston, on the mean c_m and at most c_max, times its area over the largest opening
of the port: u = A c/(a b).
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import Any

from kurbel.arrays import Number
from kurbel.declared.unit_systems import show, show_range
from kurbel.machine import Cylinder
from kurbel.machine.ideal_cards import Steam
from kurbel.machine.valve import Valve, ValveEnd
from kurbel.numerics.extreme import Extreme
from kurbel.quantity import Heading, value, values_for
from kurbel.solver.figures import Results
from kurbel.solver.motion import Motion

_ENDS = {"head": ("H", "head end"), "crank": ("C", "crank end")}
"""End of the cylinder -> index of its symbols, and its name."""
_EVENTS = ("admission", "cut_off", "release", "compression")
_MOTION = ("motion",)
_THROTTLING = 50.0
_FAST = 60.0  # m/s at any moment, from which on inlets throttle: Die Kolbendampfmaschinen, p. 141


def _of_end(id: str, symbol: str, kind: str, text: str, **words: Any) -> Any:
    """Return a key value of each end."""
    return values_for(_ENDS, f"{id}_*", symbol, kind, text, commands=_MOTION, **words)


class ValveGear(Results):
    """What the valve of a cylinder does, in SI; crank angles are those of the cylinder."""

    _valve = Heading("Valve")
    valve_travel = value(
        "2r",
        "length",
        "Travel of the valve",
        lambda gear: 2 * gear.valve.eccentric.radius,
        commands=_MOTION,
    )
    advance = value(
        "δ_E",
        "angle",
        "Angle of advance of the eccentric",
        lambda gear: gear.valve.eccentric.advance,
        commands=_MOTION,
    )
    valve_shift = value(
        "ε_E",
        "length",
        "Middle of the travel off the middle of the ports, toward opening the head end to steam",
        lambda gear: gear.valve.shift,
        commands=_MOTION,
    )
    cut_off = _of_end(
        "cut_off",
        "x_E,*",
        "ratio",
        "Cut-off at the *: fraction of the stroke at which admission ends",
    )
    release = _of_end(
        "release",
        "x_A,*",
        "ratio",
        "Release at the *: fraction of the stroke at which the exhaust opens",
    )
    compression = _of_end(
        "compression",
        "x_K,*",
        "ratio",
        "Compression at the *: part of the return stroke left when the exhaust shuts",
    )
    admission = _of_end(
        "admission",
        "x_V,*",
        "ratio",
        "Admission at the *: part of the return stroke left when steam enters",
    )
    lead = _of_end("lead", "v_*", "length", "Lead at the *: opening to steam at its dead centre")
    exhaust_lead = _of_end(
        "exhaust_lead",
        "v_i,*",
        "length",
        "Exhaust lead at the *: opening to the exhaust at the end of its stroke",
    )
    opening = _of_end("opening", "a_max,*", "length", "Largest opening to steam at the *")
    steam_speed = _of_end(
        "steam_speed",
        "u_*",
        "velocity",
        "Mean speed of the steam through the largest opening at the *",
    )
    steam_speed_max = _of_end(
        "steam_speed_max",
        "u_max,*",
        "velocity",
        "Largest speed of the steam through the largest opening at the *",
    )

    def __init__(self, valve: Valve, cylinder: Cylinder, motion: Motion) -> None:
        self.valve, self.cylinder, self.motion = valve, cylinder, motion

    @cached_property
    def answers(self) -> dict[str, Any]:
        """The key values of both ends."""
        answers = dict[str, Any]()
        for name, end in zip(_ENDS, self.valve.ends):
            fractions = end.fractions(self.motion.mechanism)
            for event, degrees in end.events._asdict().items():
                angle = (degrees + end.dead_centre) % 360.0
                answers[f"{event}_{name}"] = Extreme(fractions._asdict()[event], angle)
            answers[f"lead_{name}"] = end.lead
            answers[f"exhaust_lead_{name}"] = end.exhaust_lead
            answers[f"opening_{name}"] = end.opening
            times = self._times_faster(end)
            if times is not None:
                answers[f"steam_speed_{name}"] = times * self.motion.c_m
                answers[f"steam_speed_max_{name}"] = times * self.motion.c_max.value
        return answers

    def events_of_ends(self) -> Iterator[tuple[str, dict[str, Extreme]]]:
        """Yield the name of each end with its events, in the order of a turn; of a single machine."""
        for name, (_, end) in _ENDS.items():
            events = {event.replace("_", "-"): self.answers[f"{event}_{name}"] for event in _EVENTS}
            yield end, events

    @property
    def notes(self) -> Iterator[str]:
        """What a reader of the results should know, each in one sentence; of a single machine."""
        chambers = self.cylinder.pistons[0].chambers if self.cylinder.pistons else {}
        others = [
            end.replace("_", " ") for end, card in chambers.items() if not isinstance(card, Steam)
        ]
        if others:
            ends = " and the ".join(others)
            yield f"the events of 'valve' do not change the pressures of the {ends}, which are given"
        fastest = max(self.answers.get(f"steam_speed_max_{name}", 0.0) for name in _ENDS)
        if fastest > _FAST:
            speed = show(round(fastest, 1), "velocity")
            yield (
                f"the steam rushes through the port at up to {speed}: throttling is to be expected "
                f"above {show_range(_THROTTLING, _FAST, 'velocity')}, and the ideal card is too full there"
            )

    def _times_faster(self, end: ValveEnd) -> Number | None:
        """Return the speed of the steam over that of the piston; None where a length or the speed is not known."""
        pistons, port_length = self.cylinder.pistons, self.valve.port_length
        if not pistons or port_length is None or self.motion.c_m is None:
            return None
        areas = {"head_end": pistons[0].head_area, "crank_end": pistons[0].crank_area}
        return areas[end.key] / (end.opening * port_length)
