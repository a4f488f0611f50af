"""`kurbel example`: the machines that come with kurbel."""

import os

import click

from kurbel.cli.completion import complete_example
from kurbel.errors import UsageError

_PACKAGE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
# a wheel carries the machines inside the package; in a checkout they lie beside src, where people look for them
_PLACES = (os.path.join(_PACKAGE, "configs"), os.path.join(_PACKAGE, os.pardir, os.pardir, "configs"))
_SUFFIX = ".yaml"


@click.command()
@click.argument("name", required=False, shell_complete=complete_example)
@click.option("--output", "-o", "file_name", metavar="FILE", help="Write to this file instead of standard output.")
def example(name: str | None, file_name: str | None) -> None:
    """List the machines that come with kurbel, or print the file of the machine NAME.

    \b
      kurbel example waterworks > engine.yaml
      kurbel example waterworks | kurbel forces -
    """
    from kurbel.render.output import write_out
    from kurbel.render.page import write_entries

    if name is None:
        write_entries([(each, _described(each)) for each in shipped_names()], file_name)
    else:
        write_out((_read(_known(name)),), file_name, "utf-8")


def _folder() -> str:
    return next(filter(os.path.isdir, _PLACES))


def shipped_names() -> tuple[str, ...]:
    """Return the names of the machines that come with kurbel."""
    return tuple(sorted(file[: -len(_SUFFIX)] for file in os.listdir(_folder()) if file.endswith(_SUFFIX)))


def _known(name: str) -> str:
    from kurbel.near_words import did_you_mean

    bare, names = name.removesuffix(_SUFFIX), shipped_names()
    if bare not in names:
        raise UsageError(f"no example '{name}'{did_you_mean(bare, names)} (known: {', '.join(names)})")
    return bare


def _read(name: str) -> str:
    with open(os.path.join(_folder(), name + _SUFFIX), encoding="utf-8") as file:
        return file.read()


def _described(name: str) -> str:
    """Return the first comment line of the file of a machine."""
    return _read(name).partition("\n")[0].lstrip("# ")
