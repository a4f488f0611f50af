"""From a machine file and the values of some of its keys to machines: what was read once is made again, with arrays.

Making records is what reading does, and the rules of records hold for arrays: a sweep of 1e5 rows is one machine whose
numbers are arrays (machines,), and the rows that break a rule. Words, counts and points of cards are structure: rows
that differ in these are made apart.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, Flags, Indices, Indivisible
from kurbel.declared.forms.structures import Maker, too_extreme
from kurbel.declared.forms.values import Form, Number
from kurbel.declared.keys import TOO_EXTREME, Record, Rule
from kurbel.declared.numerals import NUMBER
from kurbel.declared.reading import REFUSED, Given, Plain, Reading, StopReading, Tree, shown
from kurbel.errors import Fault, Path, RuleError, Step, UsageError, path_text
from kurbel.machine import Machine
from kurbel.machine.batch import Lot, changed
from kurbel.machine.origin import Origin
from kurbel.machine_file.given import leaves, tree_of
from kurbel.machine_file.overrides import by_numbers, dotted, path_of
from kurbel.machine_file.reader import read_values, reading_of
from kurbel.near_words import did_you_mean

Column = Sequence[str] | Array
"""What a key has in every row: texts as in the file, or numbers (rows,) in SI."""
_Place = tuple[int, str]
"""A value that was read: of which `Given`, by its id, and under which key."""


class Unbound(Exception):
    """The texts of a row make no value; the message tells why."""


class Bound(NamedTuple):
    """What rows make, counted from 0: machines, those of one structure in one record, or the reason why none."""

    lots: list[Lot]
    failures: dict[int, str]


class _Slot(NamedTuple):
    """A value that is read anew: of what, under which of its keys, and which varied keys stand there, and where."""

    given: Given
    name: str
    varied: list[tuple[int, Path]]

    @property
    def form(self) -> Form:
        """What may stand there."""
        return self.given.form.keys[self.name].form  # type: ignore[no-any-return]

    @property
    def number(self) -> Number | None:
        """The form of the number that it becomes, if one varied key is all that stands here."""
        alone = len(self.varied) == 1 and not self.varied[0][1]
        return self.form.number if alone and not isinstance(self.given.made, Indivisible) else None

    def read(self, texts: Sequence[str], whole: Reading) -> Any:
        """Return what texts of its varied keys become, or Unbound, unraised; whole: how the file was read."""
        tree = self.given.mapping[self.name]
        reading = Reading(whole.folder, key_values=whole.key_values)
        try:
            for (_, inner), text in zip(self.varied, texts):
                tree = _with(tree, inner, Plain(text)) if inner else Plain(text)
        except Unbound as error:
            return error
        value = self.form.read(reading, tree, (self.name,))
        if value is REFUSED or reading.faults:
            return Unbound(_joined([fault.below(self.given.path) for fault in reading.faults]))
        return Maker(reading).made(value)


class Binder:
    """Makes machines of a file from the values of these keys, in their order.

    start: texts that make a machine, from which the others differ. Raises UsageError for a key that is none.
    """

    def __init__(self, origin: Origin, keys: Sequence[str], start: Sequence[str]) -> None:
        self._reading = reading_of(origin)
        begun = origin._replace(varied=tuple(f"{key}={text}" for key, text in zip(keys, start)))
        self._root = read_values(begun, self._reading)
        self.machine: Machine = self._root.made
        self.kinds: list[str] = []
        """Of the numbers that stand under the keys, '' of words."""
        self._slots: dict[_Place, _Slot] = {}
        every = list(_every(self._root))
        for number, key in enumerate(keys):
            self._place(number, path_of(key), every)
        self._anew = {id(one) for slot in self._slots.values() for one in _around(slot.given, every)}

    def _place(self, number: int, path: Path, every: Sequence[Given]) -> None:
        """Note in which slots a key stands: that of its record, and those of what is `like` that."""
        owner, name = _owner(path, every)
        inner = path[len(owner.path) + 1 :]
        bare = inner and NUMBER.fullmatch(_at(owner.mapping.get(name), inner) or "")  # the number of a point, say
        self.kinds.append(owner.form.keys[name].form.kind or ("ratio" if bare else ""))
        for one in every:
            if _reads(one, name) and one.mapping.get(name) is owner.mapping.get(name):
                slot = self._slots.setdefault((id(one), name), _Slot(one, name, []))
                slot.varied.append((number, inner))

    def bound(self, rows: Sequence[Sequence[str]]) -> Bound:
        """Return the machines of rows of texts, those of one structure in one record, and why other rows make none."""
        return self.of_columns([[row[number] for row in rows] for number in range(len(self.kinds))], len(rows))

    def of_columns(self, columns: Sequence[Column], count: int) -> Bound:
        """Return the same of columns, one for each key: texts, or numbers (count,) in SI."""
        found = Bound([], {})
        numbers: dict[_Place, Array] = {}
        others: dict[_Place, list[Any]] = {}
        for place, slot in self._slots.items():
            values = self._read(slot, columns, found.failures)
            if isinstance(values, np.ndarray):
                numbers[place] = values
            else:
                others[place] = values
        whole = np.delete(np.arange(count), [*found.failures])
        for rows in _grouped([*others.values()], whole):
            words = {place: column[rows[0]] for place, column in others.items()}
            self._bind(rows, words, numbers, found)
        return found

    def _read(self, slot: _Slot, columns: Sequence[Column], failures: dict[int, str]) -> Any:
        """Return what a slot gets in every row: numbers (rows,), or a list of other values; notes rows without any."""
        own = [columns[number] for number, _ in slot.varied]
        if isinstance(own[0], np.ndarray):
            return own[0]
        if slot.number and (plain := slot.number.numbers(own[0])) is not None:
            return np.array(plain)
        texts = list(zip(*own))
        known = {one: slot.read(one, self._reading) for one in dict.fromkeys(texts)}
        for row, text in enumerate(texts):
            if isinstance(known[text], Unbound):
                failures.setdefault(row, str(known[text]))
        values = [known[text] for text in texts]
        if slot.number and all(isinstance(one, (float, Unbound)) for one in known.values()):
            return np.array([np.nan if isinstance(one, Unbound) else one for one in values])
        return values

    def _bind(self, rows: Indices, words: dict[_Place, Any], numbers: dict[_Place, Array], found: Bound) -> None:
        """Make the machines of rows that have the same words; what cannot be made at once is made row by row."""
        own = {place: column[rows] for place, column in numbers.items()}
        if len(rows) == 1 or not own:
            self._alone(rows, words | {place: column[0].item() for place, column in own.items()}, found)
            return
        maker = _Maker(self._reading, self._anew, words | self._formed(own), len(rows))
        try:
            with np.errstate(all="ignore"):
                machine = maker.made(self._root)
        except (RuleError, TypeError, ValueError, AttributeError, ArithmeticError):
            for row in rows:  # its formulas are those of one machine
                self._bind(np.array([row]), words, numbers, found)
            return
        found.failures.update({int(rows[row]): _joined(faults) for row, faults in maker.failures().items()})
        for places in _structures(machine, ~maker.broken):
            lot = changed(machine, lambda values, at=places: _column(values[at]), {})  # type: ignore[misc]
            found.lots.append(Lot(lot, rows[places].tolist()))

    def _alone(self, rows: Indices, values: dict[_Place, Any], found: Bound) -> None:
        """Make the one machine of these rows."""
        reading = Reading()
        reading.alike = self._reading.alike
        try:
            machine = _Maker(reading, self._anew, self._formed(values)).made(self._root)
        except StopReading:
            machine = REFUSED
        if reading.faults:
            found.failures.update(dict.fromkeys(rows.tolist(), _joined(reading.faults)))
        else:
            found.lots.append(Lot(machine, rows.tolist()))

    def _formed(self, values: Mapping[_Place, Any]) -> dict[_Place, Any]:
        """Return numbers as what their forms make of them."""
        forms = {place: self._slots[place].form.number for place in values}
        return {
            place: form.of_numbers(one) if (form := forms[place]) and isinstance(one, (float, np.ndarray)) else one
            for place, one in values.items()
        }


class CasesBinder:
    """Binders of the load cases of a file; the first of the keys is `case`, and its texts are their names."""

    def __init__(self, origin: Origin, keys: Sequence[str], start: Sequence[str]) -> None:
        self._origin, self._keys, self._start = origin, keys[1:], start[1:]
        self._binders: dict[str, Binder] = {}
        first = self._of(start[0])
        self.machine, self.kinds = first.machine, ["", *first.kinds]

    def _of(self, name: str) -> Binder:
        if name not in self._binders:
            self._binders[name] = Binder(self._origin._replace(case=name), self._keys, self._start)
        return self._binders[name]

    def bound(self, rows: Sequence[Sequence[str]]) -> Bound:
        """Return the machines of rows of texts, case by case; see `Binder.bound`."""
        found = Bound([], {})
        for name in dict.fromkeys(row[0] for row in rows):
            places = [place for place, row in enumerate(rows) if row[0] == name]
            own = self._of(name).bound([rows[place][1:] for place in places])
            found.lots.extend(Lot(lot.machine, [places[row] for row in lot.rows]) for lot in own.lots)
            found.failures.update({places[row]: why for row, why in own.failures.items()})
        return found


class _Maker(Maker):
    """Makes records again in which something is read anew; of many machines, their numbers arrays (count,)."""

    def __init__(self, reading: Reading, anew: set[int], values: Mapping[_Place, Any], count: int = 1) -> None:
        super().__init__(reading)
        self._anew, self._values, self._count = anew, values, count
        self.broken: Flags = np.zeros(count, dtype=bool)
        self._rules: list[tuple[Given, Any, Rule]] = []

    def made(self, value: Any) -> Any:
        """Return the record, as it is where nothing in it is read anew."""
        if isinstance(value, Given) and id(value) not in self._anew:
            return value.made
        return self._record(value) if isinstance(value, Given) else super().made(value)

    def _record(self, given: Given) -> Any:
        values = {name: self._values.get((id(given), name), one) for name, one in given.values.items()}
        other = Given(given.form, given.mapping, given.path, values)
        if self._count == 1:
            return super()._record(other)
        inside = len(self._rules)
        values = {name: self.made(one) for name, one in values.items()}
        record = given.form.record.of_keys(**values)
        stages: list[Iterable[Rule]] = [given.form.record.rules_of_keys(values)]
        if isinstance(record, Record):
            stages += [record.rules(), [Rule((), too_extreme(record, values), TOO_EXTREME)]]
        for rules in stages:
            # what a part or a stage breaks is not told of the whole or the next
            below = np.zeros(self._count, dtype=bool)
            for _, _, rule in self._rules[inside:]:
                below |= rule.broken
            for rule in rules:
                rows = np.broadcast_to(rule.broken, self._count) & ~below
                if rows.any():
                    self._rules.append((given, record, rule._replace(broken=rows)))
                    self.broken |= rows
        return record

    def failures(self) -> dict[int, list[Fault]]:
        """Return what each row breaks."""
        found: dict[int, list[Fault]] = {}
        for given, record, rule in self._rules:
            for row in np.flatnonzero(rule.broken).tolist():
                faults = given.form.flattened(RuleError(rule.fault(record, row)), given.mapping).faults
                found.setdefault(row, []).extend(one.below(given.path) for one in faults)
        return {row: _as_read(faults, self.reading.alike) for row, faults in found.items()}


def _as_read(faults: Sequence[Fault], alike: dict[Path, Path]) -> list[Fault]:
    """Return faults as a reading notes them: those that were taken over once, and not too many of them."""
    reading = Reading()
    reading.alike = alike
    try:
        for fault in faults:
            reading.note(fault)
    except StopReading:
        pass
    return reading.faults


def _structures(machine: Machine, fit: Flags) -> Iterator[Indices]:
    """Yield the places of machines, of those that are fit, in which the same numbers are 0, or infinite."""
    codes: list[Array] = []

    def coded(numbers: Array) -> Array:
        code = (numbers == 0) + 2.0 * np.isinf(numbers)
        if (code != code[0]).any():
            codes.append(code)
        return numbers

    changed(machine, coded, {})
    places = np.flatnonzero(fit)
    if not codes or not len(places):
        yield from (places,) if len(places) else ()
        return
    kinds = np.unique(np.stack(codes)[:, places], axis=1, return_inverse=True)[1].ravel()
    for kind in range(kinds.max() + 1):
        yield places[kinds == kind]


def _column(values: Array) -> Any:
    """Return numbers of many machines, or the one that all of them have."""
    bits = values.view(np.int64)  # 0 and −0 are two
    return values if (bits != bits[0]).any() else values[0].item()


def _grouped(columns: Sequence[Sequence[Any]], rows: Indices) -> list[Indices]:
    """Return the rows with the same values in all columns together."""
    if not columns:
        return [rows] if len(rows) else []
    groups: dict[tuple[int, ...], list[int]] = {}
    for row in rows.tolist():
        groups.setdefault(tuple(id(column[row]) for column in columns), []).append(row)
    return [np.array(group) for group in groups.values()]


def _every(value: Any) -> Iterator[Given]:
    """Yield what was read of every mapping, those inside others first."""
    if isinstance(value, Given):
        for one in value.values.values():
            yield from _every(one)
        yield value
    elif isinstance(value, tuple):
        for one in value:
            yield from _every(one)


def _around(inner: Given, every: Sequence[Given]) -> Iterator[Given]:
    """Yield what was read of a mapping, and of those around it."""
    for one in every:
        if inner in _every(one):
            yield one


def written_texts(origin: Origin, keys: Sequence[str]) -> list[str]:
    """Return what a file has under these dotted keys; raises UsageError for a key under which no value stands."""
    tree, texts = tree_of(origin), []
    for key in keys:
        try:
            texts.append(written(tree, key))
        except UsageError as error:
            raise UsageError(f"{shown(key)}: {error}") from None
    return texts


def written(tree: Tree, key: str) -> str:
    """Return what stands under a dotted key; raises UsageError where no value does."""
    text = _at(tree, path_of(key))
    if text is None:
        raise UsageError(f"no value stands under this key in the file{_meant(tree, key)}")
    return text


def _at(tree: Any, path: Path) -> str | None:
    """Return the text at a path in a tree; None where there is none."""
    try:
        for step in path:
            tree = tree[step]
    except (KeyError, IndexError, TypeError):
        return None
    return tree if isinstance(tree, str) else None


def _meant(tree: Tree, key: str) -> str:
    """Return which key with a value was probably meant by one without, or an empty text."""
    paths = [path for path, value in leaves(tree) if isinstance(value, str) and path[0] != "uncertainty"]
    for path in paths:
        names = ".".join(step for step in path if isinstance(step, str))
        if f".{names}".endswith(f".{key}"):
            return f"; did you mean '{dotted(path)}'?"
    return did_you_mean(by_numbers(tree, key), tuple(map(dotted, paths)))


def _owner(path: Path, every: Sequence[Given]) -> tuple[Given, str]:
    """Return what reads a key itself, the innermost one, and the name of its own key on the way there."""
    fitting = [
        one
        for one in every
        if len(one.path) < len(path) and one.path == path[: len(one.path)] and _reads(one, path[len(one.path)])
    ]
    if not fitting:
        raise UsageError(f"--vary {path_text(path)}: no value stands under this key that could be varied")
    owner = max(fitting, key=lambda one: len(one.path))
    return owner, str(path[len(owner.path)])


def _reads(given: Given, name: Step) -> bool:
    """Return whether a record reads the value of a key itself."""
    return name in given.values and name in given.form.keys


def _with(tree: Any, path: Path, value: Any) -> Any:
    """Return a tree of a machine file with another value at a path in it."""
    step, rest = path[0], path[1:]
    try:
        new = _with(tree[step], rest, value) if rest else value
        if isinstance(tree, dict):
            return {**tree, step: new}
        return [*tree[:step], new, *tree[step + 1 :]]  # type: ignore[operator]
    except (TypeError, KeyError, IndexError):
        raise Unbound(f"{path_text(path)}: no value stands there") from None


def _joined(faults: Sequence[Fault]) -> str:
    texts = (f"{path_text(one.path)}: {one.message}" if one.path else one.message for one in faults)
    return "; ".join(dict.fromkeys(texts))  # equal cylinders have one fault in common
