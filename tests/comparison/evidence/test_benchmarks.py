"""Numbers published elsewhere: met by the equations and by the engine, or the difference is explained."""

import math
import os
import re
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from known_analyses import computed
from known_results import known_benchmarks
from places import ROOT
from rich.console import Console

import reference
from comparison.evidence.benchmarks import analysis, cases, readings
from comparison.evidence.benchmarks.analysis import (
    BenchmarkTable,
    SideNumbers,
    _make_benchmark,
    halve_samples,
    solve_side,
)
from comparison.evidence.benchmarks.cases import (
    MASTODON_EXTREMES,
    BenchmarkCase,
    MotionReading,
    list_cases,
    load_mastodon_case,
    load_shipped_scene,
)
from comparison.evidence.benchmarks.command import main, print_benchmarks
from comparison.evidence.benchmarks.table import (
    FRICTION_EXPLANATION,
    MODEL_EXPLANATION,
    STORED,
    Benchmarks,
    PublishedNumber,
    SideNumber,
    verdict_line,
    word_page,
    word_published_number,
    word_with_error,
)
from comparison.evidence.sides import ENGINE, EQUATIONS, SMOOTHED
from comparison.verdicts import MET, NOT_COMPARED, NOT_MET
from reference.problem import Trajectory

CASES = list_cases()
CHEAP = ("sdnd104-0.99", "frame", "pendulum")  # the last by the command
INPUT = Path(os.environ.get("PHASE_RESONANCE_MASTODON", "mastodon-fp-seismic-input.csv"))
BY_NAME = {case.scene.name: case for case in CASES}


@pytest.mark.parametrize("name", BY_NAME)
def test_the_equations_meet_every_published_number(name, within):
    case = BY_NAME[name]
    solved = solve_side((case, EQUATIONS))
    assert len(solved.values) == len(case.published)
    for value, error, row in zip(solved.values, solved.errors, case.published):
        within(abs(value - row.published) / max(error + row.uncertainty, 1e-300), 1.0)
        assert error <= max(row.uncertainty, 1e-7 * abs(value)), "smaller than what the published digits leave"


def _every_number_is_met_or_explained(table: Benchmarks) -> None:
    for each in table.benchmarks:
        assert each.seconds[ENGINE] > 0.0
        for row in each.rows:
            assert row.numbers[EQUATIONS].verdict == MET, (each.name, row)
            assert row.numbers[ENGINE].verdict == MET or row.numbers[ENGINE].explanation == FRICTION_EXPLANATION, (
                each.name,
                row,
            )


def test_published_periods_of_a_uniform_building_are_those_of_its_closed_form() -> None:
    """omega_n of N equal stories goes as sin((2 n - 1) pi / (4 N + 2))."""
    (stories,) = (case for case in list_cases() if "five-story" in case.title)
    sines = np.sin((2.0 * np.arange(1, 6) - 1.0) * np.pi / 22.0)
    assert [each.published for each in stories.published] == pytest.approx(2.0 * sines[0] / sines, abs=5e-5)


def test_a_side_that_fails_costs_the_others_nothing():
    broken = replace(BY_NAME["pendulum"], start=((5.0, 0.0),))  # beyond the rim: both sides refuse
    chosen = [broken, *(BY_NAME[name] for name in CHEAP[:2])]
    first, *others = computed(BenchmarkTable(chosen)).benchmarks
    assert [each.name for each in (first, *others)] == [case.scene.name for case in chosen]
    assert {number.verdict for number in first.rows[0].numbers.values()} == {NOT_COMPARED}
    assert "rim" in first.endings[EQUATIONS]
    _every_number_is_met_or_explained(Benchmarks(others, {}))


@pytest.mark.long
def test_the_engine_meets_all_published_numbers(within):
    table = computed(BenchmarkTable([BY_NAME[name] for name in BY_NAME if name not in CHEAP]))
    _every_number_is_met_or_explained(table)
    for row in (row for each in table.benchmarks for row in each.rows):
        if (found := row.numbers[ENGINE]).verdict == MET:
            within(abs(found.value - row.published) / max(found.error + row.uncertainty, 1e-300), 1.0)


