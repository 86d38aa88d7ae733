"""What a pull request and a CI server are shown: summary.md and junit.xml say what the run found, and nothing else."""

import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from jsonschema import Draft202012Validator
from pydantic import TypeAdapter
from report_texts import summary_of

from comparison.registry import StudyResults
from comparison.surfaces.waterfall import WaterfallBar
from reference.problem import load_scene

LIMITS = ("median", "maximum", "ratio", "closure", "failed")


def test_the_summary_names_every_broken_limit_and_every_verdict(finished: Path) -> None:
    text = (finished / "summary.md").read_text(encoding="utf-8")
    assert "12 acceptance limits broken" in text
    assert r"- fig3-I: body 1: acceptance.median: 0.01 found, 0.0001 allowed" in text
    assert "- **fig3-I** (Fig. 3a, b" in text
    assert "Cause: elastic contact, not geometry" in text, "the only model of the hierarchy that differs"
    assert "No building has been compared, and this study has no measured peaks" in text


def test_junit_fails_the_broken_limits_of_every_scene(finished: Path) -> None:
    suites = ElementTree.parse(finished / "junit.xml").getroot()
    assert [suite.get("name") for suite in suites] == ["fig3-I", "fig4-viscous"]
    for suite in suites:
        acceptance = load_scene(str(suite.get("name"))).acceptance
        cases = suite.findall("testcase")
        assert [case.get("name") for case in cases] == [f"acceptance.{k} = {getattr(acceptance, k):g}" for k in LIMITS]
        failed = [case for case in cases if case.find("failure") is not None]
        assert [str(case.get("name")).split()[0] for case in failed] == [
            "acceptance.median",
            "acceptance.maximum",
            "acceptance.ratio",
        ]
        assert suite.get("failures") == "3"
        text = str(failed[0].findtext("failure"))
        assert [line.split(": ")[1] for line in text.splitlines()] == ["body 1", "body 2"], "both bodies break it"


def _objects(schema: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """Every schema inside a schema."""
    yield schema
    inner = [*schema.get("properties", {}).values(), *schema.get("$defs", {}).values()]
    inner += [schema.get("items"), schema.get("additionalProperties"), *schema.get("anyOf", [])]
    for part in inner:
        if isinstance(part, dict):
            yield from _objects(part)


def test_every_key_of_the_summary_is_as_documented(finished: Path) -> None:
    schema = json.loads((finished / "summary.schema.json").read_text(encoding="utf-8"))
    Draft202012Validator.check_schema(schema)
    summary = summary_of(finished)
    assert [error_message.message for error_message in Draft202012Validator(schema).iter_errors(summary)] == []
    for part in _objects(schema):
        if "properties" in part:
            limits_of_engines = {"$ref": "#/$defs/Limits"}  # tables under names that users choose
            assert part["additionalProperties"] in (False, limits_of_engines), "an undocumented key is a fault"
            assert all(key.get("description") for key in part["properties"].values())


def test_the_summary_read_back_is_the_results(finished: Path) -> None:
    text = (finished / "summary.json").read_text(encoding="utf-8")
    assert json.loads(StudyResults.model_validate_json(text).as_json()) == json.loads(text)


def test_a_missing_number_is_null_in_one_way() -> None:
    form, bar = TypeAdapter(WaterfallBar), WaterfallBar("exact", math.nan, math.inf)
    written = form.dump_python(bar, mode="json")
    assert written == {"model": "exact", "size": None, "error": None, "real": False}
    assert math.isnan(form.validate_python(written).size)
