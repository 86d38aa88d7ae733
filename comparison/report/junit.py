"""junit.xml: one test suite per scene, one test case per acceptance limit it states; what a CI server shows."""

from __future__ import annotations

import re
from xml.etree import ElementTree

from comparison.analysis.acceptance import Limit
from comparison.report.findings import Findings
from reference.problem import Scene

FORBIDDEN = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")  # what XML 1.0 cannot hold


def junit(findings: Findings) -> str:
    """The acceptance limits of every scene as JUnit XML; a broken limit is a failure with its line as the message."""
    suites = ElementTree.Element("testsuites", name="phase-resonance acceptance limits")
    for scene in findings.study.scenes:
        suites.append(_suite(scene, findings))
    for key in ("tests", "failures"):
        suites.set(key, str(sum(int(suite.get(key, "0")) for suite in suites)))
    ElementTree.indent(suites)
    return ElementTree.tostring(suites, encoding="unicode", xml_declaration=True) + "\n"


def _suite(scene: Scene, findings: Findings) -> ElementTree.Element:
    seconds = float(findings.surfaces["cost"].sel(scene=scene.name).sum())
    name, began = _allowed(scene.name), str(findings.run["began"])
    suite = ElementTree.Element("testsuite", name=name, time=f"{seconds:.1f}", timestamp=began)
    limits = [limit for limit in findings.limits if limit.scene == scene.name]
    suite.extend([_case(name, limit) for limit in limits])
    suite.set("tests", str(len(limits)))
    suite.set("failures", str(len(suite.findall("testcase/failure"))))
    suite.set("errors", "0")
    return suite


def _case(scene: str, limit: Limit) -> ElementTree.Element:
    case = ElementTree.Element("testcase", classname=scene, name=f"acceptance.{limit.key} = {limit.allowed:g}")
    if limit.broken:
        lines = [_allowed(line) for line in limit.broken]
        ElementTree.SubElement(case, "failure", message=lines[0]).text = "\n".join(lines)
    return case


def _allowed(text: str) -> str:
    """The text, every character that XML cannot hold replaced."""
    return FORBIDDEN.sub("\ufffd", text)
