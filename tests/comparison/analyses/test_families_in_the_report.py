"""A range in a scene file, or many files, is one study; its budget is drawn against the value that runs."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from fake_models import fake_hierarchy
from places import scene_text
from runs import RUN
from studies import solved

from comparison.analyses.demands.analysis import DemandStatistics, PhaseExtreme
from comparison.analyses.families.analysis import (
    FamilyCurve,
    FamilyDemand,
    FamilyStep,
    list_family_demands_over_phases,
)
from comparison.analyses.families.feature import family_panels, family_results
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


def statistics(value: float) -> list[DemandStatistics]:
    fractiles = tuple(Fractile(probability, value + probability, 0.0) for probability in FRACTILES)
    low, high = (PhaseExtreme(value + shift, 0.0, (0.0, 0.0)) for shift in (-1.0, 2.0))
    mean = UncertainNumber(value=value, error=0.0)
    return [DemandStatistics("small", "drift", 2, 16, 0.25, mean, fractiles, low, high, ())]


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
    assert results.unchecked == {scene.name: ["total", "translational"] for scene in family.scenes}
    findings: Any = SimpleNamespace(found={}, families=[family], study=study, surfaces=surfaces)
    first, *others = results.scenes
    stated = [first.model_copy(update={"demand_statistics": statistics(5.0)}), *others]
    (found,) = family_results(findings, stated) or ()
    assert (found.demands_over_phases, len(found.demands)) == (True, 1), "of one scene"
    assert [limit.scene for limit in results.limits] == [scene.name for scene in family.scenes for _ in range(5)]


def test_every_plot_of_a_family_has_the_lines_of_its_body_and_quantity(file: Path) -> None:
    family = load_family(file)
    study = Study(family.scenes, 2, 1e-3, fake_hierarchy())
    results = make_report(study, solved(study), {}, [], RUN, families=[family]).results
    keys, sides = ("exact", "translational", "spatial"), (1, 2)
    curves = [
        FamilyCurve(key, body, *[(100.0 * body + 10.0 * n + shift,) * 3 for shift in (0.0, -1.0, 2.0)], (0.1,) * 3)
        for n, key in enumerate(keys)
        for body in sides
    ]
    steps = [FamilyStep(key, body, (body + 0.1 * n,) * 3, (0.0,) * 3, (True,) * 3)
             for n, key in enumerate((*keys, "total")) for body in sides]  # fmt: skip
    demands = [
        FamilyDemand("exact", quantity, body, *[(value + shift, np.nan, value) for shift in (0.0, -0.5, 0.5)], (1,) * 3)
        for quantity, body, value in (
            ("acceleration", 2, 7.0), ("acceleration", 1, 5.0), ("drift", 1, 0.03), ("drift", 2, 0.04)
        )
    ]  # fmt: skip
    known = {"curves": curves, "steps": steps, "demands": demands, "demands_over_phases": True}
    changed = results.families[0].model_copy(update=known)
    [listed] = family_panels(results.model_copy(update={"families": [changed]}))
    values, title = [0.1, 0.15, 0.2], results.titles
    effect = {model.key: model.effect or model.title for model in results.models}
    drawn = {
        panel["title"]: [
            tuple(line.get(name) for name in ("name", "x", "y", "color", "low", "high"))
            for line in panel["plot"]["series"]
        ]
        for panel in listed["panels"]
    }

    expected: dict[str, list[Any]] = {}
    for b in sides:
        mu = [(100.0 * b + 10.0 * n, n) for n in range(3)]
        bands = [([middle - 1.0] * 3, [middle + 2.0] * 3) if n != 1 else (None, None) for middle, n in mu]
        expected[f"mu_{b}"] = [(title[keys[n]], values, [middle] * 3, n, *bands[n]) for middle, n in mu]
        expected[f"what each effect adds to mu_{b}"] = [
            (name, values, [100.0 * (b + 0.1 * n)] * 3, "ink" if name == "total" else n + 1, None, None)
            for n, name in enumerate((*(effect[key] for key in keys), "total"))
        ]
    for name, factor, value in (("platform acceleration", 1.0, 5.0), ("drift of the lowest story", 1e3, 0.04)):
        scaled = [[factor * (value + shift), None, factor * value] for shift in (0.0, -0.5, 0.5)]
        expected[f"{name} over all phases"] = [(title["exact"], values, scaled[0], 1, *scaled[1:])]
    assert drawn == expected
    assert [panel["plot"]["y"]["title"] for panel in listed["panels"]][-2:] == [
        "platform acceleration, m/s²", "drift of the lowest story, mm",
    ]  # fmt: skip


def test_demands_of_all_phases_go_before_stored_motions(file: Path) -> None:
    family = load_family(file)

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
