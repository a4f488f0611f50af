"""What the exit statuses mean, for the help of every command."""

from __future__ import annotations

DONE, BROKEN, WRONG, NO_SOLUTION, INTERNAL, INTERRUPTED = 0, 1, 2, 3, 70, 130

_MEANINGS = {
    DONE: "done",
    BROKEN: "a limit is broken (check) or a case failed (accuracy --extremes)",
    WRONG: "wrong usage or input, or the output cannot be written",
    NO_SOLUTION: "no solution: the machine stalls, locks itself or is in resonance",
    INTERNAL: "a fault in kurbel",
    INTERRUPTED: "interrupted",
}


def exit_statuses(*own: int) -> str:
    """Return the last sentence of a help: the statuses of every command, and those that only some return."""
    return "Exit status: " + "; ".join(
        f"{status} {meaning}" for status, meaning in _MEANINGS.items() if status in own or status not in _OF_SOME
    )


_OF_SOME = (BROKEN, NO_SOLUTION)
