"""Buildings on elastic bearings against Kane's equations in relative coordinates (elastic_chain.py)."""

import math

import numpy as np
import pytest
from elastic_chain import ElasticBuilding
from random_buildings import Building, random_building, under_a_record
from scenes_at_hand import assert_within

import multibody
from reference.problem import Outcome, Scene


def share_of_errors(building: Building) -> float:
    """Largest difference of the engine's factors from the equations', over both errors."""
    scene, phase, v_reg = building
    engine = multibody.amplification(Scene.model_validate(scene), [phase], "spatial", v_reg)
    assert engine.status[0] == Outcome.OK
    rough, close = (ElasticBuilding(scene, v_reg).factors(phase, rtol) for rtol in (1e-5, 1e-7))
    return float((np.abs(engine.mu[0] - close) / (engine.error[0] + np.abs(rough - close))).max())


def on_a_plane(seed: int) -> Building:
    """That building on a flat slider, on the axis of its links and shaken vertically, too."""
    scene, phase, v_reg = random_building(seed)
    scene["isolator"]["radius"] = math.inf
    for body in scene["bodies"]:
        del body["offset"]
    scene["excitation"]["amplitudes"].append(np.random.default_rng([9, seed]).uniform(-4.0, 4.0, 2).tolist())
    return scene, phase, v_reg


@pytest.mark.long  # half a minute each, without compiling
@pytest.mark.parametrize(
    "building",
    [*map(random_building, range(12)), *map(on_a_plane, range(4)), *map(under_a_record, range(5))],
    ids=lambda building: building[0]["title"],
)
def test_a_random_building_on_bearings_stays_within_its_error(building: Building) -> None:
    share = share_of_errors(building)
    print(f"\n{building[0]['title']}: {share:.2f} of the errors")
    assert share <= 1.0


@pytest.mark.parametrize(
    ("seed", "mu"), [(0, [0.99133843, 0.80543322]), (2, [0.98553951, 0.88931466])], ids=["start", "sample"]
)
def test_a_peak_behind_a_kink_of_the_record_is_within_its_error(seed: int, mu: list[float]) -> None:
    """Stiff links swing and friction relaxes: levels 0 and 1 agreed by chance, 1.4 errors from elastic_chain.py."""
    scene, phase, v_reg = under_a_record(seed)
    engine = multibody.amplification(Scene.model_validate(scene), [phase], "spatial", v_reg)
    assert_within(engine, mu)
