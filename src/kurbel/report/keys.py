"""The keys of the machine file, from their declarations: a line each, or one in full."""

from collections.abc import Callable, Iterable, Iterator
from typing import NamedTuple

from kurbel.declared.forms.structures import Inline, Keyed, Listing, RecordForm, Variant, records
from kurbel.declared.forms.values import Form
from kurbel.declared.keys import Key, absent_text
from kurbel.declared.reading import text_in_one_line
from kurbel.errors import UsageError
from kurbel.machine import Machine
from kurbel.near_words import near
from kurbel.tables.sources import legend


class ListedKey(NamedTuple):
    """A key with its dotted path, what holds without it, alternatives to it, and the word that it belongs to."""

    path: str
    key: Key
    absent: str
    others: tuple[str, ...] = ()
    beside: str = ""

    @property
    def line(self) -> str:
        """What is written, what it means, and what holds without it."""
        return f"{self._form}: {self.key.description}" + (
            f"; {self.absent}" if self.key.required else ""
        )

    @property
    def full(self) -> list[tuple[str, str]]:
        """All about the key, each after its head."""
        key = self.key
        item = key.form.item if isinstance(key.form, Listing) else None
        inner = (
            _of_record(item, self.path, _is_any)
            if isinstance(item, RecordForm)
            else _below(key.form, self.path, _is_any)
        )
        name = self.path.rpartition(".")[2]
        below = dict.fromkeys(one.path.removeprefix(f"{self.path}.") for one in inner)
        found = {
            "with": self.beside,
            "meaning": key.text.replace("`", ""),
            "symbol": key.symbol,
            "form": self._form,
            "usual": key.usual,
            "absent": self.absent or "left out",
            "or give": key.instead or ", ".join(self.others),
            "needs": key.needs,
            "example": key.line(name),
            "below it": ", ".join(below),
            "source": legend([key.text, key.usual]),
        }
        return [(head, text) for head, text in found.items() if text]

    @property
    def _form(self) -> str:
        return self.key.written.replace("`", "").replace("\t", "\\t")


Places = dict[str, list[ListedKey]]
"""Keys by their dotted paths."""


def _is_any(word: str) -> bool:
    return True


def every_place(is_wanted: Callable[[str], bool] = _is_any) -> Places:
    """Return every key of a machine file by its dotted path, once for each mechanism that has it.

    Those of a cylinder are at the top. is_wanted: takes a key, or the word of a mechanism, and returns whether what is
    below it is listed, too.
    """
    places: Places = {}
    for key in _of_record(RecordForm(Machine), "", is_wanted):
        places.setdefault(key.path, []).append(key)
    return places


def places_of(texts: Iterable[tuple[str, str]]) -> Places:
    """Return the keys that a file may have below those that it has; texts: the paths of its keys, and the values."""
    words = set[str]()
    for path, value in texts:
        words.update(_steps(path), [value])
    return every_place(words.__contains__)


def described(path: str) -> list[tuple[str, str]]:
    """Return heads with their texts: the key at a dotted path, as messages and `--set` write it; or the keys below it.

    Raises UsageError if there are none.
    """
    if not path.strip(". "):
        raise UsageError("no key is named; 'kurbel keys' without one lists them all")
    places, steps = every_place(), _steps(path)
    # keys of a cylinder and of a piston are listed at the top
    inner = steps[1 + (steps[1:2] == ["each"]) :] if steps[0] in ("cylinders", "tandem") else steps
    for name in (".".join(steps), ".".join(inner)):
        if found := places.get(name):
            return [line for one in found for line in one.full]
        if below := [
            (each, ones[0].line) for each, ones in places.items() if each.startswith(f"{name}.")
        ]:
            return below
    above = dict.fromkeys(
        name[:end] for name in places for end, sign in enumerate(f"{name}.") if sign == "."
    )
    last = {name: name.rpartition(".")[2] for name in above}
    meant = steps[-1] if steps[-1] in last.values() else near(steps[-1], tuple(last.values()))
    there = [name for name in above if last[name] == meant]
    hint = (
        f"; it is at {', '.join(there)}"
        if meant == steps[-1]
        else f"; did you mean {' or '.join(map(repr, there))}?"
    )
    raise UsageError(
        f"no key '{text_in_one_line(path)}'{hint if there else ''} ('kurbel keys' lists them)"
    )


def meaning(path: str, places: Places) -> str:
    """Return what the key at the end of a path means, as the file has it; '' if it is not known."""
    steps = _steps(path)
    above = next((k for k in range(len(steps)) if ".".join(steps[k:]) in places), None)
    if above is None:
        return ""
    found = places[".".join(steps[above:])]
    every = [
        one for one in found if not one.beside
    ] or found  # of the machine, of a cylinder, of a piston
    record = 2 if "tandem" in steps[:above] else min(above, 1)
    return every[min(record, len(every) - 1)].key.text.replace("`", "")


def _steps(path: str) -> list[str]:
    return [
        step for step in path.replace("[", ".").replace("]", "").split(".") if not step.isdecimal()
    ]


def _of_record(
    record: RecordForm, path: str, is_wanted: Callable[[str], bool], beside: str = ""
) -> Iterator[ListedKey]:
    for name, key in record.keys.items():
        form = key.form
        if not isinstance(form, Inline):
            here = f"{path}.{name}" if path else name
            others = tuple(other for other, one in record.keys.items() if one.instead == name)
            yield ListedKey(here, key, absent_text(record.keys, name), others, beside)
            if is_wanted(name):
                yield from _below(form, here, is_wanted)
        if isinstance(form, Variant):
            chosen = [word for word in form.cases if is_wanted(word)] or [form.default]
            for word in chosen:
                yield from _of_record(form.cases[word], path, is_wanted, f"{name}: {word}")
        elif form.inline:
            for _, inner in records(form, name):
                yield from _of_record(inner, path, is_wanted)


def _below(form: Form, path: str, is_wanted: Callable[[str], bool]) -> Iterator[ListedKey]:
    """Yield the keys below a key of this form."""
    if isinstance(form, RecordForm):
        yield from () if form.inline_too else _of_record(form, path, is_wanted)
        return
    if isinstance(form, Keyed):
        for name, key in form.single.items():
            yield ListedKey(f"{path}.{name}", key, key.absent)
    if not form.inline:
        for name, inner in form.parts:
            if not name:
                yield from _below(inner, path, is_wanted)
            elif is_wanted(name):
                yield from _below(inner, f"{path}.{name}", is_wanted)
