"""A sweep on a cluster of Dask, of which parts are killed or missing. Left out where dask is not installed."""

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from command import limited
from representative import CONFIGS
from swept_rows import until_written

distributed = pytest.importorskip("distributed")

WATERWORKS = str(CONFIGS["waterworks"])


class Cluster:
    """A scheduler and its workers, each a process."""

    def __init__(self, folder: Path) -> None:
        self._file = folder / "scheduler.json"
        self.processes: list[subprocess.Popen[bytes]] = []
        self._start("dask_scheduler", "--port", "0")
        with self._client() as client:
            self.address: str = client.scheduler.address

    def add_workers(self, count: int) -> None:
        for _ in range(count):
            self._start("dask_worker", "--no-nanny", "--nthreads", "1")
        with self._client() as client:
            client.wait_for_workers(count, timeout=60)

    def _start(self, module: str, *options: str) -> None:
        command = [sys.executable, "-m", f"distributed.cli.{module}", "--no-dashboard", *options]
        command += ["--scheduler-file", str(self._file)]
        quiet = subprocess.DEVNULL
        self.processes.append(
            subprocess.Popen(command, stdout=quiet, stderr=quiet, cwd=self._file.parent)
        )

    def _client(self) -> Any:
        return distributed.Client(scheduler_file=str(self._file), timeout=60, set_as_default=False)


@pytest.fixture
def cluster(tmp_path: Path) -> Iterator[Cluster]:
    made = Cluster(tmp_path)
    yield made
    for process in made.processes:
        process.kill()
        process.wait()


SWEEP = [sys.executable, "-m", "kurbel", "sweep", WATERWORKS, "--columns", "T_max,b_max", "--vary"]


@pytest.mark.slow
def test_a_cluster_of_which_parts_are_missing_or_killed(cluster: Cluster, tmp_path: Path) -> None:
    """One cluster for all, since its start costs more than the sweeps."""
    without_workers_it_is_waited_for(cluster)
    cluster.add_workers(2)
    a_killed_worker_loses_no_row(cluster, tmp_path / "rows.csv")
    cluster.add_workers(2)
    a_killed_scheduler_is_named_and_resume_goes_on(cluster, tmp_path / "rows.csv")


def without_workers_it_is_waited_for(cluster: Cluster) -> None:
    words = [*SWEEP, "rod_ratio=4,5", "-f", "csv", "--dask", cluster.address]
    process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    limited(process, 300)
    assert process.stderr
    assert (
        process.stderr.readline()
        == f"--dask {cluster.address}: the cluster has no workers; waiting for one\n"
    )
    cluster.add_workers(1)
    stdout, stderr = process.communicate(timeout=300)
    assert (process.returncode, stderr, stdout.count("\n")) == (0, "", 3)


def in_the_midst(cluster: Cluster, file: Path) -> subprocess.Popen[str]:
    """Return a sweep of 6,001 rows that has written some."""
    words = [*SWEEP, "rod_ratio=3:6:0.0005", "--dask", cluster.address, "-o", str(file)]
    process = subprocess.Popen(words, stderr=subprocess.PIPE, text=True)
    until_written(process, file.with_name("rows.csv.part"), 1000)
    return process


def a_killed_worker_loses_no_row(cluster: Cluster, file: Path) -> None:
    process = in_the_midst(cluster, file)
    os.kill(cluster.processes[1].pid, signal.SIGKILL)
    assert (process.communicate(timeout=300)[1], process.returncode) == ("", 0)
    alone = subprocess.run(
        [*SWEEP, "rod_ratio=3:6:0.0005", "-f", "csv"], capture_output=True, check=True
    ).stdout
    assert file.read_bytes() == alone
    assert alone.count(b"\n") == 6_002


def a_killed_scheduler_is_named_and_resume_goes_on(cluster: Cluster, file: Path) -> None:
    """It was a fault in kurbel, after a traceback of Dask."""
    part = file.with_name("rows.csv.part")
    file.write_text("old")
    process = in_the_midst(cluster, file)
    os.kill(cluster.processes[0].pid, signal.SIGKILL)
    stderr = process.communicate(timeout=300)[1]
    rows = part.read_bytes().count(b"\n") - 1
    assert stderr.startswith(
        f"{part} holds {rows} rows; run again with --resume to continue\n"
        f"Error: --dask {cluster.address}: the cluster failed: "
    )
    assert stderr.count("\n") == 2
    assert (process.returncode, file.read_text()) == (2, "old")
