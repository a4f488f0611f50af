"""The machines that come with kurbel."""

import os

_PACKAGE = os.path.dirname(os.path.abspath(__file__))
# a wheel carries the machines inside the package; a checkout has them next to src
_PLACES = (
    os.path.join(_PACKAGE, "configs"),
    os.path.join(_PACKAGE, os.pardir, os.pardir, "configs"),
)


MODELINE = "# yaml-language-server: $schema=./kurbel.schema.json\n"
"""First line of a machine file by which an editor finds what `kurbel schema` has written next to it."""


def file_of(name: str) -> str:
    """Return the path of a shipped machine."""
    folder = next(filter(os.path.isdir, _PLACES))
    return os.path.join(folder, f"{name}.yaml")


def shipped() -> dict[str, str]:
    """Return the machines that come with kurbel: the text of each file by its name."""
    folder = next(filter(os.path.isdir, _PLACES))
    names = sorted(
        name.removesuffix(".yaml") for name in os.listdir(folder) if name.endswith(".yaml")
    )
    texts = {}
    for name in names:
        with open(file_of(name), encoding="utf-8") as file:
            texts[name] = file.read()
    return texts
