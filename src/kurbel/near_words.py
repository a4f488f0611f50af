"""The known word that a misspelt word probably means."""

_OTHER_FIRST_LETTER = 0.85
"""Least similarity of a word with another first letter, which is rarely misspelt: 'direction' is not 'friction'."""
_LONGEST = 40  # characters of a word worth comparing


def near(word: str, words: tuple[str, ...]) -> str:
    """Return the one of these words that is most similar, or ''."""
    if len(word) > _LONGEST:
        return ""
    from difflib import get_close_matches  # of messages only

    lower = word.lower().replace("-", "_").replace(" ", "_")
    by_lower = {name.lower().replace("-", "_"): name for name in words}
    for similar in get_close_matches(lower, list(by_lower), n=3, cutoff=0.7):
        is_alike = similar[:1] == lower[:1]
        if is_alike or get_close_matches(lower, [similar], cutoff=_OTHER_FIRST_LETTER):
            return by_lower[similar]
    return ""


def did_you_mean(word: str, words: tuple[str, ...]) -> str:
    """Return '; did you mean …?' if one of these words is similar, or ''.

    >>> did_you_mean("froces", ("table", "forces"))
    "; did you mean 'forces'?"
    """
    similar = near(word, words)
    if not similar:
        return ""
    return f"; did you mean '{similar}'?"
