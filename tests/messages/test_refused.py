"""What is refused, by every command and in every file, with its status and its words: the cases of `refused.yaml`.

Among them are those that are nearly the same and are not refused, and what is left out or noted.
"""

import re
import shlex
from pathlib import Path
from typing import NamedTuple

import pytest
import yaml

from command import run
from representative import CONFIGS

SUBJECTS: dict[str, list[dict[str, object]]] = yaml.safe_load(
    Path(__file__).with_name("refused.yaml").read_text("utf-8")
)


class Refusal(NamedTuple):
    """A command, the text of a machine file on its standard input, and what its output says and does not say."""

    command: str = "check -"
    input: str | None = None
    status: int = 2
    says: tuple[str, ...] = ()
    says_not: tuple[str, ...] = ()

    @classmethod
    def read(cls, keys: dict[str, object]) -> "Refusal":
        """Return the case of these keys of the file; one sentence needs no list."""
        assert keys.keys() <= {"command", "input", "status", "says", "not"}
        rest = {key: value for key, value in keys.items() if key not in ("says", "not")}
        return cls(says=_sentences(keys.get("says")), says_not=_sentences(keys.get("not")), **rest)

    def failures(self) -> list[str]:
        """Run the command, and return in which respects its status and its output differ from these."""
        result = run(*shlex.split(self.command), text=self.input)
        output = " ".join((result.stderr + result.stdout).split())
        failures = [f"does not say: {words}" for words in self.says if words not in output]
        failures += [f"says: {words}" for words in self.says_not if words in output]
        if result.exit_code != self.status:
            failures.append(f"status {result.exit_code}")
        if re.search("Traceback|\x1b", output):
            failures.append("a traceback, or an escape sequence")
        if failures:
            failures = [self.command, self.input or "", output, *failures]
        return failures


def _sentences(value: object) -> tuple[str, ...]:
    """Return the sentences of a key: one, a list, or none."""
    if isinstance(value, str):
        return (value,)
    return tuple(value) if isinstance(value, list) else ()


@pytest.mark.parametrize("subject", SUBJECTS)
def test_what_is_refused_and_with_which_words(
    subject: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(CONFIGS["waterworks"].parent)
    files = sorted(Path().iterdir())
    failures = [Refusal.read(keys).failures() for keys in SUBJECTS[subject]]
    assert [failure for failure in failures if failure] == []
    assert sorted(Path().iterdir()) == files
