"""junit.xml: one test suite per scene, one test case per acceptance limit it states; what a CI server shows."""

from __future__ import annotations

import re
from xml.etree import ElementTree

from comparison.report.results import Results
from comparison.report.scene_result import SceneResult
from comparison.surfaces.acceptance import Limit

FORBIDDEN = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")  # what XML 1.0 cannot hold


def junit(results: Results) -> str:
    """The acceptance limits of every scene as JUnit XML; a broken limit is a failure with its line as the message."""
    suites = ElementTree.Element("testsuites", name="phase-resonance acceptance limits")
    for scene in results.scenes:
        suites.append(_suite(scene, results.run.began))
    for key in ("tests", "failures"):
        suites.set(key, str(sum(int(suite.get(key, "0")) for suite in suites)))
    ElementTree.indent(suites)
    return ElementTree.tostring(suites, encoding="unicode", xml_declaration=True) + "\n"


def _suite(scene: SceneResult, began: str) -> ElementTree.Element:
    seconds = sum(model.cost for model in scene.models.values())
    name = _allowed(scene.name)
    suite = ElementTree.Element("testsuite", name=name, time=f"{seconds:.1f}", timestamp=began)
    suite.extend([_case(name, limit) for limit in scene.limits])
    ElementTree.SubElement(suite, "system-out").text = _allowed("\n".join(h.statement for h in scene.headlines))
    suite.set("tests", str(len(scene.limits)))
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
