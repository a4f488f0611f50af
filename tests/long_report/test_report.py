"""`kurbel report`: one self-contained page with all that a machine has, or two machines side by side."""

import re
from dataclasses import replace
from hashlib import sha256
from html import unescape
from itertools import pairwise
from pathlib import Path

import html5lib
import numpy as np
import pytest
from pages import page_of, page_of_case

from command import run
from kurbel.machine_file import loads
from kurbel.machine_file.overrides import key_texts
from kurbel.pictures.picture_source import PictureOptions
from kurbel.pictures.pictures import pictures
from kurbel.solver.case import Case
from representative import CONFIGS, case_of, few

LARGEST = 600_000
ATTACK = "<script>alert(1)</script> \x1b[31m & \"'"


def text_in(page: str) -> str:
    return unescape(re.sub(r"<[^>]*>", "", page))


def section(page: str, id: str) -> str:
    return re.search(rf'<section id="{id}".*?</section>', page, re.DOTALL).group()  # type: ignore[union-attr]


def tiles(page: str) -> list[tuple[str, str]]:
    """The key values of the first page: what each is, and its number as it is printed."""
    facts = re.search(r'<div class="facts">(.*?)</div>', page, re.DOTALL)
    assert facts
    return [
        (unescape(name), unescape(number))
        for name, number in re.findall(
            r"<p><small>([^<]*)</small><br><b>([^<]*)</b>", facts.group(1)
        )
    ]


def number_of(text: str) -> float:
    return float(
        unescape(text).replace("−", "-").replace("\N{NARROW NO-BREAK SPACE}", "").removesuffix("°")
    )


def test_the_waterworks_machine_is_whole_and_small() -> None:
    page = page_of("waterworks")
    assert len(page.encode()) <= LARGEST
    digest = sha256(CONFIGS["waterworks"].read_bytes()).hexdigest()
    assert digest in page
    for id in ("input", "motion", "forces", "flywheel", "left-out"):
        assert f'<section id="{id}">' in page
        assert f'<a href="#{id}">' in page
    drawn = list(pictures(case_of("punch"), ("all",), PictureOptions()))
    assert page_of("punch").count("<figure>") == len(drawn)
    for words in (
        "T_max",
        "87.70",
        "Made from",
        "rod_ratio",
        "Indicated work of the driving pistons",
        "no inclination",
    ):
        assert words in page


@pytest.mark.parametrize("name", ["waterworks-two-cranks", "marine-diesel", "shaper"])
def test_the_first_page_shows_most(name: str) -> None:
    """The mechanism, eight key values as the commands print them, verdicts and warnings; input comes last."""
    page = page_of(name)
    sections = re.findall(r'<section id="([^"]*)"', page)
    assert (sections[0], sections[1], sections[-1]) == ("summary", "flywheel", "input")
    assert section(page, "summary").count("<figure>") == 1
    rest = page[page.index("</section>") :]
    facts = [number for _, number in tiles(page)]
    assert len(facts) >= 8
    assert all(
        f">{number}" in unescape(rest) or number.split(".")[0] in unescape(rest)
        for number in facts[:8]
    )


def test_the_torque_of_a_driven_machine_is_its_largest_in_size() -> None:
    """A compressor is driven: its largest torque is against the rotation, and its smallest magnitude near zero."""
    title, number = next(
        tile for tile in tiles(page_of("compressor-two-stage")) if tile[0] == "Largest torque"
    )
    torques = case_of("compressor-two-stage").flywheel.at(np.arange(0.0, 360.0, 0.05)).M
    assert number_of(number) * 1e3 == pytest.approx(
        torques[np.argmax(np.abs(torques))], rel=1e-3
    ), title


def test_the_fluctuating_volume_is_that_of_the_whole_pump() -> None:
    """Three single-acting cranks at 120 deg at L/R = 5 have 0.029388 A s, one alone 0.553084 (docs/delivery.md)."""
    number = dict(tiles(page_of("triplex-pump")))["Fluctuating volume"]
    bore, stroke, slip = 8.0, 16.0, 0.04  # cm, cm
    assert number_of(number) == pytest.approx(
        0.029388 * np.pi / 4 * bore**2 * stroke * (1 - slip), rel=1e-3
    )


