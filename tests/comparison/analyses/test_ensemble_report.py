"""The report of an ensemble: its page and the paper it prints to, its sentences, and what it refuses."""

import csv
import hashlib
import json
import math
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from browsers import CHROMIUM, LAPTOP, OVERLAPS, PHONE, opened, unfolded
from fake_models import fake_hierarchy
from known_analyses import analyses_are
from places import write_pulses
from playwright.sync_api import Browser
from printed_pages import A4, BEYOND, CUT, DOT, MARGIN, as_printed, letters, printed_page
from runs import SMALL, quick_figures

import reference
from comparison.analyses.ensemble import hand_checks, page, panels, rows, sentences, terminal, trust
from comparison.analyses.ensemble.command import main
from comparison.analyses.ensemble.limits import check_limits, list_verdicts
from comparison.analyses.ensemble.quantities import word_value
from comparison.analyses.ensemble.result import (
    STORED,
    BuildingRead,
    ChosenMotion,
    DemandAtScale,
    DemandCurve,
    DemandFractile,
    EndedMotion,
    EngineMotions,
    EnsembleResult,
    GroundComponent,
    GroundMotion,
    Statistic,
    Structure,
    SupportExtremes,
)  # fmt: skip
from comparison.analyses.ensemble.statistics import summarize_motions
from comparison.run import main as study
from comparison.runner.attempts import LostParts
from comparison.runner.progress import make_wide_console
from reference.measures import Estimate
from reference.problem import GRAVITY
from reference.problem.acceptance import DemandLimits

SCENE = """title = "two floors on four pendulums"
[isolator]
radius = 2.0
friction = {slow = 0.03, fast = 0.06, rate = 50.0}
supports = [[3.0, 2.0], [-3.0, 2.0], [-3.0, -2.0], [3.0, -2.0]]
sphere_radius = 0.1
travel = 0.5
[[bodies]]
mass = 40e3
height = 2.6
size = [7.0, 5.0, 0.6]
floor = "deck"
[[bodies]]
mass = 30e3
height = 5.6
size = [7.0, 5.0, 0.3]
stiffness = [30e6, 20e6]
[[bodies]]
mass = 20e3
height = 8.6
size = [7.0, 5.0, 0.3]
stiffness = [20e6, 25e6]
floor = "roof"
[excitation]
record = {suite = "suite", motion = "all"}
"""
MODELS = ("small", "exact", "regularised", "translational", "spatial")
NO_CHROMIUM = pytest.mark.skipif(CHROMIUM is None, reason="no Chromium on this machine")


def run(*words: str) -> int:
    return main([*words], executor=lambda workers: ThreadPoolExecutor(1))


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """Four motions, both bounds, the engine's default choice: the report of a small building."""
    place = tmp_path_factory.mktemp("ensemble")
    pulses = {"m1": (1.0, 4.0, 0.5), "m2": (1.5, 5.0, 1.5), "m3": (2.0, 6.0, 0.5), "m4": (2.5, 7.0, 0.5)}
    write_pulses(place / "suite", pulses)
    lines = ["name,x,y,z,factor,magnitude"]
    for number in (1, 2, 3, 4):
        name = f"pulse {number}" if number < 4 else "RSN1021_SUPERSTITION_HILLS_B-ICC"  # longer than a column
        lines.append(f"{name},m{number}.csv,,,1.{number},{'6.9' if number == 1 else ''}")
    (place / "suite" / "motions.csv").write_text("\n".join(lines) + "\n")
    (place / "mine.toml").write_text(SCENE)
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(place)
        assert run("mine.toml", "--bounds", "0.8", "1.5", "--out", "out") == 0
        yield place


@pytest.fixture(scope="module")
def found(folder: Path) -> EnsembleResult:
    result = STORED.load(folder / "out")
    assert result is not None
    return result


