"""References of the stiff scenes of `kurbel accuracy`: the speed of the shaft by collocation in 40 digits of mpmath.

python benchmarks/stiff_scenes.py [SCENE …] computes those of the scenes whose names contain a word, by default of all,
and writes them into src/kurbel/accuracy/stiff.tsv. A scene takes from seconds to minutes.
"""

import sys
from pathlib import Path

from kurbel import accuracy, loads
from kurbel.accuracy.methods import mp
from kurbel.accuracy.references import Textbook
from kurbel.accuracy.shaft import SpeedOfShaft, TextbookShaft, speed_of
from kurbel.accuracy.textbook import DIGITS

TABLE = Path(accuracy.__file__).parent / "stiff.tsv"
PRINTED = 25
MOST = 3000


def numbers(values: object) -> str:
    """Return numbers with 25 digits, separated by blanks."""
    return " ".join(mp.nstr(value, PRINTED) for value in values)


def columns(speed: SpeedOfShaft) -> list[str]:
    """Return the columns of a reference."""
    return [
        numbers(speed.omega),
        numbers([speed.delta]),
        numbers([speed.omega_max]),
        numbers(speed.M_K),
    ]


def main() -> None:
    words = sys.argv[1:]
    head, *lines = TABLE.read_text(encoding="utf-8").splitlines()
    for number, line in enumerate(lines):
        quick, text, *_ = line.split("\t")
        machine = loads(text)
        if words and not any(word in machine.name for word in words):
            continue
        print(machine.name, flush=True)
        with mp.workdps(DIGITS):
            reference = columns(speed_of(TextbookShaft(Textbook(machine)), MOST))
        lines[number] = "\t".join([quick, text, *reference])
        TABLE.write_text("\n".join([head, *lines]) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
