"""What a shell completes: shipped machines, columns, cylinders, keys; each is looked up when TAB is pressed."""

from collections.abc import Iterable

import click

from kurbel.errors import KurbelError


def _beginning(words: Iterable[str], begun: str, before: str = "") -> list[str]:
    return [before + word for word in words if word.startswith(begun)]


def complete_key(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
    """Return the keys of the machine file that begin like this."""
    from kurbel.report.keys import every_place

    return _beginning(every_place(), incomplete)


def complete_kind(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
    """Return the kinds of quantities that begin like this."""
    from kurbel.declared.units import kinds

    return _beginning(kinds(), incomplete)


def complete_override(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
    """Return the keys for `KEY=VALUE`, each with its equals sign; of a value nothing."""
    return [] if "=" in incomplete else [f"{key}=" for key in complete_key(ctx, param, incomplete)]


def complete_columns(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
    """Return the columns of the command that may follow those named already."""
    from kurbel.quantities import every_quantity

    named, comma, begun = incomplete.rpartition(",")
    known = [one for one in every_quantity().columns(ctx.info_name or "") if one not in named.split(",")]
    return _beginning(known, begun, named + comma)


def complete_example(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
    """Return the shipped machines that begin like this."""
    from kurbel.cli.example import shipped_names

    return _beginning(shipped_names(), incomplete)


def complete_cylinder(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
    """Return the cylinders of the machine file that stands on the line; none where it cannot be read."""
    from kurbel.machine_file import load

    file = next(iter(ctx.args), "")  # a line that ends in an option is not read to its end
    try:
        machine = load(file) if file and file != "-" else None
    except KurbelError:
        return []
    return _beginning((one.name for one in machine.cylinders), incomplete) if machine else []


def complete_picture(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
    """Return the pictures that begin like this."""
    from kurbel.report.pictures import PICTURES

    return _beginning((*(one.id for one in PICTURES), "all"), incomplete)
