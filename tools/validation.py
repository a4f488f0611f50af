"""The page of validation: every published example as printed and as computed, and which of both is right.

`pytest --rewrite tests/project/test_documents.py` writes it, from the tables of the tests.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

import kurbel
from kurbel.crank_angle import CrankAngle
from kurbel.crank_formulas import first_order_acceleration, first_order_displacement
from valve_prints import PRINTS, Print
from worked_examples import FOLDER, SI, TABLE, printed_answer

_ROOT = Path(__file__).parent.parent
_WATERWORKS = _ROOT / "configs" / "waterworks.yaml"
_KGF, _CM2 = 9.80665, 1e-4

_JUDGED = {
    "right": "both",
    "right_within_1_unit": "both; last digit of the print off by one",
    "first_order_formula": "kurbel; first-order formula",
    "series_approximation": "kurbel; cut-off series",
    "graphical": "kurbel; read off a drawing",
    "rounded_intermediates": "kurbel; rounded on the way",
    "wrong": "kurbel; print wrong",
    "note": "not printed",
    "not printed": "not printed",
}
"""What the table of the examples says of a printed figure -> who is right, and why."""

_HEAD = """# Validation

Every published example that kurbel is tested with: what the source prints, what kurbel computes, and which is right.

*Deviation* is the printed figure minus kurbel's, relative to kurbel's; *right* names who is right, and what the source
does otherwise. The tests also hold every figure of kurbel in
the worked examples against an independent recalculation in 30 digits, to its last digit; where nothing is printed, that
is the only check. ᵍ: the source takes g = 9.81 m/s² or a rounded horsepower, kurbel 9.80665 m/s² and 550 ft lbf/s.
⁰: the figure is an input of the example, and kurbel finds the condition that it is the answer to.

Books marked * are read from their Python companions (code and stored output, FOSSEE/Python-Textbook-Companions on
GitHub); a slip of such a program is not a slip of the book.
"""

_COMPANIONS = (
    "Theory of Machines",
    "Gupta, Fund",
    "Tayal",
    "Bhandari",
    "Keswani",
    "Jindal",
    "Bevan",
)


def page() -> str:
    """Return the page."""
    blocks = [
        _HEAD,
        _roetscher(),
        _zusammenstellung(),
        _blau(),
        _tredgold(),
        _redtenbacher(),
        _valves(),
        _counts(),
        *_books(),
    ]
    return "\n\n".join(block.strip() for block in blocks) + "\n"


def _counts() -> str:
    rows = [row for rows in TABLE.values() for row in rows]
    judged = [_JUDGED[row["verdict"]] for row in rows if "ask" in row]
    counted = [
        (what, str(judged.count(what)))
        for what in dict.fromkeys(_JUDGED.values())
        if what in judged
    ]
    counted.append(("not computed by kurbel, with the reason", str(len(rows) - len(judged))))
    text = f"## Worked examples in short\n\n{len(TABLE)} examples with {len(rows)} figures:"
    return f"{text}\n\n{_table('right', '>figures', rows=counted)}"


# the worked examples, by their source


def _books() -> Iterator[str]:
    """Yield a section for each book, and one for pages and programs."""
    books: dict[str, list[str]] = {}
    for example in TABLE:
        books.setdefault(_book(_source(example)), []).append(example)
    for book in sorted(books, key=lambda one: (one == _OTHERS, one)):
        star = "*" if any(name in book for name in _COMPANIONS) and "Uicker" not in book else ""
        notes = "\n".join(f"- **{one}**: {_source(one)}" for one in books[book])
        rows = (_row(one, row) for one in books[book] for row in TABLE[one])
        heads = ("example", "quantity", ">printed", ">kurbel", "unit", ">deviation", "right")
        yield f"## {book}{star}\n\n{_table(*heads, rows=rows)}\n\n{notes}"


_OTHERS = "Web pages, programs and independent calculations"
_BOOK = re.compile(
    r"((?:\w\. )*\w+(?:(?:, \w+)? & [^,]+)?, (?:The|A|Theory|Reciprocating|Machine|Fund|Internal|Eng|Design)[^,(]*)"
)


def _book(source: str) -> str:
    found = _BOOK.match(source)
    return found[1].replace(" vol. 1 ", "") if found else _OTHERS


def _source(example: str) -> str:
    """Return what is said of the source: at the head of the machine file, else beside the entry of the table."""
    file = next(
        (
            f
            for f in [FOLDER / f"{example}.yaml", *sorted(FOLDER.glob(f"{example}-*.yaml"))]
            if f.exists()
        ),
        None,
    )
    if file:
        comment = re.match(r"(?:#.*\n)+", file.read_text(encoding="utf-8"))
        assert comment, file
        return " ".join(line.removeprefix("#").strip() for line in comment[0].splitlines())
    table = (FOLDER / "answers.yaml").read_text(encoding="utf-8")
    beside = re.search(rf"(?m)^{re.escape(example)}:  # (.*)$", table)
    assert beside, example
    return beside[1]


def _row(example: str, row: dict[str, Any]) -> tuple[str, ...]:
    printed = row.get("printed", "–")
    if "ask" not in row:
        return example, row["of"], printed, "–", _unit(row), "", f"not computed: {row['reason']}"
    judged = _JUDGED[row["verdict"]] + (f" ({row['why']})" if "why" in row else "")
    figures = _figures({"file": example, **row})
    mark = "⁰" if "back" in row else "ᵍ" if _constants(row) else ""
    shown = ", ".join(_shown(figure) for figure in figures) + mark
    return example, row["of"], printed, shown, _unit(row), _deviation(printed, figures), judged


def _unit(row: dict[str, Any]) -> str:
    return re.sub(
        r"(?<=[a-z])([23])", lambda power: "²³"[int(power[1]) - 2], row["unit"].replace("deg", "°")
    )


def _figures(row: dict[str, Any]) -> list[float]:
    """Return kurbel's figures in the unit of the source, counted as the source counts."""
    if "back" in row:
        return [row.get("strict", row["exact"])]
    values = printed_answer(row)
    factor = SI[row["unit"]] * row.get("times", 1)
    return [
        (one - row.get("plus", 0)) / factor
        for one in (values if isinstance(values, list) else [values])
    ]


