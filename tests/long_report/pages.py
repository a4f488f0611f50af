"""Pages for the tests of this folder."""

from functools import cache

from kurbel.cli.request import cases_of
from kurbel.machine_file.overrides import key_texts
from kurbel.page.contents import Contents
from kurbel.page.whole import side_by_side, whole_report
from kurbel.render import Look
from kurbel.render.report_page import report_page
from kurbel.solver.case import Case
from representative import case_of


def page_of_case(case: Case, cases: tuple[Case, ...] = (), sections: tuple[str, ...] = ()) -> str:
    """The report of one machine, or these sections of it."""
    keys = key_texts(case.machine.origin) if case.machine.origin else ()
    contents = Contents.of(sections)
    document = whole_report(case, keys, "metric", 15.0, lambda doing: None, cases, contents)
    return "".join(report_page(document, Look("html"), "a4", "2000-01-01"))


@cache
def page_of(*names: str, cases: bool = False) -> str:
    """The report of one shipped machine, with its load cases if they are wanted, or of two."""
    machines = [case_of(name) for name in names]
    if len(machines) == 1:
        return page_of_case(machines[0], tuple(cases_of(machines[0].machine)) if cases else ())
    keys = [key_texts(case.machine.origin) for case in machines if case.machine.origin]
    document = side_by_side(machines, keys, "metric", lambda doing: None)
    return "".join(report_page(document, Look("html"), "a4", "2000-01-01"))
