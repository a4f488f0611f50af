"""The exact connecting rod: two masses at its ends and a couple, as the rod swings (R 298).

A rod of mass m_r, centre of gravity at a from the crosshead pin and moment of inertia I_r about it moves like a mass
m_r (1 − a/L) at the crosshead pin, a mass m_r a/L at the crank pin, and a couple (I_r − m_r a (L − a)) ψ̈. The first
mass goes to and fro with the piston. The second pulls at the pin with its centrifugal force and its weight. The couple
is carried by the guide and the crank pin, two equal forces square to the stroke line.
"""

from functools import cached_property
from typing import Any

from kurbel import crank_formulas as formulas
from kurbel.crank_angle import CrankAngle
from kurbel.declared.units import GRAVITY
from kurbel.machine.masses import ConnectingRod

RodAngle = tuple[Any, Any]


class ExactRod:
    """A rod of length L in m on a crank of radius R in m, turning at ω (rad/s, None where no speed is given).

    weight, crosshead_weight: of the masses at crank and crosshead pin in N, toward the shaft along the stroke line, and
    square to it onto the guide; None where weights are left out.
    """

    def __init__(self, rod: ConnectingRod, length: Any, crank: Any, omega: Any, incline: CrankAngle | None) -> None:
        self.length = length
        self.crank = crank
        self.omega = 0.0 if omega is None else omega
        self.pin_mass = rod.at_pin(length)
        self.excess_inertia = rod.excess_inertia(length)
        self.crosshead_mass = rod.at_crosshead(length)
        weight = self.pin_mass * GRAVITY
        self.weight = None if incline is None else (weight * incline.sin, weight * incline.cos)

        weight = self.crosshead_mass * GRAVITY
        self.crosshead_weight = None if incline is None else (weight * incline.sin, weight * incline.cos)

    @cached_property
    def pull(self) -> Any:
        """Centrifugal force m R ω² of the mass at the pin in N, away from the shaft."""
        # a float squared by ** raises where the product is infinite
        return self.pin_mass * self.crank * self.omega * self.omega

    def swing_slope(self, rod_angle: RodAngle, angle: CrankAngle) -> Any:
        """Return dψ/dφ = λ cos φ/cos ψ."""
        return formulas.rod_slope(angle.cos, rod_angle[1], self.crank / self.length)

    def couple(self, rod_angle: RodAngle, angle: CrankAngle) -> Any:
        """Return (I_r − m_r a (L − a)) ψ̈ in N m, at uniform rotation."""
        sin_psi, cos_psi = rod_angle
        slope = self.swing_slope(rod_angle, angle)
        curvature = formulas.rod_curvature(angle.sin, sin_psi, cos_psi, slope, self.crank / self.length)
        return curvature * (self.excess_inertia * self.omega * self.omega)

    def side_force(self, rod_angle: RodAngle, angle: CrankAngle) -> Any:
        """Return the force in N, square to the stroke line, by which the couple relieves the guide."""
        return self.couple(rod_angle, angle) / (rod_angle[1] * self.length)

    def tangential(self, rod_angle: RodAngle, angle: CrankAngle) -> Any:
        """Return what couple and weight give to T in N."""
        share = -self.side_force(rod_angle, angle) * angle.cos
        if self.weight is None:
            return share
        return share + (angle.sin * self.weight[0] - angle.cos * self.weight[1])

    def radial(self, rod_angle: RodAngle, angle: CrankAngle) -> Any:
        """Return what couple, centrifugal force and weight give to D in N."""
        share = self.side_force(rod_angle, angle) * angle.sin - self.pull
        if self.weight is None:
            return share
        return share + (angle.cos * self.weight[0] + angle.sin * self.weight[1])

    def at_crosshead(self, rod_angle: RodAngle, push: Any, lift: Any, b: Any) -> Any:
        """Return the force in N along the rod at the crosshead pin, compression positive.

        push: what is left of P for the rod; lift: N less the weight on the guide; b: acceleration in m/s², None without
        inertia. In both stands the rod's own mass at this pin, which the pin does not act on.
        """
        if b is not None:
            push = push + b * self.crosshead_mass
        if self.crosshead_weight is not None:
            push, lift = push - self.crosshead_weight[0], lift + self.crosshead_weight[1]
        return push * rod_angle[1] + lift * rod_angle[0]

    def at_crank(self, rod_angle: RodAngle, angle: CrankAngle, tangential: Any, radial: Any) -> Any:
        """Return the force in N along the rod at the crank pin, T sin(φ+ψ) + D cos(φ+ψ), compression positive."""
        sin_psi, cos_psi = rod_angle
        sin, cos = angle.sin * cos_psi + angle.cos * sin_psi, angle.cos * cos_psi - angle.sin * sin_psi
        return tangential * sin + radial * cos

    def reduced_inertia(self, rod_angle: RodAngle, angle: CrankAngle) -> Any:
        """Return what the rod, but for the masses at its ends, adds to the shaft's inertia, in kg m²."""
        slope = self.swing_slope(rod_angle, angle)
        return slope * slope * self.excess_inertia
