r"""The second pass for markup: `document` writes a report with a writer for Markdown, HTML or LaTeX.

A writer has no knowledge of reports. Its methods `text`, `sentence`, `symbol`, `words` and `prose` take plain text and
escape it; all others take escaped text. LaTeX is to be \input into a document with \usepackage{booktabs, longtable}.
"""

import math
import re
from abc import ABC, abstractmethod
from collections.abc import Collection, Iterable, Iterator, Sequence
from html import escape

from kurbel.render import Look
from kurbel.render.style import page_css
from kurbel.render.text import measures, subscripts, width
from kurbel.render.text_tables import (
    MARK,
    TextColumn,
    TextTable,
    headed,
    key_value_table,
    part_name,
    place_table,
    sheets,
)
from kurbel.tables.sources import legend_of
from kurbel.tables.tables import Report, for_people, notes_for_people

_ON_PAPER = 9
"""Columns of numbers, apart from that of the angle, that fit on A4; further ones go into another table."""
_PAGE, _GAP = 112, 2
"""Characters of a line that fit on a page of HTML on paper, and those between two columns."""


class Writer(ABC):
    """A writer of one format: its elements are templates for escaped text.

    parting: what is between the cells of a line.
    """

    title = paragraph = strong = list_head = item = list_end = line = parting = table_end = ""

    def __init__(self, look: Look) -> None:
        self.look = look

    def pages_across(self, table: TextTable) -> int:
        """Return into how many parts a table is divided by its columns, so that each fits on a page."""
        return math.ceil(len(table.columns[table.heads :]) / _ON_PAPER)

    @abstractmethod
    def text(self, plain: str) -> str:
        """Return a text in which everything is escaped that would be taken for markup."""

    def sentence(self, plain: str) -> str:
        """Return an escaped sentence."""
        return self.text(plain)

    def symbol(self, plain: str) -> str:
        """Return an escaped symbol."""
        return self.sentence(plain)

    def words(self, text: str) -> str:
        """Return a text of a report, in the characters of the output, escaped."""
        return self.text(self.look.text(text))

    def prose(self, text: str) -> str:
        """Return a sentence of a report, its numbers as they are wanted, escaped."""
        return self.sentence(self.look.sentence(text))

    @abstractmethod
    def table_head(self, table: TextTable, caption: str, heads: Sequence[tuple[str, str]]) -> str:
        """Return the beginning of a table; heads: symbol and unit of each column."""

    def row(self, table: TextTable, number: int, cells: Sequence[str]) -> str:
        """Return a row."""
        return self.line.format(self.parting.join(cells))


class Markdown(Writer):
    """Markdown: one line for each row, a blank line between elements."""

    title, paragraph, strong = "## {}\n", "\n{}\n", "**{}**"
    list_head, item, line, parting = "\n### {}\n\n", "- {}\n", "| {} |\n", " | "

    def pages_across(self, table: TextTable) -> int:
        """Return 1: a line has any length."""
        return 1

    def text(self, plain: str) -> str:
        return re.sub(r"([\\|*_<>`\[\]])", r"\\\1", plain)

    def table_head(self, table: TextTable, caption: str, heads: Sequence[tuple[str, str]]) -> str:
        """Return title, heads, and the line that sets the alignment of the columns."""
        titles = [f"{symbol} ({unit})" if unit else symbol.strip() for symbol, unit in heads]
        rules = ["---" if column.words else "--:" for column in table.columns]
        titled = f"\n### {caption}\n" if caption else ""
        return f"{titled}\n{self.row(table, 0, titles)}{self.row(table, 0, rules)}"


