"""What a command imports, without a process of its own for each."""

from __future__ import annotations

import sys
from importlib import import_module

from click.testing import CliRunner

OPTIONAL = ("kurbel", "rich", "typst", "scipy", "mpmath", "hashlib", "decimal", "fractions", "cmath", "unicodedata")


def modules_after(*commands: list[str]) -> set[str]:
    """Return the modules that there are after these commands, run as if nothing of `OPTIONAL` had been imported before.

    The modules of the tests are put aside meanwhile, and come back as they were.
    """
    before = {name: module for name, module in sys.modules.items() if name.partition(".")[0] in OPTIONAL}
    for name in before:
        del sys.modules[name]
    try:
        kurbel = import_module("kurbel.cli").kurbel
        for command in commands:
            result = CliRunner().invoke(kurbel, command)
            assert result.exit_code == 0, result.output
        return set(sys.modules)
    finally:
        for name in [name for name in sys.modules if name.partition(".")[0] in OPTIONAL]:
            del sys.modules[name]
        sys.modules.update(before)