@pytest.mark.skipif(not INPUT.exists(), reason="the input motion of MASTODON's test is not shipped")
def test_both_sides_meet_mastodon_within_three_percent():
    """To 3 mm, as it was read, by the small equations; without heating they are 15 to 83 mm smaller."""
    case = load_mastodon_case(INPUT)
    for row in computed(BenchmarkTable([case])).benchmarks[0].rows:
        equations, smoothed, engine = (row.numbers[side] for side in (EQUATIONS, SMOOTHED, ENGINE))
        assert equations.verdict == engine.verdict
        assert equations.verdict == MET or equations.explanation == MODEL_EXPLANATION
        assert 0.975 < equations.value / row.published < 1.0
        assert abs(engine.value - smoothed.value) <= engine.error + smoothed.error, "both sides agree"
    cold = case.scene.with_values({"isolator.friction": {"slow": 0.03, "fast": 0.06, "rate": 100.0}})
    heated, plain = (
        1e3 * np.array(readings.find_position_ranges(reference.trajectory(each, (0.0, 0.0), "small", tolerance=1e-5)))
        for each in (case.scene, cold)
    )
    assert np.abs(heated - MASTODON_EXTREMES).max() < 3.1
    assert (np.abs(plain - MASTODON_EXTREMES) > 15.0).all()


def test_the_error_covers_that_of_few_instants(monkeypatch):
    monkeypatch.setattr(analysis, "READ_SAMPLES", 201)
    solved, known = solve_side((BY_NAME["sdnd104-15"], EQUATIONS)), BY_NAME["sdnd104-15"].published[0].published
    assert 1e-4 < abs(solved.values[0] - known) <= solved.errors[0] < 0.01


def _words(difference: str = "", **sides: tuple[float, float]) -> dict[str, str]:
    case = BenchmarkCase(
        "a",
        "b",
        "c",
        [PublishedNumber("x", "mm", 1.0, 0.01)],
        MotionReading(readings.compute_mean_period),
        load_shipped_scene("pendulum"),
    )
    case = replace(case, difference=difference)
    answers = {side: SideNumbers([value], [error], "ok", 0.0) for side, (value, error) in sides.items()}
    row = _make_benchmark(case, answers).rows[0]
    return {side: row.word(side, explained=True) for side in row.numbers}


def test_a_number_is_met_within_both_errors():
    near, far = (1.005, 1e-3), (1.2, 1e-3)
    assert _words(equations=near, smoothed=near, engine=near)[ENGINE] == "met"
    assert _words(equations=(1.0105, 1e-3), smoothed=far, engine=far)[EQUATIONS] == "met"
    assert (
        _words(equations=near, smoothed=far, engine=(1.2015, 1e-3))[ENGINE]
        == f"not met (by +20 %): {FRICTION_EXPLANATION}"
    )
    assert _words(equations=near, smoothed=near, engine=far)[ENGINE] == "not met (by +20 %): not explained"
    assert _words(equations=far, smoothed=far, engine=far)[EQUATIONS] == "not met (by +20 %): not explained"
    low = (0.8, 1e-3)
    assert (
        _words("heating", equations=low, smoothed=far, engine=far)[EQUATIONS]
        == f"not met (by −20 %): {MODEL_EXPLANATION}"
    )
    nothing = (math.nan, math.nan)
    assert _words(equations=nothing, smoothed=far, engine=(1.0, math.nan)) == {
        EQUATIONS: "not compared", SMOOTHED: f"not met (by +20 %): {FRICTION_EXPLANATION}", ENGINE: "not compared",
    }  # fmt: skip
    assert word_with_error(SideNumber(2.02423, 3e-4, "met")) == "2.0242 ± 3e-04"
    assert word_with_error(SideNumber(math.pi, 1e-12, "met")) == "3.141593 ± 1e-12"
    assert [word_with_error(SideNumber(*each, "met")) for each in ((2.5, 0.0), (1e-5, 1.0))] == ["2.5", "1e-05 ± 1e+00"]
    assert _words(equations=(1.01 + 1e-13, 0.0), smoothed=far, engine=far)[EQUATIONS] == "met", (
        "rounding is no deviation"
    )
    (known,) = known_benchmarks().benchmarks
    with pytest.raises(ValueError, match="numbers must have equations and engine"):
        replace(known, rows=[replace(known.rows[0], numbers={EQUATIONS: known.rows[0].numbers[EQUATIONS]})])


