"""The commands on one machine that print tables: motion, forces, flywheel, stress, bearings, balance and the rest."""

from collections.abc import Callable
from functools import wraps
from typing import TYPE_CHECKING, Any

import click

from kurbel.cli.options import (
    Output,
    Spreads,
    angle_options,
    columns_option,
    frequency,
    machine_file,
    orders_option,
    output_options,
    part_options,
    row_options,
    speeds_option,
    stacked,
    uncertainty_option,
    units_option,
    where_option,
)
from kurbel.declared.unit_systems import messages_in

if TYPE_CHECKING:
    from kurbel.cli.request import Request


_OF_EVERY = "Key values are exact, whichever rows are printed. FILE may be - for standard input."


def _with_request(command: Callable[..., None]) -> Callable[..., None]:
    @wraps(command)
    def with_request(units: str | None, output: Output, **options: Any) -> None:
        from kurbel.cli.request import Request

        own = {name: options.pop(name) for name in Request.__annotations__ if name in options}
        with messages_in(units or "metric"):
            system = units or ("si" if output.look.format in ("csv", "json") else "metric")
            command(Request(click.get_current_context().info_name or "", units=system, output=output, **own), **options)

    with_request.__doc__ = f"{command.__doc__}\n\n    {_OF_EVERY}"
    return with_request


machine_places = stacked(machine_file, part_options, units_option, output_options, _with_request)
"""Adds FILE and the options of a command without a table over the crank angle; see `machine_table`."""
machine_table = stacked(
    machine_file, angle_options, columns_option, part_options, units_option, output_options, _with_request
)
"""Adds FILE and all options of a table, which the command gets as one `Request`."""
cases_option = click.option(
    "--cases", is_flag=True, help="A row of key values for every load case of FILE, those of --columns if given."
)


@click.command()
@machine_table
@row_options
def motion(request: "Request") -> None:
    """Print the motion of every cylinder's mechanism in FILE over one turn of the crank, and the key values.

    A sliding output has x, c, b, a swinging one theta, theta_dot, theta_ddot. Without a speed in FILE only the
    positions are printed.
    """
    from kurbel.report.crank import motion_report

    case = request.case()
    request.print(motion_report, case=case, parts=len(case.cylinders))


@click.command()
@machine_table
@cases_option
@uncertainty_option
@row_options
@click.option(
    "--cycle", type=click.IntRange(min=1), metavar="N", help="This measured cycle of a trace, not their mean."
)
@click.option("--each-cycle", is_flag=True, help="A line for every measured cycle instead of the table over the angle.")
def forces(request: "Request", cycle: int | None, each_cycle: bool, spreads: Spreads) -> None:
    """Print the forces in the crank train over the working cycle, and the key values, for every cylinder of FILE.

    P acts along the stroke line, S in the rod, N on the guide, D and T at the crank pin; forces toward the shaft
    count positive. At a jump of the pressure the table has the value just after it.
    """
    from kurbel.report.crank import forces_report

    case = request.case(cycle)
    if not each_cycle:
        request.print(forces_report, case=case, parts=len(case.cylinders), spreads=spreads)
    elif given := request.given(**{"--cycle": cycle}):
        raise click.UsageError(f"--each-cycle has no table over the angle; leave out {given[0]}.")
    else:
        request.print(forces_report, True, case=case)


@click.command()
@machine_table
@where_option
@uncertainty_option
def flywheel(request: "Request", spreads: Spreads) -> None:
    """Print turning effort, excess work, flywheel and speed fluctuation of the whole machine.

    Every cylinder counts at the angle of its crank; T is referred to the radius of crank 1, T_b is the share of the
    inertia forces in it. E is the excess of the work over that of the resistance, omega the speed under the load of
    FILE, which may depend on it.
    """
    from kurbel.report.turning import flywheel_report

    request.print(flywheel_report, spreads=spreads)


@click.command()
@machine_table
@uncertainty_option
@click.option("--places", "places_only", is_flag=True, help="Only the stresses place by place; as csv one line each.")
def stress(request: "Request", places_only: bool, spreads: Spreads) -> None:
    """Print the forces on the bearings of a crankshaft with one throw, and the stresses in pin, webs and journals.

    Stresses are listed for each place: in the dead centre under the full piston force, at the largest torque, and at
    the largest stress of the place over the whole cycle; combined after Bach (sigma_res) and after von Mises
    (sigma_v). FILE needs 'crankshaft', one cylinder and a pressure.
    """
    from kurbel.report.crank import stress_report

    request.print(stress_report, places_only, spreads=spreads)


