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


def test_the_building_is_on_the_page_as_it_was_read(folder: Path, found: EnsembleResult) -> None:
    text = (folder / "out" / "index.html").read_text(encoding="utf-8")
    lower, upper = (each.building for each in found.structures)
    assert lower is not None
    assert upper is not None
    assert (list(lower.friction), list(upper.friction)) == (pytest.approx([0.024, 0.048]), pytest.approx([0.045, 0.09]))
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


def test_a_demand_of_the_isolator_is_plotted_unless_it_is_zero_in_every_motion() -> None:
    for values, plots in (((0.0, 0.2), 2), ((0.0, 0.0), 1)):
        at_scales = {"scales": (1.0, 2.0), "values": values, "errors": (0.0, 0.0)}
        residual = replace(planted().curves[0], quantity="residual", **at_scales)
        assert len(panels.make_isolator_panels(replace(planted(), curves=[*planted().curves, residual]))) == plots


def test_a_smallest_support_force_is_no_demand_that_turning_changes() -> None:
    """A share of a force near zero: it has a clause of its own."""
    forces = {"exact": (9.0, 8.0, 4.0, 2.0), "spatial": (9.0, 8.0, 3.6, 1.0), "translational": (9.0, 8.0, 4.0, 2.0)}
    said = trust.model_ratio_sentence(with_demand(planted(), "support_force_min", None, **forces))
    assert said.endswith(
        "bodies that turn on their supports change a demand by up to 4.8 % (isolator displacement, m3), and the "
        "smallest support force, against statics, by up to 50 % (m4)."
    )


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


def test_statistics_over_several_places_are_of_the_largest_value_of_every_motion() -> None:
    """The story of the largest mean is not that of the largest value."""
    found = replace(planted(), structures=[replace(planted().structures[0], bodies=3)])
    found = with_demand(found, "drift_ratio", 2, exact=(0.001, 0.001, 0.001, 0.009), spatial=(0.001,) * 4)
    found = with_demand(found, "drift_ratio", 3, exact=(0.004, 0.004, 0.004, 0.005), spatial=(0.004,) * 4)
    errors = [replace(each, errors=(0.0005 if each.body == 2 else 0.0055,)) for each in found.curves]
    largest = rows.find_largest_over_bodies_by_motion(replace(found, curves=errors), "b", "drift_ratio", "exact", 1.0)
    assert (largest["m4"][0].error, largest["m4"][1]) == (pytest.approx(0.0015), 2), "the other story may be the worst"
    unknown = [
        replace(each, values=(None,)) if (each.quantity, each.body, each.motion) == ("drift_ratio", 3, "m1") else each
        for each in found.curves
    ]
    lost = [replace(each, answered=3, reasons={"rim reached": 1}) if each.body == 3 else each for each in found.stripes]
    about = found.structures[0], "drift_ratio", 1.0
    told = rows.summarize_over_bodies(replace(found, curves=unknown, stripes=lost), *about)
    assert (told and told.reasons) == {"rim reached": 1}, "of the body that lacks a motion"
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
    lost = [replace(each, values=(None,)) if each.structure == "c" and each.body else each for each in curves]
    for length, bounds in ((8, ("c" * 8, "b")), (9, ())):
        parts: dict[str, Any] = {
            part: [replace(each, **{key: "c" * length}) if getattr(each, key) == "c" else each for each in rest]
            for part, key, rest in (("structures", "name", names), ("curves", "structure", curves),
                                    ("stripes", "structure", stripes))}  # fmt: skip
        row = demand_row(replace(both, **parts), "largest drift ratio", "envelope")
        assert row.bounds[::4] == bounds, "a name that is too long hides all"
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
    assert "at least" not in sentences.answer_sentence(planted())
    assert " alone" not in sentences.answer_sentence(planted())
    rim = [replace(each, reasons={"rim reached": 1}) if each.reasons else each for each in two_bounds().stripes]
    said = sentences.answer_sentence(replace(two_bounds(), stripes=rim))
    assert ("at least the travel" in said, "(c alone, m4)" in said) == (False, True)
    stopped = [EndedMotion("b", "m4", 1.0, "rim reached", 3.0)]
    assert sentences.travel_sentence(replace(two_bounds(), ended=stopped)) == ""
    one, two = two_bounds().structures
    other = replace(two, building=replace(two.building, travel=0.4))
    both = [replace(two_bounds().stripes[0], structure=name) for name in "bc"]
    said = sentences.answer_sentence(replace(two_bounds(), structures=[one, other], stripes=both))
    assert "displacement: at least the travel, 500 mm (b); at least the travel, 400 mm (c); no demand is known" in said
    for count, named in ((3, "m1, m2, m3 (b)"), (4, "4 motions (b)")):
        lost = [replace(each, values=(None,)) if int(each.motion[1]) <= count else each for each in planted().curves]
        assert f"No value under {named}." in sentences.answer_sentence(replace(planted(), curves=lost))
    alike = [planted().stripes[0], two_bounds().stripes[1]]
    assert "(b, m4)" in sentences.answer_sentence(replace(two_bounds(), stripes=alike)), "the first of equal bounds"