def _constants(row: dict[str, Any]) -> bool:
    """Return whether other constants change the figure by more than its shown digits."""
    return "strict" in row and "printed" in row and abs(row["strict"] / row["exact"] - 1) > 5e-7


def _deviation(printed: str, figures: Sequence[float]) -> str:
    try:
        pairs = list(zip([float(word) for word in printed.split(", ")], figures, strict=True))
    except ValueError:
        return ""
    # of several the worst is shown
    return max(
        (_relative(*pair) for pair in pairs), key=lambda text: abs(float(text.rstrip(" %") or 0))
    )


def _relative(printed: float, computed: float) -> str:
    if abs(computed) < 1e-9:
        return ""
    return f"{_signed(100 * (printed / computed - 1))} %"


def _signed(value: float) -> str:
    digits = 1 - math.floor(math.log10(abs(value))) if value else 0
    return f"{value:+.{min(max(digits, 0), 3)}f}" if abs(value) >= 5e-4 else "0"


def _shown(value: float) -> str:
    return "0" if abs(value) < 1e-9 else f"{value:.6g}"


# the books that kurbel follows


def _roetscher() -> str:
    """Return the figures of ch. 14 and of the waterworks engine of Tafel I."""
    case = kurbel.solve(kurbel.load(_WATERWORKS))
    low = kurbel.solve(kurbel.load(_ROOT / "configs" / "waterworks-two-cranks.yaml")).cylinders[1]
    cylinder = case.cylinders[0]
    fourth = kurbel.solve("{crank: 1 m, rod_ratio: 4, speed: 1 rad/s}").cylinders[0].motion
    pump = cylinder.columns([90, 270])["P_driven"] / _KGF
    inertia = "826 kg rounded to 830 kg, v to 2.095 m/s"
    rows: list[tuple[str, str, str, float, str, str]] = [
        (
            "607",
            "area of the steam piston, head end",
            "1546.3",
            case["A_head"].value / _CM2,
            "cm²",
            "",
        ),
        (
            "607",
            "area of the steam piston, crank end",
            "1511.9",
            case["A_crank"].value / _CM2,
            "cm²",
            "",
        ),
        ("604", "c_max/v for L/R = 5", "1.02", case["c_max"].value / case["v"].value, "", ""),
        ("604", "c_max/v for L/R = 4", "1.03", fourth.c_max.value, "", ""),
        (
            "605",
            "b at the dead centre, relative to the infinite rod",
            "1.20",
            case["b_max"].value / _infinite(case),
            "",
            "",
        ),
        ("608", "speed of the crank pin", "2.095", case["v"].value, "m/s", "rounded up"),
        (
            "608",
            "largest inertia force, high-pressure side",
            "1115",
            -case["P_inertia_min"].value / _KGF,
            "kgf",
            inertia,
        ),
        (
            "608",
            "largest inertia force, low-pressure side",
            "1330",
            -low.P_inertia_min.value / _KGF,
            "kgf",
            inertia.replace("826", "986").replace("830", "990"),
        ),
        ("613", "pump force, outstroke", "3490", -float(pump[0]), "kgf", "rounded to tens"),
        ("613", "pump force, return stroke", "3710", float(pump[1]), "kgf", "rounded to tens"),
    ]
    shown = (
        (
            f"R p. {page}",
            of,
            printed,
            _shown(value),
            unit,
            _relative(float(printed), value),
            _agreed(printed, value, why),
        )
        for page, of, printed, value, unit, why in rows
    )
    return _own_book("F. Rötscher, Die Maschinenelemente (1927)", shown)


