"""How the cost grows: a slope that is known is found, tall scenes are valid, what takes too long has no value."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from known_analyses import collected
from scipy.stats import linregress

from comparison.analyses.tradeoff import command, growth
from comparison.analyses.tradeoff.growth import (
    QUANTITIES,
    SCHEMA,
    STORED,
    Growth,
    MeasuredGrowth,
    Series,
    fitted_slope,
    tall,
    with_slope,
)
from comparison.study.study import Study
from reference.problem import load_scene

SCENE = load_scene("fig3-I")


def test_a_known_slope_is_found_in_the_larger_half() -> None:
    values = [1.0, 2.0, 4.0, 8.0, 16.0, 32.0]
    seconds = [1.0, 1.0, 1.0, *(value**1.5 for value in values[3:])]
    assert fitted_slope(values, seconds) == pytest.approx((1.5, 0.0), abs=1e-12)
    assert fitted_slope([*values, 64.0], [*seconds, np.nan])[0] == pytest.approx(1.5), "no answer does not count"
    assert np.isnan(fitted_slope(values[:2], seconds[:2])[0])
    line = linregress(np.log([1.0, 2.0, 4.0]), np.log([1.0, 3.0, 5.0]))
    assert fitted_slope([1.0, 2.0, 4.0], [1.0, 3.0, 5.0]) == pytest.approx((line.slope, line.stderr))


@pytest.mark.parametrize("bodies", [2, 6, 100])
def test_a_tall_scene_has_its_bodies_one_above_the_other(bodies: int) -> None:
    scene = tall(SCENE, bodies)
    heights = [body.height for body in scene.bodies]
    assert len(heights) == bodies
    assert heights == sorted(heights)
    assert scene.isolator.ring is not None
    assert scene.isolator.ring >= bodies


def test_the_cost_grows_with_bodies_and_phase_pairs() -> None:
    few = [
        replace(QUANTITIES[0], values=(2, 4, 8), models=QUANTITIES[2].models),
        replace(QUANTITIES[2], values=(4, 16, 64)),
    ]
    bodies, pairs = collected(Growth(few), Study((SCENE,), 1, 1e-3), executor=lambda jobs: ThreadPoolExecutor(1))
    assert bodies.quantity == "bodies"
    assert pairs.quantity == "phase pairs"
    assert None not in bodies.seconds
    assert pairs.seconds[-1] > pairs.seconds[0]


def test_growth_without_an_answer_is_read_back(tmp_path: Path) -> None:
    measured = growth_of(
        with_slope("bodies", "", "exact", (2.0, 4.0), (0.1, float("nan"))),
        with_slope("workers", "", "exact", (1.0,), (2.0,)),
    )
    files = command.growth_files(measured)
    assert set(files) == set(command.GROWTH_FILES)
    assert STORED.load(tmp_path) is None
    (tmp_path / "growth.json").write_bytes(files["growth.json"])
    assert STORED.load(tmp_path) == measured
    assert (measured.series[0].seconds, measured.series[0].slope) == ([0.1, None], None)


def growth_of(*series: Series) -> MeasuredGrowth:
    return MeasuredGrowth(SCHEMA, "fig3-I", "a scene", list(series), {"command": "made up"})


def test_the_command_writes_and_prints_the_growth(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    bodies = with_slope("bodies", "", "exact", (2.0, 4.0, 8.0), (0.5, 2.0, 8.0))
    workers = with_slope("workers", "", "exact", (1.0, 2.0), (3.0, float("nan")))
    monkeypatch.setattr(command, "computed", lambda *rest: None)
    monkeypatch.setattr(Growth, "collect", lambda *rest: [bodies])
    monkeypatch.setattr(command, "by_workers", lambda *rest: workers)
    assert command.main(["fig3-I", "--growth", "--out", str(tmp_path)]) == 0
    found = STORED.load(tmp_path)
    assert found is not None
    assert found.series == [bodies, workers]
    rows = [line.split() for line in capsys.readouterr().out.splitlines()]
    assert ["bodies", "exact", "2", "0.5"] in rows
    assert ["bodies", "exact", "8", "8", "2.00", "±", "0.00"] in rows, "the slope stands in the last row"
    assert ["workers", "exact", "2", "no", "answer"] in rows


def test_workers_share_the_same_calls(monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[object] = []
    monkeypatch.setattr(growth, "measure", calls.append)
    series = growth.by_workers(SCENE, ThreadPoolExecutor, 3)
    assert list(series.values) == [1.0, 2.0, 3.0]
    assert len(calls) == 3 * growth.CALLS + 2 * (1 + 2 + 3), "the same work for all, and two calls to warm each up"
