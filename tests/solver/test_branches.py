"""Branches and several gears of a shaft line: published examples, and trees against the motion of their own shafts."""

import math
from typing import Any

import jsonschema
import numpy as np
import pytest

from kurbel.errors import KurbelError
from kurbel.machine_file import loads
from kurbel.machine_file.schema import json_schema
from kurbel.pictures.pictures import PictureOptions, pictures
from kurbel.solver.case import Case
from kurbel.solver.chapters.torsion import ShaftVibration

FR_GEARED = """
name: An engine with two rotors
shaft:
  - {name: motor, inertia: 400e-6 kg m2}
  - {stiffness: 10000 N m/rad}
  - {name: gear 1, inertia: 25e-6 kg m2}
  - branch:
      - {gear: 1}
      - {name: gear 2, inertia: 25e-6 kg m2}
      - {stiffness: 5000 N m/rad}
      - {name: rotor 2, inertia: 700e-6 kg m2}
  - {stiffness: 5000 N m/rad}
  - {name: rotor 1, inertia: 700e-6 kg m2}
"""
GEARBOX = """
name: A pump and a drum behind a gearbox
speed: 900 rpm
effort: {unit: N m, mean: 800, harmonics: [[2, 300, 100], [4, -50, 20]]}
shaft:
  - {name: engine, inertia: 1.2 kg m2}
  - {stiffness: 250 kN m/rad, loss_factor: 0.01}
  - {name: gearbox, inertia: 0.3 kg m2}
  - branch:
      - {gear: 2}
      - {name: pump wheel, inertia: 0.02 kg m2}
      - {diameter: 35 mm, length: 300 mm}
      - {name: pump, inertia: 0.05 kg m2, damping: 0.1 N m s/rad}
  - {gear: 1/3}
  - {name: wheel, inertia: 2.5 kg m2}
  - {diameter: 70 mm, length: 2 m, loss_factor: 0.01}
  - {name: drum, inertia: 60 kg m2}
"""


def solved(text: str) -> ShaftVibration:
    return Case(loads(text)).torsion


def frequencies(vibration: ShaftVibration) -> Any:
    """Elastic natural frequencies in Hz."""
    return vibration.modes.omegas[1 - vibration.first :] / (2 * math.pi)


def test_two_equal_rotors() -> None:
    """Friswell et al. by openTorsion; two equal rotors swing together, or against each other while the rest is still.

    Together they are one rotor of twice the inertia on a shaft of twice the stiffness, a row of three masses: ω⁴ − ω²
    (k₁/J₁ + (k₁ + k₂)/J₂ + k₂/J₃) + k₁ k₂ (J₁ + J₂ + J₃)/(J₁ J₂ J₃) = 0.
    """
    vibration = solved(FR_GEARED)
    assert frequencies(vibration) == pytest.approx([425.4, 634.1, 3247.2], rel=1e-4)
    assert [mass.name for mass in vibration.line.masses] == [
        "motor",
        "gear 1 + gear 2",
        "rotor 2",
        "rotor 1",
    ]

    k1, k2, J1, J2, J3 = 10000.0, 10000.0, 400e-6, 50e-6, 1400e-6
    p = k1 / J1 + (k1 + k2) / J2 + k2 / J3
    q = k1 * k2 * (J1 + J2 + J3) / (J1 * J2 * J3)
    high = (p + math.sqrt(p * p - 4 * q)) / 2
    squares = (5000 / 700e-6, q / high, high)
    exact = [math.sqrt(square) / (2 * math.pi) for square in squares]
    assert frequencies(vibration) == pytest.approx(exact, rel=1e-15)

    against = vibration.modes.holzer(1).angles
    assert against == pytest.approx([0, 0, 1, -1], abs=1e-15)
    together = vibration.modes.holzer(2).angles
    assert together[2] == pytest.approx(together[3], rel=1e-14)


