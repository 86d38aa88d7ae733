# ruff: noqa: E501 (a sentence stands on one line where it can)
"""mu over the smallest resolved speed: recomputed pair by pair, its sentence, plots and tables."""

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from known_analyses import collected
from known_conditioning import BELOW, known_curve, known_curves, known_supremum
from numpy.typing import NDArray
from pydantic import TypeAdapter

import multibody
import reference
from comparison.analyses.conditioning import analysis
from comparison.analyses.conditioning.analysis import (
    ENGINE_PERIODS,
    ENGINE_PHASES,
    QUESTIONS,
    REGULARIZATIONS,
    SPEEDS,
    Conditioning,
    ConditioningCurve,
    conditioning_curves,
)
from comparison.analyses.conditioning.feature import conditioning_panels, conditioning_tables
from comparison.analyses.conditioning.statement import ILL_CONDITIONED_CHANGE, conditioning_line, yielding_line
from comparison.study.study import Study
from reference.problem import Amplification, Scene, load_scene
from reference.problem.readings import AS_INTEGRATED, LITERAL_SUPREMUM

Array = NDArray[np.float64]
GRID = 4
SET_VALUED, REGULARIZED, EXACT, TRANSLATIONAL, SPATIAL, YIELDING, DAMPED = range(len(QUESTIONS))
# physics of the paper's scenes, per cent below the literal supremum at these v_c, recorded with 16 x 16 phases
RECORDED_SPEEDS = (3e-2, 1e-2, 3e-3, 1e-3, 1e-4, 1e-6, 1e-9, 1e-12)
RECORDED = {
    "fig3-I": ("-10.8", "-9.4", "-8.9", "-8.2", "-6.2", "-3.4", "-1.5", "-0.95"),
    "fig3-II": ("-6.3", "-5.8", "-5.7", "-5.6", "-5.2", "-2.5", "-0.9", "-0.4"),
}


def _mu(scene: Scene, pair: tuple[float, float], **settings: Any) -> tuple[Array, Array]:
    answer = reference.amplification(scene, [pair], tolerance=1e-6, **settings)
    return answer.mu[0], answer.error[0]


@pytest.mark.parametrize(
    ("number", "argument"), [(SET_VALUED, "cutoff"), (REGULARIZED, "regularization")], ids=["v_c", "v_reg"]
)
@pytest.mark.parametrize("name", ["fig3-I", "fig4-dry"])
def test_every_number_is_that_of_a_loop_over_the_pairs(number: int, argument: str, name: str) -> None:
    """Without symmetry, one pair in a call; sums by hand."""
    scene, axis = load_scene(name), [2.0 * math.pi * k / GRID for k in range(GRID)]
    pairs = [(one, other) for one in axis for other in axis]
    limit = [_mu(scene, pair, equations="small") for pair in pairs]
    for curve in conditioning_curves((scene, number, GRID)):
        body = curve.body - 1
        if curve.reading == LITERAL_SUPREMUM:
            assert (curve.v, curve.relative_mean) == ((0.0,), (0.0,))
        for place, speed in enumerate(curve.v):
            found = [_mu(scene, pair, equations="small", **{argument: speed or None}) for pair in pairs]
            mu, error = ([float(part[body]) for part in column] for column in zip(*found))
            supremum = [float(part[body]) for part, _ in limit]
            assert curve.mean[place] == pytest.approx(sum(mu) / 16.0, rel=1e-5)
            assert curve.mean_error[place] == pytest.approx(sum(error) / 16.0, rel=0.5)
            assert curve.largest[place] == pytest.approx(max(mu), rel=1e-5)
            at = min(pairs, key=lambda pair: math.dist(pair, curve.largest_phases[place]))
            assert curve.largest_phases[place] == pytest.approx(at)
            assert mu[pairs.index(at)] == pytest.approx(max(mu), rel=1e-5)
            assert curve.largest_error[place] == pytest.approx(error[pairs.index(at)], rel=0.5)
            below = [(one - other) / other for one, other in zip(mu, supremum)]
            assert curve.relative_mean[place] == pytest.approx(sum(below) / 16.0, abs=1e-5)
            parts = [[below[GRID * i + j] for i in (a, a + 2) for j in (b, b + 2)] for a in (0, 1) for b in (0, 1)]
            scatter = math.sqrt(sum((sum(part) / 4.0 - sum(below) / 16.0) ** 2 for part in parts) / 4.0)
            spread = math.sqrt(sum((each - sum(below) / 16.0) ** 2 for each in below) / 16.0)
            assert curve.relative_error[place] == pytest.approx(1.5 * max(scatter, spread / GRID), abs=1e-5)
        assert (curve.grid, curve.pairs, curve.duration, curve.base) == (GRID, 16, 20.0, "small")


