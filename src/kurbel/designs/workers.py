"""Blocks of a sweep computed by this process, by others on this machine, or by a cluster, and returned in order."""

import logging
import os
import pickle
import subprocess
import sys
import warnings
from collections import deque
from collections.abc import Callable, Generator, Iterator
from contextlib import contextmanager, suppress
from functools import lru_cache
from itertools import cycle, islice
from typing import Any

from kurbel.designs.study import Design
from kurbel.designs.sweep import Spec, Sweep
from kurbel.errors import KurbelError, UsageError

_FOR_ONE = 5_000
"""Least rows of a process: about as many are computed while another process starts."""
_MOST_JOBS = 4
"""Most processes started by default: the computer may have other work, and each needs memory for the library."""
_AHEAD = 3
"""Blocks per worker of a cluster that are submitted ahead: little is computed that is not yet read."""
_ANSWERS_WITHIN = 10.0
"""Seconds in which a cluster must answer."""


def rows_of(
    sweep: Sweep, rows: range, jobs: int = 1, dask: str | None = None, note: Callable[[str], None] = lambda _: None
) -> Generator[Design, None, None]:
    """Yield rows in their order as soon as they are computed.

    jobs: processes on this computer; dask: address of a cluster; note: is called with messages for the user.
    Raises UsageError for an address that does not answer, KurbelError where a process or the cluster is lost.
    """
    if dask is not None:
        blocks = _of_cluster(sweep, rows, dask, note)
    else:
        blocks = _of_processes(sweep, rows, jobs) if jobs > 1 else map(sweep.block, sweep.blocks(rows))
    for block in blocks:
        yield from (row for row in block if row.number - 1 in rows)


def likely_jobs(rows: int) -> int:
    """Return the number of processes on this computer that is worthwhile for so many rows."""
    # a scheduler may have left this process fewer cores than the machine has
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return max(min(cores, _MOST_JOBS, rows // _FOR_ONE), 1)


def _of_processes(sweep: Sweep, rows: range, jobs: int) -> Iterator[list[Design]]:
    """Yield blocks in order from processes that each compute every so-many-th; a full pipe makes them wait."""
    # isolated, so that none looks for modules in the working directory; a session of its own hears no interrupt
    code = f"import sys; sys.path[:] = {list(filter(None, sys.path))}; from kurbel.designs.workers import work; work()"
    command, pipe = [sys.executable, "-I", "-c", code], subprocess.PIPE
    processes = [
        subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=subprocess.DEVNULL, start_new_session=True)
        for _ in range(jobs)
    ]
    try:
        for number, process in enumerate(processes):
            assert process.stdin
            pickle.dump((sweep.spec, rows, number, jobs), process.stdin)
            process.stdin.flush()
        for _, process in zip(sweep.blocks(rows), cycle(processes)):
            assert process.stdout
            yield pickle.load(process.stdout)
    except (OSError, EOFError, pickle.UnpicklingError):  # its ends of the pipes are closed
        why = "--jobs 1 needs the least memory, and shows what is wrong"
        raise KurbelError(f"a worker process ended early, with status {process.wait()}; {why}") from None
    finally:
        for process in processes:
            process.kill()
            process.communicate()


def work() -> None:
    """Compute every so-many-th block of the rows that standard input describes, and write them to standard output."""
    warnings.simplefilter("error", RuntimeWarning)  # as in the process that started this one
    spec, rows, first, jobs = pickle.load(sys.stdin.buffer)
    sweep = Sweep(spec)
    with suppress(BrokenPipeError):  # the process that started this one has ended
        for block in islice(sweep.blocks(rows), first, None, jobs):
            pickle.dump(sweep.block(block), sys.stdout.buffer)
            sys.stdout.buffer.flush()


_known = lru_cache(maxsize=4)(Sweep)


def _computed(spec: Spec, rows: range) -> list[Design]:
    """Return a block of a sweep, in a worker of a cluster, which makes a sweep only once."""
    return _known(spec).block(rows)


def _of_cluster(sweep: Sweep, rows: range, address: str, note: Callable[[str], None]) -> Iterator[list[Design]]:
    """Yield blocks in order from the workers of a cluster, with few of them ahead."""
    blocks, waiting = sweep.blocks(rows), deque[Any]()
    with _client(address) as client:
        while True:
            workers = len(client.nthreads())
            for block in islice(blocks, max(_AHEAD * max(workers, 1) - len(waiting), 0)):
                waiting.append(client.submit(_computed, sweep.spec, block, pure=False))
            if not waiting:
                return
            if not workers:
                note(f"--dask {address}: the cluster has no workers; waiting for one")
            yield waiting.popleft().result()


@contextmanager
def _client(address: str) -> Iterator[Any]:
    """Yield a client of a cluster; raises UsageError where there is none, KurbelError for what goes wrong later."""
    try:
        import asyncio

        from distributed import Client
        from distributed.comm import connect
    except ImportError:
        raise UsageError("--dask needs dask.distributed: pip install 'kurbel[dask]'") from None

    async def reached() -> None:
        await (await connect(address, timeout=_ANSWERS_WITHIN)).close()

    logging.disable()  # of a lost scheduler it writes tracebacks
    try:
        asyncio.run(reached())  # a client that reaches nothing waits 20 s at its end, and writes a traceback
        client = Client(address, timeout=_ANSWERS_WITHIN, set_as_default=False)
    except (OSError, ValueError, TypeError) as error:  # no address, no answer in time, or a protocol that is not set up
        first_line = str(error).partition("\n")[0]
        raise UsageError(f"--dask {address}: no scheduler responds there ({first_line})") from None
    try:
        yield client
    except Exception as error:
        raise KurbelError(f"--dask {address}: the cluster failed: {type(error).__name__}") from None
    finally:
        client.close()
