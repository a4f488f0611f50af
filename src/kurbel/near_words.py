"""What was probably meant by a misspelt word."""

from difflib import get_close_matches

_OTHERWISE = 0.85
_LONGEST = 40  # characters of a word worth comparing


def near(word: str, known: tuple[str, ...]) -> str:
    """Return the known word that is most like this one, or ''."""
    if len(word) > _LONGEST:
        return ""
    lower = word.lower().replace("-", "_").replace(" ", "_")
    alike = {name.lower().replace("-", "_"): name for name in known}
    found = get_close_matches(lower, list(alike), n=3, cutoff=0.7)
    # few slip at the first letter: what begins otherwise must be all the more alike ('direction' is no 'friction')
    found = [one for one in found if one[:1] == lower[:1] or get_close_matches(lower, [one], cutoff=_OTHERWISE)]
    return alike[found[0]] if found else ""


def did_you_mean(word: str, known: tuple[str, ...]) -> str:
    """Return '; did you mean …?' where a known word is near, or ''.

    >>> did_you_mean("froces", ("table", "forces"))
    "; did you mean 'forces'?"
    """
    found = near(word, known)
    return f"; did you mean '{found}'?" if found else ""
