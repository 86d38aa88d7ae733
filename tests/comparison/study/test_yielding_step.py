"""Friction that yields as a step of the study, from rigid friction on."""

import pytest
from studies import solved

import reference
from comparison.study.models import (
    EXACT,
    MODEL_HIERARCHY,
    SMALL,
    SMALL_RIGID_FRICTION,
    chain_of,
    effect_pairs_of,
    label_of,
    models_of,
    pairs_of,
    partner_of,
    readings_of,
    with_steps_of_scenes,
)
from comparison.study.study import Study
from comparison.study.user_models import make_user_model
from reference.problem import load_scene
from reference.problem.readings import DEFAULT_V_C

PLAIN = load_scene("fig3-I").with_values({"duration": 3.0, "name": "plain"})
SOFT = PLAIN.with_yield_displacement(1e-3).with_values({"name": "soft"})
HIERARCHY = with_steps_of_scenes(MODEL_HIERARCHY, [SOFT])


def test_the_law_is_a_step_of_its_own() -> None:
    assert [model.key for model in chain_of(SOFT, HIERARCHY)] == ["rigid", "small", "exact", "translational", "spatial"]
    effects = [(pair.effect, pair.first.key, pair.second.key) for pair in effect_pairs_of(SOFT, HIERARCHY)]
    assert effects[:2] == [("yielding friction", "rigid", "small"), ("geometry", "small", "exact")]
    total = pairs_of(SOFT, HIERARCHY)[0]
    assert (total.first.key, total.second.key, total.base.key) == ("rigid", "spatial", "rigid")


def test_a_pair_says_which_models_it_compares() -> None:
    hierarchy = [*MODEL_HIERARCHY, make_user_model("mine", {"function": "user_engines:plain"}, "regularised")]
    every = [
        *pairs_of(PLAIN, hierarchy),
        *effect_pairs_of(PLAIN, hierarchy),
        *pairs_of(PLAIN, hierarchy, {"spatial"}),
        *pairs_of(PLAIN, hierarchy, {"small-resolved", "spatial"}),
        *pairs_of(PLAIN, hierarchy, {"regularised"}),
    ]
    found = [(pair.first.key, pair.second.key, pair.base.key, pair.sentence) for pair in every]
    small, same = "small-resolved", "same geometry and same friction law on both sides: this gap must close"
    mine = (
        "regularised",
        "mine",
        "regularised",
        "the exact equations, v_reg against an engine of yours, which is said to solve the same",
    )
    total = (small, "spatial", small, "the paper's printed equations against the most complete model of Exudyn")
    planar = (
        small,
        "translational",
        small,
        "the paper's printed equations against Exudyn under the paper's own assumption that no body turns",
    )
    alike = ("regularised", "translational", "regularised", same)
    assert found == [
        mine, total, planar, alike,
        (small, "resolved", small, "what geometry adds to the small equations, as integrated"),
        ("resolved", "regularised", small, "what regularized friction adds to the exact equations, as integrated"),
        ("regularised", "translational", small, "what elastic contact adds to the exact equations, v_reg"),
        ("translational", "spatial", small, "what turning of the bodies adds to the translational engine"),
        ("small", "exact", "small", "what geometry adds to the small equations, literal supremum"),
        ("small-regularised", "regularised", small, "what geometry adds to the small equations, v_reg"),
        (small, "small-regularised", small, "what regularized friction adds to the small equations, as integrated"),
        (small, "small", small, "what the limits at stops add to the small equations as integrated"),
        ("small", small, "small", "what an integration of the small equations misses of the literal supremum"),
        ("small", "spatial", "small", "the literal supremum of the printed equations against the spatial engine"),
        mine, (small, "translational", small, "the paper's printed equations against the translational engine"), alike,
        mine, ("resolved", "translational", "resolved",
               "the exact equations, as integrated against the translational engine"), alike,
        total, planar,
    ]  # fmt: skip


def test_scenes_without_the_key_have_the_models_they_had() -> None:
    assert with_steps_of_scenes(MODEL_HIERARCHY, [PLAIN]) == MODEL_HIERARCHY
    both = with_steps_of_scenes(MODEL_HIERARCHY, [PLAIN, SOFT])
    assert [model.key for model in models_of(PLAIN, both)] == [model.key for model in MODEL_HIERARCHY]
    asked, before = (Study((PLAIN,), 2, 1e-3, hierarchy).batches() for hierarchy in (both, MODEL_HIERARCHY))
    assert [(each.model, each.question, len(each.phases)) for each in asked] == [
        (each.model, each.question, len(each.phases)) for each in before
    ]


def test_the_first_model_moves_the_scene_with_rigid_friction() -> None:
    study = Study((SOFT,), 2, 1e-3, models_of(SOFT, HIERARCHY)[:2])
    mu = solved(study)["mu"].sel(scene="soft", alpha1=0.0, alpha2=0.0)
    for key, scene, settings in (("rigid", PLAIN, {"cutoff": DEFAULT_V_C}), ("small", SOFT, {})):
        expected = reference.amplification(scene, [(0.0, 0.0)], equations="small", **settings).mu[0]
        assert mu.sel(model=key).values == pytest.approx(expected, rel=1e-6)


def test_words_are_those_of_the_law() -> None:
    small = next(model for model in HIERARCHY if model.key == SMALL.key)
    assert ["really sticks" in model.adds for model in (SMALL, small)] == [True, False]
    assert ["set-valued" in model.assumptions["friction"] for model in (SMALL, small)] == [True, False]
    assert [label_of(model, SOFT) for model in models_of(SOFT, HIERARCHY)[:3]] == [
        "small equations, rigid friction, as integrated", "small equations", "exact equations",
    ]  # fmt: skip
    oiled = load_scene("fig4-viscous")
    for scene, reading in ((PLAIN, ", as integrated"), (oiled, "")):
        assert label_of(SMALL_RIGID_FRICTION, scene) == "small equations, rigid friction" + reading
    mixed = {model.key: model for model in with_steps_of_scenes(MODEL_HIERARCHY, [PLAIN, SOFT])}
    assert mixed[EXACT.key].title == EXACT.title
    assert mixed[EXACT.key].assumptions["friction"].startswith(f"{EXACT.assumptions['friction']}; where the scene says")
    assert readings_of([SMALL_RIGID_FRICTION, small], SOFT) == ["as integrated"]
    assert readings_of([small], SOFT) == []
    assert readings_of([SMALL], PLAIN) == ["literal supremum"]
    assert readings_of([SMALL, SMALL_RIGID_FRICTION, SMALL], PLAIN) == ["literal supremum", "as integrated"]


@pytest.mark.parametrize(
    ("like", "partner"), [("small-resolved", "small"), ("exact", "exact"), ("regularised", "exact")]
)
def test_an_engine_of_the_user_is_compared_under_the_same_law(like: str, partner: str) -> None:
    engine = make_user_model("mine", {"function": "mine:amplification"}, like)
    assert partner_of(engine, SOFT, HIERARCHY).key == partner
