"""Every worked example that kurbel can compute: its machine file, to the digits of an independent recalculation.

`answers.yaml` beside this file says which output has its figures, or why none has.
"""

import re
from typing import Any

import pytest

from command import run
from representative import few
from worked_examples import COMPUTED, FILES, FOLDER, TABLE, expected, printed_answer

EXAMPLES = list(dict.fromkeys(row["file"] for row in COMPUTED))
# the question, but for its numbers, and the first example that has it
KINDS = {re.sub(r"\d", "", row["ask"]): row["file"] for row in reversed(COMPUTED)}


@pytest.mark.parametrize("file", few(EXAMPLES, dict.fromkeys(KINDS.values())))
def test_it_answers(file: str) -> None:
    for row in COMPUTED:
        if row["file"] == file:
            check(row)


def check(row: dict[str, Any]) -> None:
    answered = printed_answer(row)
    if "back" in row:
        assert str(row.get("strict", row["exact"])) in (FOLDER / f"{row['file']}.yaml").read_text(
            encoding="utf-8"
        )
        assert answered == pytest.approx(row["back"], rel=1e-11, abs=1e-7), row["of"]
        return
    answered = answered if isinstance(answered, list) else [answered]
    wanted, unit_of_last = expected(row)
    assert len(answered) == len(wanted), row["of"]
    for value, figure, last in zip(answered, wanted, unit_of_last):
        assert value == pytest.approx(figure, rel=0, abs=0.51 * last), row["of"]


def test_every_figure_has_an_answer_or_a_reason() -> None:
    assert all(TABLE.values())
    for row in (row for rows in TABLE.values() for row in rows):
        assert ("ask" in row) != ("reason" in row), row["of"]
        strict = row.get("strict")
        # another g or a finer search changes no more than that; a slip of the recalculation would
        assert strict is None or strict == pytest.approx(row["exact"], rel=1e-2), row["of"]


def test_none_of_the_78_examples_is_missing() -> None:
    """51 and 28, of which SK12.1 and KMD32.4 are in both lists, and the branched shaft of Friswell 9.6.3."""
    assert "FR-9.6.3" in TABLE
    assert len(TABLE) == 51 + 28 - 2 + 1


@pytest.mark.parametrize("file", few(FILES, FILES[::6]))
def test_every_machine_file_is_valid_and_of_an_example(file: str) -> None:
    assert file in TABLE or file in {row["file"] for row in COMPUTED}
    result = run("check", FOLDER / f"{file}.yaml")
    assert (result.exit_code, result.stderr) == (0, "")
