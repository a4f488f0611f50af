"""The way in, for `kurbel` and `python -m kurbel`: small, since nothing guards it against an interrupt but itself."""

from __future__ import annotations

import gc
import os
import sys

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import NoReturn


def main() -> NoReturn:
    """Run the command line; an interrupt ends it silently with status 130, while it is being imported too."""
    gc.disable()  # a run is too short for its garbage to matter; looking for it costs a twentieth of the time
    # matrices of nine rows are no work for many: threads cost their making, and wait for each other in a sweep
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    try:
        from kurbel.late_patterns import late_patterns

        with late_patterns():
            from kurbel.cli import kurbel
        kurbel.main()
    except KeyboardInterrupt:
        _end(130)
    except SystemExit as end:
        _end(end.code)


def _end(status: str | int | None) -> NoReturn:
    """End without Python's tour through everything imported, a twentieth of a short run.

    Whatever needs an end of its own, as worker processes do, has come to it before.
    """
    try:
        sys.stdout.flush()
        sys.stderr.flush()
    except (AttributeError, OSError, ValueError):  # none, full or closed: Python's own end knows what is to be done
        sys.exit(status)
    os._exit(status if isinstance(status, int) else 0)


if __name__ == "__main__":
    main()
