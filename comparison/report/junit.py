"""
junit.xml, which a CI server shows: one test suite per scene, one test case per acceptance limit, and a skipped one for
each pair of models without a limit.
"""

import re
from xml.etree import ElementTree

from comparison.report.results import Results

FORBIDDEN = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")  # what XML 1.0 cannot hold

OUTCOMES = {"failures": "failure", "skipped": "skipped"}  # attribute that counts the elements of this name


def junit(results: Results) -> str:
    """The acceptance limits of every scene as JUnit XML; a broken limit is a failure with its line as the message."""
    suites = ElementTree.Element("testsuites", name="phase-resonance acceptance limits")
    for scene in results.scenes:
        seconds, name = sum(model.cost for model in scene.models.values()), _limit_text(scene.name)
        about = {"name": name, "time": f"{seconds:.1f}", "timestamp": results.run.began}
        suite = ElementTree.SubElement(suites, "testsuite", about)
        for limit in scene.limits:
            key = f"acceptance.{limit.key} = {limit.allowed:g}{' by default' if limit.default else ''}"
            case = ElementTree.SubElement(suite, "testcase", classname=name, name=key)
            if limit.broken:
                lines = [_limit_text(line) for line in limit.broken]
                ElementTree.SubElement(case, "failure", message=lines[0]).text = "\n".join(lines)
        for pair in scene.unchecked:
            case = ElementTree.SubElement(suite, "testcase", classname=name, name=f"acceptance: {pair}")
            ElementTree.SubElement(case, "skipped", message="not checked, as no limit is stated")
        ElementTree.SubElement(suite, "system-out").text = _limit_text("\n".join(h.statement for h in scene.headlines))
        counts: dict[str, int] = {"tests": len(suite.findall("testcase")), "errors": 0}
        counts |= {kind: len(suite.findall(f"testcase/{tag}")) for kind, tag in OUTCOMES.items()}
        suite.attrib |= {kind: str(count) for kind, count in counts.items()}
    for kind in ("tests", *OUTCOMES):
        suites.set(kind, str(sum(int(suite.get(kind, "0")) for suite in suites)))
    ElementTree.indent(suites)
    return ElementTree.tostring(suites, encoding="unicode", xml_declaration=True) + "\n"


def _limit_text(text: str) -> str:
    """The text, every character that XML cannot hold replaced."""
    return FORBIDDEN.sub("\ufffd", text)
