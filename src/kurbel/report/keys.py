"""The keys of the machine file, from their declarations: a line each, or one in full."""

from collections.abc import Callable, Iterable, Iterator
from itertools import chain
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
        absent = f"; {self.absent}" if self.key.required else ""
        return f"{self._form}: {self.key.description}{absent}"

    @property
    def full(self) -> list[tuple[str, str]]:
        """All about the key, each after its head."""
        key = self.key
        item = key.form.item if isinstance(key.form, Listing) else None
        if isinstance(item, RecordForm):
            inner = _of_record(item, self.path, _is_any)
        else:
            inner = _below(key.form, self.path, _is_any)
        name = self.path.rpartition(".")[2]
        below = dict.fromkeys(listed.path.removeprefix(f"{self.path}.") for listed in inner)
        texts = {
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
        return [(head, text) for head, text in texts.items() if text]

    @property
    def _form(self) -> str:
        return self.key.written.replace("`", "").replace("\t", "\\t")


KeyPlaces = dict[str, list[ListedKey]]
"""Keys by their dotted paths."""


def _is_any(word: str) -> bool:
    return True


def every_place(is_wanted: Callable[[str], bool] = _is_any) -> KeyPlaces:
    """Return every key of a machine file by its dotted path, once for each mechanism that has it.

    Those of a cylinder are at the top. is_wanted: takes a key, or the word of a mechanism, and returns whether what is
    below it is listed, too.
    """
    keys_by_path: KeyPlaces = {}
    for listed in _of_record(RecordForm(Machine), "", is_wanted):
        keys_by_path.setdefault(listed.path, []).append(listed)
    return keys_by_path


def places_of(texts: Iterable[tuple[str, str]]) -> KeyPlaces:
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
    listed_keys, steps = every_place(), _steps(path)
    # keys of a cylinder and of a piston are listed at the top
    inner = steps
    if steps[0] in ("cylinders", "tandem"):
        inner = steps[2:] if steps[1:2] == ["each"] else steps[1:]
    for name in (".".join(steps), ".".join(inner)):
        if name in listed_keys:
            return list(chain.from_iterable(listed.full for listed in listed_keys[name]))
        below = [
            (key_path, listed[0].line)
            for key_path, listed in listed_keys.items()
            if key_path.startswith(f"{name}.")
        ]
        if below:
            return below
    raise UsageError(
        f"no key '{text_in_one_line(path)}'{_hint(steps[-1], listed_keys)} ('kurbel keys' lists them)"
    )


def _hint(name: str, listed_keys: Iterable[str]) -> str:
    """Return where a key of this name is, or which of a similar name may be meant, with all that are above keys."""
    paths = dict[str, str]()  # of keys and of what is above them, with their last names
    for path in listed_keys:
        steps = path.split(".")
        for count in range(1, len(steps) + 1):
            paths[".".join(steps[:count])] = steps[count - 1]
    last_names = tuple(paths.values())
    meant = name if name in last_names else near(name, last_names)
    similar = [path for path, last in paths.items() if last == meant]
    if not similar:
        return ""
    if meant == name:
        return f"; it is at {', '.join(similar)}"
    return f"; did you mean {' or '.join(map(repr, similar))}?"


def meaning(path: str, keys_by_path: KeyPlaces) -> str:
    """Return what the key at the end of a path means, as the file has it; '' if it is not known."""
    steps = _steps(path)
    for above in range(len(steps)):
        listed = keys_by_path.get(".".join(steps[above:]))
        if listed:
            break
    else:
        return ""
    # of the machine, of a cylinder, of a piston
    of_records = [key for key in listed if not key.beside] or listed
    record = 2 if "tandem" in steps[:above] else min(above, 1)
    return of_records[min(record, len(of_records) - 1)].key.text.replace("`", "")


def _steps(path: str) -> list[str]:
    return [
        step for step in path.replace("[", ".").replace("]", "").split(".") if not step.isdecimal()
    ]


def _of_record(
    record: RecordForm, path: str, is_wanted: Callable[[str], bool], beside: str = ""
) -> Iterator[ListedKey]:
    """Yield the keys of a record at a path, and those below the wanted ones."""
    for name, key in record.keys.items():
        form = key.form
        if not isinstance(form, Inline):
            key_path = f"{path}.{name}" if path else name
            others = tuple(
                other for other, other_key in record.keys.items() if other_key.instead == name
            )
            yield ListedKey(key_path, key, absent_text(record.keys, name), others, beside)
            if is_wanted(name):
                yield from _below(form, key_path, is_wanted)
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
        if not form.inline_too:
            yield from _of_record(form, path, is_wanted)
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
