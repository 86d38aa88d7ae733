"""The command line with the paper's equations and the engine themselves: every phase computed, none mirrored."""

from __future__ import annotations

from pathlib import Path

import pytest
import xarray as xr

from comparison.run import main

pytestmark = pytest.mark.long


@pytest.fixture(scope="module")
def real(tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("real") / "report"
    assert main(["fig3-I", "--grid", "4", "--full", "--jobs", "2", "--out", str(place)]) == 0
    return place


def test_every_point_has_an_answer_with_an_error(real: Path) -> None:
    with xr.open_dataset(real / "surfaces.nc", engine="h5netcdf") as data:
        assert (data["status"] == "ok").all()
        assert data["mu"].sizes == {"scene": 1, "model": 6, "body": 2, "alpha1": 4, "alpha2": 4}
        assert (data["mu"] > 0.0).all()
        assert (data["error"] > 0.0).all()
        assert (data["error"] <= 1e-3 * data["mu"]).all(), "the tolerance asked for"
        for model in ("exact", "translational", "spatial"):
            mu = data["mu"].sel(model=model, scene="fig3-I", body=1)
            assert float(mu.max() - mu.min()) > 0.1, "no surface is one number everywhere"
