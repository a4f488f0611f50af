"""Input that a reader could misunderstand: it is understood as written, or refused with its place."""

from decimal import Decimal

from kurbel.accuracy.extremes import Probe, Refusal

_HEAD = "crank: 400 mm, rod_ratio: 5, bore: 450 mm"


def _expansion(points: str) -> str:
    card = f"{{unit: bar, expansion: {points}, compression: [[1, 1], [0, 1]]}}"
    return f"{{{_HEAD}, indicator: {{head_end: {card}}}}}"


CASES = [
    Probe("1e3 mm is a number", "{crank: 1e3 mm, rod_ratio: 5}", "motion stroke", lambda: Decimal(2), 0),
    Probe("ratio written 5:1", "{crank: 400 mm, rod_ratio: 5:1}", "motion x@30", Refusal("5 for 5:1")),
    Probe("decimal comma", "crank: 0,4 m\nrod_ratio: 5", "motion x@30", Refusal("decimal comma")),
    Probe("no unit", "{crank: 400, rod_ratio: 5}", "motion x@30", Refusal("400 has no unit")),
    Probe("unit of another kind", "{crank: 400 kg, rod_ratio: 5}", "motion x@30", Refusal("kg is a unit of mass")),
    Probe("no number", "{crank: .nan, rod_ratio: 5}", "motion x@30", Refusal("expected a number with its unit")),
    Probe("infinite crank", "{crank: infinite, rod_ratio: 5}", "motion x@30", Refusal("expected a number")),
    Probe("key twice", "crank: 400 mm\ncrank: 500 mm\nrod_ratio: 5", "motion x@30", Refusal("twice")),
    *(
        Probe(name, _expansion(points), "forces work", Refusal(text))
        for name, points, text in (
            ("line that turns back", "[[0, 5], [0.6, 5], [0.4, 4], [1, 2]]", "turns back"),
            ("three points in a jump", "[[0, 5], [0.5, 5], [0.5, 4], [0.5, 3], [1, 2]]", "three points"),
            ("outside the stroke", "[[0, 5], [1.1, 2]]", "no fraction of the stroke"),
            ("open card", "[[0.1, 5], [1, 2]]", "must reach from fraction 0 to 1"),
            ("one point", "[[0, 5]]", ""),
        )
    ),
]