@pytest.mark.parametrize("name", ["fig3-I", "fig3-II"])
def test_the_curve_climbs_to_the_supremum_as_recorded(name: str) -> None:
    curves = conditioning_curves((load_scene(name), SET_VALUED, 16))
    for body in (1, 2):
        resolved, supremum = (curve for curve in curves if curve.body == body)
        assert (resolved.reading, supremum.reading) == (AS_INTEGRATED, LITERAL_SUPREMUM)
        for values, errors in (
            ((*resolved.mean, *supremum.mean), (*resolved.mean_error, *supremum.mean_error)),
            ((*resolved.largest, *supremum.largest), (*resolved.largest_error, *supremum.largest_error)),
        ):
            assert list(resolved.v) == sorted(resolved.v, reverse=True)
            for before, after, error, other in zip(values, values[1:], errors, errors[1:]):
                assert after >= before - 2.0 * (error + other)
    platform = curves[0]
    for speed, percent in zip(RECORDED_SPEEDS, RECORDED[name], strict=True):
        decimals = len(percent.partition(".")[2])
        assert f"{100.0 * platform.relative_mean[platform.v.index(speed)]:.{decimals}f}" == percent


def test_the_exact_equations_stand_at_few_pairs_of_the_first_periods() -> None:
    scene = load_scene("fig3-I")
    short = scene.with_values({"duration": ENGINE_PERIODS * 1.1})  # the slower of 0.9 and 1.1 s
    resolved, _, supremum, _ = conditioning_curves((scene, EXACT, 0))
    limit = reference.amplification(short, ENGINE_PHASES).mu[:, 0]
    for place, speed in enumerate(SPEEDS):
        mu = reference.amplification(short, ENGINE_PHASES, cutoff=speed).mu[:, 0]
        assert resolved.mean[place] == pytest.approx(mu.mean(), rel=1e-5)
        assert resolved.relative_mean[place] == pytest.approx((mu / limit - 1.0).mean(), abs=1e-5)
        assert resolved.relative_error[place] < 1e-5, "listed pairs have no error of sampling"
    assert (supremum.mean[0], supremum.largest[0]) == pytest.approx((limit.mean(), limit.max()), rel=1e-5)
    assert supremum.largest_phases[0] == pytest.approx(tuple(ENGINE_PHASES[limit.argmax()]))
    assert (resolved.grid, resolved.pairs, resolved.base) == (0, 3, "exact")
    assert resolved.duration == pytest.approx(short.duration)


def _answering(mu_at: Any) -> Any:
    """mu of pair p and body i at a speed, from `mu_at(speed)[p]` times 1 + i; NaN has a status."""

    def amplification(scene: Scene, phases: Array, **settings: Any) -> Amplification:
        first = np.array(mu_at(settings.get("regularization") or settings.get("cutoff")))
        mu = np.abs(first[:, None]) * np.array([1.0, 2.0])
        mu[first < 0.0, 1] = math.nan  # a negative number stands for a second body without a value
        status = np.where(np.isfinite(first), "ok", "step limit")
        return Amplification(mu, 1e-3 * mu, status, np.full(len(mu), np.nan), 0.0)

    return amplification


