"""The runs that are frozen: machines, command lines for each, and what they answer.

Only the command line and the public names of `kurbel` are used, so that all behind them may be rebuilt. A run is a
command line; its answer is what it prints as JSON, or as text, with its exit status and standard error.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import shlex
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from itertools import count
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import yaml
from click import Context
from click.testing import CliRunner

from frozen_machines import KINDS, write_traces
from kurbel.cli import kurbel as command_line
from random_files import machine_file

CONFIGS = Path(__file__).parent.parent / "configs"
NO_MACHINE = "no machine"
HARD = 27
ANGLES = {False: "0,33,90,147,180,215.5,280,341", True: "0,33,97,180,290,360,455,610.5"}
"""Eight crank angles, of a machine with a four-stroke cycle or not."""
ORDERS = {False: "1:12:1", True: "0.5:12:0.5"}
Answer = dict[str, Any]


@cache
def machine_text(name: str) -> str:
    """Return the file of a machine such as shipped/waterworks, random/17, hard/3."""
    if name == NO_MACHINE:
        return ""
    kind, _, which = name.partition("/")
    if kind == "shipped":
        return (CONFIGS / f"{which}.yaml").read_text(encoding="utf-8")
    random = np.random.default_rng([1925, int(which)])
    if kind == "random":
        return machine_file(random)
    return str(yaml.safe_dump(KINDS[int(which) % len(KINDS)](random), sort_keys=False))


def hash_of(name: str) -> str:
    return hashlib.sha256(machine_text(name).encode()).hexdigest()[:16]


@contextmanager
def among_traces() -> Iterator[None]:
    """Work in a folder with the traces that machines name."""
    before = os.getcwd()
    with TemporaryDirectory() as folder:
        write_traces(Path(folder))
        os.chdir(folder)
        try:
            yield
        finally:
            os.chdir(before)


def answer_of(machine: str, line: str) -> Answer:
    """Return what a command line answers that reads a machine from standard input."""
    result = CliRunner(env={"COLUMNS": "80"}).invoke(command_line, shlex.split(line), input=machine_text(machine))
    answer: Answer = {"exit": result.exit_code} | ({"error": result.stderr} if result.stderr else {})
    if "-f json" not in line:
        return answer | {"text": result.stdout.splitlines()}
    if line.startswith("sweep"):
        rows = [json.loads(row) for row in result.stdout.splitlines()]
        heads = dict.fromkeys(head for row in rows for head in row)
        found = [
            {"id": head, "unit": head.rpartition("_")[2], "values": [row.get(head) for row in rows]} for head in heads
        ]
        return answer | {"columns": _rounded(found)}
    return answer | (_rounded(json.loads(result.stdout)) if result.stdout else {})


def _rounded(node: Any) -> Any:
    """Return an answer to 14 digits, without versions and files; of residuals only whether they are rounding errors."""
    if isinstance(node, float):
        return float(f"{node:.14g}")
    if isinstance(node, list):
        return [_rounded(one) for one in node]
    if not isinstance(node, dict):
        return node
    if str(node.get("id")).endswith("residual") and abs(node.get("value") or 0.0) < 1e-9:
        return node | {"value": 0.0}
    return {key: _rounded(one) for key, one in node.items() if key not in ("kurbel", "versions", "inputs")}


def machine_lines(machine: str, answers: dict[str, Answer]) -> Iterator[str]:
    """Yield the command lines for a machine; those before are answered when one is taken."""
    four = "four-stroke" in machine_text(machine)
    angles = f"-f json --angles {ANGLES[four]}"
    yield "check - -f json"
    if answers["check - -f json"]["exit"] == 2:
        return
    for command in ("motion", "forces", "flywheel", "stress", "balance"):
        yield f"{command} - {angles}"
    if not machine.startswith("random") or machine.endswith(tuple("02468")):  # which take longest
        yield f"bearings - {angles}"
    for command in ("harmonics", "torsion"):
        yield f"{command} - -f json --orders {ORDERS[four]}"
    speed = re.search(r"^speed: '?([-+.\de]+) *(\w+)", machine_text(machine), re.MULTILINE)
    speeds = f"{0.9 * float(speed[1]):.6g},{1.1 * float(speed[1]):.6g} {speed[2]}" if speed else "50,60 rpm"
    sweep = f"sweep - -f json --vary 'speed={speeds}'"
    if machine.startswith("random"):
        yield from [sweep] * machine.endswith(("0", "5"))
        return
    yield sweep
    chapters = ["flywheel", "balance"] + ["stress", "bearings"] * machine.startswith("hard")
    whole = [answers[f"{command} - {angles}"] for command in chapters]
    parts = [*whole, *(bearing for answer in whole for bearing in answer.get("bearings", ()))]
    told = [one["id"] for part in parts for key in ("machine_key_values", "key_values") for one in part.get(key, ())]
    ids = dict.fromkeys(id for id in told if "residual" not in id)
    yield f"{sweep} --columns {','.join(ids)}"
    for cylinder in answers[f"forces - {angles}"].get("cylinders", ())[:1]:
        yield f"forces - {angles} --columns '{','.join(column['id'] for column in cylinder['columns'])}'"
    yield f"balance - {angles} --columns F_free,F_x_book,F_y_book"
    yield f"torsion - {angles} --columns M_shaft,tau --modes 2"
    yield "forces - -f json --each-cycle"
    if machine.startswith("hard"):
        return
    yield f"{sweep} --columns c_max,b_min,phi_b_zero --angles"
    for command in ("motion", "forces", "balance"):
        yield f"{command} - {angles} --compare"
    yield "motion - -f json --over x --step 12.5"
    yield "harmonics - -f json --orders 1:4:1 --speeds '60,90 rpm'"
    yield "forces - -f json --key-values --uncertainty 'speed=1 %'"


def plain_lines() -> Iterator[str]:
    """Yield the command lines that need no machine."""
    yield "--help"
    for command in command_line.list_commands(Context(command_line)):
        yield f"{command} --help"
    yield from ("schema", "schema --answers", "keys", "units", "example", "plot --list")
    for options in ("", "--compare --layout rows", "--ratio 1.001 --ratio inf --rows b,c,x,psi,S,N,D --formula exact"):
        yield f"table -f json {options}".strip()
    for options in ("10 --coefficient 0.1", "3 --coefficient 0.4 --direction 20", "89 --coefficient 1.2"):
        yield f"friction -f json --incline {options}"


def names() -> Iterator[str]:
    """Yield the machines; random ones without end."""
    yield from (f"shipped/{path.stem}" for path in sorted(CONFIGS.glob("*.yaml")))
    yield from (f"hard/{number}" for number in range(HARD))
    yield from (f"random/{number}" for number in count())
