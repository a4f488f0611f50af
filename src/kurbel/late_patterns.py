"""Regular expressions that are compiled when they are first used, not when their module is imported.

yaml compiles ten for its reader in Python and for the types that it would guess, and one of them, a set of characters,
takes longer than any machine file takes to be read; libyaml, which reads here, needs none. What click imports compiles
a dozen more, most of them to tell by which system Python runs. A run needs a few of them all.
"""

import re
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

_compile = re.compile


class LatePattern:
    """Stands for a regular expression and becomes it when it is asked for anything."""

    def __init__(self, *arguments: Any) -> None:
        self._arguments = arguments

    def __getattr__(self, name: str) -> Any:
        """Return what the compiled expression has under this name."""
        return getattr(_compile(*self._arguments), name)  # re keeps what it has compiled


@contextmanager
def late_patterns() -> Iterator[None]:
    """Have `re.compile` return late patterns, where no other thread could come by one."""
    if threading.active_count() == 1:
        re.compile = LatePattern  # type: ignore[assignment]
    try:
        yield
    finally:
        re.compile = _compile
