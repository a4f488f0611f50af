"""Forms of mappings and lists: records, lists, alternatives, words that choose further keys, records inline.

A file is read in two passes: forms turn texts into numbers, words and lists, one `Given` for each mapping; then `Maker`
makes records of them.
"""

import functools
import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NoReturn

import numpy as np

from kurbel.arrays import Indivisible
from kurbel.declared.forms.values import TEXT, Choice, Form, NumberForm
from kurbel.declared.keys import TOO_EXTREME, Key, Record, required
from kurbel.declared.numerals import NUMBER
from kurbel.declared.reading import (
    REFUSED,
    Node,
    Plain,
    Reading,
    Tree,
    glued_hint,
    has_refused,
    is_nothing,
    kind_of,
    shown,
)
from kurbel.declared.units import MOST_ITEMS
from kurbel.errors import Path, RuleError, refused
from kurbel.near_words import did_you_mean, near
from kurbel.numerics.arithmetic import is_number


class RecordForm(Form):
    """A mapping that becomes a record. inline_too: another record also has its keys inline, so `places` skips it."""

    shape = dict

    def __init__(self, record: type[Record], inline_too: bool = False) -> None:
        self.record, self.inline_too, self.keys = record, inline_too, record.KEYS
        parts = ((name, key.form) for name, key in self.keys.items())
        super().__init__(f"a mapping with the keys {', '.join(self.keys)}", parts=parts)
        self.listed = next((form for _, form in self.parts if isinstance(form, Inline) and form.unless), None)

    def every_key(self) -> Iterator[tuple[str, Key]]:
        """Yield all keys that such a mapping can have, with those of inline records after the key that brings them."""
        for name, key in self.keys.items():
            yield name, key
            for record in key.form.inline:
                yield from record.every_key()

    def names(self, mapping: Tree) -> dict[str, None]:
        """Return the names of all keys that this mapping may have: its own, inline ones, those of the variant."""
        found = {name: None for name, key in self.keys.items() if not isinstance(key.form, Inline)}
        for name, key in self.keys.items():
            if isinstance(key.form, Inline) and key.form.unless not in mapping:
                found |= key.form.names(mapping)
            elif isinstance(key.form, Variant):
                for case in key.form.chosen(mapping.get(name)):
                    found |= case.names(mapping)
        return found

    def take(self, reading: Reading, value: Node, path: Path) -> Any:
        """Read the values of the keys of a mapping."""
        if not isinstance(value, dict):
            no_mapping(self, value)
        # a misspelt key counts as given but unreadable, so that it is not also reported as missing
        meant = dict.fromkeys(self._unknown(reading, value, path), REFUSED)
        return self.build(reading, value | meant, path)

    def build(self, reading: Reading, mapping: Tree, path: Path, inline: bool = False) -> "Given":
        """Read the keys of the record out of a mapping that may hold those of others."""
        own = [name for name, key in self.keys.items() if not isinstance(key.form, Inline)]
        rest = {name: value for name, value in mapping.items() if name not in own}
        missing = required(self.keys)
        values: dict[str, Any] = {}
        for name, key in self.keys.items():
            form = key.form
            if isinstance(form, Inline):
                if form.unless not in mapping and rest.keys() & form.names(mapping).keys():
                    values[name] = form.build(reading, rest, path, inline=True)
            elif isinstance(form, Variant):
                word = form.read(reading, mapping[name], (*path, name)) if name in mapping else form.default
                values[name] = word if word is REFUSED else form.cases[word].build(reading, rest, path, inline=True)
            elif name in mapping:
                values[name] = form.read(reading, mapping[name], (*path, name))
            elif name in missing:
                # a fault of an inline record points at one of its keys that is given
                beside = next((given for given in own if given in mapping), "") if inline else ""
                meaning = key.text[:1].lower() + key.text[1:]
                message = f"'{name}' is missing{' as well' if beside else ''}: {meaning}; {key.write(name)}"
                values[name] = reading.fault((*path, beside) if beside else path, message, bool(beside))
        return Given(self, mapping, path, values)

    def _unknown(self, reading: Reading, mapping: Tree, path: Path) -> Iterator[str]:
        """Note a fault for each unknown key and yield the known ones that were probably meant."""
        known = self.names(mapping)
        elsewhere = self._moved(mapping)
        other_words = {word: name for name, key in self.every_key() for word in (*key.also, key.symbol)}
        others = f"; valid keys here are {', '.join(known)}"
        for name in [name for name in mapping if name not in known]:
            home = self._as_here(reading.where_it_belongs(name, path), mapping)
            word = other_words.get(name, "")
            meant = word if word in known else near(name, tuple(known))
            if name in elsewhere:
                message, meant = elsewhere[name], ""
            elif name == "<<":
                message = (
                    "merging is not supported; write the keys themselves; a cylinder may be 'like: NAME' of another"
                )
            elif meant:
                message = f"unknown key; did you mean '{meant}'?"
                if home and meant == word:  # another name for one key, and the name of one elsewhere
                    message, meant = f"{message} Or {home}", ""
            elif home:
                message = f"does not belong here; {home}"
            else:
                message, others = f"unknown key{others}", ""
            reading.fault((*path, name), message, at_key=True)
            if meant and meant not in mapping:
                yield meant

    def _moved(self, mapping: Tree) -> dict[str, str]:
        """Return the keys that belong below another key of this mapping, each with the words where to move it."""
        moved = {
            inner: f"move it below '{name}'"
            for name, form in self.parts
            if isinstance(form, RecordForm) and form.inline_too
            for inner in form.names({})
        }
        if self.listed and self.listed.unless in mapping:
            unless = self.listed.unless
            there = f"'{unless}.each'" if isinstance(mapping[unless], dict) else f"the items of '{unless}'"
            moved |= dict.fromkeys(self.listed.names(mapping), f"belongs {self.listed.item}; move it into {there}")
        return moved

    def _as_here(self, words: str, mapping: Tree) -> str:
        """Return words for a place as seen from this mapping: that of a cylinder's key is in an item of 'cylinders'."""
        if self.listed and self.listed.unless in mapping:
            own, listed = self.listed.names(mapping), mapping[self.listed.unless]
            item = f"{self.listed.unless}.{'each' if isinstance(listed, dict) else 0}"
            for name in re.findall(r"under '(\w+)", words):
                words = words.replace(f"under '{name}", f"under '{item}.{name}") if name in own else words
        return words

    def flattened(self, error: RuleError, mapping: Tree) -> RuleError:
        """Return the faults of a record with the paths of its mapping, where keys of a list's items may be inline."""
        faults = list(error.faults)
        for place, fault in enumerate(faults):
            if self.listed and len(fault.path) > 1 and fault.path[0] == self.listed.unless:
                name, item, *inner = fault.path
                listed = mapping.get(self.listed.unless)
                head = () if listed is None else (name, "each" if isinstance(listed, dict) else item)
                faults[place] = fault._replace(path=(*head, *inner)) if isinstance(item, int) else fault
        return RuleError(*faults)

    def born(self, values: Tree) -> Any:
        """Return the record of these values of its keys; raises RuleError."""
        try:
            born = self.record.from_keys(**values)
        except ArithmeticError:
            refused(TOO_EXTREME)
        return refused(TOO_EXTREME) if too_extreme(born, values) else born


