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

FORBIDDEN = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")  # what XML 1.0 cannot hold

UNCHECKED = "not checked, as no limit is stated"
OUTCOMES = {"failures": "failure", "skipped": "skipped"}  # attribute that counts the elements of this name


@dataclass(frozen=True)
class JUnitCase:
    """One check. failures: a line for each place where it fails; skipped: why nothing was checked, "" otherwise."""

    name: str
    failures: Sequence[str] = ()
    skipped: str = ""


@dataclass(frozen=True)
class JUnitSuite:
    """The checks of one scene, which took so many seconds from a timestamp on; said: what else is said of it."""

    name: str
    seconds: float
    timestamp: str
    cases: Sequence[JUnitCase]
    said: str = ""


def junit_xml(results: Results) -> str:
    """The acceptance limits of every scene as JUnit XML; a broken limit is a failure with its line as the message."""
    return junit_text([_suite_of(scene, results.run.began) for scene in results.scenes])


def _suite_of(scene: SceneResult, began: str) -> JUnitSuite:
    """The limits of a scene, and what has none."""
    cases = []
    for limit in scene.limits:
        key = f"acceptance.{limit.key} = {limit.allowed:g}{' by default' if limit.default else ''}"
        cases.append(JUnitCase(key, limit.broken))
    cases += [JUnitCase(f"acceptance: {pair}", skipped=UNCHECKED) for pair in scene.unchecked]
    seconds, said = sum(model.cost for model in scene.models.values()), "\n".join(h.statement for h in scene.headlines)
    return JUnitSuite(scene.name, seconds, began, cases, said)


def junit_text(scenes: Sequence[JUnitSuite]) -> str:
    """Return suites of checks as JUnit XML."""
    suites = ElementTree.Element("testsuites", name="phase-resonance acceptance limits")
    for scene in scenes:
        name = _xml_text(scene.name)
        about = {"name": name, "time": f"{scene.seconds:.1f}", "timestamp": scene.timestamp}
        suite = ElementTree.SubElement(suites, "testsuite", about)
        for each in scene.cases:
            case = ElementTree.SubElement(suite, "testcase", classname=name, name=_xml_text(each.name))
            if each.failures:
                lines = [_xml_text(line) for line in each.failures]
                ElementTree.SubElement(case, "failure", message=lines[0]).text = "\n".join(lines)
            if each.skipped:
                ElementTree.SubElement(case, "skipped", message=each.skipped)
        ElementTree.SubElement(suite, "system-out").text = _xml_text(scene.said)
        counts: dict[str, int] = {"tests": len(suite.findall("testcase")), "errors": 0}
        counts |= {kind: len(suite.findall(f"testcase/{tag}")) for kind, tag in OUTCOMES.items()}
        suite.attrib |= {kind: str(count) for kind, count in counts.items()}
    for kind in ("tests", *OUTCOMES):
        suites.set(kind, str(sum(int(suite.get(kind, "0")) for suite in suites)))
    ElementTree.indent(suites)
    return ElementTree.tostring(suites, encoding="unicode", xml_declaration=True) + "\n"


def _xml_text(text: str) -> str:
    """The text, every character that XML cannot hold replaced."""
    return FORBIDDEN.sub("\ufffd", text)
