"""The declaration of a printed quantity, and the order of several of them."""

from collections.abc import Iterable, Iterator
from typing import NamedTuple

NOISE_POWER = -14
"""A residual below this power of ten is rounding, another on every processor."""


GREEK = {
    "φ": "phi", "ψ": "psi", "θ": "theta", "Θ": "Theta", "ω": "omega", "δ": "delta", "Δ": "d", "λ": "lambda", "μ": "mu",
    "ν": "nu", "η": "eta", "π": "pi", "ρ": "rho", "ε": "eps", "γ": "gamma", "α": "alpha", "β": "beta", "κ": "kappa",
    "σ": "sigma", "τ": "tau", "Σ": "sum ", "½": "1/2", "−": "-", "\u0307": "_dot", "\u0308": "_ddot",
}  # fmt: skip
"""Sign of a symbol -> what stands for it where the output has no Greek letters."""
_PLAIN = str.maketrans(GREEK)
_EXTREME_TEXTS = {"largest": "Largest", "smallest": "Smallest", "peak": "Largest magnitude of"}
"""Part of the extremes of a column -> the first words of its sentence."""


class Quantity(NamedTuple):
    """One printed quantity; the order in which quantities are declared is that in which they are printed.

    `id` stands in JSON and CSV, `symbol` over the printed table (`plain` where the output has no Greek letters, if it
    is more than what stands for each of them), `kind` decides the unit (see `units`), and `text` says in one sentence
    what it is. `commands` print it, if the machine has it. Its value is the attribute of its id in the results of the
    command, or what `asks` names: a method of the results, its argument, and which part of what it returns.
    `extremes`: of a column, the commands that print its largest and smallest value as key values `<id>_max` and
    `<id>_min`; `called` names it in their sentences.
    `unless`: an attribute of the results; where it is true, the quantity adds nothing and is printed only on request.
    `after`: the id after which it is printed, if not where it is declared. A `residual` would be zero without rounding:
    tables do not show rounding. A quantity that is `listed`, a list of values, cannot have a bound.
    `peak`: a column with extremes that has, besides, its largest magnitude as key value `<id>_peak`.
    `on_request`: the commands that print it only where it is requested by name.
    `wanted_large`: a bound on it is one from below, as on every smallest value.
    `gauge`: a pressure that is absolute where the machine file gives it so; its unit then has this `mark`.
    """

    id: str
    symbol: str
    kind: str
    text: str
    plain: str = ""
    commands: tuple[str, ...] = ()
    extremes: tuple[str, ...] = ()
    called: str = ""
    unless: str = ""
    after: str = ""
    asks: tuple[str, ...] = ()
    residual: bool = False
    listed: bool = False
    peak: bool = False
    on_request: tuple[str, ...] = ()
    wanted_large: bool = False
    gauge: bool = False
    mark: str = ""

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
        >>> force.extreme("smallest", "min", ("forces",)).family, Quantity("wear_mean", "f N c_m", "power", "").family
        ('F_pin', 'wear')
        """
        name = self.asks[1] if len(self.asks) > 1 else self.id
        stem, _, end = name.rpartition("_")
        return stem if end in ("max", "min", "peak", "mean") else name

    def is_noise(self, value: float) -> bool:
        """Whether this value is a residual of rounding alone."""
        return self.residual and abs(value) < 10.0**NOISE_POWER

    def absolute(self) -> "Quantity":
        """Return the quantity of a machine whose pressures are absolute."""
        text = self.text.replace("Gauge", "Absolute").replace("gauge", "absolute")
        return self._replace(text=text, mark="abs") if self.gauge else self

    def of_ram(self) -> "Quantity":
        """Return the quantity of a machine that drives a ram and has no piston."""
        text = self.text.replace("piston force", "force along the stroke line").replace("piston speed", "ram speed")
        return self._replace(text=text)

    def marked(self, unit: str) -> str:
        """Return the unit as it is shown."""
        return f"{unit} {self.mark}".rstrip()

    def extreme(self, word: str, end: str, commands: tuple[str, ...]) -> "Quantity":
        """Return the key value that is the largest (`max`), smallest (`min`), or largest magnitude of this column.

        >>> force = Quantity("F_pin", "F_z", "force", "Force on the pin", called="force")
        >>> force.extreme("largest", "max", ("forces",))[:4]
        ('F_pin_max', 'F_z,max', 'force', 'Largest force')
        """
        comma = "," if "_" in self.symbol else "_"
        return Quantity(
            f"{self.id}_{end}",
            f"{self.symbol}{comma}{end}",
            self.kind,
            f"{_EXTREME_TEXTS[word]} {self.called}",
            self.plain and f"{self.plain}{comma}{end}",
            commands,
            asks=("extremes_of", self.id, word),
        )


def extremes(columns: Iterable[Quantity], command: str, *also: str) -> Iterator[Quantity]:
    """Yield the key values that are extremes of columns, as a command searches them; `also` others print them."""
    for column in columns:
        if command in column.extremes:
            yield column.extreme("largest", "max", (command, *also))
            yield column.extreme("smallest", "min", (command, *also))
            if column.peak:
                yield column.extreme("peak", "peak", (command, *also))


def placed(declared: Iterable[Quantity]) -> tuple[Quantity, ...]:
    """Return the quantities in order; several with one place to stand `after` keep theirs among them."""
    given = tuple(declared)
    ordered = [one for one in given if not one.after]
    for one in given:
        if one.after:
            place = [other.id for other in ordered].index(one.after) + 1
            while place < len(ordered) and ordered[place].after == one.after:
                place += 1
            ordered.insert(place, one)
    return tuple(ordered)


def by_id(*quantities: Quantity) -> dict[str, Quantity]:
    """Return the quantities by their ids."""
    return {quantity.id: quantity for quantity in quantities}


def called(name: str, quantities: Iterable[Quantity]) -> tuple[str, ...]:
    """Return the ids of the quantities that a name may mean: their id, or else a symbol as it is printed.

    >>> called("A_H", [Quantity("A_head", "A_H", "area", "Piston area at the head end")])
    ('A_head',)
    """
    given = tuple(quantities)
    if any(name == one.id for one in given):
        return (name,)
    return tuple(dict.fromkeys(one.id for one in given if name in (one.symbol, one.ascii_symbol)))


def ambiguity(name: str, found: tuple[str, ...]) -> str:
    """Return what is to be said of a symbol that several quantities have; '' where it is one."""
    return f"'{name}' is the symbol of {' and of '.join(found)}; write which" if len(found) > 1 else ""


def joined(words: Iterable[str], quantities: Iterable[Quantity]) -> Iterator[str]:
    """Yield names that were split at their commas as they were before: `σ_w` and `A` are one where `σ_w,A` is known.

    Words that are ids, as `p_max` and `m`, are those, whatever symbol they might be together.

    >>> list(joined(["T", "F_z", "max"], [Quantity("F_pin", "F_z,max", "force", "Force on the pin")]))
    ['T', 'F_z,max']
    """
    rest, known = list(words), tuple(quantities)
    ids = {one.id for one in known}
    while rest:
        parts = (rest[:count] for count in range(min(len(rest), 4), 1, -1))
        names = (",".join(part) for part in parts if not ids.issuperset(part))
        name = next((name for name in names if called(name, known)), rest[0])
        del rest[: name.count(",") + 1]
        yield name
