"""Every quantity that kurbel prints, from the classes that compute them: for limits, sweeps, JSON and the reference.

`every_quantity` opens every chapter and mechanism. A name that a file or an option gives is looked up in `KEY_VALUES`,
which goes from chapter to chapter and opens no more of them than the name needs.
"""

from collections.abc import Iterator, Mapping
from functools import cache

from kurbel.mechanisms.kinds import KINDS
from kurbel.quantity import Lists, Quantity, by_id
from kurbel.solver.case import CHAPTERS, Chapter
from kurbel.solver.figures import doors_of, rows_of
from kurbel.solver.forces import CylinderForces


@cache
def every_quantity() -> Lists:
    """Return all quantities that any machine may have; one that several classes declare is listed for each."""
    mechanisms = [door() for door in KINDS.values()]
    offers = tuple(dict.fromkeys(offer for mechanism in mechanisms for offer in mechanism.OFFERS))
    key_offers = tuple(dict.fromkeys(offer for mechanism in mechanisms for offer in mechanism.KEY_OFFERS))
    columns: list[Quantity] = []
    key_values: list[Quantity] = []
    for chapter in CHAPTERS:
        rows = rows_of(chapter.kind, offers, key_offers) if chapter.kind is CylinderForces else rows_of(chapter.kind)
        columns += rows.lists.all_columns
        key_values += rows.lists.all_key_values
    return Lists(tuple(columns), tuple(key_values))


@cache
def _behind_no_door(chapter: Chapter) -> Mapping[str, Quantity]:
    """Return the key values of a chapter, by id, without those of its parts behind doors, and of mechanisms."""
    return by_id(*rows_of(chapter.kind, closed=doors_of(chapter.kind)).lists.all_key_values)


@cache
def _every_key_value() -> Mapping[str, Quantity]:
    return by_id(*every_quantity().all_key_values)


def _chapter_by_chapter() -> Iterator[Mapping[str, Quantity]]:
    """Yield the key values of one chapter after the other, as far as they are behind no other door; then all."""
    for chapter in CHAPTERS:
        yield _behind_no_door(chapter)
    yield _every_key_value()


class KeyValues(Mapping[str, Quantity]):
    """All key values by id; one that an early chapter has is found without opening the later ones."""

    def __getitem__(self, id: str) -> Quantity:
        if id.isidentifier():
            for quantities in _chapter_by_chapter():
                if id in quantities:
                    return quantities[id]
        raise KeyError(id)

    def __iter__(self) -> Iterator[str]:
        return iter(_every_key_value())

    def __len__(self) -> int:
        return len(_every_key_value())

    def commands_of(self, id: str) -> Iterator[str]:
        """Yield the commands that have a key value, each once; the one whose own it is first."""
        yielded = set[str]()
        for quantities in _chapter_by_chapter():
            if id not in quantities:
                continue
            for command in quantities[id].commands:
                if command not in yielded:
                    yielded.add(command)
                    yield command


KEY_VALUES = KeyValues()
