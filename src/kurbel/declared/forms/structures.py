"""Forms of mappings and lists: records (also inline), lists, alternatives, words that choose further keys.

A file is read in two passes: first, forms turn texts into numbers, words and lists, and each mapping into a `ReadMapping`;
then `Maker` (`making`) makes records of these.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from typing import Any, NoReturn, Union

from kurbel.declared.forms.values import TEXT, Choice, Form, NumberForm
from kurbel.declared.keys import Key, Keys, Record, required
from kurbel.declared.numerals import NUMBER, keyboard_text
from kurbel.declared.reading import (
    REFUSED,
    Node,
    Plain,
    Reading,
    Tree,
    glued_hint,
    is_nothing,
    node_kind,
    text_in_one_line,
)
from kurbel.declared.units import MOST_ITEMS
from kurbel.errors import Path, RuleError, path_text, refused
from kurbel.near_words import did_you_mean, near

Door = Callable[[], type[Record]]
"""A function with one import inside, that of the record it returns; it is called when the first mapping is read."""


class RecordForm(Form):
    """A mapping that becomes a record. inline_too: the outer mapping may have its keys, too, so `key_places` skips it.

    record: the class, or a door to it, which is opened when a file has such a mapping, or asks for its keys.
    """

    shape = dict
    example, written, schema = "…", "a mapping", {}

    def __init__(self, record: type[Record] | Door, inline_too: bool = False) -> None:
        self._door: Door = (lambda: record) if isinstance(record, type) else record
        self.inline_too = inline_too

    @cached_property
    def record(self) -> type[Record]:
        """The class of the record."""
        return self._door()

    @property
    def keys(self) -> Keys:
        """Its keys by name."""
        return self.record.KEYS

    @cached_property
    def expected(self) -> str:
        """For 'expected …'."""
        return f"a mapping with the keys {', '.join(self.keys)}"

    @cached_property
    def parts(self) -> tuple[tuple[str, Form], ...]:
        """The forms of its keys."""
        return tuple((name, key.form) for name, key in self.keys.items())

    @cached_property
    def listed(self) -> "Inline | None":
        """The form of the keys of an item of a list that may be here instead."""
        for _, form in self.parts:
            if isinstance(form, Inline) and form.unless:
                return form
        return None

    def names(self, mapping: Tree) -> Keys:
        """Return all keys that this mapping may have: its own, inline ones, those of the variant."""
        keys = {name: key for name, key in self.keys.items() if not isinstance(key.form, Inline)}
        for name, key in self.keys.items():
            if isinstance(key.form, Inline) and key.form.unless not in mapping:
                keys |= key.form.names(mapping)
            elif isinstance(key.form, Variant):
                for case in key.form.chosen(mapping.get(name)):
                    keys |= case.names(mapping)
        return keys

    def unwritten(self) -> dict[str, str]:
        """Return words for what no key describes, those of inline records too, each with what to write instead."""
        advice = dict(self.record.UNWRITTEN)
        for key in self.keys.values():
            if isinstance(key.form, Inline):
                advice |= key.form.unwritten()
        return advice

    def take(self, reading: Reading, value: Node, path: Path) -> object:
        """Read the values of the keys of a mapping."""
        if not isinstance(value, dict):
            no_mapping(self, value)
        # a misspelt key counts as given but unreadable, so that it is not also reported as missing
        meant = dict.fromkeys(self._unknown(reading, value, path), REFUSED)
        return self.build(reading, value | meant, path)

    def build(
        self, reading: Reading, mapping: Tree, path: Path, inline: bool = False
    ) -> "ReadMapping":
        """Read the keys of this record from a mapping that may also have keys of other records."""
        own_names = [name for name, key in self.keys.items() if not isinstance(key.form, Inline)]
        rest = {name: value for name, value in mapping.items() if name not in own_names}
        required_names = required(self.keys, mapping)
        values: dict[str, object] = {}
        for name, key in self.keys.items():
            form = key.form
            if isinstance(form, Inline):
                is_written = bool(rest.keys() & form.names(mapping))
                if is_written and form.unless not in mapping:
                    values[name] = form.build(reading, rest, path, inline=True)
            elif isinstance(form, Variant):
                word = form.read(reading, mapping.get(name, form.default), (*path, name))
                values[name] = REFUSED
                if word is not REFUSED:
                    values[name] = form.cases[word].build(reading, rest, path, inline=True)
            elif name in mapping:
                values[name] = form.read(reading, mapping[name], (*path, name))
            elif name in required_names:
                present = [own_name for own_name in own_names if own_name in mapping]
                near_key = present[0] if present and inline else ""
                values[name] = self._missing(reading, name, path, near_key)
        return ReadMapping(self, mapping, path, values)

    def _missing(self, reading: Reading, name: str, path: Path, near_key: str) -> object:
        """Report that a key is missing; near_key: of an inline record, a key that is present, where the fault points."""
        key = self.keys[name]
        meaning = key.text[:1].lower() + key.text[1:]
        as_well = " as well" if near_key else ""
        message = f"'{name}' is missing{as_well}: {meaning}; {key.write(name)}"
        if near_key:
            return reading.fault((*path, near_key), message, at_key=True)
        return reading.fault(path, message)

    def _unknown(self, reading: Reading, mapping: Tree, path: Path) -> Iterator[str]:
        """Report each unknown key, and yield the valid keys that were probably meant."""
        keys = self.names(mapping)
        moved = self.moved(mapping)
        unwritten = self.unwritten()
        # other words and symbols of the keys
        synonyms: dict[str, str] = {}
        for name, key in keys.items():
            synonyms |= dict.fromkeys((*key.also, key.symbol), name)
        # all valid keys are listed once
        valid_keys = f"; valid keys here are {', '.join(keys)}"
        for name in mapping:
            if name in keys:
                continue
            if name in unwritten:
                reading.fault((*path, name), f"unknown key; {unwritten[name]}", at_key=True)
                continue
            belongs = moved.get(name) or reading.where_it_belongs(name, path)
            meant = ""
            if name not in moved:
                meant = synonyms.get(name) or synonyms.get(name.lower()) or near(name, tuple(keys))
            if meant:
                message = f"unknown key; did you mean '{meant}'?"
                # a synonym of a key here may be the name of a key elsewhere
                if belongs and name in synonyms:
                    message = f"{message} Or {belongs}"
                    meant = ""
            elif belongs:
                message = f"does not belong here; {belongs}"
            else:
                message = f"unknown key{valid_keys}"
                valid_keys = ""
            reading.fault((*path, name), message, at_key=True)
            if meant and meant not in mapping:
                yield meant

    def moved(self, mapping: Tree) -> dict[str, str]:
        """Return the keys that belong below another key of this mapping, each with the message where to move it."""
        moved: dict[str, str] = {}
        for name, form in self.parts:
            if isinstance(form, RecordForm) and form.inline_too:
                moved |= dict.fromkeys(form.names({}), f"move it below '{name}'")
        if self.listed and self.listed.unless in mapping:
            list_key = self.listed.unless
            target = f"the items of '{list_key}'"
            if isinstance(mapping[list_key], dict):
                target = f"'{list_key}.each'"
            advice = f"it belongs {self.listed.item}; move it into {target}"
            moved |= dict.fromkeys(self.listed.names(mapping), advice)
        return moved

    def flattened(self, error: RuleError, mapping: Tree) -> RuleError:
        """Return the error with the paths of this mapping, where keys of an item may be below `each` or inline."""
        if self.listed is None:
            return error
        list_key = self.listed.unless
        items = mapping.get(list_key)
        faults = []
        for fault in error.faults:
            is_in_item = len(fault.path) > 1 and isinstance(fault.path[1], int)
            if is_in_item and fault.path[0] == list_key:
                path = fault.path
                if items is None:
                    path = path[2:]
                elif isinstance(items, dict):
                    path = (list_key, "each", *path[2:])
                fault = fault._replace(path=path)
            faults.append(fault)
        return RuleError(*faults)


class Inline(RecordForm):
    """The keys of another record, written in the same mapping: those of the piston in its cylinder.

    unless: the key of a list of such records. If it is given, their keys are in its items instead (or below its `each`,
    if all are equal). In both cases the rules of the outer record refer to an item of that list.
    """

    def __init__(self, record: type[Record], unless: str = "") -> None:
        super().__init__(record)
        self.unless = unless
        self.item = f"to a {unless.removesuffix('s')}"
        self.inline = (self,)


class ReadMapping:
    """A mapping after the first pass: all that its record is made from.

    mapping, path: what was read, and where; values: by key, with a `ReadMapping` where there will be a record; made: the
    record, after the second pass.
    """

    def __init__(
        self, form: RecordForm, mapping: Tree, path: Path, values: dict[str, object]
    ) -> None:
        self.form = form
        self.mapping = mapping
        self.path = path
        self.values = values
        self.made: Any = None

    def with_value(self, name: str, value: object) -> "ReadMapping":
        """Return it with another value of a key."""
        return ReadMapping(self.form, self.mapping, self.path, {**self.values, name: value})


def no_mapping(form: Form, value: Node) -> NoReturn:
    """Raise RuleError for a value that is no mapping."""
    if isinstance(value, Plain) and not value:
        refused(f"no value here; write below it, indented, {form.expected}")
    refused(f"expected {form.expected}, got {node_kind(value)}{glued_hint(value)}")


def key_places(
    form: Form, path: Path = (), words: str = "at the top of the file"
) -> Iterator[tuple[str, Path, str]]:
    """Yield (description, path, key) for every key below a mapping of this form; both are of the key's mapping."""
    if isinstance(form, RecordForm) and form.inline_too:
        return
    for name, inner in form.parts:
        if isinstance(inner, Inline):
            inner_words = inner.item if inner.unless else words
            yield from key_places(inner, path, inner_words)
            continue
        if not name:
            yield from key_places(inner, path, words)
            continue
        yield words, path, name
        if isinstance(inner, Variant):
            for word, case in inner.cases.items():
                for key in case.keys:
                    yield f"to '{name}: {word}'", (), key
        below: Path = (*path, name)
        yield from key_places(inner, below, f"under '{path_text(below)}'")