def test_a_gearbox_with_a_pump_and_a_drum() -> None:
    """Forced vibration of trees with other ratios; figures by finite elements in the shafts' own coordinates.

    The load is that of the drum, the last mass of the line, and not of the branch, whose mean torque is zero.
    """
    vibration = solved(GEARBOX)
    own = [13.046332790633873, 105.56900789600601, 174.8365849776877]
    assert frequencies(vibration) == pytest.approx(own, rel=1e-14)
    mode = [1.0, 0.9677464235140789, 0.9759170406012146, -0.3051685113866692]
    assert vibration.holzer(1).angles == pytest.approx(mode, rel=1e-13)
    torques = {segment.name: segment for segment in vibration.segments}
    joined = "gearbox + pump wheel + wheel"
    assert list(torques) == [f"engine – {joined}", f"{joined} – pump", f"{joined} – drum"]
    means = [segment.M_shaft_mean for segment in torques.values()]
    assert means == pytest.approx([800, 0, 2400], rel=1e-13, abs=1e-10)
    swings = [segment.M_vibratory for segment in torques.values()]
    own = [117.32785145473719, 21.507319221787647, 181.9975652309935]
    assert swings == pytest.approx(own, rel=1e-11)
    assert vibration.vibration_loss == pytest.approx(0.5967664710135224, rel=1e-11)


class RandomTree:
    """A tree of masses with gears, as a file, and as stiffness and inertia in the coordinates of its own shafts.

    Joined wheels are a constraint u₁ θ₂ = u₂ θ₁ there, and not one mass.
    """

    def __init__(self, seed: int) -> None:
        self.numbers = np.random.default_rng(seed)
        self.inertias: list[float] = []
        self.springs: list[tuple[int, int, float]] = []
        self.wheels: list[tuple[int, int, float]] = []
        first = self.mass()
        lines = [f"  - {{inertia: {self.inertias[first]!r} kg m2}}"]
        lines += self.following(first, "  ", depth=0)
        self.text = "name: Tree\nshaft:\n" + "\n".join(lines)

    def mass(self) -> int:
        self.inertias.append(float(10 ** self.numbers.uniform(-1, 1)))
        return len(self.inertias) - 1

    def following(self, mass: int, indent: str, depth: int) -> list[str]:
        """The items behind a mass: branches, then a segment or a gear with the next mass, and so on."""
        lines = list[str]()
        for number in range(int(self.numbers.integers(1, 4))):
            is_behind_mass = not depth or number > 0
            if is_behind_mass and depth < 3 and self.numbers.random() < 0.6:
                lines.append(f"{indent}- branch:")
                lines += self.following(mass, f"{indent}    ", depth + 1)
            if self.numbers.random() < 0.4:
                ratio = float(self.numbers.uniform(0.3, 3))
                other = self.mass()
                self.wheels.append((mass, other, ratio))
                lines.append(f"{indent}- {{gear: {ratio!r}}}")
                lines.append(f"{indent}- {{inertia: {self.inertias[other]!r} kg m2}}")
                mass = other
            stiffness = float(10 ** self.numbers.uniform(2, 5))
            other = self.mass()
            self.springs.append((mass, other, stiffness))
            lines.append(f"{indent}- {{stiffness: {stiffness!r} N m/rad}}")
            lines.append(f"{indent}- {{inertia: {self.inertias[other]!r} kg m2}}")
            mass = other
        return lines

    def frequencies(self) -> Any:
        """Elastic natural frequencies in Hz by a dense eigenproblem on the null space of the constraints."""
        count = len(self.inertias)
        K = np.zeros((count, count))
        for mass, other, stiffness in self.springs:
            twist = np.zeros(count)
            twist[mass], twist[other] = 1, -1
            K += stiffness * np.outer(twist, twist)
        gears = np.zeros((len(self.wheels), count))
        for row, (mass, other, ratio) in zip(gears, self.wheels):
            row[mass], row[other] = ratio, -1
        free = np.linalg.svd(gears)[2][len(self.wheels) :].T if self.wheels else np.eye(count)
        J = free.T @ np.diag(self.inertias) @ free
        half = np.linalg.inv(np.linalg.cholesky(J))
        squares = np.linalg.eigvalsh(half @ free.T @ K @ free @ half.T)
        return np.sqrt(squares[1:]) / (2 * math.pi)


