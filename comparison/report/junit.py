"""
junit.xml, which a CI server shows: one test suite per scene, one test case per acceptance limit, and a skipped one for
each pair of models without a limit.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from xml.etree import ElementTree

from comparison.report.results import Results
from comparison.report.scene_result import SceneResult

# Matches a character that XML 1.0 cannot hold
FORBIDDEN_CHARACTERS = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")

UNCHECKED_TEXT = "not checked, as no limit is stated"  # reason given for a skipped test case
# For each attribute of a JUnit test suite that states a number: name of the XML elements that it counts
ELEMENT_OF_COUNT = {"failures": "failure", "skipped": "skipped"}


@dataclass(frozen=True)
class JUnitCase:
    """Test case: an acceptance limit of a scene, or a pair of models that is compared without a limit."""

    name: str
    failures: Sequence[str] = ()  # sentences on how the limit is broken
    skipped: str = ""  # why nothing was checked, "" if it was


@dataclass(frozen=True)
class JUnitSuite:
    """Test suite of one scene."""

    name: str
    seconds: float  # compute time
    timestamp: str  # date and time of the run
    cases: Sequence[JUnitCase]
    said: str = ""  # text for its standard output


def format_limits_as_junit(results: Results) -> str:
    """Return the acceptance limits of every scene as JUnit XML; a broken limit is a failure with its text."""
    return format_junit([_make_suite(scene, results.run.began) for scene in results.scenes])


def _make_suite(scene: SceneResult, began: str) -> JUnitSuite:
    """Return the test suite of a scene: a case for each acceptance limit, a skipped one for each pair without."""
    cases = []
    for limit in scene.limits:
        key = f"acceptance.{limit.key} = {limit.allowed:g}{' by default' if limit.default else ''}"
        cases.append(JUnitCase(key, limit.broken))
    cases += [JUnitCase(f"acceptance: {pair}", skipped=UNCHECKED_TEXT) for pair in scene.unchecked]
    return JUnitSuite(
        name=scene.name,
        seconds=sum(model.cost for model in scene.models.values()),
        timestamp=began,
        cases=cases,
        said="\n".join(headline.statement for headline in scene.headlines),
    )


def format_junit(scenes: Sequence[JUnitSuite]) -> str:
    """Return the test suites of all scenes as JUnit XML."""
    suites = ElementTree.Element("testsuites", name="phase-resonance acceptance limits")
    for scene in scenes:
        name = _replace_forbidden(scene.name)
        about = {"name": name, "time": f"{scene.seconds:.1f}", "timestamp": scene.timestamp}
        suite = ElementTree.SubElement(suites, "testsuite", about)
        for each in scene.cases:
            case = ElementTree.SubElement(suite, "testcase", classname=name, name=_replace_forbidden(each.name))
            if each.failures:
                lines = [_replace_forbidden(line) for line in each.failures]
                ElementTree.SubElement(case, "failure", message=lines[0]).text = "\n".join(lines)
            if each.skipped:
                ElementTree.SubElement(case, "skipped", message=each.skipped)
        ElementTree.SubElement(suite, "system-out").text = _replace_forbidden(scene.said)
        counts: dict[str, int] = {"tests": len(suite.findall("testcase")), "errors": 0}
        counts |= {kind: len(suite.findall(f"testcase/{tag}")) for kind, tag in ELEMENT_OF_COUNT.items()}
        suite.attrib |= {kind: str(count) for kind, count in counts.items()}
    for kind in ("tests", *ELEMENT_OF_COUNT):
        suites.set(kind, str(sum(int(suite.get(kind, "0")) for suite in suites)))
    ElementTree.indent(suites)
    return ElementTree.tostring(suites, encoding="unicode", xml_declaration=True) + "\n"


def _replace_forbidden(text: str) -> str:
    """Return the text with every character that XML cannot hold replaced."""
    return FORBIDDEN_CHARACTERS.sub("\ufffd", text)
