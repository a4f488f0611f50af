"""The known word that a misspelt word probably means."""

_OTHER_FIRST_LETTER = 0.85
"""Least similarity of a word with another first letter, which is rarely misspelt: 'direction' is not 'friction'."""
_LONGEST = 40  # characters of a word worth comparing


def near(word: str, known: tuple[str, ...]) -> str:
    """Return the known word that is most similar, or ''."""
    if len(word) > _LONGEST:
        return ""
    from difflib import get_close_matches  # of messages only

    lower = word.lower().replace("-", "_").replace(" ", "_")
    alike = {name.lower().replace("-", "_"): name for name in known}
    found = get_close_matches(lower, list(alike), n=3, cutoff=0.7)
    cutoff = _OTHER_FIRST_LETTER
    found = [
        one
        for one in found
        if one[:1] == lower[:1] or get_close_matches(lower, [one], cutoff=cutoff)
    ]
    return alike[found[0]] if found else ""


def did_you_mean(word: str, known: tuple[str, ...]) -> str:
    """Return '; did you mean …?' if a known word is similar, or ''.

    >>> did_you_mean("froces", ("table", "forces"))
    "; did you mean 'forces'?"
    """
    found = near(word, known)
    return f"; did you mean '{found}'?" if found else ""
