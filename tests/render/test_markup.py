"""Markup: every text is escaped, and LaTeX uses nothing but what article, booktabs and longtable know."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest

from command import run
from kurbel.quantities import every_quantity
from kurbel.render import Look
from kurbel.render.formats import render
from kurbel.render.markup import Latex
from kurbel.tables.tables import KeyValue, LeftOut, Part, PlaceTable, Report
from render.sample_report import ONE, PHI
from representative import CONFIGS


@pytest.mark.parametrize(
    ("plain", "typeset"),
    [
        (
            "a_b & 5 % # {x} ~ ^ \\ $",
            r"a\_b \& 5 \% \# \{x\} \textasciitilde{} \textasciicircum{} \textbackslash{} \$",
        ),
        (
            'the "big" one',
            r"the \textquotedblright{}big\textquotedblright{} one",
        ),  # \textquotedbl needs T1
        ("½ λ", r"$\frac12$ $\lambda$"),  # \tfrac needs amsmath
        ("[1] *", "{[}1] {*}"),  # \\[1] would be a distance, \\* a command
        ("ψ̇ and θ̈", r"$\dot{\psi}$ and $\ddot{\theta}$"),
        ("ν at ∠AB", r"$\nu$ at $\angle$AB"),
    ],
)
def test_texts(plain: str, typeset: str) -> None:
    assert Latex(Look()).text(plain) == typeset


@pytest.mark.parametrize(
    ("plain", "typeset"),
    [("θ̈_max", r"$\ddot{\theta}_{\mathrm{max}}$"), ("x^2_a{b", r"x\textasciicircum{}2\_a\{b")],
)
def test_symbols(plain: str, typeset: str) -> None:
    assert Latex(Look()).symbol(plain) == typeset


HOSTILE = r"\end{document}<script>|a|* [x](y) `z` $ & # % _ ^ ~ { } > -1"
"""A name from a file that every format would take for markup."""


@pytest.mark.parametrize("format", ["markdown", "html", "latex"])
def test_every_text_is_escaped(format: str) -> None:
    """One walk, one door: wherever a text stands, none of its marks works."""
    column = ONE.parts[0].columns[1]._replace(symbol=HOSTILE, unit=HOSTILE)
    one = KeyValue("x", HOSTILE, HOSTILE, HOSTILE, 1.0, HOSTILE)
    places = PlaceTable(
        "t", HOSTILE, (HOSTILE,), ((HOSTILE,),), (column._replace(values=(1.0,)),), headed=True
    )
    part = Part(HOSTILE, (PHI, column), (one,), (LeftOut(HOSTILE, HOSTILE),), (HOSTILE,), (places,))
    report = Report(
        HOSTILE, "forces", HOSTILE, "cylinders", (part, part._replace(key_values=())), None, HOSTILE
    )
    text = render(report._replace(notes=(HOSTILE,), head=(HOSTILE,)), Look(format))
    marks = {
        "markdown": r"(?<!\\)(<script|\|a|\[x|`z)",
        "html": "<script",
        "latex": r"\\end\{document|(?<!\\)[&%#_] [#%_^]",
    }
    assert not re.search(marks[format], text)


def test_no_quantity_has_a_character_that_latex_does_not_know() -> None:
    for one in (*every_quantity().all_columns, *every_quantity().all_key_values):
        for written in (
            Latex(Look()).symbol(one.symbol),
            *map(Latex(Look()).text, (one.text, one.called)),
        ):
            assert all(ord(c) < 0x250 or c in "–—’‘“”" for c in written), one.id


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("pdflatex") is None, reason="no pdflatex on this machine")
@pytest.mark.parametrize(
    "words",
    [
        "forces waterworks",
        "forces waterworks --key-values",
        "stress gas-engine",
        "torsion marine-diesel",
        "table",
    ],
)
def test_an_article_takes_it_in_and_nothing_is_too_wide(words: str, tmp_path: Path) -> None:
    command = [str(CONFIGS.get(word, word)) for word in words.split()]
    done = run(*command, "-f", "latex", "-o", tmp_path / "tables.tex")
    assert done.exit_code == 0
    body = "\\usepackage{booktabs,longtable}\\begin{document}\\input{tables}\\end{document}"
    (tmp_path / "article.tex").write_text(f"\\documentclass{{article}}{body}", encoding="utf-8")
    command = ["pdflatex", "-interaction=nonstopmode", "-halt-on-error", "article"]
    for _ in range(2):  # longtable knows the widths of its columns from the second run on
        said = subprocess.run(
            command, cwd=tmp_path, capture_output=True, timeout=60, check=True
        ).stdout
    assert not re.search(b"Overfull|Missing character", said)
