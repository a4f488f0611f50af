"""Forms of mappings and lists: records, lists, alternatives, words that choose further keys, records inline.

A file is read in two passes: forms turn texts into numbers, words and lists, one `Given` for each mapping; then `Maker`
makes records of them.
"""

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, NoReturn

import numpy as np

from kurbel.arrays import Indivisible
from kurbel.declared.forms.values import TEXT, Choice, Form, Number, Schema, Truth, reference
from kurbel.declared.keys import TOO_EXTREME, Key, Record, contradictions, required
from kurbel.declared.reading import REFUSED, Given, Plain, Reading, Tree, glued_hint, is_nothing, kind_of, shown
from kurbel.declared.units import MOST_ITEMS
from kurbel.errors import Fault, Path, RuleError, refused
from kurbel.near_words import did_you_mean, near
from kurbel.numerics.arithmetic import is_number


class RecordForm(Form):
    """A mapping that becomes a record. inline_too: its keys also stand inline elsewhere, and are looked for there."""

    shape = dict

    def __init__(self, record: type[Record], inline_too: bool = False) -> None:
        self.record, self.inline_too, self.keys = record, inline_too, record.KEYS
        super().__init__(f"a mapping with the keys {', '.join(self.keys)}")

    def parts(self) -> Iterable[tuple[str, Form]]:
        return [(name, key.form) for name, key in self.keys.items()]

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

    def take(self, reading: Reading, value: Any, path: Path) -> Any:
        """Read the values of the keys of a mapping."""
        if not isinstance(value, dict):
            no_mapping(self, value)
        # a misspelt key counts as given but unreadable, so that nobody is told that it is missing as well
        meant = dict.fromkeys(self._unknown(reading, value, path), REFUSED)
        return self.build(reading, value | meant, path)

    def build(self, reading: Reading, mapping: Tree, path: Path, inline: bool = False) -> Given:
        """Read the keys of the record out of a mapping that may hold those of others."""
        own = [name for name, key in self.keys.items() if not isinstance(key.form, Inline)]
        rest = {name: value for name, value in mapping.items() if name not in own}
        missing = required(self.keys)
        values: Tree = {}
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
                # of an inline record, point at what is there of it
                beside = next((given for given in own if given in mapping), "") if inline else ""
                meaning = key.text[:1].lower() + key.text[1:]
                message = f"'{name}' is missing{' beside it' if beside else ''}: {meaning}; {key.write(name)}"
                values[name] = reading.fault((*path, beside) if beside else path, message, bool(beside))
        return Given(self, mapping, path, values)

    def _unknown(self, reading: Reading, mapping: Tree, path: Path) -> Iterator[str]:
        """Note a fault for each unknown key and yield the known ones that were probably meant."""
        known = self.names(mapping)
        unknown = [name for name in mapping if name not in known]
        if not unknown:
            return
        elsewhere = self._moved(mapping)
        other_words = {
            word: (name, key.form) for name, key in self.every_key() for word in (*key.also, key.symbol) if word
        }
        listed = False
        for name in unknown:
            home, meant = self._as_here(reading.where_it_belongs(name, path), mapping), ""
            if name not in elsewhere:
                meant, form = other_words.get(name, ("", None))
                # where a key of this name belongs elsewhere, it means one of a single value only with one that suits
                # that, such as a piston rod in mm, which is no mass
                strange = home and form and form.shape is str and form.read(Reading(), mapping[name], ()) is REFUSED
                if meant not in known or strange:
                    meant = near(name, tuple(known))
            if name in elsewhere:
                message = elsewhere[name]
            elif meant:
                message = f"unknown key; did you mean '{meant}'?"
            elif name == "<<":
                message = (
                    "merging is not supported; write the keys themselves; a cylinder may be 'like: NAME' of another"
                )
            elif home:
                message = f"does not belong here; {home}"
            else:
                message = "unknown key" if listed else f"unknown key; known here are {', '.join(known)}"
                listed = True
            reading.fault((*path, name), message, at_key=True)
            if meant and meant not in mapping:
                yield meant

    def _moved(self, mapping: Tree) -> dict[str, str]:
        """Return the keys that do not stand in this mapping but below one of its keys, each with where to move it."""
        moved: dict[str, str] = {}
        for name, key in self.keys.items():
            form = key.form
            if isinstance(form, Inline) and form.unless in mapping:
                each = isinstance(mapping[form.unless], dict)
                there = f"'{form.unless}.each'" if each else f"the items of '{form.unless}'"
                moved |= dict.fromkeys(form.names(mapping), f"belongs {form.item}; move it into {there}")
            elif isinstance(form, RecordForm) and form.inline_too:
                moved |= dict.fromkeys(form.names({}), f"move it below '{name}'")
        return moved

    def _as_here(self, words: str, mapping: Tree) -> str:
        """Return words for places as they are called from this mapping: those of a cylinder in an item of the list."""
        forms = (key.form for key in self.keys.values())
        for form in (one for one in forms if isinstance(one, Inline) and one.unless in mapping):
            item, own = f"{form.unless}.{'each' if isinstance(mapping[form.unless], dict) else 0}", form.names(mapping)
            for name in re.findall(r"under '(\w+)", words):
                words = words.replace(f"under '{name}", f"under '{item}.{name}") if name in own else words
        return words

    def flattened(self, error: RuleError, mapping: Tree) -> RuleError:
        """Return the faults of the record as those of its mapping, whatever list the record has made of it."""
        listed = {key.form.unless for key in self.keys.values() if isinstance(key.form, Inline)}

        def flat(fault: Fault) -> Fault:
            name, *inner = fault.path or ("",)
            if name not in listed or not inner or not isinstance(inner[0], int):
                return fault
            given = mapping.get(str(name))
            head = () if given is None else (name, "each") if isinstance(given, dict) else fault.path[:2]
            return fault._replace(path=(*head, *inner[1:]))

        return RuleError(*map(flat, error.faults))

    def born(self, values: Tree) -> Any:
        """Return the record of these values of its keys; raises RuleError."""
        try:
            born = self.record.from_keys(**values)
        except ArithmeticError:
            refused(TOO_EXTREME)
        return refused(TOO_EXTREME) if too_extreme(born, values) else born

    def schema(self, definitions: Schema) -> Schema:
        name = self.record.__name__
        if name not in definitions:
            definitions[name] = self.object_schema(definitions)
        return reference(name)

    def object_schema(self, definitions: Schema) -> Schema:
        """Return the schema of the mapping itself."""
        properties: Schema = {}
        rules: list[Schema] = []
        self.describe(properties, rules, definitions)
        schema = {"type": "object", "additionalProperties": False, "properties": properties}
        return schema | self._demands() | ({"allOf": rules} if rules else {})

    def _demands(self) -> Schema:
        """Return the schema of the keys that must be given."""
        return {"required": needed} if (needed := required(self.keys)) else {}

    def describe(self, properties: Schema, rules: list[Schema], definitions: Schema) -> None:
        """Add all keys to the schema of a mapping, those of inline records after its own."""
        for name, key in sorted(self.keys.items(), key=lambda item: isinstance(item[1].form, Inline)):
            form = key.form
            if isinstance(form, Inline):
                before = set(properties)
                form.describe(properties, rules, definitions)
                added = [[inner] for inner in properties if inner not in before]
                if demands := form._demands():
                    rules.append({"if": {"anyOf": [{"required": group} for group in added]}, "then": demands})
                if form.unless:
                    rules.append({"if": {"required": [form.unless]}, "then": _none_of(added)})
                continue
            properties.setdefault(name, {**form.schema(definitions), "description": key.description})
            if key.instead:
                rules.append(_none_of([[name, key.instead]]))
            if key.needs:
                rules.append({"dependencies": {name: [key.needs]}})
            if not isinstance(form, Variant):
                continue
            for word, case in form.cases.items():
                case.describe(properties, rules, definitions)
                chosen: Schema = {"properties": {name: {"const": word}}}
                if word != form.default:
                    chosen["required"] = [name]
                others = dict.fromkeys(inner for one in form.cases.values() for inner in one.keys)
                foreign = [[inner] for inner in others if inner not in case.keys]
                rules.append({"if": chosen, "then": (_none_of(foreign) if foreign else {}) | case._demands()})


