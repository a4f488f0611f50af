"""A sweep on a cluster of Dask: in order, whole, though a worker is killed. Left out where dask is not installed."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

distributed = pytest.importorskip("distributed")

WATERWORKS = str(Path(__file__).parent.parent.parent / "configs" / "waterworks.yaml")


@pytest.fixture
def cluster(tmp_path: Path) -> Iterator[tuple[str, list[subprocess.Popen[bytes]]]]:
    """A scheduler and two workers, each a process."""
    told = tmp_path / "scheduler.json"
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "cwd": tmp_path}
    dask = [sys.executable, "-m", "distributed.cli.dask_scheduler", "--port", "0", "--no-dashboard"]
    processes = [subprocess.Popen([*dask, "--scheduler-file", str(told)], **quiet)]  # type: ignore[call-overload]
    worker = [sys.executable, "-m", "distributed.cli.dask_worker", "--scheduler-file", str(told), "--no-nanny"]
    processes += [
        subprocess.Popen([*worker, "--nthreads", "1", "--no-dashboard"], **quiet)  # type: ignore[call-overload]
        for _ in range(2)
    ]
    with distributed.Client(scheduler_file=str(told), timeout=60, set_as_default=False) as client:
        client.wait_for_workers(2, timeout=60)
        address = client.scheduler.address
    yield address, processes[1:]
    for process in processes:
        process.kill()
        process.wait()


@pytest.mark.slow
def test_a_killed_worker_loses_no_row(cluster: tuple[str, list[subprocess.Popen[bytes]]], tmp_path: Path) -> None:
    address, workers = cluster
    asked = ["--vary", "rod_ratio=3:6:0.0002", "--columns", "T_max,b_max"]
    sweep = [sys.executable, "-m", "kurbel", "sweep", WATERWORKS, *asked]
    file = tmp_path / "rows.csv"
    process = subprocess.Popen([*sweep, "--dask", address, "-o", str(file)])
    while process.poll() is None and not (file.exists() and file.stat().st_size):
        time.sleep(0.02)
    os.kill(workers[0].pid, signal.SIGKILL)
    assert process.wait(300) == 0
    alone = subprocess.run([*sweep, "-f", "csv"], capture_output=True, check=True).stdout
    assert file.read_bytes() == alone
    assert alone.count(b"\n") == 15_002
