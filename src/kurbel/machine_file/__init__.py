"""The machine file: YAML in, `Machine` out, or every fault of the file with its line and column."""

from kurbel.machine_file.reader import load, loads

__all__ = ["load", "loads"]