class Html(Writer):
    """HTML: the content of the body of a page."""

    title, paragraph, strong = "<h1>{}</h1>\n", "<p>{}</p>\n", "<b>{}</b>"
    list_head, item, list_end = "<h2>{}</h2>\n<ul>\n", "<li>{}</li>\n", "</ul>\n"
    table_end = "</tbody></table></div>\n"

    def pages_across(self, table: TextTable) -> int:
        """Return into how many parts a table is divided, by the widths of its columns; at most those of other formats."""
        names, columns = table.columns[: table.heads], table.columns[table.heads :]
        room = _PAGE - sum(map(_room_of, names))
        by_width = math.ceil(sum(map(_room_of, columns)) / max(room, 1))
        return min(by_width, super().pages_across(table))

    def text(self, plain: str) -> str:
        return escape(plain)

    def sentence(self, plain: str) -> str:
        """Return a text with no line break between a number and its unit, and with subscripts.

        >>> print(Html(Look()).sentence("φ_P=0"), Html(Look()).sentence("T_max 5.1 kN"))
        φ<sub>P=0</sub> T<sub>max</sub> <span class="n">5.1 kN</span>
        """
        parts = subscripts(measures().sub(r'<span class="n">\g<0></span>', self.text(plain)))
        parts[1::2] = [f"<sub>{part}</sub>" for part in parts[1::2]]
        return "".join(parts)

    def table_head(self, table: TextTable, caption: str, heads: Sequence[tuple[str, str]]) -> str:
        """Return the beginning of a table, which can be scrolled in a narrow window."""
        cells = []
        for column, (symbol, unit) in zip(table.columns, heads):
            below = f"<br><small>{unit}</small>" if unit else ""
            cells.append(f'<th scope="col"{_right(not column.words)}>{symbol}{below}</th>')
        titled = f"<caption>{caption}</caption>" if caption else ""
        label = caption or "values over the crank angle"
        room = "wide narrow" if _is_narrow(table) else "wide"
        return (
            f'<div class="{room}" tabindex="0" role="region" aria-label="{label}">'
            f"<table>{titled}\n"
            f"<thead><tr>{''.join(cells)}</tr></thead>\n<tbody>\n"
        )

    def row(self, table: TextTable, number: int, cells: Sequence[str]) -> str:
        """Return a row; lists of numbers and long names may be wrapped."""
        shown = []
        for index, (column, cell) in enumerate(zip(table.columns, cells)):
            is_list = number in table.lists and index == 1
            side = ' class="l"' if is_list else _right(not column.words)
            if index >= table.heads:
                shown.append(f"<td{side}>{cell}</td>")
                continue
            name = cell.replace(".", ".<wbr>") if column.words else cell
            shown.append(f'<th scope="row"{side}>{name}</th>')
        verdict = f' class="{table.verdicts[number]}"' if table.verdicts else ""
        return f"<tr{verdict}>{''.join(shown)}</tr>\n"


def _is_narrow(table: TextTable) -> bool:
    """Return whether a table takes less than half of a page of paper, so that two are next to each other."""
    return sum(map(_room_of, table.columns)) <= _PAGE // 2


def _room_of(column: TextColumn) -> int:
    """Return the characters of a line that a column takes, with the gap to the next one."""
    texts = (column.symbol, column.unit, *column.cells)
    return max(width(text.strip()) for text in texts) + _GAP


def _right(number: bool) -> str:
    return ' class="r"' if number else ""


_NAMES = (
    "varphi psi theta omega delta lambda mu eta pi varrho alpha beta kappa sigma tau varepsilon gamma nu zeta xi chi "
    "Phi Psi Omega Theta Sigma Delta"
)
_MATH = {
    **dict(zip("φψθωδλμηπραβκστεγνζξχΦΨΩΘΣΔ", _NAMES.split())),
    "∠": "angle", "∮": "oint", "√": "surd", "∞": "infty", "·": "cdot", "×": "times", "≤": "le", "≥": "ge",
    "≈": "approx", "≠": "ne", "→": "to", "±": "pm", "−": "-", "°": "^\\circ", "′": "prime", "½": "frac12",
    "¼": "frac14", "⅔": "frac23", "₀": "_0", "…": "dots", "²": "^2", "³": "^3",
    **{power: f"^{{{plain}}}" for power, plain in zip("⁻⁰¹⁴⁵⁶⁷⁸⁹", "-01456789")},
}  # fmt: skip
"""Character -> its command in a formula, without the backslash; what begins with -, ^ or _ is no command."""
_SPECIAL = {
    **{letter: f"\\{letter}" for letter in "{}$&#%_"}, "\\": r"\textbackslash{}", "^": r"\textasciicircum{}",
    "~": r"\textasciitilde{}", "<": r"\textless{}", ">": r"\textgreater{}", "|": r"\textbar{}",
    '"': r"\textquotedblright{}", "„": r"\quotedblbase{}", "[": "{[}", "*": "{*}", "\N{NARROW NO-BREAK SPACE}": r"\,",
}  # fmt: skip
"""Character -> how LaTeX writes it; a bracket or a star right after the end of a row would be its argument."""
_DOTS = {"\u0307": "dot", "\u0308": "ddot"}
_LETTER = "(?s).[\u0307\u0308]?"
"""A character, or a letter with the dots over it."""
_INDEXED = "((?:[A-Za-zΑ-ω][\u0307\u0308]?){1,3})_([\\w,=−+-]+)"


