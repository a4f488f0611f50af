"""The page of *Öl- und Gasmaschinen* (G) that the model of the crankshaft follows."""

import math

import numpy as np
import pytest

from kurbel.solver.shaft import FreeBody
from shafts import place_at, shaft, strength


class TestOelUndGasmaschinen:
    """*Öl- und Gasmaschinen*, Kurbelwangen: the formulas of the page, written out with figures of our own.

    The throw lies in the dead centre, a = b = 400 mm, e = 170 mm, webs 120 × 220 mm, P = 300 kN; the reaction of the
    flywheel in A, 20 kN, stands square to it.
    """

    P, A_S = 300e3, 20e3

    def web(self) -> tuple[float, ...]:
        sized = shaft(
            b=0.4,
            flywheel_mass=1.0,
            flywheel_position=0.2,
            allowable_bending=60e6,
            allowable_torsion=40e6,
        )
        weight = self.A_S * 0.8 / 0.2  # so that A_s = G f/(a + b) is 20 kN
        body = FreeBody(sized, 0.3, np.array([self.P + 0j]), np.array([-1j * weight]))
        face, side = place_at(body, "web_B", "wide face"), place_at(body, "web_B", "narrow face")
        found = (
            face.compression,
            face.torsion,
            side.bending_out_of_plane,
            face.bending_in_plane,
            face.combined,
            side.torsion,
        )
        return tuple(float(value[0]) for value in found)

    def test_every_line_of_the_page(self) -> None:
        t, w, a, e, r = 0.12, 0.22, 0.4, 0.17, 0.3
        compression, torsion, by_weight, in_plane, combined, narrow = self.web()
        assert compression == pytest.approx(0.5 * self.P / (t * w), rel=1e-13)
        assert torsion == pytest.approx(4.5 * self.A_S * (a + e) / (t * t * w), rel=1e-13)
        assert by_weight == pytest.approx(
            self.A_S * r / (t * w * w / 6), rel=1e-13
        )  # lever to the axis of the pin
        assert in_plane == pytest.approx(self.P / 2 * (a - e) / (t * t * w / 6), rel=1e-13)
        sigma, alpha = compression + in_plane, 60 / (1.3 * 40)
        bach = 0.35 * sigma + 0.65 * math.sqrt(sigma**2 + 4 * (alpha * torsion) ** 2)
        assert combined == pytest.approx(bach, rel=1e-13)
        assert narrow == pytest.approx(torsion * t / w, rel=1e-13)

    def test_pin_at_largest_torque(self) -> None:
        """M_b = √((A_T a)² + (A_R a)²), M_d = A_T r, combined with α₀ = 1."""
        sized = shaft(b=0.4)
        at = strength(sized).at([35.0])
        bending = math.hypot(at.A_T[0] * 0.4, at.A_D[0] * 0.4) / (math.pi * 0.18**3 / 32)
        torsion = at.A_T[0] * 0.3 / (math.pi * 0.18**3 / 16)
        bach = 0.35 * bending + 0.65 * math.sqrt(bending**2 + 4 * torsion**2)
        assert at.sigma_pin[0] == pytest.approx(bach, rel=1e-13)
