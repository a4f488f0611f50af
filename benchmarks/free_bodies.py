"""References of the shipped machines: forces and work by free bodies of every member, in 40 digits of mpmath.

python benchmarks/free_bodies.py [--write] [MACHINE …] computes those of the machines whose names contain a word, by
default of all, and compares kurbel with them; --write: puts them into tests/accuracy/free_bodies.tsv. A machine takes
from a tenth of a second to four seconds.
"""

import sys
from pathlib import Path

import numpy as np

from kurbel import loads
from kurbel.accuracy.methods import mp
from kurbel.accuracy.references import NEEDED, Textbook, unknown
from kurbel.accuracy.textbook import DIGITS
from kurbel.accuracy.trials import errors, kurbel_answer
from kurbel.shipped import shipped

TABLE = Path(__file__).parent.parent / "tests" / "accuracy" / "free_bodies.tsv"
PRINTED = 25


def lines_of(name: str) -> list[str]:
    """Return the lines of a machine: its name, a quantity, and the value or the values with 25 digits."""
    machine = loads(shipped()[name])
    textbook = Textbook(machine)
    lines = []
    for quantity in NEEDED:
        answer = kurbel_answer(machine, quantity)
        if answer is None:
            continue
        obstacle = next(unknown(machine, quantity), "")
        if obstacle:
            print(f"{name:<28}{quantity:<14}no independent calculation of {obstacle}", flush=True)
            continue
        truth = np.atleast_1d(np.array(textbook.reference(quantity), dtype=object))
        values = " ".join(mp.nstr(value, PRINTED) for value in truth)
        lines.append("\t".join((name, quantity, values)))
        if np.abs(truth).max() < 1e-30:
            print(f"{name:<28}{quantity:<14}is zero", flush=True)
            continue
        error, _ = errors(np.atleast_1d(np.asarray(answer, dtype=float)), truth)
        print(f"{name:<28}{quantity:<14}{error:.1e}", flush=True)
    return lines


def main() -> None:
    words = [word for word in sys.argv[1:] if word != "--write"]
    head, *stored = ["machine\tquantity\tvalues"]
    if TABLE.exists():
        head, *stored = TABLE.read_text(encoding="utf-8").splitlines()
    lines: list[str] = []
    for name in shipped():
        if words and not any(word in name for word in words):
            lines += [line for line in stored if line.startswith(f"{name}\t")]
            continue
        with mp.workdps(DIGITS):
            lines += lines_of(name)
    if "--write" in sys.argv:
        TABLE.write_text("\n".join([head, *lines]) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