FIRST = {
    "waterworks-two-cranks": ("Power at the shaft", "Mean flow"),
    "marine-diesel": ("Power at the shaft", "Highest pressure"),
    "compressor-two-stage": ("Capacity", "Discharge temperature"),
    "triplex-pump": ("Mean flow", "Fluctuating volume"),
    "shaper": ("Stroke", "Working over return time"),
    "crank-rocker": ("Angle of swing", "Transmission angle"),
    "punch": ("Mean torque", "Flywheel inertia"),
    "v8-cross-plane": ("Largest piston force", "Largest unbalanced moment"),
}


@pytest.mark.parametrize("name", FIRST)
def test_the_key_values_are_those_of_its_kind(name: str) -> None:
    """None is zero, such as the power of an engine without gas, and none has an angle with digits of rounding."""
    page = page_of(name)
    result = tiles(page)
    assert set(FIRST[name]) <= {title for title, _ in result}
    assert all(number_of(number.partition("·")[0]) for _, number in result)
    assert not re.search(r"e-\d", section(page, "summary"))


def test_what_a_machine_is_is_below_its_name() -> None:
    """As configs/marine-diesel.yaml has it: L/R = 4.4, so that the rod has 1980 mm."""
    machine = "6 cylinders, two-stroke, 110 rpm, stroke 900 mm, rod 1980 mm, bore 540 mm"
    assert machine in text_in(page_of("marine-diesel"))
    assert "Shaper 40 rpm, stroke 975 mm" in " ".join(
        text_in(page_of("shaper")).split()
    )  # a ram, and no cylinder
    named = re.findall(
        r"<(title|h\d|caption|figcaption)>(?:<b>)?Motor ship", page_of("marine-diesel")
    )
    assert named == ["title", "h1"]  # of the window, and of the page


def test_numbers_from_ten_thousand_have_thin_spaces() -> None:
    """GD² = 4 J in kg m² of J = 9000 kg m², and what the warning of the waterworks engine says of J."""
    assert "36\N{NARROW NO-BREAK SPACE}000" in section(page_of("marine-diesel"), "flywheel")
    summary = section(page_of("waterworks-two-cranks"), "summary")
    assert "18\N{NARROW NO-BREAK SPACE}066.2 kg m²" in summary
    assert not re.search(
        r"(?<![\d.])\d{5}", re.sub(r"<svg.*?</svg>", "", unescape(summary), flags=re.DOTALL)
    )


def test_firing_intervals() -> None:
    """A two-stroke of six fires every 60°, in the order that the file gives."""
    page = page_of("marine-diesel")
    rows = re.findall(
        r'<th scope="row">\D*(\d)</th><td class="r">(\d+)°</td><td class="r">(\d+)°</td>', page
    )
    assert [tuple(map(int, row)) for row in rows] == [
        (number, 60 * place, 60) for place, number in enumerate((1, 5, 3, 4, 2, 6))
    ]


def test_equal_cylinders_and_bearings_are_there_once() -> None:
    """Both banks of the V8 have equal pistons; six equal cylinders have one picture of each kind."""
    page = page_of("marine-diesel")
    assert (
        page.count("Indicator diagram: cylinders 1–6.") == 2
    )  # its heading, and for readers of screens
    assert "Indicator diagram: cylinder 2" not in page
    forces = section(page_of("v8-cross-plane"), "forces")
    assert "left 1–4, right 1–4" in text_in(forces)
    assert forces.count("<caption>Key values</caption>") == forces.count("<caption>") == 1


def test_load_cases_and_limits_are_on_the_first_page() -> None:
    """Of each limit and cylinder what is nearest to its bound in any case; half the capacity with one end unloaded."""
    page = page_of("compressor-two-stage", cases=True)
    assert all("one end unloaded" in section(page, id) for id in ("forces", "delivery"))
    summary = text_in(section(page, "summary"))
    rows = re.findall(r"([\d.]+)\s?(?:°|%)\s*≥ (15°|3 %)\s*PASS", summary)
    assert len(rows) == 4
    assert summary.count("PASS") == 4
    both, one = (
        number_of(re.search(rf"{name}\s*([\d.]+)", summary).group(1))
        for name in ("both ends", "unloaded")
    )
    assert one == pytest.approx(both / 2, rel=0.02)


def sections_of(page: str) -> list[str]:
    return re.findall(r'<section id="([^"]*)"', page)[1:]


