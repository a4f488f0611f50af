"""Which parts of the whole report are wanted: sections by their words, and what every command has of a kind."""

from collections.abc import Sequence
from typing import NamedTuple

from kurbel.declared.reading import text_in_one_line
from kurbel.errors import UsageError
from kurbel.near_words import did_you_mean
from kurbel.report.commands import REPORTS

ALL, ANSWERS, PICTURES, TABLES = "all", "answers", "pictures", "tables"
ENERGY, LEFT_OUT, INPUT = "energy", "left-out", "input"
SHORT = (ANSWERS, INPUT)
"""The sections of a short report."""
SECTIONS = (
    ANSWERS,
    PICTURES,
    *(command.word for command in REPORTS),
    ENERGY,
    TABLES,
    LEFT_OUT,
    INPUT,
    ALL,
)
"""Words of sections, as they are chosen; a command has its pictures and answers."""


class Contents(NamedTuple):
    """The parts of a report after its first page; words: of `SECTIONS`, none for all that there are."""

    words: tuple[str, ...] = ()

    @classmethod
    def of(cls, words: Sequence[str]) -> "Contents":
        """Return the contents of these words. Raises UsageError for a word that is none of a section."""
        for word in words:
            if word not in SECTIONS:
                raise UsageError(
                    f"--sections: there is no section '{text_in_one_line(word)}'"
                    f"{did_you_mean(word, SECTIONS)} (there are {', '.join(SECTIONS)})"
                )
        return cls(tuple(words))

    @property
    def prints_tables(self) -> bool:
        """Whether the tables over the crank angle are named, so that they are printed, too."""
        return TABLES in self.words or ALL in self.words

    def has(self, word: str) -> bool:
        """Return whether a section is wanted."""
        return not self.words or ALL in self.words or word in self.words

    def has_answers(self, command: str) -> bool:
        """Return whether key values and tables of a command are wanted."""
        return self.has(command) or self.has(ANSWERS)

    def has_pictures(self, command: str) -> bool:
        """Return whether the pictures of a command are wanted."""
        return self.has(command) or self.has(PICTURES)

    def has_table(self, command: str) -> bool:
        """Return whether the table over the crank angle is wanted: that of named commands, or of all."""
        named_commands = [other.word for other in REPORTS if other.word in self.words]
        is_of_all = not named_commands or self.has(ANSWERS)
        return self.has(TABLES) and (is_of_all or self.has(command))