def test_a_number_that_a_coarser_motion_lacks_has_no_error(monkeypatch):
    monkeypatch.setattr(analysis, "halve_samples", lambda motion: SimpleNamespace(read=[1.3, 5.0]))
    reading = SimpleNamespace(read=lambda motion: motion.read)
    for coarser, errors in (([1.0, 2.0], [0.1 + 0.2 / 3.0, 2.0 + 1.0 / 3.0]), ([1.0], [math.nan] * 2)):
        accuracy = SimpleNamespace(
            coarser=[SimpleNamespace(read=coarser)], error_of=lambda value, others: value - others[0]
        )
        motion = SimpleNamespace(status="ok", time=[0.0, 1.0], read=[1.1, 4.0], accuracy=accuracy)
        values, found = analysis._read_numbers(reading, motion)
        assert values == motion.read
        assert found == pytest.approx(errors, nan_ok=True)


def test_a_task_costs_what_its_side_and_its_duration_cost():
    short = BY_NAME["pendulum"]
    tasks = [
        BenchmarkTable([replace(short, scene=short.scene.with_values({"duration": end}))]).tasks()
        for end in (6.0, 24.0)
    ]
    assert [[task.seconds for task in each] for each in tasks] == [[0.1, 0.1, 3.5], [0.2, 0.2, 7.0]]
    assert [task.needs_compiled_reference for task in tasks[0]] == [True, True, False]


def test_a_file_whose_verdict_contradicts_its_numbers_is_refused(tmp_path):
    known = STORED.as_json(known_benchmarks())
    for right, wrong in (
        (b'"met"', b'"not met"'),
        (b'"published": 2.0242', b'"published": 2.05'),
        (b'"met"', b'"law"'),
    ):
        (tmp_path / STORED.name).write_bytes(known.replace(right, wrong))
        with pytest.raises(ValueError, match=r"not a table of benchmarks: .*run phase-resonance benchmarks"):
            STORED.load(tmp_path)
    for verdict, said in ((MET, "contradicts None"), (NOT_COMPARED, "")):
        numbers = {EQUATIONS: SideNumber(value=None, error=None, verdict=verdict)}
        with pytest.raises(ValueError, match=said) if said else nullcontext():
            PublishedNumber(quantity="q", unit="", published=1.0, uncertainty=0.0, numbers=numbers)


def test_another_motion_is_not_that_of_mastodon(tmp_path, capsys, monkeypatch):
    time = 0.01 * np.arange(5002)
    shaking = np.outer(0.9 * np.sin(time), [8.950749, 6.770387, 1.692597])
    kinds = {"steps": (2.0 * time, shaking), "short": (time[:200], shaking[:200]), "weak": (time, 0.9 * shaking)}
    shaking[157] = [-8.950749, 6.770387, -1.692597]
    kinds |= {"off": (time, 0.998 * shaking), "turned": (time, shaking[:, [1, 0, 2]])}
    content = {kind: np.column_stack(columns) for kind, columns in {**kinds, "copy": (time, 0.9995 * shaking)}.items()}
    monkeypatch.setattr(cases, "read_csv_samples", lambda text: content["copy"])
    case = load_mastodon_case(ROOT / "README.md")
    assert case.scene.record[157] == pytest.approx(content["copy"][157])
    assert case.scene.total_mass * 9.81 == pytest.approx(6285710.0)
    assert {row.quantity: row.published for row in case.published} == {
        "smallest along x": -432.0, "largest along x": 330.0, "smallest along y": -197.0, "largest along y": 152.0
    }  # fmt: skip
    monkeypatch.undo()
    for name, (instants, samples) in kinds.items():
        rows = "\n".join(",".join(map(repr, map(float, row))) for row in np.column_stack([instants, samples]))
        (tmp_path / f"{name}.csv").write_text(f"time [s], ax [m/s^2], ay [m/s^2], az [m/s^2]\n{rows}\n")
        words = ["--only", "mastodon", "--mastodon", str(tmp_path / f"{name}.csv"), "--out", str(tmp_path / "report")]
        assert main(words) == 2
        error = capsys.readouterr().err
        assert error.count("\n") == 1
        assert "5002 samples every 0.01 s with peaks of 8.951, 6.77, 1.693 m/s^2; it has " in error
        assert not (tmp_path / "report").exists(), "nothing is computed"


