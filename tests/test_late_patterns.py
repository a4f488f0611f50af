"""Regular expressions of others are compiled when they are needed; whoever needs one finds it whole."""

import re
import subprocess
import sys
import threading

import pytest

from kurbel.late_patterns import LatePattern, late_patterns

_BOTH_WAYS = """
import datetime, kurbel, yaml
assert kurbel.loads("{crank: 1 m, rod_ratio: 5}").cylinders
assert yaml.load("day: 2026-11-22", Loader=yaml.SafeLoader) == {"day": datetime.date(2026, 11, 22)}
assert yaml.load("[0x10, 1.5e+3, ~, on]", Loader=yaml.SafeLoader) == [16, 1500.0, None, True]
try:
    yaml.load("a: \\x07", Loader=yaml.SafeLoader)
except yaml.reader.ReaderError:
    print("refused")
"""


@pytest.fixture(autouse=True)
def _alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever runs the tests may have threads of its own."""
    own = threading.active_count() - 1
    count = threading.active_count
    monkeypatch.setattr(threading, "active_count", lambda: count() - own)


def test_a_late_pattern_is_the_expression_it_stands_for() -> None:
    with late_patterns():
        late = re.compile("a(?P<digits>[0-9]+)", re.IGNORECASE)
        assert isinstance(late, LatePattern)
        found = late.match("A12")
    assert found is not None
    assert found["digits"] == "12"
    assert late.groupindex == {"digits": 1}


def test_patterns_are_compiled_at_once_again_after_an_error() -> None:
    with pytest.raises(ImportError), late_patterns():
        raise ImportError
    assert isinstance(re.compile("a+b"), re.Pattern)


def test_a_loader_in_python_works_beside_kurbel() -> None:
    """The types that yaml guesses and the characters that it refuses are those of its late expressions."""
    done = subprocess.run([sys.executable, "-c", _BOTH_WAYS], capture_output=True, text=True, check=False)
    assert (done.stdout, done.stderr) == ("refused\n", "")


def test_nothing_is_late_beside_another_thread() -> None:
    done = threading.Event()
    other = threading.Thread(target=done.wait)
    other.start()
    try:
        with late_patterns():
            assert isinstance(re.compile("a+c"), re.Pattern)
    finally:
        done.set()
        other.join()