def records(form: Form, word: str) -> Iterator[tuple[str, RecordForm]]:
    """Yield (name, form) of every record that the value of a key of this form may be; word: the key."""
    if isinstance(form, RecordForm):
        yield word, form
        return
    if isinstance(form, Variant):
        for name, case in form.cases.items():
            yield f"{word}: {name}", case
    word_without_key = "card" if isinstance(form, Keyed) else word
    for name, inner in form.parts:
        yield from records(inner, name or word_without_key)


class Variant(Choice):
    """A word that decides which further keys the same mapping has, such as those of the mechanism."""

    def __init__(self, default: str, cases: dict[str, RecordForm], also: dict[str, str]) -> None:
        super().__init__(tuple(cases), also)
        self.default = default
        self.cases = cases
        self.inline = tuple(cases.values())

    def chosen(self, word: Node | None) -> Iterable[RecordForm]:
        """Return the form that a word chooses, the default one without a word, or all forms if it is unknown."""
        if word is None:
            return [self.cases[self.default]]
        if isinstance(word, str) and word in self.cases:
            return [self.cases[word]]
        return self.cases.values()


class Listing(Form):
    """A list of items of one form, at least one; becomes a tuple.

    called: given if an item may have `like: NAME`, which copies the keys of an earlier item; items without a name are
    called by this word and their number, as in `cylinder 2`. An item's own keys replace copied ones, including those
    that give the same quantity by another key (`stroke` replaces `crank`). most: number of items.
    """

    shape = list

    def __init__(self, item: Form, called: str = "", most: int = MOST_ITEMS) -> None:
        item_text = f"a list; each {item.written}"
        super().__init__("a list, each item after '- '", written=item_text, parts=[("", item)])
        self.item = item
        self.kind = item.kind
        self.called = called
        self.most = most

    def take(self, reading: Reading, value: Node, path: Path) -> object:
        """Read a list into a tuple, with REFUSED in place of what could not be read."""
        if isinstance(value, Plain) and not value:
            refused("no value here; write a list below it, each item after '- '")
        if isinstance(value, dict) and self.is_item(value):
            item = ", ".join(f"{key}: …" for key in value)
            refused(f"expected a list, got one of its items; write '{path[-1]}: [{{{item}}}]'")
        if not isinstance(value, list):
            refused(f"expected a list, each item after '- ', got {node_kind(value)}")
        if not value:
            refused("the list is empty; give at least one item or leave the key out")
        if len(value) > self.most:
            refused(f"{len(value)} items; no machine has more than {self.most} of them")
        items = self._completed(reading, value, path) if self.called else value
        return tuple(
            self.item.read(reading, item, (*path, index)) for index, item in enumerate(items)
        )

    def is_item(self, mapping: Tree) -> bool:
        """Return whether a mapping that is given in the place of the list has the keys of one of its items."""
        if not isinstance(self.item, RecordForm) or not mapping:
            return False
        return mapping.keys() <= self.item.names(mapping).keys()

    def _completed(self, reading: Reading, items: Sequence[Node], path: Path) -> list[Node]:
        """Return items with the keys that `like` copies; an error in a copied key is reported once, at the original."""
        above: dict[str, int] = {}  # names of the items so far, with their indices
        completed: list[Any] = list(items)
        for index, item in enumerate(items):
            if not isinstance(item, dict):
                continue
            # the keys that it copies
            if "like" in item:
                here: Path = (*path, index)
                original_name = str(item["like"])
                if original_name not in above:
                    message = self._none_above(original_name, tuple(above))
                    completed[index] = reading.fault((*here, "like"), message)
                    continue
                original = above[original_name]
                reading.alike[here] = (*path, original)
                completed[index] = self._copy(completed[original], item)
            # its name, by which later items may copy it
            name = completed[index].get("name")
            if not isinstance(name, str):
                name = f"{self.called} {index + 1}"
            above.setdefault(name, index)
        return completed

    def _none_above(self, name: str, names_above: tuple[str, ...]) -> str:
        """Return the message on `like` with a name that no item above has."""
        hint = did_you_mean(name, names_above)
        if names_above and not hint:
            hint = f"; above are {', '.join(map(text_in_one_line, names_above))}"
        return f"no {self.called} above this one is called '{text_in_one_line(name)}'{hint}"

    def _copy(self, original: Tree, item: Tree) -> Tree:
        """Return the keys of an item that is `like` another one: copied keys, except those that its own replace."""
        assert isinstance(self.item, RecordForm)
        own_keys = {key: value for key, value in item.items() if key != "like"}
        replaced = {"name"}
        for name, key in self.item.names(original | own_keys).items():
            if key.instead and (name in own_keys or key.instead in own_keys):
                replaced |= {name, key.instead}
        copied = {key: value for key, value in original.items() if key not in replaced}
        return copied | own_keys


