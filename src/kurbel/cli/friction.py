"""`kurbel friction`: a body on an inclined plane."""

import click

from kurbel.cli.output_options import Output, output_options
from kurbel.cli.readings import number


@click.command()
@click.option("--incline", type=number, required=True, metavar="DEGREES", help="Plane against the horizontal.")
@click.option("--coefficient", type=number, required=True, metavar="F", help="Coefficient of friction, such as 0.1.")
@click.option(
    "--direction",
    type=number,
    default=0.0,
    metavar="DEGREES",
    help="Direction of the force above the plane; along the plane if not given.",
)
@output_options
def friction(incline: float, coefficient: float, direction: float, output: Output) -> None:
    """Print the force P, over the weight Q, that moves a body up an inclined plane, and that holds it there.

    After Redtenbacher 1862: in the direction that is asked for, and horizontally, where P = Q tan(alpha +- rho) with
    tan rho = f. A negative holding force is one that must push the body down: it rests by its friction alone.
    """
    from kurbel.report.friction import inclined_plane

    output.write(inclined_plane(incline, coefficient, direction))
