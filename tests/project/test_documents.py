"""README, docs and docstrings cannot go stale: what they show is run, pages that are generated and links are checked.

A block of another language with a title is a file of that name for the commands of its page:
```yaml title="engine.yaml"
A line `…` in an output stands for lines that the page leaves out.
"""

import doctest
import os
import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Callable
from functools import lru_cache
from importlib import import_module
from pathlib import Path

import pytest

import from_declarations  # tools/from_declarations.py
import man_page
import notebook  # tools/notebook.py
import python_reference  # tools/python_reference.py
import shipped  # tools/shipped.py
import validation  # tools/validation.py
from command import run
from representative import law_of_each
from worked_examples import TABLE

ROOT = Path(__file__).parents[2]
README = ROOT / "README.md"
PAGES = sorted((ROOT / "docs").rglob("*.md"))
COMMAND = re.compile(r"```console\n(\$ [^\n]*)\n(.*?)```", re.DOTALL)
FILE = re.compile(r'```\w+ title="([^"]+)"\n(.*?)```', re.DOTALL)

NO_SHELL = os.name != "posix" or shutil.which("bash") is None


def text_of(page: Path) -> str:
    return page.read_text(encoding="utf-8")


def marked(page: Path) -> list[pytest.MarkDecorator]:
    """Return the marks of a page: README is checked always, the pages of docs with the slow tests."""
    return [] if page == README else [pytest.mark.slow]


def named(page: Path) -> str:
    return page.relative_to(ROOT).as_posix()


PAGES_WITH_COMMANDS = [
    pytest.param(page, marks=marked(page), id=named(page))
    for page in [README, *PAGES]
    if COMMAND.search(text_of(page))
]


@pytest.fixture(scope="module")
def workshop(tmp_path_factory: pytest.TempPathFactory) -> Callable[[Path], Path]:
    """Give a page its folder: the files that it shows, the machines of the repository, and `kurbel` on the path."""

    @lru_cache
    def folder_of(page: Path) -> Path:
        folder = tmp_path_factory.mktemp("page")
        for name, text in FILE.findall(text_of(page)):
            (folder / name).write_text(text, encoding="utf-8")
        shutil.copytree(ROOT / "configs", folder / "configs")
        script = folder / "bin" / "kurbel"
        script.parent.mkdir()
        script.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m kurbel "$@"\n')
        script.chmod(0o755)
        return folder

    return folder_of


SHELL = re.compile(r"[|<>;&$*\\`\n]")
"""What only a shell does."""


def output_of(command: str, folder: Path) -> str:
    """Return what a line of the shell prints in a folder.

    A kurbel at its beginning is called in this process, which has imported it already; the rest is left to the shell.
    """
    line, given, heard = command.removeprefix("$ "), None, ""
    first, _, rest = line.partition(" | ")
    words = [] if SHELL.search(first) or first.count("'") % 2 else shlex.split(first)
    if words[:1] == ["kurbel"]:
        with pytest.MonkeyPatch.context() as place:
            place.chdir(folder)
            ran = run(*words[1:])
        if not rest:
            return ran.output
        line, given, heard = rest, ran.stdout_bytes, ran.stderr
    environment = {k: v for k, v in os.environ.items() if k not in ("FORCE_COLOR", "COLUMNS")}
    environment |= {
        "PATH": f"{folder / 'bin'}{os.pathsep}{environment['PATH']}",
        "PYTHONIOENCODING": "utf-8",
    }
    done = subprocess.run(
        ["bash", "-c", line],
        cwd=folder,
        env=environment,
        input=given,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        check=False,
    )
    return heard + done.stdout.decode()


LEFT_OUT = "…\n"


def shortened(real: str, printed: str) -> str:
    """Return an output with the lines left out that the page leaves out; all of it where what the page shows is gone.

    Each passage that the page shows begins at a line that differs from its first one in figures alone, and has as
    many lines; the last one goes on to the end.

    >>> shortened("a 1\\nb\\nc 3\\nd\\n", "…\\nc 2\\n…\\n")
    '…\\nc 3\\n…\\n'
    """
    lines, done = real.splitlines(keepends=True), 0
    wordings = [wording(line) for line in lines]
    *passages, last = printed.split(LEFT_OUT)
    if not passages:
        return real
    kept = list[str]()
    for passage in [*passages, last]:
        begun = passage.splitlines(keepends=True)
        if begun and wording(begun[0]) not in wordings[done:]:
            return real
        start = wordings.index(wording(begun[0]), done) if begun else done
        done = len(lines) if begun and passage is last else start + len(begun)
        kept.append("".join(lines[start:done]))
    return LEFT_OUT.join(kept)