class Inline(RecordForm):
    """Keys of another record that stand in the same mapping: those of the piston in its cylinder.

    With the key `unless`, a list of such records, they stand in its items instead, or of equal ones below its `each`;
    rules of the outer record speak of an inline record as an item of that list.
    """

    def __init__(self, record: type[Record], unless: str = "") -> None:
        super().__init__(record)
        self.unless, self.item, self.inline = unless, f"to a {unless.removesuffix('s')}", (self,)


@dataclass(eq=False)
class Given:
    """What was read of a mapping, from which a record is made: its form, the values of its keys, and what became of it.

    values: by key, with others like it and tuples of them in place of records; mapping, path: where it was read.
    """

    form: RecordForm
    mapping: Tree
    path: Path
    values: dict[str, Any]
    made: Any = None


def no_mapping(form: Form, value: Node) -> NoReturn:
    """Raise RuleError for a value that is no mapping."""
    if isinstance(value, Plain) and not value:
        refused(f"no value here; write below it, indented, {form.expected}")
    refused(f"expected {form.expected}, got {kind_of(value)}{glued_hint(value)}")


def places(form: Form, path: str = "", words: str = "at the top of the file") -> Iterator[tuple[str, str]]:
    """Yield every key that may stand in a mapping of this form, each after the words for that mapping; path: of it."""
    if isinstance(form, RecordForm) and form.inline_too:
        return
    for name, inner in form.parts:
        if isinstance(inner, Inline):
            yield from places(inner, path, inner.item if inner.unless else words)
            continue
        below = f"{path}.{name}" if path and name else path or name
        if name:
            yield words, name
        if isinstance(inner, Variant):
            yield from ((f"to '{name}: {word}'", one) for word, case in inner.cases.items() for one in case.keys)
        yield from places(inner, below, f"under '{below}'" if name else words)


def records(form: Form, word: str) -> Iterator[tuple[str, RecordForm]]:
    """Yield the records that a key of this form leads to, each after the word that names it."""
    if isinstance(form, RecordForm):
        yield word, form
    elif isinstance(form, Variant):
        yield from ((f"{word}: {name}", case) for name, case in form.cases.items())
    for name, inner in () if isinstance(form, RecordForm) else form.parts:
        yield from records(inner, name or ("card" if isinstance(form, Keyed) else word))