def test_sections_are_those_named() -> None:
    case = case_of("punch")
    assert sections_of(page_of("punch"))[-3:] == ["tables", "left-out", "input"]
    short = page_of_case(case, sections=("answers", "input"))
    assert sections_of(short) == ["flywheel", "harmonics", "input"]
    assert short.count("<figure>") == section(short, "summary").count("<figure>")
    pictures_alone = page_of_case(case, sections=("pictures",))
    assert "<table>" not in section(pictures_alone, "flywheel")
    assert "<figure>" in section(pictures_alone, "flywheel")
    # of a command pictures and answers, also next to the answers of all
    named = page_of_case(case, sections=("answers", "flywheel"))
    assert "<figure>" in section(named, "flywheel")
    assert "<figure>" not in section(named, "harmonics")


def test_tables_over_the_angle_are_printed_where_they_are_named() -> None:
    """On the page a box decides; what follows it is hidden in print as long as it is not ticked."""
    unticked, ticked = '<input type="checkbox" id="print-tables">', ' id="print-tables" checked>'
    assert unticked in section(page_of("punch"), "tables")
    assert "#print-tables:not(:checked)~*" in page_of("punch")
    for words in (("flywheel", "tables"), ("all",)):
        page = page_of_case(case_of("punch"), sections=words)
        assert ticked in section(page, "tables")
    assert "Over the crank angle" not in page_of_case(case_of("punch"), sections=("flywheel",))


def test_sections_that_a_machine_does_not_have_are_refused() -> None:
    machine = str(CONFIGS["punch"])
    unknown = run("report", machine, "--sections", "bearing", "-o", "-")
    assert unknown.exit_code == 2
    assert "there is no section 'bearing'; did you mean 'bearings'?" in unknown.stderr
    missing = run("report", machine, "--sections", "torsion", "-o", "-")
    assert missing.exit_code == 2
    assert "--sections torsion: Punch with flywheel: no 'shaft' is given" in missing.stderr
    both = run("report", machine, "--short", "--sections", "input", "-o", "-")
    assert "--short is --sections answers,input; give one of them" in both.stderr


def test_the_sheet_is_that_of_the_paper() -> None:
    short = ("report", str(CONFIGS["punch"]), "--short", "-o", "-")
    assert "@page{size:a4}" in run(*short).stdout
    assert "@page{size:letter}" in run(*short, "--paper", "letter").stdout


def test_a_title_of_the_users() -> None:
    page = run("report", str(CONFIGS["shaper"]), "--title", "Offer 7 <a>").stdout
    assert "<h1>Offer 7 &lt;a&gt;</h1>" in page


def test_the_energy_balance_closes_on_the_page() -> None:
    """What goes in less what friction takes reaches the shaft, in the printed figures."""
    rows = re.search(r'id="energy".*?<tbody>(.*?)</tbody>', page_of("waterworks"), re.DOTALL)
    assert rows
    figures = [
        number_of(match) for match in re.findall(r'<td class="r">(−?[0-9.]+)</td>', rows.group(1))
    ]
    *terms, shaft = figures
    assert sum(terms) == pytest.approx(shaft, rel=1e-3)
    assert "below 1e-14" in rows.group(1) or re.search(r"e-1[0-9]", rows.group(1))


PAGES = [
    ("gas-engine",),
    ("waterworks",),
    ("waterworks", "compressor"),
    ("shaper", "scotch-yoke-pump"),
]


@pytest.mark.parametrize(
    "names", few([(page,) for page in PAGES], [(PAGES[1],), (PAGES[3],)], map("-".join, PAGES))
)
def test_nothing_comes_from_elsewhere_and_nothing_runs(names: tuple[str, ...]) -> None:
    page = page_of(*names)
    assert "default-src 'none'" in page
    assert not re.findall(
        r"<script|<link|<img|<iframe|\bsrc=|url\(|@import|\son\w+=|javascript:", page
    )
    assert set(re.findall(r'href="([^"]*)"', page)) <= {
        f"#{id}" for id in re.findall(r'id="([^"]*)"', page)
    }


