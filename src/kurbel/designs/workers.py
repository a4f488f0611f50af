"""Who computes the chunks of a sweep: this process, others on this machine, or a cluster; the order stays."""

import os
import signal
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from kurbel.designs.sweep import Row, Spec, Sweep, computed
from kurbel.errors import UsageError

_FOR_ONE = 5_000
"""Rows that one process should have at least: about so many are computed while another one starts."""
_MOST_JOBS = 4
"""Processes that are started unasked: the machine may have other work, and each holds the library."""
_AHEAD = 3
"""Chunks per worker that are on their way: what is computed and not yet read stays little."""
_RETRIES = 5
"""How often a chunk is sent anew whose worker was lost."""
_ANSWERS_WITHIN = 10.0
"""Seconds in which a cluster must answer."""


def rows_of(sweep: Sweep, rows: range, jobs: int = 1, dask: str = "") -> Iterator[Row]:
    """Yield rows in their order as soon as they are there; jobs: processes of this machine; dask: address of a cluster.

    Raises UsageError for an address that does not answer.
    """
    if dask:
        with _cluster(dask) as (submit, workers):
            yield from _gathered(sweep, rows, submit, workers)
    elif jobs > 1:
        with _processes(jobs) as submit:
            yield from _gathered(sweep, rows, submit, jobs)
    else:
        for company, wanted in sweep.chunks(rows):
            yield from sweep.chunk(company, wanted)


def likely_jobs(rows: int) -> int:
    """Return how many processes of this machine so many rows are worth."""
    # a scheduler may have left this process fewer cores than the machine has
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return max(min(cores, _MOST_JOBS, rows // _FOR_ONE), 1)


def _gathered(sweep: Sweep, rows: range, submit: Callable[..., Any], workers: int) -> Iterator[Row]:
    """Yield the rows that others compute, in order, with few chunks of them ahead."""
    waiting: deque[Any] = deque()
    for company, wanted in sweep.chunks(rows):
        waiting.append(submit(computed, sweep.spec, company, wanted))
        if len(waiting) > _AHEAD * workers:
            yield from waiting.popleft().result()
    while waiting:
        yield from waiting.popleft().result()


@contextmanager
def _processes(jobs: int) -> Iterator[Callable[..., Any]]:
    from concurrent.futures import ProcessPoolExecutor
    from multiprocessing import active_children, get_context

    pool = ProcessPoolExecutor(jobs, get_context("spawn"), initializer=_end_with_parent)

    def submit(*task: Any) -> Any:
        with _interrupts_wait():  # for ever in the processes that are started here: one is for this process alone
            return pool.submit(*task)

    try:
        yield submit
    except BaseException:  # nobody waits for what they still compute
        with _interrupts_wait():
            for worker in active_children():
                worker.terminate()
        raise
    finally:
        with _interrupts_wait():  # the second of an impatient user would leave half of it behind
            pool.shutdown(wait=True, cancel_futures=True)


def _end_with_parent() -> None:
    """End this process when the one that started it does, killed or not: nobody else would tell it to."""
    from multiprocessing import parent_process
    from threading import Thread

    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, (signal.SIGTERM,))  # by which that one ends it
    parent = parent_process()
    assert parent is not None

    def follow() -> None:
        parent.join()
        os._exit(1)

    Thread(target=follow, daemon=True).start()


@contextmanager
def _interrupts_wait() -> Iterator[None]:
    """Hear an interrupt that comes meanwhile afterwards, where the system can keep it; SIGTERM may be heard as one."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, (signal.SIGINT, signal.SIGTERM))
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextmanager
def _cluster(address: str) -> Iterator[tuple[Callable[..., Any], int]]:
    try:
        from distributed import Client
    except ImportError:
        raise UsageError("--dask needs dask.distributed: pip install 'kurbel[dask]'") from None
    try:
        client = Client(address, timeout=_ANSWERS_WITHIN, set_as_default=False)
    except (OSError, ValueError, TypeError) as error:  # no address, no answer in time, or a way that is not set up
        raise UsageError(f"--dask {address}: no scheduler answers there ({str(error).splitlines()[0]})") from None

    def submit(function: Callable[..., Any], spec: Spec, company: range, wanted: range) -> Any:
        key = f"kurbel-{hash(spec)}-{wanted}"
        return client.submit(function, spec, company, wanted, retries=_RETRIES, key=key)

    try:
        yield submit, max(len(client.scheduler_info()["workers"]), 1)
    finally:
        client.close()
