"""No test is held to a time; and one switch rewrites every text that the tests keep of the program's output."""

import os
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

# random examples are the same at every run, and no clock is read; .ci/run draws four times as many. Others every
# time: --hypothesis-profile=other
EVERY = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.register_profile("brief", EVERY, max_examples=8, derandomize=True)
settings.register_profile("thorough", EVERY, max_examples=32, derandomize=True)
settings.register_profile("other", EVERY, max_examples=100, derandomize=False)
settings.load_profile("brief")

# processes that the tests start are an installed kurbel's: they find it compiled, instead of compiling it each anew
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)

# what pytest rewrites of the tests is kept for the next run, too: it takes most of the collection
sys.dont_write_bytecode = False

# as on the command line, where a thread for each core would only get in the way of the others
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# a width and a height in the environment (pytest-xdist sets both) hold for every output, by contract
os.environ.pop("COLUMNS", None)
os.environ.pop("LINES", None)


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--rewrite",
        action="store_true",
        help="write what the program prints now into tests/golden, the expected messages of bad machine files, the "
        "README and docs; read the diff. Not with -n.",
    )


@pytest.fixture
def kept(request: pytest.FixtureRequest) -> Callable[[Path, str], str]:
    """Return the text that is kept in a file; with --rewrite it is first replaced by the one that is printed now."""

    def text_in(file: Path, printed: str) -> str:
        if request.config.getoption("--rewrite"):
            file.write_text(printed, encoding="utf-8", newline="\n")
        return file.read_text(encoding="utf-8")

    return text_in