class Inline(RecordForm):
    """Keys of another record that stand in the same mapping: those of the piston in its cylinder.

    With the key `unless`, a list of such records, they stand in its items instead, or of equal ones below its `each`;
    rules of the outer record speak of an inline record as an item of that list.
    """

    def __init__(self, record: type[Record], unless: str = "") -> None:
        super().__init__(record)
        self.unless, self.item, self.inline = unless, f"to a {unless.removesuffix('s')}", (self,)


def _none_of(groups: list[list[str]]) -> Schema:
    """Return a schema that forbids each of these groups of keys together."""
    return {"not": {"anyOf": [{"required": group} for group in groups]}}


def no_mapping(form: Form, value: Any) -> NoReturn:
    """Raise RuleError for a value that is no mapping."""
    if isinstance(value, Plain) and not value:
        refused(f"nothing stands here; write below it, indented, {form.expected}")
    refused(f"expected {form.expected}, got {kind_of(value)}{glued_hint(value)}")


def places(form: Form, path: str = "", words: str = "at the top of the file") -> Iterator[tuple[str, str]]:
    """Yield every key that may stand in a mapping of this form, each after the words for that mapping; path: of it."""
    if isinstance(form, RecordForm) and form.inline_too:
        return
    for name, inner in form.parts():
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
    for name, inner in () if isinstance(form, RecordForm) else form.parts():
        yield from records(inner, name or ("card" if isinstance(form, Keyed) else word))


