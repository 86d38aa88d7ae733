"""The report of an ensemble: its page and the paper it prints to, its sentences, and what it refuses."""

import csv
import json
import math
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from browsers import CHROMIUM, LAPTOP, OVERLAPS, PHONE, chromium, opened, unfolded
from fake_models import fake_hierarchy
from playwright.sync_api import Browser
from printed_pages import BEYOND, CUT, as_printed, letters, printed_page
from runs import SMALL

import reference
from comparison.analyses.ensemble import page, panels, rows, sentences, trust
from comparison.analyses.ensemble.command import main
from comparison.analyses.ensemble.quantities import text_of
from comparison.analyses.ensemble.result import (
    STORED,
    BuildingRead,
    ChosenMotion,
    DemandCurve,
    DemandFractile,
    Engine,
    EnsembleResult,
    GroundMotion,
    Statistic,
    Stripe,
    Structure,
)  # fmt: skip
from comparison.run import main as study
from reference.problem import GRAVITY

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
    (place / "suite").mkdir()
    time = np.arange(0.0, 2.0, 0.05)
    lines = ["name,x,y,z,factor,magnitude"]
    for number in (1, 2, 3, 4):
        along_x = 0.5 * (1.0 + number) * np.sin((3.0 + number) * time) * np.exp(-(((time - 1.0) / 0.5) ** 2))
        table = "\n".join(f"{t:.2f},{a:.6f},{(1.5 if number == 2 else 0.5) * a:.6f}" for t, a in zip(time, along_x))
        (place / "suite" / f"m{number}.csv").write_text(f"time [s],ax [m/s^2],ay [m/s^2]\n{table}\n")
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


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with chromium() as browser:
        yield browser


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
            shown = [text_of(value, None, factor) for value in np.quantile(values, [0.16, 0.5, 0.84], method="hazen")]
            assert letters("".join(shown)) in text, (bound, head)
            for value in (np.mean(values), min(values) if "min" in head else max(values)):
                assert letters(text_of(float(value), None, factor)) in text, (bound, head)
        shears = [100.0 * float(row["base_shear [N]"]) / weight for row in own]
        assert letters(text_of(float(np.mean(shears)), None, 1.0)) in text
    for each in found.supports:
        for number in (each.smallest, each.largest):
            assert letters(text_of(number.value, number.error, 1e-3)) in text
    for size in printed.sizes:
        assert size == pytest.approx((210.0, 297.0), abs=0.5)
    assert min(printed.filled[:-1]) > 1.0 / 3.0, printed.filled
    lines = [sentences.answer_sentence(found), trust.trust_sentence(found), *sentences.engine_sentences(found)]
    for line in [*lines, *sentences.support_sentences(found), *sentences.DEFINITIONS]:
        assert letters(line) in text, line


@NO_CHROMIUM
def test_nothing_of_the_report_is_cut_or_overlaps_on_paper_and_phone(folder: Path, browser: Browser) -> None:
    sheet = as_printed(opened(browser, folder / "out" / "index.html", LAPTOP).page)
    assert sheet.evaluate(BEYOND, 186.0 / 25.4 * 96.0) == []
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
    building = reference.describe_building(reference.load_family("mine.toml").scenes[0])
    for value in (f"{building.weight / 1e3:.5g}", f"4, {building.load_per_support / 1e3:.4g} each", "0.5, 3.5, 6.5"):
        assert f">{value}<" in text, value
    assert f"{building.isolated_period[0, 0]:.3g}, " in text
    lower, upper = (each.building for each in found.structures)
    assert lower is not None
    assert upper is not None
    assert (list(lower.friction), list(upper.friction)) == (pytest.approx([0.024, 0.048]), pytest.approx([0.045, 0.09]))
    for structure in found.structures:
        isolator, moved = structure.isolator, found.stripe(structure.name, "displacement")
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
    suite = {each.motion: each for each in found.suite}
    assert (suite["pulse 1"].magnitude, suite["pulse 2"].magnitude) == (6.9, None)
    assert suite["pulse 3"].factor == 1.3
    raw = np.loadtxt(folder / "suite" / "m3.csv", delimiter=",", skiprows=1)
    assert suite["pulse 3"].peak == pytest.approx(1.3 * np.hypot(raw[:, 1], raw[:, 2]).max())