def test_the_page_in_docs_has_every_benchmark():
    text = (ROOT / "docs" / "benchmarks.md").read_text(encoding="utf-8")
    for case in CASES:
        section = text.split(f"\n## {case.title}\n", 1)[1].split("\n## ", 1)[0]
        assert f"Source: {case.source}. Evidence for: {case.evidence}." in section
        assert f"v_reg of the engine: {case.regularization:g} m/s" in section
        for row in case.published:
            assert f"\n| {row.quantity} | {word_published_number(row)} | " in section
    assert "\n- 0 not met and not explained\n" in text


def test_every_number_stands_under_its_side(capsys):
    table = known_benchmarks()
    print_benchmarks(Console(width=200), table)
    *lines, _, about, counts, unexplained = capsys.readouterr().out.splitlines()
    heads, _, cells = (re.split(r"\s{2,}", line.strip()) for line in lines[1:4])
    assert heads == ["scene", "quantity", "published", "equations", "verdict", "engine", "verdict"]
    numbers = "2.02423 ± 2e-08", "met", "none", "not compared"
    assert cells == ["frame", "isolation period, s", "2.0242", *numbers]
    row = "| isolation period | 2.0242 s ± 5e-05 | 2.02423 ± 2e-08 | met | 2.02425 ± 3e-08 | none | not compared |"
    assert row in word_page(table)
    assert (
        "| quantity | published | equations | verdict | equations with the engine's friction | engine | verdict |"
        in word_page(table)
    )
    assert (about, counts) == ("frame: theirs is heated", "2 published numbers: 1 met, 0 not met, 1 not compared.")
    assert unexplained == "0 not met and not explained."
    (known,) = table.benchmarks
    rows = [replace(known.rows[0], quantity=f"point {number}") for number in (1, 2, 3)]
    short = "| a <frame>, point 3 | 2.0242 s ± 5e-05 | 2.02423 ± 2e-08, met | none, not compared |"
    assert f"|---|---|---|---|\n{short}\n\n" in word_page(Benchmarks([replace(known, name="sdnd100", rows=rows)], {}))
    assert STORED.word_field("numbers") == "numbers; null unless phase-resonance benchmarks left it next to the report"


def test_a_known_motion_is_read_as_it_is() -> None:
    """x = cos t and y = 0.3 sin 2t - 0.1 to 9 s, which is no turning point; the body above is elsewhere."""
    time = np.linspace(0.0, 9.0, 182)
    place = np.stack([np.cos(time), 0.3 * np.sin(2.0 * time) - 0.1], axis=1)
    speed = np.stack([-np.sin(time), 0.6 * np.cos(2.0 * time)], axis=1)
    position, velocity = (np.stack([part, 5.0 + part**2], axis=1) for part in (place, speed))
    rest = {"contact_force": time, "stick": [], "status": "ok", "instant": math.nan, "scene": BY_NAME["frame"].scene}
    motion = Trajectory(time, position, velocity, -position, **rest)
    assert readings.interpolate_positions(motion, [0.33, 9.0, 9.1]) == pytest.approx(
        [math.cos(0.33), math.cos(9.0), math.nan], abs=1e-7, nan_ok=True
    )
    assert readings.find_position_ranges(motion) == pytest.approx([-1.0, 1.0, -0.4, 0.2], abs=1e-5)
    assert readings.compute_half_range(motion, 4.0) == pytest.approx(0.5 * (1.0 - math.cos(9.0)), abs=1e-5)
    assert readings.find_turning_points(motion) == pytest.approx([-1.0, 1.0, math.cos(9.0)], abs=1e-5)
    assert readings.compute_mean_period(motion) == pytest.approx(2.0 * math.pi, abs=1e-5)
    dense = np.linspace(1.0, 5.0, 10001)
    length = np.trapezoid(np.hypot(np.sin(dense), 0.6 * np.cos(2.0 * dense)), dense)
    assert readings.compute_path_length(motion, 1.0, 5.0) == pytest.approx(length, rel=1e-4)
    for count, kept in ((182, [*range(0, 181, 2), 181]), (181, [*range(0, 181, 2)])):
        halved = halve_samples(Trajectory(*(part[:count] for part in (time, position, velocity, -position)), **rest))
        for found, whole in ((halved.time, time), (halved.position, position), (halved.velocity, velocity)):
            assert (found == whole[kept]).all()
        assert (halved.absolute_acceleration == -position[kept]).all()


