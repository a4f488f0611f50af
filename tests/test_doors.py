"""Doors: a run imports what its machine file and its command need, and nothing that others would need."""

import ast
import json
import subprocess
import sys
from collections import defaultdict
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest
import yaml

import kurbel
from kurbel.declared.forms.structures import RecordForm
from kurbel.declared.forms.values import Form
from kurbel.machine_file.reader import ROOT
from kurbel.quantities import CHAPTERS, KEY_VALUES
from kurbel.report.commands import COMMANDS, REPORTS
from kurbel.solver.drive import any_of
from representative import CONFIGS, case_of

PACKAGE = Path(kurbel.__file__).parent

CORE = {
    "crank_formulas kurbel arrays crank_angle errors near_words quantities quantity shipped __main__",
    "machine machine.batch machine.chamber machine.cylinder machine.indicator machine.origin machine.parts",
    "mechanisms mechanisms.kinds mechanisms.setting mechanisms.slider_crank",
    "solver solver.case solver.chambers solver.cycle solver.drive solver.figures solver.forces solver.gas",
    "solver.motion solver.newton solver.rod_load solver.state solver.vector",
    "report report.commands report.forces tables tables.frame tables.named_values tables.tables",
    "render render.csv_text render.formats render.output render.text",
}
"""What `kurbel motion -f csv` of a crank with its rod needs of the trades. Whoever adds a module here adds it to the
start of every command: put it behind a door instead, unless every machine needs it."""
ALWAYS = ("cli", "declared", "machine_file", "numerics")
"""Packages that are no capability of their own."""
NEEDS = {
    "machine.several": {"cylinders", "firing_order", "cylinder"},
    "mechanisms.slider_crank": {"mechanism"},
    "solver.given_torque": {"effort", "load"},
    "solver.ideal_process": {"steam", "compressor", "otto", "diesel"},
    "solver.indicated": {"trace"},
    "solver.shaft": {"crankshaft"},
    "solver.total_work": {"cylinders", "tandem"},
    "traces.pressure": {"trace"},
    "traces.checks": {"trace"},
    "solver.chapters.coupling": {"coupling"},
}
"""Module that is imported where the solver needs it -> the keys of which a file has one. What a new capability imports
inside a function of the solver is a line here; its record and its command are found from their declarations."""


# what imports what


@cache
def at_head(module: str) -> frozenset[str]:
    """The modules of kurbel that a module imports whenever it is imported, without those for annotations."""
    return frozenset(_imported(_tree(module).body))


@cache
def in_functions(module: str) -> dict[str, frozenset[str]]:
    """The modules that functions of a module import, by the names of the functions."""
    functions = (node for node in ast.walk(_tree(module)) if isinstance(node, ast.FunctionDef))
    return {node.name: frozenset(_imported(node.body)) for node in functions}


def _tree(module: str) -> ast.Module:
    path = PACKAGE if module == "kurbel" else PACKAGE.joinpath(*module.split("."))
    path = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
    return ast.parse(path.read_text(encoding="utf-8"))


def _imported(body: list[ast.stmt]) -> Iterator[str]:
    for node in body:
        if isinstance(node, ast.ImportFrom) and node.module and node.module.startswith("kurbel."):
            inside = node.module.removeprefix("kurbel.")
            yield inside
            for name in node.names:
                if (PACKAGE.joinpath(*inside.split("."), f"{name.name}.py")).exists():
                    yield f"{inside}.{name.name}"


def with_heads(modules: set[str]) -> set[str]:
    """Return modules with everything that they import at their heads, and with their packages."""
    found: set[str] = set()
    waiting = [*modules]
    while waiting:
        module = waiting.pop()
        if module not in found:
            found.add(module)
            outer = module.rpartition(".")[0]
            waiting += [*at_head(module), *([outer] if outer else [])]
    return found


# what a run needs


@cache
def records() -> dict[str, set[str]]:
    """The modules of the records behind each key or word of the machine file, from their declarations."""
    needed: dict[str, set[str]] = defaultdict(set)
    seen: set[tuple[int, str]] = set()

    def visit(form: Form, key: str) -> None:
        if (id(form), key) in seen:
            return
        seen.add((id(form), key))
        if isinstance(form, RecordForm):
            needed[key].add(form.record.__module__.removeprefix("kurbel."))
        for name, part in form.parts:
            visit(part, name or key)

    visit(ROOT, "")
    return needed


def words_of(content: Any) -> Iterator[str]:
    """Yield every key of a machine file, and every word."""
    if isinstance(content, dict):
        for key, value in content.items():
            yield str(key)
            yield from words_of(value)
    elif isinstance(content, list):
        for item in content:
            yield from words_of(item)
    elif isinstance(content, str):
        yield content


def needed_by(machine: str, command: str) -> set[str]:
    """Return the modules that a command on a machine may load, its table as CSV."""
    words = set(words_of(yaml.safe_load(CONFIGS[machine].read_text(encoding="utf-8"))))
    core = {module for line in CORE for module in line.split()}
    of_keys = {module for word in words for module in records().get(word, ())}
    of_solver = {module for module, keys in NEEDS.items() if keys & words}
    return with_heads(
        core | of_keys | of_solver | _of_limits(machine) | _of_command(machine, command)
    )


