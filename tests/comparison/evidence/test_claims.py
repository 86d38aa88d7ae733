"""Every statement on surfaces that show it and that violate it; verdicts, counts and line by reading; the command."""

from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from known_analyses import collected
from numpy.typing import NDArray
from terminal_tables import rows_under

from comparison.cli import computing
from comparison.evidence.claims import checks
from comparison.evidence.claims import peaks_and_valleys as counting
from comparison.evidence.claims import table as table_module  # table: what a test made
from comparison.evidence.claims.checks import StatementVerdict, _describe_curvatures, count_peaks, find_unequal_axes
from comparison.evidence.claims.claims import CLAIMS, PaperStatement
from comparison.evidence.claims.command import main
from comparison.evidence.claims.evidence import MOTION_PHASES, CaseInReading, Evidence, gather_evidence
from comparison.evidence.claims.feature import FEATURE
from comparison.evidence.claims.peaks_and_valleys import PeakCounts
from comparison.evidence.claims.readings import (
    AS_INTEGRATED,
    LITERAL_SUPREMUM,
    READINGS,
    STATEMENT_CASES,
    effective_reading,
)
from comparison.evidence.claims.smoothness import SharpestCurvature
from comparison.evidence.claims.table import Claims, ClaimTable, make_claim_table, select_study_surfaces, word_claims
from comparison.evidence.convergence.analysis import Convergence
from comparison.evidence.forced_ratios import compute_forced_ratios
from comparison.evidence.scaling.analysis import Scaling
from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults
from comparison.study.batches import Batch, BatchResult
from comparison.study.models import SMALL
from comparison.study.study import Study
from comparison.surfaces.surfaces import label_surfaces, make_surface_tasks
from comparison.verdicts import MEANING_OF_VERDICT, MET, NOT_COMPARED, NOT_MET, Verdict
from reference import amplification, modes, trajectory
from reference.problem import builtin_scenes, load_scene

Array = NDArray[np.float64]
N = 16
PAPERS = Study(tuple(map(load_scene, builtin_scenes())), 4, 1e-3)  # every scene that the statements are about
A1, A2 = np.meshgrid(*[2.0 * np.pi * np.arange(N) / N] * 2, indexing="ij")
SMOOTH, FOLD = SharpestCurvature(2.0, (0.0, 0.0)), SharpestCurvature(1.0, (0.5, 1.0))
RESONANT = ((0.9, 1.0), (1.1, 1.0))  # s: both harmonics at T_c (1 -+ 0.1)


def _seen(
    mu_1: Array, mu_2: Array, bend: SharpestCurvature = FOLD, apart: float = 1.0, swing: float = 0.01
) -> Evidence:
    mu = np.stack([mu_1, mu_2], axis=-1)
    return Evidence(mu, 1e-4, ("ok",), (bend, bend), (apart, apart), swing, RESONANT)


FOUR = 2.5 - np.cos(2.0 * (A1 - A2))  # drawn: four ridges along the diagonal and three valleys between them
TWO = 2.5 - np.cos(A1 - A2)
CORNERS = 1.5 + 0.5 * (np.cos(A1) + np.cos(A2))  # from rest it would have a twin in the center
SEVERAL_PEAKS = 1.5 + 0.25 * np.cos(2.0 * A1) + 0.25 * np.cos(2.0 * A2)

PAPER: Mapping[str, Evidence] = {  # surfaces as the paper describes them
    "fig3-I": _seen(FOUR, SEVERAL_PEAKS),
    "fig3-I alone": Evidence(FOUR[..., None], 1e-4, ("ok",)),
    "fig3-II": _seen(TWO, CORNERS, apart=0.0),
    "fig3-II alone": Evidence(TWO[..., None], 1e-4, ("ok",)),
    "fig3-II oscillator": Evidence(CORNERS[::2, ::2, None], 1e-4, ("ok",)),
    "fig4-dry": _seen(np.round(TWO, 1), np.round(CORNERS, 1), apart=0.0),
    "fig4-viscous": _seen(TWO, CORNERS, SMOOTH, apart=0.0),
}


def _claim(about: str, words: str) -> PaperStatement:
    return next(claim for claim in CLAIMS if claim.figure == about and words in claim.says)


