"""A sweep: rows of inputs and key values, computed in order, block by block, here or by other processes."""

import logging
import math
import os
import pickle
import re
import subprocess
import sys
import warnings
from collections import deque
from collections.abc import Callable, Generator, Hashable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from functools import cached_property, lru_cache
from itertools import chain, cycle, islice
from typing import Any, NamedTuple

import numpy as np

from kurbel.declared.unit_systems import convert, shown_unit
from kurbel.designs.answers import Cell, Design, DesignResult, DesignValue, Head, Study, is_slow
from kurbel.designs.binding import KeyColumn, numbers_of
from kurbel.designs.plan import Input, Plan
from kurbel.errors import KurbelError, UsageError
from kurbel.machine.origin import Origin
from kurbel.machine_file.overrides import case_names, tree_of
from kurbel.machine_file.zeros import references_of
from kurbel.solver.case import Case
from kurbel.tables.tables import grouped, joined_names

_BLOCK, _SLOW_BLOCK = 1000, 10
"""Rows computed together, and those of designs that are computed one after another."""
_FIRST = 20
"""Rows of the first block, so that the first lines appear soon."""
_STARTS = 100
"""Rows in which the first valid machine is searched for."""
_GOLDEN = (5**0.5 - 1) / 2


class Spec(NamedTuple):
    """All that defines a sweep, so that it can be passed to other processes.

    axes, side_by_side, sample, seed, most: see `Plan`; cases: all load cases of the file. columns: ids or symbols;
    with_angles: next to each extreme its crank angle; system: of units; start: texts of a valid machine, if known.
    """

    origin: Origin
    axes: tuple[tuple[Input, ...], ...] = ()
    side_by_side: bool = False
    sample: int | None = None
    seed: int = 0
    most: int | None = None
    cases: bool = False
    columns: tuple[str, ...] = ()
    with_angles: bool = False
    system: str = "si"
    start: tuple[str, ...] = ()


def _comparable_cases(origin: Origin) -> tuple[str, ...]:
    """Return the names of the load cases of a file; raises UsageError where their pressures count from several zeros.

    One column would have absolute and gauge pressures below each other.
    """
    names = case_names(origin)
    case_of_zeros: dict[str, str] = {}
    for name in names:
        zeros: set[str] = set()
        with suppress(KurbelError):  # a faulty case says so in its row
            zeros = references_of(tree_of(origin._replace(case=name)))
        # cylinders may differ, each in columns of its own
        if zeros:
            case_of_zeros.setdefault(" or ".join(sorted(zeros)), name)
    if len(case_of_zeros) > 1:
        listed = " and ".join(f"{zeros} in '{name}'" for zeros, name in case_of_zeros.items())
        raise UsageError(f"--cases: pressures are {listed}; write those of all cases from one zero")
    return names