def _of_limits(machine: str) -> set[str]:
    """Return the modules of the chapters down to those of the key values on which the file has limits."""
    given = case_of(machine).machine
    found: set[str] = set()
    for name, _ in (*given.limits, *given.expect):
        id = name.rpartition(".")[2]
        for chapter in CHAPTERS:
            found |= _of_door(chapter.door)
            if id in KEY_VALUES._lists[chapter]:
                break
        else:
            return _everything()
    return found


def _everything() -> set[str]:
    every = (path.relative_to(PACKAGE).with_suffix("").parts for path in PACKAGE.rglob("*.py"))
    return {".".join(part for part in parts if part != "__init__") for parts in every} - {""}


def _of_door(door: Any) -> set[str]:
    return set(in_functions(door.__module__.removeprefix("kurbel.")).get(door.__name__, ()))


def _of_command(machine: str, command: str) -> set[str]:
    """Return the modules of a command: its report, and its chapters with the turning effort on which they stand."""
    if command == "check":
        return _of_check(machine)
    found = _of_door(COMMANDS[command].of)
    for chapter in CHAPTERS:
        if chapter.command == command:
            found |= _of_door(chapter.door)
    return (
        found
        if command in ("motion", "forces")
        else found | {"solver.effort", *_named("Case", command)}
    )


def _named(_: str, command: str) -> set[str]:
    """Return what the results of a case by this name import: those of bearings come with the pins."""
    return set(in_functions("solver.case").get(command, ()))


def _of_check(machine: str) -> set[str]:
    """Return the modules of a check: what is said, and of the chapters those that have something to say."""
    case = case_of(machine)
    found = {
        "cli.checking",
        "machine.firing",
        "notes.warnings",
        "solver.effort",
        "solver.indicated",
    }
    if case.machine.crankshaft:
        found |= {"solver.chapters.bearings", "solver.chapters.stress", "solver.shaft"}
    if case.machine.shaft or case.machine.coupling:
        found |= {"report.torsion"}
    pumping = any(any_of(forces.drive.pumping) for forces in case.cylinders)
    if pumping or any(chamber.compresses for chamber in case.machine.chambers):
        found |= {"report.delivery"}
    if case.machine.limits or case.machine.expect:
        found |= {"report.forces", "report.flywheel"}
    return found


# what it loads


@pytest.fixture(scope="module")
def loaded() -> Iterator[Any]:
    """Return a function that runs the command line in a fresh process and returns the modules it imports."""
    server = Path(__file__).parent / "loaded.py"
    with subprocess.Popen(
        [sys.executable, str(server)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        encoding="utf-8",
    ) as process:
        assert process.stdin
        assert process.stdout

        def modules_of(*words: str) -> set[str]:
            process.stdin.write(json.dumps(words) + "\n")
            process.stdin.flush()
            names = json.loads(process.stdout.readline())
            return {name.removeprefix("kurbel.") for name in names}

        yield modules_of
        process.stdin.close()


def beyond(modules: set[str], allowed: set[str]) -> list[str]:
    """Return the modules that are not allowed, apart from packages that are no capability."""
    return sorted(name for name in modules - allowed if name.split(".")[0] not in ALWAYS)


def test_of_a_plain_machine_the_core(loaded: Any, tmp_path: Path) -> None:
    plain = tmp_path / "plain.yaml"
    plain.write_text("{crank: 400 mm, rod_ratio: 5, speed: 50 rpm}", encoding="utf-8")
    core = {module for line in CORE for module in line.split()}
    assert beyond(loaded("motion", str(plain), "-f", "csv"), core) == []


@pytest.mark.parametrize("command", [*(row.word for row in REPORTS), "check"])
@pytest.mark.parametrize(
    "machine", [CONFIGS["waterworks"], CONFIGS["diesel-trace"]], ids=lambda file: file.stem
)
def test_a_run_loads_what_its_file_and_its_command_need(
    loaded: Any, machine: Path, command: str
) -> None:
    form = () if command == "check" else ("-f", "csv")
    assert beyond(loaded(command, str(machine), *form), needed_by(machine.stem, command)) == []


def test_a_sweep_of_forces_loads_no_chapter(loaded: Any) -> None:
    file = str(CONFIGS["waterworks"])
    modules = loaded(
        "sweep", file, "--vary", "rod_ratio=4,5", "--columns", "T_max,N_max", "-f", "csv"
    )
    assert not [
        name
        for name in modules
        if name.startswith(("solver.chapters", "traces", "notes", "solver.flywheel"))
    ]


@pytest.mark.parametrize(
    "words", [("flywheel", "--where", "T = 0"), ("forces", "--columns", "T,N")]
)
def test_a_named_column_opens_no_other_chapter(loaded: Any, words: tuple[str, ...]) -> None:
    command, *options = words
    modules = loaded(command, str(CONFIGS["waterworks"]), *options, "-f", "csv")
    assert not [name for name in modules if name.startswith(("solver.chapters.", "traces"))]


def test_help_loads_neither_solver_nor_machine(loaded: Any) -> None:
    modules = loaded("--help")
    assert not [
        name
        for name in modules
        if name.startswith(("solver", "machine", "mechanisms", "traces", "pictures"))
    ]


def test_at_their_heads_core_modules_import_no_chapter() -> None:
    core = {module for line in CORE for module in line.split()}
    assert {
        name
        for name in with_heads(core)
        if name.startswith(("solver.chapters", "traces", "pictures"))
    } == set()


def test_the_word_of_a_chapter_is_that_of_its_class() -> None:
    assert [
        (chapter.command, chapter.kind.command)
        for chapter in CHAPTERS
        if chapter.command != chapter.kind.command
    ] == []
