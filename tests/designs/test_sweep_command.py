"""`kurbel sweep` from the command line: rows, order, choice, parts, and what goes wrong."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import kurbel
from kurbel.designs import sweep as sweeps
from swept_rows import CONFIGS, WATERWORKS, rows, run, until_written


def test_rows_are_what_forces_reports_of_each() -> None:
    result = rows(
        "--vary",
        "rod_ratio=4,5",
        "--vary",
        "speed=40,50 rpm",
        "--columns",
        "T_max,p_i,φ_P=0",
        "--angles",
    )
    assert [(one["rod_ratio"], one["row"]) for one in result] == [
        (4.0, 1),
        (4.0, 2),
        (5.0, 3),
        (5.0, 4),
    ]
    for one, (ratio, speed) in zip(result, [(4, 40), (4, 50), (5, 40), (5, 50)]):
        machine = kurbel.load(WATERWORKS, [f"rod_ratio={ratio}", f"speed={speed} rpm"])
        single = kurbel.solve(machine).cylinders[0]
        assert one["speed_rps"] == speed / 60
        assert one["T_max_N"] == pytest.approx(single["T_max"].value, rel=1e-13)
        assert one["T_max_at_deg"] == pytest.approx(single["T_max"].degrees, rel=1e-11)
        assert one["mean_pressure_Pa"] == pytest.approx(single["p_i"].value, rel=1e-13)
        assert one["phi_reversal_deg"] == pytest.approx(
            list(single["phi_reversal"].value), rel=1e-12
        )
        assert one["failure"] is None


def test_keys_that_go_together_in_a_grid() -> None:
    """Bore and rod of one size beside each other, each with every speed."""
    result = rows(
        "--vary",
        "bore=400,450 mm; head_end_rod=70,80 mm",
        "--vary",
        "speed=40,50 rpm",
        "--columns",
        "A_head,c_max",
    )
    assert [(one["bore_m"], one["head_end_rod_m"]) for one in result] == [(0.4, 0.07)] * 2 + [
        (0.45, 0.08)
    ] * 2
    for one in result:
        area = np.pi / 4 * (one["bore_m"] ** 2 - one["head_end_rod_m"] ** 2)
        assert one["A_head_m^2"] == pytest.approx(area, rel=1e-14)
    assert result[1]["c_max_m/s"] == pytest.approx(result[0]["c_max_m/s"] * 5 / 4, rel=1e-14)


def test_without_a_cylinder_rows_are_what_flywheel_reports(tmp_path: Path) -> None:
    """T = 9 + 5 cos 2φ N m: ΔE = 5 N m, W = 18π J; a machine without key values of `forces` was a fault of kurbel."""
    machine = tmp_path / "effort.yaml"
    machine.write_text(
        "{speed: 1 1/s, effort: {unit: N m, mean: 9, harmonics: [[2, 5, 0]]}}", encoding="utf-8"
    )
    for one, speed in zip(rows("--vary", "speed=1,2 1/s", file=str(machine)), (1, 2), strict=True):
        assert one["dE_J"] == pytest.approx(5, rel=1e-13)
        assert one["work_shaft_J"] == pytest.approx(18 * np.pi, rel=1e-13)
        assert one["power_shaft_W"] == pytest.approx(18 * np.pi * speed, rel=1e-13)


def test_cylinders_that_work_alike_have_one_column_in_a_table(tmp_path: Path) -> None:
    """Equal ones once for people, each in csv; where a key of one of them varies they are no longer alike."""
    generator = str(CONFIGS["four-cylinder-generator"])
    sweep = ("--vary", "speed=200,300 rpm", "--columns", "T_max,dE")
    assert run(*sweep, file=generator).stdout.split()[:4] == [
        "row",
        "speed",
        "cylinders",
        "1–4.T_max",
    ]
    heads = run(*sweep, "-f", "csv", file=generator).stdout.splitlines()[0].split(",")
    assert heads[2:6] == [f"cylinder {n}.T_max_N" for n in (1, 2, 3, 4)]
    two, each = tmp_path / "two.yaml", "crank: 50 mm, rod_ratio: 4"
    two.write_text(
        f"{{speed: 60 rpm, cylinders: [{{name: A, {each}}}, {{name: B, {each}}}]}}",
        encoding="utf-8",
    )
    table = run("--vary", "speed=60,90 rpm", "--columns", "c_max", file=str(two)).stdout
    assert table.split()[:5] == ["row", "speed", "A,", "B.c_max", "failure"]
    table = run("--vary", "cylinders.1.crank=50,60 mm", "--columns", "c_max", file=str(two)).stdout
    assert table.split()[:5] == ["row", "cylinders.1.crank", "A.c_max", "B.c_max", "failure"]


def test_a_row_that_fails_stays_with_its_reason() -> None:
    result = rows("--vary", "rod_ratio=0.5,2", "--columns", "T_max")
    assert result[0]["T_max_N"] is None
    assert result[0]["failure"] == "rod_ratio: 0.5 is too small; it must be more than 1"
    assert result[1]["failure"] is None


def test_key_values_of_other_commands_and_limits() -> None:
    file = str(CONFIGS["waterworks-two-cranks"])
    result = rows("--vary", "flywheel.fluctuation=1/80,1/100", "--columns", "dE,J,c_max", file=file)
    for one, fluctuation in zip(result, ("1/80", "1/100")):
        turning = kurbel.solve(kurbel.load(file, [f"flywheel.fluctuation={fluctuation}"])).flywheel
        assert (one["dE_J"], one["J_kgm^2"]) == (turning.dE, turning.J)
    limits = ("--set", "limits.c_max=2.3 m/s", "--set", "limits.b_max=15 m/s2")
    kept = rows(
        "--vary", "rod_ratio=3,5", "--vary", "speed=50,60 rpm", "--columns", "c_max", *limits
    )
    assert [one["keeps"] for one in kept] == [True, False, True, False]
    assert [one["broken"] for one in kept] == [None, "c_max", None, "c_max"]


def test_where_sort_top_and_pareto() -> None:
    words = ("--vary", "rod_ratio=3:6:0.5", "--columns", "c_max,b_max")
    every = {row["row"]: row for row in rows(*words)}
    below = rows(*words, "--where", "b_max < 13.5 m/s2")
    assert [one["row"] for one in below] == [
        row for row, one in every.items() if one["b_max_m/s^2"] < 13.5
    ]
    assert [row["row"] for row in rows(*words, "--where", "rod_ratio >= 5")] == [5, 6, 7]
    assert [row["row"] for row in rows(*words, "--sort", "c_max", "--top", "2")] == [7, 6]
    assert [row["row"] for row in rows(*words, "--sort", "-c_max", "--top", "1")] == [1]
    # a longer rod betters both
    assert [row["row"] for row in rows(*words, "--pareto", "c_max,b_max")] == [7]
    # more of c_max against less of b_max: nothing betters anything
    assert [row["row"] for row in rows(*words, "--pareto", "-c_max,b_max")] == [1, 2, 3, 4, 5, 6, 7]


def test_a_key_value_is_requested_of_one_cylinder_as_it_is_called_in_the_head() -> None:
    compressor = str(CONFIGS["compressor-two-stage"])
    column, vary = "low pressure.rod_tension_max", ("--vary", "speed=300,500 rpm")
    both = rows(*vary, "--columns", "rod_tension_max", file=compressor)
    alone = rows(
        *vary, "--columns", column, "--sort", column, "--where", f"{column} > 1 N", file=compressor
    )
    reported = [[row.get(f"{column}_N") for row in result] for result in (alone, both)]
    assert reported[0] == sorted(reported[1])
    assert not any("high pressure" in head for row in alone for head in row)


def test_a_summary_reports_quantiles_and_ranks() -> None:
    words = ("--vary", "rod_ratio=uniform(3, 6)", "--sample", "60", "--columns", "b_max,work")
    whole = rows(*words)
    reported = {row["column"]: row for row in rows(*words, "--summary")}
    values = np.array([one["b_max_m/s^2"] for one in whole])
    assert reported["b_max"]["q50"] == pytest.approx(np.median(values), rel=1e-13)
    assert (reported["b_max"]["q0"], reported["b_max"]["q100"]) == (values.min(), values.max())
    assert reported["b_max"]["r(rod_ratio)"] == pytest.approx(-1)  # b_max = R ω² (1 + λ)
    assert reported["rod_ratio"]["rows"] == 60


def test_parts_one_after_another_are_the_whole_byte_for_byte() -> None:
    """Each row in the company that it has in the whole: numpy 1.24 rounds otherwise in arrays of another length."""
    words = ("--vary", "rod_ratio=3:6:0.2", "--columns", "T_max", "-f", "csv")
    whole = run(*words).stdout
    assert "".join(run(*words, "--shard", f"{k}/4").stdout for k in (1, 2, 3, 4)) == whole
    assert len(whole.splitlines()) == 17


def test_resuming_ends_in_the_same_file(tmp_path: Path) -> None:
    words = ("--vary", "rod_ratio=3:6:0.3", "--columns", "c_max")
    for suffix in ("csv", "json"):
        file = tmp_path / f"rows.{suffix}"
        assert run(*words, "-o", str(file)).exit_code == 0
        whole = file.read_bytes()
        for cut in (0, 200, len(whole) - 1):
            file.write_bytes(whole[:cut])
            assert run(*words, "-o", str(file), "--resume").exit_code == 0
            assert file.read_bytes() == whole
    file.write_text("something else\nquite\n")
    refused = run(*words, "-o", str(file), "--resume")
    assert "is not of this sweep" in refused.output
    assert refused.exit_code == 2


def part(file: Path) -> Path:
    """Return the file that holds the rows until all are there."""
    return file.with_name(file.name + ".part")


def in_the_midst(file: Path, jobs: str) -> subprocess.Popen[str]:
    """Return a sweep that has written its first rows."""
    words = ["--vary", "rod_ratio=3:6:0.00002", "--columns", "T_max", "-o", str(file)]
    # what runs in the background overlooks interrupts, and so do those that it starts
    process = subprocess.Popen(
        [sys.executable, "-m", "kurbel", "sweep", WATERWORKS, *words, "--jobs", jobs],
        start_new_session=True,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    until_written(process, part(file), 100)
    return process


@pytest.mark.slow
@pytest.mark.parametrize("jobs", ["1", "2"])
def test_an_interrupt_leaves_whole_rows_and_the_old_file(jobs: str, tmp_path: Path) -> None:
    file = tmp_path / "rows.csv"
    file.write_text("old")
    process = in_the_midst(file, jobs)
    os.killpg(process.pid, signal.SIGINT)  # as a terminal does
    stderr = process.communicate(timeout=60)[1]
    lines = part(file).read_text().splitlines(keepends=True)
    assert (
        stderr.rstrip()
        == f"{part(file)} holds {len(lines) - 1} rows; run again with --resume to continue"
    )
    assert (process.returncode, file.read_text()) == (130, "old")
    assert all(line.count(",") == 3 and line.endswith("\n") for line in lines)


@pytest.mark.slow
@pytest.mark.parametrize("end", [signal.SIGTERM, signal.SIGKILL])
def test_who_is_killed_leaves_no_process_and_the_old_file(end: int, tmp_path: Path) -> None:
    file = tmp_path / "rows.csv"
    file.write_text("old")
    process = in_the_midst(file, "2")
    os.kill(process.pid, end)
    stderr = process.communicate(timeout=60)[
        1
    ]  # comes to the end of what each of them may write to when none is left
    assert stderr == ""
    assert file.read_text() == "old"
    assert part(file).read_text().startswith("row,rod_ratio,T_max_N,failure\n1,3.0,")


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:1", "tls://127.0.0.1:1", "http://x"])
def test_an_address_that_does_not_answer(address: str, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("distributed")
    monkeypatch.setattr(sweeps, "_ANSWERS_WITHIN", 0.5)
    result = run("--vary", "rod_ratio=3,4", "--dask", address)
    assert "no scheduler responds there" in result.output
    assert result.exit_code == 2


def test_every_format_has_every_row(tmp_path: Path) -> None:
    words = ("--vary", "rod_ratio=0.5,5", "--columns", "T_max,phi_reversal")
    assert run(*words, "-f", "csv", "--decimal", "comma").stdout.splitlines()[0] == (
        "row;rod_ratio;T_max_N;phi_reversal_deg;failure"
    )
    assert run(*words, "-f", "markdown").stdout.count("\n") == 4
    text = run(*words).stdout.splitlines()
    assert text[-2].split() == ["2", "5.000", "87.70", "130.5", "316.1"]
    assert "too small" in text[-3]


@pytest.mark.parametrize(
    ("inputs", "message"),
    [
        ({"rod_ratio": [1, 2], "speed": [3, 4, 5]}, "rod_ratio has 2, speed has 3"),
        ({"rod_ratio": []}, "one or more of them; rod_ratio has 0"),
        ({"rod": [1.0]}, "no value for this key"),
        ({}, "there is none"),
    ],
)
def test_python_gets_what_is_wrong(inputs: dict[str, list[float]], message: str) -> None:
    with pytest.raises(kurbel.KurbelError, match=message):
        kurbel.sweep(kurbel.load(WATERWORKS), inputs, ["T_max"])
    machine = kurbel.Machine((kurbel.Cylinder(kurbel.SliderCrank(0.1, 0.5)),))
    with pytest.raises(kurbel.KurbelError, match=r"kurbel\.load"):
        kurbel.sweep(machine, {"crank": [1.0]})
