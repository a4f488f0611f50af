"""Doors: a run imports what its machine file and its command need, and nothing that others would need."""

import ast
import json
import subprocess
import sys
from collections import defaultdict
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import pytest
import yaml

import kurbel
from kurbel.declared.forms.structures import RecordForm, Variant
from kurbel.declared.forms.values import Form
from kurbel.machine_file.reader import ROOT
from kurbel.mechanisms.kinds import KINDS
from kurbel.quantities import CHAPTERS, KEY_VALUES
from kurbel.report.commands import COMMANDS, REPORTS
from kurbel.solver.drive import any_of
from kurbel.solver.figures import doors_of, result_rows
from representative import CONFIGS, case_of, shipped

PACKAGE = Path(kurbel.__file__).parent

CORE = {
    "crank_formulas kurbel arrays crank_angle errors near_words quantities quantity shipped",
    "machine machine.batch machine.chamber machine.cylinder machine.indicator machine.origin machine.parts",
    "mechanisms mechanisms.kinds mechanisms.setting mechanisms.slider_crank",
    "solver solver.case solver.chambers solver.cycle solver.drive solver.figures solver.forces solver.gas",
    "solver.motion solver.newton solver.rod_load solver.state solver.vector solver.piston_works",
    "solver.books_of_friction",
    "report report.commands report.forces",
    "tables tables.frame tables.named_values tables.shown tables.tables",
    "render render.csv_text render.formats render.output render.text",
}
"""What `kurbel motion -f csv` of a crank with its rod needs of the trades. Whoever adds a module here adds it to the
start of every command: put it behind a door instead, unless every machine needs it."""
CORE_MODULES = {module for line in CORE for module in line.split()}
ALWAYS = ("cli", "declared", "machine_file", "numerics")
"""Packages that are no capability of their own."""
NEEDS = {
    "machine.several": {"cylinders", "firing_order", "cylinder"},
    "solver.given_torque": {"effort", "load"},
    "solver.ideal_process": {"steam", "compressor", "otto", "diesel"},
    "solver.heat_release": {"heat", "wiebe"},
    "solver.wiebe": {"wiebe"},
    "solver.indicated": {"trace"},
    "solver.output_load": {"force"},
    "solver.shaft": {"crankshaft"},
    "solver.total_work": {"cylinders", "tandem"},
    "solver.valve": {"valve"},
    "traces.pressure": {"trace"},
    "traces.checks": {"trace"},
    "solver.chapters.coupling": {"coupling"},
    "machine.linked": {"link_rod"},
}
"""Module that is imported where the solver needs it -> the keys of which a file has one. What a new capability imports
inside a function of the solver is a line here; its record and its command are found from their declarations."""
CHECKED = {
    "cli.checking": set[str](),
    "machine.firing": set[str](),
    "notes.warnings": set[str](),
    "solver.effort": set[str](),
    "solver.indicated": set[str](),
    "solver.flywheel": {"flywheel", "load", "coupling", "efficiency", "diameter_squared"},
    "solver.chapters.balance": {"axial_position", "spacing", "counterweights", "balance_shafts"}
    | {"locomotive"},
    "solver.chapters.bearings": {"crankshaft"},
    "solver.chapters.stress": {"crankshaft"},
    "solver.chapters.stress_places": {"crankshaft"},
    # the crank pins of several cylinders
    "machine.crankshaft": {"crankshaft", "cylinders"},
    "solver.shaft": {"crankshaft", "cylinders"},
    "report.torsion": {"shaft", "coupling"},
    "report.delivery": {"pump", "compressor", "gas"},
}
"""Module that a check imports to say what it has to say -> the keys of which a file has one, none for every check."""


_MECHANISMS = (
    "mechanisms.four_bar",
    "mechanisms.parallel_crank",
    "mechanisms.scotch_yoke",
    "mechanisms.slotted_lever",
)
"""Those of other machines than engines with a connecting rod."""


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
    return set().union(*(_with_its_heads(module) for module in modules))