class Sweep:
    """The rows of one machine file. Raises UsageError for options that define no sweep."""

    def __init__(self, spec: Spec) -> None:
        self.spec = spec
        cases = [(Input("case", _comparable_cases(spec.origin)),)] if spec.cases else []
        self.plan = Plan([*cases, *spec.axes], spec.side_by_side, spec.sample, spec.seed, spec.most)
        self.rows = self.plan.rows
        starts: Iterable[int] = range(self.rows)
        if self.rows > _STARTS:
            # steps of the golden section: all over the plan, without repeating the same value of a key
            starts = (int(self.rows * (number * _GOLDEN % 1)) for number in range(_STARTS))
        self._keys = [input.key for input in self.plan.inputs]
        texts = chain([spec.start] if spec.start else [], map(self.plan.texts, starts))
        self._study = Study(
            spec.origin, self._keys, texts, spec.columns, spec.with_angles, cases=spec.cases
        )
        self.kinds = self._study.binder.kinds
        """The kind of number of each key, '' for words."""
        self._numbers = list(map(numbers_of, self.plan.inputs, self.kinds))
        self.texts = ("keeps", "broken", "failure") if self._study.limits else ("failure",)
        """Columns after the values: whether all limits are kept, `yes`, `no` or `` where one cannot be judged, the
        first that is not; why there are no values, or which limits cannot be judged."""

    @cached_property
    def heads(self) -> tuple[Head, ...]:
        """The heads of the columns, with units that are chosen by the first values."""
        heads = []
        binder = self._study.binder
        for column, kind, zero in zip(self._columns(range(1)), binder.kinds, binder.zeros):
            first = float(column.numbers[column.indices[0]])
            size = first if math.isfinite(first) else 0.0
            unit = shown_unit(kind, self.spec.system, size) if kind else ""
            heads.append(Head(column.input.key, unit, kind, input=True, zero=zero))
        return (*heads, *self._study.heads(self.spec.system))

    @cached_property
    def shown(self) -> list[tuple[str, int]]:
        """The heads for people, each with the index of its column: one for the key values of identical cylinders.

        Identical cylinders have equal values in all rows, unless the load case or a key of a single cylinder varies.
        """
        heads = [(head.id, index) for index, head in enumerate(self.heads)]
        of_single_cylinder = any(re.match(r"cylinders\W*\d", key) for key in self._keys)
        if self.spec.cases or of_single_cylinder:
            return heads
        # by name: the first of identical cylinders, or the cylinder itself
        originals = {
            cylinder.drive.name: cylinder.twin or cylinder
            for cylinder in Case(self._study.binder.machine).cylinders
        }
        answers = self._study.answers

        def content(index: int) -> Hashable:
            """Return what is equal for columns that become one; the index itself for one that stays alone."""
            answer = answers[index]
            value = self._study.first[index]
            what, _, owner = answer.subject.rpartition(" of ")
            if owner not in originals or not isinstance(value, float):
                return index
            return what, originals[owner], answer.quantity.id, answer.angle, f"{value:.9g}"

        input_count = len(self._keys)
        shown = heads[:input_count]
        for group in grouped(range(len(answers)), content):
            name, column = heads[input_count + group[0]]
            if len(group) > 1:
                owners = joined_names([answers[index].subject for index in group])
                name = f"{owners}.{name.rpartition('.')[2]}"
            shown.append((name, column))
        return shown

    def blocks(self, rows: range) -> Iterator[range]:
        """Yield the blocks of rows, counted from 0, that have any of these rows.

        A row is computed together with the same rows in every run, since its last digits may depend on their number.
        """
        size = _SLOW_BLOCK if is_slow(self._study.binder.machine, self._study.every) else _BLOCK
        start, stop = 0, min(_FIRST, size)
        while start < rows.stop:
            if stop > rows.start:
                yield range(start, min(stop, self.rows))
            start, stop = stop, stop - stop % size + size

    def block(self, rows: range) -> list[Design]:
        """Return the rows of a block."""
        results = self._study.of(self._columns(rows))
        lacking = [None] * len(self._study.answers)
        heads = self.heads[len(self._keys) :]
        values_of_rows = [result.values or lacking for result in results]
        columns = [_in_unit(column, head) for column, head in zip(zip(*values_of_rows), heads)]
        designs = []
        for row, inputs, values, result in zip(rows, self.inputs(rows), zip(*columns), results):
            designs.append(Design(row + 1, (*inputs, *values), self._texts(result)))
        return designs

    def inputs(self, rows: Sequence[int]) -> Iterable[tuple[Cell, ...]]:
        """Return the values of the inputs in these rows, counted from 0."""
        cells_of_columns: list[list[Cell]] = []
        for head, column in zip(self.heads, self._columns(rows)):
            in_unit = convert(column.numbers[column.indices], head.kind, head.unit) + 0.0
            column_cells: list[Cell] = []
            for row, number in enumerate(in_unit.tolist()):
                column_cells.append(number if math.isfinite(number) else column.text(row))
            cells_of_columns.append(column_cells)
        return zip(*cells_of_columns)

    def _columns(self, rows: Sequence[int]) -> list[KeyColumn]:
        """Return the values of the keys in these rows, counted from 0."""
        value_numbers = self.plan.value_numbers(np.array(rows))
        return list(map(KeyColumn, self.plan.inputs, self._numbers, value_numbers))

    def _texts(self, result: DesignResult) -> tuple[str, ...]:
        """Return the texts after the values: whether the limits are kept, the first that is not, and why."""
        failure = result.failure or "; ".join(filter(None, (result.other_parts, *result.unjudged)))
        if not self._study.limits:
            return (failure,)
        keeps = "yes"
        if result.broken:
            keeps = "no"
        elif result.failure or result.unjudged:
            keeps = ""
        return keeps, next(iter(result.broken), ""), failure


def _in_unit(column: Sequence[DesignValue], head: Head) -> list[DesignValue]:
    """Return values in the unit of their head; lists as tuples, None for a missing value."""
    if head.listed:
        return [_list_in_unit(values, head) for values in column]
    numbers = convert(np.array(column, dtype=float), head.kind, head.unit) + 0.0
    return [None if math.isnan(number) else number for number in numbers.tolist()]


