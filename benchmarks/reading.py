"""Time to read 1e5 points from a machine file (with dashes, in brackets) and a trace file, as ratio to `import numpy`.

python benchmarks/reading.py
"""

from __future__ import annotations

import gc
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

START = time.process_time()
import numpy  # noqa: E402, F401

NUMPY = time.process_time() - START

from kurbel.machine.trace import Trace  # noqa: E402
from kurbel.machine_file import loads  # noqa: E402

PAIRS = [(f"{i * 360 / 1e5:.4f}", f"{100 + i % 7}") for i in range(100_001)]
HEAD = "effort:\n  unit: N m\n  points:"


def ratio(work: Callable[[], object]) -> float:
    """Return the least time of three, over that of importing numpy."""
    times = []
    for _ in range(3):
        start = time.process_time()
        work()
        times.append(time.process_time() - start)
    return min(times) / NUMPY


def main() -> None:
    gc.disable()  # as the command line does
    loads(f"{HEAD} [[0, 1], [360, 1]]")
    dashes = HEAD + "".join(f"\n    - [{x}, {y}]" for x, y in PAIRS)
    brackets = f"{HEAD} [{', '.join(f'[{x}, {y}]' for x, y in PAIRS)}]"
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "p.csv"
        file.write_text("\n".join(f"{x},{y}" for x, y in PAIRS))
        print(f"import numpy   1.0   ({NUMPY:.2f} s)")
        print(f"dashes       {ratio(lambda: loads(dashes)):5.1f}")
        print(f"in brackets  {ratio(lambda: loads(brackets)):5.1f}")
        print(f"trace file   {ratio(lambda: Trace.from_keys((1e5, 1), file=str(file))):5.1f}")


if __name__ == "__main__":
    main()