def too_extreme(born: Any, values: Tree) -> Any:
    """Return whether, or where, a number of a record is not finite, nor infinite by a word or by default."""
    meant: Any = False
    for value in values.values():
        if is_number(value) or isinstance(value, np.ndarray):
            meant = meant | (value == math.inf)
    broken: Any = False
    for name, value in vars(born).items():
        if is_number(value) or (isinstance(value, np.ndarray) and not isinstance(born, Indivisible)):
            endless = (value == math.inf) & (meant | (vars(type(born)).get(name) == math.inf))
            broken = broken | ~np.asarray(np.isfinite(value) | endless)
    return broken


class Maker:
    """The second pass: makes the records of what was read, and notes what is wrong with them."""

    def __init__(self, reading: Reading) -> None:
        self.reading = reading

    def made(self, value: Any, path: Path = ()) -> Any:
        """Return what a value that was read becomes; REFUSED after noting what is wrong with it."""
        if isinstance(value, Given):
            value.made = self._record(value)
            return value.made
        if isinstance(value, tuple) and any(isinstance(one, Given) for one in value):
            items = tuple(self.made(one, (*path, index)) for index, one in enumerate(value))
            if not any(one is REFUSED for one in items):
                return items
            self.reading.partly[path] = items
            return REFUSED
        return value

    def _record(self, given: Given) -> Any:
        path, form = given.path, given.form
        values = {name: self.made(one, (*path, name)) for name, one in given.values.items()}
        try:
            if not any(one is REFUSED for one in values.values()):
                return form.born(values)
            # what is there contradicts the rest whether it could be read or not
            known = {name: self._partly(self.reading.partly.get((*path, name), one)) for name, one in values.items()}
            faults = (*contradictions(form.keys, values), *form.record.faults_of_keys(known))
            return self.reading.refuse(path, RuleError(*faults))
        except RuleError as error:
            return self.reading.refuse(path, form.flattened(error, given.mapping))

    def _partly(self, value: Any) -> Any:
        """Return a list of which some items could not be read, the others made."""
        items = value if isinstance(value, tuple) else ()
        return tuple(self.made(one) if isinstance(one, Given) else one for one in items) or value


