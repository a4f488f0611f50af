"""The way in, for `kurbel` and `python -m kurbel`: small, since nothing guards it against an interrupt but itself.

What it imports at its head Python has imported already: the working directory may still be the first place to look.
"""

import os
import sys

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import NoReturn


def main() -> "NoReturn":
    """Run the command line; an interrupt ends it silently with status 130, while it is being imported too."""
    _leave_out_working_directory()
    _open_closed_streams()
    # matrices of nine rows are no work for many: threads cost their making, and wait for each other in a sweep
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    try:
        from kurbel.cli import kurbel

        kurbel.main()
    except KeyboardInterrupt:
        sys.exit(130)


def _leave_out_working_directory() -> None:
    """Look for modules in the working directory no more, where `python -m` and an empty PYTHONPATH put it first.

    It stays where kurbel itself comes from it.
    """
    library = os.path.dirname(os.__file__)
    first = sys.path.index(library) if library in sys.path else 1
    package_directory = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    try:
        here = os.path.realpath(os.getcwd())
    except OSError:  # it is deleted
        here = ""
    if here != os.path.realpath(package_directory):
        sys.path[:first] = [
            directory
            for directory in sys.path[:first]
            if directory and os.path.realpath(directory) != here
        ]


def _open_closed_streams() -> None:
    """Give closed standard streams to the null device, or else the first file that is opened becomes one of them."""
    while (descriptor := os.open(os.devnull, os.O_RDWR)) <= 2:
        pass
    os.close(descriptor)


if __name__ == "__main__":
    main()
