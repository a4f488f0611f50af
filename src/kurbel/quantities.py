"""Every quantity that kurbel prints, from the classes that compute them: for limits, sweeps, JSON and the reference.

`every_quantity` opens every chapter and mechanism. A name that a file or an option gives is looked up in `KEY_VALUES`
or `COLUMNS`, which go from chapter to chapter and open no more of them than the name needs.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache, cached_property

from kurbel.mechanisms import KeyOffer, Offer
from kurbel.mechanisms.kinds import KINDS
from kurbel.quantity import (
    Lists,
    Meanings,
    Quantity,
    by_id,
    called,
    refuse_other_meanings,
    rejoined_names,
)
from kurbel.solver.case import CHAPTERS, Chapter
from kurbel.solver.figures import doors_of, result_rows
from kurbel.solver.forces import CylinderForces


@cache
def every_quantity() -> Lists:
    """Return all quantities that any machine may have; one that several classes declare is listed for each.

    Raises TypeError for an id that has two meanings.
    """
    offers, key_offers = dict[Offer, None](), dict[KeyOffer, None]()
    for door in KINDS.values():
        mechanism = door()
        offers |= dict.fromkeys(mechanism.OFFERS)
        key_offers |= dict.fromkeys(mechanism.KEY_OFFERS)
    columns: list[Quantity] = []
    key_values: list[Quantity] = []
    meanings_of_columns: Meanings = {}
    meanings_of_key_values: Meanings = {}
    for chapter in CHAPTERS:
        if chapter.kind is CylinderForces:
            rows = result_rows(chapter.kind, tuple(offers), tuple(key_offers))
        else:
            rows = result_rows(chapter.kind)
        lists, owner = rows.lists, chapter.kind.__name__
        refuse_other_meanings(meanings_of_columns, lists.all_columns, owner, with_sentence=False)
        refuse_other_meanings(meanings_of_key_values, lists.all_key_values, owner)
        columns += lists.all_columns
        key_values += lists.all_key_values
    return Lists(tuple(columns), tuple(key_values))


class ByChapter(Mapping[str, Quantity]):
    """Quantities by id; one that an early chapter has is found without opening the later ones.

    of: takes lists of quantities and returns those that are meant, columns or key values.
    """

    def __init__(self, of: Callable[[Lists], tuple[Quantity, ...]]) -> None:
        self._of = of
        self._lists: dict[Chapter, Mapping[str, Quantity]] = {}

    def __getitem__(self, id: str) -> Quantity:
        return self.of_chapter_with(id)[id]

    def of_chapter_with(self, id: str) -> Mapping[str, Quantity]:
        """Return all quantities of the first chapter that has this one; raises KeyError if none has it."""
        if id.isidentifier():
            for quantities in self._chapter_by_chapter():
                if id in quantities:
                    return quantities
        raise KeyError(id)

    def __iter__(self) -> Iterator[str]:
        return iter(self._all)

    def __len__(self) -> int:
        return len(self._all)

    @cached_property
    def _all(self) -> Mapping[str, Quantity]:
        return by_id(*self._of(every_quantity()))

    def _chapter_by_chapter(self) -> Iterator[Mapping[str, Quantity]]:
        """Yield the quantities of each chapter, without those of mechanisms and of parts behind doors; then all."""
        for chapter in CHAPTERS:
            if chapter not in self._lists:
                rows = result_rows(chapter.kind, closed=doors_of(chapter.kind))
                self._lists[chapter] = by_id(*self._of(rows.lists))
            yield self._lists[chapter]
        yield self._all

    def ids_of(self, name: str) -> tuple[str, ...]:
        """Return the ids of the quantities that a name may mean, see `called`; for an id nothing else is opened."""
        if name in self:
            return (name,)
        return called(name, self.values())

    def commands_of(self, id: str) -> Iterator[str]:
        """Yield the commands that have a quantity, each once; the one whose own it is first."""
        yielded = set[str]()
        for quantities in self._chapter_by_chapter():
            if id not in quantities:
                continue
            for command in quantities[id].commands:
                if command not in yielded:
                    yielded.add(command)
                    yield command

    def names_of(self, words: Iterable[str]) -> list[str]:
        """Return names that were split at their commas as they were before, see `rejoined_names`; with or without a prefix."""
        names = list(words)
        are_ids = all(name.rpartition(".")[2] in self for name in names)
        if are_ids:
            return names
        return list(rejoined_names(names, self.values()))


KEY_VALUES = ByChapter(lambda lists: lists.all_key_values)
"""All key values."""
COLUMNS = ByChapter(lambda lists: tuple(column for column in lists.all_columns if column.commands))
"""All columns that a command prints."""


def key_values_of(command: str, names: Iterable[str]) -> dict[str, Quantity]:
    """Return the key values of a command by id: of its own chapters if these have all the names, else all."""
    quantities = key_values_of_chapters(command)
    if all(name in quantities for name in names):
        return quantities
    return every_quantity().key_values(command)


def key_values_of_chapters(command: str) -> dict[str, Quantity]:
    """Return the key values of a command by id: of its own chapters, and of cylinders; no other one is opened."""
    quantities = list[Quantity]()
    for chapter in CHAPTERS:
        if chapter.command in (CylinderForces.command, command):
            rows = result_rows(chapter.kind, closed=doors_of(chapter.kind))
            quantities += rows.lists.all_key_values
    return Lists((), tuple(quantities)).key_values(command)
