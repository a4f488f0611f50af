"""Forms of mappings and lists: records (also inline), lists, alternatives, words that choose further keys.

A file is read in two passes: first, forms turn texts into numbers, words and lists, and each mapping into a `ReadMapping`;
then `Maker` makes records of these.
"""

import functools
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NoReturn, Union

import numpy as np

from kurbel.arrays import Indivisible, Truth
from kurbel.declared.forms.values import TEXT, Choice, Form, NumberForm
from kurbel.declared.keys import TOO_EXTREME, Key, Keys, Record, required
from kurbel.declared.numerals import NUMBER, keyboard_text
from kurbel.declared.reading import (
    REFUSED,
    Node,
    Plain,
    Reading,
    Tree,
    glued_hint,
    has_refused,
    is_nothing,
    node_kind,
    text_in_one_line,
)
from kurbel.declared.units import MOST_ITEMS
from kurbel.errors import NotANumber, Path, RuleError, path_text, refused
from kurbel.near_words import did_you_mean, near
from kurbel.numerics.arithmetic import is_number

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
        return next(
            (form for _, form in self.parts if isinstance(form, Inline) and form.unless), None
        )

    def names(self, mapping: Tree) -> Keys:
        """Return all keys that this mapping may have: its own, inline ones, those of the variant."""
        found = {name: key for name, key in self.keys.items() if not isinstance(key.form, Inline)}
        for name, key in self.keys.items():
            if isinstance(key.form, Inline) and key.form.unless not in mapping:
                found |= key.form.names(mapping)
            elif isinstance(key.form, Variant):
                for case in key.form.chosen(mapping.get(name)):
                    found |= case.names(mapping)
        return found

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
        own = [name for name, key in self.keys.items() if not isinstance(key.form, Inline)]
        rest = {name: value for name, value in mapping.items() if name not in own}
        missing = required(self.keys)
        values: dict[str, object] = {}
        for name, key in self.keys.items():
            form = key.form
            if isinstance(form, Inline):
                if form.unless not in mapping and rest.keys() & form.names(mapping):
                    values[name] = form.build(reading, rest, path, inline=True)
            elif isinstance(form, Variant):
                word = (
                    form.read(reading, mapping[name], (*path, name))
                    if name in mapping
                    else form.default
                )
                values[name] = (
                    word
                    if word is REFUSED
                    else form.cases[word].build(reading, rest, path, inline=True)
                )
            elif name in mapping:
                values[name] = form.read(reading, mapping[name], (*path, name))
            elif name in missing:
                # the error of an inline record points at one of its keys that is given
                present = next((given for given in own if given in mapping), "") if inline else ""
                meaning = key.text[:1].lower() + key.text[1:]
                message = f"'{name}' is missing{' as well' if present else ''}: {meaning}; {key.write(name)}"
                values[name] = reading.fault(
                    (*path, present) if present else path, message, bool(present)
                )
        return ReadMapping(self, mapping, path, values)

    def _unknown(self, reading: Reading, mapping: Tree, path: Path) -> Iterator[str]:
        """Report each unknown key, and yield the known keys that were probably meant."""
        known, moved = self.names(mapping), self.moved(mapping)
        unwritten = self.unwritten()
        synonyms = {word: name for name, key in known.items() for word in (*key.also, key.symbol)}
        others = f"; valid keys here are {', '.join(known)}"
        for name in [name for name in mapping if name not in known]:
            if name in unwritten:
                reading.fault((*path, name), f"unknown key; {unwritten[name]}", at_key=True)
                continue
            place = moved.get(name) or reading.where_it_belongs(name, path)
            meant = "" if name in moved else synonyms.get(name) or near(name, tuple(known))
            if meant:
                # a synonym of a key here may be the name of a key elsewhere
                message = f"unknown key; did you mean '{meant}'?"
                if place and name in synonyms:
                    message, meant = f"{message} Or {place}", ""
            elif place:
                message = f"does not belong here; {place}"
            else:
                message, others = f"unknown key{others}", ""
            reading.fault((*path, name), message, at_key=True)
            if meant and meant not in mapping:
                yield meant

    def moved(self, mapping: Tree) -> dict[str, str]:
        """Return the keys that belong below another key of this mapping, each with the message where to move it."""
        moved = {
            inner: f"move it below '{name}'"
            for name, form in self.parts
            if isinstance(form, RecordForm) and form.inline_too
            for inner in form.names({})
        }
        if self.listed and self.listed.unless in mapping:
            unless = self.listed.unless
            there = (
                f"'{unless}.each'"
                if isinstance(mapping[unless], dict)
                else f"the items of '{unless}'"
            )
            moved |= dict.fromkeys(
                self.listed.names(mapping), f"it belongs {self.listed.item}; move it into {there}"
            )
        return moved

    def flattened(self, error: RuleError, mapping: Tree) -> RuleError:
        """Return the error with the paths of this mapping, where keys of an item may be below `each` or inline."""
        unless = self.listed.unless if self.listed else ""
        faults = []
        for fault in error.faults:
            name, item = (*fault.path, "", "")[:2]
            if unless and name == unless and isinstance(item, int):
                listed = mapping.get(unless)
                head = (
                    () if listed is None else (name, "each" if isinstance(listed, dict) else item)
                )
                fault = fault._replace(path=(*head, *fault.path[2:]))
            faults.append(fault)
        return RuleError(*faults)


