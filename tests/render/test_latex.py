"""LaTeX that plain article with booktabs and longtable compiles: nothing but what these know."""

from __future__ import annotations

import pytest

from kurbel.mechanisms import every_quantity
from kurbel.render import Look, render
from kurbel.render.latex import symbol, text
from render.sample_report import REPORT


@pytest.mark.parametrize(
    ("plain", "typeset"),
    [
        ("a_b & 5 % # {x} ~ ^ \\ $", r"a\_b \& 5 \% \# \{x\} \textasciitilde{} \textasciicircum{} \textbackslash{} \$"),
        ('the "big" one', r"the \textquotedblright{}big\textquotedblright{} one"),  # \textquotedbl needs T1
        ("½ λ", r"$\frac12$ $\lambda$"),  # \tfrac needs amsmath
        ("[1] *", "{[}1] {*}"),  # \\[1] would be a distance, \\* a command
        ("ψ̇ and θ̈", r"$\dot{\psi}$ and $\ddot{\theta}$"),
        ("ν at ∠AB", r"$\nu$ at $\angle$AB"),
    ],
)
def test_texts(plain: str, typeset: str) -> None:
    assert text(plain) == typeset


def test_dots_stand_over_their_letter_in_a_symbol() -> None:
    assert symbol("θ̈_max") == r"$\ddot{\theta}_{\mathrm{max}}$"


def test_no_quantity_has_a_character_that_latex_does_not_know() -> None:
    for one in (*every_quantity().all_columns, *every_quantity().all_key_values):
        for written in (symbol(one.symbol), text(one.text), text(one.called)):
            assert all(ord(c) < 0x250 or c in "–—’‘“”" for c in written), one.id


def test_equal_cylinders_are_told_once() -> None:
    part = REPORT.parts[0]
    twice = REPORT._replace(parts=(part, part._replace(name="cylinder 2")), whole=None)
    assert "".join(render(twice, Look("latex"))).count("Key values") == 1
    assert "".join(render(twice, Look("html"))).count("<caption>Key values") == 1
