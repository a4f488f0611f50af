"""Where the rows of a sweep go: whole lines, the first ones at once, so that an interrupted run keeps its own."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from itertools import islice
from typing import Any

from kurbel.errors import UsageError
from kurbel.render import Look
from kurbel.render.output import silence, stdout_look
from kurbel.render.sweep_rows import WRITERS, Titles, csv_rows

_AT_LEAST_EVERY = 0.5
"""Seconds after which lines that are ready are written."""
_IN_A_GROUP = 10_000
"""Rows of a group of a Parquet file."""


class SweepOutput:
    """The output of a sweep; rows: those that are still to be computed, fewer where a file has the first ones already.

    resume: go on at the end of the file. Raises UsageError for a file of another sweep.
    """

    def __init__(self, titles: Titles, look: Look, file_name: str | None, rows: range, resume: bool = False) -> None:
        self.titles = titles
        self._file_name = None if file_name == "-" else file_name
        self._look = look if self._file_name else look._replace(encoding=stdout_look().encoding)
        self._resumed = 0
        self.rows = rows
        if resume:
            assert self._file_name is not None
            self._resumed, last = _written(self._file_name, titles, self._look)
            self.rows = rows[max(last - rows.start, 0) :]

    def write(self, rows: Iterable[Any]) -> None:
        """Write the rows; a reader that leaves early is no fault. Raises UsageError."""
        if self._look.format == "parquet":
            self._write_parquet(rows)
            return
        with self._opened() as file:
            _flow(self._texts(rows), file, self._look.encoding)

    def _texts(self, rows: Iterable[Any]) -> Iterator[str]:
        if self._look.format == "csv":
            headed = not self._resumed and self.rows.start == 0
            return csv_rows(self.titles, rows, self._look, headed)
        return WRITERS[self._look.format](self.titles, rows, self._look)

    @contextmanager
    def _opened(self) -> Iterator[Any]:
        try:
            if self._file_name is None:
                sys.stdout.flush()
                yield getattr(sys.stdout, "buffer", sys.stdout)
                return
            mode = "r+b" if self._resumed else "wb"
            with open(self._file_name, mode) as file:
                file.seek(self._resumed)
                file.truncate()
                yield file
        except BrokenPipeError:
            silence(sys.stdout)
        except OSError as error:
            where = self._file_name or "to standard output"
            raise UsageError(f"cannot write {where}: {error.strerror or error}") from None

    def _write_parquet(self, rows: Iterable[Any]) -> None:
        try:
            import pyarrow  # type: ignore[import-not-found, unused-ignore]
            from pyarrow import parquet
        except ImportError:
            raise UsageError("Parquet needs pyarrow: pip install 'kurbel[parquet]'") from None
        names = self.titles.whole
        following = iter(rows)
        writer = None
        try:
            while group := list(islice(following, _IN_A_GROUP)):
                columns = zip(*(self.titles.values(row) for row in group))
                table = pyarrow.table(dict(zip(names, map(_column, columns))), schema=writer and writer.schema)
                writer = writer or parquet.ParquetWriter(self._file_name, table.schema)
                writer.write_table(table)
        except OSError as error:
            raise UsageError(f"cannot write {self._file_name}: {error.strerror or error}") from None
        finally:
            if writer:
                writer.close()


def _column(values: tuple[Any, ...]) -> list[Any]:
    """Return values of one type: texts, numbers, or lists of them."""
    texts = any(isinstance(one, str) for one in values)
    return [one if one is None or not texts else str(one) for one in map(_listed, values)]


def _listed(value: Any) -> Any:
    return list(value) if isinstance(value, tuple) else value


def _flow(texts: Iterable[str], file: Any, encoding: str) -> None:
    """Write whole lines, those that are ready whenever some time has passed, and at an interrupt too."""
    ready: list[bytes] = []
    written = 0.0
    try:
        for text in texts:
            ready.append(text.encode(encoding, "replace"))
            if time.monotonic() - written >= _AT_LEAST_EVERY:
                _put(ready, file)
                written = time.monotonic()
    finally:
        _put(ready, file)


def _put(ready: list[bytes], file: Any) -> None:
    lines = b"".join(ready)
    ready.clear()
    file.write(lines)
    file.flush()


def _written(file_name: str, titles: Titles, look: Look) -> tuple[int, int]:
    """Return how many bytes of whole lines a file has, and the number of the last row in it."""
    try:
        with open(file_name, "rb") as file:
            content = file.read()
    except FileNotFoundError:
        return 0, 0
    except OSError as error:
        raise UsageError(f"cannot read {file_name}: {error.strerror}") from None
    whole = content[: content.rfind(b"\n") + 1]
    lines = whole.decode("utf-8", "replace").splitlines()
    if not lines:
        return 0, 0
    head = next(csv_rows(titles, (), look)).rstrip("\n") if look.format == "csv" else ""
    ours = lines[0] == head or _number_of(lines[0], look)  # a later shard has no head
    last = 0 if len(lines) == 1 and lines[0] == head else _number_of(lines[-1], look)
    if not ours or last is None:
        raise UsageError(f"--resume: {file_name} is not of this sweep; it begins with {lines[0][:60]!r}")
    return len(whole), last


def _number_of(line: str, look: Look) -> int | None:
    try:
        if look.format == "json":
            return int(json.loads(line)["row"])
        return int(line.partition(";" if look.comma else ",")[0])
    except (ValueError, KeyError, TypeError):
        return None
