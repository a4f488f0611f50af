"""Measured traces: files read, samples cut into whole cycles, corrected, and checked for what is implausible."""
