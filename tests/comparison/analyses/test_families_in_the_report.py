"""A range in a scene file, or many files, is one study; its budget is drawn against the value that runs."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fake_models import fake_hierarchy
from places import scene_text
from runs import RUN
from studies import solved

from comparison.analyses.demands.analysis import DemandStatistics, PhaseExtreme
from comparison.analyses.families.analysis import list_family_demands_over_phases
from comparison.analyses.families.feature import family_panels
from comparison.registry import make_report
from comparison.result_types import UncertainNumber
from comparison.study.study import Study
from comparison.surfaces.distribution import Fractile
from reference.measures.distribution import FRACTILES
from reference.problem import load_family


@pytest.fixture
def file(tmp_path: Path) -> Path:
    place, friction = tmp_path / "mine.toml", "friction = {range = [0.1, 0.2], steps = 3}"
    place.write_text(scene_text("fig3-I", ("friction = 0.1", friction)), encoding="utf-8")
    return place


def test_the_results_have_every_curve_and_step_of_a_family(file: Path) -> None:
    """The smooth fake model: mu_1 = 3 + cos a1 + sin a2, so 1, 3 and 5 on a 4 x 4 grid; the engine 1 % above."""
    family = load_family(file)
    study = Study(family.scenes, 4, 1e-3, fake_hierarchy(gap=0.01))
    surfaces = solved(study)
    surfaces["mu"].loc[{"scene": family.scenes[1].name, "model": "translational"}] = np.nan
    results = make_report(study, surfaces, {}, [], RUN, families=[family]).results
    curves = {(curve.model, curve.body): curve for curve in results.families[0].curves}
    assert len(curves) == 2 * len(study.hierarchy)
    engine = curves["translational", 1]
    assert np.isnan([engine.mean[1], engine.lowest[1], engine.error[1]]).all()
    assert [engine.mean[0], engine.mean[2]] == pytest.approx([3.03, 3.03])
    steps = {(step.model, step.body): step for step in results.families[0].steps}
    assert [steps["total", 1].size[0], steps["total", 2].size[2]] == pytest.approx([0.01, 0.01])
    assert steps["translational", 1].resolved == (True, False, True)


def test_demands_of_all_phases_go_before_stored_motions(file: Path) -> None:
    family = load_family(file)

    def statistics(value: float) -> list[DemandStatistics]:
        fractiles = tuple(Fractile(probability, value + probability, 0.0) for probability in FRACTILES)
        low, high = (PhaseExtreme(value + shift, 0.0, (0.0, 0.0)) for shift in (-1.0, 2.0))
        return [
            DemandStatistics(
                "small", "drift", 2, 16, 0.25, UncertainNumber(value=value, error=0.0), fractiles, low, high, ()
            )
        ]

    first, _, third = (scene.name for scene in family.scenes)
    [band] = list_family_demands_over_phases(family, {first: statistics(5.0), third: statistics(7.0)})
    assert (band.quantity, band.body, band.motions) == ("drift", 2, (12, 0, 12))
    assert [band.lowest[0], band.median[0], band.highest[0], band.median[2]] == pytest.approx([4.0, 5.5, 7.0, 7.5])
    assert np.isnan(band.median[1])


def test_an_axis_is_logarithmic_over_decades_and_names_a_few(file: Path) -> None:
    family = load_family(file)
    study = Study(family.scenes, 2, 1e-3, fake_hierarchy())
    results = make_report(study, solved(study), {}, [], RUN, families=[family]).results

    def axis(*values: float | str) -> dict[str, Any]:
        changed = results.families[0].model_copy(update={"values": list(values)})
        [listed] = family_panels(results.model_copy(update={"families": [changed]}))
        return dict(listed["panels"][0]["plot"]["x"])

    assert axis(1e-3, 1e-2, 1e-1).get("log") is True
    assert "log" not in axis(0.1, 0.15, 0.2)
    assert "log" not in axis(0.0, 1.0, 100.0)
    few, many = (axis(*(f"{n}, 0.5" for n in range(count)))["ticks"] for count in (12, 220))
    assert len(few) == 12
    assert [tick[1] for tick in many][:3] == ["0, 0.5", "19, 0.5", "38, 0.5"]
    assert len(many) <= 12