def test_the_engine_is_relative_to_the_supremum_of_the_exact_equations(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = []

    def supremum(scene: Scene, phases: Array, **settings: Any) -> Amplification:
        asked.append((settings["equations"], settings.get("cutoff"), scene.duration, phases.tolist()))
        return _answering(lambda speed: [2.0, 4.0, 5.0])(scene, phases)

    monkeypatch.setattr(reference, "amplification", supremum)
    monkeypatch.setattr(multibody, "amplification", _answering(lambda speed: [1.0 + speed, 3.0, 4.0 - speed]))
    for number in (TRANSLATIONAL, SPATIAL):
        curves = conditioning_curves((load_scene("fig3-I"), number, 0))
        assert [(curve.body, curve.speed, curve.reading) for curve in curves] == [
            (body, "v_reg", AS_INTEGRATED) for body in (1, 2)
        ]
        for curve in curves:
            for place, v in enumerate(REGULARIZATIONS):
                assert curve.mean[place] == pytest.approx(curve.body * 8.0 / 3.0)
                assert curve.mean_error[place] == pytest.approx(curve.body * 8e-3 / 3.0)
                assert curve.largest[place] == pytest.approx(curve.body * (4.0 - v))
                assert curve.largest_error[place] == pytest.approx(curve.body * 1e-3 * (4.0 - v))
                ratios = np.array([(1.0 + v) / 2.0, 0.75, (4.0 - v) / 5.0])
                assert curve.relative_mean[place] == pytest.approx((ratios - 1.0).mean())
                assert curve.relative_error[place] == pytest.approx(1e-3 * math.sqrt(2.0) * ratios.mean())
    assert {question[:2] for question in asked} == {("exact", None)}
    assert [question[2] for question in asked] == pytest.approx([3.3] * 2)
    assert asked[0][3] == ENGINE_PHASES.tolist()


def test_a_pair_that_lacks_a_speed_counts_at_none(monkeypatch: pytest.MonkeyPatch) -> None:
    """Means at different speeds are of the same pairs; a speed without any answer takes none from the others."""
    nan = math.nan
    monkeypatch.setattr(reference, "amplification", _answering(lambda speed: [2.0, 4.0, 5.0]))
    answers = {1e-2: [1.0, nan, 3.0], 1e-4: [nan] * 3}
    monkeypatch.setattr(multibody, "amplification", _answering(lambda v: answers.get(v, [1.0, 2.0, 3.0])))
    curve, _ = conditioning_curves((load_scene("fig3-I"), SPATIAL, 0))
    assert curve.mean[:4] == (2.0,) * 4
    assert (curve.pairs, curve.reason, math.isnan(curve.mean[4]), math.isnan(curve.largest[4])) == (2, "", True, True)
    for lost, at in ((nan, 1e-9), (-4.0, 1e-9), (-4.0, None)):  # of all bodies, of the second, of its supremum
        given = {at: [2.0, lost, 5.0]}
        monkeypatch.setattr(reference, "amplification", _answering(lambda v, at=given: at.get(v, [2.0, 4.0, 5.0])))
        resolved, _, supremum, _ = conditioning_curves((load_scene("fig3-I"), EXACT, 0))
        assert (resolved.pairs, resolved.mean[0], supremum.pairs, supremum.mean) == (2, 3.5, 2, (3.5,))
    monkeypatch.setattr(reference, "amplification", _answering(lambda speed: [nan] * 3))
    curve, _ = conditioning_curves((load_scene("fig3-I"), SPATIAL, 0))
    assert (curve.pairs, curve.reason) == (0, "step limit")
    assert np.isnan(curve.mean).all()
    kind = TypeAdapter(list[ConditioningCurve])
    text = kind.dump_json([curve])
    assert b"NaN" not in text
    assert kind.validate_json(text)[0].v == curve.v


def test_the_error_on_a_grid_is_the_root_of_that_of_numbers_and_that_of_sampling() -> None:
    size = np.linspace(-0.2, -0.1, 16)
    answers: Any = SimpleNamespace(independent=16, phases=np.zeros((16, 2)))
    sure, found = (analysis._statistics_at_speed(1.0 + size, size, size, error, answers, GRID).relative_error
                   for error in (0.0 * size, np.linspace(0.0, 0.04, 16)))  # fmt: skip
    assert found == pytest.approx(math.hypot(0.02, sure))
    assert found > 1.05 * max(sure, 0.02)


def test_each_scene_with_dry_friction_and_phases_is_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    names = ("fig3-I", "fig4-viscous", "synthetic-pair")
    scenes = tuple(map(load_scene, names))
    flat = load_scene("fig3-I").with_values({"bodies.0.height": None})

    def asked(grid: int, *scenes: Scene) -> list[tuple[str, int, int]]:
        return [(each.name, *rest) for each, *rest in Conditioning().task_arguments(Study(scenes, grid, 1e-3))]

    assert asked(48, *scenes) == [("fig3-I", number, 16 if number < EXACT else 0) for number in range(5)]
    assert SPATIAL not in {number for _, number, _ in asked(4, flat)}, "without a height"
    for grid, taken in ((4, 4), (16, 16), (7, 7), (17, 16), (64, 16), (18, 6)):
        assert asked(grid, scenes[0])[0][2] == taken, grid

    assert collected(Conditioning(), Study(scenes[1:], 4, 1e-3)) is None
    monkeypatch.setattr(analysis, "QUESTIONS", QUESTIONS[:1])

    def broken(*args: object, **settings: object) -> None:
        raise RuntimeError("singular")

    monkeypatch.setattr(reference, "amplification", broken)
    curves = collected(Conditioning(), Study(scenes[:1], 4, 1e-3))
    assert {curve.reason for curve in curves} == {"solver failed: RuntimeError: singular"}
    assert [len(curve.mean) for curve in curves] == [len(SPEEDS)] * 2
    assert conditioning_line(curves) == ""
    assert conditioning_panels(curves) == []
    assert {row["curve"].reason for table in conditioning_tables(curves) for row in table["rows"]} == {curves[0].reason}


@pytest.mark.long
def test_the_spatial_engine_settles_where_the_translational_one_climbs() -> None:
    """The last step of v_reg adds 1.3 % without and 0.2 % with bodies that turn."""
    last = []
    for number in (TRANSLATIONAL, SPATIAL):
        curve, _ = conditioning_curves((load_scene("fig3-I"), number, 0))
        last.append(curve.mean[-1] / curve.mean[-2] - 1.0)
    assert last == [pytest.approx(0.0125, abs=0.002), pytest.approx(0.0019, abs=0.001)]


OTHERS = [*known_curves(body=2), *known_curves(scene="fig3-II")]


def _smaller(curves: list[ConditioningCurve]) -> list[ConditioningCurve]:
    """Others with half the distance at every speed, and more of it above 1 mm/s."""
    return [replace(curve, relative_mean=tuple(0.5 * size for size in curve.relative_mean)) for curve in curves]


SENTENCE = (
    "The literal supremum is ill-conditioned: relative to it, mu_1 of fig3-I is −11.1 ± 0.4 % where speeds above "
    "1e-3 m/s count (as integrated), −5.2 ± 0.2 % above 1e-6 m/s, −1.73 ± 0.07 % above 1e-12 m/s (mean of 8 × 8 phases); as "
    "v_reg falls from 3e-4 to 1e-4 m/s, Exudyn's mean of 3 phase pairs still changes by +1.32 ± 0.02 % in translation, by +0.90 ± 0.01 % with bodies "
    "that turn."
)


def test_the_sentence_names_reading_base_grid_sign_and_error() -> None:
    assert conditioning_line(known_curves()) == SENTENCE
    assert conditioning_line([*_smaller(OTHERS), *known_curves()]) == SENTENCE, "the scene and body with most of it"
    assert conditioning_line([*known_curves(), *_smaller(OTHERS)]) == SENTENCE


def test_the_sentence_is_of_the_scene_with_most_below_a_millionth() -> None:
    """Another scene lies further below as integrated, and has nothing that slow speeds decide."""
    steep = tuple(5.0 * size if v >= 1e-3 else 0.0 for v, size in zip(SPEEDS, BELOW))
    others = [replace(each, relative_mean=steep) for each in known_curves(scene="fig3-II") if each.v == SPEEDS]
    assert conditioning_line([*others, *known_curves()]) == SENTENCE
    more = [
        replace(each, relative_mean=tuple(1.5 * size for size in each.relative_mean)) for each in known_curves(body=2)
    ]
    assert "mu_2 of fig3-I is −16.7 ± 0.4 % where speeds above 1e-3 m/s count" in conditioning_line(
        [*known_curves(), *more]
    )


def test_the_sentence_says_what_the_grid_does_not_tell() -> None:
    [resolved, *rest] = known_curves()
    wide = replace(resolved, relative_error=(0.06,) * len(SPEEDS))
    line = conditioning_line([wide, *rest])
    assert line.startswith("Whether the literal supremum is ill-conditioned, 8 × 8 phases do not tell: relative to it,")
    assert line.endswith(
        "−11 ± 6 % where speeds above 1e-3 m/s count (as integrated), −5 ± 6 % above 1e-6 m/s, −2 ± 6 % above 1e-12 m/s "
        "(mean of 8 × 8 phases)."
    )
    unknown = conditioning_line([replace(resolved, relative_error=(math.nan,) * len(SPEEDS)), *rest])
    assert unknown.startswith("Whether")
    for v in (1e-3, 1e-6, 1e-12):
        gap = tuple(math.nan if each == v else size for each, size in zip(SPEEDS, resolved.relative_mean))
        assert conditioning_line([replace(resolved, relative_mean=gap), *rest]) == ""
    assert (
        "−11 % (error unknown) where speeds above 1e-3 m/s count (as integrated), −5.2 % (error unknown) above 1e-6 m/s"
        in unknown
    )


@pytest.mark.parametrize(
    ("size", "word"), [(0.9 * ILL_CONDITIONED_CHANGE, "well"), (1.2 * ILL_CONDITIONED_CHANGE, "ill")]
)
def test_the_supremum_is_well_conditioned_below_a_thousandth(size: float, word: str) -> None:
    [resolved, *rest] = known_curves()
    scaled = tuple(size / 0.052 * each for each in resolved.relative_mean)
    line = conditioning_line([replace(resolved, relative_mean=scaled, relative_error=(1e-6,) * len(SPEEDS)), *rest])
    assert line.startswith(f"The literal supremum is {word}-conditioned: relative to it, mu_1 of fig3-I is −0.")
    assert ("Exudyn" in line) == (word == "ill")
    wide = replace(resolved, relative_mean=scaled, relative_error=(0.5 * size,) * len(SPEEDS))
    assert conditioning_line([wide, *rest]).startswith("The literal" if word == "ill" else "Whether")


def test_the_sentence_leaves_out_an_engine_without_the_pairs() -> None:
    *others, translational, spatial = known_curves()
    tail = (
        "; as v_reg falls from 3e-4 to 1e-4 m/s, Exudyn's mean of 3 phase pairs still changes by +0.90 ± 0.01 % with bodies that "
        "turn."
    )
    assert conditioning_line([*others, spatial]).endswith(tail)
    assert conditioning_line([*others, replace(translational, pairs=2), spatial]).endswith(tail)
    for mean in ((*translational.mean[:-1], math.nan), (*translational.mean[:-2], math.nan, translational.mean[-1])):
        assert conditioning_line([*others, replace(translational, mean=mean), spatial]).endswith(tail)
    assert conditioning_line(others).endswith("(mean of 8 × 8 phases).")
    assert conditioning_line(None) == conditioning_line([]) == conditioning_line([translational, spatial]) == ""


def test_a_plot_names_the_reading_of_every_curve() -> None:
    grid, engine = conditioning_panels([*known_curves(), *known_curves(body=2)])
    assert grid["title"] == "fig3-I, small equations, 8 × 8 phases"
    assert engine["title"] == "fig3-I, engine, 3 phase pairs, the first 3.3 s"
    for each, quantity in ((grid, "μ_1"), (engine, "mean μ_1")):
        assert each["plot"]["x"] == {"title": "v_c or v_reg, m/s", "log": True}
        assert each["plot"]["y"] == {"title": quantity}
    drawn = {line["name"]: line for each in (grid, engine) for line in each["plot"]["series"]}
    resolved, supremum = known_curve(), known_supremum()
    for name, curve, values in (
        ("mean, as integrated at v_c", resolved, resolved.mean),
        ("largest, as integrated at v_c", resolved, resolved.largest),
        ("mean, as integrated at v_reg", known_curve(speed="v_reg"), known_curve(speed="v_reg").mean),
        ("exact equations, as integrated at v_c", known_curve("exact"), known_curve("exact").mean),
        *(
            (f"{name}, as integrated at v_reg", known_curve(model, "v_reg"), known_curve(model, "v_reg").mean)
            for model, name in (("translational", "Exudyn in translation"), ("spatial", "Exudyn, bodies that turn"))
        ),
    ):
        line = drawn.pop(name)
        assert (line["x"], line["y"], line["marks"]) == (list(curve.v), list(values), True), name
    for name, value in (
        ("mean, literal supremum", supremum.mean[0]),
        ("largest, literal supremum", supremum.largest[0]),
        ("exact equations, literal supremum", known_supremum("exact").mean[0]),
    ):
        line = drawn.pop(name)
        assert (line["x"], line["y"], "dash" in line) == ([1e-12, 1e-1], [value] * 2, True), name
    assert drawn == {}
    assert all(len({line["color"] for line in each["plot"]["series"]}) == 3 for each in (grid, engine))


def test_a_table_holds_every_number_and_the_largest_error() -> None:
    first, second = conditioning_tables([*known_curves(), *known_curves(body=2)])
    assert (first["speed"], len(first["heads"]), first["heads"][7], len(first["rows"])) == (
        "v_c",
        12,
        "1e-6",
        2 * 2 * 3,
    )
    assert (second["speed"], second["heads"][-1], len(second["rows"])) == ("v_reg", "1e-4", 2 * 3 * 3)
    mean, largest, below = first["rows"][:3]
    resolved, supremum = known_curve(), known_supremum()
    for row, values, errors, limit in (
        (mean, resolved.mean, resolved.mean_error, supremum.mean[0]),
        (largest, resolved.largest, resolved.largest_error, supremum.largest[0]),
        (below, resolved.relative_mean, resolved.relative_error, 0.0),
    ):
        assert [value for value, _ in row["cells"]] == [*values, limit]
        assert row["error"][0] == max(errors)
    assert (mean["name"], mean["phases"], below["cells"][4][1]) == ("small equations", "8 × 8", "−11 %")
    spatial = second["rows"][6]
    assert (spatial["name"], spatial["phases"], spatial["cells"][-1][0]) == ("Exudyn, bodies that turn", "3 pairs", 2.3)


def _yielding(**values: Any) -> Scene:
    return load_scene("fig3-I").with_values({"duration": 4.0, "name": "soft", **values}).with_yield_displacement(2e-3)


@pytest.mark.parametrize(("number", "damping"), [(YIELDING, None), (DAMPED, 0.05)])
def test_a_yield_displacement_takes_the_place_of_the_speed(number: int, damping: float | None) -> None:
    """Without symmetry, one pair in a call; the literal supremum is that of rigid friction."""
    scene = _yielding()
    curve, _, supremum, _ = conditioning_curves((scene, number, 2))
    links = {} if damping is None else {"bodies.1.damping": damping}
    axis = [0.0, math.pi]
    pairs = [(one, other) for one in axis for other in axis]
    limit = [_mu(load_scene("fig3-I").with_values({"duration": 4.0, **links}), pair)[0][0] for pair in pairs]
    assert (curve.v[0], curve.own, curve.damping, curve.speed) == (2e-3, 2e-3, damping, "u_y")
    for place in (0, 1, 3):
        soft = scene.with_values({"isolator.friction": {"slow": 0.1, "yield_displacement": curve.v[place]}, **links})
        mu = [_mu(soft, pair)[0][0] for pair in pairs]
        assert curve.mean[place] == pytest.approx(sum(mu) / 4.0, rel=1e-4)
        assert curve.largest[place] == pytest.approx(max(mu), rel=1e-4)
        below = [(one - other) / other for one, other in zip(mu, limit)]
        assert curve.relative_mean[place] == pytest.approx(sum(below) / 4.0, abs=1e-4)
    assert supremum.mean == pytest.approx((sum(limit) / 4.0,), rel=1e-5)
    assert (supremum.reading, supremum.v) == (LITERAL_SUPREMUM, (0.0,))


def test_only_scenes_whose_friction_yields_are_asked_for_it() -> None:
    study = Study((load_scene("fig3-I"), _yielding()), 16, 1e-3)
    asked = [(scene.name, number, grid) for scene, number, grid in Conditioning().task_arguments(study)]
    rigid = [(0, 16), (1, 16), (2, 0), (3, 0), (4, 0)]
    assert asked == [*(("fig3-I", *each) for each in rigid), ("soft", YIELDING, 8), ("soft", DAMPED, 8)]
    alone = _yielding(bodies=[{"mass": 1.0}])
    links = [number for _, number, _ in Conditioning().task_arguments(Study((alone,), 16, 1e-3))]
    assert links == [YIELDING], "without links"
    own = load_scene("fig3-I").with_yield_displacement(2.54321e-3)
    assert QUESTIONS[YIELDING].own_yield(own) == pytest.approx(2.54321e-3, rel=1e-8)
    for damping, other in (([[0.0, 0.0]], 0.05), ([[0.0, 0.0], [0.0, 0.7]], 0.0)):
        scene: Any = SimpleNamespace(damping=np.array(damping))
        assert [QUESTIONS[number].damping_of(scene) for number in (YIELDING, DAMPED)] == [None, other]


def _known_yields(**changes: Any) -> list[ConditioningCurve]:
    ways = (2e-3, 1e-3, 1e-4)
    curve = known_curve(
        "exact", scene="soft", speed="u_y", v=ways, grid=8, own=1e-3, mean=(1.7, 1.8, 1.9), largest=(2.1, 2.3, 2.2),
        mean_error=(1e-4, 2e-4, 3e-4), largest_error=(4e-4, 5e-4, 6e-4), relative_mean=(-0.02, 0.03, 0.05),
        relative_error=(0.004, 0.005, 0.006),
    )  # fmt: skip
    limit = known_supremum("exact", scene="soft", speed="u_y", grid=8, own=1e-3)
    damped = [replace(each, damping=0.05) for each in (curve, limit)]
    damped[0] = replace(damped[0], relative_mean=(0.3, 0.4, 0.2))
    return [replace(curve, **changes), limit, *damped]


def test_the_sentence_on_a_yield_displacement_follows_from_the_curve() -> None:
    said = yielding_line(_known_yields())
    assert said == (
        "Friction of soft yields at 1e-3 m: mu_1 is 1.8 ± 0.0002 in the mean of 8 × 8 phases and 2.3 ± 0.0005 at most, "
        "the mean +3.0 ± 0.5 % from the literal supremum of rigid friction; over yield displacements from 2e-3 to 1e-4 m "
        "the mean is between −2.0 ± 0.4 % (at 2e-3 m) and +5.0 ± 0.6 % (at 1e-4 m) from it. "
        "With links damped by 5 %, over yield displacements from 2e-3 to 1e-4 m the mean is between "
        "+20.0 ± 0.6 % (at 1e-4 m) and +40.0 ± 0.5 % (at 1e-3 m) from it."
    )
    assert "+3.0" not in yielding_line(_known_yields(relative_mean=(-0.02, -0.07, 0.05)))
    assert "between −7.0 ± 0.5 % (at 1e-3 m)" in yielding_line(_known_yields(relative_mean=(-0.02, -0.07, 0.05)))
    assert "yields at 1e-4 m: mu_1 is 1.9 ± 0.0003" in yielding_line(_known_yields(own=1e-4))
    assert yielding_line(known_curves()) == yielding_line(None) == yielding_line(_known_yields()[:1]) == ""
    assert yielding_line([replace(each, pairs=0) for each in _known_yields()]) == "", "no pair has an answer"
    assert conditioning_line(_known_yields()) == ""


def test_yield_displacements_have_a_panel_and_a_table_of_their_own() -> None:
    *_, panel = conditioning_panels([*known_curves(), *_known_yields()])
    assert panel["title"] == "soft, friction that yields, exact equations, 8 × 8 phases"
    assert panel["plot"]["x"] == {"title": "yield displacement u_y, m", "log": True}
    lines = {line["name"]: line for line in panel["plot"]["series"]}
    assert lines["largest, links damped by 5 %"]["y"] == [2.1, 2.3, 2.2]
    colors = {name: line["color"] for name, line in lines.items() if "rigid" not in name}
    assert len({*colors.values()}) == len(colors) == 4, colors
    undamped = [replace(curve, damping=0.0) for curve in _known_yields() if curve.damping is not None]
    *_, panel = conditioning_panels([*known_curves(), *undamped])
    assert {line["name"].split(", ")[1] for line in panel["plot"]["series"]} == {"links damped by 0 %"}
    assert lines["mean, links as stated, rigid, literal supremum"]["y"] == [2.3, 2.3]
    *others, table = conditioning_tables([*known_curves(), *_known_yields()])
    assert others == conditioning_tables(known_curves())
    shuffled = conditioning_tables([*_known_yields(), *known_curves()[::-1]])
    assert [each["speed"] for each in shuffled] == ["v_c", "v_reg", "u_y"]
    other = replace(_known_yields()[0], scene="other", v=(2e-3, 2.54e-3, 1e-4))
    apart = conditioning_tables([*_known_yields(), other])
    assert [len(each["rows"]) for each in apart] == [len(table["rows"]), len(table["rows"]) // 2]
    assert (table["speed"], table["unit"], table["heads"]) == ("u_y", "m", ["2e-3", "1e-3", "1e-4"])
    assert [value for value, _ in table["rows"][1]["cells"]] == [2.1, 2.3, 2.2, pytest.approx(3.22)]
