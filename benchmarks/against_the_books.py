"""Print the table of the README: how far off the methods are that engineers use instead, for the steam engine.

python benchmarks/against_the_books.py: runs `kurbel accuracy --quick` and puts three of its methods side by side.
"""

from __future__ import annotations

import json
import subprocess
import sys

METHODS = {
    "10° table": "by hand or spreadsheet, a row every 10°",
    "1° table": "spreadsheet, a row every degree",
    "kurbel": "kurbel",
}
"""Method as the table calls it -> what it is to the reader."""
TABLES = {"36": "10° table", "360": "1° table"}
ROWS = ("A_i", "T_max, T_min", "A_f", "ΔE")
MEANING = {
    "A_i": "indicated work",
    "T_max, T_min": "largest and smallest tangential force",
    "A_f": "friction work of the crosshead",
    "ΔE": "excess work, which sizes the flywheel",
}


def errors() -> dict[tuple[str, str], float]:
    """Return the error of every method in every quantity of the first machine."""
    asked = [sys.executable, "-m", "kurbel", "accuracy", "--quick", "-f", "json"]
    answer = json.loads(
        subprocess.run(asked, capture_output=True, check=True, encoding="utf-8").stdout
    )
    table = answer["scenes"][0]["place_tables"][0]
    values = next(column["values"] for column in table["columns"] if column["id"] == "error")
    found: dict[tuple[str, str], float] = {}
    quantity = ""
    for row, error in zip(table["rows"], values):
        quantity = row["quantity"] or quantity
        method = row["method"]
        if method in ("trapezium rule", "largest ordinate"):
            method = TABLES.get(row["points"], "")
        found[quantity, method] = error
    return found


def main() -> None:
    found = errors()
    print("| relative error of | " + " | ".join(METHODS.values()) + " |")
    print("| --- " + "| --: " * len(METHODS) + "|")
    for quantity in ROWS:
        cells = " | ".join(f"{found[quantity, method]:.0e}" for method in METHODS)
        print(f"| {MEANING[quantity]} | {cells} |")


if __name__ == "__main__":
    main()
