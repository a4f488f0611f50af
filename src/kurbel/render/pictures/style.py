"""How pictures look: the colours and strokes of their curves, in light and dark, told apart without colour, too."""

from dataclasses import dataclass

from kurbel.report.pictures.picture import Panel


@dataclass(frozen=True, eq=False)
class Look:
    """A curve's colour on a light and on a dark ground, and its stroke: lengths of dash and gap, none for a full line.

    character: what draws it where there are only letters.
    """

    light: str
    dark: str
    dashes: tuple[float, ...]
    character: str


LOOKS = (
    Look("#0b0b0b", "#f2f2f2", (), "*"),
    Look("#0062a3", "#6cc0f2", (8, 3), "+"),
    Look("#a8420a", "#f0a35e", (2, 2.5), "o"),
    Look("#00694f", "#3fd1a0", (9, 3, 2, 3), "x"),
    Look("#8f2f74", "#eaa0cf", (5, 2), "#"),
    Look("#6b5900", "#e6d354", (1, 3), "@"),
)
"""After Okabe and Ito, whom the colour-blind can tell apart, darkened or lightened to a contrast of 4.5."""


def looks_of(panel: Panel) -> list[int]:
    """Return the look of each curve of a panel: lines take one after the other."""
    found, following = [], 0
    for curve in panel.curves:
        own = following if curve.look is None else curve.look
        found.append(own % len(LOOKS))
        following += curve.kind in ("line", "dots")
    return found


SHAPES: tuple[tuple[tuple[float, float], ...], ...] = (
    (),
    ((-1, -1), (1, -1), (1, 1), (-1, 1)),
    ((0, -1.3), (1.2, 1), (-1.2, 1)),
    ((0, -1.4), (1.4, 0), (0, 1.4), (-1.4, 0)),
    ((0, 1.3), (1.2, -1), (-1.2, -1)),
    ((-1.4, -0.5), (1.4, -0.5), (1.4, 0.5), (-1.4, 0.5)),
    ((-0.5, -1.4), (0.5, -1.4), (0.5, 1.4), (-0.5, 1.4)),
)
"""Corners of the figures that mark points, over their radius; none is a circle. Seven of them and six colours."""

INK, PAPER = ("#1a1a1a", "#e8e8e8"), ("#ffffff", "#15181b")
FAINT, GRID = ("#5c5c5c", "#a5a5a5"), ("#dcdcdc", "#33383d")
GAIN, LOSS = ("#b9cfe2", "#2d4a63"), ("#f1dccd", "#59402c")
"""Each in light and in dark."""

_RULES = """\
.s{{background:{paper}}}
text{{font:11px system-ui,"DejaVu Sans",sans-serif;fill:{ink}}}
.h{{font-size:13px;font-weight:600}}.t{{font-size:10px}}
.f{{stroke:{faint};stroke-width:1;fill:none}}.g{{stroke:{grid};stroke-width:1;fill:none}}
.x{{stroke:{ink};stroke-width:1;fill:none}}.p{{fill:{gain}}}.n{{fill:{loss}}}
.o{{fill:{paper};stroke:{ink};stroke-width:1.2}}.m{{stroke:{ink};stroke-width:4;fill:none;stroke-linecap:round}}
.b{{fill:{grid};stroke:{ink};stroke-width:1.2}}.i{{fill:{ink};stroke:{ink};stroke-width:1.2}}
.halo{{paint-order:stroke;stroke:{paper};stroke-width:3px;stroke-linejoin:round}}
"""


def css() -> str:
    """Return the style sheet of pictures, for light and dark; paper is light."""
    still = "svg .moving{display:none}svg .still{display:inline}"
    return (
        f"{_sheet(0)}svg .still{{display:none}}@media (prefers-reduced-motion:reduce){{{still}}}@media print{{{still}}}"
        f"@media screen and (prefers-color-scheme:dark){{{_sheet(1)}}}"
    )


def _sheet(mode: int) -> str:
    named = {"ink": INK, "paper": PAPER, "faint": FAINT, "grid": GRID, "gain": GAIN, "loss": LOSS}
    rules = _RULES.format(**{name: colours[mode] for name, colours in named.items()}).replace("\n", "")
    for number, look in enumerate(LOOKS):
        colour = (look.light, look.dark)[mode]
        dashes = f";stroke-dasharray:{' '.join(f'{one:g}' for one in look.dashes)}" if look.dashes else ""
        rules += f".k{number}{{stroke:{colour};stroke-width:1.6;fill:none{dashes}}}.j{number}{{stroke:{colour};"
        rules += f"stroke-width:1.2;fill:none}}.c{number}{{fill:{colour};stroke:none}}"
    return rules