def cells_of(found: EnsembleResult) -> list[tuple[str, ...]]:
    """Mean, largest value, its motion and the number of motions of the displacement, by bound and of the envelope."""
    shown = [row for row in rows.make_demand_rows(found, 1.0) if row.name == "isolator displacement"]
    return [(row.cells[0], row.cells[-1], row.motion, row.motions) for row in shown]


def test_what_a_motion_without_a_value_leaves_open_is_said_and_is_no_table_of_none() -> None:
    """Three motions moved 0.1, 0.2 and 0.3 m, the fourth the travel of 0.5 m at least."""
    upper = ("250 ± 1", "400 ± 1", "m4", "4")
    rim = [replace(each, reasons={"rim reached": 1}) if each.reasons else each for each in two_bounds().stripes]
    envelope = ("≥ 250 ± 1", "≥ 400 ± 1", "m4", "")
    assert cells_of(replace(two_bounds(), stripes=rim)) == [
        ("200 (of 3)", "≥ 300", "m3", "3 of 4"), upper, envelope,
    ]  # fmt: skip
    both = [replace(each, reasons={"rim reached": 1, "travel reached": 1}) if each.reasons else each for each in rim]
    assert cells_of(replace(two_bounds(), stripes=both))[0] == ("200 (of 3)", "≥ 300", "m3", "3 of 5"), "not all at it"
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
    for (_, what), check in checks.items():
        assert check.verdict in ("0.00 %", "inside"), what
    structure = replace(found.structures[0], weight=2.0 * found.structures[0].weight)
    wrong = {check.what: check.verdict for check in hand_checks.list_hand_checks(found, structure)}
    assert (wrong["weight"], wrong["dead loads of all supports together"]) == ("+100.00 %", "−50.00 %")
    assert next(verdict for what, verdict in wrong.items() if "base shear" in what).startswith("outside by ")
    modes = replace(found.structures[0].building, modal_damping=[[0.01, 0.02, 0.03, 0.04], [0.02, 0.03]])
    *_, drift = hand_checks.list_hand_checks(found, replace(found.structures[0], building=modes))
    assert drift.formula.endswith("ζ = 0.03"), "of the third mode"
    assert hand_checks.HandCheck("weight", "", 9999.6, 28252.8, 28252.8, "kN").by_hand == "10000 to 28253 kN"


def test_the_displaced_weight_is_worded_about_the_contact_points_and_once() -> None:
    structure = planted().structures[0]
    assert structure.building is not None
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
    assert said(0.0, 0.0, 0.0, 0.0) == said(0.04, 0.1, 0.04, 0.0) == ""
    assert "ζ = 4 % along x, 6 % along y in the first mode" in said(0.04, 0.1, 0.06, 0.15)


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
    (said,) = sentences.support_sentences(replace(planted(), supports=[replace(about, model="spatial", motions=2)]))
    assert said.startswith("By the spatial engine, 2 of 4 motions: ")
    shown = page.render_ensemble_page(some)
    assert '<td class="number">3 of 4</td>' in shown


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
    both = [replace(planted().structures[0], name=name) for name in ("b", "c")]
    suprema = {"acceleration": 2.0, "acceleration_supremum": 2.0}, {"acceleration": 2.0, "acceleration_supremum": 2.5}
    stripes = [
        replace(planted().stripes[0], structure=each.name, quantity=name, body=1, mean=Statistic(mean, 0.001))
        for each, means in zip(both, suprema)
        for name, mean in means.items()
    ]
    tables = page._height_context(replace(planted(), structures=both, stripes=stripes), LostParts())["tables"]
    rows_of_both = [(row.name, row.bound) for row in tables[-1][1]]
    assert rows_of_both == [("deck", "b"), ("deck", "c"), ("deck", "envelope")], (
        "a floor has all its rows where one differs"
    )


