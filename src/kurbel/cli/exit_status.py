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


_OF_SOME = {
    BROKEN: ("kurbel", "check", "accuracy"),
    NO_SOLUTION: (
        *("kurbel", "forces", "flywheel", "stress", "bearings", "balance", "torsion"),
        *("plot", "check", "accuracy"),
    ),
}
"""Statuses that only some commands return."""


def exit_statuses(command: str) -> str:
    """Return the last sentence of the help of a command, or of `kurbel` itself."""
    return "Exit status: " + "; ".join(
        f"{status} {meaning}" for status, meaning in _MEANINGS.items() if command in _OF_SOME.get(status, (command,))
    )
