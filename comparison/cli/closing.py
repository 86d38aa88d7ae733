"""Terminal output after a run: one table, warnings, the sentences of the page, and the next commands."""

import math
import shlex
import sys
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from comparison.cli.arguments import edit_command_line, format_command_line
from comparison.cli.options import Options
from comparison.cli.terminal import make_table
from comparison.report.results import Results
from comparison.report.scene_result import SceneResult
from comparison.study.levels import StudyLevel
from comparison.surfaces.headline import Headline
from comparison.surfaces.statements import word_unchecked
from comparison.wording import percent, signed
from reference.problem import Scene, builtin_scenes, example_scenes
from reference.support.arguments import name_some

FIRST_SENTENCES = 8  # largest number of headlines that the terminal shows after an intermediate level of a run
FILMED_MODELS = ("translational", "spatial")  # keys of the models that multibody.animate can film
ALERT_LABELS = {  # first words of an alert's line on the terminal, by kind of alert
    "refused": "No answer",
    "limit": "Limit broken",
    "lacking": "Values missing",
    "fault": "solver",
    "swing": "Wide swing",
    "travel": "Travel nearly used up",
}


def print_solver_messages(results: Results) -> None:
    """Print on standard error the messages that solvers reported in this run."""
    for line in results.faults:
        print(f"{ALERT_LABELS['fault']}: {line}", file=sys.stderr)


def print_check(results: Results, scenes: Sequence[Scene]) -> None:
    """Print on standard error, as last lines of a run with --check, broken limits and comparisons without a limit."""
    lines = [f"--check: {line}" for line in word_demands_elsewhere(scenes)]
    lines += [f"limit broken: {alert.scene}: {alert.text}" for alert in results.broken]
    rest = word_unchecked(results.unchecked)
    if not results.limits:
        lines.append("--check: no scene states [acceptance] limits: nothing was checked")
    elif rest:
        lines.append(f"--check: {rest}")
    sys.stdout.flush()  # so that these lines are the last, too, if both outputs go to one file
    for line in lines:
        print(line, file=sys.stderr)


def word_demands_elsewhere(scenes: Sequence[Scene]) -> list[str]:
    """Return a line that names the command that checks the scenes' limits on demands; none without such limits."""
    stated = [scene.name for scene in scenes if scene.acceptance.demands is not None]
    if not stated:
        return []
    return [f"[acceptance.demands] of {name_some(stated, 1)}: phase-resonance ensemble --check checks it"]


def print_closing(console: Console, results: Results, options: Options, words: Sequence[str], report: Path) -> None:
    """Print the last lines of a run: differences, warnings, headlines, the report's place and further commands."""
    _print_differences(console, results)
    console.print(f"The run took {results.run.word_run_times}.", soft_wrap=True)
    on_stderr = ("fault", "limit") if options.check else ("fault",)
    for alert in (alert for alert in results.alerts if alert.kind not in on_stderr):
        color = "red" if alert.level == "red" else "yellow"
        console.print(f"{ALERT_LABELS[alert.kind]}: {alert.line}", style=color, soft_wrap=True)
    for headline in (headline for scene in results.scenes for headline in scene.headlines):
        console.print(headline.sentence, soft_wrap=True)
    if results.measurement_clauses:
        console.print(f"{results.measurements}.", soft_wrap=True)
    # No line break inside the path, so that a user can copy it
    console.print(f"Report: {report / 'index.html'}", soft_wrap=True)
    if results.run.level < results.run.levels:
        console.print(f"This is level {results.run.level} of {results.run.levels}: the same command goes on with it.")
    for line in word_next_commands(results, words):
        console.print(line, soft_wrap=True)


def print_level(console: Console, results: Results, before: Results | None, level: StudyLevel, report: Path) -> None:
    """Print where the report of an intermediate level (grid of phases) is, and its first headlines that are new."""
    console.print(f"{level.title.capitalize()}: {report / 'index.html'}", soft_wrap=True)
    known = set(_headline_sentences(before)) if before else set()
    sentences = [sentence for sentence in _headline_sentences(results) if sentence not in known]
    for sentence in sentences[:FIRST_SENTENCES]:
        console.print(f"  {sentence}", soft_wrap=True)
    if len(sentences) > FIRST_SENTENCES:
        console.print(f"  and {len(sentences) - FIRST_SENTENCES} more on the page.")


def _headline_sentences(results: Results) -> list[str]:
    """Return the main sentence on each body of each scene."""
    return [headline.sentence for scene in results.scenes for headline in scene.headlines]


def word_next_commands(results: Results, words: Sequence[str]) -> list[str]:
    """Return lines with commands to go on with: for a film of the largest difference, for the cost of a finer grid."""
    lines = []
    filmed = [
        (headline, source)
        for scene in results.phased
        if (source := _find_source(scene, words))
        for headline in scene.headlines
        if headline.maximum_model in FILMED_MODELS and math.isfinite(headline.maximum)
    ]
    if filmed:
        largest, source = max(filmed, key=lambda pair: abs(pair[0].maximum))
        lines.append(f"Next: a film of the largest difference: {_film_command(largest, source)}")
    if results.phased and not any(word.startswith("--budget") for word in words):
        finer = format_command_line(
            edit_command_line(words, ["--grid", str(2 * results.grid), "--plan"], options=["--grid"])
        )
        lines.append(f"Next: what a finer grid costs: {finer}")
    return lines


def _film_command(headline: Headline, source: str) -> str:
    """Return the command that films the motion with the largest difference of engine and equations."""
    phases = " ".join(f"{phase:.4f}" for phase in headline.maximum_phases)
    source = f"./{source}" if source.startswith("-") else source  # A leading hyphen would make it an option.
    return f"python -m multibody.animate {shlex.quote(source)} --phases {phases} --model {headline.maximum_model}"


def _find_source(scene: SceneResult, words: Sequence[str]) -> str:
    """
    Return the word by which a command line names the scene; "" if it is one of a family, or its loading was changed.
    """
    if any(word.startswith("--amplitude") for word in words):
        return ""
    if scene.name in (*builtin_scenes(), *example_scenes()):
        return scene.name
    return next((word for word in words if word.endswith(".toml") and Path(word).stem == scene.name), "")


def _print_differences(console: Console, results: Results) -> None:
    """Print a table of relative differences of models: mean, standard deviation, maximum, number of failed points."""
    rows = [row for scene in results.scenes_with("differences") for row in scene.differences]
    if not rows:
        return
    over = " over the phases: mean and standard deviation with sign, maximum of the size"
    console.print(f"Relative differences{over if results.phased else ''}, per body:", soft_wrap=True)
    table = make_table("scene", "body", "difference", "mean", "std. dev.", "maximum", "not ok")
    for row in rows:
        cells = (signed(row.mean), *(percent(size) for size in (row.spread, row.maximum)))
        table.add_row(row.scene, str(row.body), row.pair.replace("-", " "), *cells, str(row.not_ok))
    console.print(table)