@click.command()
@machine_table
@cases_option
def bearings(request: "Request") -> None:
    """Print the loads on crank pins, crosshead pins and main bearings over the cycle.

    The direction of each load is given in the frames of throw, engine and rod; key values are the largest, smallest
    and mean load, pressures, p v, and the arcs of the surfaces that are never loaded. Main bearings need 'crankshaft',
    whose throw is used for every throw of a machine with several. --cylinder takes the name of a pin or bearing.
    """
    from kurbel.report.crank import bearings_report

    request.print(bearings_report)


@click.command()
@machine_table
@click.option("--compare", is_flag=True, help="Also by the textbook formula cos phi + R/L cos 2phi (R 291).")
@click.option("--orders", "orders_only", is_flag=True, help="Only the tables of orders and weights, and key values.")
def balance(request: "Request", orders_only: bool) -> None:
    """Print the unbalanced forces and moments on the frame of FILE, and the counterweights against them.

    F_x is the unbalanced force along the stroke line of cylinder 1, outward from the shaft, F_y that across it, 90
    degrees on in the sense of rotation; M_x and M_y are their moments along the shaft; M_roll rolls the frame about
    it. Each order is a vector that turns with the crank and one that turns against it; an order that cancels is
    exactly 0. The best counterweights replace those of FILE.
    """
    from kurbel.report.balance import balance_report

    if orders_only and (given := request.given()):
        raise click.UsageError(f"--orders prints nothing over the crank angle; leave it or {' and '.join(given)} out.")
    request.print(balance_report, orders_only)


@click.command()
@machine_places
@orders_option
@speeds_option
def harmonics(request: "Request", orders: tuple[float, ...] | None, speeds: tuple[float, ...] | None) -> None:
    """Print the orders of the torque of every cylinder, and of the turning effort of the whole machine.

    Orders count periods per turn of the shaft, so that a four-stroke cycle has halves. They are integrated piece by
    piece between the corners of the cards. t is the tangential pressure |M|/(R A). Major orders are those in which all
    cranks pull together.
    """
    from kurbel.report.turning import harmonics_report

    request.print(harmonics_report, orders, speeds)


@click.command()
@machine_table
@cases_option
@orders_option
@speeds_option
@click.option(
    "--modes", type=click.IntRange(1, 100), default=3, help="Critical speeds of so many modes; 3 if not given."
)
@click.option("--mode", type=click.IntRange(1), help="The mode of Holzer's table; 1 if not given.")
@click.option(
    "--at",
    type=frequency,
    metavar="'F Hz'",
    help="Holzer's table at this frequency, with its residual torque, instead of a mode.",
)
def torsion(
    request: "Request",
    orders: tuple[float, ...] | None,
    speeds: tuple[float, ...] | None,
    modes: int,
    mode: int | None,
    at: float | None,
) -> None:
    """Print natural frequencies, Holzer's table, and critical speeds of the shaft line.

    Where damping and torques are given, also the steady vibration: torque and stress in every shaft segment at the
    working speed, all orders together, and at the critical speeds that the machine meets, with orders up to 24;
    --columns M_shaft,tau prints them over the crank angle. FILE needs 'shaft', or a 'coupling' behind a 'flywheel'.
    """
    from kurbel.report.turning import Wanted, torsion_report

    if mode is not None and at is not None:
        raise click.UsageError(
            "--mode and --at: Holzer's table is that of a mode or at a frequency; leave one of them out."
        )
    request.print(torsion_report, Wanted(orders, modes, mode or 1, speeds, at))


@click.command()
@machine_table
@cases_option
def delivery(request: "Request") -> None:
    """Print what the pumps and compressors of FILE deliver.

    Of pumps the flow over the crank angle, its mean and fluctuation, and the effect of air vessels and pipes; of
    compressors capacity, mass flow and temperature of every end and stage, by their ideal cards.
    """
    from kurbel.report.delivery import delivery_report

    request.print(delivery_report)
