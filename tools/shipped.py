"""The page of the machines that come with kurbel: what each is and teaches, its picture, its results, its file.

The site includes the file itself (`--8<--`). `pytest --rewrite tests/project/test_documents.py` writes it, and the same on
tests/pictures/test_gallery.py its pictures.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from click.testing import CliRunner

import gallery  # tools/gallery.py
from kurbel.cli import kurbel
from kurbel.render.text import Look
from kurbel.tables.tables import grouped, together

_CONFIGS = Path(__file__).parent.parent / "configs"
_SHOWN = {
    "motion": (
        "stroke",
        "swing",
        "time_ratio",
        "c_m",
        "c_max",
        "b_max",
        "cut_off_head",
        "cut_off_crank",
    ),
    "forces": ("P_peak", "N_peak", "T_max", "work", "power", "mean_pressure", "loss_crosshead"),
    "flywheel": ("M_mean", "dE", "J", "delta"),
    "stress": ("safety_pin_min", "safety_web_A_min"),
    "balance": ("F_free_max", "M_free_max", "counterweight_best", "share_best", "hammer_blow"),
}
"""Command -> ids of its key values that the page shows, as far as a machine has them."""

_ROUNDING = 1e-9
"""A value below this is that of a sum that cancels, another on every processor."""

_HEAD = """# Machines that come with kurbel

`kurbel example` lists them, `kurbel example NAME > engine.yaml` copies one. Each begins with a comment on the source of
its figures and on what it shows; figures that the source prints are under `expect`, which `kurbel check` compares.
"""


def page() -> str:
    """Return the page: for each shipped machine its comment, answers, and file."""
    return "\n".join([_HEAD, *(_machine(file) for file in sorted(_CONFIGS.glob("*.yaml")))])


def _machine(file: Path) -> str:
    text = file.read_text(encoding="utf-8")
    picture = gallery.embedded(gallery.TEACHING[file.stem], file.stem)
    answers = "".join(_answers(command, ids, file) for command, ids in _SHOWN.items())
    table = f"| Key value | Value | At |\n| --- | --: | --: |\n{answers}".rstrip()
    source = f'<details markdown>\n<summary>The file</summary>\n\n```yaml\n--8<-- "{file.name}"\n```\n\n</details>'
    return f"## {file.stem}\n\n{_comment(text)}\n\n{picture}\n\n{table}\n\n{source}\n"


def _comment(text: str) -> str:
    """Return the comment at the head of a file as prose."""
    lines = []
    for line in text.splitlines():
        if not line.startswith("#"):
            break
        lines.append(line.removeprefix("#").strip())
    return "\n".join(line for line in lines if "$schema" not in line).strip()


def _answers(command: str, ids: tuple[str, ...], file: Path) -> str:
    """Return a row for each of these key values that the command prints for the machine; '' where it has none."""
    asked = [
        command,
        str(file),
        "-f",
        "json",
        "--units",
        "metric",
        "--digits",
        "4",
        "--angles",
        "0",
    ]
    ran = CliRunner().invoke(kurbel, asked)
    if ran.exit_code:
        return ""
    answer = json.loads(ran.stdout)
    equal = grouped(answer.get("cylinders", []), lambda one: repr(one["key_values"]))
    parts = [
        (together([part["name"] for part in parts]), parts[0]["key_values"]) for parts in equal
    ]
    several = len(parts) > 1
    parts.append(("", answer.get("machine_key_values", [])))
    rows = [
        f"| {_named(value, name if several else '')} | {value['value']:g} {Look().unit(value['unit'])} | {_angle(value)} |"
        for name, values in parts
        for value in values
        if value["id"] in ids and abs(value["value"]) > _ROUNDING
    ]
    return "".join(f"{row}\n" for row in dict.fromkeys(rows))


def _named(one: dict[str, Any], cylinder: str) -> str:
    return f"`{one['id']}`, {one['symbol']}" + (f", {cylinder}" if cylinder else "")


def _angle(one: dict[str, Any]) -> str:
    return f"{one['at_deg']:.1f}°" if "at_deg" in one else ""
