"""junit.xml: one test suite per scene, one test case per acceptance limit it states; what a CI server shows."""

from __future__ import annotations

from xml.etree import ElementTree

from comparison.report.findings import Findings
from reference.problem import Scene


def junit(found: Findings) -> str:
    """The acceptance limits of every scene as JUnit XML; a broken limit is a failure with its line as the message."""
    suites = ElementTree.Element("testsuites", name="phase-resonance acceptance limits")
    for scene in found.study.scenes:
        suites.append(_suite(scene, found))
    for key in ("tests", "failures"):
        suites.set(key, str(sum(int(suite.get(key, "0")) for suite in suites)))
    ElementTree.indent(suites)
    return ElementTree.tostring(suites, encoding="unicode", xml_declaration=True) + "\n"


def _suite(scene: Scene, found: Findings) -> ElementTree.Element:
    seconds = float(found.surfaces["cost"].sel(scene=scene.name).sum())
    suite = ElementTree.Element("testsuite", name=scene.name, time=f"{seconds:.1f}", timestamp=str(found.run["began"]))
    limits = {key: limit for key, limit in scene.acceptance.model_dump().items() if limit is not None}
    for key, limit in limits.items():
        case = ElementTree.SubElement(suite, "testcase", classname=scene.name, name=f"acceptance.{key} = {limit:g}")
        broken = [line for line in found.broken if line.startswith(f"{scene.name}: ") and f"acceptance.{key}:" in line]
        if broken:
            ElementTree.SubElement(case, "failure", message=broken[0]).text = "\n".join(broken)
    suite.set("tests", str(len(limits)))
    suite.set("failures", str(len(suite.findall("testcase/failure"))))
    suite.set("errors", "0")
    return suite
