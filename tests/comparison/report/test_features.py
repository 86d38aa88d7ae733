"""A feature is one folder and its entry in the registry: one is added to a copy of the package, another deleted."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from places import ROOT
from report_texts import page_of, summary_of

FOLDER = {
    "__init__.py": "",
    "feature.py": '''
from comparison.report.section import Feature, Section
from comparison.result_types import Number


def ratios(findings, scenes):
    """The largest mu_2 over mu_1 of each model."""
    mu = findings.surfaces["mu"].isel(scene=0)
    return (mu.sel(body=2) / mu.sel(body=1)).max(["alpha1", "alpha2"]).values.tolist()


def _draw(figures, report):
    (figures / "ratio.txt").write_text(str(len(report.results.of("ratio"))))


SECTION = Section("Ratio of the factors", draw=_draw)
FEATURE = Feature("ratio", list[Number], "ratio of two factors", summary=ratios, section=SECTION)
''',
    "section.html.j2": '{% for ratio in results.ratio %}<p class="ratio">{{ ratio }}</p>{% endfor %}',
}


@pytest.mark.long
def test_a_folder_and_its_entry_are_a_feature(tmp_path: Path) -> None:
    """A copy of the package has the feature `ratio` and not the claims: in file, page and figures."""
    copy, report = tmp_path, tmp_path / "report"
    for name in ("reference", "multibody"):
        (copy / name).symlink_to(ROOT / name)
    shutil.copytree(ROOT / "comparison", copy / "comparison", ignore=shutil.ignore_patterns("__pycache__"))
    folder = copy / "comparison" / "analyses" / "ratio"
    folder.mkdir()
    for name, text in FOLDER.items():
        (folder / name).write_text(text, encoding="utf-8")
    shutil.rmtree(copy / "comparison" / "analyses" / "claims")
    registry = copy / "comparison" / "registry.py"
    text = registry.read_text(encoding="utf-8")
    measured = "from comparison.analyses.measured import feature as measured\n"
    edits = {
        "from comparison.evidence.claims import feature as claims\n": "",
        "    claims.FEATURE,\n": "    ratio.FEATURE,\n",
        measured: measured + "from comparison.analyses.ratio import feature as ratio\n",
    }
    for old, new in edits.items():
        assert text.count(old) == 1
        text = text.replace(old, new)
    registry.write_text(text, encoding="utf-8")
    command = [sys.executable, "-P", "-m", "comparison.run", "fig3-I", "--grid", "2", "--only", "surfaces,budget"]
    environment = {**os.environ, "PYTHONPATH": str(copy), "PYTHONDONTWRITEBYTECODE": "1"}
    subprocess.run([*command, "--out", str(report)], cwd=copy, env=environment, check=True)
    summary = summary_of(report)
    count = len(summary["models"])
    assert (len(summary["ratio"]), page_of(report).count('<p class="ratio">')) == (count, count)
    assert (report / "figures" / "ratio.txt").read_text() == str(count)
    assert '"ratio"' in (report / "summary.schema.json").read_text(encoding="utf-8")
    assert "claims" not in summary
    assert 'id="claims"' not in page_of(report, "verification.html")
