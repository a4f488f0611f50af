"""The quantities of the crankshaft: its parts, the forces on its bearings, stresses and pressures."""

from collections.abc import Iterable, Iterator
from functools import partial

from kurbel.declared.quantity import Quantity, by_id

_stress = partial(Quantity, commands=("stress",))

SHAFT_PARTS = {
    "pin": ("pin", "the crank pin"),
    "web_A": ("w,A", "web A"),
    "web_B": ("w,B", "web B"),
    "journal_A": ("j,A", "journal A"),
    "journal_B": ("j,B", "journal B"),
}
"""Parts of a crankshaft: the index of their symbols, and what they are called in a sentence."""


def _each(
    id: str,
    symbol: str,
    kind: str,
    text: str,
    method: str = "",
    answer: str = "",
    parts: Iterable[str] = SHAFT_PARTS,
    argument: str = "",
) -> Iterator[Quantity]:
    """Yield the same quantity for each of these parts of a crankshaft; `*` stands for the part.

    method: what answers it, for the part or another argument, and which part of its answer; none for a column.
    """
    for part in parts:
        index, called = SHAFT_PARTS[part]
        asks = (method, argument or part, answer) if method else ()
        yield _stress(id.replace("*", part), symbol.replace("*", index), kind, text.replace("*", called), asks=asks)


STRENGTH_COLUMNS = (
    _stress("A_D", "A_D", "force", "Force on bearing A along D, in the frame that turns with the throw"),
    _stress("A_T", "A_T", "force", "Force on bearing A along T"),
    _stress("B_D", "B_D", "force", "Force on bearing B, beside the flywheel, along D"),
    _stress("B_T", "B_T", "force", "Force on bearing B along T"),
    *_each("sigma_*", "σ_*", "stress", "Largest combined stress of * (Bach)"),
    *_each("mises_*", "σ_v,*", "stress", "Largest equivalent stress of * (von Mises)"),
)


def _of_bearing(part: str, force: str) -> Iterator[Quantity]:
    each = partial(_each, parts=(part,), argument=force)
    highest, speed = "Largest pressure on * over the cycle, force over d l", "pressure_velocity"
    yield from each("p_*_max", "p_*,max", "pressure", highest, "pressure_max")
    yield from each("p_*_mean", "p_*,m", "pressure", "Mean pressure on * over the time of a cycle", "pressure_mean")
    yield from each("k_*", "k_*", speed, "Mean pressure times surface speed, p_m v, of *", speed)


STRENGTH_VALUES = (
    _stress(
        "P_dc", "P_dc", "force", "Full piston force, without inertia, taken in the dead centre", asks=("full_force",)
    ),
    _stress(
        "C_rod", "C_r", "force", "Centrifugal force of the connecting rod's turning part, which D does not contain"
    ),
    *_each(
        "sigma_*_dc",
        "σ_*,dc",
        "stress",
        "Combined stress of * in the dead centre under full force (Bach)",
        "sigma_dc",
        "value",
    ),
    *_each("sigma_*_max", "σ_*,max", "stress", "Largest combined stress of * over the cycle (Bach)", "sigma_max"),
    *_each(
        "mises_*_max", "σ_v,*,max", "stress", "Largest equivalent stress of * over the cycle (von Mises)", "mises_max"
    ),
    *_each(
        "safety_*_min",
        "S_*",
        "ratio",
        "Smallest safety of *: k_b over its combined stress, dead centre and cycle",
        "safety",
    ),
    _stress("A_max", "A_max", "force", "Largest force on bearing A", asks=("load_max", "A")),
    _stress("B_max", "B_max", "force", "Largest force on bearing B, beside the flywheel", asks=("load_max", "B")),
    _stress(
        "p_pin_dc",
        "p_pin,dc",
        "pressure",
        "Pressure on the crank pin under full force, P/(d l)",
        asks=("pin_pressure_dc",),
    ),
    *_of_bearing("pin", "pin"),
    *_of_bearing("journal_A", "A"),
    *_of_bearing("journal_B", "B"),
    _stress(
        "equilibrium_residual",
        "ΣF, ΣM",
        "ratio",
        "What is left of the sums of forces and moments on the crankshaft",
        "sum F, M",
        residual=True,
    ),
)


STRESSES = by_id(
    Quantity("compression", "σ_c", "stress", "Compression of a web by the force along it, negative where it is pulled"),
    Quantity("bending_in_plane", "σ_b1", "stress", "Bending in the plane of the throw"),
    Quantity("bending_out_of_plane", "σ_b2", "stress", "Bending square to the plane of the throw"),
    Quantity("torsion", "τ", "stress", "Torsion"),
    Quantity("combined", "σ_res", "stress", "Combined stress 0.35 σ + 0.65 √(σ² + 4(α₀τ)²) (Bach)"),
    Quantity("von_mises", "σ_v", "stress", "Equivalent stress √(σ² + 3τ²) (von Mises)"),
)
"""Stresses at one place of a crankshaft, by id."""
