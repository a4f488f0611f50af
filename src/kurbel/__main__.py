"""`python -m kurbel`."""

from __future__ import annotations

from kurbel.cli import main

if __name__ == "__main__":
    main()