FOUND = {
    "mu_2 has several peaks and valleys, more complex than those of mu_1": "mu_2 4 and 4, mu_1 2 and 2",
    "mu_1 has two peaks separated by a valley": "only as drawn: periodic 1 and 1; drawn 2 and 1; profile 2 and 1",
    "the vibrations are small, (4.2)": "up to 0.01 rho^2",
    "x_2(t) differs from y_2(t)": "|x_2 - y_2| up to 1 of the largest",
    "x_i = y_i: the solution (4.7) stays in its plane": "|x_i - y_i| below 1e-09 of the largest",
    "mu_2 has peaks near the corners": "peaks at (0°, 0°), the nearest 0° from a corner",
}


@pytest.mark.parametrize("claim", CLAIMS, ids=lambda c: f"{c.figure}: {c.says}")
def test_every_claim_holds_on_surfaces_as_described(claim: PaperStatement) -> None:
    verdict = claim.verdict(PAPER)
    assert verdict == StatementVerdict(MET, FOUND.get(claim.says, verdict.reason))


ONE_BODY = Evidence(TWO[..., None], 1e-4, ("ok",))
ONE_AXIS, BOTH_AXES, DRY, WET = (PAPER[name] for name in ("fig3-I", "fig3-II", "fig4-dry", "fig4-viscous"))
VIOLATIONS: list[tuple[str, str, Mapping[str, Evidence]]] = [
    ("Fig. 3", "small", {"fig3-II": replace(BOTH_AXES, swing=0.2)}),
    ("Fig. 3", "small", {"fig3-I": replace(ONE_AXIS, swing=0.2)}),
    ("Fig. 3", "close to resonance", {"fig3-I": replace(ONE_AXIS, resonance=((1.11, 1.0), (0.9, 1.0)))}),
    ("Fig. 3", "close to resonance", {"fig3-I": replace(ONE_AXIS, resonance=((0.9, 1.0), (1.11, 1.0)))}),
    ("Fig. 3a, b", "more intensively", {"fig3-I": _seen(SEVERAL_PEAKS, FOUR)}),
    ("Fig. 3a", "four peaks", {"fig3-I": _seen(TWO, SEVERAL_PEAKS)}),
    ("Fig. 3a", "four peaks", {"fig3-I": _seen(2.5 + np.cos(3.0 * (A1 - A2)), SEVERAL_PEAKS)}),
    ("Fig. 3a", "four peaks", {"fig3-I": _seen(1.0 + 1e-3 * FOUR, SEVERAL_PEAKS)}),  # no resonance
    ("Fig. 3a", "one-mass", {"fig3-I alone": Evidence(-FOUR[..., None] + 5.0, 1e-4, ("ok",))}),
    ("Fig. 3a", "one-mass", {"fig3-I alone": Evidence(1.0 + 1e-3 * FOUR[..., None], 1e-4, ("ok",))}),  # held
    ("Fig. 3d", "peaks near the corners", {"fig3-II": _seen(TWO, 1.0 + 1e-3 * CORNERS)}),
    ("Fig. 3b", "more complex", {"fig3-I": _seen(SEVERAL_PEAKS, TWO)}),
    ("Fig. 3b", "more complex", {"fig3-I": _seen(TWO, 1.0 + np.cos(A1) ** 2 * (1.0 + np.cos(A2)))}),  # one valley
    ("Fig. 3b", "x_2(t) differs", {"fig3-I": replace(ONE_AXIS, apart=(1.0, 0.01))}),
    ("Fig. 3c", "two peaks", {"fig3-II": _seen(FOUR, CORNERS)}),
    ("Fig. 3c", "one degree", {"fig3-II alone": Evidence(np.roll(TWO, N // 4, axis=0)[..., None], 1e-4, ("ok",))}),
    ("Fig. 3d", "peaks near the corners", {"fig3-II": _seen(TWO, np.roll(CORNERS, N // 2, axis=1))}),
    ("Fig. 3d", "nonresonant", {"fig3-II oscillator": Evidence(SEVERAL_PEAKS[..., None], 1e-4, ("ok",))}),
    ("Fig. 3", "not smooth", {"fig3-I": replace(ONE_AXIS, bends=(FOLD, SMOOTH))}),
    ("Fig. 4a, b", "plane", {"fig4-dry": replace(DRY, apart=(0.0, 1e-3))}),
    ("Fig. 4a", "similar", {"fig4-dry": _seen(FOUR, CORNERS)}),
    ("Fig. 4b", "similar", {"fig4-dry": _seen(TWO, SEVERAL_PEAKS)}),
    ("Fig. 4c, d", "smooth", {"fig4-viscous": replace(WET, bends=(SMOOTH, FOLD))}),
    ("Fig. 4c, d", "smooth", {"fig4-viscous": replace(WET, ground=FOLD)}),
]


@pytest.mark.parametrize(("about", "words", "changed"), VIOLATIONS, ids=lambda part: str(part)[:40])
def test_a_claim_fails_on_what_violates_it(about: str, words: str, changed: Mapping[str, Evidence]) -> None:
    assert _claim(about, words).verdict({**PAPER, **changed}).verdict == NOT_MET


def test_the_loading_is_near_no_natural_period_of_the_paper() -> None:
    """The chain has 0.63 and 1.69 s in x, 0.58 and 1.45 s in y: 0.9 and 1.1 s are a quarter away from any."""
    verdict = _claim("Fig. 3", "resonance").verdict(
        {"fig3-I": gather_evidence(CaseInReading("fig3-I", LITERAL_SUPREMUM, 4))}
    )
    assert verdict == StatementVerdict(NOT_MET, "0.90 s is -38 % from 1.45 s; 1.10 s is -24 % from 1.45 s")


def test_smooth_is_read_as_differentiable() -> None:
    """The fold of the denominator is in every surface."""
    smooth = _claim("Fig. 4c, d", "smooth")
    verdict = smooth.verdict({**PAPER, "fig4-viscous": replace(WET, ground=FOLD, case="fig4-viscous")})
    assert verdict == StatementVerdict(
        NOT_MET,
        "cannot hold: the denominator of (5.1) has a fold; fig4-viscous: mu_1 smooth (h^2.0), mu_2 smooth (h^2.0)",
    )
    assert smooth.verdict({**PAPER, "fig4-viscous": replace(WET, ground=SMOOTH)}).verdict == MET
    assert smooth.rule.startswith("smooth is read as differentiable")
    assert "The paper may mean less" in smooth.cannot


def test_a_peak_in_a_corner_is_enough_and_its_twin_is_no_objection() -> None:
    """The paper says that there are peaks near the corners, not that there are no others."""
    twins = np.cos(A1) * np.cos(A2)
    claim = _claim("Fig. 3d", "near the corners")
    assert claim.verdict({**PAPER, "fig3-II": _seen(TWO, twins)}).verdict == MET
    lower = twins - 0.1 * np.cos(A1)  # than the twin in the center, which comes first
    words = "peaks at (180°, 180°), (0°, 0°), the nearest 0° from a corner"
    assert claim.verdict({**PAPER, "fig3-II": _seen(TWO, lower)}) == StatementVerdict(MET, words)
    centers = np.roll(twins, N // 2, axis=1)
    assert claim.verdict({**PAPER, "fig3-II": _seen(TWO, centers)}) == StatementVerdict(
        NOT_MET, "peaks at (0°, 180°), (180°, 0°), the nearest 180° from a corner"
    )
    assert "which the paper does not say" in claim.cannot


@pytest.mark.parametrize(
    ("double", "word", "words", "other"), [(1.0, NOT_MET, "1 and 1", "15 %"), (1.5, MET, "4 and 2", "35 %")]
)
def test_a_count_that_depends_on_the_prominence_says_so(double: float, word: Verdict, words: str, other: str) -> None:
    mu_2 = np.cos(A1) + np.cos(A2) + double * (np.cos(2.0 * A1) + np.cos(2.0 * A2))
    verdict = _claim("Fig. 3b", "more complex").verdict({"fig3-I": _seen(TWO, mu_2)})
    assert verdict == StatementVerdict(word, f"mu_2 {words}, mu_1 1 and 1; otherwise at a prominence of {other}")


def test_a_case_without_an_answer_leaves_its_claims_not_compared() -> None:
    mu = ONE_AXIS.mu.copy()
    mu[3, 3] = np.nan
    ended, broke = replace(ONE_AXIS, mu=mu, statuses=("ok", "rim reached")), Evidence(error_message="broke")
    changed = {**PAPER, "fig3-I": ended, "fig4-dry": broke}
    assert _claim("Fig. 3a", "four").verdict(changed) == StatementVerdict(NOT_COMPARED, "fig3-I: ok, rim reached")
    assert _claim("Fig. 4a", "similar").verdict(changed) == StatementVerdict(NOT_COMPARED, "fig4-dry: broke")
    assert _claim("Fig. 4c, d", "smooth").verdict({"fig4-viscous": Evidence()}).reason == "fig4-viscous: no surface"
    assert _claim("Fig. 3c", "two peaks").verdict(changed).verdict == MET


def test_a_verdict_without_its_reason_is_refused() -> None:
    with pytest.raises(ValueError, match="the verdict 'not met' needs one"):
        StatementVerdict(NOT_MET, "")


def _table(integrated: str, supremum: str) -> ClaimTable:
    """A table of verdicts, a letter for each statement: + met, - not met, ? not compared."""
    words: Mapping[str, Verdict] = dict(zip("+-?", MEANING_OF_VERDICT))
    columns = zip((AS_INTEGRATED, LITERAL_SUPREMUM), (integrated, supremum))
    return make_claim_table(
        {r.name: [StatementVerdict(words[c], f"{k}{c}") for k, c in enumerate(row)] for r, row in columns}
    )


KNOWN = _table("+++++++---------", "+++++++++-------")


def test_the_line_counts_each_reading_by_its_name() -> None:
    assert word_claims(KNOWN) == (
        "Of the paper's 16 statements about its figures, with the parameters as printed, on 24 x 24 phase "
        "pairs, 7 are met as integrated and 9 as literal supremum; "
        "its plots were not available, and the text at hand names no authors and no year."
    )
    assert "9 are met as integrated and 7 as literal supremum;" in word_claims(
        _table(*("+" * k + "-" * (16 - k) for k in (9, 7)))
    )


def test_the_page_says_the_same_in_both_places() -> None:
    results = SimpleNamespace(claims=KNOWN)
    assert FEATURE.section is not None
    assert FEATURE.section.lead(results) == word_claims(KNOWN)
    assert FEATURE.section.verdict(results) == "of 16 statements, 7 are met as integrated and 9 as literal supremum"


def test_what_is_not_compared_is_neither_met_nor_not_met() -> None:
    lacking = _table("+" * 5 + "?" * 2 + "-" * 9, "+" * 6 + "?" + "-" * 9)
    assert lacking.counts == {
        "as integrated": {"met": 5, "not met": 9, "not compared": 2},
        "literal supremum": {"met": 6, "not met": 9, "not compared": 1},
    }
    assert "5 are met as integrated and 6 as literal supremum, 2 not compared (as integrated)," in word_claims(lacking)
    assert ", 1 not compared (literal supremum);" in word_claims(lacking)


def test_every_statement_has_its_own_verdicts_with_their_reasons() -> None:
    assert [each.says for each in KNOWN.statements] == [claim.says for claim in CLAIMS]
    assert [each.verdicts["literal supremum"].verdict for each in KNOWN.statements] == ["met"] * 9 + ["not met"] * 7
    assert KNOWN.statements[7].reasons == ["as integrated: 7-", "literal supremum: 7+"]
    assert KNOWN.statements[0].reasons == ["0+"], "once where both readings say the same"


def _known_evidence(question: CaseInReading) -> Evidence:
    """What the paper describes, as integrated; in the supremum with two humps where the paper has four."""
    if question.case == "fig3-I" and question.reading == LITERAL_SUPREMUM:
        return _seen(TWO, SEVERAL_PEAKS)
    return PAPER[question.case]


def test_a_reading_is_judged_by_its_own_surfaces(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(table_module, "gather_evidence", _known_evidence)
    table = collected(Claims(N), PAPERS)
    four = next(each for each in table.statements if "four peaks" in each.says)
    assert {name: verdict.verdict for name, verdict in four.verdicts.items()} == {
        "as integrated": "met",
        "literal supremum": "not met",
    }
    assert table.counts["as integrated"]["met"] == 16
    assert table.counts["literal supremum"]["met"] == 14, "nor is it like the surface of one mass"


def test_readings_share_every_surface_they_can() -> None:
    for case in ("fig4-viscous", "fig3-II oscillator"):
        assert {effective_reading(reading, STATEMENT_CASES[case]()) for reading in READINGS} == {LITERAL_SUPREMUM}
    assert effective_reading(AS_INTEGRATED, STATEMENT_CASES["fig4-dry"]()) == AS_INTEGRATED
    asked = [task.argument for task in Claims(N).tasks(PAPERS)]
    assert (
        len(asked)
        == len({(question.case, question.reading.cutoff) for question in asked})
        == 2 * len(STATEMENT_CASES) - 2
    )


def _planted_result(batch: Batch) -> BatchResult:
    """Different numbers at every phase pair, in every body and scene."""
    plane = (len(batch.phases), len(batch.scene.bodies))
    mu = (batch.phases @ [[1.0], [0.1]]) * [[1.0, 2.0]] + len(batch.scene.name)
    none = np.full(plane[0], np.nan)
    return BatchResult(mu, 0.01 + 1e-3 * mu, ["ok"] * plane[0], none, 0.0, "", none)


def test_the_surfaces_of_the_study_are_used_where_it_has_the_grid() -> None:
    """Every second phase of a finer study; not of another grid, a model that is missing or a scene that was changed."""
    scenes = tuple(load_scene(name) for name in builtin_scenes())
    study = Study(scenes, 8, 1e-3, (SMALL,))
    batches = [task.argument for task in make_surface_tasks(study)]
    surfaces = label_surfaces(study, batches, [_planted_result(batch) for batch in batches])
    for case in ("fig3-I", "fig4-viscous"):
        known = select_study_surfaces(study, surfaces, case, LITERAL_SUPREMUM, 4)
        assert known is not None
        found = surfaces["mu"].sel(scene=case, model="small").values[:2, ::2, ::2]
        assert np.array_equal(known.mu, np.moveaxis(found, 0, -1), equal_nan=True)
        error = surfaces["error"].sel(scene=case, model="small").values[:2, ::2, ::2].max()
        assert (known.case, known.mu.shape, known.error, known.statuses) == (case, (4, 4, 2), error, ("ok",))
    assert select_study_surfaces(study, surfaces, "fig3-I", LITERAL_SUPREMUM, 3) is None
    assert select_study_surfaces(study, surfaces, "fig3-I", AS_INTEGRATED, 4) is None
    assert select_study_surfaces(study, surfaces, "fig3-I alone", LITERAL_SUPREMUM, 4) is None
    assert select_study_surfaces(study, None, "fig3-I", LITERAL_SUPREMUM, 4) is None
    changed = tuple(scene.with_values({"duration": 19.0, "name": scene.name}) for scene in scenes)
    assert select_study_surfaces(replace(study, scenes=changed), surfaces, "fig3-I", LITERAL_SUPREMUM, 4) is None
    tasks = {(t.argument.case, t.argument.reading): t.argument.known for t in Claims(4).tasks(study, surfaces)}
    assert tasks["fig3-I", LITERAL_SUPREMUM] is not None
    assert tasks["fig3-I", AS_INTEGRATED] is None
    assert gather_evidence(CaseInReading("fig3-I alone", LITERAL_SUPREMUM, 4, ONE_BODY)) is ONE_BODY


def test_a_case_that_fails_is_named_and_the_others_judged(monkeypatch: pytest.MonkeyPatch) -> None:
    def gather_evidence(question: CaseInReading) -> Evidence:
        if question.case == "fig4-dry":
            raise RuntimeError("singular")
        return PAPER[question.case]

    monkeypatch.setattr(table_module, "gather_evidence", gather_evidence)
    verdicts = {each.says: each.verdicts["as integrated"] for each in collected(Claims(N), PAPERS).statements}
    assert verdicts["mu_1 is similar to case II"] == StatementVerdict(
        NOT_COMPARED, "fig4-dry: solver failed: RuntimeError: singular"
    )
    assert verdicts["mu_1 has two peaks separated by a valley"].verdict == MET


@pytest.mark.parametrize("out", [".", "report"])
def test_the_command_prints_the_table(monkeypatch, capsys, tmp_path, out):
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    monkeypatch.setattr(table_module, "gather_evidence", _known_evidence)
    monkeypatch.setattr(computing, "make_compiling_task", lambda: Task(len, (), "compiling", 0.0, None, False))
    assert main(["--jobs", "2", "--grid", "16", "--out", out], ThreadPoolExecutor) == 0
    printed = capsys.readouterr().out
    rows = rows_under(printed, "as integrated", "literal supremum")
    assert [(row["about"], row["statement"]) for row in rows] == [(claim.figure, claim.says) for claim in CLAIMS]
    four = next(row for row in rows if "four peaks" in row["statement"])
    assert (four["as integrated"], four["literal supremum"]) == ("met", "not met")
    assert "as integrated: only as drawn: periodic 2 and 2; drawn 4 and 3; profile 4 and 3" in printed
    lines = printed.splitlines()
    for claim in CLAIMS:
        begin = lines.index(f"{claim.figure}: {claim.says}; met if: {claim.rule}")
        assert not claim.cannot or lines[begin + 2] == f"   {claim.cannot}"
    assert lines[-1].startswith("Of the paper's 16 statements")
    assert "16 are met as integrated and 14 as literal supremum;" in printed
    ratios = [row for row in rows_under(printed, "ratio", "without decay") if row["scene"] == "fig3-II"]
    expected = compute_forced_ratios(load_scene("fig3-II"))
    assert [[row[head] for head in ("axis", "period, s", "body", "ratio", "without decay")] for row in ratios] == [
        [each.axis, f"{each.period:.3g}", str(each.body), f"{each.ratio:.2f}", f"{each.steady:.2f}"]
        for each in expected
    ]
    stores = {".": "here.tiles", "report": "here/report.tiles"}
    assert (tmp_path / stores[out]).is_dir()
    assert not Path("report").exists(), "the command writes no report"


def test_evidence_of_the_paper_is_what_the_equations_give() -> None:
    """Coarse: the plane of (4.7) to rounding, two unequal axes apart, displacements of the same motions."""
    dry = gather_evidence(CaseInReading("fig4-dry", AS_INTEGRATED, 4))
    assert (dry.error_message, dry.mu.shape) == ("", (4, 4, 2))
    assert max(dry.apart) < 1e-9
    scene, unequal = load_scene("fig4-dry"), load_scene("fig3-I")
    reach = amplification(scene, MOTION_PHASES, "small", full=True).displacement.max()
    assert dry.swing == pytest.approx((reach / scene.radius) ** 2, rel=1e-3)
    moved = [trajectory(unequal, phase, equations="small").position[..., :2] for phase in MOTION_PHASES]
    apart = [np.abs(each[..., 0] - each[..., 1]).max(axis=0) / np.abs(each).max(axis=(0, 2)) for each in moved]
    assert len({*np.argmax(apart, axis=0)}) == 2, "each body has a worst motion of its own"
    integrated, supremum = (gather_evidence(CaseInReading("fig3-I", reading, 4)) for reading in READINGS)
    assert integrated.apart == pytest.approx(np.max(apart, axis=0), rel=1e-3)
    phases = np.array([(0.0, np.pi)])
    for found, cutoff in ((integrated, 1e-3), (supremum, None)):
        expected = amplification(unequal, phases, equations="small", cutoff=cutoff).mu[0]
        assert found.mu[0, 2] == pytest.approx(expected, rel=1e-3)
    assert supremum.mu[0, 2, 0] > 1.05 * integrated.mu[0, 2, 0]


def test_peaks_that_only_the_cut_square_has_are_as_drawn() -> None:
    """One peak at the corner is four where the square is cut, and none on the profile."""
    found = count_peaks(Evidence(CORNERS[..., None], 1e-4, ("ok",)), PeakCounts(4, 1))
    assert found == StatementVerdict(MET, "only as drawn: periodic 1 and 1; drawn 4 and 1; profile 0 and 0")


@pytest.mark.parametrize(("half", "error", "flat"), [(0.02, 1e-4, True), (0.03, 0.029, False), (0.03, 0.031, True)])
def test_a_range_of_a_twentieth_of_the_mean_or_of_the_errors_is_flat(half: float, error: float, flat: bool) -> None:
    assert Evidence(1.0 + half * np.cos(A1)[..., None], error, ("ok",)).flat(1) == flat


def test_the_platform_alone_is_loaded_close_to_its_own_period() -> None:
    alone = STATEMENT_CASES["fig3-I alone"]()
    gaps = np.array(alone.excitation.periods) / float(modes(alone).period[0, 0]) - 1.0
    assert gaps == pytest.approx([-0.1, 0.1])
    oscillator = STATEMENT_CASES["fig3-II oscillator"]()
    assert (oscillator.isolator.period, oscillator.friction_coefficient) == (1.5, 0.0), "T_3x of the second body"


def test_forced_ratios_are_those_of_oscillator_and_chain() -> None:
    scene = load_scene("fig3-II")
    for each in compute_forced_ratios(scene):
        soft = {"x": 1.5, "y": 1.2}[each.axis]
        s = complex(-0.3 / each.period, 2.0 * np.pi / each.period)
        assert each.steady == pytest.approx(1.0 / abs(1.0 - (soft / each.period) ** 2))
        assert each.ratio == pytest.approx(1.0 / abs(1.0 + (s * soft / (2.0 * np.pi)) ** 2))
    assert [round(each.steady, 2) for each in compute_forced_ratios(scene) if each.axis == "y"] == [1.29, 5.26]
    damped = scene.with_values({"bodies.1.damping": [0.1, 0.3], "excitation.amplitudes": [[1.0, 2.0], [0.0, 1.0]]})
    found = compute_forced_ratios(damped)
    assert [(each.axis, each.harmonic) for each in found] == [("x", 1), ("x", 2), ("y", 2)], "of what is loaded"
    for each in found:
        s, axis = complex(-0.3 / each.period, 2.0 * np.pi / each.period), "xy".index(each.axis)
        link = damped.stiffness[0, axis] + s * damped.damping[0, axis]
        assert each.ratio == pytest.approx(abs(link / (damped.masses[1] * s**2 + link)))
    body = scene.bodies[1].model_dump(exclude_none=True)
    light = scene.with_values({"bodies": [scene.bodies[0].model_dump(exclude_none=True), body, {**body, "mass": 1e-9}]})
    two = [each.ratio for each in compute_forced_ratios(scene)]
    three = [each.ratio for each in compute_forced_ratios(light)]
    assert three[::2] == pytest.approx(two, rel=1e-6)
    assert three[1::2] == pytest.approx([each**2 for each in two], rel=1e-6), "each body drives the next alike"
    assert compute_forced_ratios(scene.with_values({"bodies": [scene.bodies[0].model_dump(exclude_none=True)]})) == []


def test_the_fold_of_the_denominator_is_in_viscous_surfaces() -> None:
    """The proof that no friction makes them differentiable."""
    assert gather_evidence(CaseInReading("fig4-viscous", LITERAL_SUPREMUM, 8)).ground.kind == "fold"


def test_claims_are_tested_only_with_all_scenes_of_the_paper() -> None:
    study = Study((load_scene("fig3-I"),), 4, 1e-3)
    assert Claims().tasks(study) == []
    assert Claims().collect(study, None, TaskResults()) is None
    for analysis in (Scaling(), Convergence()):
        assert {task.about.name for task in analysis.tasks(study)} == {"fig3-I"}


def test_a_flat_surface_is_no_fold_however_its_errors_are_curved() -> None:
    evidence = _seen(np.full((N, N), 1.3), SEVERAL_PEAKS)
    assert _describe_curvatures(replace(evidence, case="dry")) == "dry: mu_1 flat, mu_2 fold (h^1.0)"


def test_the_reason_of_unequal_axes_is_the_number_of_the_second_body() -> None:
    for second, verdict in ((0.9, MET), (1e-4, NOT_MET)):
        found = find_unequal_axes(replace(_seen(FOUR, TWO), apart=(0.3, second)))
        assert (found.verdict, found.reason) == (verdict, f"|x_2 - y_2| up to {second:.2g} of the largest")


@pytest.mark.parametrize("verdict", [MET, NOT_MET, NOT_COMPARED])
def test_every_verdict_on_a_statement_has_a_reason(verdict: Verdict) -> None:
    with pytest.raises(ValueError, match="needs one"):
        StatementVerdict(verdict, "")


@pytest.mark.parametrize(("best", "verdict"), [(counting.SHARE, MET), (counting.MIN_SHARE, NOT_MET)])
def test_peaks_count_at_the_stated_prominence_alone(
    best: float, verdict: Verdict, monkeypatch: pytest.MonkeyPatch
) -> None:
    def count(mu: Array, error: float, share: float) -> PeakCounts:
        return PeakCounts(4, 3) if share == best else PeakCounts(9, 9)

    monkeypatch.setattr(checks, "PEAK_COUNTS_BY_VIEW", {"periodic": count})
    found = count_peaks(Evidence(CORNERS[..., None], 1e-4, ("ok",)), PeakCounts(4, 3))
    assert found.verdict == verdict
    assert "4 to 9" in found.reason