def _list_in_unit(values: DesignValue, head: Head) -> tuple[float, ...] | None:
    if not isinstance(values, tuple):
        return None
    return tuple(convert(value, head.kind, head.unit) + 0.0 for value in values)


# processes that compute its blocks

_FOR_ONE = 5_000
"""Least rows of a process: about as many are computed while another process starts."""
_MOST_JOBS = 4
"""Most processes started by default: the computer may have other work, and each needs memory for the library."""
_AHEAD = 3
"""Blocks per worker of a cluster that are submitted ahead: little is computed that is not yet read."""
_ANSWERS_WITHIN = 10.0
"""Seconds in which a cluster must answer."""


def computed_rows(
    sweep: Sweep,
    rows: range,
    jobs: int = 1,
    dask: str | None = None,
    note: Callable[[str], None] = lambda _: None,
) -> Generator[Design, None, None]:
    """Yield rows in their order as soon as they are computed.

    jobs: processes on this computer; dask: address of a cluster; note: is called with messages for the user.
    Raises UsageError for an address that does not answer, KurbelError where a process or the cluster is lost.
    """
    if dask is not None:
        blocks = _of_cluster(sweep, rows, dask, note)
    elif jobs > 1:
        blocks = _of_processes(sweep, rows, jobs)
    else:
        blocks = map(sweep.block, sweep.blocks(rows))
    for block in blocks:
        yield from (row for row in block if row.number - 1 in rows)


def likely_jobs(rows: int) -> int:
    """Return the number of processes on this computer that is worthwhile for so many rows."""
    # a scheduler may have left this process fewer cores than the machine has
    if hasattr(os, "sched_getaffinity"):
        cores = len(os.sched_getaffinity(0))
    else:
        cores = os.cpu_count() or 1
    return max(min(cores, _MOST_JOBS, rows // _FOR_ONE), 1)


def _of_processes(sweep: Sweep, rows: range, jobs: int) -> Iterator[list[Design]]:
    """Yield blocks in order from processes that each compute every so-many-th; a full pipe makes them wait."""
    # isolated, so that none looks for modules in the working directory; a session of its own hears no interrupt
    code = f"import sys; sys.path[:] = {list(filter(None, sys.path))}; from kurbel.designs.sweep import work; work()"
    command = [sys.executable, "-I", "-c", code]
    pipe = subprocess.PIPE
    processes = [
        subprocess.Popen(
            command, stdin=pipe, stdout=pipe, stderr=subprocess.DEVNULL, start_new_session=True
        )
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
    # its ends of the pipes are closed
    except (OSError, EOFError, pickle.UnpicklingError):
        why = "--jobs 1 needs the least memory, and shows what is wrong"
        raise KurbelError(
            f"a worker process ended early, with status {process.wait()}; {why}"
        ) from None
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


_sweep_of = lru_cache(maxsize=4)(Sweep)


def _computed(spec: Spec, rows: range) -> list[Design]:
    """Return a block of a sweep, in a worker of a cluster, which makes a sweep only once."""
    return _sweep_of(spec).block(rows)


def _of_cluster(
    sweep: Sweep, rows: range, address: str, note: Callable[[str], None]
) -> Iterator[list[Design]]:
    """Yield blocks in order from the workers of a cluster, with few of them ahead."""
    blocks = sweep.blocks(rows)
    waiting: deque[Any] = deque()
    with _client(address) as client:
        while True:
            workers = len(client.nthreads())
            wanted_ahead = _AHEAD * max(workers, 1)
            for block in islice(blocks, max(wanted_ahead - len(waiting), 0)):
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
        raise UsageError("--dask needs dask.distributed: pip install distributed") from None

    async def reached() -> None:
        await (await connect(address, timeout=_ANSWERS_WITHIN)).close()

    # of a lost scheduler it writes tracebacks
    logging.disable()
    try:
        # a client that reaches nothing waits 20 s at its end, and writes a traceback
        asyncio.run(reached())
        client = Client(address, timeout=_ANSWERS_WITHIN, set_as_default=False)
    # no address, no answer in time, or a protocol that is not set up
    except (OSError, ValueError, TypeError) as error:
        first_line = str(error).partition("\n")[0]
        raise UsageError(f"--dask {address}: no scheduler responds there ({first_line})") from None
    try:
        yield client
    except Exception as error:
        raise KurbelError(f"--dask {address}: the cluster failed: {type(error).__name__}") from None
    finally:
        client.close()