class Inline(RecordForm):
    """The keys of another record, written in the same mapping: those of the piston in its cylinder.

    unless: the key of a list of such records. If it is given, their keys are in its items instead (or below its `each`,
    if all are equal). In both cases the rules of the outer record refer to an item of that list.
    """

    def __init__(self, record: type[Record], unless: str = "") -> None:
        super().__init__(record)
        self.unless, self.item, self.inline = unless, f"to a {unless.removesuffix('s')}", (self,)


@dataclass(eq=False)
class ReadMapping:
    """A mapping after the first pass: all that its record is made from.

    mapping, path: what was read, and where; values: by key, with a `ReadMapping` where there will be a record; made: the
    record, after the second pass.
    """

    form: RecordForm
    mapping: Tree
    path: Path
    values: dict[str, object]
    made: Any = None


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
            yield from key_places(inner, path, inner.item if inner.unless else words)
            continue
        below: Path = (*path, name) if name else path
        if name:
            yield words, path, name
        if isinstance(inner, Variant):
            yield from (
                (f"to '{name}: {word}'", (), key)
                for word, case in inner.cases.items()
                for key in case.keys
            )
        yield from key_places(inner, below, f"under '{path_text(below)}'" if name else words)


def records(form: Form, word: str) -> Iterator[tuple[str, RecordForm]]:
    """Yield (name, form) of every record that the value of a key of this form may be; word: the key."""
    if isinstance(form, RecordForm):
        yield word, form
    elif isinstance(form, Variant):
        yield from ((f"{word}: {name}", case) for name, case in form.cases.items())
    for name, inner in () if isinstance(form, RecordForm) else form.parts:
        yield from records(inner, name or ("card" if isinstance(form, Keyed) else word))


def too_extreme(record: object, values: Mapping[str, object]) -> Truth:
    """Return whether a number of a record has overflowed, for many machines as an array (machines,).

    values: of its keys. A number may be infinite if one of these is, as `rod: infinite`, or by default.
    """
    defaults = [vars(type(record)).get(name) for name in vars(record)]
    infinite = any(one == math.inf for one in (*values.values(), *defaults) if is_number(one))
    broken: Truth = False
    for value in vars(record).values():
        if is_number(value) or (
            isinstance(value, np.ndarray) and not isinstance(record, Indivisible)
        ):
            broken = broken | ~(np.isfinite(value) | (infinite & (value == math.inf)))
    return broken