class Nested(Form):
    """A list within an item of another list, of the same items: a branch in a shaft line.

    outer: returns the form of the outer list, which does not exist yet when its items are declared. It has no parts of
    its own, so that what walks over all keys meets those of the items once.
    """

    shape = list

    def __init__(self, outer: Callable[[], Listing], written: str) -> None:
        super().__init__("a list, each item after '- '", written=written)
        self.outer = outer

    def take(self, reading: Reading, value: Node, path: Path) -> object:
        """Read a list as the outer one."""
        return self.outer().take(reading, value, path)


class OneOf(Form):
    """Several forms: the first that has the shape of a value (text, list, mapping) and suits what a text looks like.

    A text is a word, a number with its unit, or a bare number.
    """

    def __init__(self, *forms: Form) -> None:
        self.forms = forms
        self.example = forms[0].example
        self.schema = {}
        self.parts = tuple(("", form) for form in forms)
        self.written = " or ".join(form.written for form in forms)
        # its number and its kind are those of the form that has one
        self.kind = next((form.kind for form in forms if form.kind), "")
        numbers = [form.number for form in forms if form.number]
        self.number = numbers[0] if len(numbers) == 1 else None
        self.unread = next((form.unread for form in forms if form.unread is not None), None)

    @cached_property
    def expected(self) -> str:
        """For 'expected …'."""
        return ", or ".join(form.expected for form in self.forms)

    def take(self, reading: Reading, value: Node, path: Path) -> object:
        """Read a value by the first form that has its shape."""
        if isinstance(value, dict):
            words = self._words_without_value()
            for name in value:
                if name in words:
                    alone = f"- {name}" if isinstance(path[-1], int) else f"{path[-1]}: {name}"
                    message = f"takes no value; write '{alone}'"
                    return reading.fault((*path, name), message, at_key=True)
            listing = self._list_of(value)
            if listing is not None:
                return listing.read(reading, value, path)
        fitting = self._fitting(value)
        if fitting:
            return fitting[0].read(reading, value, path)
        node = "nothing" if is_nothing(value) else node_kind(value)
        return refused(f"expected {self.expected}, got {node}")

    def _words_without_value(self) -> set[str]:
        """Return the words of these forms that are no keys of a record among them."""
        words: set[str] = set()
        keys: set[str] = set()
        for form in self.forms:
            if isinstance(form, Choice):
                words.update(form.words)
            elif isinstance(form, RecordForm):
                keys.update(form.keys)
        return words - keys

    def _list_of(self, mapping: Tree) -> "Listing | None":
        """Return the list, among these forms, of which a mapping is an item; None if it is no item.

        A record that has its keys, or knows below which of its own they belong, says more about them.
        """
        for form in self.forms:
            if isinstance(form, RecordForm):
                keys_of_record = {*form.keys, *form.moved(mapping)}
                if mapping.keys() & keys_of_record:
                    return None
        for form in self.forms:
            if isinstance(form, Listing) and form.is_item(mapping):
                return form
        return None

    def kind_as_written(self, value: Node | None) -> str:
        """Return the kind of the number that is written in this way."""
        return next((form.kind for form in self._fitting(value) if form.kind), self.kind)

    def _fitting(self, value: Node | None) -> list[Form]:
        """Return the forms that have the shape of a value, or look like it; all of its shape if none does."""
        shape = type(value) if isinstance(value, (dict, list)) else str
        alike = [form for form in self.forms if form.shape is shape]
        text = keyboard_text(value) if isinstance(value, str) else ""
        suiting = [form for form in alike if not (isinstance(form, Choice) and NUMBER.match(text))]
        bare = NUMBER.fullmatch(text) is not None
        of_the_number = [form for form in suiting if (form.kind == "ratio") == bare]
        return of_the_number or suiting or alike


