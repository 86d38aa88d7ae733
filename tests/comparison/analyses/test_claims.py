"""Every claim on surfaces that show it and that violate it; readings that change what they say; the command."""

from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest
from known_analyses import collected
from numpy.typing import NDArray
from terminal_tables import rows_under

from comparison.analyses.claims import table as table_module  # table: what a test made
from comparison.analyses.claims.checks import Finding, Verdict, counted
from comparison.analyses.claims.claims import CLAIMS, Claim
from comparison.analyses.claims.command import main
from comparison.analyses.claims.evidence import MOTIONS, Evidence, Question, gathered
from comparison.analyses.claims.peaks_and_valleys import Counts
from comparison.analyses.claims.readings import CASES, LIGHT_BODY, OWN_PERIOD, READINGS, Reading, without_effect
from comparison.analyses.claims.smoothness import Bend
from comparison.analyses.claims.table import Claims
from comparison.analyses.convergence.analysis import Convergence
from comparison.analyses.effective_values.analysis import forced_ratios
from comparison.analyses.scaling.analysis import Scaling
from comparison.cli import computing
from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults
from comparison.study.study import Study
from reference import amplification, modes, trajectory
from reference.problem import builtin_scenes, load_scene

Array = NDArray[np.float64]
N = 16
PAPERS = Study(tuple(map(load_scene, builtin_scenes())), 4, 1e-3)  # every scene that the claims are about
A1, A2 = np.meshgrid(*[2.0 * np.pi * np.arange(N) / N] * 2, indexing="ij")
SMOOTH, FOLD = Bend(2.0, (0.0, 0.0)), Bend(1.0, (0.5, 1.0))
RESONANT = ((0.9, 1.0), (1.1, 1.0))  # s: both harmonics at T_c (1 -+ 0.1)


def _seen(mu_1: Array, mu_2: Array, bend: Bend = FOLD, apart: float = 1.0, swing: float = 0.01) -> Evidence:
    mu = np.stack([mu_1, mu_2], axis=-1)
    return Evidence(mu, 1e-4, ("ok",), (bend, bend), (apart, apart), swing, RESONANT, numerators=(bend, bend))


FOUR = 2.5 - np.cos(2.0 * (A1 - A2))  # drawn: four ridges along the diagonal and three valleys between them
TWO = 2.5 - np.cos(A1 - A2)
CORNERS = 1.5 + 0.5 * (np.cos(A1) + np.cos(A2))  # from rest it would have a twin in the center
QUADRANTS = 1.5 - 0.25 * (np.cos(2.0 * A1) + np.cos(2.0 * A2))
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


def _claim(about: str, words: str) -> Claim:
    return next(claim for claim in CLAIMS if claim.figure == about and words in claim.says)


FOUND = {
    "mu_2 has several peaks and valleys, more complex than those of mu_1": "mu_2 4 and 4, mu_1 2 and 2",
    "mu_1 has two peaks separated by a valley": "periodic 1 and 1; drawn 2 and 1; profile 2 and 1",
    "the vibrations are small, (4.2)": "up to 0.01 rho^2",
    "x_2(t) differs from y_2(t)": "|x_2 - y_2| up to 1 of the largest",
    "instead: mu_2 has its peaks near the centers of the quadrants": "peaks at (90°, 90°), (90°, 270°), "
    "(270°, 90°), (270°, 270°)",
}
CENTERED = {**PAPER, "fig3-II": _seen(TWO, QUADRANTS, apart=0.0)}


@pytest.mark.parametrize("claim", CLAIMS, ids=lambda c: f"{c.figure}: {c.says}")
def test_every_claim_holds_on_surfaces_as_described(claim: Claim) -> None:
    verdict = claim.verdict(CENTERED if "quadrants" in claim.says else PAPER)
    assert verdict.finding.holds, verdict.found
    assert FOUND.get(claim.says, verdict.found) == verdict.found


