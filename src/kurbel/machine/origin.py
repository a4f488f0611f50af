"""What a machine was read from."""

from typing import NamedTuple


class Origin(NamedTuple):
    """A machine file as it was read: the name that messages show, its bytes, and what was set over it (`KEY=VALUE`)."""

    name: str
    content: bytes
    overrides: tuple[str, ...] = ()
