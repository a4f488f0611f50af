"""Style sheets of pages and pictures: light, dark, and print."""

import re

COLOURS = {
    "ink": ("#1a1a1a", "#e8e8e8"),
    "paper": ("#ffffff", "#15181b"),
    "faint": ("#555555", "#adadad"),
    "rule": ("#c4c4c4", "#41474d"),
    "shade": ("#f3f4f5", "#1f2428"),
    "good": ("#1d6b34", "#7fd49a"),
    "bad": ("#a31515", "#ff9d94"),
    "link": ("#0b5394", "#8cc4f5"),
    "warn": ("#d9a514", "#b98a10"),
    "warned": ("#fdf3d8", "#33291a"),
    # of pictures; lines after Okabe and Ito, whom the colour-blind can tell apart, darkened or lightened
    "grid": ("#dcdcdc", "#33383d"),
    "gain": ("#cfe0f1", "#27425c"),
    "loss": ("#f6ddcc", "#583d28"),
    "line0": ("#0b5394", "#7cc0f5"),
    "line1": ("#b04a0c", "#f0a35e"),
    "line2": ("#0b0b0b", "#f2f2f2"),
    "line3": ("#00694f", "#3fd1a0"),
    "line4": ("#8f2f74", "#eaa0cf"),
    "line5": ("#6b5900", "#e6d354"),
    # of parts of machines
    "edge": ("#2c3843", "#aeb8c1"),
    "wall": ("#55626e", "#93a0ab"),
    "web": ("#8593a0", "#5d6b7a"),
    "metal": ("#c9d2da", "#5a6772"),
    "rod": ("#e4e9ed", "#74818c"),
    "hollow": ("#f6f8f9", "#20262c"),
    "gas": ("#e0603a", "#e8693f"),
    "liquid": ("#3f86bd", "#4d9ad3"),
}
"""Each in light and in dark; texts and lines have a contrast of 4.5 to their ground."""

PAGE = """\
body{margin:0;background:var(--paper);color:var(--ink);font:15px/1.45 system-ui,"DejaVu Sans",sans-serif}
main{max-width:60rem;margin:0 auto;padding:1rem;overflow-wrap:anywhere}
h1{font-size:1.5rem}h2{font-size:1.25rem;border-bottom:1px solid var(--rule)}h3{font-size:1.05rem}
h4{font-size:1rem;margin-bottom:.3rem}a{color:var(--link)}
.wide{overflow-x:auto;margin:.6rem 0}.wide:focus-visible{outline:2px solid var(--link)}
table{border-collapse:collapse;font-variant-numeric:tabular-nums}
caption{text-align:left;font-weight:600;padding:.3rem 0}
th,td{padding:.12rem .5rem;text-align:left;vertical-align:top;overflow-wrap:normal}
td.r,th.r{text-align:right}td.r,td.r+td:nth-child(3),tbody th.r,thead small,.n{white-space:nowrap}
thead th{border-bottom:1px solid var(--ink);vertical-align:bottom}
tbody tr>*{border-bottom:1px solid var(--rule)}tbody th{font-weight:400}td.l{max-width:14rem}
@media screen and (max-width:40rem){.wide td:not(.r):last-child{min-width:12rem}}
small{color:var(--faint)}.good{color:var(--good)}.bad{color:var(--bad);font-weight:600}
@page{margin:12mm 14mm}
@media print{body{font-size:9pt}main{max-width:none;padding:0}.wide{overflow:visible;margin:.3rem 0}
p{margin:.4rem 0}table{font-size:7.2pt;line-height:1.2}th,td{padding:.04rem .3rem}
.wide,h2,h3,h4,p,ul,figure,section{clear:both}
.narrow{break-inside:avoid;float:left;clear:none;min-width:5cm;margin-right:.7cm}.narrow th,.narrow td{padding:.04rem .2rem}
.narrow table{min-width:100%;font-size:7pt}
tr,h2,h3,h4,caption,figcaption,svg{break-inside:avoid}h2,h3,h4,caption,figcaption{break-after:avoid}
thead,tbody tr:first-child{break-after:avoid}thead{display:table-header-group}}
"""
LONG_REPORT = """\
main{max-width:61rem;padding:1.5rem 1rem}
h1{font-size:1.9rem;line-height:1.2;margin:0 0 .2rem}
h2{border-bottom:2px solid var(--ink);margin:2.6rem 0 .8rem}
h3{font-weight:600;margin:1.6rem 0 .3rem}
section>p{max-width:46rem}#summary>p{max-width:none}
.sub,figcaption{color:var(--faint);margin:.1rem 0}
figcaption b{color:var(--ink)}
#summary{border:1px solid var(--rule);border-radius:.4rem;padding:.6rem 1.1rem 1rem;margin:1rem 0}
.facts{display:grid;grid-template-columns:repeat(4,1fr);gap:.6rem;margin:1rem 0}
.facts p{background:var(--shade);border-radius:.3rem;margin:0;padding:.5rem .7rem}
.facts b{font-size:1.35rem;white-space:nowrap}.facts small{font-size:.8rem}
@media screen and (max-width:52rem){.facts{grid-template-columns:1fr 1fr}#summary{border:0;padding:0}}
.notice{margin:.5rem 0}
.warning{padding:.4rem .8rem;border-left:.3rem solid var(--warn);background:var(--warned)}
tr.good,tr.bad{color:var(--ink);font-weight:400}
tr.good td:nth-child(3),tr.bad td:nth-child(3){white-space:nowrap}
tr.good td:nth-child(4){color:var(--good);font-weight:600}
tr.bad td:nth-child(4){color:var(--bad);font-weight:600}
nav ul{display:flex;flex-wrap:wrap;gap:.3rem 1.3rem;list-style:none;padding:0}
footer{border-top:2px solid var(--ink);margin-top:2.6rem}
figure{margin:1.2rem 0}
figure svg{width:100%;min-width:30rem;height:auto;display:block}
#summary figure svg{min-width:0}
.unprinted{display:none}
@media print{main{padding:0}figure{margin:.5rem 0}figure svg{min-width:0;max-height:7.1cm}
figure svg.tall{max-height:8.8cm}
#summary{border:0;padding:0}#summary figure svg{max-height:6cm}
.facts{grid-template-columns:repeat(6,1fr);gap:.3rem;margin:.4rem 0}.facts p{padding:.2rem .5rem;line-height:1.2}.facts b{font-size:1.1rem}
.facts small{font-size:.7rem}
nav{display:none}#input th[scope=row]{white-space:nowrap}#input wbr{display:none}
h1{font-size:18pt}h2{margin:.8rem 0 .4rem}h3{margin-top:.8rem}
#print-tables,#print-tables+label,#print-tables:not(:checked)~*{display:none}
#print-tables:not(:checked)~.unprinted{display:block}
a{color:inherit;text-decoration:none}}
"""
PAIRS = """\
.pair{display:grid;grid-template-columns:1fr 1fr;gap:1.6rem}.pair>*{min-width:0}
@media screen{main{max-width:96rem}}
@media screen and (max-width:66rem){.pair{grid-template-columns:1fr}}
@media print{.pair{gap:.7cm;clear:both}}
"""
"""Of pictures of two machines side by side, which are printed on sheets that lie."""

