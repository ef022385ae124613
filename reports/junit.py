"""Requirements as JUnit XML, which servers of continuous integration read.

There is a test suite for each pin and a test case for each requirement. A requirement that is
missed, or met only as described, is a failure. One that is not decided is an error. One that was
not checked is skipped, and never passes.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import PurePath
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from reports.data.requirements import MET, RequirementRow, requirement_rows
from reports.data.results import Results
from reports.format.numbers import short
from reports.format.ranges import factor_text

TAG_OF_OUTCOME = {
    "missed": "failure",
    "depends": "failure",
    "not decided": "error",
    "not checked": "skipped",
}
BY_FACTORS_ON_LOADS = ", by the factors on loads"
COUNTED_TAGS = {"failures": "failure", "errors": "error", "skipped": "skipped"}
# Characters that XML 1.0 does not allow, not even escaped.
FORBIDDEN = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def junit_xml(results: Results) -> bytes:
    """Return the requirements of a run as JUnit XML in UTF-8."""
    rows = requirement_rows(results)
    root = _counted(Element("testsuites"), results.title, rows)
    stated = {row.key for row in rows if row.stated}
    for pin in dict.fromkeys(row.pin for row in rows):
        own = [row for row in rows if row.pin == pin]
        suite = _counted(SubElement(root, "testsuite"), f"pin {pin}", own)
        for row in own:
            again = not row.stated and row.key in stated
            _add_case(suite, row, results.study, BY_FACTORS_ON_LOADS if again else "")
    indent(root)
    content: bytes = tostring(root, encoding="utf-8", xml_declaration=True)
    return content + b"\n"


def _counted(element: Element, name: str, rows: Iterable[RequirementRow]) -> Element:
    """Return the element with its name and the numbers of its test cases."""
    tags = [TAG_OF_OUTCOME.get(row.outcome) for row in rows]
    element.set("name", _printable(name))
    element.set("tests", f"{len(tags)}")
    for key, tag in COUNTED_TAGS.items():
        element.set(key, f"{tags.count(tag)}")
    return element


def _add_case(suite: Element, row: RequirementRow, study: str, by: str) -> None:
    """Add the test case of a requirement, under a name that does not change with the factor.

    by: the end of the name, which distinguishes the requirement from a stated one of the same name.
    """
    case = f", {row.case}" if row.case else ""
    name = f"{row.title}{case}{by}"
    test = SubElement(suite, "testcase")
    test.set("name", _printable(name))
    test.set("classname", _printable(f"{PurePath(study).stem}.{row.pin}"))
    if row.outcome != MET:
        sign = SubElement(test, TAG_OF_OUTCOME[row.outcome])
        sign.set("message", _printable(message(row)))
        sign.set("type", row.outcome)
        sign.text = _printable(f"pin {row.pin}{case}: {message(row)}")


def message(row: RequirementRow) -> str:
    """Return what was reached, what is missing and what a result depends on, in a line."""
    text = f"{row.outcome}: {row.title}"
    if row.reached is not None:
        text += f", factor {factor_text(row.reached, row.required)}"
    text += f", {short(row.required)} required"
    if row.over:
        text += f"; not reached over what is open: {row.over}"
    return f"{text}; needs {row.needs}" if row.needs else text


def _printable(text: str) -> str:
    return FORBIDDEN.sub("\ufffd", text)
