"""Speed of the shaft of the extreme machines: kurbel's and its time, against collocation in 40 digits of mpmath.

python benchmarks/speed_lines.py [MOST]

The references that the table of `kurbel accuracy --extremes` has of ω are computed as those of the stiff scenes, by
kurbel.accuracy.shaft. MOST: of the machines of the table; a few seconds each.
"""

import sys
import time

from kurbel import loads
from kurbel.accuracy.extremes import Probe, all_cases
from kurbel.accuracy.methods import Precise, mp, mpf
from kurbel.accuracy.references import Textbook
from kurbel.accuracy.shaft import EVERY, TextbookShaft, speed_of
from kurbel.accuracy.textbook import DIGITS
from kurbel.machine import Machine
from kurbel.solver.case import Case

ASKED = "flywheel omega@"
MOST_ELEMENTS = 3000


def compared(machine: Machine, case: Probe, truth: Precise) -> str:
    """Return the line of a case: its reference, what the table has, and kurbel with its time."""
    angle = float(case.asked.removeprefix(ASKED))
    begin = time.perf_counter()
    omega = float(Case(machine).flywheel.at([angle]).omega[0])
    spent = 1e3 * (time.perf_counter() - begin)
    of_table = float(abs(mpf(case.expected) / truth - 1))
    of_kurbel = float(abs(mpf(omega) / truth - 1))
    names = f"{case.case:<34}{angle:>5g}  {mp.nstr(truth, 30):<34}"
    return f"{names}{of_table:>14.0e}{of_kurbel:>10.0e}{spent:>8.1f}"


def main() -> None:
    most = int(sys.argv[1]) if len(sys.argv) > 1 else 100
    cases = [case for case in all_cases() if case.asked.startswith(ASKED)]
    texts = list(dict.fromkeys(case.machine for case in cases))
    print(f"{'machine':<34}{'at':>5}  {'reference':<34}{'of the table':>14}{'kurbel':>10}{'ms':>8}")
    with mp.workdps(DIGITS):
        for text in texts[:most]:
            machine = loads(text)
            omega = speed_of(TextbookShaft(Textbook(machine)), MOST_ELEMENTS).omega
            for case in cases:
                angle = float(case.asked.removeprefix(ASKED))
                if case.machine == text:
                    print(compared(machine, case, omega[round(angle / EVERY) - 1]), flush=True)


if __name__ == "__main__":
    main()