def test_plots_and_tables_name_the_floors_and_mark_code(folder: Path, found: EnsembleResult) -> None:
    assert str(page.mark_code("a `b` <c>")) == "a <code>b</code> &lt;c&gt;"
    text = (folder / "out" / "index.html").read_text(encoding="utf-8")
    assert "state it by <code>offset</code> at" in text
    assert ">peak velocity x, m/s<" in text


def test_numbers_have_four_digits_and_no_power_of_ten() -> None:
    numbers = (-12345.6, None), (9999.6, 2.0), (9999.4, None), (-5.0, 1e-5), (-5.0, 4e-4), (-2e-5, None), (0.0, 0.0)
    texts = ["-12350", "10000 ± 2", "9999", "-5", "-5 ± 0.0004", "-2.0e-05", "0"]
    assert [word_value(*number, 1.0) for number in numbers] == texts


def test_one_duration_is_no_range() -> None:
    assert sentences.ground_sentence(planted()).endswith("; duration 10 s.")
    unlike = [GroundMotion("m1", 30.0, 3.5), GroundMotion("m2", 10.0, 2.0), GroundMotion("m3", 20.0, 3.0)]
    assert sentences.ground_sentence(replace(planted(), suite=unlike)) == (
        "Peaks from 0.204 g to 0.357 g, resultant of x and y, with the factors; durations from 10 to 30 s."
    )


def test_numbers_and_names_of_sentences_are_those_of_their_bound() -> None:
    numbers = {
        ("b", 1, 3.0, 2.0): ((-2e3, "m3"), (7e3, "m4"), 0.002), ("c", 2, -3.5, 2.5): ((1e3, "m4"), (9e3, "m1"), 0.0),
        ("c", 3, 0.5, -2.5): ((2e3, "m2"), (8e3, "m2"), 0.001),
    }  # fmt: skip
    supports = [
        SupportExtremes(*at, "spatial", 2, Statistic(low, 20.0), one, Statistic(high, 30.0), two, Statistic(gap, 0.0))
        for at, ((low, one), (high, two), gap) in numbers.items()
    ]
    assert sentences.support_sentences(replace(two_bounds(), supports=supports)) == [
        "By the spatial engine, 2 of 4 motions of each bound: largest force 9 ± 0.03 kN, support 2 at [-3.5, 2.5] m "
        "(m1, c); smallest force -2 ± 0.02 kN, support 1 at [3, 2] m (m3, b); largest uplift 2 mm at support 1 (b)."
    ]
    down = [replace(each, uplift=Statistic(0.0, 0.0)) for each in supports]
    (said,) = sentences.support_sentences(replace(two_bounds(), supports=down))
    assert said.endswith("; largest uplift 0 mm.")