ONE_AXIS, BOTH_AXES, DRY, WET = (PAPER[name] for name in ("fig3-I", "fig3-II", "fig4-dry", "fig4-viscous"))
ROUGH = np.tile([1.0, 3.0], (N, N // 2))  # along one phase
VIOLATIONS: list[tuple[str, str, Mapping[str, Evidence]]] = [
    ("Fig. 3", "small", {"fig3-II": replace(BOTH_AXES, swing=0.2)}),
    ("Fig. 3", "close to resonance", {"fig3-I": replace(ONE_AXIS, resonance=((0.9, 1.0), (1.11, 1.0)))}),
    ("Fig. 3a, b", "more intensively", {"fig3-I": _seen(SEVERAL_PEAKS, FOUR)}),
    ("Fig. 3a", "four peaks", {"fig3-I": _seen(TWO, SEVERAL_PEAKS)}),
    ("Fig. 3a", "four peaks", {"fig3-I": _seen(2.5 + np.cos(3.0 * (A1 - A2)), SEVERAL_PEAKS)}),
    ("Fig. 3a", "four peaks", {"fig3-I": _seen(1.0 + 1e-3 * FOUR, SEVERAL_PEAKS)}),  # no resonance
    ("Fig. 3a", "one-mass", {"fig3-I alone": Evidence(-FOUR[..., None] + 5.0, 1e-4, ("ok",))}),
    ("Fig. 3a", "one-mass", {"fig3-I alone": Evidence(1.0 + 1e-3 * FOUR[..., None], 1e-4, ("ok",))}),  # held
    ("Fig. 3d", "peaks near the corners", {"fig3-II": _seen(TWO, 1.0 + 1e-3 * CORNERS)}),
    ("Fig. 3b", "more complex", {"fig3-I": _seen(SEVERAL_PEAKS, TWO)}),
    ("Fig. 3b", "x_2(t) differs", {"fig3-I": replace(ONE_AXIS, apart=(1.0, 0.01))}),
    ("Fig. 3c", "two peaks", {"fig3-II": _seen(FOUR, CORNERS)}),
    ("Fig. 3c", "one degree", {"fig3-II alone": Evidence(np.roll(TWO, N // 4, axis=0)[..., None], 1e-4, ("ok",))}),
    ("Fig. 3d", "peaks near the corners", {"fig3-II": _seen(TWO, np.roll(CORNERS, N // 2, axis=1))}),
    ("Fig. 3d", "quadrants", {}),
    ("Fig. 3d", "nonresonant", {"fig3-II oscillator": Evidence(SEVERAL_PEAKS[..., None], 1e-4, ("ok",))}),
    ("Fig. 3", "not smooth", {"fig3-I": replace(ONE_AXIS, bends=(FOLD, SMOOTH))}),
    ("Fig. 4a, b", "plane", {"fig4-dry": replace(DRY, apart=(0.0, 1e-3))}),
    ("Fig. 4a", "similar", {"fig4-dry": _seen(FOUR, CORNERS)}),
    ("Fig. 4b", "similar", {"fig4-dry": _seen(TWO, SEVERAL_PEAKS)}),
    ("Fig. 4c, d", "viscous friction makes the surfaces smooth", {"fig4-viscous": replace(WET, bends=(SMOOTH, FOLD))}),
    ("Fig. 4c, d", "between the kinks", {"fig4-viscous": replace(WET, numerators=(SMOOTH, FOLD))}),
    *(("Fig. 4c, d", "smoother", {"fig4-viscous": _seen(rough, CORNERS)}) for rough in (ROUGH, ROUGH.T)),
]


@pytest.mark.parametrize(("about", "words", "changed"), VIOLATIONS, ids=lambda part: str(part)[:40])
def test_a_claim_fails_on_what_violates_it(about: str, words: str, changed: Mapping[str, Evidence]) -> None:
    assert _claim(about, words).verdict({**PAPER, **changed}).finding is Finding.NOT


def test_the_loading_is_near_no_natural_period_of_the_paper() -> None:
    """The chain has 0.63 and 1.69 s in x, 0.58 and 1.45 s in y: 0.9 and 1.1 s are a quarter away from any."""
    verdict = _claim("Fig. 3", "resonance").verdict({"fig3-I": gathered(Question("fig3-I", Reading(0.3), 4))})
    assert verdict == Verdict(Finding.NOT, "0.90 s is -38 % from 1.45 s; 1.10 s is -24 % from 1.45 s")


def test_a_claim_cannot_hold_where_what_its_proof_assumes_is_so() -> None:
    twins = {**PAPER, "fig3-II": replace(BOTH_AXES, twins=True)}
    assert _claim("Fig. 3d", "peaks near the corners").verdict(twins).finding is Finding.CANNOT
    folded = {**PAPER, "fig4-viscous": replace(WET, ground=FOLD)}
    smooth = _claim("Fig. 4c, d", "viscous friction makes the surfaces smooth")
    assert smooth.verdict(folded).finding is Finding.CANNOT
    assert smooth.verdict({**PAPER, "fig4-viscous": replace(WET, ground=SMOOTH)}).finding.holds
    changed = {**twins, **folded, "fig3-II": twins["fig3-II"]}
    impossible = [claim.proof for claim in CLAIMS if claim.verdict(changed).finding is Finding.CANNOT]
    assert len([*filter(None, impossible)]) == len(impossible) == 2


def test_a_case_without_an_answer_leaves_its_claims_open() -> None:
    mu = ONE_AXIS.mu.copy()
    mu[3, 3] = np.nan
    ended, broke = replace(ONE_AXIS, mu=mu, statuses=("ok", "rim reached")), Evidence(error_message="broke")
    changed = {**PAPER, "fig3-I": ended, "fig4-dry": broke}
    assert _claim("Fig. 3a", "four").verdict(changed) == Verdict(Finding.OPEN, "fig3-I: ok, rim reached")
    assert _claim("Fig. 4a", "similar").verdict(changed) == Verdict(Finding.OPEN, "fig4-dry: broke")
    assert _claim("Fig. 3c", "two peaks").verdict(changed).finding.holds


def test_readings_share_every_surface_they_can() -> None:
    wet = CASES["fig4-viscous"](Reading())
    assert without_effect(Reading(peak="regularised"), wet) == without_effect(Reading(peak="supremum"), wet)
    asked = [task.argument for task in Claims(N).tasks(PAPERS)]
    assert len(asked) == len({(question.scene.digest(), question.reading.peak, question.grid) for question in asked})


def test_a_case_that_fails_is_named_and_the_others_answered(monkeypatch: pytest.MonkeyPatch) -> None:
    def gathered(question: Question) -> Evidence:
        if question.case == "fig4-dry":
            raise RuntimeError("singular")
        return PAPER[question.case]

    monkeypatch.setattr(table_module, "gathered", gathered)
    table = collected(Claims(N, READINGS[:2]), PAPERS)
    findings = {claim.says: claim.verdicts[0] for claim in table.claims}
    assert findings["mu_1 is similar to case II"].found == "fig4-dry: solver failed: RuntimeError: singular"
    assert findings["mu_1 has two peaks separated by a valley"].finding.holds


def test_the_command_prints_the_table(monkeypatch, capsys, tmp_path):
    def of_the_paper(question: Question) -> Evidence:
        return PAPER[question.case]

    monkeypatch.setattr(table_module, "gathered", of_the_paper)
    monkeypatch.setattr(computing, "compiling_task", lambda: Task(len, (), "compiling", 0.0, None, False))
    assert main(["--jobs", "2", "--grid", "16", "--words", "--out", str(tmp_path / "report")], ThreadPoolExecutor) == 0
    printed = capsys.readouterr().out
    assert "1 m/s², f_c 0.1 s/m, resolved: 16 of 16" in printed
    assert "periodic 2 and 2; drawn 4 and 3" in printed
    assert "Under no reading: Fig. 3d: instead: mu_2 has its peaks near the centers of the quadrants." in printed
    assert "+ reproduced; d as drawn; - not reproduced; x cannot hold; ? no answer" in printed
    ratios = [row for row in rows_under(printed, "ratio", "without decay") if row["scene"] == "fig3-II"]
    expected = forced_ratios(load_scene("fig3-II"))
    assert [row["ratio"] for row in ratios] == [f"{each.ratio:.2f}" for each in expected]
    assert [row["without decay"] for row in ratios] == [f"{each.steady:.2f}" for each in expected]
    assert not (tmp_path / "report").exists(), "the command writes no report"


def test_evidence_of_the_paper_is_what_the_equations_give() -> None:
    """Short and coarse: the plane of (4.7) to rounding, two unequal axes apart, no fold without a grid to see one."""
    dry = gathered(Question("fig4-dry", Reading(duration=1.5), 4))
    assert (dry.error_message, dry.mu.shape) == ("", (4, 4, 2))
    assert max(dry.apart) < 1e-9
    scene = load_scene("fig4-dry").with_values({"duration": 1.5})
    reach = amplification(scene, MOTIONS, "small", full=True).displacement.max()
    assert dry.swing == pytest.approx((reach / scene.radius) ** 2, rel=1e-3)
    unequal = load_scene("fig3-I").with_values({"duration": 1.5})
    moved = [trajectory(unequal, phase, equations="small").position[:, 1, :2] for phase in MOTIONS]
    apart = max(np.abs(each[:, 0] - each[:, 1]).max() / np.abs(each).max() for each in moved)
    assert gathered(Question("fig3-I", Reading(duration=1.5), 4)).apart[1] == pytest.approx(apart, rel=1e-3)


def test_peaks_that_only_the_cut_square_has_are_as_drawn() -> None:
    """One peak at the corner is four where the square is cut, and none on the profile."""
    found = counted(Evidence(CORNERS[..., None], 1e-4, ("ok",)), Counts(4, 1))
    assert found == Verdict(Finding.AS_DRAWN, "periodic 1 and 1; drawn 4 and 1; profile 0 and 0")


@pytest.mark.parametrize(("half", "error", "flat"), [(0.02, 1e-4, True), (0.03, 1e-4, False), (0.03, 0.05, True)])
def test_a_range_of_a_twentieth_of_the_mean_or_of_the_errors_is_flat(half: float, error: float, flat: bool) -> None:
    assert Evidence(1.0 + half * np.cos(A1)[..., None], error, ("ok",)).flat(1) == flat


def test_readings_change_the_keys_they_name() -> None:
    light = CASES["fig4-dry"](LIGHT_BODY)
    assert light.masses.tolist() == [1.0, 0.1]
    assert light.bodies[1].period == pytest.approx([4.5, 4.5])
    assert light.friction_coefficient == 0.01
    assert light.largest_acceleration == pytest.approx(0.2)
    own = CASES["fig3-I"](OWN_PERIOD)
    assert own.excitation.periods == pytest.approx([0.54, 0.66])
    assert own.excitation.decay == pytest.approx([0.3 / 0.54, 0.3 / 0.66])
    assert np.abs(modes(own).period[:, 1] / 0.6 - 1.0).max() < 0.06, "the short natural periods"
    wet = CASES["fig4-viscous"](OWN_PERIOD)
    assert (wet.lubricated, wet.friction_coefficient) == (True, Reading.lubrication)
    alone = CASES["fig3-I alone"](OWN_PERIOD)
    gaps = np.array(alone.excitation.periods) / float(modes(alone).period[0, 0]) - 1.0
    assert gaps == pytest.approx([-0.1, 0.1]), "close to its own period"
    oscillator = CASES["fig3-II oscillator"](Reading())
    assert (oscillator.isolator.period, oscillator.friction_coefficient) == (1.5, 0.0), "T_3x of the second body"


def test_forced_ratios_are_those_of_oscillator_and_chain() -> None:
    scene = load_scene("fig3-II")
    for each in forced_ratios(scene):
        soft = {"x": 1.5, "y": 1.2}[each.axis]
        s = complex(-0.3 / each.period, 2.0 * np.pi / each.period)
        assert each.steady == pytest.approx(1.0 / abs(1.0 - (soft / each.period) ** 2))
        assert each.ratio == pytest.approx(1.0 / abs(1.0 + (s * soft / (2.0 * np.pi)) ** 2))
    assert [round(each.steady, 2) for each in forced_ratios(scene) if each.axis == "y"] == [1.29, 5.26]
    body = scene.bodies[1].model_dump(exclude_none=True)
    light = scene.with_values({"bodies": [scene.bodies[0].model_dump(exclude_none=True), body, {**body, "mass": 1e-9}]})
    two = [each.ratio for each in forced_ratios(scene)]
    three = [each.ratio for each in forced_ratios(light)]
    assert three[::2] == pytest.approx(two, rel=1e-6)
    assert three[1::2] == pytest.approx([each**2 for each in two], rel=1e-6), "each body drives the next alike"
    assert forced_ratios(scene.with_values({"bodies": [scene.bodies[0].model_dump(exclude_none=True)]})) == []


def test_the_fold_of_the_denominator_is_in_viscous_surfaces() -> None:
    """The proof that viscous friction cannot smooth them: mu_1 times the denominator is smooth."""
    viscous = gathered(Question("fig4-viscous", Reading(), 8))
    assert (viscous.ground.kind, viscous.numerators[0].kind) == ("fold", "smooth")


def test_claims_are_tested_only_with_all_scenes_of_the_paper() -> None:
    study = Study((load_scene("fig3-I"),), 4, 1e-3)
    assert Claims().tasks(study) == []
    assert Claims().collect(study, None, TaskResults()) is None
    for analysis in (Scaling(), Convergence()):
        assert {task.about.name for task in analysis.tasks(study)} == {"fig3-I"}
