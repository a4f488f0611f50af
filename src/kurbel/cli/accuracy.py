"""`kurbel accuracy`: error against run time, and the check on stiff and extreme cases."""

from typing import TYPE_CHECKING

import click

from kurbel.cli.output_options import Output, loaded, output_options, set_option

if TYPE_CHECKING:
    from kurbel.accuracy.inexact import Difference
    from kurbel.machine import Machine


@click.command()
@click.argument("file", metavar="[FILE]", required=False, type=click.Path(allow_dash=True))
@set_option
@click.option("--quick", is_flag=True, help="Fewer scenes, points and repeats: for CI.")
@click.option("--extremes", is_flag=True, help="Put stiff and extreme machines to kurbel instead.")
@click.option("--plot", "picture", metavar="FILE.svg|png|pdf", help="Draw the picture too.")
@output_options
def accuracy(
    file: str | None, overrides: tuple[str, ...], quick: bool, extremes: bool, picture: str | None, output: Output
) -> int:
    """Compare kurbel's own methods with others, quantity by quantity: error, time, and what went wrong.

    Without FILE for built-in scenes, with FILE for that machine (- for standard input). References have 40 digits
    and come from other methods than kurbel's. Numerical errors, errors of the model (the formulas of the book) and
    errors of the data (0.1 deg of dead centre, 0.5 % noise, what the file gives as 'uncertainty') stand apart; the last
    section says what leaving out saves.
    """
    if overrides and file is None:
        raise click.UsageError("--set sets a value over that of FILE; give the FILE.")
    if extremes:
        return _extremes(file, picture, output)
    from kurbel.render.drawing import check_file, draw_file

    if picture is not None:
        check_file(picture, "--plot")
    from kurbel.machine_file import loads
    from kurbel.report.accuracy import accuracy_report

    machine = None if file is None else loaded(file, overrides, output.file_name, picture)
    report = accuracy_report(machine, quick, loads, _uncertain(machine))
    output.write(report)
    if picture is not None:
        from kurbel.report.accuracy_picture import accuracy_picture

        draw_file([accuracy_picture(report)], output.look, picture)
    return 0


def _uncertain(machine: "Machine | None") -> "tuple[Difference, ...]":
    if not (machine and machine.uncertainty):
        return ()
    from kurbel.designs.uncertainty import data_uncertainty

    return data_uncertainty(machine)


def _extremes(file: str | None, picture: str | None, output: Output) -> int:
    if file is not None or picture is not None:
        raise click.UsageError("--extremes has its own machines and no picture; leave FILE and --plot out.")
    from kurbel.machine_file import loads
    from kurbel.report.accuracy import extremes_report

    report, passed = extremes_report(loads)
    output.write(report)
    return int(not passed)