def _infinite(case: Any) -> float:
    """Return the acceleration v²/R at the dead centre with an infinite rod."""
    return float(case["v"].value ** 2 / (case["stroke"].value / 2))


def _agreed(printed: str, value: float, why: str) -> str:
    decimals = len(printed.partition(".")[2])
    return (
        "both"
        if round(value, decimals) == float(printed)
        else f"kurbel; {why or 'rounded on the way'}"
    )


def _own_book(title: str, rows: Iterable[tuple[str, ...]]) -> str:
    heads = ("place", "quantity", ">printed", ">kurbel", "unit", ">deviation", "right")
    return f"## {title}\n\n{_table(*heads, rows=rows)}"


def _printed_table(name: str) -> list[list[float]]:
    """Return the rows of a printed table that the tests hold; an asterisk there marks a misprint."""
    lines = (_ROOT / "tests" / "reference" / name).read_text("utf-8").splitlines()
    return [
        [float(figure.strip("*")) for figure in line.split(",")] for line in lines if line[0] != "#"
    ]


def _zusammenstellung() -> str:
    """Return the misprints of Zusammenstellung 112, and how many figures agree."""
    figures = [
        (f"L/R = {ratio:g}, φ = {degrees:g}°", row, printed, exact(ratio, degrees))
        for ratio, degrees, *both in _printed_table("zusammenstellung_112.csv")
        for row, printed, exact in zip(
            ("acceleration", "velocity"), both, (_acceleration, _velocity)
        )
    ]
    wrong = [figure for figure in figures if abs(figure[2] - figure[3]) > 0.5005e-3]
    rows = ((place, row, f"{printed:.3f}", f"{value:.5f}") for place, row, printed, value in wrong)
    text = f"""## R, Zusammenstellung 112 (pp. 602–603)

{len(figures)} figures are legible in the scan. {len(figures) - len(wrong)} agree with the formula of the book to the
last decimal; these {len(wrong)} do not (the last may be a fault of the scan). `kurbel table` prints the table anew."""
    return f"{text}\n\n{_table('place', 'row', '>printed', '>formula of the book', rows=rows)}"


def _acceleration(ratio: float, degrees: float) -> float:
    angle = CrankAngle.of(float(degrees))
    return float(first_order_acceleration(angle.sin, angle.cos, 1 / ratio))


def _velocity(ratio: float, degrees: float) -> float:
    return float(kurbel.SliderCrank(1.0, float(ratio)).slope(CrankAngle.of(float(degrees))))


def _blau() -> str:
    """Return the examples 31 to 35, first-order formulas on purpose."""
    roots = {
        ratio: math.degrees(math.acos((math.sqrt(ratio**2 + 8) - ratio) / 4)) for ratio in (5, 4)
    }
    sixth = math.degrees(math.acos((math.sqrt(41) - 5) / 4))
    minus_sixth = _where_minus_a_sixth()
    rows: list[tuple[str, str, str, float, str]] = [
        ("31", "x/R at 45°, L/R = 5", "0.343", _displacement(5, 45), ""),
        ("31", "x/R at 90°", "1.1", _displacement(5, 90), ""),
        ("31", "x/R at 135°", "1.757", _displacement(5, 135), ""),
        ("32", "x/R at 45°, L/R = 4", "0.356", _displacement(4, 45), ""),
        ("32", "x/R at 90°", "1.125", _displacement(4, 90), ""),
        ("32", "x/R at 135°", "1.77", _displacement(4, 135), ""),
        ("33", "b = 0, L/R = 5 (79°20′)", "79.333", roots[5], "°"),
        ("33", "x/R there", "0.911", _displacement(5, roots[5]), ""),
        ("33", "b = 0, L/R = 4", "77", roots[4], "°"),
        ("33", "x/R there", "0.895", _displacement(4, roots[4]), ""),
        ("34", "b is a sixth of b at 0° (69°30′)", "69.5", sixth, "°"),
        ("34", "x/R there", "0.737", _displacement(5, sixth), ""),
        ("35", "b is minus a sixth of b at 0°", "90", minus_sixth, "°"),
    ]
    shown = (
        (
            f"example {n}",
            of,
            printed,
            _shown(value),
            unit,
            _relative(float(printed), value),
            _agreed(printed, value, ""),
        )
        for n, of, printed, value, unit in rows
    )
    text = (
        "The first-order formulas of the book, which `--compare` prints next to the exact columns."
    )
    return _own_book("E. Blau (1905)", shown).replace("\n\n", f"\n\n{text}\n\n", 1)


