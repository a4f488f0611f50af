"""Chunks of a sweep computed by this process, by others on this machine, or by a cluster, and returned in order."""

import logging
import os
import pickle
import subprocess
import sys
import warnings
from collections import deque
from collections.abc import Callable, Generator, Iterator
from concurrent.futures import CancelledError, ThreadPoolExecutor
from contextlib import contextmanager
from queue import SimpleQueue
from signal import Signals
from typing import Any

from kurbel.designs.sweep import Design, Spec, Sweep, computed
from kurbel.errors import KurbelError, UsageError

_FOR_ONE = 5_000
"""Least rows of a process: about as many are computed while another process starts."""
_MOST_JOBS = 4
"""Most processes started by default: the computer may have other work, and each needs memory for the library."""
_AHEAD = 3
"""Chunks per worker that are submitted ahead: little is computed that is not yet read."""
_RETRIES = 5
"""How often a chunk is sent again if its worker is lost."""
_ANSWERS_WITHIN = 10.0
"""Seconds in which a cluster must answer."""
_LOOKED_EVERY = 1.0
"""Seconds of waiting for a chunk after which it is checked that the cluster has workers."""

Answer = Callable[[], list[Design]]
"""Waits for the rows of a chunk and returns them."""
Submit = Callable[[Spec, range, range], Answer]
"""Submits a chunk: see `computed`."""


def rows_of(
    sweep: Sweep, rows: range, jobs: int = 1, dask: str = "", note: Callable[[str], None] = lambda _: None
) -> Generator[Design, None, None]:
    """Yield rows in their order as soon as they are computed.

    jobs: processes on this computer; dask: address of a cluster; note: is called with messages for the user.
    Raises UsageError for an address that does not answer, KurbelError where a process or the cluster is lost.
    """
    if dask:
        with _cluster(dask, note) as (submit, workers):
            yield from _gathered(sweep, rows, submit, workers)
    elif jobs > 1:
        with _processes(jobs) as submit:
            yield from _gathered(sweep, rows, submit, lambda: jobs)
    else:
        for together, wanted in sweep.chunks(rows):
            yield from sweep.chunk(together, wanted)


def likely_jobs(rows: int) -> int:
    """Return the number of processes on this computer that is worthwhile for so many rows."""
    # a scheduler may have left this process fewer cores than the machine has
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return max(min(cores, _MOST_JOBS, rows // _FOR_ONE), 1)


def _gathered(sweep: Sweep, rows: range, submit: Submit, workers: Callable[[], int]) -> Iterator[Design]:
    """Yield the rows that others compute, in order, with few chunks of them ahead; workers: how many there are now."""
    waiting: deque[Answer] = deque()
    for together, wanted in sweep.chunks(rows):
        waiting.append(submit(sweep.spec, together, wanted))
        if len(waiting) > _AHEAD * workers():
            yield from waiting.popleft()()
    while waiting:
        yield from waiting.popleft()()


@contextmanager
def _processes(jobs: int) -> Iterator[Submit]:
    # isolated, so that none looks for modules in the working directory; a session of its own hears no interrupt
    code = f"import sys; sys.path[:] = {list(filter(None, sys.path))}; from kurbel.designs.workers import work; work()"
    pipe = subprocess.PIPE
    processes = [
        subprocess.Popen([sys.executable, "-I", "-c", code], stdin=pipe, stdout=pipe, start_new_session=True)
        for _ in range(jobs)
    ]
    idle = SimpleQueue[Any]()
    for process in processes:
        idle.put(process)
    threads = ThreadPoolExecutor(jobs)

    def answer(*task: Any) -> list[Design]:
        process = idle.get()
        try:
            return _answered(process, task)
        finally:
            idle.put(process)

    try:
        yield lambda *task: threads.submit(answer, *task).result
    finally:
        for process in processes:
            process.kill()
        threads.shutdown(cancel_futures=True)
        for process in processes:
            process.communicate()


def _answered(process: "subprocess.Popen[bytes]", task: tuple[Any, ...]) -> list[Design]:
    """Return the rows that a process computes; raises what it meets, and KurbelError where it ends instead."""
    assert process.stdin
    assert process.stdout
    try:
        pickle.dump(task, process.stdin)
        process.stdin.flush()
        found = pickle.load(process.stdout)
    except (OSError, EOFError, pickle.UnpicklingError):  # its ends of the pipes are closed
        raise KurbelError(_end_of(process.wait())) from None
    if isinstance(found, Exception):
        raise found
    return found


def _end_of(status: int) -> str:
    if status >= 0:
        return f"a worker process ended early with status {status}"
    try:
        name = Signals(-status).name
    except ValueError:  # one that has no name, as those for real time
        name = f"signal {-status}"
    return f"a worker process was killed ({name}), by the system if memory ran out; --jobs 1 needs the least"


def work() -> None:
    """Compute the chunks that standard input has, until it ends, and write their rows to standard output."""
    warnings.simplefilter("error", RuntimeWarning)  # as in the process that started this one
    while True:
        try:
            task = pickle.load(sys.stdin.buffer)
        except EOFError:
            return
        try:
            found: Any = computed(*task)
        except Exception as error:
            found = error
        try:
            pickle.dump(found, sys.stdout.buffer)
            sys.stdout.buffer.flush()
        except BrokenPipeError:  # the process that started this one has ended; what is buffered is for nobody
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            return


@contextmanager
def _cluster(address: str, note: Callable[[str], None]) -> Iterator[tuple[Submit, Callable[[], int]]]:
    try:
        import asyncio

        from distributed import Client, TimeoutError
        from distributed.comm import CommClosedError, connect
    except ImportError:
        raise UsageError("--dask needs dask.distributed: pip install 'kurbel[dask]'") from None

    async def reached() -> None:
        await (await connect(address, timeout=_ANSWERS_WITHIN)).close()

    logging.disable()  # of a lost scheduler it writes tracebacks
    try:
        asyncio.run(reached())  # a client that reaches nothing waits 20 s at its end, and writes a traceback
        client = Client(address, timeout=_ANSWERS_WITHIN, set_as_default=False)
    except (OSError, ValueError, TypeError) as error:  # no address, no answer in time, or a protocol that is not set up
        raise UsageError(f"--dask {address}: no scheduler responds there ({_first_line(error)})") from None

    def workers() -> int:
        return max(len(client.nthreads()), 1)

    def submit(spec: Spec, together: range, wanted: range) -> Answer:
        key = f"kurbel-{hash(spec)}-{wanted}"
        future = client.submit(computed, spec, together, wanted, retries=_RETRIES, key=key)

        def answer() -> list[Design]:
            waiting = False
            while True:
                try:
                    return future.result(timeout=_LOOKED_EVERY)
                except TimeoutError:
                    if not waiting and not client.nthreads():
                        note(f"--dask {address}: the cluster has no workers; waiting for one")
                        waiting = True

        return answer

    try:
        yield submit, workers
    except Exception as error:
        if client.status != "running" or isinstance(error, (CancelledError, CommClosedError)):
            raise KurbelError(f"--dask {address}: the connection to the scheduler is lost") from None
        raise KurbelError(f"--dask {address}: {type(error).__name__}: {_first_line(error)}") from None
    finally:
        client.close()


def _first_line(error: Exception) -> str:
    return str(error).partition("\n")[0]
