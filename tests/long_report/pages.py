"""Pages for the tests of this folder."""

from __future__ import annotations

from functools import cache

from kurbel.machine_file.given import given
from kurbel.render import Look
from kurbel.render.report_page import report_page
from kurbel.report.whole import side_by_side, whole_report
from kurbel.solver.case import Case
from representative import case_of


def page_of_case(case: Case) -> str:
    """The report of one machine."""
    keys = given(case.machine.origin) if case.machine.origin else ()
    document = whole_report(case, keys, "metric", 15.0, lambda doing: None)
    return "".join(report_page(document, Look("html"), "2000-01-01"))


@cache
def page_of(*names: str) -> str:
    """The report of one shipped machine, or of two."""
    cases = [case_of(name) for name in names]
    if len(cases) == 1:
        return page_of_case(cases[0])
    keys = [given(case.machine.origin) for case in cases if case.machine.origin]
    document = side_by_side(cases, keys, "metric", lambda doing: None)
    return "".join(report_page(document, Look("html"), "2000-01-01"))
