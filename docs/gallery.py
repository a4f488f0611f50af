"""Write docs/gallery.md and its pictures: every picture that kurbel draws, each by the command that stands above it.

python docs/gallery.py
"""

from __future__ import annotations

from pathlib import Path

from kurbel.machine_file import load
from kurbel.render import Look
from kurbel.render.output import write_file
from kurbel.render.pictures.svg import svg_file
from kurbel.report.pictures import PICTURES, Wish, pictures
from kurbel.solver.case import Case

FOLDER = Path(__file__).parent
CONFIGS = FOLDER.parent / "configs"
MACHINES = {
    "free-orders": "v8-cross-plane",
    "effort": "waterworks-two-cranks",
    "throw-stress": "gas-engine",
    "card-volume": "compressor",
    "bearing-loads": "gas-engine",
    "orders": "marine-diesel",
    "modes": "marine-diesel",
}
"""Picture -> the shipped machine that shows it best; the others are of the waterworks engine."""
USUAL = "waterworks"
MOVING = ("scotch-yoke-pump", "shaper", "crank-rocker", "coupled-axle", "yoke-frame-pump")
"""The other mechanisms of the book."""


def shown() -> list[tuple[str, str]]:
    """Return every picture with the machine that it is of."""
    return [*((one.id, MACHINES.get(one.id, USUAL)) for one in PICTURES), *(("mechanism", name) for name in MOVING)]


def svg_of(id: str, machine: str) -> str:
    """Return a picture of a shipped machine, of its first cylinder where it has several, as SVG."""
    case = Case(load(CONFIGS / f"{machine}.yaml"))
    first = next(pictures(case, (id,), Wish()))
    return "".join(svg_file([first], Look()))


def page() -> str:
    """Return the page."""
    titles = {one.id: one for one in PICTURES}
    blocks = [
        "# Gallery",
        "Every picture that `kurbel plot` draws, of machines that come with kurbel; `--list` says which "
        "of them a machine has. `python docs/gallery.py` writes this page.",
    ]
    for id, machine in shown():
        one = titles[id]
        heading = one.title if machine in (USUAL, MACHINES.get(id)) else f"{one.title}: {machine}"
        blocks += [
            f"## {heading}",
            f"```sh\nkurbel plot configs/{machine}.yaml {id} -o {id}.svg\n```",
            f"![{one.text}](gallery/{machine}-{id}.svg)",
            one.text,
        ]
    return "\n\n".join(blocks) + "\n"


def main() -> None:
    """Write the page and its pictures."""
    (FOLDER / "gallery").mkdir(exist_ok=True)
    for id, machine in shown():
        write_file(str(FOLDER / "gallery" / f"{machine}-{id}.svg"), (svg_of(id, machine),))
    write_file(str(FOLDER / "gallery.md"), (page(),))


if __name__ == "__main__":
    main()