def test_the_largest_error_names_its_side_and_is_the_largest_share_not_the_largest_number():
    (known,) = known_benchmarks().benchmarks
    (row,) = known.rows[:1]
    met = SideNumber(row.published, 1e-6, MET)

    def off(share, published):
        return SideNumber(published * (1.0 + share), 1e-9, NOT_MET)

    force = replace(row, quantity="force", published=2e4, uncertainty=1.0, numbers={})
    one = replace(row, numbers={EQUATIONS: off(-0.05, row.published), SMOOTHED: met, ENGINE: met})
    numbers = {EQUATIONS: SideNumber(2e4, 1.0, MET), SMOOTHED: off(0.5, 2e4), ENGINE: off(0.02, 2e4)}
    line = verdict_line(Benchmarks([replace(known, rows=[replace(force, numbers=numbers), one])], {}))
    assert "2 met, 2 not met (largest: frame, isolation period, equations, −5 %), 0 not compared" in line
    numbers = {**numbers, ENGINE: off(0.2, 2e4)}
    line = verdict_line(Benchmarks([replace(known, rows=[replace(force, numbers=numbers), one])], {}))
    assert "(largest: frame, force, engine, +20 %)" in line


@pytest.mark.parametrize(
    ("number", "code", "said"),
    [
        (SideNumber(2.0242, 1e-6, MET), 0, "2 met, 0 not met, 0 not compared"),
        (
            SideNumber(2.0, 1e-3, NOT_MET, FRICTION_EXPLANATION),
            0,
            "1 met, 1 not met (largest: frame, isolation period, engine, −1.2 %),",
        ),
        (SideNumber(2.0, 1e-3, NOT_MET, MODEL_EXPLANATION), 0, f"1 not met: {MODEL_EXPLANATION}."),
        (SideNumber(2.0, 1e-3, NOT_MET), 1, "1 not met and not explained."),
        (SideNumber(None, None, NOT_COMPARED), 1, "1 met, 0 not met, 1 not compared"),
    ],
)
def test_a_number_that_is_off_or_lacking_is_an_exit_code(number, code, said, monkeypatch, tmp_path, capsys):
    (known,) = known_benchmarks().benchmarks
    numbers = {**known.rows[0].numbers, ENGINE: number}
    table = Benchmarks([replace(known, rows=[replace(known.rows[0], numbers=numbers)])], {})
    monkeypatch.setattr("comparison.evidence.benchmarks.command.compute_tasks", lambda *rest: None)
    monkeypatch.setattr(BenchmarkTable, "collect", lambda *rest: table)
    assert main(["--only", "frame", "--out", str(tmp_path / "report")]) == code
    assert main(["--only", "one-story", "--out", str(tmp_path / "none")]) == 2, "part of the title"
    stored = STORED.load(tmp_path / "report")
    assert stored.benchmarks == table.benchmarks
    assert (tmp_path / "report" / "benchmarks.md").read_text(encoding="utf-8") == word_page(stored)
    printed = capsys.readouterr().out
    assert f"2 published numbers: {verdict_line(table).removeprefix('2 published numbers: ')}." in printed
    assert said in printed


def test_both_laws_of_friction_and_the_engine_are_asked(monkeypatch):
    asked = []
    monkeypatch.setattr(
        analysis, "import_function", lambda path: lambda *given, **settings: asked.append((path, settings))
    )
    for side in (EQUATIONS, SMOOTHED, ENGINE):
        with pytest.raises(AttributeError):  # None is no motion
            solve_side((BY_NAME["sdnd100"], side))
    laws = [(path.partition(":")[0], settings["regularization"], settings["tolerance"]) for path, settings in asked]
    assert laws == [("reference", None, 1e-8), ("reference", 1e-7, 1e-8), ("multibody", 1e-7, 1e-4)]
    assert {settings["initial"].position[0, 0] for _, settings in asked} == {0.85e-3}
    assert not any(settings["initial"].velocity.any() for _, settings in asked), "released from rest"
    few = {side: SideNumbers([2.0242], [0.0], "ok", 0.0) for side in (EQUATIONS, SMOOTHED, ENGINE)}
    rows = _make_benchmark(BY_NAME["frame"], few).rows
    assert [row.numbers[EQUATIONS].verdict for row in rows] == [NOT_COMPARED] * 2, "one number of two may be either"
