"""What is built and installed: every file once, and the shipped machines found from wherever kurbel was installed."""

import os
import subprocess
import sys
import sysconfig
import tarfile
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
MACHINES = sorted(path.stem for path in (ROOT / "configs").glob("*.yaml"))
NOT_OURS = ("PYTHONPATH", "PIP_USER")  # they would let in what was not installed
ENVIRONMENT = {key: value for key, value in os.environ.items() if key not in NOT_OURS}


def run(*command: object, folder: Path, **environment: str) -> str:
    done = subprocess.run(
        [str(word) for word in command],
        cwd=folder,
        env=ENVIRONMENT | environment,
        capture_output=True,
        encoding="utf-8",
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def installed(folder: Path, *what: object) -> Path:
    """Install into a new virtual environment, which sees the dependencies of this one; return its python."""
    run(sys.executable, "-m", "venv", "--without-pip", folder / "venv", folder=folder)
    python = folder / "venv" / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    own = run(
        python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))", folder=folder
    ).strip()
    Path(own, "dependencies.pth").write_text(sysconfig.get_path("purelib") + "\n", encoding="utf-8")
    pip = (
        sys.executable,
        "-m",
        "pip",
        "--python",
        python,
        "install",
        "--quiet",
        "--disable-pip-version-check",
    )
    # an environment of its own for every build is fetched anew each time; .ci/run builds in one. A kurbel among the
    # dependencies is not the one that is meant
    run(*pip, "--no-build-isolation", "--no-deps", "--ignore-installed", *what, folder=folder)
    return python


def check_examples(python: Path, folder: Path) -> None:
    listed = run(python, "-m", "kurbel", "example", folder=folder).splitlines()
    assert [line.split()[0] for line in listed] == MACHINES
    shown = run(python, "-m", "kurbel", "example", "waterworks", folder=folder)
    _, _, printed = shown.partition("\n")  # after the line for editors
    assert printed == (ROOT / "configs" / "waterworks.yaml").read_text(encoding="utf-8")


def origin(python: Path, folder: Path) -> Path:
    return Path(run(python, "-c", "import kurbel; print(kurbel.__file__)", folder=folder).strip())


def test_no_file_is_a_symbolic_link() -> None:
    """A checkout on Windows makes a text file of it."""
    if not (ROOT / ".git").exists():
        pytest.skip("no checkout")
    listed = run("git", "ls-files", "--stage", folder=ROOT).splitlines()
    assert listed
    assert [line for line in listed if line.startswith("120000")] == []


@pytest.mark.slow
def test_wheel_and_sdist_hold_every_file_once(tmp_path: Path) -> None:
    """The wheel is built from the sdist, as installers do where there is no wheel."""
    run(
        sys.executable, "-m", "build", "--no-isolation", "--outdir", tmp_path, ROOT, folder=tmp_path
    )
    (wheel,), (sdist,) = tmp_path.glob("*.whl"), tmp_path.glob("*.tar.gz")
    with tarfile.open(sdist) as archive:
        held = [name.partition("/")[2] for name in archive.getnames()]
    for name in (
        "README.md",
        "CHANGELOG.md",
        "LICENSE",
        "pyproject.toml",
        "tests/project/test_packaging.py",
    ):
        assert held.count(name) == 1
    for folder in ("docs", "tools", "benchmarks", "tests", "src", "configs"):
        there = [f"{folder}/{path.name}" for path in (ROOT / folder).iterdir() if path.is_file()]
        assert set(there) <= set(held)
    assert sorted(Path(name).stem for name in held if "configs/" in name) == MACHINES
    names = zipfile.ZipFile(wheel).namelist()
    assert sorted(Path(name).stem for name in names if name.endswith(".yaml")) == MACHINES
    assert all(f"kurbel/configs/{machine}.yaml" in names for machine in MACHINES)
    assert any(name.endswith("share/man/man1/kurbel.1") for name in names)
    assert not [name for name in names if name.startswith(("tests", "benchmarks", "docs", "tools"))]
    python = installed(tmp_path, wheel)
    check_examples(python, tmp_path)
    assert tmp_path in origin(python, tmp_path).parents