def test_lists_of_the_report_end_and_sizes_and_heights_are_of_every_body() -> None:
    (structure,) = planted().structures
    stated = (
        ([(7.0, 5.5, 1.0)], (0.0, 1.0)),
        ([(7.0, 5.5, 1.0)] * 2, (0.5, -0.2)),
        ([(7.0, 5.5, 1.0), None], (-0.2, 0.5)),
    )
    read = [replace(structure, building=replace(structure.building, sizes=sizes, heights=at)) for sizes, at in stated]
    assert [sentences.word_plan_sizes(each) for each in read] == ["7 × 5.5", "7 × 5.5, all", "7 × 5.5; not stated"]
    assert [sentences.below_contact_sentence(each) != "" for each in read] == [False, False, True], "of the platform"
    for count, end in ((12, "m12 (a)."), (13, "m12 (a) and 1 more.")):
        chosen = [ChosenMotion("b", f"m{number}", 1.0, ["a"], {}) for number in range(1, count + 1)]
        first, _ = sentences.engine_sentences(replace(planted(), engine=EngineMotions("spatial", chosen)))
        assert first.endswith(end)
    stripe, shown = replace(planted().stripes[0], quantity="uplift", model="spatial"), rows.DemandColumn("", "uplift")
    lifted = replace(planted(), stripes=[stripe], scales=(1.0, 0.5))
    assert [rows.statistics_of_column(lifted, shown, scale, structure) for scale in lifted.scales] == [stripe, None]
    rest, first = (replace(planted().stripes[0], quantity=name) for name in ("base_shear", "displacement"))
    lost = [replace(first, quantity=name, reasons={"rim reached": 1}) for name in ("displacement", "residual")]
    for kept, what in ((lost, "every demand"), ([*lost, rest], "isolator displacement, residual displacement")):
        line, *_ = sentences.missing_sentences(replace(planted(), stripes=kept), structure)
        assert line.endswith(f": {what} (rim reached).")
    for count, end in ((12, ""), (13, " and more")):
        curves = [
            replace(planted().curves[0], motion=f"m{number}", values=(None,), errors=(None,)) for number in range(count)
        ]
        line, *_ = sentences.missing_sentences(replace(planted(), stripes=lost, curves=curves), structure)
        assert f" ({', '.join(f'm{number}' for number in range(12))}{end}): every demand" in line
    held = replace(planted(), curves=[replace(planted().curves[0], values=(0.0,)), *curves[:1]])
    assert sentences.list_motions_without_displacement(held, structure) == ["m0"], "no slide is a displacement of 0"
    assert rows.word_cell(Statistic(2.0, 0.0), 10.0, 4, 5, "support_force_min") == "20 (smallest)"
    assert rows.word_cell(Statistic(None, None), 10.0, 4, 5, "support_force_min") == "none"


def test_a_table_of_models_is_headed_by_the_motions_of_its_first_demand(capsys: pytest.CaptureFixture[str]) -> None:
    found = with_demand(planted(), "support_force_min", None, exact=(9.0, 8.0, 4.0, 2.0), spatial=(9.0, 8.0, 3.6, 1.0))
    fewer = [each for each in found.curves if (each.quantity, each.motion) != ("support_force_min", "m3")]
    terminal.print_engine(make_wide_console(), replace(found, curves=fewer))
    assert "b, mean difference from the exact equations on 2 motions:" in capsys.readouterr().out


def test_models_stand_beside_each_other_on_the_motions_that_all_have(capsys: pytest.CaptureFixture[str]) -> None:
    (row,) = trust.make_model_ratio_rows(planted())
    assert row.ratios["spatial"].text == "+5.00 %", "no range of equal ratios"
    found = planted()
    terminal.print_engine(
        make_wide_console(), replace(found, engine=replace(found.engine, motions=found.engine.motions[:1]))
    )
    assert capsys.readouterr().out.splitlines()[:3] == [
        "The spatial engine computed: m3 (largest displacement).",
        "The engine was asked for largest accelerations to 1 %.",
        "b, mean difference from the exact equations on 2 motions:",
    ]


def test_a_fractile_beyond_the_outermost_motions_is_left_out() -> None:
    for motions, *expected in (
        (1, "–", "100", "–"),
        (2, "–", "150", "–"),
        (3, "–", "200", "–"),
        (4, "114", "250", "386"),
    ):
        row = demand_row(planted(motions=motions), "isolator displacement")
        assert list(row.cells[1:4]) == expected


def test_the_first_sentence_says_what_has_no_value_before_what_has() -> None:
    assert sentences.answer_sentence(planted()) == (
        "Isolator displacement: mean 250 mm, largest 400 mm = 80 % of the travel (m4). Outcomes by the equations: 4 ok."
    )
    found = planted()
    curves = [replace(each, values=(None,)) if each.motion == "m4" else each for each in found.curves]
    said = sentences.answer_sentence(replace(found, curves=curves, outcomes={"ok": 3, "travel reached": 1}))
    assert said.startswith("No value under m4 (b). ")
    assert said.endswith("Outcomes by the equations: 3 ok, 1 travel reached.")


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
    assert all(f"{part} could not be shown: RuntimeError: planted" in without for part in lost)
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