@cache
def _with_its_heads(module: str) -> frozenset[str]:
    result: set[str] = set()
    waiting = [module]
    while waiting:
        module = waiting.pop()
        if module not in result:
            result.add(module)
            outer = module.rpartition(".")[0]
            waiting += [*at_head(module), *([outer] if outer else [])]
    return frozenset(result)


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
        if isinstance(form, Variant):
            for word, case in form.cases.items():
                visit(case, word)

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
    of_keys = {module for word in words for module in records().get(word, ())}
    of_solver = {module for module, keys in NEEDS.items() if keys & words}
    modules = CORE_MODULES | of_keys | of_solver | _of_limits(machine)
    if command == "check":
        modules |= {module for module, keys in CHECKED.items() if not keys or keys & words}
        modules |= _of_compared(machine)
        if any(any_of(forces.drive.pumping) for forces in case_of(machine).cylinders):
            modules |= {"report.delivery"}
    else:
        modules |= _of_command(command)
    return with_heads(modules)


def _of_limits(machine: str) -> set[str]:
    """Return the modules of the chapters down to those of the key values on which the file has limits."""
    given = case_of(machine).machine
    result: set[str] = set()
    for name, _ in (*given.limits, *given.expect):
        id = name.rpartition(".")[2]
        for chapter in CHAPTERS:
            result |= _of_door(chapter.door)
            rows = result_rows(chapter.kind, closed=doors_of(chapter.kind))
            if id in rows.key_values:
                break
        else:
            return _everything()
    return result


def _of_compared(machine: str) -> set[str]:
    """Return the modules of the commands that have the key values on which the file has limits."""
    given = case_of(machine).machine
    ids = {name.rpartition(".")[2] for name, _ in (*given.limits, *given.expect)}
    commands = {next(KEY_VALUES.commands_of(id)) for id in ids} | {"flywheel" for _ in ids}
    return {module for command in commands for module in _of_command(command)}


def _everything() -> set[str]:
    every = (path.relative_to(PACKAGE).with_suffix("").parts for path in PACKAGE.rglob("*.py"))
    return {".".join(part for part in parts if part != "__init__") for parts in every} - {""}


def _of_door(door: Any) -> set[str]:
    return set(in_functions(door.__module__.removeprefix("kurbel.")).get(door.__name__, ()))


def _of_command(command: str) -> set[str]:
    """Return the modules of a command: its report, and its chapters with the turning effort that they take."""
    result = _of_door(COMMANDS[command].of)
    for chapter in CHAPTERS:
        if chapter.command == command:
            result |= _of_door(chapter.door)
    if command in ("motion", "forces"):
        return result
    # what the case imports for it: the results of bearings come with the pins
    return result | {"solver.effort"} | in_functions("solver.case").get(command, set())


# what it loads


class Server:
    """A process that runs the command line in forks of itself, and says which modules each run imports.

    words: of a run whose modules, and what it has read once for all, every run starts with.
    """

    def __init__(self, *words: str) -> None:
        server = str(Path(__file__).parents[1] / "loaded.py")
        self.process = subprocess.Popen(
            [sys.executable, server, *words],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            encoding="utf-8",
        )

    def __call__(self, *words: str) -> set[str]:
        """Return the modules of kurbel that a run with these words imports."""
        return self.of_each([words])[0]

    def of_each(self, runs: Sequence[Sequence[str]]) -> list[set[str]]:
        """Return the modules of kurbel that the first run imports, and those of each other run after the first one."""
        assert self.process.stdin
        assert self.process.stdout
        self.process.stdin.write(json.dumps(runs) + "\n")
        self.process.stdin.flush()
        modules = json.loads(self.process.stdout.readline())
        return [{name.removeprefix("kurbel.") for name in names} for names in modules]

    def close(self) -> None:
        """End the process."""
        self.process.communicate()


@pytest.fixture(scope="module")
def plain(tmp_path_factory: pytest.TempPathFactory) -> str:
    """A crank with its rod."""
    file = tmp_path_factory.mktemp("doors") / "plain.yaml"
    file.write_text("{crank: 400 mm, rod_ratio: 5, speed: 50 rpm}", encoding="utf-8")
    return str(file)


@pytest.fixture(scope="module")
def loaded() -> Iterator[Server]:
    """Runs that start without any module of kurbel."""
    server = Server()
    yield server
    server.close()


@pytest.fixture(scope="module")
def loaded_after_core(plain: str) -> Iterator[Server]:
    """Runs that start with the modules that every run needs, which saves most of their time."""
    server = Server("motion", plain, "-f", "csv")
    yield server
    server.close()


