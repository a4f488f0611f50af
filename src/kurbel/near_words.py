"""What was probably meant by a misspelt word."""

from __future__ import annotations

_LONGEST = 40  # characters of a word worth comparing


def near(word: str, known: tuple[str, ...]) -> str:
    """Return the known word that is most like this one, or ''."""
    from difflib import get_close_matches

    if len(word) > _LONGEST:
        return ""
    lower = word.lower().replace("-", "_").replace(" ", "_")
    alike = {name.lower().replace("-", "_"): name for name in known}
    found = get_close_matches(lower, list(alike), n=1, cutoff=0.7)
    return alike[found[0]] if found else ""


def did_you_mean(word: str, known: tuple[str, ...]) -> str:
    """Return '; did you mean …?' where a known word is near, or ''.

    >>> did_you_mean("froces", ("table", "forces"))
    "; did you mean 'forces'?"
    """
    found = near(word, known)
    return f"; did you mean '{found}'?" if found else ""