@pytest.mark.parametrize("seed", range(20))
def test_trees_in_the_coordinates_of_their_own_shafts(seed: int) -> None:
    tree = RandomTree(seed)
    vibration = solved(tree.text)
    assert frequencies(vibration) == pytest.approx(tree.frequencies(), rel=1e-9)
    for mode in vibration.mode_numbers:
        assert vibration.modes.holzer(mode).residual < 1e-11


def test_a_branch_written_last_is_the_same_line() -> None:
    """A branch behind the last mass goes on where the line could go on; its masses are in the order of the list."""
    row = solved(
        "shaft: [{inertia: 1 kg m2}, {stiffness: 900 N m/rad}, {inertia: 2 kg m2}, {gear: 2}, "
        "{stiffness: 70 N m/rad}, {inertia: 0.1 kg m2}]"
    )
    branched = solved(
        "shaft: [{inertia: 1 kg m2}, {stiffness: 900 N m/rad}, {inertia: 2 kg m2}, "
        "{branch: [{gear: 2}, {stiffness: 70 N m/rad}, {inertia: 0.1 kg m2}]}]"
    )
    assert branched.modes.omegas.tolist() == row.modes.omegas.tolist()
    assert branched.line.load == 1
    assert row.line.load == 2


def test_a_branch_to_the_ground() -> None:
    """A mass held by a branch to a fixed end: ω² = (k₁ + k₂)/J of a single mass beside a much heavier one."""
    vibration = solved(
        "shaft: [{inertia: 2 kg m2}, {branch: [{stiffness: 300 N m/rad}, ground]}, "
        "{stiffness: 500 N m/rad}, ground]"
    )
    assert vibration.modes.omegas == pytest.approx([20.0], rel=1e-15)


@pytest.mark.parametrize(
    ("ratio", "is_refused"), [("1/3", False), ("1/2", True)], ids=["equal", "unequal"]
)
def test_cranks_turn_at_one_speed(ratio: str, is_refused: bool) -> None:
    """3 times 1/3 is 1 but for rounding."""
    text = (
        "{cylinders: [{crank: 100 mm, rod: 400 mm, name: a}, {crank: 100 mm, rod: 400 mm, name: b}], "
        "shaft: [{cylinder: a, inertia: 1 kg m2}, {gear: 3}, {inertia: 1 kg m2}, "
        f"{{gear: {ratio}}}, {{cylinder: b, inertia: 1 kg m2}}, {{stiffness: 9 N m/rad}}, "
        "{inertia: 1 kg m2}]}"
    )
    if is_refused:
        with pytest.raises(KurbelError, match=r"different speeds \(1 and 1.5\)"):
            loads(text)
    else:
        assert len(solved(text).line.masses) == 2


def test_the_schema_knows_branches_of_branches() -> None:
    validator = jsonschema.Draft7Validator(json_schema())
    inner = [{"gear": 2}, {"inertia": "1 kg m2"}]
    branch = [{"stiffness": "1 N m/rad"}, {"inertia": "1 kg m2"}, {"branch": inner}]
    assert validator.is_valid({"shaft": [{"inertia": "1 kg m2"}, {"branch": branch}]})
    inner.append({"stiffness": "1 N"})
    assert not validator.is_valid({"shaft": [{"inertia": "1 kg m2"}, {"branch": branch}]})


def test_a_mode_is_drawn_with_a_line_for_each_branch() -> None:
    case = Case(loads(FR_GEARED))
    panel = next(pictures(case, ("modes",), PictureOptions())).panels[0]
    pieces = [places.tolist() for places, _ in panel.curves[0].pieces()]
    assert pieces == [[0, 1, 2], [1, 3]]
    assert panel.curves[0].jumps() == []
