"""The way in, for `kurbel` and `python -m kurbel`: small, since nothing guards it against an interrupt but itself."""

from __future__ import annotations

import sys

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import NoReturn


def main() -> NoReturn:
    """Run the command line; an interrupt ends it silently with status 130, while it is being imported too."""
    try:
        from kurbel.cli import main as run

        run()
    except KeyboardInterrupt:
        sys.exit(130)


if __name__ == "__main__":
    main()