def too_extreme(born: Any, values: Tree) -> Any:
    """Return whether, or where, a number of a record is not finite, nor infinite by a word or by default."""

    def numbers(of: Tree) -> dict[str, Any]:
        return {name: one for name, one in of.items() if is_number(one) or isinstance(one, np.ndarray)}

    meant: Any = functools.reduce(np.logical_or, (one == math.inf for one in numbers(values).values()), False)
    broken: Any = False
    for name, value in numbers(vars(born)).items():
        if isinstance(value, np.ndarray) and isinstance(born, Indivisible):
            continue
        endless = (value == math.inf) & (meant | (vars(type(born)).get(name) == math.inf))
        broken = broken | ~np.asarray(np.isfinite(value) | endless)
    return broken


class Maker:
    """The second pass: makes the records of what was read, and notes what is wrong with them."""

    def __init__(self, reading: Reading) -> None:
        self.reading = reading

    def made(self, value: Any) -> Any:
        """Return what a value that was read becomes; REFUSED after noting what is wrong with it."""
        if isinstance(value, Given):
            value.made = self._record(value)
            return value.made
        if isinstance(value, tuple) and any(isinstance(one, Given) for one in value):
            return tuple(map(self.made, value))
        return value

    def _record(self, given: Given) -> Any:
        path, form = given.path, given.form
        values = {name: self.made(one) for name, one in given.values.items()}
        try:
            if not any(one is REFUSED or (isinstance(one, tuple) and has_refused(one)) for one in values.values()):
                return form.born(values)
            # what is there contradicts the rest whether it could be read or not
            return self.reading.refuse(path, RuleError(*form.record.faults_of_keys(values)))
        except RuleError as error:
            return self.reading.refuse(path, form.flattened(error, given.mapping))


class Variant(Choice):
    """A word that decides which further keys the same mapping has, such as those of the mechanism."""

    def __init__(self, default: str, cases: dict[str, RecordForm], also: dict[str, str]) -> None:
        super().__init__(tuple(cases), also)
        self.default, self.cases, self.inline = default, cases, tuple(cases.values())

    def chosen(self, word: Node | None) -> Iterable[RecordForm]:
        """Return the record that a word chooses, or the default one; all of them where the word is unknown."""
        known = self.cases.get(self.default if word is None else word) if isinstance(word, (str, type(None))) else None
        return [known] if known else self.cases.values()


class Listing(Form):
    """A list of items of one form, at least one; becomes a tuple.

    called: given if an item may have `like: NAME`, which copies the keys of an item above; it is the word before the
    number of an item without a name, as in `cylinder 2`. Keys of the item itself override copied ones, also copied
    ones that give the same thing under another name (`stroke` overrides `crank`).
    """

    shape = list

    def __init__(self, item: Form, called: str = "") -> None:
        item_text = f"a list; each {item.written}"
        super().__init__("a list, each item after '- '", written=item_text, parts=[("", item)])
        self.item, self.kind, self.called = item, item.kind, called

    def take(self, reading: Reading, value: Node, path: Path) -> Any:
        """Read a list into a tuple, with REFUSED in place of what could not be read."""
        if isinstance(value, Plain) and not value:
            refused("no value here; write a list below it, each item after '- '")
        if not isinstance(value, list):
            refused(f"expected a list, each item after '- ', got {kind_of(value)}")
        if not value:
            refused("the list is empty; give at least one item or leave the key out")
        if len(value) > MOST_ITEMS:
            refused(f"{len(value)} items; no machine has more than {MOST_ITEMS} of them")
        whole = self._completed(reading, value, path) if self.called else value
        return tuple(self.item.read(reading, item, (*path, index)) for index, item in enumerate(whole))

    def _completed(self, reading: Reading, items: Sequence[Node], path: Path) -> list[Node]:
        """Return items with the keys that `like` copies; a fault in a copied key is reported once, at the original."""
        assert isinstance(self.item, RecordForm)
        pairs = [{name, key.instead} for name, key in self.item.every_key() if key.instead]
        above: dict[str, tuple[int, Tree]] = {}
        completed: list[Any] = []
        for index, item in enumerate(items):
            whole = item
            like = item.get("like", REFUSED) if isinstance(item, dict) else REFUSED
            if isinstance(item, dict) and isinstance(like, str) and like in above:
                place, other = above[like]
                here: Path = (*path, index)
                reading.alike[here] = (*path, place)
                own = {key: value for key, value in item.items() if key != "like"}
                replaced = {"name", *(key for pair in pairs if own.keys() & pair for key in pair)}
                whole = {key: value for key, value in other.items() if key not in replaced} | own
            elif like is not REFUSED:
                hint = did_you_mean(str(like), tuple(above)) or f"; above are {', '.join(map(shown, above))}"
                none_such = f"no {self.called} above this one is called '{shown(str(like))}'{hint if above else ''}"
                whole = reading.fault((*path, index, "like"), none_such)
            if isinstance(whole, dict):
                name = whole.get("name")
                above.setdefault(name if isinstance(name, str) else f"{self.called} {index + 1}", (index, whole))
            completed.append(whole)
        return completed


