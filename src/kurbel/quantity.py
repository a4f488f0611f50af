"""A quantity: one printed figure or column, declared once, as an attribute of the class that computes it.

    @key_value("A_H", "area")
    def A_head(self) -> Values | None:
        'Piston area at the head end.'

The name of the method is the id of the quantity, the first paragraph of its docstring the sentence that users read. The
attribute is computed on first use. The rows of a class are printed in the order in which they are defined
(`kurbel.solver.figures`); `kurbel.quantities` lists those of all classes.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import partial
from typing import Any, Generic, NamedTuple, TypeVar, overload

V = TypeVar("V")

NOISE_POWER = -14
"""A residual below this power of ten is rounding error, which differs between processors."""
ENTRY_DIGITS = 6
"""Significant digits of a value that people write into a machine file again."""
ENTRY_DECIMALS = 4
"""Most decimals of such an angle in degrees."""
GREEK = {
    "φ": "phi", "ψ": "psi", "θ": "theta", "Θ": "Theta", "ω": "omega", "δ": "delta", "Δ": "d", "λ": "lambda", "μ": "mu",
    "ν": "nu", "η": "eta", "π": "pi", "ρ": "rho", "ε": "eps", "γ": "gamma", "α": "alpha", "β": "beta", "κ": "kappa",
    "σ": "sigma", "τ": "tau", "Σ": "sum ", "½": "1/2", "−": "-", "\u0307": "_dot", "\u0308": "_ddot",
}  # fmt: skip
"""Character of a symbol -> its replacement if the output has no Greek letters."""
_PLAIN = str.maketrans(GREEK)
_FIRST_WORDS = re.compile(
    r".+?(?=[:;,(−Σ]| (?:from|toward|of|over|in|on|at|that|since|along|to) |$)"
)
_LARGEST = {"max": "Largest", "min": "Smallest", "peak": "Largest magnitude of"}
"""End of the id of an extreme of a column -> the first words of its sentence."""


ITS_OWN = ("those of its class",)
"""Commands of a quantity that does not say which."""


_OF_RAM = (
    ("piston force", "force along the stroke line"),
    ("piston speed", "ram speed"),
    (" (yoke frame: on the piston rod)", ""),
)
"""Words of sentences, and what they are of a machine that drives a ram and has no piston."""


class Quantity(NamedTuple):
    """One printed quantity; the order in which quantities are declared is that in which they are printed.

    `id` is its name in JSON and CSV, `symbol` that in the printed table (`plain` if the output has no Greek letters and
    `GREEK` does not suffice), `kind` decides the unit (see `units`), and `text` describes it in one sentence.
    `commands`: those that print it, if the machine has it.
    `extremes`: of a column, the commands that print its largest and smallest value as key values `<id>_max` and
    `<id>_min`; `called` names it in their sentences.
    `after`: the id after which it is printed, if not where it is declared. A `residual` would be zero without rounding:
    tables do not show rounding. A quantity that is `listed`, a list of values, cannot have a bound.
    `group`: quantities of one kind and one group are shown in one unit; '' for that of its column.
    `peak`: a column with extremes that has, besides, its largest magnitude as key value `<id>_peak`.
    `on_request`: the commands that print it only if it is requested by name.
    `wanted_large`: a bound on it is one from below, as on every smallest value.
    `heading`: of the key values among which it is listed for people; see `Heading`.
    `of_book`: an approximation of the books, which people are shown where approximations are requested.
    `for_entry`: people write it into the machine file again, so that it is printed with more digits.
    `gauge`: a pressure that is absolute where the machine file gives it so; its unit then has this `mark`.
    `needs`: what a machine without it lacks, for the message to who requests it.
    """

    id: str
    symbol: str
    kind: str
    text: str
    plain: str = ""
    commands: tuple[str, ...] = ()
    extremes: tuple[str, ...] = ()
    called: str = ""
    after: str = ""
    residual: bool = False
    listed: bool = False
    peak: bool = False
    on_request: tuple[str, ...] = ()
    wanted_large: bool = False
    for_entry: bool = False
    gauge: bool = False
    mark: str = ""
    group: str = ""
    heading: str = ""
    of_book: bool = False
    needs: str = ""

    @property
    def short(self) -> str:
        """Two or three words for axes and legends: what it is called, or the first words of its sentence.

        >>> Quantity("M", "M", "torque", "Torque on the shaft").short
        'torque'
        """
        return self.called or first_words(self.text).lower()

    @property
    def bounded_below(self) -> bool:
        """Whether a bound on it is one from below."""
        return self.wanted_large or self.id.endswith("_min")

    @property
    def ascii_symbol(self) -> str:
        """The symbol for an output that cannot show Greek letters."""
        return self.plain or self.symbol.translate(_PLAIN)

    @property
    def family(self) -> str:
        """What its largest, smallest and mean value have in common: their column, or their id but for its end.

        >>> force = Quantity("F_pin", "F_z", "force", "Force on the pin", called="force")
        >>> force.extreme("min").family, Quantity("wear_mean", "f N c_m", "power", "").family
        ('F_pin', 'wear')
        """
        if self.group:
            return self.group
        stem, _, end = self.id.rpartition("_")
        if end in ("max", "min", "peak", "mean"):
            return stem
        return self.id

    def is_noise(self, value: float) -> bool:
        """Whether this value is a residual of rounding alone."""
        return self.residual and abs(value) < 10.0**NOISE_POWER

    def absolute(self) -> Quantity:
        """Return the quantity of a machine whose pressures are absolute."""
        text = self.text.replace("Gauge", "Absolute").replace("gauge", "absolute")
        if not self.gauge:
            return self
        return self._replace(text=text, mark="abs")

    def of_ram(self) -> Quantity:
        """Return the quantity of a machine that drives a ram and has no piston."""
        text = self.text
        for of_piston, of_ram in _OF_RAM:
            text = text.replace(of_piston, of_ram)
        return self._replace(text=text)

    def without_guide(self) -> Quantity:
        """Return the quantity of a machine without a crosshead guide, whose piston rod takes the side force."""
        text = self.text.replace("guide force", "side force on the piston rod")
        return self._replace(text=text.replace("Force on the guide,", "Force on the piston rod,"))

    def printed_by(self, command: str, heading: str = "") -> Quantity:
        """Return it as a key value of this command and its own `commands`, below this heading unless it has one."""
        commands = [] if self.commands == ITS_OWN else list(self.commands)
        if command and command not in commands:
            commands.append(command)
        return self._replace(commands=tuple(commands), heading=self.heading or heading)

    @property
    def zero(self) -> str:
        """What a pressure counts from: `absolute`, `gauge`, '' of differences and of other quantities."""
        if not self.gauge:
            return ""
        return "absolute" if self.mark else "gauge"

    def marked(self, unit: str) -> str:
        """Return the unit as it is shown."""
        return f"{unit} {self.mark}".rstrip()

    def extreme(self, end: str) -> Quantity:
        """Return the key value that is the largest (`max`), smallest (`min`), or largest magnitude of this column.

        >>> force = Quantity("F_pin", "F_z", "force", "Force on the pin", called="force")
        >>> force.extreme("max")[:4]
        ('F_pin_max', 'F_z,max', 'force', 'Largest force')
        """
        comma = "," if "_" in self.symbol else "_"
        plain = self.plain and f"{self.plain}{comma}{end}"
        symbol, text = f"{self.symbol}{comma}{end}", f"{_LARGEST[end]} {self.called}"
        return Quantity(f"{self.id}_{end}", symbol, self.kind, text, plain, of_book=self.of_book)


def first_words(sentence: str) -> str:
    """Return the first words of the sentence of a quantity, which name it.

    >>> first_words("Largest velocity on the outstroke")
    'Largest velocity'
    """
    first = _FIRST_WORDS.match(sentence)
    if not first:
        return sentence
    return first.group().strip()


def by_id(*quantities: Quantity) -> dict[str, Quantity]:
    """Return the quantities by their ids."""
    return {quantity.id: quantity for quantity in quantities}


Meanings = dict[str, tuple[Quantity, str]]
"""Id -> the quantity that was declared first with it, and the class that has it."""


def refuse_other_meanings(
    meanings: Meanings, quantities: Iterable[Quantity], owner: str, with_sentence: bool = True
) -> None:
    """Add the quantities of a class to the meanings of their ids; raises TypeError where an id has another one.

    with_sentence: two classes with one id also have the same sentence; columns may have one for each command.

    >>> force = Quantity("N_max", "N_max", "force", "Largest guide force")
    >>> refuse_other_meanings({"N_max": (force, "CylinderForces")}, [force._replace(kind="power")], "Pump")
    Traceback (most recent call last):
    TypeError: 'N_max' of Pump has the kind 'power', but 'force' in CylinderForces: give it another id
    """
    for quantity in quantities:
        first, where = meanings.setdefault(quantity.id, (quantity, owner))
        pairs = [("kind", quantity.kind, first.kind), ("symbol", quantity.symbol, first.symbol)]
        if with_sentence:
            pairs.append(("sentence", quantity.text, first.text))
        for what, text, text_of_first in pairs:
            if text != text_of_first:
                raise TypeError(
                    f"'{quantity.id}' of {owner} has the {what} '{text}', but '{text_of_first}' in {where}: "
                    "give it another id"
                )


def called(name: str, quantities: Iterable[Quantity]) -> tuple[str, ...]:
    """Return the ids of the quantities that a name may mean: their id, or else a symbol as it is printed.

    >>> called("A_H", [Quantity("A_head", "A_H", "area", "Piston area at the head end")])
    ('A_head',)
    """
    quantities = tuple(quantities)
    if any(name == quantity.id for quantity in quantities):
        return (name,)
    ids = dict[str, None]()
    for quantity in quantities:
        if name in (quantity.symbol, quantity.ascii_symbol):
            ids[quantity.id] = None
    return tuple(ids)


def ambiguity(name: str, ids: tuple[str, ...]) -> str:
    """Return the message for a symbol that several quantities have; '' if only one has it."""
    if len(ids) < 2:
        return ""
    return f"'{name}' is the symbol of {' and of '.join(ids)}; write which"


def in_sentences(word: str, quantities: Iterable[Quantity]) -> str:
    """Return a hint which of these quantities have a word in their sentences, for a word that is no id; or ''.

    >>> in_sentences("piston_area", [Quantity("A_head", "A_H", "area", "Piston area at the head end")])
    '; it is in the sentences of A_head'
    """
    words = word.lower().replace("_", " ")
    if len(words) < 3:
        return ""
    with_word = (quantity for quantity in quantities if words in quantity.text.lower())
    ids = dict.fromkeys(quantity.id for quantity in with_word)
    if not ids:
        return ""
    return f"; it is in the sentences of {', '.join(ids)}"


def rejoined_names(words: Iterable[str], quantities: Iterable[Quantity]) -> Iterator[str]:
    """Yield names that were split at their commas as they were before: `σ_w` and `A` are one where `σ_w,A` is known.

    Words that are ids, as `p_max` and `m`, are those, whatever symbol they might be together.

    >>> list(rejoined_names(["T", "F_z", "max"], [Quantity("F_pin", "F_z,max", "force", "Force on the pin")]))
    ['T', 'F_z,max']
    """
    rest, quantities = list(words), tuple(quantities)
    ids = {quantity.id for quantity in quantities}
    while rest:
        # the longest run of words that is a symbol, or else the next word
        name = rest[0]
        for count in range(min(len(rest), 4), 1, -1):
            joined = ",".join(rest[:count])
            are_ids = ids.issuperset(rest[:count])
            if not are_ids and called(joined, quantities):
                name = joined
                break
        del rest[: name.count(",") + 1]
        yield name


PHI = Quantity(
    "phi", "φ", "angle", "Crank angle from the inner dead centre, in the sense of rotation"
)
"""Over it all other columns are printed."""


class Lists(NamedTuple):
    """Columns and key values, each in the order in which they are printed."""

    all_columns: tuple[Quantity, ...]
    all_key_values: tuple[Quantity, ...]

    def columns(self, command: str) -> dict[str, Quantity]:
        """Return the columns of a command, by id."""
        return by_id(*(column for column in self.all_columns if command in column.commands))

    def key_values(self, command: str) -> dict[str, Quantity]:
        """Return the key values of a command, by id."""
        values = self.all_key_values
        return by_id(*(key_value for key_value in values if command in key_value.commands))

    def commands_of(self, id: str) -> tuple[str, ...]:
        """Return the commands that have a key value, the one whose own it is first."""
        commands = dict[str, None]()
        for key_value in self.all_key_values:
            if key_value.id == id:
                commands |= dict.fromkeys(key_value.commands)
        return tuple(commands)


Of = Callable[[Any], V]
"""Takes the results of a command, or the state at crank angles; see `QuantityRow`."""
ResultCondition = Of[bool]
Formula = Of[Any]
FormulaOfPart = Callable[[Any, str], Any]
"""Takes the results of a command and the name of one of their parts."""
ValuesById = dict[str, Any]
"""Values in SI by id, without those that there are not."""


class QuantityRow(NamedTuple):
    """A quantity with what computes it.

    of: takes the results of a command, or for a column the state at crank angles, and returns the value in SI, None
    where there is none. unless: takes the results, and is true where the quantity adds nothing. repeats: takes the
    results, and is true where people read it in another row, so that only programs and those who name it get it.
    """

    quantity: Quantity
    of: Formula
    unless: ResultCondition | None = None
    repeats: ResultCondition | None = None


class Heading(NamedTuple):
    """In a class of results: the heading of the key values that are defined after it, up to the next one."""

    text: str


class Computed(Generic[V]):
    """An attribute that is computed once for each object, and the row of the quantity that it is.

    Its id is its name in the class. function: takes the object; None where the value is in its mapping `answers`.
    """

    def __init__(
        self,
        function: Of[V] | None,
        quantity: Quantity,
        unless: ResultCondition | None = None,
        repeats: ResultCondition | None = None,
    ) -> None:
        self.name, self.__doc__ = quantity.id, quantity.text
        self.function = function or (lambda row: row.answers.get(self.name))
        self.rows: tuple[QuantityRow, ...] = (QuantityRow(quantity, self.__get__, unless, repeats),)

    def __set_name__(self, owner: type, name: str) -> None:
        (row,) = self.rows
        self.name, self.rows = name, (row._replace(quantity=row.quantity._replace(id=name)),)

    @overload
    def __get__(self, results: None, owner: type | None = None) -> Computed[V]: ...
    @overload
    def __get__(self, results: object, owner: type | None = None) -> V: ...
    def __get__(self, results: object | None, owner: type | None = None) -> V | Computed[V]:
        if results is None:
            return self
        computed = vars(results)
        if self.name not in computed:
            computed[self.name] = self.function(results)
        return computed[self.name]


def key_value(
    symbol: str,
    kind: str,
    *,
    unless: ResultCondition | None = None,
    repeats: ResultCondition | None = None,
    **words: Any,
) -> Callable[[Of[V]], Computed[V]]:
    """Return what makes a method a key value or column of its class; the words are those of `Quantity`.

    The first paragraph of its docstring is the sentence that users read.
    """

    def made(function: Of[V]) -> Computed[V]:
        text = " ".join((function.__doc__ or "").split("\n\n")[0].split()).rstrip(".")
        quantity = Quantity("", symbol, kind, text, **({"commands": ITS_OWN} | words))
        return Computed(function, quantity, unless, repeats)

    return made


column = key_value


def value(
    symbol: str,
    kind: str,
    text: str,
    of: Formula | None = None,
    *,
    unless: ResultCondition | None = None,
    repeats: ResultCondition | None = None,
    **words: Any,
) -> Computed[Any]:
    """Return a key value or column: its id is the name of the attribute, `text` the sentence that users read.

    of: takes the object and returns the value in SI; without it the value is in the mapping `answers` of the object,
    by id, or there is none. unless, repeats: see `QuantityRow`; words: those of `Quantity`.
    """
    return Computed(
        of, Quantity("", symbol, kind, text, **({"commands": ITS_OWN} | words)), unless, repeats
    )


class ForEach:
    """One quantity of several parts, a method of the part; its rows are attributes of the class, named by their ids."""

    def __init__(self, of: FormulaOfPart, rows: tuple[QuantityRow, ...]) -> None:
        self.of, self.rows = of, rows

    def __get__(self, results: object | None, owner: type) -> Any:
        if results is None:
            return self
        return partial(self.of, results)


def values_for(
    parts: Mapping[str, tuple[str, str]],
    id: str,
    symbol: str,
    kind: str,
    text: str,
    *,
    of: FormulaOfPart | None = None,
    group: Callable[[str], str] = lambda part: "",
    after: str = "",
    repeats: ResultCondition | None = None,
    **words: Any,
) -> ForEach:
    """Return a key value or column of each of several parts, as `value` of one; of: takes object and part.

    parts: the index of the symbol of each, and what it is called in a sentence; they take the place of `*` in id,
    symbol, sentence and `after`. group: returns the group of the quantity of a part; words: those of
    `Quantity`, the same for all.
    """

    answer: FormulaOfPart = of or (lambda results, part: results.answers.get(id.replace("*", part)))

    def row(part: str, index: str, called: str) -> QuantityRow:
        defaults = {"commands": ITS_OWN, "after": after.replace("*", part), "group": group(part)}
        quantity = Quantity(
            id.replace("*", part),
            symbol.replace("*", index),
            kind,
            text.replace("*", called),
            **(defaults | words),
        )
        computed = Computed(lambda results: answer(results, part), quantity, repeats=repeats)
        return computed.rows[0]  # computed once, as any other

    return ForEach(answer, tuple(row(part, *words) for part, words in parts.items()))
