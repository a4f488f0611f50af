"""kurbel: crank-drive calculation."""

__version__ = "0.1.0"