class OneOf(Form):
    """Several forms, which differ in shape (text, list, mapping) or are word and number; the first that fits reads."""

    def __init__(self, *forms: Form) -> None:
        expected = ", or ".join(form.expected for form in forms)
        written = " or ".join(form.written for form in forms)
        super().__init__(expected, forms[0].example, written, parts=[("", form) for form in forms])
        self.forms = forms
        self.kind = next((form.kind for form in forms if form.kind), "")
        self.number = next((form.number for form in forms if form.number), None)

    def take(self, reading: Reading, value: Node, path: Path) -> Any:
        """Read a value by the first form that has its shape."""
        words = [word for form in self.forms if isinstance(form, Choice) for word in form.words]
        keys = [key for form in self.forms if isinstance(form, RecordForm) for key in form.keys]
        for name in value if isinstance(value, dict) else ():
            if name in words and name not in keys:
                alone = f"- {name}" if isinstance(path[-1], int) else f"{path[-1]}: {name}"
                return reading.fault((*path, name), f"takes no value; write '{alone}'", at_key=True)
        shape = type(value) if isinstance(value, (dict, list)) else str
        alike = [form for form in self.forms if form.shape is shape]
        if alike:  # of a word and a number, the one that it looks like
            suiting = (form for form in alike if not (isinstance(form, Choice) and NUMBER.match(str(value))))
            return next(suiting, alike[0]).read(reading, value, path)
        return refused(f"expected {self.expected}, got {'nothing' if is_nothing(value) else kind_of(value)}")


class Keyed(Form):
    """A mapping with one key that decides its form, `{constant: …}` or `{trace: …}`; without one, `otherwise` reads it.

    texts: meanings of those deciding keys whose value is no mapping; beside: keys of their mappings that may also stand
    beside the deciding one.
    """

    shape = dict

    def __init__(
        self, cases: dict[str, Form], otherwise: RecordForm, texts: dict[str, str], beside: tuple[str, ...] = ()
    ) -> None:
        expected = f"{otherwise.expected}; or with one of {', '.join(cases)}"
        super().__init__(expected, parts=(*cases.items(), ("", otherwise)))
        self.cases, self.otherwise, self.beside = cases, otherwise, beside
        self.single = {name: Key(one, texts.get(name, "")) for name, one in cases.items() if one.shape is not dict}

    def take(self, reading: Reading, value: Node, path: Path) -> Any:
        """Read a mapping by the key that decides its form."""
        if not isinstance(value, dict):
            no_mapping(self, value)
        known, cases = self.otherwise.keys, self.cases
        telling = next((name for name in value if name in cases), "")
        if not telling:
            for name in value:
                if name not in known and (meant := near(name, (*known, *cases))) in cases:
                    return reading.fault((*path, name), f"unknown key; did you mean '{meant}'?", at_key=True)
            return self.otherwise.read(reading, value, path)
        inside = value[telling]
        if isinstance(inside, dict):
            case = cases[telling]
            keys = case.keys if isinstance(case, RecordForm) else {}
            moved = {name: value[name] for name in self.beside if name in value and name in keys and name not in inside}
            inside, value = {**inside, **moved}, {name: one for name, one in value.items() if name not in moved}
        for name in value:
            if name != telling:
                home = reading.where_it_belongs(name, path) or "leave it out"
                way_out = "leave one of them out" if name in known or name in cases else home
                reading.fault((*path, name), f"cannot be combined with '{telling}'; {way_out}", at_key=True)
        inner = cases[telling].read(reading, inside, (*path, telling))
        return inner if len(value) == 1 else REFUSED


def form_of(form: Any, bounds: Mapping[str, Any] = {}) -> Form:
    """Return the form of a key's value: a kind of quantity with its bounds, a type, words, a record, a list of one.

    bounds: `above`, `least`, `below`, `most` in SI, and `words` that stand for numbers.
    """
    if isinstance(form, str):
        return NumberForm(form, **bounds)
    if isinstance(form, tuple):
        return Choice(form)
    if isinstance(form, list):
        return Listing(form_of(form[0], bounds))
    if form is int:
        return NumberForm(whole=True, **{"least": 1, **bounds})
    if form is bool:
        return Choice(("true", "false"), means={"true": True, "false": False})
    if form is str:
        return TEXT
    return RecordForm(form) if isinstance(form, type) else form