class Variant(Choice):
    """One of these words, on which hang further keys of the same mapping: those of the mechanism, say."""

    def __init__(self, default: str, cases: dict[str, RecordForm], also: dict[str, str]) -> None:
        super().__init__(tuple(cases), also)
        self.default, self.cases, self.inline = default, cases, tuple(cases.values())

    def chosen(self, word: Any) -> Iterable[RecordForm]:
        """Return the record that a word chooses, or the default one; all of them where the word is unknown."""
        known = self.cases.get(self.default if word is None else word) if isinstance(word, (str, type(None))) else None
        return [known] if known else self.cases.values()


class Listing(Form):
    """A list of items of one form, at least one; becomes a tuple.

    called: what an item without a name is called, before its number, if `like: NAME` in one takes over what stands in
    that one above it. What stands in the item itself comes first, also before what says the same thing there by
    another key.
    """

    shape = list

    def __init__(self, item: Form, called: str = "") -> None:
        super().__init__("a list, each item after '- '", written=f"a list; each {item.written}")
        self.item, self.kind, self.called = item, item.kind, called

    def parts(self) -> Iterable[tuple[str, Form]]:
        return (("", self.item),)

    def schema(self, definitions: Schema) -> Schema:
        item = self.item.schema(definitions)
        if self.called and isinstance(self.item, RecordForm):  # one that is like another need not say everything
            properties: Schema = {}
            self.item.describe(properties, [], definitions)
            short = {"type": "object", "additionalProperties": False, "properties": properties}
            item = {"if": {"required": ["like"]}, "then": short, "else": item}
        return {"type": "array", "items": item, "minItems": 1, "maxItems": MOST_ITEMS}

    def take(self, reading: Reading, value: Any, path: Path) -> Any:
        """Read a list into a tuple."""
        if isinstance(value, Plain) and not value:
            refused("nothing stands here; write a list below it, each item after '- '")
        if not isinstance(value, list):
            refused(f"expected a list, each item after '- ', got {kind_of(value)}")
        if not value:
            refused("the list is empty; give at least one item or leave the key out")
        if len(value) > MOST_ITEMS:
            refused(f"{len(value)} items; no machine has more than {MOST_ITEMS} of them")
        whole = self._completed(reading, value, path) if self.called else value
        items = tuple(self.item.read(reading, item, (*path, index)) for index, item in enumerate(whole))
        if any(item is REFUSED for item in items):
            reading.partly[path] = items
            return REFUSED
        return items

    def _completed(self, reading: Reading, items: Sequence[Any], path: Path) -> list[Any]:
        """Return items with what they take over; their faults are those of the other one where they are the same."""
        assert isinstance(self.item, RecordForm)
        pairs = [{name, key.instead} for name, key in self.item.every_key() if key.instead]
        above: dict[str, tuple[int, Tree]] = {}
        completed: list[Any] = []
        for index, item in enumerate(items):
            whole = item
            like = item.get("like", REFUSED) if isinstance(item, dict) else REFUSED
            if isinstance(like, str) and like in above:
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
    """Several forms that differ in shape (text, list, mapping), or word and number; the first that suits reads it."""

    def __init__(self, *forms: Form) -> None:
        expected = ", or ".join(form.expected for form in forms)
        super().__init__(expected, forms[0].example, " or ".join(form.written for form in forms))
        self.forms = forms
        self.kind = next((form.kind for form in forms if form.kind), "")
        self.numeric = any(form.numeric for form in forms)

    def schema(self, definitions: Schema) -> Schema:
        return {"anyOf": [form.schema(definitions) for form in self.forms]}

    def take(self, reading: Reading, value: Any, path: Path) -> Any:
        """Read a value by the first form that has its shape."""
        shape = type(value) if isinstance(value, (dict, list)) else str
        words = [word for form in self.forms if isinstance(form, Choice) for word in form.words]
        if found := [name for name in value if name in words] if shape is dict else []:
            alone = f"- {found[0]}" if isinstance(path[-1], int) else f"{path[-1]}: {found[0]}"
            return reading.fault((*path, found[0]), f"takes no value; write '{alone}'", at_key=True)
        alike = [form for form in self.forms if form.shape is shape]
        if alike:  # of a word and a number, the one that it looks like
            return next((form for form in alike if form.suits(value)), alike[0]).read(reading, value, path)
        return refused(f"expected {self.expected}, got {'nothing' if is_nothing(value) else kind_of(value)}")

    def of_numbers(self, numbers: Any) -> Any:
        return next(form for form in self.forms if form.numeric).of_numbers(numbers)

    def numbers(self, texts: Sequence[str]) -> list[float] | None:
        return next((form.numbers(texts) for form in self.forms if form.shape is str and form.suits(texts[0])), None)

    def parts(self) -> Iterable[tuple[str, Form]]:
        return [("", form) for form in self.forms]