def _where_minus_a_sixth() -> float:
    """Return the first angle at which the b of first order is minus a sixth of the largest; L/R = 5."""
    case = kurbel.solve("{crank: 1 m, rod_ratio: 5, speed: 1 rad/s}")
    found = case.cylinders[0].angles_where("b_book", -case["b_max"].value / 6)
    return float(found.angles[0])


def _displacement(ratio: float, degrees: float) -> float:
    angle = CrankAngle.of(float(degrees))
    return float(first_order_displacement(angle.sin, angle.cos, 1 / ratio))


def _tredgold() -> str:
    figures = [
        (f"L/R = {ratio:g}, φ = {degrees:g}°", printed, _velocity(ratio, degrees))
        for degrees, ratio, printed, _ in _printed_table("tredgold_1838.csv")
    ]
    wrong = [figure for figure in figures if abs(figure[1] - figure[2]) >= 0.01]
    rows = ((place, f"{printed:.2f}", f"{value:.5f}") for place, printed, value in wrong)
    text = f"""## T. Tredgold, The Steam Engine (1838): rotary force

Of {len(figures)} figures T/P = sin(φ + ψ)/cos ψ with two decimals {len(figures) - len(wrong)} agree within one unit of
the last. From 120° on the column L/R = 3 repeats that of L/R = 4."""
    return f"{text}\n\n{_table('place', '>printed', '>kurbel', rows=rows)}"


def _redtenbacher() -> str:
    case = kurbel.solve(kurbel.load(_ROOT / "configs" / "locomotive.yaml"))
    over = "not printed: the source averages over the angle of the rod, not over the stroke"
    rows: list[tuple[str, str, str, Callable[[], float], str]] = [
        (
            "D 7",
            "½ λ f",
            "0.8333",
            lambda: 100 * case["loss_crosshead_redtenbacher"].value,
            "both (printed 1/120)",
        ),
        (
            "D 5",
            "with the logarithm",
            "–",
            lambda: 100 * (1 - 60 * math.log1p(1 / 60)),
            "not printed",
        ),
        ("–", "over the stroke", "–", lambda: 100 * case["loss_crosshead"].value, over),
    ]
    shown = (
        (
            place,
            of,
            printed,
            _shown(value()),
            "%",
            _relative(float(printed), value()) if printed != "–" else "",
            why,
        )
        for place, of, printed, value, why in rows
    )
    return _own_book(
        "F. Redtenbacher, Der Maschinenbau (1862): friction loss of the crosshead", shown
    )


def _valves() -> str:
    rows = (
        (
            print.source,
            print.of,
            print.printed,
            _shown(print.computed),
            print.unit,
            _of_print(print),
            _judged_print(print),
        )
        for print in PRINTS
    )
    text = (
        "Dingler's Polytechnisches Journal and Bourne's Catechism of the Steam Engine. Infinite rods, except for the "
        "last engine of 1859 and that of 1891, whose connecting rods are given. No printed example with a finite "
        "eccentric rod is known: there the tests hold kurbel against a bisection in 40 digits, and against the "
        "eccentric as a slider-crank."
    )
    return _own_book("Valve gears in print, 1859 to 1892", rows).replace(
        "\n\n", f"\n\n{text}\n\n", 1
    )


def _of_print(one: Print) -> str:
    return _relative(float(one.printed), one.computed)


def _judged_print(one: Print) -> str:
    if one.agrees and not one.why:
        return "both"
    return f"kurbel; {one.why}"


def _table(*heads: str, rows: Iterable[Sequence[str]]) -> str:
    """Return a Markdown table; a head that begins with > is that of a column of figures."""
    marks = ("--:" if head.startswith(">") else "---" for head in heads)
    lines = [[head.removeprefix(">") for head in heads], marks, *rows]
    return "\n".join(f"| {' | '.join(cell.replace('|', '¦') for cell in line)} |" for line in lines)