class Latex(Writer):
    """LaTeX: tables in the style of booktabs, which may run over several pages with the heads on each."""

    title, paragraph = "% \\usepackage{{booktabs, longtable}}\n\\subsection*{{{}}}\n", "{}\n\n"
    strong = "\\textbf{{{}}}"
    list_head, item = "\\paragraph{{{}}}\n\\begin{{itemize}}\n", "\\item {}\n"
    list_end, table_end = "\\end{itemize}\n\n", "\\bottomrule\n\\end{longtable}}\n\n"
    line, parting = "{}\\\\\n", " & "

    def text(self, plain: str) -> str:
        r"""Return a text in which everything is escaped that LaTeX would take for a command.

        >>> print(Latex(Look()).text("50 % of φ_1 ≤ 90°"), Latex(Look()).text("−3"))
        50 \% of $\varphi$\_1 $\le$ 90$^\circ$ $-$3
        """
        return "".join(map(_in_text, re.findall(_LETTER, plain)))

    def symbol(self, plain: str) -> str:
        r"""Return a symbol, with what follows its underscore as a subscript.

        >>> print(*map(Latex(Look()).symbol, ("P_b", "φ_P=0", "ΔE")))
        $P_{\mathrm{b}}$ $\varphi_{\mathrm{P=0}}$ $\Delta$E
        """
        indexed = re.fullmatch(_INDEXED, plain)
        if not indexed:
            return self.text(plain)
        formulas = []
        for part in indexed.groups():
            formulas.append("".join(map(_formula, re.findall(_LETTER, part))))
        name, index = formulas
        return f"${name}_{{\\mathrm{{{index}}}}}$"

    def table_head(self, table: TextTable, caption: str, heads: Sequence[tuple[str, str]]) -> str:
        r"""Return the beginning of a table; by \tabcolsep ten columns of numbers fit the 345 pt of an article."""
        layouts = {"number": "r", "name": "l", "symbol": "l", "sentence": "p{0.42\\linewidth}"}
        layout = "".join(layouts[column.kind] for column in table.columns)
        text = f"{{\\small\\setlength{{\\tabcolsep}}{{3pt}}\\begin{{longtable}}{{@{{}}{layout}@{{}}}}\n"
        if caption:
            text += f"\\multicolumn{{{len(heads)}}}{{@{{}}l}}{{{caption}}}\\\\\n"
        text += "\\toprule\n" + self.row(table, 0, [symbol for symbol, _ in heads])
        if any(unit for _, unit in heads):
            text += self.row(table, 0, [unit for _, unit in heads])
        return text + "\\midrule\n\\endhead\n"


def _in_text(letter: str) -> str:
    """Return a character, or a letter with dots over it, as it is written in a text."""
    if letter in _SPECIAL:
        return _SPECIAL[letter]
    is_formula = len(letter) > 1 or letter in _MATH
    if not is_formula:
        return letter
    return f"${_formula(letter)}$"


def _formula(letter: str) -> str:
    """Return a character, or a letter with dots over it, as it is written in a formula."""
    base, dots = letter[0], letter[1:]
    written = "\\_" if base == "_" else base
    if base in _MATH:
        command = _MATH[base]
        written = command if command[0] in "-^_" else f"\\{command}"
    if not dots:
        return written
    return f"\\{_DOTS[dots]}{{{written}}}"