@pytest.mark.parametrize("name", few(["gas-engine", "waterworks"], ["waterworks"]))
def test_it_can_be_read_by_those_who_do_not_see(name: str) -> None:
    tree = html5lib.parse(page_of(name), namespaceHTMLElements=False)
    assert tree.get("lang") == "en"
    for svg in tree.iter("{http://www.w3.org/2000/svg}svg"):
        title = svg.find("{http://www.w3.org/2000/svg}title")
        assert svg.get("role") == "img"
        assert len(title.text or "") > 40
    for table in tree.iter("table"):
        heads = list(table.find("thead").iter("th"))
        assert heads
        assert all(head.get("scope") == "col" for head in heads)
    levels = [int(one.tag[1]) for one in tree.iter() if str(one.tag) in ("h1", "h2", "h3", "h4")]
    assert levels[0] == 1
    assert all(after <= before + 1 for before, after in pairwise(levels))
    ids = re.findall(r'\sid="([^"]*)"', page_of(name))
    assert len(ids) == len(set(ids))


def test_names_are_text_and_nothing_else() -> None:
    page = page_of_case(Case(replace(loads("{stroke: 800 mm, rod_ratio: 5}"), name=ATTACK)))
    assert "<script" not in page
    assert "&lt;script&gt;" in page
    assert "\x1b" not in page
    html5lib.HTMLParser(strict=True).parse(page)


def test_limits_and_expectations_have_a_verdict() -> None:
    text = "{speed: 50 rpm, stroke: 800 mm, rod_ratio: 5, limits: {c_max: 2 m/s, b_max: 20 m/s2}, "
    page = page_of_case(Case(loads(text + 'expect: {stroke: "800 mm ± 1 %"}}')))
    said = text_in(page)
    # R Zusammenstellung 112, of which c_max is 2.136 m/s
    assert re.search(
        r"2\.1359 m/s\s*≤ 2 m/s\s*FAIL\s*Largest velocity on the outstroke\s*cylinder 1", said
    )
    assert "PASS" in said
    assert "800 mm ± 1 %" in said
    assert page.count('<tr class="bad">') == 1
    assert page.count('<tr class="good">') == 2


def test_what_is_missing_is_reported_with_the_reason() -> None:
    page = text_in(page_of_case(Case(loads("{stroke: 800 mm, rod_ratio: 5}"))))
    assert "no force acts, so there is no torque" in page
    assert "no speed given" in page
    locked = "{speed: 50 rpm, stroke: 800 mm, rod_ratio: 2, masses: {piston: 100 kg}, friction: {crosshead: 5}}"
    said = text_in(page_of_case(Case(loads(locked))))
    assert "No solution:" in said
    assert "locks itself" in said
    assert "Largest velocity on the outstroke" in said  # what can be computed still is


def test_the_input_is_reported_as_it_was_read() -> None:
    machine = loads(
        "{stroke: 800 mm, rod_ratio: 5, bore: 1 in}",
        overrides=("bore=450 mm", "masses.piston=1 kg"),
    )
    assert machine.origin
    assert dict(key_texts(machine.origin)) == {
        "stroke": "800 mm",
        "rod_ratio": "5",
        "bore": "450 mm",
        "masses.piston": "1 kg",
    }
    page = page_of_case(Case(machine))
    assert "set over it: bore=450 mm" in text_in(page)
    assert "Diameter of the cylinder" in page


def test_differences_are_in_percent(tmp_path: Path) -> None:
    one, other, out = tmp_path / "a.yaml", tmp_path / "b.yaml", tmp_path / "r.html"
    one.write_text("{name: A, speed: 50 rpm, stroke: 800 mm, rod_ratio: 5}")
    other.write_text("{name: B, speed: 50 rpm, stroke: 900 mm, rod_ratio: 5}")
    assert run("report", str(one), str(other), "-o", str(out)).exit_code == 0
    said = text_in(out.read_text(encoding="utf-8"))
    assert "+12.50 %" in said  # 900/800
    assert re.search(r"stroke\s*800 mm\s*900 mm", said)
    rows = re.findall(
        r'<th scope="row">c<sub>m</sub></th>(.*?)</tr>', out.read_text(encoding="utf-8")
    )
    assert "+12.50 %" in rows[0]
    one.write_text("{name: A, stroke: 800 mm, rod_ratio: 5}")
    same = run("report", str(one), str(one))
    assert "Nothing: both files give the same." in same.stdout
    assert "A (A)" in same.stdout
    other.write_text("{name: A, stroke: 900 mm, rod_ratio: 5}")
    page = run("report", str(one), str(other)).stdout
    assert f"A (A) is that of {one}; A (B) is that of {other}." in text_in(page)
    # the heading, and what a reader of screens says
    assert (
        text_in(page).count("A (A). Displacement")
        == text_in(page).count("A (B). Displacement")
        == 2
    )
