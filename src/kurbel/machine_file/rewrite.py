"""A machine file with other values under some of its keys; all else, comments too, stays as it is written."""

from collections.abc import Mapping

import yaml

from kurbel.errors import Path, UsageError
from kurbel.machine_file.overrides import dotted, path_of


def rewritten(text: str, values: Mapping[str, str]) -> str:
    """Return the text of a machine file with texts of values in place of those under dotted keys.

    A key that is not there yet comes last in the file, or first in its mapping. Raises UsageError for one of a list or
    mapping.

    >>> rewritten("crank: 400 mm  # of 1905\\nrod: 2 m\\n", {"crank": "410 mm", "flywheel.inertia": "9 kg m2"})
    'crank: 410 mm  # of 1905\\nrod: 2 m\\nflywheel: {inertia: 9 kg m2}\\n'
    """
    for key, value in values.items():
        start, end, written = _edit(text, path_of(key), value)
        text = text[:start] + written + text[end:]
    return text


def _edit(text: str, path: Path, value: str) -> tuple[int, int, str]:
    """Return from where to where a value stands, or belongs, and what is to stand there."""
    node = yaml.compose(text, Loader=yaml.SafeLoader)
    for place, step in enumerate(path):
        if isinstance(node, yaml.SequenceNode) and isinstance(step, int) and step < len(node.value):
            node = node.value[step]
            continue
        if not isinstance(node, yaml.MappingNode):
            raise UsageError(f"--write: '{dotted(path)}' is not written out in the file; write it there first")
        inner = next((value for key, value in node.value if key.value == str(step)), None)
        if inner is not None:
            node = inner
            continue
        for missing in reversed(path[place + 1 :]):
            value = f"{{{missing}: {value}}}"
        if node.flow_style:
            start = node.start_mark.index + 1
            return start, start, f"{step}: {value}, "
        if not place:
            return len(text), len(text), "\n" * (not text.endswith("\n")) + f"{step}: {value}\n"
        start, indent = node.start_mark.index, " " * node.start_mark.column
        return start, start, f"{step}: {value}\n{indent}"
    if not isinstance(node, yaml.ScalarNode):
        raise UsageError(f"--write: '{dotted(path)}' is no single value in the file")
    return node.start_mark.index, node.end_mark.index, value
