"""The inclined plane with friction, after Redtenbacher 1862 (D), whose equations 1 to 5 here are those of the plane."""

from kurbel.crank_angle import CrankAngle
from kurbel.errors import NoSolutionError


def holding_force(incline: float, friction: float, direction: float = 0.0) -> float:
    """Return P/Q that moves a body of weight Q up an inclined plane: (sin α + f cos α)/(cos β + f sin β), D 1.

    incline α and direction β of the force above the plane, in degrees; β = −α is a horizontal force (D 3), f < 0 gives
    the force that just keeps it from sliding down (D 2), zero at tan α = f (D 4).

    Raises NoSolutionError where no force moves it (D 5: horizontally, tan α ≥ 1/f).
    """
    alpha, beta = CrankAngle.of(float(incline)), CrankAngle.of(float(direction))
    below = beta.cos + friction * beta.sin
    if below <= 0:
        raise NoSolutionError(
            f"the body locks itself: no force at {direction:g} deg moves it up {incline:g} deg"
        )
    return float((alpha.sin + friction * alpha.cos) / below)