class Maker:
    """The second pass: makes records of what was read, and reports what is wrong with them.

    broken: which of many machines, whose numbers are arrays (count,), break a rule.
    """

    def __init__(self, reading: Reading, count: int = 0) -> None:
        self.reading, self.broken = reading, np.zeros(count, dtype=bool)

    def made(self, value: object) -> Any:
        """Return the record, tuple or value that was read; REFUSED after reporting what is wrong with it."""
        if isinstance(value, ReadMapping):
            values = {name: self.made(one) for name, one in value.values.items()}
            try:
                value.made = self._record(value.form, values)
            except ArithmeticError:
                value.made = self.reading.fault(value.path, TOO_EXTREME)
            except RuleError as error:
                value.made = self.reading.refuse(
                    value.path, value.form.flattened(error, value.mapping)
                )
            return value.made
        if isinstance(value, tuple) and any(isinstance(one, ReadMapping) for one in value):
            return tuple(map(self.made, value))
        return value

    def _record(self, form: RecordForm, values: dict[str, object]) -> object:
        """Return the record of values by key; REFUSED if one could not be read, after judging the others.

        For that the rules get `Form.unread` in its place, a nan, which breaks no rule.
        """
        unread = {
            name: form.keys[name].form.unread
            for name, one in values.items()
            if one is REFUSED or (isinstance(one, tuple) and has_refused(one))
        }
        if None in unread.values():  # nothing can be in place of a word or a mapping
            raise RuleError(*form.record.faults_of_some(values))
        try:
            record = form.record.from_keys(**(values | unread))
        except RuleError as error:
            raise RuleError(
                *(fault for fault in error.faults if not (unread and isinstance(fault, NotANumber)))
            ) from None
        except (ArithmeticError, ValueError):
            if not unread:  # else a formula takes no nan
                raise
        if unread:
            return REFUSED
        extreme = too_extreme(record, values)
        if len(self.broken):
            rules = [
                *form.record.rules_of_keys(values),
                *(record.rules() if isinstance(record, Record) else ()),
            ]
            self.broken = functools.reduce(
                np.logical_or, (rule.broken for rule in rules), self.broken | extreme
            )
        elif extreme:
            refused(TOO_EXTREME)
        return record


