"""The table of evidence is the one that its command writes, and the README states the same measured numbers."""

import importlib.util

from pages import ROOT

from comparison.analyses.validation.table import recorded

SCRIPT = ROOT / "docs" / "evidence_table.py"


def test_the_page_opens_with_the_table_that_its_command_writes() -> None:
    spec = importlib.util.spec_from_file_location("evidence_table", SCRIPT)
    assert spec is not None
    assert spec.loader is not None
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    page = (ROOT / "docs" / "evidence.md").read_text(encoding="utf-8")
    assert script.with_table(page) == page
    assert page.index("|") > page.index(script.BEGIN)


def test_the_readme_states_the_measured_numbers_as_recorded() -> None:
    rows = {(each.experiment, each.name): each for each in recorded().quantities}
    half, rest = (rows["frame, 450 g", name] for name in ("half range", "share of time at rest"))
    errors = [abs(half.sides[side].error / half.measured) for side in ("equations", "engine")]
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    row = next(line for line in text.splitlines() if "**measured**" in line)
    assert f"half range {100.0 * max(errors):.1f} %" in row
    assert (
        f"time at rest {max(abs(rest.sides[side].error) for side in ('equations', 'engine')):.1f} % of a cycle" in row
    )
    assert ("within" in row) == (rest.sides["engine"].verdict == "within u_val")
