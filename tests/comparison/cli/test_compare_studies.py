"""The comparison of two reports finds one changed bit, one changed number, and nothing else."""

import json
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from places import ROOT
from report_texts import summary_of

SCRIPT = ROOT / "docs/compare_studies.py"


def compare(before: Path, after: Path) -> tuple[int, str]:
    """Exit code and output of the script."""
    done = subprocess.run([sys.executable, SCRIPT, before, after], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout


@pytest.mark.long
def test_a_changed_bit_and_a_changed_number_are_found(finished: Path, tmp_path: Path) -> None:
    other = tmp_path / "other"
    shutil.copytree(finished, other)
    summary = summary_of(other)
    summary["run"]["wall_seconds"] += 1.0
    for model in summary["scenes"][0]["models"].values():
        model["cost"] += 1.0
    (other / "summary.json").write_text(json.dumps(summary), encoding="utf-8")
    code, out = compare(finished, other)
    assert (code, out.splitlines()[-1].endswith(": 0 differences.")) == (0, True), out

    summary["scenes"][0]["differences"][0]["median"] += 1e-15
    (other / "summary.json").write_text(json.dumps(summary), encoding="utf-8")
    surfaces = xr.load_dataset(other / "surfaces.nc")
    mu = surfaces["mu"].values
    mu.flat[0] = np.nextafter(mu.flat[0], np.inf)
    surfaces.to_netcdf(other / "surfaces.nc", engine="h5netcdf")
    code, out = compare(finished, other)
    assert code == 1
    lines = out.splitlines()
    assert lines[0].startswith("surfaces.nc: mu: 1 of "), out
    assert lines[1].startswith("summary.json: scenes[0].differences[0].median: "), out
    assert len(lines) == 3, out


@pytest.mark.long
def test_a_folder_without_a_report_is_refused(finished: Path, tmp_path: Path) -> None:
    assert compare(finished, tmp_path)[0] == 2
