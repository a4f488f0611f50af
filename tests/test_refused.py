"""What is refused, by every command and in every file: `refused.txt` has the line, its status, and what is said; and
beside it what is nearly the same and is not refused, what is left out, and what is noted. " … " stands between words
of which each is said, and `not:` before those that are not."""

import re
import shlex
from pathlib import Path

import pytest

from command import run
from representative import CONFIGS

PARTS = Path(__file__).with_name("refused.txt").read_text("utf-8").split("\n# ")


def told(line: str) -> str:
    """Status and message of a line; <<< stands before the text of a machine file, \\x00 for a character."""
    words = [
        re.sub(r"\\x(..)", lambda code: chr(int(code[1], 16)), word)
        for word in shlex.split(line)[2:]
    ]
    text = words.pop() if "<<<" in words else None
    result = run(*[word for word in words if word != "<<<"], text=text)
    assert not re.search("Traceback|\x1b", result.output)
    return f"{result.exit_code} {' '.join((result.stderr + result.stdout).split())}"


def fits(words: str, found: str) -> bool:
    return all(
        (one.removeprefix("not: ") in found) != one.startswith("not: ")
        for one in words.split(" … ")
    )


@pytest.mark.parametrize("part", PARTS, ids=[part.partition("\n")[0].strip("# ") for part in PARTS])
def test_what_is_refused_and_with_which_words(part: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(CONFIGS["waterworks"].parent)
    there = sorted(Path().iterdir())
    asked = re.findall(r"^(\$ .+)\n(\d) (.+)$", part, re.MULTILINE)
    assert len(asked) == part.count("\n$ ")
    found = [(line, status, words, told(line)) for line, status, words in asked]
    assert [one for one in found if not (one[3].startswith(one[1]) and fits(one[2], one[3]))] == []
    assert sorted(Path().iterdir()) == there
