"""The page of the machines that come with kurbel: a table of what each shows, with its picture, its file and its topic.

`pytest --rewrite tests/project/test_documents.py` writes it, and the same on tests/pictures/test_gallery.py its pictures.
"""

from __future__ import annotations

import gallery  # tools/gallery.py
from kurbel.pictures.pictures import PICTURES
from kurbel.shipped import MODELINE, shipped

_TOPICS = {
    "": ("Motion", "mechanisms.md"),
    "balance": ("Balance", "balance.md"),
    "bearings": ("Oil film", "oil-film.md"),
    "delivery": ("Pumps", "delivery.md#pumps"),
    "flywheel": ("Flywheel", "flywheel.md"),
    "forces": ("Forces", "answers.md"),
    "harmonics": ("Orders", "torsion.md"),
    "motion": ("Slide valves", "valve.md"),
    "stress": ("Crankshaft", "crankshaft.md"),
    "torsion": ("Torsional vibration", "torsion.md"),
}
"""Command of the picture that teaches most of a machine -> the topic that explains it."""
_TOPICS_OF_MACHINES = {
    "compressor": ("Compressor", "compressor.md"),
    "compressor-two-stage": ("Rod load", "bearings.md"),
    "diesel-trace": ("Measured traces", "traces.md"),
    "odd-fire-v6": ("Engine layouts", "engine-layouts.md"),
    "radial-three": ("Engine layouts", "engine-layouts.md"),
    "steam-ideal": ("Machine file", "machine-file.md"),
    "vr6": ("Engine layouts", "engine-layouts.md"),
    "w9": ("Engine layouts", "engine-layouts.md"),
}
"""Machine -> its topic where that of the picture is another."""

_HEAD = """# Machines that come with kurbel

`kurbel example` lists them, `kurbel example NAME > engine.yaml` copies one. Each file begins with the source of its
figures; those that the source prints are under `expect`, and `kurbel example --check` compares them all.

| | machine | shows | topic |
|---|---|---|---|
"""


def page() -> str:
    """Return the page: a row for each shipped machine."""
    return _HEAD + "".join(_row(name, text) for name, text in shipped().items())


def _row(name: str, text: str) -> str:
    """Return the picture of a machine, its file, the first paragraph of its comment, and its topic."""
    picture_id = gallery.TEACHING[name]
    picture = next(picture for picture in PICTURES if picture.id == picture_id)
    topic, target = _TOPICS_OF_MACHINES.get(name, _TOPICS[picture.command])
    file = gallery.file_of(picture_id, name)
    cells = (
        f"[![{name}: {picture.title}]({file})]({file})",
        f"[{name}](../configs/{name}.yaml)",
        _first_paragraph(text).replace("|", "&#124;"),
        f"[{topic}]({target})",
    )
    return f"| {' | '.join(cells)} |\n"


def _first_paragraph(text: str) -> str:
    """Return the first paragraph of the comment at the head of a file."""
    lines = []
    for line in text.removeprefix(MODELINE).splitlines():
        words = line.removeprefix("#").strip()
        if not line.startswith("#") or not words:
            break
        lines.append(words)
    return " ".join(lines)
