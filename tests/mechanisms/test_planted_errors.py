"""The laws are worth something only if a wrong formula breaks one: each of these slips, once planted, breaks one."""

import dataclasses
import importlib
import inspect
import itertools
import types
from collections.abc import Callable, Iterator

import pytest
import test_every_mechanism as laws

SLIPS = [
    ("slider_crank", "rod_angle", "angle.sin - self.offset", "angle.sin + self.offset"),
    ("slider_crank", "coordinate", "middle_sin + middle_cos", "middle_sin - middle_cos"),
    ("slider_crank", "slope", "(angle.sin + angle.cos", "(angle.sin - angle.cos"),
    ("slider_crank", "curvature", "+ bend", "- bend"),
    ("slider_crank", "radial", "cos - angle.sin", "cos + angle.sin"),
    ("slider_crank", "radial", "cos - angle.sin", "sin - angle.cos"),
    ("scotch_yoke", "coordinate", "versine", "vercosine"),
    ("scotch_yoke", "block_slope", "angle.cos", "angle.sin"),
    ("scotch_yoke", "pin_force_factor", "+ 1.0", "- 1.0"),
    ("scotch_yoke", "radial", "angle.cos", "-angle.cos"),
    ("scotch_yoke", "radial", "angle.cos", "angle.sin"),
    ("scotch_yoke", "guide_pair_factor", "angle.sin", "angle.cos"),
    ("slider_crank", "bending_arm", "self.gland + self.coordinate", "self.gland - self.coordinate"),
    ("slotted_lever", "_lever_at", "-crank * frame * (gap", "crank * frame * (gap"),
    ("slotted_lever", "pin_force_factor", "/ lever.reach", "* lever.reach"),
    ("slotted_lever", "radial", "-force", "force"),
    ("slotted_lever", "radial", "angle.sin", "angle.cos"),
    ("slotted_lever", "block_slope", "-self.crank", "self.crank"),
    ("slotted_lever", "_ram", "cos - sin *", "cos + sin *"),
    ("slotted_lever", "_ram", "sin + cos * (rise / run)", "sin - cos * (rise / run)"),
    ("four_bar", "closed_at", "H * across - foot", "H * across + foot"),
    ("four_bar", "closed_at", "+ a * (angle.versine", "- a * (angle.versine"),
    ("four_bar", "swing_at", "ahead - bearing", "ahead + bearing"),
    ("four_bar", "swing_at", "angle.versine + (self", "angle.versine - (self"),
    ("four_bar", "coupler_force_factor", "self.coupler / self.frame", "-self.coupler / self.frame"),
    ("oscillating_cylinder", "curvature", "angle.cos - slope * slope", "angle.cos"),
    ("oscillating_cylinder", "_direction", "return -self.crank", "return self.crank"),
    ("oscillating_cylinder", "radial", "angle.cos * cos + angle.sin * sin", "angle.cos"),
    ("oscillating_cylinder", "swing_at", "slope = -crank", "slope = crank"),
    ("oscillating_cylinder", "crank_angles_at", "reach + self._gap)", "reach)"),
    ("parallel_crank", "", "-mechanism.crank * angle.versine", "-mechanism.crank * angle.sin"),
    ("parallel_crank", "", "-mechanism.crank * angle.cos", "mechanism.crank * angle.cos"),
    (
        "parallel_crank",
        "_acceleration",
        "mechanism.crank * results.omega",
        "mechanism.crank * mechanism.crank * results.omega",
    ),
    ("parallel_crank", "coupler_force_factor", "angle.sin", "angle.cos"),
]
"""File, function ('' for the columns before the class), its text and the wrong one: signs, sine for cosine, factors."""


def planted(file: str, function: str, right: str, wrong: str) -> types.ModuleType:
    """Return the module with this text replaced where it first stands from that function on."""
    module = importlib.import_module(f"kurbel.mechanisms.{file}")
    before, head, after = inspect.getsource(module).partition(
        f"def {function}(" if function else "OFFERS = ("
    )
    assert right in after, (
        f"{file}.{function} has no '{right}' any more: plant the slip in the formula as it stands now"
    )
    spoilt = types.ModuleType(module.__name__)
    exec(compile(before + head + after.replace(right, wrong, 1), file, "exec"), spoilt.__dict__)
    return spoilt


def take_over(monkeypatch: pytest.MonkeyPatch, spoilt: types.ModuleType) -> None:
    """Put what the spoilt module defines where the real one has it: its functions, and what its classes hold."""
    real = importlib.import_module(spoilt.__name__)
    for name, one in vars(spoilt).items():
        if isinstance(one, type) and one.__module__ == real.__name__:
            for key, value in vars(one).items():
                if not key.startswith("__"):
                    monkeypatch.setattr(getattr(real, name), key, value)
        elif inspect.isfunction(one) and one.__module__ == real.__name__:
            monkeypatch.setattr(real, name, one)


def calls_of(law: Callable[..., None]) -> Iterator[tuple[Callable[..., None], dict[str, object]]]:
    """Yield the calls that make up a test: the law itself with the arguments of each."""
    if hasattr(law, "law"):
        for values in law.values:
            yield law.law, dict(zip(inspect.signature(law.law).parameters, values))
        return
    marks = [mark.args for mark in getattr(law, "pytestmark", ()) if mark.name == "parametrize"]
    for chosen in itertools.product(
        *([named(names, one) for one in every] for names, every in marks)
    ):
        yield law, {name: value for given in chosen for name, value in given.items()}


def named(names: str | tuple[str, ...], value: object) -> dict[str, object]:
    """Return one parameter of pytest by the names of the arguments."""
    if isinstance(value, type(pytest.param())):
        values = value.values
    else:
        values = value if isinstance(names, tuple) else (value,)
    return dict(zip(names if isinstance(names, tuple) else (names,), values))


def broken(file: str) -> Iterator[str]:
    """Yield the names of the laws that the machines of a file now break."""
    own = f"kurbel.mechanisms.{file}"
    for name, test in vars(laws).items():
        calls = calls_of(test) if name.startswith("test_") else ()
        try:
            for law, given in calls:
                if type(given.get("machine")).__module__ == own:
                    # anew, since some keep what they once computed
                    law(**{**given, "machine": dataclasses.replace(given["machine"])})
        except AssertionError:
            yield name


@pytest.mark.slow
@pytest.mark.parametrize(
    ("file", "function", "right", "wrong"), SLIPS, ids=[" ".join(slip) for slip in SLIPS]
)
def test_a_slip_breaks_a_law(
    file: str, function: str, right: str, wrong: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    take_over(monkeypatch, planted(file, function, right, wrong))
    assert next(broken(file), None) is not None
