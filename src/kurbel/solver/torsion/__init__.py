"""Torsional vibration of the shaft line of a machine."""
