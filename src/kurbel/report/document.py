"""What a long report is made of: sections of tables, pictures and sentences, whatever it will be rendered as."""

from typing import NamedTuple, Union

from kurbel.report.picture import Picture
from kurbel.report.tables import Provenance, Report


class Grid(NamedTuple):
    """A table of texts; numbers, units: which of its columns are that; verdicts: which rows are good, and which bad."""

    title: str
    heads: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    numbers: tuple[int, ...] = ()
    units: tuple[int, ...] = ()
    verdicts: tuple[str, ...] = ()


class Pair(NamedTuple):
    """A picture of each of two machines, None of one that does not have it."""

    left: Picture | None
    right: Picture | None


Item = Union[str, Grid, Report, Picture, Pair]


class Section(NamedTuple):
    """A section: its word in links, its title, and its items."""

    id: str
    title: str
    items: tuple[Item, ...]


class Document(NamedTuple):
    """A report on one machine, or on several next to one another."""

    title: str
    provenance: tuple[Provenance, ...]
    sections: tuple[Section, ...]
