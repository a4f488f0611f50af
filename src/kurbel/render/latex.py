r"""LaTeX: tables in the manner of booktabs, to be \input into a document that has \usepackage{booktabs, longtable}."""

import re
from collections.abc import Collection, Iterable, Iterator, Sequence
from typing import NamedTuple

from kurbel.render import Look
from kurbel.render.document import ON_PAPER, Table, document, key_value_table
from kurbel.render.sheet import MARK
from kurbel.report.tables import KeyValue, Report

_GREEK = {
    "φ": "varphi", "ψ": "psi", "θ": "theta", "ω": "omega", "δ": "delta", "λ": "lambda", "μ": "mu", "η": "eta",
    "π": "pi", "ρ": "varrho", "α": "alpha", "β": "beta", "κ": "kappa", "σ": "sigma", "τ": "tau", "Δ": "Delta",
    "ε": "varepsilon", "γ": "gamma", "ν": "nu",
    "ζ": "zeta", "ξ": "xi", "χ": "chi", "Φ": "Phi", "Ψ": "Psi", "Ω": "Omega", "Θ": "Theta", "∠": "angle",
    "Σ": "Sigma", "∮": "oint", "√": "surd", "∞": "infty", "·": "cdot", "×": "times", "≤": "le", "≥": "ge",
    "≈": "approx", "≠": "ne", "→": "to", "±": "pm", "−": "-", "²": "^2", "³": "^3", "°": "^\\circ", "′": "prime",
    "½": "frac12", "¼": "frac14", "⅔": "frac23", "₀": "_0", "…": "dots",
}  # fmt: skip
_POWERS = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
_SPECIAL = {
    "\\": r"\textbackslash{}", "{": r"\{", "}": r"\}", "$": r"\$", "&": r"\&", "#": r"\#", "%": r"\%", "_": r"\_",
    "^": r"\textasciicircum{}", "~": r"\textasciitilde{}", "<": r"\textless{}", ">": r"\textgreater{}",
    "|": r"\textbar{}", '"': r"\textquotedblright{}", "„": r"\quotedblbase{}", "[": "{[}", "*": "{*}",
}  # fmt: skip
"""Behind the end of a row a bracket or a star would belong to it."""
_DOTS = {"\u0307": "dot", "\u0308": "ddot"}


def latex(report: Report, look: Look) -> Iterator[str]:
    """Yield the report as LaTeX, one table after the other."""
    return document(report, look, _Latex(look))


_NARROW = r"{\small\setlength{\tabcolsep}{3pt}"
"""By which ten columns of numbers stand within the 345 pt of an article."""


class _Latex(NamedTuple):
    """Writes LaTeX; each table may run over several pages, its head on each."""

    look: Look
    across: int | None = ON_PAPER

    def title(self, plain: str) -> Iterator[str]:
        yield f"% \\usepackage{{booktabs, longtable}}\n\\subsection*{{{text(plain)}}}\n"

    def paragraph(self, plain: str) -> Iterator[str]:
        yield f"{text(plain)}\n\n"

    def table(self, table: Table) -> Iterator[str]:
        layout = "".join("l" if column.words else "r" for column in table.columns)
        return self._table(table, layout, (map(_cell, row) for row in table.rows))

    def key_values(self, title: str, found: Collection[KeyValue]) -> Iterator[str]:
        table = key_value_table(title, found, self.look)
        rows = ((symbol(name), *map(_cell, cells)) for name, *cells in table.rows)
        return self._table(table, "lrlrp{0.42\\linewidth}", rows)

    def items(self, title: str, lines: Sequence[str]) -> Iterator[str]:
        items = "".join(f"\\item {text(one)}\n" for one in lines)
        yield f"\\paragraph{{{text(title)}}}\n\\begin{{itemize}}\n{items}\\end{{itemize}}\n\n"

    def _table(self, table: Table, layout: str, rows: Iterable[Iterable[str]]) -> Iterator[str]:
        columns = table.columns
        yield f"{_NARROW}\\begin{{longtable}}{{@{{}}{layout}@{{}}}}\n"
        if table.caption:
            yield f"\\multicolumn{{{len(columns)}}}{{@{{}}l}}{{{text(table.caption)}}}\\\\\n"
        yield f"\\toprule\n{_row((text if one.words else symbol)(one.symbol) for one in columns)}"
        if any(one.unit for one in columns):
            yield _row(text(one.unit) for one in columns)
        yield "\\midrule\n\\endhead\n"
        yield from map(_row, rows)
        yield "\\bottomrule\n\\end{longtable}}\n\n"


def _row(cells: Iterable[str]) -> str:
    return f"{' & '.join(cells)}\\\\\n"


def text(plain: str) -> str:
    """Return a text with everything escaped that LaTeX would take for a command.

    >>> print(text("50 % of φ_1 ≤ 90°"))
    50 \\% of $\\varphi$\\_1 $\\le$ 90$^\\circ$
    """
    return "".join(_SPECIAL.get(one) or _math(one) for one in re.findall(".[\u0307\u0308]?", plain, re.DOTALL))


def _math(one: str) -> str:
    """Return a character, or a letter with the dots over it, as LaTeX sets it between words."""
    if one[1:]:
        return f"${_letter(one)}$"
    if one in "⁻⁰¹⁴⁵⁶⁷⁸⁹":
        return f"$^{{{one.translate(_POWERS)}}}$"
    found = _GREEK.get(one)
    if found is None:
        return one
    return f"${found}$" if found[0] in "-^_" else f"$\\{found}$"


def symbol(plain: str) -> str:
    """Return a symbol, what follows its underscore as its index.

    >>> print(symbol("P_b"), symbol("φ_P=0"), symbol("ΔE"))
    $P_{\\mathrm{b}}$ $\\varphi_{\\mathrm{P=0}}$ $\\Delta$E
    """
    found = re.fullmatch("((?:[A-Za-zΑ-ω][\u0307\u0308]?){1,3})_([\\w,=−+-]+)", plain)
    if not found:
        return text(plain)
    name, index = ("".join(map(_letter, re.findall(".[\u0307\u0308]?", part))) for part in found.groups())
    index = index.replace("_", "\\_").replace("\\-", "-")
    return f"${name}_{{\\mathrm{{{index}}}}}$"


def _letter(one: str) -> str:
    """Return a letter within a formula, with the dots that stand over it."""
    base = f"\\{_GREEK[one[0]]}" if one[0] in _GREEK else one[0]
    return f"\\{_DOTS[one[1]]}{{{base}}}" if one[1:] else base


def _cell(plain: str) -> str:
    plain = plain.strip()
    if plain.endswith(MARK):
        return f"\\textbf{{{text(plain[:-1])}}}"
    # a minus sign, not a hyphen, before a number
    return f"$-${text(plain[1:])}" if re.match(r"-[0-9]", plain) else text(plain)
