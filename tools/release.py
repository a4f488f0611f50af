"""Make a release: python tools/release.py 0.2.0, on a clean main branch; --dry-run shows what it would do.

Sets the version, dates the changelog, runs .ci/run, commits and tags, and builds wheel and sdist into dist/.
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
from collections.abc import Callable
from datetime import date
from pathlib import Path

ROOT = Path(__file__).parent.parent


def _with_version(text: str, version: str) -> str:
    return re.sub(r'__version__ = "[^"]+"', f'__version__ = "{version}"', text)


def _cited(text: str, version: str) -> str:
    return re.sub(r"(?m)^version: .*$", f"version: {version}", text)


def _dated(text: str, version: str) -> str:
    """Return the changelog with its unreleased part under this version and today, and a new empty one above."""
    if not re.search(r"(?m)^## \[Unreleased\]\n+(?!## )", text):
        sys.exit("CHANGELOG.md: nothing stands under [Unreleased]")
    return text.replace(
        "## [Unreleased]", f"## [Unreleased]\n\n## [{version}] - {date.today().isoformat()}", 1
    )


CHANGED: dict[str, Callable[[str, str], str]] = {
    "src/kurbel/__init__.py": _with_version,
    "CITATION.cff": _cited,
    "CHANGELOG.md": _dated,
}
"""File -> what a release makes of its text."""


def main() -> None:
    given = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    given.add_argument("version", help="such as 0.2.0")
    given.add_argument(
        "--dry-run", action="store_true", help="change nothing, say what would be done"
    )
    asked = given.parse_args()
    if not re.fullmatch(r"\d+\.\d+\.\d+", asked.version):
        sys.exit(f"'{asked.version}' is no version: write three numbers, such as 0.2.0")
    if subprocess.run(
        ["git", "status", "--porcelain"], cwd=ROOT, capture_output=True, check=True
    ).stdout.strip():
        sys.exit(
            "there are changes that are not committed: a release is made from a clean checkout"
        )
    texts = {
        name: change((ROOT / name).read_text("utf-8"), asked.version)
        for name, change in CHANGED.items()
    }
    commands = [
        ["bash", ".ci/run"],
        ["git", "commit", "--all", "--message", f"Release {asked.version}"],
        ["git", "tag", "--annotate", f"v{asked.version}", "--message", f"kurbel {asked.version}"],
        [sys.executable, "-m", "build"],
    ]
    if asked.dry_run:
        print(
            "would change",
            ", ".join(texts),
            *(f"\nwould run {' '.join(command)}" for command in commands),
        )
        return
    for name, text in texts.items():
        (ROOT / name).write_text(text, encoding="utf-8", newline="\n")
    for command in commands:
        subprocess.run(command, cwd=ROOT, check=True)


if __name__ == "__main__":
    main()