def table(folder: Path) -> list[dict[str, str]]:
    with open(folder / "out" / "ensemble.csv", newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


@NO_CHROMIUM
def test_every_number_of_the_printed_report_is_read_back(folder: Path, found: EnsembleResult, browser: Browser) -> None:
    """Every cell of the page stands on the paper, and the statistics there are those of ensemble.csv by hand."""
    printed = printed_page(browser, folder / "out" / "index.html")
    text = "".join(printed.texts)
    cells = {letters(cell) for cell in printed.cells}
    assert len(cells) > 200
    assert sorted(cell for cell in cells if cell not in text) == []
    read, weight = table(folder), 90e3 * GRAVITY
    heads = {
        "displacement [m]": 1e3, "travel_share [-]": 100.0, "base_shear [N]": 1e-3,
        "acceleration_1 [m/s^2]": 1 / GRAVITY, "drift_2 [m]": 1e3, "drift_ratio_2 [-]": 100.0,
        "overturning_moment_1 [N m]": 1e-3,
        "story_shear_3 [N]": 1e-3, "support_force_max [N]": 1e-3, "support_force_min [N]": 1e-3,
    }  # fmt: skip
    for bound in ("lower bound", "upper bound"):
        own = [row for row in read if (row["bound"], row["model"]) == (bound, "exact")]
        assert len(own) == 4
        for head, factor in heads.items():
            values = [float(row[head]) for row in own]
            shown = [
                word_value(value, None, factor) for value in np.quantile(values, [0.16, 0.5, 0.84], method="hazen")
            ]
            assert letters("".join(shown)) in text, (bound, head)
            for value in (np.mean(values), min(values) if "min" in head else max(values)):
                assert letters(word_value(float(value), None, factor)) in text, (bound, head)
        shears = [100.0 * float(row["base_shear [N]"]) / weight for row in own]
        assert letters(word_value(float(np.mean(shears)), None, 1.0)) in text
    for each in found.supports:
        for number in (each.smallest, each.largest):
            assert letters(word_value(number.value, number.error, 1e-3)) in text
    for number, sheet in enumerate(printed.texts, start=1):
        assert letters(f"page {number} of {len(printed.texts)}") in sheet
        assert sheet.count(letters(sentences.word_heading(found))) == 1 + (number == 1), "at the top of every page"
    for size in printed.sizes:
        assert size == pytest.approx(A4, abs=0.5)
    assert min(printed.filled[:-1]) > 1.0 / 3.0, printed.filled
    lines = [sentences.answer_sentence(found), trust.model_ratio_sentence(found), *sentences.engine_sentences(found)]
    for line in [*lines, *sentences.support_sentences(found), *sentences.DEFINITIONS]:
        assert letters(line) in text, line


@NO_CHROMIUM
def test_nothing_of_the_report_is_cut_or_overlaps_on_paper_and_phone(folder: Path, browser: Browser) -> None:
    sheet = as_printed(opened(browser, folder / "out" / "index.html", LAPTOP).page)
    assert sheet.evaluate(BEYOND, (A4[0] - 2.0 * MARGIN) / DOT) == []
    assert sheet.evaluate(CUT) == []
    assert sheet.evaluate(OVERLAPS)["faults"] == []
    sheet.close()
    for width in (PHONE, LAPTOP):
        visit = opened(browser, folder / "out" / "index.html", width, "dark")
        unfolded(visit.page)
        assert (visit.complaints, len(visit.requests)) == ([], 1)
        assert visit.page.evaluate("document.documentElement.scrollWidth <= innerWidth + 1")
        assert visit.page.evaluate(OVERLAPS)["faults"] == []
        visit.page.close()


def test_shears_drifts_and_moments_along_x_and_y_are_on_the_page_and_in_the_table(
    folder: Path, found: EnsembleResult
) -> None:
    read, text = table(folder), (folder / "out" / "index.html").read_text(encoding="utf-8")
    for demand, unit, factor in (("story_shear", "N", 1e-3), ("drift", "m", 1e3), ("overturning_moment", "N m", 1e-3)):
        shown = rows.make_direction_rows(found, demand)
        stories = {"below roof": 3, "below body 2": 2} | ({} if demand == "drift" else {"isolator": 1})
        assert [row.name for row, _ in shown if row.is_first] == list(stories)
        for row, cells in shown:
            below = [f"<br><small>{source}" if source else "" for _, source in cells]
            assert all(f">{cell}{source}<" in text for (cell, _), source in zip(cells, below))
            heads = [f"{demand}{of}_{stories[row.name]} [{unit}]" for of in ("", "_x", "_y")]
            own = [each for each in read if (each["bound"], each["model"]) == (row.bound, "exact")]
            whole, *along = ([float(each[head]) for each in own] for head in heads)
            for place, values in enumerate(along if own else ()):
                by_hand = [word_value(float(value), None, factor) for value in (np.mean(values), max(values))]
                assert [cell.partition(" ")[0] for cell, _ in cells[2 * place :][:2]] == by_hand
                largest = max(own, key=lambda each: float(each[heads[1 + place]]))
                assert (cells[2 * place][1], cells[2 * place + 1][1]) == ("", largest["motion"])
            if not own:
                assert all(source.split(", ")[-1] in ("lower", "upper") for _, source in cells), "bounds of an envelope"
                assert all(part <= (1.0 + 1e-6) * length for part, length in zip(values, whole))


def test_the_building_is_on_the_page_as_it_was_read(folder: Path, found: EnsembleResult) -> None:
    text = (folder / "out" / "index.html").read_text(encoding="utf-8")
    building = reference.describe_building(reference.load_family("mine.toml").scenes[0])
    for value in (f"{building.weight / 1e3:.5g}", f"4, {building.load_per_support / 1e3:.4g} each", "0.5, 3.5, 6.5"):
        assert f">{value}<" in text, value
    assert f"{building.isolated_period[0, 0]:.3g}, " in text
    lower, upper = (each.building for each in found.structures)
    assert lower is not None
    assert upper is not None
    assert (list(lower.friction), list(upper.friction)) == (pytest.approx([0.024, 0.048]), pytest.approx([0.045, 0.09]))
    for structure in found.structures:
        isolator, moved = structure.isolator, found.find_demand(structure.name, "displacement")
        assert isolator is not None
        assert moved is not None
        effective = reference.effective_isolator(
            reference.load_scene("fig3-I").with_values({
                "isolator": {"radius": 2.0, "friction": isolator.friction}, "bodies": [{"mass": 90e3}],
            }),
            moved.mean.value,
        )  # fmt: skip
        said = f"{effective.period:.3g} s, {100 * effective.damping:.3g} % at the mean displacement"
        assert said in text
    assert "roof" in text
    for value in ("50", "30 along x, 20 along y; 20 along x, 25 along y", "7 × 5, all"):
        assert f">{value}<" in text, value
    assert sentences.displaced_weight_sentence(found.structures[0]) in text
    assert 'radius of the spheres</th><td>m</td><td class="long">0.1<' in text
    assert f"phase-resonance {found.run['provenance']['phase-resonance']}" in text
    suite = {each.motion: each for each in found.suite}
    assert (suite["pulse 1"].magnitude, suite["pulse 2"].magnitude) == (6.9, None)
    assert suite["pulse 3"].factor == 1.3
    raw = np.loadtxt(folder / "suite" / "m3.csv", delimiter=",", skiprows=1)
    assert suite["pulse 3"].peak == pytest.approx(1.3 * np.hypot(raw[:, 1], raw[:, 2]).max())
    third = suite["pulse 3"]
    assert (list(third.files), third.step) == (["m3.csv, CSV"], pytest.approx(0.05))
    for column, one in enumerate(third.components, start=1):
        assert one.axis == "xyz"[column - 1]
        assert one.peak == pytest.approx(1.3 * np.abs(raw[:, column]).max())
        velocity = np.cumsum(0.5 * 0.05 * 1.3 * (raw[1:, column] + raw[:-1, column]))
        assert one.velocity == pytest.approx(np.abs(velocity).max())
        assert f">{one.peak / GRAVITY:.3g}<" in text
        assert f">{one.velocity:.3g}<" in text
    samples = next(
        scene.record for scene in reference.load_family("mine.toml").scenes if "m3.csv" in scene.excitation.origin[0]
    )
    np.testing.assert_allclose(samples[: len(raw), 1:3], 1.3 * raw[:, 1:3], rtol=1e-12)
    spectrum = reference.response_spectrum(samples[:, 0], samples[:, 1:3], found.ground_periods)
    np.testing.assert_allclose(third.spectrum, spectrum, rtol=1e-12)
    scene = hashlib.sha256(Path("mine.toml").read_bytes()).hexdigest()
    assert third.digest == hashlib.sha256(samples.tobytes()).hexdigest()
    assert (said := sentences.digest_sentence(found)) in text
    assert said.startswith(f"SHA-256, its first 12 digits, of scene files: mine.toml {scene[:12]}; of samples of the")
    assert f"pulse 3 {third.digest[:12]}" in said
    assert f"pulse 3 {third.digest[:12]}" not in sentences.digest_sentence(
        replace(found, suite=[replace(each, digest="0" * 64) for each in found.suite])
    )
    (panel,) = [make() for make in panels.make_ground_panels(found)]
    *motions, mean = panel["plot"]["series"]
    assert [each["titles"][0] for each in motions] == [each.motion for each in found.suite]
    spectra = np.array([each.spectrum for each in found.suite]) / GRAVITY
    np.testing.assert_allclose(mean["y"], np.prod(spectra, axis=0) ** 0.25, rtol=1e-12)


def test_forces_over_the_height_agree_with_those_of_the_supports(found: EnsembleResult) -> None:
    """By hand: moments at the isolator carried by two rows of supports bound the change of a support's force."""
    for structure in found.structures:
        moment, force = (found.find_demand(structure.name, name, body) for name, body in
                         (("overturning_moment", 1), ("support_force_max", None)))  # fmt: skip
        shear, base = (
            found.find_demand(structure.name, "story_shear", 1),
            found.find_demand(structure.name, "base_shear"),
        )
        assert moment is not None
        assert force is not None
        assert shear is not None
        assert base is not None
        assert shear.mean == base.mean
        displaced = found.find_demand(structure.name, "displacement")
        assert displaced is not None
        # by moment along y, with the shorter arm, and the weight that is displaced by u R / rho
        most = moment.largest.value + 2.1 / 2.0 * structure.weight * displaced.largest.value  # type: ignore[operator]
        bound = structure.weight / 4.0 + most * math.hypot(3.0 / 36.0, 2.0 / 16.0)
        assert structure.weight / 4.0 < force.largest.value < 1.1 * bound  # type: ignore[operator]


def isolated_block(time: np.ndarray, ground: np.ndarray) -> reference.Scene:
    return reference.load_scene("fig3-I").with_values({
        "isolator": {"radius": 2.24, "friction": 0.05}, "bodies": [{"mass": 1e5}], "duration": float(time[-1]),
        "excitation": {"record": {"time": time, "acceleration": ground}},
    })  # fmt: skip


def test_the_displacement_of_design_codes_is_above_that_of_the_bearing_under_noise() -> None:
    """ELF: D = S_d(T_eff, damping_eff), iterated; six artificial motions move 0.43 to 0.78 of it."""
    time = np.arange(0.0, 40.0, 0.02)
    ratios = []
    for seed in range(6):
        noise = np.random.default_rng(seed).normal(0.0, 1.0, len(time) // 20 + 1)
        rough = np.interp(time, np.linspace(0.0, 40.0, len(noise)), noise)
        ground = 1.1 * np.convolve(rough, np.hanning(25) / 12.0, "same") * np.exp(-(((time - 20.0) / 10.0) ** 2))
        scene = isolated_block(time, ground)
        moved = reference.demands(reference.trajectory(scene, (0.0, 0.0))).displacement.value
        elf = 0.1
        for _ in range(60):
            linear = reference.effective_isolator(scene, elf)
            period, damping = float(linear.period), float(linear.damping)
            (pseudo,) = reference.response_spectrum(time, ground[:, None], [period], damping)
            elf = 0.5 * (elf + float(pseudo) * (period / (2.0 * math.pi)) ** 2)
        ratios.append(moved / elf)
    assert min(ratios) > 0.4, ratios
    assert max(ratios) < 1.0, ratios


def planted(ratios: dict[str, float] | None = None, motions: int = 4) -> EnsembleResult:
    """A displacement of every motion by the equations, and of the second half by all models, times these ratios."""
    values = [0.1 * (number + 1) for number in range(motions)]
    names = [f"m{number + 1}" for number in range(motions)]
    ratios = {"exact": 1.0, "small": 0.9, "regularised": 1.0, "translational": 1.002, "spatial": 1.05} | (ratios or {})
    curves = [
        DemandCurve("b", "displacement", None, model, name, (1.0,), (ratio * value,), (0.0,))
        for model, ratio in ratios.items()
        for name, value in zip(names, values)
        if model == "exact" or value > np.median(values)
    ]
    numbers = [Statistic(float(each), 0.001) for each in (np.mean(values), max(values), min(values))]
    shares = (0.16, 0.5, 0.84)
    fractiles = [DemandFractile(float(np.quantile(values, share, method="hazen")), 0.0, share) for share in shares]
    stripe = DemandAtScale("b", "displacement", None, "exact", "m", 1.0, motions, numbers[0], fractiles, *numbers[1:],
                    {}, names[-1], names[0])  # fmt: skip
    chosen = [ChosenMotion("b", name, 1.0, ["largest displacement"], {}) for name in names[motions // 2 :]]
    building = BuildingRead(4, 250.0, [[2.0]], [[]], [[]], 2.0, (0.03, 0.06), 0.5, None, ("deck",))
    return EnsembleResult(
        "phase-resonance/ensemble/4", [Structure("b", "A <block>", 1, 1e3, None, building)], (1.0,), motions,
        {"ok": motions}, [stripe], curves, [], EngineMotions("spatial", chosen), {},
        suite=[GroundMotion(name, 10.0, 2.0) for name in names],
    )  # fmt: skip


def demand_row(found: EnsembleResult, name: str, bound: str = "b") -> rows.DemandRow:
    """The one row of a demand in the table at scale 1."""
    (row,) = (row for row in rows.make_demand_rows(found, 1.0) if (row.name, row.bound) == (name, bound))
    return row


def test_one_sentence_keeps_geometry_codes_and_turning_apart() -> None:
    said = trust.model_ratio_sentence(planted())
    assert said == (
        "On the 2 motions that all models computed, four things are apart: the geometry of the sphere, which the "
        "small equations leave out, is worth up to 10 % (isolator displacement, m4); given the same equations and "
        "friction law, the two codes differ by up to 0.2 % (isolator displacement, m3); the regularized friction of "
        "the engines, which the exact equations have not, is worth less than 0.01 % (isolator displacement, m3); "
        "bodies that turn on their supports change a demand by up to 4.8 % (isolator displacement, m3)."
    )
    contradiction = trust.model_ratio_sentence(planted({"small": 1.0, "translational": 1.3, "spatial": 1.3}))
    assert "the two codes differ by up to 30 %" in contradiction, "the codes, and neither geometry nor turning"
    assert "leave out, is worth less than 0.01 %" in contradiction
    regularized = trust.model_ratio_sentence(planted({"regularised": 1.3, "translational": 1.3, "spatial": 1.3}))
    assert "the two codes differ by less than 0.01 %" in regularized, "with the same friction law"
    assert "which the exact equations have not, is worth up to 30 % (isolator displacement" in regularized


def with_demand(found: EnsembleResult, quantity: str, body: int | None, **models: Sequence[float]) -> EnsembleResult:
    """Another demand of every motion by these models, with its statistics by the equations."""
    names = [each.motion for each in found.suite]
    curves = [
        DemandCurve("b", quantity, body, model, name, (1.0,), (value,), (0.0,))
        for model, values in models.items()
        for name, value in zip(names, values)
    ]
    numbers = {name: Estimate(value, 0.0) for name, value in zip(names, models["exact"])}
    stripe = summarize_motions(("b", quantity, body, "exact", "", 1.0), numbers, {})
    return replace(found, curves=[*found.curves, *curves], stripes=[*found.stripes, stripe])


def test_the_sentence_of_trust_covers_every_demand_of_its_table() -> None:
    """The largest difference of a single motion, of moments and support forces, too; the smallest force by itself."""
    found = with_demand(planted(), "support_force_max", None, exact=(4.0, 4.0, 4.0, 4.0), spatial=(4.0, 4.0, 4.0, 4.4))
    said = trust.model_ratio_sentence(found)
    assert said.endswith("change a demand by up to 10 % (largest support force, m4).")
    found = with_demand(found, "support_force_min", None, exact=(1.0, 1.0, 1.0, 1.0), spatial=(1.0, 1.0, 0.99, 0.8))
    said = trust.model_ratio_sentence(found)
    assert said.endswith(
        "(largest support force, m4), and the smallest support force, against statics, by up to 20 % (m4)."
    )
    moments = {"exact": (1.0, 1.0, 1.0, 1.0), "translational": (1.0, 1.0, 1.0, 1.0), "spatial": (1.0, 1.0, 1.0, 1.5)}
    others = {"small": (1.0,) * 4, "regularised": (1.0,) * 4}
    said = trust.model_ratio_sentence(with_demand(found, "overturning_moment", 1, **moments, **others))
    assert "change a demand by up to 50 % (overturning moment at the isolator, m4), and the smallest" in said


def test_statistics_over_several_places_are_of_the_largest_value_of_every_motion() -> None:
    """The story of the largest mean is not that of the largest value."""
    found = replace(planted(), structures=[replace(planted().structures[0], bodies=3)])
    found = with_demand(found, "drift_ratio", 2, exact=(0.001, 0.001, 0.001, 0.009), spatial=(0.001,) * 4)
    found = with_demand(found, "drift_ratio", 3, exact=(0.004, 0.004, 0.004, 0.005), spatial=(0.004,) * 4)
    row = demand_row(found, "largest drift ratio")
    assert (row.cells[0], row.cells[2], row.cells[4]) == ("0.525", "0.4", "0.9"), "mean, median and largest of maxima"
    assert (row.motion, row.where) == ("m4", "below body 2")
    table = {row.name: row.cells[4] for row in rows.make_profile_rows(found, "drift_ratio", 1.0)}
    assert (table["below body 2"], table["below body 3"]) == ("0.9", "0.5"), "every story by itself"
    for each in found.stripes:
        if each.quantity == "drift_ratio":
            assert float(row.cells[4]) >= 100.0 * each.largest.value - 1e-9  # type: ignore[operator]
    unknown = [
        replace(each, values=(None,)) if (each.quantity, each.body, each.motion) == ("drift_ratio", 3, "m1") else each
        for each in found.curves
    ]
    row = demand_row(replace(found, curves=unknown), "largest drift ratio")
    assert (row.cells[0], row.cells[4], row.where, row.motions) == ("0.5667 (of 3)", "≥ 0.9", "below body 2", "3 of 4")


def test_an_envelope_has_the_place_and_bound_of_its_largest_value() -> None:
    """Bounds whose largest drifts are in different stories; a bound without one leaves no place."""
    one = replace(planted(), structures=[replace(planted().structures[0], bodies=3)])
    one = with_demand(one, "drift_ratio", 2, exact=(0.001, 0.001, 0.001, 0.009))
    one = with_demand(one, "drift_ratio", 3, exact=(0.004, 0.004, 0.004, 0.005))
    other = replace(planted(), structures=one.structures)
    other = with_demand(other, "drift_ratio", 2, exact=(0.001, 0.001, 0.002, 0.001))
    other = with_demand(other, "drift_ratio", 3, exact=(0.006, 0.006, 0.007, 0.006))
    curves = [*one.curves, *(replace(each, structure="c") for each in other.curves)]
    stripes = [*one.stripes, *(replace(each, structure="c") for each in other.stripes)]
    names = [*one.structures, replace(one.structures[0], name="c")]
    both = replace(one, structures=names, curves=curves, stripes=stripes)
    row = demand_row(both, "largest drift ratio", "envelope")
    assert (row.cells[0], row.cells[4], row.motion, row.where) == ("0.625", "0.9", "m4", "below body 2")
    assert row.bounds == ("c", "c", "c", "b", "b")
    lost = [replace(each, values=(None,)) if each.structure == "c" and each.body else each for each in curves]
    row = demand_row(replace(both, curves=lost), "largest drift ratio", "envelope")
    assert (row.cells[4], row.motion, row.where) == ("≥ 0.9", "m4", "below body 2"), "of the bound that has values"
    lost = [replace(each, values=(None,)) if each.motion == "m4" and each.body else each for each in curves]
    row = demand_row(replace(both, curves=lost), "largest drift ratio")
    assert (row.cells[4], row.motion, row.where) == ("≥ 0.4", "m1", "below body 3"), "of the motions that have values"


def test_a_motion_beyond_the_travel_has_its_instant_in_the_files_and_on_the_page(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "short.toml").write_text(SCENE.replace("travel = 0.5", "travel = 0.04"))
    assert run("short.toml", "--engine", "0", "--out", "short") == 0
    said = capsys.readouterr().out
    stored = STORED.load(folder / "short")
    assert stored is not None
    assert {each.status for each in stored.ended} == {"travel reached"}
    assert stored.outcomes["travel reached"] == len(stored.ended) > 0
    assert all(each.instant is not None and 0.0 < each.instant < 2.0 for each in stored.ended)
    line = sentences.travel_sentence(stored)
    assert f" at {stored.ended[0].instant:.4g} s" in line
    assert line in said
    shown = (folder / "short" / "index.html").read_text(encoding="utf-8")
    assert line in shown
    assert "at least the travel, 40 mm" in shown


@NO_CHROMIUM
def test_rows_of_one_demand_stay_together_on_paper(folder: Path, browser: Browser) -> None:
    sheet = as_printed(opened(browser, folder / "out" / "index.html", LAPTOP).page)
    groups = sheet.evaluate("""[...document.querySelectorAll('.demands tbody')].map(body =>
      [getComputedStyle(body).breakInside, ...[...body.rows].map(row => row.cells[0].textContent)])""")
    assert len(groups) > 20
    for inside, first, *others in groups:
        assert (inside, bool(first), {*others} <= {""}) == ("avoid", True, True), (first, others)
    last = sheet.evaluate("getComputedStyle(document.querySelector('#run')).breakBefore")
    assert last == "avoid", "no last sheet of three lines"
    sheet.close()


def test_an_extended_smallest_force_shows_its_harmful_end() -> None:
    found = with_demand(planted(), "support_force_min", None, exact=(4e3, 3e3, 2e3, 1e3), spatial=(4e3, 3e3, 1e3, 5e2))
    (cells,) = [cells for row, _, cells in trust.extrapolate_ratios(found) if row.name == "smallest support force"]
    assert cells[1] == "1.875 (1.25 to 2.5)"
    assert cells[2] == "16 %: 0.855 (0.57 to 1.14)"
    assert cells[3] == "smallest: 0.75 (0.5 to 1)"


def test_one_motion_extends_no_ratio_nor_does_a_force_below_zero() -> None:
    def cells(exact: Sequence[float], spatial: Sequence[float], left_out: tuple[str, ...] = ()) -> list[str]:
        found = with_demand(planted(), "support_force_min", None, exact=exact, spatial=spatial)
        kept = [each for each in found.curves if each.model != "spatial" or each.motion not in left_out]
        rows = trust.extrapolate_ratios(replace(found, curves=kept))
        return next(shown for row, _, shown in rows if row.name == "smallest support force")

    alone = replace(
        planted(), curves=[each for each in planted().curves if each.model == "exact" or each.motion == "m4"]
    )
    said = trust.extrapolation_sentence(list(trust.extrapolate_ratios(alone)))
    assert said.startswith("A ratio of fewer than 2 motions has no spread: it makes no estimate of the suite.")
    shown = page.render_ensemble_page(alone).partition('id="extended"')[2].partition("</section>")[0]
    assert ("makes no estimate" in shown, "<table" in shown) == (True, False)
    mixed = with_demand(alone, "support_force_min", None, exact=(4e3, 3e3, 2e3, 1e3), spatial=(4e3, 3e3, 2e3, 1e3))
    shown = page.render_ensemble_page(mixed).partition('id="extended"')[2].partition("</section>")[0]
    assert "<table" in shown, "the second demand has several"
    several = list(trust.extrapolate_ratios(planted()))
    assert "none" not in trust.extrapolation_sentence(several)
    assert "none" in trust.extrapolation_sentence([(*several[0][:2], ["mm", "none"])])
    assert "<table" in page.render_ensemble_page(planted()).partition('id="extended"')[2].partition("</section>")[0]
    one = cells((4e3, 3e3, 2e3, 1e3), (1.0, 1.0, 1.0, 5e2), ("m1", "m2", "m3"))
    assert one[1:] == ["none", "16 %: none", "smallest: none"], "one motion tells no spread"
    below = cells((4e3, 3e3, 2e3, -1e3), (4e3, 3e3, 1e3, 0.0))
    assert below[3] == "smallest: none", "the engine's supports do not pull"


def two_bounds() -> EnsembleResult:
    """The lower bound reaches its travel of 0.5 m under m4, the upper bound has a value under all."""
    one = planted()
    lower = [replace(each, values=(None,), errors=(None,)) if each.motion == "m4" else each for each in one.curves]
    none = Statistic(None, None)
    stripe = replace(
        one.stripes[0], mean=none, largest=none, answered=3, reasons={"travel reached": 1}, largest_motion="",
        known=[Statistic(0.2, 0.0), Statistic(0.3, 0.0)], known_motion="m3",
    )  # fmt: skip
    upper = [replace(each, structure="c") for each in one.curves]
    names = [replace(one.structures[0], name=name) for name in ("b", "c")]
    return replace(
        one, structures=names, curves=[*lower, *upper], stripes=[stripe, replace(one.stripes[0], structure="c")],
        outcomes={"ok": 7, "travel reached": 1}, ended=[EndedMotion("b", "m4", 1.0, "travel reached", 12.345)],
    )  # fmt: skip


def test_the_largest_displacement_of_one_bound_is_not_that_of_a_bound_that_reaches_its_travel() -> None:
    assert sentences.answer_sentence(two_bounds()) == (
        "No value under m4 (b). Isolator displacement: at least the travel, 500 mm (b); mean 250 mm, largest 400 mm = "
        "80 % of the travel (c alone, m4). Outcomes by the equations: 7 ok, 1 travel reached."
    )
    assert "at least" not in sentences.answer_sentence(planted())
    assert " alone" not in sentences.answer_sentence(planted())
    rim = [replace(each, reasons={"rim reached": 1}) if each.reasons else each for each in two_bounds().stripes]
    said = sentences.answer_sentence(replace(two_bounds(), stripes=rim))
    assert ("at least the travel" in said, "(c alone, m4)" in said) == (False, True)
    alike = [planted().stripes[0], two_bounds().stripes[1]]
    assert "(b, m4)" in sentences.answer_sentence(replace(two_bounds(), stripes=alike)), "the first of equal bounds"


def test_a_motion_that_reaches_the_travel_is_said_with_its_instant() -> None:
    smaller = EndedMotion("b", "m9", 0.5, "travel reached", 3.0)
    assert sentences.travel_sentence(replace(two_bounds(), ended=[smaller, *two_bounds().ended])) == (
        "The travel is reached under m4 at 12.35 s (b). No demand has a value there. A run without `travel` gives the "
        "displacement that is needed."
    )
    assert sentences.travel_sentence(planted()) == ""
    stopped = [EndedMotion("b", "m4", 1.0, "rim reached", 3.0)]
    assert sentences.travel_sentence(replace(two_bounds(), ended=stopped)) == ""


def cells_of(found: EnsembleResult) -> list[tuple[str, ...]]:
    """Mean, largest value, its motion and the number of motions of the displacement, by bound and of the envelope."""
    shown = [row for row in rows.make_demand_rows(found, 1.0) if row.name == "isolator displacement"]
    return [(row.cells[0], row.cells[-1], row.motion, row.motions) for row in shown]


def test_what_a_motion_without_a_value_leaves_open_is_said_and_is_no_table_of_none() -> None:
    """Three motions moved 0.1, 0.2 and 0.3 m, the fourth the travel of 0.5 m at least."""
    upper = ("250 ± 1", "400 ± 1", "m4", "4")
    assert cells_of(two_bounds()) == [("≥ 275", "≥ 500", "", "3 of 4"), upper, ("≥ 275", "≥ 500", "", "")]
    rim = [replace(each, reasons={"rim reached": 1}) if each.reasons else each for each in two_bounds().stripes]
    envelope = ("≥ 250 ± 1", "≥ 400 ± 1", "m4", "")
    assert cells_of(replace(two_bounds(), stripes=rim)) == [
        ("200 (of 3)", "≥ 300", "m3", "3 of 4"), upper, envelope,
    ]  # fmt: skip
    numbers = {name: Estimate(value, 0.0) for name, value in zip("abcd", (3.0, math.nan, 1.0, 2.0))}
    force = summarize_motions(("b", "support_force_min", None, "exact", "N", 1.0), numbers, {"rim reached": 1})
    assert (force.mean.value, [each.value for each in force.known], force.known_motion) == (None, [2.0, 1.0], "c")
    told = rows.summarize_demand(planted().structures[0], force)
    assert (told.marks, told.motion, told.numbers[-1].value) == ((" (of 3)", "", "", "", "≤ "), "c", 1.0)
    whole = summarize_motions(("b", "displacement", None, "exact", "m", 1.0), {"a": Estimate(1.0, 0.0)}, {})
    assert (list(whole.known), rows.summarize_demand(planted().structures[0], whole).marks) == ([], ("",) * 5)


def test_checks_by_hand_are_those_of_the_report_and_show_a_number_that_is_wrong(
    folder: Path, found: EnsembleResult
) -> None:
    checks = {(bound, check.what): check for bound, check in hand_checks.list_hand_check_rows(found)}
    assert len(checks) == 10
    weight = checks["lower bound", "weight"]
    assert (weight.by_hand, weight.found, weight.verdict) == ("882.9 kN", pytest.approx(882.9), "0.00 %")
    for (_, what), check in checks.items():
        assert check.verdict in ("0.00 %", "inside"), what
    structure = replace(found.structures[0], weight=2.0 * found.structures[0].weight)
    wrong = {check.what: check.verdict for check in hand_checks.list_hand_checks(found, structure)}
    assert (wrong["weight"], wrong["dead loads of all supports together"]) == ("+100.00 %", "−50.00 %")
    assert next(verdict for what, verdict in wrong.items() if "base shear" in what).startswith("outside by ")
    assert hand_checks.HandCheck("weight", "", 28252.8, 28252.8, 28252.8, "kN").by_hand == "28253 kN"
    own = [row for row in table(folder) if (row["bound"], row["model"]) == ("lower bound", "exact")]
    drift = checks["lower bound", "largest drift below roof"]
    shear, drifted = (1e3 * max(float(row[name]) for row in own) for name in ("story_shear_3 [N]", "drift_3 [m]"))
    stories = [rows.make_profile_rows(found, name, 1.0) for name in ("story_shear", "drift")]
    roofs = (next(row for row in each if (row.bound, row.name) == ("lower bound", "below roof")) for each in stories)
    shown = [row.cells[-1].partition(" ±")[0] for row in roofs]
    assert (f"V = {shown[0]} kN", f"{shown[1]} mm") == (drift.formula.split(", ")[1], drift.in_report), "in the tables"
    assert (drift.low, drift.high) == pytest.approx((shear / 25e6, shear / 20e6), rel=1e-4), "x and y"
    assert drift.found == pytest.approx(drifted, rel=1e-4)
    damped = replace(found.structures[0].building, modal_damping=[[0.05, 0.2], [0.05, 0.3]])  # type: ignore[type-var]
    (drift,) = (
        each
        for each in hand_checks.list_hand_checks(found, replace(found.structures[0], building=damped))
        if "drift" in each.what
    )
    assert drift.low == pytest.approx(shear / 25e6 / math.hypot(1.0, 0.6), rel=1e-4)
    moved = max(own, key=lambda row: float(row["displacement [m]"]))
    slope = math.tan(math.asin(float(moved["displacement [m]"]) / 2.0))
    base = checks["lower bound", f"base shear under {moved['motion']}"]
    assert base.low == pytest.approx(882.9 * math.hypot(slope, 0.024), rel=1e-3)


def test_the_displaced_weight_is_worded_about_the_contact_points_and_once() -> None:
    structure = planted().structures[0]
    assert structure.building is not None
    sphere = replace(structure, building=replace(structure.building, sphere_radius=0.5))
    said = sentences.displaced_weight_sentence(sphere)
    assert "W × (R / ρ × displacement + drift) about the contact points" in said
    assert said.endswith("ρ = 2 m, r = 0.5 m, R = ρ + r = 2.5 m, R / ρ = 1.25.")
    assert "R / ρ = 1." in sentences.displaced_weight_sentence(structure), "no radius of a sphere"
    flat = replace(structure, building=replace(structure.building, radius=None))
    assert "W × (displacement + drift)" in sentences.displaced_weight_sentence(flat)
    assert "ρ" not in "".join(sentences.DEFINITIONS), "the definitions refer to it"


def test_damping_in_proportion_to_the_stiffness_is_said_and_no_other_is() -> None:
    structure = planted().structures[0]
    assert structure.building is not None

    def said(*ratios: float) -> str:
        building = replace(
            structure.building, fixed_base_period=[[0.5, 0.2]] * 2, modal_damping=[[*ratios[:2]], [*ratios[2:]]]
        )  # type: ignore[type-var]
        return sentences.damping_sentence(replace(structure, building=building))

    assert "c = 2 ζ k / ω₁ with ζ = 4 % in the first mode" in said(0.04, 0.1, 0.04, 0.1)
    assert said(0.04, 0.1, 0.04, 0.04) == ""
    assert said(0.0, 0.0, 0.0, 0.0) == ""


def test_support_forces_say_of_how_many_motions_they_are() -> None:
    known, none = Statistic(1e3, 0.0), Statistic(None, None)
    about = SupportExtremes("b", 1, 3.0, 2.0, "exact", 3, known, "m1", known, "m2", none)
    some = replace(planted(), supports=[about])
    (said,) = sentences.support_sentences(some)
    assert said.startswith("By the equations and statics, 3 of 4 motions: largest force 1 kN")
    assert said.endswith("The worst may be under a motion without a value.")
    whole = replace(planted(), supports=[replace(about, motions=4)])
    (said,) = sentences.support_sentences(whole)
    assert said.startswith("By the equations and statics, 4 motions: ")
    assert "may be" not in said
    (said,) = sentences.support_sentences(
        replace(two_bounds(), supports=[about, replace(about, structure="c", motions=4)])
    )
    assert "statics, 3 of 4 motions of the b, 4 motions of the c: " in said
    assert said.endswith("The worst may be under a motion without a value."), "of one bound, and so of all"
    (said,) = sentences.support_sentences(replace(planted(), supports=[replace(about, model="spatial", motions=2)]))
    assert said.startswith("By the spatial engine, 2 of 4 motions: ")
    shown = page.render_ensemble_page(some)
    assert '<td class="number">3 of 4</td>' in shown


def test_every_motion_of_every_bound_is_a_row_with_its_outcome() -> None:
    found = two_bounds()
    assert rows.make_motion_heads(found) == ["isolator displacement, mm"]
    read = {(motion, bound): (cells, outcome) for motion, bound, cells, outcome in rows.make_motion_rows(found)}
    assert len(read) == 8
    assert read["m4", "b"] == (["none"], "travel reached")
    assert read["m4", "c"] == (["400"], "ok")
    scales = {sentences.word_heading(replace(planted(), scales=each, stripes=[])) for each in ((1.0,), (2.0,), (0.5, 1.0))}
    assert scales == {"A <block>: 4 motions", "A <block>: 4 motions, scale 2", "A <block>: 4 motions, scale 1"}


def test_what_is_not_modeled_is_one_list_in_the_report_and_in_the_guide() -> None:
    guide = (Path(__file__).parents[3] / "docs/guide/building.md").read_text(encoding="utf-8")
    listed = guide.partition("## What is not modeled")[2].partition("\n## ")[0]
    items = [" ".join(item.split()) for item in listed.split("\n- ")[1:]]
    assert len(items) == len(sentences.NOT_MODELED)
    for item, line in zip(items, sentences.NOT_MODELED):
        assert item.startswith(line), line


def test_how_many_motions_have_a_vertical_component_is_said_where_it_is_known() -> None:
    one, two = (
        GroundMotion(name, 10.0, 2.0, components=[GroundComponent(axis, 2.0, 0.1) for axis in axes])
        for name, axes in (("m1", "xy"), ("m2", "xyz"))
    )
    for suite, said in (([one, two], ": 1 of 2 motions here."), ([one, one], ": none of 2 motions here."),
                        ([two, GroundMotion("m3", 10.0, 2.0)], ".")):  # fmt: skip
        lines = sentences.list_not_modeled(replace(planted(), suite=suite))
        assert f"Vertical ground motion, except where the record has z{said}" in lines
        assert len(lines) == len(sentences.NOT_MODELED)


def test_the_recentering_ratio_is_defined_where_it_stands(folder: Path, found: EnsembleResult) -> None:
    lower, upper = found.structures
    assert lower.isolator is not None
    assert upper.isolator is not None
    for ratios, said in (
        ((1.2, 0.9), " It is below 1 (upper bound): the platform may stay there."),
        ((0.8, 0.9), " It is below 1 (lower bound, upper bound): the platform may stay there."),
        ((1.2, 1.0), ""),
    ):
        stated = [replace(each, isolator=replace(each.isolator, restoring=ratio))
                  for each, ratio in zip(found.structures, ratios)]  # fmt: skip
        line = sentences.restoring_sentence(replace(found, structures=stated))
        head = "The re-centering ratio is the restoring force over the friction force at that displacement."
        assert line == head + said
    assert sentences.restoring_sentence(found) in (folder / "out" / "index.html").read_text(encoding="utf-8")
    assert sentences.restoring_sentence(planted()) == "", "no isolator"


def test_the_literal_supremum_is_a_row_only_where_it_differs(folder: Path, found: EnsembleResult) -> None:
    """A planted supremum that differs at the roof alone; then at no floor, and at every floor."""

    def profile(suprema: dict[int, float]) -> tuple[list[str], str]:
        stripes = [each for each in found.stripes if each.quantity != "acceleration_supremum"]
        for each in found.list_demands_of_bodies("mine[lower bound]", "acceleration"):
            larger = Statistic(suprema.get(each.body or 0, 1.0) * (each.mean.value or 0.0), each.mean.error)
            stripes.append(replace(each, quantity="acceleration_supremum", mean=larger))
        alone = replace(found, stripes=[s for s in stripes if s.structure == "mine[lower bound]"])
        ((_, shown, note),) = [
            each for each in page._height_context(alone, LostParts())["tables"] if "supremum" in each[0]
        ]
        return [row.name for row in shown], note

    assert profile({3: 1.1})[0] == ["roof"]
    assert profile({3: 1.1})[1].startswith("At the floors that are left out the literal supremum is the acceleration")
    assert profile({})[0] == []
    assert profile({})[1].startswith("At every floor the literal supremum is the acceleration as integrated")
    assert profile({1: 1.1, 2: 1.1, 3: 1.1}) == (["roof", "body 2", "deck"], "")


def test_plots_and_tables_name_the_floors_and_mark_code(folder: Path, found: EnsembleResult) -> None:
    titles = [make()["title"] for make in panels.make_floor_spectra_panels(found)]
    assert titles == ["floor spectrum: deck", "floor spectrum: roof"]
    assert str(page.mark_code("a `b` <c>")) == "a <code>b</code> &lt;c&gt;"
    text = (folder / "out" / "index.html").read_text(encoding="utf-8")
    assert "state it by <code>offset</code> at" in text
    assert ">peak velocity x, m/s<" in text
    (ground,) = [make()["plot"] for make in panels.make_ground_panels(found)]
    ticks = {text for _, text in ground["x"]["ticks"]}
    assert {"0.1", "0.2", "0.5", "1", "2"} <= ticks
    assert len({each["color"] for each in ground["series"]}) == 2, "a motion and the mean"


def test_one_duration_is_no_range() -> None:
    assert sentences.ground_sentence(planted()).endswith("; duration 10 s.")
    unlike = [GroundMotion("m1", 30.0, 3.5), GroundMotion("m2", 10.0, 2.0), GroundMotion("m3", 20.0, 3.0)]
    assert sentences.ground_sentence(replace(planted(), suite=unlike)) == (
        "Peaks from 0.204 g to 0.357 g, resultant of x and y, with the factors; durations from 10 to 30 s."
    )


def test_numbers_and_names_of_sentences_are_those_of_their_bound() -> None:
    chosen = [
        ChosenMotion("b", "m3", 1.0, ["displacement"], {"spatial": "ok", "small": "step limit"}),
        ChosenMotion("c", "m4", 1.0, ["base shear", "median"], {"spatial": "step limit"}),
        ChosenMotion("c", "m2", 1.0, ["asked for"], {"spatial": "ok"}),
    ]
    found = replace(two_bounds(), engine=EngineMotions("spatial", chosen, 0.02))
    assert sentences.engine_sentences(found) == [
        "The spatial engine computed, b: m3 (displacement).",
        "The spatial engine computed, c: m4 (base shear, median; step limit); m2 (asked for).",
        "The engine was asked for largest accelerations to 2 %.",
    ]
    numbers = {
        ("b", 1, 3.0, 2.0): ((-2e3, "m3"), (7e3, "m4"), 0.002), ("c", 2, -3.5, 2.5): ((1e3, "m4"), (9e3, "m1"), 0.0),
        ("c", 3, 0.5, -2.5): ((2e3, "m2"), (8e3, "m2"), 0.001),
    }  # fmt: skip
    supports = [
        SupportExtremes(*at, "spatial", 2, Statistic(low, 20.0), one, Statistic(high, 30.0), two, Statistic(gap, 0.0))
        for at, ((low, one), (high, two), gap) in numbers.items()
    ]
    assert sentences.support_sentences(replace(found, supports=supports)) == [
        "By the spatial engine, 2 of 4 motions of each bound: largest force 9 ± 0.03 kN, support 2 at [-3.5, 2.5] m "
        "(m1, c); smallest force -2 ± 0.02 kN, support 1 at [3, 2] m (m3, b); largest uplift 2 mm at support 1."
    ]


def test_models_stand_beside_each_other_on_the_motions_that_all_have(capsys: pytest.CaptureFixture[str]) -> None:
    (row,) = trust.make_model_ratio_rows(planted())
    assert (row.motions, row.value) == (("m3", "m4"), pytest.approx(0.35)), "the other motions are in no mean"
    assert {key: ratio.mean for key, ratio in row.ratios.items()} == pytest.approx(
        {"small": 0.9, "translational": 1.002, "spatial": 1.05}
    )
    assert [row.ratios[key].brief for key in ("small", "translational", "spatial")] == [
        "−10.00 %",
        "+0.20 %",
        "+5.00 %",
    ]
    assert row.ratios["spatial"].text == "+5.00 %", "no range of equal ratios"
    found = planted()
    terminal.print_engine(make_wide_console(), replace(found, engine=replace(found.engine, motions=found.engine.motions[:1])))
    assert capsys.readouterr().out.splitlines()[:3] == [
        "The spatial engine computed: m3 (largest displacement).",
        "The engine was asked for largest accelerations to 1 %.",
        "b, mean difference from the exact equations on 2 motions:",
    ]


def test_the_ratio_of_the_engine_is_extended_to_the_suite_with_its_spread() -> None:
    found = planted()
    curves = [
        replace(each, values=(0.44,)) if (each.model, each.motion) == ("spatial", "m4") else each
        for each in found.curves
    ]
    ((_, ratio, cells),) = trust.extrapolate_ratios(replace(found, curves=curves))
    assert (ratio.mean, ratio.smallest, ratio.largest) == pytest.approx((1.075, 1.05, 1.1))
    mean, share, largest = 0.25 * 1.075, 1e3 * 0.386 * 1.075, 1e3 * 0.4 * 1.075
    assert cells == [
        "mm", f"{1e3 * mean:.4g} ({250 * 1.05:.4g} to {250 * 1.1:.4g})",
        f"{share:.4g} ({386 * 1.05:.4g} to {386 * 1.1:.4g})", f"{largest:.4g} ({400 * 1.05:.4g} to {400 * 1.1:.4g})",
    ]  # fmt: skip


def test_no_statistic_mixes_motions_of_the_equations_with_those_of_the_engine(found: EnsembleResult) -> None:
    assert {each.model for each in found.stripes} == {"exact"}, "no fractiles of the engine's few motions"
    named = {each.name: each for each in found.structures}
    shown = rows.make_demand_rows(found, 1.0)
    of_engine = "uplift of a support", "support displacement, with torsion"
    uplift = [row for row in shown if row.name in of_engine]
    assert [row.cells[:4] for row in uplift] == [("–",) * 4] * 2 * len(named)
    for row in uplift:
        assert "of 4 (spatial engine)" in row.motions
    assert all("engine" not in row.motions for row in shown if row.name not in of_engine)
    lifts = [
        DemandCurve("b", "uplift", None, "spatial", name, (1.0,), (value,), (None,))
        for name, value in (("m2", None), ("m3", 2e-3), ("m4", 5e-3), ("m1", 1e-3))
    ]
    row = demand_row(replace(planted(), curves=lifts), of_engine[0])
    assert (row.cells[4], row.motion, row.motions) == ("5", "m4", "3 of 4 (spatial engine)")


def test_a_fractile_beyond_the_outermost_motions_is_left_out() -> None:
    for motions, expected in ((2, ["–", "150", "–"]), (3, ["–", "200", "–"]), (4, ["114", "250", "386"])):
        row = demand_row(planted(motions=motions), "isolator displacement")
        assert list(row.cells[1:4]) == expected


def test_the_envelope_is_the_worst_of_the_bounds_in_every_column() -> None:
    one = planted()
    other = [replace(each, structure="c", mean=Statistic(0.2, 0.0), largest=Statistic(0.9, 0.0), largest_motion="m1")
             for each in one.stripes]  # fmt: skip
    both = replace(
        one, structures=[*one.structures, replace(one.structures[0], name="c")], stripes=[*one.stripes, *other]
    )
    envelope = demand_row(both, "isolator displacement", "envelope")
    assert (envelope.cells[0], envelope.cells[-1], envelope.motion) == ("250 ± 1", "900", "m1")
    assert (envelope.bounds, envelope.every_bound) == (("b", "b", "b", "b", "c"), ""), "each cell has its own bound"
    assert "<small>c</small>" in page.render_ensemble_page(both)
    lost = [replace(each, largest=Statistic(None, None), answered=3, reasons={"travel reached": 1}) for each in other]
    envelope = demand_row(replace(both, stripes=[*one.stripes, *lost]), "isolator displacement", "envelope")
    assert (envelope.cells[-1], envelope.motion, envelope.every_bound) == ("≥ 400 ± 1", "m4", "b")


def test_bounds_of_different_weight_are_compared_in_the_unit_that_is_read() -> None:
    """The heavier has the larger force, the lighter the larger share; mean and largest share are of two bounds."""
    one = planted()
    shears = [
        replace(one.stripes[0], structure=name, quantity="base_shear", unit="N", mean=Statistic(mean, 0.0),
                largest=Statistic(largest, 0.0))
        for name, mean, largest in (("b", 300.0, 400.0), ("c", 700.0, 1000.0), ("d", 310.0, 380.0))
    ]  # fmt: skip
    weights = {"b": 1e3, "c": 4e3, "d": 1e3}
    structures = [replace(one.structures[0], name=name, weight=weight) for name, weight in weights.items()]
    found = replace(one, structures=structures, stripes=shears)
    force, share = (row for row in rows.make_demand_rows(found, 1.0) if row.bound == "envelope")
    assert (force.cells[0], force.cells[-1], force.motion) == ("0.7", "1", "m4")
    assert (share.cells[0], share.cells[-1], share.motion) == ("31", "40", "m4")
    assert [(row.bounds[0], row.bounds[-1]) for row in (force, share)] == [("c", "c"), ("d", "b")]
    said = sentences.answer_sentence(found)
    assert "mean 30 % of the weight, largest 40 % of the weight (b, m4)" in said


def test_the_first_sentence_says_what_has_no_value_before_what_has() -> None:
    assert sentences.answer_sentence(planted()) == (
        "Isolator displacement: mean 250 mm, largest 400 mm = 80 % of the travel (m4). Outcomes by the equations: 4 ok."
    )
    found = planted()
    curves = [replace(each, values=(None,)) if each.motion == "m4" else each for each in found.curves]
    said = sentences.answer_sentence(replace(found, curves=curves, outcomes={"ok": 3, "travel reached": 1}))
    assert said.startswith("No value under m4 (b). ")
    assert said.endswith("Outcomes by the equations: 3 ok, 1 travel reached.")


def test_a_platform_below_its_contact_is_said() -> None:
    structure = planted().structures[0]
    assert structure.building is not None
    below = replace(structure, building=replace(structure.building, heights=(-1.84,)))
    assert sentences.below_contact_sentence(below).startswith(
        "The center of mass of the deck is 1.84 m below the sliding contact"
    )
    assert sentences.below_contact_sentence(structure) == ""
    assert (
        sentences.below_contact_sentence(replace(structure, building=replace(structure.building, heights=(0.5,)))) == ""
    )


def test_every_motion_is_a_dot_with_its_error_by_both_sides() -> None:
    found = planted()
    curves = [replace(each, errors=(0.01,)) for each in found.curves]
    (drawn,) = (make() for make in panels.make_isolator_panels(replace(found, curves=curves)))
    series = drawn["plot"]["series"]
    dots = [each for each in series if each.get("color") == 0 and "one motion" in each["name"]]
    assert [each["y"][0] for each in dots] == pytest.approx([100.0, 200.0, 300.0, 400.0])
    assert [(each["low"][0], each["high"][0]) for each in dots[:1]] == [(pytest.approx(90.0), pytest.approx(110.0))]
    by_engine = [each for each in series if each.get("color") == "ink" and each.get("marks")]
    assert [each["y"][0] for each in by_engine] == pytest.approx([315.0, 420.0])
    assert by_engine[0]["name"] == "spatial engine"
    assert not any("at the travel" in each["name"] for each in series), "none reaches it"


def test_the_median_the_travel_and_the_limit_are_told_apart_from_the_motions() -> None:
    """A motion at the travel is an arrow there, in the slot that its dot would have."""
    (check,) = list_verdicts(check_limits(planted(), {"b": DemandLimits(displacement=0.6, statistic="mean")}))
    found = replace(two_bounds(), limits=[check, check])
    (drawn,) = (make() for make in panels.make_isolator_panels(found))
    series = {each["name"]: each for each in drawn["plot"]["series"] if each.get("legend", True)}
    assert [name for name in series if name.startswith("b")] == [
        "b: one motion", "b: at the travel", "b: median, 16 to 84 %", "b: mean",
    ]  # fmt: skip
    dots = [each for each in drawn["plot"]["series"] if each["name"] == "b: one motion"]
    arrow, median = series["b: at the travel"], series["b: median, 16 to 84 %"]
    assert (arrow["x"], arrow["y"], dots[3]["y"]) == (dots[3]["x"], [500.0], [None])
    assert len({arrow["marks"], median["marks"], dots[0]["marks"], series["b: mean"]["marks"]}) == 4
    assert series["c: mean"]["y"] == [250.0]
    assert "diamond" in panels.plots_note(found)
    assert "diamond" not in panels.plots_note(two_bounds()), "no limit is on the mean"
    assert (series["travel"]["y"], series["limit (mean)"]["y"]) == ([500.0] * 2, [600.0] * 2)
    assert drawn["plot"]["y"]["range"][1] > 600.0
    scaled = replace(found, scales=(0.5, 1.0), curves=[
        replace(each, scales=(0.5, 1.0), values=(0.05, *each.values), errors=(0.0, *each.errors))
        for each in found.curves
    ])  # fmt: skip
    (drawn,) = (make() for make in panels.make_isolator_panels(scaled))
    arrow = next(each for each in drawn["plot"]["series"] if "at the travel" in each["name"])
    assert (arrow["x"], arrow["y"]) == ([1.0], [500.0])


def test_moments_stand_where_they_are_taken_and_shears_in_the_middle_of_their_stories(found: EnsembleResult) -> None:
    expected = {
        "overturning moment": [0.0, 0.5, 3.5],
        "story shear": [0.25, 2.0, 5.0],
        "drift over the height of the story": [2.0, 5.0],
    }
    drawn = [make() for make in panels.make_height_panels(found)]
    for title, heights in expected.items():
        (panel,) = (each for each in drawn if each["title"] == f"{title} over the height")
        for line in panel["plot"]["series"]:
            assert line["y"] == pytest.approx(heights), title
        assert panel["plot"]["series"][0]["titles"][-1].startswith("below roof: ")


def test_profiles_have_the_height_on_the_vertical_axis(found: EnsembleResult) -> None:
    drawn = next(
        each for each in (make() for make in panels.make_height_panels(found)) if "acceleration" in each["title"]
    )
    assert drawn["plot"]["y"]["title"] == "height above the sliding contact, m"
    median = next(each for each in drawn["plot"]["series"] if each["name"] == "upper bound, 50 %")
    assert median["y"] == pytest.approx([0.5, 3.5, 6.5])
    expected = [found.find_demand("mine[upper bound]", "acceleration", body) for body in (1, 2, 3)]
    assert median["x"] == pytest.approx([each.fractiles[1].value / GRAVITY for each in expected])  # type: ignore[union-attr, operator]
    assert [each.partition(":")[0] for each in median["titles"]] == ["deck", "body 2", "roof"]


@pytest.mark.parametrize(("share", "name"), [(1.5, "limit (mean)"), (2.5, "limit (mean): {:.4g} g, beyond the axis")])
def test_profiles_have_a_line_at_the_limit(found: EnsembleResult, share: float, name: str) -> None:
    """A limit that is far off the axis is said in the legend, and the mean is drawn that it is on."""
    largest = max(stripe.fractiles[2].value or 0.0 for stripe in found.stripes if stripe.quantity == "acceleration")
    limits = {each.name: DemandLimits(acceleration=share * largest, statistic="mean") for each in found.structures}
    judged = replace(found, limits=list_verdicts(check_limits(found, limits)))
    drawn = next(each for each in (make() for make in panels.make_height_panels(judged)) if "accel" in each["title"])
    *lines, limit = drawn["plot"]["series"]
    assert limit["name"] == name.format(share * largest / GRAVITY)
    assert (limit["x"], limit["y"]) == (pytest.approx([share * largest / GRAVITY] * 2), [0.5, 6.5])
    assert (drawn["plot"]["x"]["range"][1] > limit["x"][0]) == (share < 2.0)
    means = next(each for each in lines if each["name"] == "upper bound, mean")
    stripes = [found.find_demand("mine[upper bound]", "acceleration", body) for body in (1, 2, 3)]
    assert means["x"] == pytest.approx([each.mean.value / GRAVITY for each in stripes if each and each.mean.value])


def fails(*rest: Any) -> None:
    raise RuntimeError("planted")


@pytest.mark.parametrize(
    ("owner", "name", "lost"),
    [
        (panels, "_demand_panel", [f"plot {number}" for number in range(1, 5)]),
        (panels, "_profile_panel", [f"plot {number}" for number in range(1, 5)]),
        (page, "make_model_ratio_rows", ["section trust"]),
        (page, "make_demand_rows", ["section demands"]), (sentences, "support_sentences", ["section supports"]),
        (sentences, "answer_sentence", ["answer"]), (page, "extrapolate_ratios", ["section extended"]),
    ],
)  # fmt: skip
def test_a_part_that_fails_costs_one_line(
    found: EnsembleResult,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    owner: Any,
    name: str,
    lost: list[str],
) -> None:
    whole = page.render_ensemble_page(found)
    monkeypatch.setattr(owner, name, fails)
    without = page.render_ensemble_page(found)
    said = capsys.readouterr().err.splitlines()
    assert said == [f"{part} could not be shown: RuntimeError: planted" for part in lost]
    assert without.count("RuntimeError: planted") >= 1
    assert without.count("<section id=") == whole.count("<section id="), "its place says what is lost"
    assert len(without) > 0.4 * len(whole)


def test_a_page_that_fails_costs_neither_tables_nor_files(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("comparison.analyses.ensemble.command.render_ensemble_page", fails)
    monkeypatch.setattr("comparison.analyses.ensemble.terminal.make_demand_rows", fails)
    assert run("mine.toml", "--engine", "0", "--out", "lost") == 0
    said = capsys.readouterr()
    assert "index.html could not be shown: RuntimeError: planted" in said.err
    assert "demands could not be shown: RuntimeError: planted" in said.err
    assert "Ensemble: lost/summary.json, lost/ensemble.csv\n" in said.out
    assert json.loads((folder / "lost" / "summary.json").read_text())["outcomes"] == {"ok": 4}


def test_a_report_of_another_kind_is_refused_and_not_shown(
    folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """No study shows an ensemble, and neither takes the place of the other."""
    quick_figures(monkeypatch)
    analyses_are(monkeypatch)
    words = [*SMALL, "--out", "out"]
    assert study(words, fake_hierarchy(), ThreadPoolExecutor) == 2
    rule = "--out = 'out': holds the page of `ensemble`, of this building or another: give a directory of its own"
    assert rule in capsys.readouterr().err
    assert study([*SMALL, "--out", "study"], fake_hierarchy(), ThreadPoolExecutor) == 0
    capsys.readouterr()
    assert run("mine.toml", "--engine", "0", "--out", "study") == 2
    assert "holds the page of `run`" in capsys.readouterr().err
    assert "two floors on four pendulums" not in (folder / "study" / "index.html").read_text(encoding="utf-8")