class Keyed(Form):
    """A mapping with one key that decides its form, `{constant: …}` or `{trace: …}`; without one, `otherwise` reads it.

    texts: meanings of those deciding keys whose value is no mapping; beside: keys of their mappings that may also be
    given next to the deciding key.
    """

    shape = dict

    def __init__(
        self,
        cases: dict[str, Form],
        otherwise: RecordForm,
        texts: dict[str, str],
        beside: tuple[str, ...] = (),
    ) -> None:
        expected = f"{otherwise.expected}; or with one of {', '.join(cases)}"
        super().__init__(expected, parts=(*cases.items(), ("", otherwise)))
        self.cases = cases
        self.otherwise = otherwise
        self.beside = beside
        self.single = {
            name: Key(form, texts.get(name, ""))
            for name, form in cases.items()
            if form.shape is not dict
        }

    def take(self, reading: Reading, value: Node, path: Path) -> object:
        """Read a mapping by the key that decides its form."""
        if not isinstance(value, dict):
            no_mapping(self, value)
        deciding = next((name for name in value if name in self.cases), "")
        if not deciding:
            return self._without_case(reading, value, path)
        case = self.cases[deciding]
        inside = value[deciding]
        # keys of its mapping that are written next to it
        moved: Tree = {}
        if isinstance(inside, dict) and isinstance(case, RecordForm):
            for name in self.beside:
                if name in case.keys and name in value and name not in inside:
                    moved[name] = value[name]
            inside = {**inside, **moved}
        # what is left contradicts it
        others = [name for name in value if name != deciding and name not in moved]
        for name in others:
            if name in self.otherwise.keys or name in self.cases:
                advice = "leave one of them out"
            else:
                advice = reading.where_it_belongs(name, path) or "leave it out"
            message = f"cannot be combined with '{deciding}'; {advice}"
            reading.fault((*path, name), message, at_key=True)
        inner = case.read(reading, inside, (*path, deciding))
        return REFUSED if others else inner

    def _without_case(self, reading: Reading, mapping: Tree, path: Path) -> object:
        """Read a mapping without a key that decides its form, unless such a key is only misspelt."""
        keys = self.otherwise.keys
        for name in mapping:
            if name in keys:
                continue
            meant = near(name, (*keys, *self.cases))
            if meant in self.cases:
                message = f"unknown key; did you mean '{meant}'?"
                return reading.fault((*path, name), message, at_key=True)
        return self.otherwise.read(reading, mapping, path)


Likeness = Union[str, type, Door, tuple[str, ...], list["Likeness"], Form]
"""What a form may be declared by: see `form_of`."""


def form_of(form: Likeness, bounds: Mapping[str, Any] = {}) -> Form:
    """Return the form of a key's value: a kind of quantity with its bounds, a type, words, a record, a list of one.

    A record may be behind a door.

    bounds: `above`, `least`, `below`, `most` in SI, and `words` that mean numbers.
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
    if isinstance(form, Form):
        return form
    return RecordForm(form)