class Keyed(Form):
    """A mapping whose single telling key decides what it becomes: `{constant: …}`, `{trace: …}`; else `otherwise`.

    texts: what those of the telling keys mean under which no mapping stands.
    """

    shape = dict

    def __init__(self, cases: dict[str, Form], otherwise: RecordForm, texts: dict[str, str]) -> None:
        super().__init__(f"{otherwise.expected}; or with one of {', '.join(cases)}")
        self.cases, self.otherwise = cases, otherwise
        self.single = {name: Key(one, texts.get(name, "")) for name, one in cases.items() if one.shape is not dict}

    def parts(self) -> Iterable[tuple[str, Form]]:
        return (*self.cases.items(), ("", self.otherwise))

    def schema(self, definitions: Schema) -> Schema:
        one = {"type": "object", "additionalProperties": False}
        cases = [
            {**one, "required": [name], "properties": {name: form.schema(definitions)}}
            for name, form in self.cases.items()
        ]
        return {"anyOf": [*cases, self.otherwise.schema(definitions)]}

    def take(self, reading: Reading, value: Any, path: Path) -> Any:
        """Read a mapping by its telling key."""
        if not isinstance(value, dict):
            no_mapping(self, value)
        known, cases = self.otherwise.keys, self.cases
        telling = next((name for name in value if name in cases), "")
        if not telling:
            misspelt = {
                name: meant
                for name in value
                if name not in known and not reading.where_it_belongs(name, path) and not near(name, tuple(known))
                if (meant := near(name, tuple(cases)))
            }
            for name, meant in misspelt.items():
                reading.fault((*path, name), f"unknown key; did you mean '{meant}'?", at_key=True)
            return REFUSED if misspelt else self.otherwise.read(reading, value, path)
        for name in value:
            if name != telling:
                home = reading.where_it_belongs(name, path) or "leave it out"
                way_out = "leave one of them out" if name in known or name in cases else home
                reading.fault((*path, name), f"cannot stand beside '{telling}'; {way_out}", at_key=True)
        inner = cases[telling].read(reading, value[telling], (*path, telling))
        return inner if len(value) == 1 else REFUSED


def form_of(form: Any, bounds: Mapping[str, Any] = {}) -> Form:
    """Return what may stand under a key: a kind of quantity with its bounds, a type, words, a record, a list of one.

    bounds: `above`, `least`, `below`, `most` in SI, and `words` that stand for numbers.
    """
    if isinstance(form, str):
        return Number(form, **bounds)
    if isinstance(form, tuple):
        return Choice(form)
    if isinstance(form, list):
        return Listing(form_of(form[0], bounds))
    if form is int:
        return Number(whole=True, **{"least": 1, **bounds})
    if form is bool:
        return Truth()
    if form is str:
        return TEXT
    return RecordForm(form) if isinstance(form, type) else form