# the report, element by element


def document(report: Report, out: Writer) -> Iterator[str]:
    """Yield the text of the report piece by piece; identical cylinders appear once."""
    report, look = for_people(report), out.look
    yield out.title.format(out.words(report.title))
    for text in report.head:
        yield out.paragraph.format(out.prose(text))
    yield from written(over_angle(report, out), out)
    yield from written(place_tables_of(report, out), out)
    for note in notes_for_people(report):
        yield out.paragraph.format(out.prose(note))
    for part in report.all_parts:
        name = part_name(report, part, look)
        of = f": {name}" if name else ""
        for heading, key_values in headed(part.key_values).items():
            under = f", {heading.lower()}" if heading else ""
            caption = f"Key values{of}{under}"
            if key_values:
                yield from written([key_value_table(caption, key_values, look)], out)
        left_out = [f"{reason.what}: {reason.why}" for reason in part.left_out]
        yield from listed(f"Left out{of}", left_out, out)
        yield from listed(f"Warnings{of}", part.warnings, out)
    books = legend_of(report)
    if books:
        yield out.paragraph.format(out.prose(books))


def listed(title: str, sentences: Collection[str], out: Writer) -> Iterator[str]:
    """Yield a list of sentences under a title, or nothing if there are none."""
    if sentences:
        yield out.list_head.format(out.text(title))
        yield from (out.item.format(out.prose(sentence)) for sentence in sentences)
        yield out.list_end


def over_angle(report: Report, out: Writer) -> Iterator[TextTable]:
    """Yield the tables over the crank angle, in parts that are not too wide."""
    for heads, bands in sheets(report, out.look):
        for name, columns in bands:
            yield from _parts_of(TextTable(name, [*heads, *columns], len(heads)), out)


def place_tables_of(report: Report, out: Writer) -> Iterator[TextTable]:
    """Yield the tables of places, in parts that are not too wide."""
    for printed_table in report.printed_tables:
        yield from _parts_of(place_table(printed_table, out.look), out)


def _parts_of(table: TextTable, out: Writer) -> Iterator[TextTable]:
    """Yield the parts of a table, each with the columns that name the rows."""
    names, columns = table.columns[: table.heads], table.columns[table.heads :]
    most = max(math.ceil(len(columns) / max(out.pages_across(table), 1)), 1)
    for start in range(0, max(len(columns), 1), most):
        yield table._replace(columns=[*names, *columns[start : start + most]])


def written(tables: Iterable[TextTable], out: Writer) -> Iterator[str]:
    """Yield tables row by row."""
    escapes = {
        "number": out.text,
        "name": out.sentence,
        "symbol": out.symbol,
        "sentence": out.sentence,
    }
    for table in tables:
        heads = []
        for column in table.columns:
            escape_head = out.text if column.words else out.symbol
            heads.append((escape_head(column.symbol), out.text(column.unit)))
        yield out.table_head(table, out.text(table.caption), heads)
        for number, row in enumerate(zip(*(column.cells for column in table.columns))):
            cells = []
            for column, text in zip(table.columns, map(str.strip, row)):
                if text.endswith(MARK):
                    cells.append(out.strong.format(out.text(text.removesuffix(MARK))))
                else:
                    cells.append(escapes[column.kind](text))
            yield out.row(table, number, cells)
        yield out.table_end


def markup(report: Report, look: Look) -> Iterator[str]:
    """Return the text of the report in the format of the look; in HTML it is a page of its own."""
    if look.format == "html":
        return html_page(look.text(report.title), document(report, Html(look)), page_css())
    return document(report, Latex(look) if look.format == "latex" else Markdown(look))


def html_page(title: str, main: Iterable[str], style: str) -> Iterator[str]:
    """Yield a self-contained page: no script, nothing from elsewhere, which the browser enforces."""
    yield (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; "
        'img-src data:">\n'
        f'<meta name="color-scheme" content="light dark">\n<title>{escape(title)}</title>\n'
        f"<style>\n{style}</style>\n</head>\n<body>\n<main>\n"
    )
    yield from main
    yield "</main>\n</body>\n</html>\n"