def wording(line: str) -> str:
    """Return a line without its figures and blanks."""
    return re.sub(r"[-\d.\s]+", " ", line)


@pytest.mark.skipif(NO_SHELL, reason="the pages speak to a shell")
@pytest.mark.parametrize("page", PAGES_WITH_COMMANDS)
def test_commands_of_a_page(
    page: Path, workshop: Callable[[Path], Path], kept: Callable[[Path, str], str]
) -> None:
    """All in their order: a command may read what one before it has written."""
    text = now = text_of(page)
    for command, printed in COMMAND.findall(text):
        if "| jq " not in command or shutil.which("jq"):
            real = shortened(output_of(command, workshop(page)), printed)
            now = now.replace(f"{command}\n{printed}```", f"{command}\n{real}```")
    assert now == kept(page, now)


PYTHON = [page for page in [README, *PAGES] if ">>>" in text_of(page)]


@pytest.mark.parametrize(
    "page", [pytest.param(page, marks=marked(page), id=named(page)) for page in PYTHON]
)
def test_python_of_a_page(page: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    result = doctest.testfile(str(page), module_relative=False, encoding="utf-8")
    assert result.attempted
    assert result.failed == 0


GENERATED = {
    "machines.md": shipped.page,
    "validation.md": validation.page,
    "notebook.md": notebook.page,
    "reference/python.md": python_reference.page,
    "reference/keys.md": from_declarations.keys,
    "reference/units.md": from_declarations.units,
    "reference/columns.md": from_declarations.columns,
    "reference/key-values.md": from_declarations.key_values,
    "reference/commands.md": from_declarations.commands,
    "reference/kurbel.1": man_page.page,
}


@pytest.mark.parametrize("name", GENERATED)
def test_a_generated_page_is_current(name: str, kept: Callable[[Path, str], str]) -> None:
    text = GENERATED[name]()
    assert kept(ROOT / "docs" / name, text) == text


def test_the_page_of_validation_has_every_example() -> None:
    page = text_of(ROOT / "docs" / "validation.md")
    assert [example for example in TABLE if f"| {example} |" not in page] == []


def test_no_page_begins_with_a_note_for_its_makers() -> None:
    begins = {named(page): text_of(page)[:500] for page in PAGES}
    assert [
        page
        for page, text in begins.items()
        if re.search(r"pytest|edit by hand|writes this page", text)
    ] == []


# links of the pages beside the site (README and its like) lead to files and headings that there are

BESIDE = sorted(ROOT.glob("*.md"))
OUTSIDE = {"https://keepachangelog.com/en/1.1.0/"}
"""The addresses elsewhere that these pages name."""


def prose_of(page: Path) -> str:
    return re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)


def links_of(page: Path) -> list[tuple[str, str]]:
    return re.findall(r"\]\(([^)\s]+)\)|(?:src|href)=\"([^\"]+)\"", prose_of(page))


def anchors_of(page: Path) -> set[str]:
    headings = re.findall(r"^#+ (.*)$", prose_of(page), re.MULTILINE)
    return {
        re.sub(r"\s", "-", re.sub(r"[^\w\s-]", "", heading).strip().lower()) for heading in headings
    }


@pytest.mark.parametrize("page", BESIDE, ids=lambda page: page.name)
def test_links_lead_somewhere(page: Path) -> None:
    for link in ("".join(pair) for pair in links_of(page)):
        if "://" in link:
            assert link in OUTSIDE
            continue
        file, _, anchor = link.partition("#")
        target = page.parent / file if file else page
        assert target.exists(), link
        assert not anchor or anchor in anchors_of(target), link


# every example in a docstring gives what stands below it

SOURCE = Path(__file__).parents[2] / "src"
MODULES = [
    ".".join(file.relative_to(SOURCE).with_suffix("").parts).removesuffix(".__init__")
    for file in sorted(SOURCE.rglob("*.py"))
    if ">>> " in file.read_text(encoding="utf-8")
]


@law_of_each(MODULES)
def test_examples_in_docstrings(module: str) -> None:
    result = doctest.testmod(import_module(module))
    assert result.attempted
    assert result.failed == 0