PICTURE = """\
text{font-family:system-ui,"DejaVu Sans",sans-serif;font-size:10px}.h{font-size:13px;font-weight:600}
.m{stroke-width:4;stroke-linecap:round}.f,.g,.x{stroke-width:1}.o,.b,.i{stroke-width:1.2}.f,.g,.q,.x,.m{fill:none}
.q{stroke-width:.5;stroke-opacity:.5}
.halo{paint-order:stroke;stroke-width:3px;stroke-linejoin:round}
.k0,.k1,.k2,.k3,.k4,.k5{fill:none;stroke-width:1.6}.j0,.j1,.j2,.j3,.j4,.j5{fill:none;stroke-width:1.2}
.k1{stroke-dasharray:8 3}.k2{stroke-dasharray:2 2.5}.k3{stroke-dasharray:9 3 2 3}
.k4{stroke-dasharray:5 2}.k5{stroke-dasharray:1 3}
.metal,.rod,.hollow{stroke-width:.9;stroke-linejoin:round}.thin,.axis,.guess{fill:none;stroke-width:.7}
.axis{stroke-dasharray:7 2.5 1.5 2.5}.guess{stroke-dasharray:4 3}
.note{font-size:12.5px}.strong,.force{font-size:13px}.strong{font-weight:600}
@media(max-width:520px){.mark,.force{font-size:19px}}
"""
PICTURE_COLOURS = """\
.s{background:var(--paper)}text{fill:var(--ink)}.halo{stroke:var(--paper)}.f,.q{stroke:var(--faint)}.g{stroke:var(--grid)}
.x,.m,.o,.b,.i{stroke:var(--ink)}.o{fill:var(--paper)}.b{fill:var(--grid)}.i{fill:var(--ink)}
.p{fill:var(--gain)}.n{fill:var(--loss)}
.k0,.j0{stroke:var(--line0)}.k1,.j1{stroke:var(--line1)}.k2,.j2{stroke:var(--line2)}
.k3,.j3{stroke:var(--line3)}.k4,.j4{stroke:var(--line4)}.k5,.j5{stroke:var(--line5)}
.c0{fill:var(--line0)}.c1{fill:var(--line1)}.c2{fill:var(--line2)}
.c3{fill:var(--line3)}.c4{fill:var(--line4)}.c5{fill:var(--line5)}
.wall{fill:var(--wall)}.web{fill:var(--web)}.metal{fill:var(--metal)}.rod{fill:var(--rod)}.hollow{fill:var(--hollow)}
.gas{fill:var(--gas)}.liquid{fill:var(--liquid)}
.thin,.guess,.metal,.rod,.hollow{stroke:var(--edge)}.axis{stroke:var(--faint)}.note{fill:var(--faint)}
"""
MOVING = """\
svg .still{display:none}
@media print{svg .moving{display:none}svg .still{display:inline}}
@media (prefers-reduced-motion:reduce){svg .moving{display:none}svg .still{display:inline}}
"""
"""What moves has a copy at rest, for paper and for readers who want nothing to move."""


def page_css(*more: str) -> str:
    """Return the style sheet of a page."""
    light = ";".join(f"--{name}:{shades[0]}" for name, shades in COLOURS.items())
    dark = ";".join(f"--{name}:{shades[1]}" for name, shades in COLOURS.items())
    return (
        f":root{{{light}}}\n@media screen and (prefers-color-scheme:dark){{:root{{{dark}}}}}\n"
        f"{PAGE}{''.join(more)}"
    )


def picture_css(paper: bool = False) -> str:
    """Return the style sheet of a file of pictures, without variables, which some programs do not know.

    paper: of what can neither be dark nor move.
    """
    light = re.sub(r"var\(--(\w+)\)", lambda name: COLOURS[name[1]][0], PICTURE_COLOURS)
    if paper:
        return PICTURE + light
    dark = re.sub(r"var\(--(\w+)\)", lambda name: COLOURS[name[1]][1], PICTURE_COLOURS)
    return f"{PICTURE}{light}{MOVING}@media screen and (prefers-color-scheme:dark){{{dark}}}\n"