def test_forces_over_the_height_agree_with_those_of_the_supports(found: EnsembleResult) -> None:
    """By hand: moments at the isolator carried by two rows of supports bound the change of a support's force."""
    for structure in found.structures:
        moment, force = (found.stripe(structure.name, name, body) for name, body in
                         (("overturning_moment", 1), ("support_force_max", None)))  # fmt: skip
        shear, base = found.stripe(structure.name, "story_shear", 1), found.stripe(structure.name, "base_shear")
        assert moment is not None
        assert force is not None
        assert shear is not None
        assert base is not None
        assert shear.mean == base.mean
        displaced = found.stripe(structure.name, "displacement")
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
    stripe = Stripe("b", "displacement", None, "exact", "m", 1.0, motions, numbers[0], fractiles, *numbers[1:],
                    {}, names[-1], names[0])  # fmt: skip
    chosen = [ChosenMotion("b", name, 1.0, ["largest displacement"], {}) for name in names[motions // 2 :]]
    building = BuildingRead(4, 250.0, [[2.0]], [[]], [[]], 2.0, (0.03, 0.06), 0.5, None, ("deck",))
    return EnsembleResult(
        "phase-resonance/ensemble/3", [Structure("b", "A <block>", 1, 1e3, None, building)], (1.0,), motions,
        {"ok": motions}, [stripe], curves, [], Engine("spatial", chosen), {},
        suite=[GroundMotion(name, 10.0, 2.0) for name in names],
    )  # fmt: skip


def test_one_sentence_keeps_geometry_codes_and_turning_apart() -> None:
    said = trust.trust_sentence(planted())
    assert said == (
        "On the 2 motions that all models computed, three things are apart: the geometry of the sphere, which the "
        "small equations leave out, is worth up to 10 % (isolator displacement); given the same equations and "
        "friction law, the two codes differ by up to 0.2 % (isolator displacement); bodies that turn on their supports "
        "change a demand by up to 4.8 % (isolator displacement)."
    )
    contradiction = trust.trust_sentence(planted({"small": 1.0, "translational": 1.3, "spatial": 1.3}))
    assert "the two codes differ by up to 30 %" in contradiction, "the codes, and neither geometry nor turning"
    assert "leave out, is worth less than 0.01 %" in contradiction
    regularized = trust.trust_sentence(planted({"regularised": 1.3, "translational": 1.3, "spatial": 1.3}))
    assert "the two codes differ by less than 0.01 %" in regularized, "with the same friction law"


def test_models_stand_beside_each_other_on_the_motions_that_all_have() -> None:
    (row,) = trust.trust_rows(planted())
    assert (row.motions, row.value) == (("m3", "m4"), pytest.approx(0.35)), "the other motions are in no mean"
    assert {key: ratio.mean for key, ratio in row.ratios.items()} == pytest.approx(
        {"small": 0.9, "translational": 1.002, "spatial": 1.05}
    )
    assert [row.ratios[key].brief for key in ("small", "translational", "spatial")] == [
        "−10.00 %",
        "+0.20 %",
        "+5.00 %",
    ]


def test_the_ratio_of_the_engine_is_extended_to_the_suite_with_its_spread() -> None:
    found = planted()
    curves = [
        replace(each, values=(0.44,)) if (each.model, each.motion) == ("spatial", "m4") else each
        for each in found.curves
    ]
    ((_, ratio, cells),) = trust.extended_rows(replace(found, curves=curves))
    assert (ratio.mean, ratio.smallest, ratio.largest) == pytest.approx((1.075, 1.05, 1.1))
    mean, share, largest = 0.25 * 1.075, 1e3 * 0.386 * 1.075, 1e3 * 0.4 * 1.075
    assert cells == [
        "mm", f"{1e3 * mean:.4g} ({250 * 1.05:.4g} to {250 * 1.1:.4g})",
        f"{share:.4g} ({386 * 1.05:.4g} to {386 * 1.1:.4g})", f"{largest:.4g} ({400 * 1.05:.4g} to {400 * 1.1:.4g})",
    ]  # fmt: skip


def test_no_statistic_mixes_motions_of_the_equations_with_those_of_the_engine(found: EnsembleResult) -> None:
    assert {each.model for each in found.stripes} == {"exact"}, "no fractiles of the engine's few motions"
    named = {each.name: each for each in found.structures}
    shown = rows.demand_rows(found, 1.0)
    uplift = [row for row in shown if row.name == "uplift of a support"]
    assert [row.cells[:4] for row in uplift] == [("–",) * 4] * len(named)
    for row in uplift:
        assert "of 4 (spatial engine)" in row.motions
    assert all("engine" not in row.motions for row in shown if row.name != "uplift of a support")


def test_a_fractile_beyond_the_outermost_motions_is_left_out() -> None:
    for motions, expected in ((2, ["–", "150", "–"]), (3, ["–", "200", "–"]), (4, ["114", "250", "386"])):
        row = next(
            row for row in rows.demand_rows(planted(motions=motions), 1.0) if row.name == "isolator displacement"
        )
        assert list(row.cells[1:4]) == expected


def test_the_envelope_is_the_worst_of_the_bounds_in_every_column() -> None:
    one = planted()
    other = [replace(each, structure="c", mean=Statistic(0.2, 0.0), largest=Statistic(0.9, 0.0), largest_motion="m1")
             for each in one.stripes]  # fmt: skip
    both = replace(
        one, structures=[*one.structures, replace(one.structures[0], name="c")], stripes=[*one.stripes, *other]
    )
    envelope = next(row for row in rows.demand_rows(both, 1.0) if row.bound == "envelope")
    assert (envelope.cells[0], envelope.cells[-1], envelope.motion) == ("250 ± 1", "900", "m1, c")
    lost = [replace(each, largest=Statistic(None, None), answered=3, reasons={"travel reached": 1}) for each in other]
    envelope = next(row for row in rows.demand_rows(replace(both, stripes=[*one.stripes, *lost]), 1.0)
                    if row.bound == "envelope")  # fmt: skip
    assert (envelope.cells[-1], envelope.motion) == ("none", ""), "a bound without a value is no smaller than the other"


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
    force, share = (row for row in rows.demand_rows(found, 1.0) if row.bound == "envelope")
    assert (force.cells[0], force.cells[-1], force.motion) == ("0.7", "1", "m4, c")
    assert (share.cells[0], share.cells[-1], share.motion) == ("31", "40", "m4, b")
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
    (drawn,) = (make() for make in panels.isolator_panels(replace(found, curves=curves)))
    series = drawn["plot"]["series"]
    dots = [each for each in series if each.get("color") == 0 and "one motion" in each["name"]]
    assert [each["y"][0] for each in dots] == pytest.approx([100.0, 200.0, 300.0, 400.0])
    assert [(each["low"][0], each["high"][0]) for each in dots[:1]] == [(pytest.approx(90.0), pytest.approx(110.0))]
    by_engine = [each for each in series if each.get("color") == "ink"]
    assert [each["y"][0] for each in by_engine] == pytest.approx([315.0, 420.0])
    assert by_engine[0]["name"] == "spatial engine"


def test_profiles_have_the_height_on_the_vertical_axis(found: EnsembleResult) -> None:
    drawn = next(each for each in (make() for make in panels.height_panels(found)) if "acceleration" in each["title"])
    assert drawn["plot"]["y"]["title"] == "height above the sliding contact, m"
    median = next(each for each in drawn["plot"]["series"] if each["name"] == "upper bound, 50 %")
    assert median["y"] == pytest.approx([0.5, 3.5, 6.5])
    expected = [found.stripe("mine[upper bound]", "acceleration", body) for body in (1, 2, 3)]
    assert median["x"] == pytest.approx([each.fractiles[1].value / GRAVITY for each in expected])  # type: ignore[union-attr, operator]
    assert [each.partition(":")[0] for each in median["titles"]] == ["deck", "body 2", "roof"]


def fails(*rest: Any) -> None:
    raise RuntimeError("planted")


@pytest.mark.parametrize(
    ("owner", "name", "lost"),
    [
        (panels, "_demand_panel", "plot 1"), (panels, "_profile_panel", "plot 1"),
        (page, "trust_rows", "section trust"),
        (page, "demand_rows", "section demands"), (sentences, "support_sentences", "section supports"),
        (sentences, "answer_sentence", "answer"), (page, "extended_rows", "section extended"),
    ],
)  # fmt: skip
def test_a_part_that_fails_costs_one_line(
    found: EnsembleResult,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    owner: Any,
    name: str,
    lost: str,
) -> None:
    whole = page.page_of(found)
    monkeypatch.setattr(owner, name, fails)
    without = page.page_of(found)
    said = capsys.readouterr().err.splitlines()
    assert said[0] == f"{lost} could not be shown: RuntimeError: planted"
    assert without.count("RuntimeError: planted") >= 1
    assert without.count("<section id=") == whole.count("<section id="), "its place says what is lost"
    assert len(without) > 0.4 * len(whole)


def test_a_page_that_fails_costs_neither_tables_nor_files(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("comparison.analyses.ensemble.command.page_of", fails)
    monkeypatch.setattr("comparison.analyses.ensemble.terminal.demand_rows", fails)
    assert run("mine.toml", "--engine", "0", "--out", "lost") == 0
    said = capsys.readouterr()
    assert "index.html could not be shown: RuntimeError: planted" in said.err
    assert "demands could not be shown: RuntimeError: planted" in said.err
    assert "Ensemble: lost/summary.json, lost/ensemble.csv\n" in said.out
    assert json.loads((folder / "lost" / "summary.json").read_text())["outcomes"] == {"ok": 4}


def test_a_report_of_another_kind_is_refused_and_not_shown(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """No study shows an ensemble, and neither takes the place of the other."""
    words = [*SMALL, "--out", "out"]
    assert study(words, fake_hierarchy(), ThreadPoolExecutor) == 2
    rule = "--out = 'out': holds the page of `ensemble`, of this building or another: give a directory of its own"
    assert rule in capsys.readouterr().err
    assert study([*SMALL, "--out", "study"], fake_hierarchy(), ThreadPoolExecutor) == 0
    capsys.readouterr()
    assert run("mine.toml", "--engine", "0", "--out", "study") == 2
    assert "holds the page of `run`" in capsys.readouterr().err
    assert "two floors on four pendulums" not in (folder / "study" / "index.html").read_text(encoding="utf-8")
