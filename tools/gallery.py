"""The pictures of the pages: every one that kurbel draws for docs/gallery.md, one of each machine for docs/machines.md.

`pytest --rewrite tests/pictures/test_gallery.py` writes the gallery and the files of both.
"""

from __future__ import annotations

from pathlib import Path

from kurbel.machine_file import load
from kurbel.pictures.picture_source import PictureOptions
from kurbel.pictures.pictures import PICTURES, pictures
from kurbel.render import Look
from kurbel.render.svg import svg_file
from kurbel.solver.case import Case

CONFIGS = Path(__file__).parent.parent / "configs"
TEACHING = {
    "boxer": "free-angle",
    "compressor": "card-volume",
    "compressor-two-stage": "effort",
    "coupled-axle": "mechanism",
    "coupled-blower": "orders",
    "crank-rocker": "mechanism",
    "diesel-four-stroke": "piston-force",
    "diesel-trace": "card",
    "diesel-two-stroke": "card",
    "four-cylinder-generator": "effort",
    "four-in-line": "free-orders",
    "four-throws": "throw-stress",
    "gas-engine": "journal-orbit",
    "gas-engine-double-acting": "effort",
    "generator-coupling": "modes",
    "locomotive": "forces",
    "locomotive-link": "valve-ellipse",
    "locomotive-two-cylinders": "free-angle",
    "marine-diesel": "modes",
    "mill-engine": "zeuner",
    "odd-fire-v6": "free-orders",
    "offset-engine": "mechanism",
    "plunger-pump": "flow",
    "petrol-engine": "heat-release",
    "press": "effort",
    "pumpjack": "mechanism",
    "punch": "effort",
    "radial-three": "free-vectors",
    "scotch-yoke-pump": "mechanism",
    "shaper": "mechanism",
    "steam-ideal": "card",
    "torsional-damper": "modes",
    "triplex-pump": "flow",
    "v8-cross-plane": "free-orders",
    "vr6": "mechanism",
    "w9": "free-angle",
    "waterworks": "piston-force",
    "waterworks-two-cranks": "effort",
    "wobbler": "mechanism",
    "yoke-frame-pump": "mechanism",
}
"""Shipped machine -> the picture that teaches most of it."""
BEST = {
    "bearing-loads": "gas-engine",
    "campbell": "torsional-damper",
    "card-volume": "compressor",
    "effort": "waterworks-two-cranks",
    "flow": "triplex-pump",
    "effort-cranks": "waterworks-two-cranks",
    "effort-sides": "waterworks-two-cranks",
    "free-orders": "v8-cross-plane",
    "heat-release": "diesel-trace",
    "journal-orbit": "gas-engine",
    "modes": "marine-diesel",
    "orders": "marine-diesel",
    "reuleaux": "mill-engine",
    "rod-load": "compressor-two-stage",
    "throw-stress": "gas-engine",
    "trace-cycles": "diesel-trace",
    "trace-lines": "diesel-trace",
    "valve-ellipse": "mill-engine",
    "zeuner": "mill-engine",
}
"""Picture -> the shipped machine that shows it best; the others are of the waterworks engine."""
USUAL = "waterworks"
MOVING = (
    "scotch-yoke-pump",
    "shaper",
    "crank-rocker",
    "coupled-axle",
    "yoke-frame-pump",
    "wobbler",
)
"""The other mechanisms of the book."""
SET = {"effort-cranks": "efficiency=0.9", "piston-force-crank": "efficiency=0.9"}
"""Picture -> what is set for it: without losses no line differs by them."""
_DECLARED = {picture.id: picture for picture in PICTURES}


def shown() -> list[tuple[str, str]]:
    """Return every picture of the gallery with the machine that it is of."""
    others = [*(("mechanism", name) for name in MOVING), ("construction", "shaper")]
    return [*((id, BEST.get(id, USUAL)) for id in _DECLARED), *others]


def every_file() -> dict[str, tuple[str, str]]:
    """Return the files of both pages, each with its picture and machine."""
    drawn = [*shown(), *((id, machine) for machine, id in TEACHING.items())]
    return {file_of(id, machine): (id, machine) for id, machine in drawn}


def file_of(id: str, machine: str) -> str:
    """Return the file of a picture, as the pages name it."""
    return f"gallery/{machine}-{id}.svg"


def embedded(id: str, machine: str) -> str:
    """Return a picture as Markdown, with what it shows for those who do not see it."""
    return f"![{machine}: {_DECLARED[id].text}]({file_of(id, machine)})"


def svg_of(id: str, machine: str) -> str:
    """Return a picture of a shipped machine, of its first cylinder where it has several, as SVG."""
    case = Case(load(CONFIGS / f"{machine}.yaml", [SET[id]] if id in SET else []))
    first = next(pictures(case, (id,), PictureOptions()))
    return svg_file([first], Look())


def page() -> str:
    """Return the page of the gallery."""
    blocks = [
        "# Gallery",
        "Every picture that `kurbel plot` draws, of machines that come with kurbel; `--list` lists those of a machine.",
    ]
    for id, machine in shown():
        one = _DECLARED[id]
        heading = one.title if machine in (USUAL, BEST.get(id)) else f"{one.title}: {machine}"
        more = f" --set {SET[id]}" if id in SET else ""
        blocks += [
            f"## {heading}",
            f"```sh\nkurbel plot configs/{machine}.yaml {id}{more} -o {id}.svg\n```",
            embedded(id, machine),
            one.text,
        ]
    return "\n\n".join(blocks) + "\n"
