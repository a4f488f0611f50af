r"""LaTeX: tables in the manner of booktabs, to be \input into a document that has \usepackage{booktabs, longtable}."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

from kurbel.render.html import number_text
from kurbel.render.numbers import angle
from kurbel.render.prose import sentence_text
from kurbel.render.sheet import MARK, part_name, sheets
from kurbel.report.alike import told_once

if TYPE_CHECKING:
    from kurbel.render import Look
    from kurbel.report.tables import KeyValue, Part, Report

_ACROSS = 9
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
    report = told_once(report)
    yield "% \\usepackage{booktabs, longtable}\n"
    yield f"\\subsection*{{{text(look.charset.text(report.title))}}}\n"
    yield from (text(look.charset.text(one)) + "\n\n" for one in report.head)
    yield from _angle_tables(report, look)
    yield from _place_tables(report, look)
    yield from (text(sentence_text(one, look)) + "\n\n" for one in (report.mirrored, *report.notes) if one)
    for part in report.all_parts:
        yield from _of_part(part_name(report, part, look), part, look)


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


def _angle_tables(report: Report, look: Look) -> Iterator[str]:
    for sheet in sheets(report, look):
        for band in sheet.bands:
            for start in range(0, max(len(band.rows), 1), _ACROSS):
                columns = [*sheet.heads, *band.rows[start : start + _ACROSS]]
                heads = [(symbol(row.symbol), row.unit) for row in columns]
                yield from _table(band.name, "r" * len(heads), heads, zip(*(row.cells for row in columns)))


def _place_tables(report: Report, look: Look) -> Iterator[str]:
    from kurbel.render.place_table import cells_of

    for one in (one for part in report.all_parts for one in part.place_tables):
        cells = cells_of(one, look)
        for start in range(0, max(len(cells.heads), 1), _ACROSS):
            across = slice(start, start + _ACROSS)
            heads = [*((text(head), "") for head in one.heads), *((symbol(s), u) for s, u in cells.heads[across])]
            rows = ((*names, *texts[across]) for names, texts in zip(cells.names, cells.rows))
            layout = "l" * len(one.heads) + "r" * (len(heads) - len(one.heads))
            yield from _table(look.charset.text(one.title), layout, heads, rows)


def _table(caption: str, layout: str, heads: Sequence[tuple[str, str]], rows: Iterable[Sequence[str]]) -> Iterator[str]:
    """Yield a table that may run over several pages, its head on each."""
    yield f"\\begin{{longtable}}{{@{{}}{layout}@{{}}}}\n"
    if caption:
        yield f"\\multicolumn{{{len(layout)}}}{{@{{}}l}}{{{text(caption)}}}\\\\\n"
    yield f"\\toprule\n{' & '.join(head for head, _ in heads)}\\\\\n"
    if any(unit for _, unit in heads):
        yield f"{' & '.join(text(unit) for _, unit in heads)}\\\\\n"
    yield "\\midrule\n\\endhead\n"
    for row in rows:
        yield f"{' & '.join(_cell(one.strip()) for one in row)}\\\\\n"
    yield "\\bottomrule\n\\end{longtable}\n\n"


def _cell(plain: str) -> str:
    if plain.endswith(MARK):
        return f"\\textbf{{{text(plain[:-1])}}}"
    # a minus sign, not a hyphen, before a number
    return f"$-${text(plain[1:])}" if re.match(r"-[0-9]", plain) else text(plain)


def _of_part(name: str, part: Part, look: Look) -> Iterator[str]:
    said = f": {name}" if name else ""
    if part.key_values:
        yield from _key_values(f"Key values{said}", part.key_values, look)
    for title, lines in (
        ("Left out", [f"{one.what}: {one.why}" for one in part.left_out]),
        ("Warnings", list(part.warnings)),
    ):
        if lines:
            items = "".join(f"\\item {text(sentence_text(one, look))}\n" for one in lines)
            yield f"\\paragraph{{{text(title + said)}}}\n\\begin{{itemize}}\n{items}\\end{{itemize}}\n\n"


def _key_values(caption: str, found: Iterable[KeyValue], look: Look) -> Iterator[str]:
    yield "\\begin{longtable}{@{}lrlrp{0.42\\linewidth}@{}}\n"
    yield f"\\multicolumn{{5}}{{@{{}}l}}{{{text(caption)}}}\\\\\n\\toprule\n"
    yield "Symbol & Value & Unit & At & Meaning\\\\\n\\midrule\n\\endhead\n"
    for one in found:
        at = "" if one.at_deg is None else text(angle(one.at_deg, look.comma) + look.charset.degree)
        cells = (
            symbol(look.charset.symbol(one.symbol, one.ascii_symbol)),
            _cell(number_text(one, look)),
            text(look.charset.unit(one.unit)),
            at,
            text(sentence_text(one.text, look)),
        )
        yield f"{' & '.join(cells)}\\\\\n"
    yield "\\bottomrule\n\\end{longtable}\n\n"
