"""A check as JSON: one object, a line for every finding."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from kurbel.render.json_text import head, json_lines, provenance

if TYPE_CHECKING:
    from kurbel.render import Look
    from kurbel.report.findings import Findings


def findings_json(found: Findings, look: Look) -> Iterator[str]:
    """Return one JSON object in pieces."""
    content = {
        **head("check"),
        "machine": found.machine,
        **provenance(found.provenance),
        "findings": [one._asdict() for one in found.findings],
    }
    return json_lines(content, look)