class Variant(Choice):
    """A word that decides which further keys the same mapping has, such as those of the mechanism."""

    def __init__(self, default: str, cases: dict[str, RecordForm], also: dict[str, str]) -> None:
        super().__init__(tuple(cases), also)
        self.default, self.cases, self.inline = default, cases, tuple(cases.values())

    def chosen(self, word: Node | None) -> Iterable[RecordForm]:
        """Return the form that a word chooses, the default one without a word, or all forms if it is unknown."""
        known = (
            self.cases.get(self.default if word is None else word)
            if isinstance(word, (str, type(None)))
            else None
        )
        return [known] if known else self.cases.values()


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
        self.item, self.kind, self.called = item, item.kind, called
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
        whole = self._completed(reading, value, path) if self.called else value
        return tuple(
            self.item.read(reading, item, (*path, index)) for index, item in enumerate(whole)
        )

    def is_item(self, mapping: Tree) -> bool:
        """Return whether a mapping that is given in the place of the list has the keys of one of its items."""
        if not isinstance(self.item, RecordForm) or not mapping:
            return False
        return mapping.keys() <= self.item.names(mapping).keys()

    def _completed(self, reading: Reading, items: Sequence[Node], path: Path) -> list[Node]:
        """Return items with the keys that `like` copies; an error in a copied key is reported once, at the original."""
        assert isinstance(self.item, RecordForm)
        above: dict[str, int] = {}
        completed: list[Any] = list(items)
        for index, item in enumerate(items):
            if not isinstance(item, dict):
                continue
            here: Path = (*path, index)
            if "like" in item:
                like = str(item["like"])
                if like not in above:
                    hint = did_you_mean(
                        like, tuple(above)
                    ) or f"; above are {', '.join(map(text_in_one_line, above))}" * bool(above)
                    none_such = f"no {self.called} above this one is called '{text_in_one_line(like)}'{hint}"
                    completed[index] = reading.fault((*here, "like"), none_such)
                    continue
                other = completed[above[like]]
                reading.alike[here] = (*path, above[like])
                own = {key: value for key, value in item.items() if key != "like"}
                pairs = [
                    {name, key.instead}
                    for name, key in self.item.names(other | own).items()
                    if key.instead
                ]
                replaced = {"name", *(key for pair in pairs if own.keys() & pair for key in pair)}
                completed[index] = {
                    key: value for key, value in other.items() if key not in replaced
                } | own
            name = completed[index].get("name")
            above.setdefault(name if isinstance(name, str) else f"{self.called} {index + 1}", index)
        return completed


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
        self.example, self.schema, self.parts = (
            forms[0].example,
            {},
            tuple(("", form) for form in forms),
        )
        self.written = " or ".join(form.written for form in forms)
        self.forms = forms
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
            words = {word for form in self.forms if isinstance(form, Choice) for word in form.words}
            words -= {
                key for form in self.forms if isinstance(form, RecordForm) for key in form.keys
            }
            if name := next((name for name in value if name in words), ""):
                alone = f"- {name}" if isinstance(path[-1], int) else f"{path[-1]}: {name}"
                return reading.fault((*path, name), f"takes no value; write '{alone}'", at_key=True)
            if (listing := self._list_of(value)) is not None:
                return listing.read(reading, value, path)
        for form in self._fitting(value):
            return form.read(reading, value, path)
        return refused(
            f"expected {self.expected}, got {'nothing' if is_nothing(value) else node_kind(value)}"
        )

    def _list_of(self, mapping: Tree) -> "Listing | None":
        """Return the list, among these forms, of which a mapping is an item; None if it is no item.

        A record that has its keys, or knows below which of its own they belong, says more about them.
        """
        records = [form for form in self.forms if isinstance(form, RecordForm)]
        of_records = {key for form in records for key in (*form.keys, *form.moved(mapping))}
        for form in self.forms:
            if (
                isinstance(form, Listing)
                and form.is_item(mapping)
                and not mapping.keys() & of_records
            ):
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
        return [form for form in suiting if (form.kind == "ratio") == bare] or suiting or alike


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
        self.cases, self.otherwise, self.beside = cases, otherwise, beside
        self.single = {
            name: Key(one, texts.get(name, ""))
            for name, one in cases.items()
            if one.shape is not dict
        }

    def take(self, reading: Reading, value: Node, path: Path) -> object:
        """Read a mapping by the key that decides its form."""
        if not isinstance(value, dict):
            no_mapping(self, value)
        known, cases = self.otherwise.keys, self.cases
        deciding = next((name for name in value if name in cases), "")
        if not deciding:
            for name in value:
                if name not in known and (meant := near(name, (*known, *cases))) in cases:
                    return reading.fault(
                        (*path, name), f"unknown key; did you mean '{meant}'?", at_key=True
                    )
            return self.otherwise.read(reading, value, path)
        case, inside = cases[deciding], value[deciding]
        moved: Tree = {}
        if isinstance(inside, dict) and isinstance(case, RecordForm):
            own = [name for name in self.beside if name in case.keys and name not in inside]
            moved = {name: value[name] for name in own if name in value}
            inside = {**inside, **moved}
        others = [name for name in value if name != deciding and name not in moved]
        for name in others:
            place = (
                ""
                if name in known or name in cases
                else reading.where_it_belongs(name, path) or "leave it out"
            )
            message = f"cannot be combined with '{deciding}'; {place or 'leave one of them out'}"
            reading.fault((*path, name), message, at_key=True)
        inner = case.read(reading, inside, (*path, deciding))
        return REFUSED if others else inner


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
    return form if isinstance(form, Form) else RecordForm(form)
