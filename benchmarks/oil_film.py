"""Oil films of all bearings of the gas engine, as a ratio to `import numpy` of the same run.

    python benchmarks/oil_film.py [ROUNDS]

Both take turns, and the least times are compared: on a machine that does other work besides only
these show what is needed. `import numpy` takes some 0.1 s on an idle machine; all films are to take
no longer.
"""

import subprocess
import sys
import time
from pathlib import Path

from kurbel.machine import Machine
from kurbel.machine_file import load
from kurbel.solver.case import Case

ENGINE = Path(__file__).parent.parent / "configs" / "gas-engine.yaml"
BUDGET = 1.0


def seconds_of_films(machine: Machine) -> dict[str, float]:
    """Return the time of orbit and key values of every bearing, whose loads are computed before."""
    times = {}
    for bearing in Case(machine).bearings.parts:
        _ = bearing.load_max
        begin = time.perf_counter()
        assert bearing.film_thickness_min
        times[bearing.name] = time.perf_counter() - begin
    return times


def seconds_of_numpy() -> float:
    begin = time.perf_counter()
    subprocess.run([sys.executable, "-c", "import numpy"], check=True)
    return time.perf_counter() - begin


def main() -> None:
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 15
    machine = load(ENGINE)
    seconds_of_films(machine)  # warms up
    films = []
    numpy = []
    for _ in range(rounds):
        films.append(seconds_of_films(machine))
        numpy.append(seconds_of_numpy())
    least = {name: min(times[name] for times in films) for name in films[0]}
    for name, seconds in least.items():
        print(f"{name:<16}{1e3 * seconds:>8.1f} ms")
    whole = sum(least.values())
    print(f"{'import numpy':<16}{1e3 * min(numpy):>8.1f} ms")
    ratio = whole / min(numpy)
    print(
        f"{'all films':<16}{1e3 * whole:>8.1f} ms{ratio:>8.2f} of import numpy, budget {BUDGET:.2f}"
    )


if __name__ == "__main__":
    main()
