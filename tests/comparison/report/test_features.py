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
    "feature.py": '''"""Ratio of the amplification factors of body 2 and the platform."""

from comparison.report.section import Feature, Section
from comparison.result_types import Number, result


@result
class Ratio:
    """mu_2 over mu_1 of one model."""

    model: str
    largest: Number


def ratios(findings, scenes):
    mu = findings.surfaces["mu"].isel(scene=0)
    largest = (mu.sel(body=2) / mu.sel(body=1)).max(["alpha1", "alpha2"])
    return [Ratio(str(key), float(largest.sel(model=key))) for key in mu["model"].values]


def _draw(figures, report):
    (figures / "ratio.txt").write_text(str(len(report.results.of("ratio"))))


FEATURE = Feature(
    "ratio", list[Ratio], "ratio of two factors", summary=ratios, section=Section("Ratio of the factors", draw=_draw)
)
''',
    "section.html.j2": '{% for row in results.ratio %}<p class="ratio">{{ row.largest }}</p>{% endfor %}',
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
        "from comparison.analyses.claims import feature as claims\n": "",
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
    models = [model["key"] for model in summary["models"]]
    assert [row["model"] for row in summary["ratio"]] == models
    assert page_of(report).count('<p class="ratio">') == len(models)
    assert (report / "figures" / "ratio.txt").read_text() == str(len(models))
    assert '"ratio"' in (report / "summary.schema.json").read_text(encoding="utf-8")
    assert "claims" not in summary
    assert 'id="claims"' not in page_of(report, "verification.html")