def beyond(modules: set[str], allowed: set[str]) -> list[str]:
    """Return the modules that are not allowed, apart from packages that are no capability."""
    return sorted(name for name in modules - allowed if name.split(".")[0] not in ALWAYS)


def test_of_a_plain_machine_the_core(loaded: Server, plain: str) -> None:
    modules = loaded("motion", plain, "-f", "csv")
    assert beyond(modules, CORE_MODULES) == []
    assert modules >= CORE_MODULES  # what is no longer loaded is no core


@pytest.mark.parametrize("machine", shipped("waterworks", "diesel-trace"))
def test_a_run_loads_what_its_file_and_its_command_need(
    loaded_after_core: Server, machine: Path
) -> None:
    # motion first: what it needs of the machine all others need, too
    commands = ["motion", *(row.word for row in REPORTS if row.word != "motion")]
    runs = [[command, str(machine), "-f", "csv"] for command in commands]
    modules_of_each = loaded_after_core.of_each([*runs, ["check", str(machine)]])
    wrong = {}
    for command, modules in zip([*commands, "check"], modules_of_each):
        wrong[command] = beyond(modules, needed_by(machine.stem, command))
    assert {command: modules for command, modules in wrong.items() if modules} == {}


def test_a_sweep_of_forces_loads_no_chapter(loaded: Server) -> None:
    file = str(CONFIGS["waterworks"])
    modules = loaded(
        "sweep", file, "--vary", "rod_ratio=4,5", "--columns", "T_max,N_max", "-f", "csv"
    )
    assert not [
        name
        for name in modules
        if name.startswith(("solver.chapters", "traces", "notes", "pictures", "solver.flywheel"))
    ]


@pytest.mark.parametrize(
    "words",
    [
        ("flywheel", "--where", "T = 0"),
        ("forces", "--columns", "T,N"),
        ("motion", "--key-values", "c_max"),
        ("flywheel", "--key-values", "dE machine.T_max"),
    ],
)
def test_a_name_opens_no_other_chapter(loaded: Server, words: tuple[str, ...]) -> None:
    command, *options = words
    modules = loaded(command, str(CONFIGS["waterworks"]), *options, "-f", "csv")
    assert not [name for name in modules if name.startswith(("solver.chapters.", "traces"))]


def test_a_picture_loads_no_page_and_no_chapter(loaded: Server) -> None:
    modules = loaded("plot", str(CONFIGS["waterworks"]))
    others = ("page", "checks", "notes", "report.keys", "solver.chapters", "traces", *_MECHANISMS)
    assert not [name for name in modules if name.startswith(others)]


def test_a_page_loads_no_mechanism_no_trace_and_no_gear_of_others(loaded: Server) -> None:
    modules = loaded("report", str(CONFIGS["waterworks"]))
    others = ("traces", "machine.valve", "solver.valve", "solver.chapters.coupling", *_MECHANISMS)
    assert not [name for name in modules if name.startswith(others)]


def test_help_loads_neither_solver_nor_machine(loaded: Server) -> None:
    modules = loaded("--help")
    assert not [
        name
        for name in modules
        if name.startswith(("solver", "machine", "mechanisms", "traces", "pictures"))
    ]


def test_at_their_heads_core_modules_import_no_chapter() -> None:
    assert {
        name
        for name in with_heads(CORE_MODULES)
        if name.startswith(("solver.chapters", "traces", "pictures"))
    } == set()


def test_none_but_kinds_and_references_name_the_class_of_a_mechanism() -> None:
    files = {door: _of_door(door) - {"mechanisms"} for door in KINDS.values()}
    mechanisms = set[str]().union(*files.values())
    naming = {
        module
        for module in _everything()
        for head in [at_head(module)]
        if head & mechanisms and not module.startswith(("mechanisms", "accuracy"))
    }
    # a link rod makes a mechanism of the slider-crank of its master
    assert naming <= {"machine.linked"}


def test_the_word_of_a_chapter_is_that_of_its_class() -> None:
    assert [
        (chapter.command, chapter.kind.command)
        for chapter in CHAPTERS
        if chapter.command != chapter.kind.command
    ] == []
