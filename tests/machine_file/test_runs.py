"""Long runs of points are taken out of the text before YAML reads it; nobody can tell but by the time it takes."""

from __future__ import annotations

from typing import Any

import pytest

from kurbel.errors import KurbelError, MachineFileError
from kurbel.machine_file import events, loads, points

PAIRS = [f"[{angle * 0.72:.2f}, {100 + angle % 7}]" for angle in range(501)]
HEAD = "effort:\n  unit: N m\n  points:"
FLOW = f"{HEAD} [{', '.join(PAIRS)}]\nspeed: 1 1/s\n"
STYLES = {
    "one line": FLOW,
    "many lines": f"{HEAD} [\n    " + ",\n    ".join(PAIRS) + ",\n  ]\nspeed: 1 1/s\n",
    "carriage returns": f"{HEAD} [\n    ".replace("\n", "\r\n") + ",\r\n    ".join(PAIRS) + "]\r\nspeed: 1 1/s\r\n",
    "dashes": HEAD + "".join(f"\n    - {pair}" for pair in PAIRS) + "\nspeed: 1 1/s\n",
    "dashes below the key": HEAD + "".join(f"\n  - {pair}" for pair in PAIRS) + "\nspeed: 1 1/s\n",
    "a comment amid": FLOW.replace(PAIRS[250], f"{PAIRS[250]} # half\n    "),
    "all in brackets": f"{{effort: {{unit: N m, points: [{','.join(PAIRS)}]}}, speed: 1 1/s}}",
}
COMMENT = f"# [{', '.join(PAIRS)}]\n"


def plain(text: str, monkeypatch: pytest.MonkeyPatch) -> Any:
    """Parse every point as an event of YAML."""
    with monkeypatch.context() as patch:
        patch.setattr(events, "without_runs", lambda text, scalar: (text, {}))
        return events.parse(text)


@pytest.mark.parametrize("style", STYLES)
def test_all_points_arrive_in_their_order(style: str) -> None:
    machine = loads(STYLES[style])
    assert machine.effort is not None
    assert machine.effort.angles == tuple(float(f"{angle * 0.72:.2f}") for angle in range(501))
    assert machine.effort.torques == tuple(100.0 + angle % 7 for angle in range(501))
    assert machine.speed == 1


@pytest.mark.parametrize("style", STYLES)
def test_yaml_meets_few_of_them(style: str, monkeypatch: pytest.MonkeyPatch) -> None:
    met = []
    scalar = events.Builder.scalar
    monkeypatch.setattr(events.Builder, "scalar", lambda self, event: (met.append(event), scalar(self, event))[1])
    loads(STYLES[style])
    assert len(met) < 20


@pytest.mark.parametrize(
    "text",
    [
        *STYLES.values(),
        COMMENT + FLOW,
        f'name: "{PAIRS}"\n' + FLOW,
        f"name: |\n  [{', '.join(PAIRS)}]\n" + FLOW,
        FLOW.replace(PAIRS[300], "[x, 1]"),
        FLOW.replace(PAIRS[300], "[1]"),
        FLOW.replace(f"{PAIRS[300]},", PAIRS[300]),
        FLOW.replace("[[", "[[[").replace("]]", "]]]"),
        FLOW.replace("[[", "[").replace("]]", "]"),
        HEAD + "\n    - " + ", ".join(PAIRS),
        HEAD + "\n    - # odd [\n      " + ", ".join(PAIRS),
        HEAD + "".join(f"\n    - {pair}" for pair in PAIRS) + "\n   - [1, 2]\n",
        HEAD + "".join(f"\n    - {pair}" for pair in PAIRS) + "\n     - [1, 2]\n",
        f"{{{', '.join(PAIRS)}}}",
        f"? [{', '.join(PAIRS)}]\n: 1",
        f"[{', '.join(PAIRS)}]: 1",
        "\ufeff" + FLOW,
    ],
)
def test_the_tree_is_that_of_yaml(text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    assert events.parse(text) == plain(text, monkeypatch)


def test_a_fault_beyond_a_run_has_its_place() -> None:
    with pytest.raises(MachineFileError) as caught:
        loads(STYLES["many lines"].replace("speed: 1 1/s", "speed: 1 x"))
    assert str(caught.value).startswith("<text>:506:8: speed: unknown speed of rotation unit 'x'")


def test_more_points_than_are_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(points, "MOST_POINTS", 500)
    with pytest.raises(KurbelError, match="501 points; more than 500 are not taken, thin them out"):
        loads(FLOW)


def test_more_values_than_any_machine_has(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(events, "_MOST_SCALARS", 500)
    with pytest.raises(KurbelError, match="more than 500 values; put measurements into a file"):
        loads(f"name: [{'1,' * 501}]")
