"""Options of the study's command line, checked before anything is computed."""

import argparse
import signal
from collections.abc import Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path

from comparison.cli.arguments import CommandParser, read_bounds, read_number, read_number_of_jobs, read_whole_number
from comparison.cli.user_models import add_models, load_user_models
from comparison.registry import EVERYTHING, FEATURES, SELECTABLE
from comparison.runner.cache import refuse_foreign_store
from comparison.runner.output import refuse_foreign_report, resolve_destination
from comparison.study.models import Model
from comparison.study.selection import Selection, make_selection, refuse_unknown
from comparison.study.study import STUDY_TOLERANCE, refuse_same_names
from reference.problem import Family, Scene, SceneError, builtin_scenes, example_scenes, load_family
from reference.problem.acceptance import Acceptance

MIN_TOLERANCE = 1e-8  # smallest relative error of the amplification that --tolerance may ask for
DEFAULT_GRID = 48  # number of phases per axis if --grid is not given


@dataclass(frozen=True)
class Options:
    """Checked options of the command line of `python -m comparison.run`."""

    families: tuple[Family, ...]  # scenes of each file: several if a value in it runs
    grid: int  # phases per axis
    out: Path  # folder of the report
    jobs: int  # number of worker processes
    tolerance: float  # relative error asked of every amplification
    budget: float | None  # s, wall time after which the run ends with the last complete level; None: no limit
    check: bool  # whether broken acceptance limits decide the exit code
    plan: bool  # whether to print what would be computed, and compute nothing
    fresh: bool = False  # whether to compute anew what earlier runs stored
    scheduler: str | None = None  # address of the cluster, None for worker processes
    full: bool = False  # whether to compute also what the scenes do not require
    max_work: float | None = None  # largest number of Exudyn's steps for a phase pair, None for the usual one
    selection: Selection = EVERYTHING  # analyses that are run
    models: tuple[Model, ...] = ()  # user's engines

    @property
    def scenes(self) -> tuple[Scene, ...]:
        """Return every scene of every scene file, in order."""
        return tuple(scene for family in self.families for scene in family.scenes)


def parse_options(argv: Sequence[str]) -> Options:
    """Return the checked options of `python -m comparison.run`. Raises SceneError, UsageError."""
    words = _parser().parse_args(argv)
    names: list[str] = words.scenes or builtin_scenes()
    amplitude = _read_optional_number("--amplitude", words.amplitude, 1e-12, 1e6, "m/s^2")
    families = tuple(load_family(name, amplitude, read_bounds(words)) for name in names)
    selection = _read_selection(words, families)
    options = Options(
        families=families,
        grid=DEFAULT_GRID if words.grid is None else read_whole_number("--grid", words.grid, 2, 512),
        out=resolve_destination(words.out),
        jobs=read_number_of_jobs(words),
        tolerance=_read_optional_number("--tolerance", words.tolerance, MIN_TOLERANCE, 0.1, "relative error of mu")
        or STUDY_TOLERANCE,
        budget=_read_optional_number("--budget", words.budget, 1.0, 1e7, "s of the whole run"),
        check=words.check,
        plan=words.plan,
        fresh=words.fresh,
        full=words.full,
        max_work=_read_optional_number("--max-work", words.max_work, 1.0, 1e12, "steps of Exudyn for a phase pair"),
        scheduler=words.scheduler,
        selection=selection,
        models=load_user_models(words.model, words.model_limit, words.scheduler),
    )
    _refuse_contradictions(options, names)
    return options


def _refuse_contradictions(options: Options, sources: Sequence[str]) -> None:
    """Raise SceneError if options contradict each other, or the system or the report's folder does not allow them."""
    if options.check:
        _refuse_limits_of_no_engine(options.scenes, [model.key for model in options.models])
    loaded = list(zip(sources, options.families))
    refuse_same_names((source, family.name) for source, family in loaded)
    refuse_same_names((source, scene.name) for source, family in loaded for scene in family.scenes)
    if options.budget is not None and not hasattr(signal, "setitimer"):
        raise SceneError("command line", "--budget", options.budget, "needs a timer that this system does not have")
    if not options.plan:
        _refuse_unusable_folder(options.out)


def _refuse_unusable_folder(out: Path) -> None:
    """Raise SceneError if the folder holds foreign files, or stored results that the report cannot read."""
    try:
        for field in (field for feature in FEATURES for field in feature.stored):
            assert field.load is not None
            field.load(out)
    except (OSError, ValueError) as error:
        raise SceneError("command line", "--out", str(out), f"the report cannot show {error}") from None
    refuse_foreign_report(out)
    refuse_foreign_store(out)


def _refuse_limits_of_no_engine(scenes: Sequence[Scene], engines: Sequence[str]) -> None:
    """Raise SceneError if a scene states limits on a user's engine that `--model` does not enter."""
    for scene in scenes:
        for name, limits in scene.acceptance.user_engine_limits.items():
            if name not in engines:
                near = get_close_matches(name, [*engines, *Acceptance.model_fields], n=1, cutoff=0.5)
                hint = f"did you mean {near[0]}?" if near else f"--model {name}=module:function enters it"
                rule = f"this study has no engine of this name; {hint}"
                raise SceneError(scene.name, f"acceptance.{name}", limits.limits_by_key(), rule)


def _parser() -> CommandParser:
    """Return the parser of the command line."""
    description = "The paper's equations against a multibody engine over a grid of initial phases, as a report."
    parser = CommandParser("run", description)
    parser.add_scenes(
        f"{', '.join(builtin_scenes())}; with a recorded motion: {', '.join(example_scenes())}; in a file one key may "
        "run over a range"
    )
    parser.add_argument("--grid", metavar="N", help=f"phases per axis (default {DEFAULT_GRID})")
    parser.add_out("report")
    parser.add_computing()
    parser.add_argument(
        "--tolerance",
        metavar="X",
        help="relative error asked of every mu; the equations are asked for 1e-6 or better "
        f"(default {STUDY_TOLERANCE:g})",
    )
    parser.add_argument(
        "--budget",
        metavar="SECONDS",
        help="time for the whole run: it ends with the report of the last level that is complete by then",
    )
    parser.add_argument("--amplitude", metavar="A", help="largest ground acceleration amplitude of every scene, m/s^2")
    parser.add_argument(
        "--full",
        action="store_true",
        help="compute every phase pair and model in full, even what the scene does not require; --plan lists that",
    )
    parser.add_argument(
        "--max-work",
        metavar="STEPS",
        help="most steps that Exudyn may take for a phase pair (default 2e6); a scene that needs more is refused "
        "before any step",
    )
    parser.add_bounds()
    add_models(parser)
    names, on_request = ", ".join(EVERYTHING.names), ", ".join(each.name for each in SELECTABLE if each.on_request)
    parser.add_argument("--only", metavar="LIST", help=f"make these analyses only, separated by commas: {names}")
    parser.add_argument("--skip", metavar="LIST", help="make all analyses but these")
    parser.add_argument("--also", metavar="LIST", help=f"make these analyses, too: {on_request}")
    parser.add_argument("--check", action="store_true", help="exit 1 if a scene's acceptance limits are broken")
    parser.add_argument(
        "--plan", action="store_true", help="print what would be computed and roughly how long it takes; run nothing"
    )
    return parser


def _read_selection(words: argparse.Namespace, families: Sequence[Family]) -> Selection:
    """Return which analyses --only, --skip and --also select. Raises SceneError."""
    only, skip, also = (_read_analyses(f"--{name}", getattr(words, name)) for name in ("only", "skip", "also"))
    if only is not None and skip is not None:
        raise SceneError("command line", "--skip", words.skip, "names what --only leaves out anyway: give one of them")
    return make_selection(SELECTABLE, (scene for family in families for scene in family.scenes), only, skip, also)


def _read_analyses(option: str, text: str | None) -> list[str] | None:
    """Return the names of analyses in the comma-separated text of an option. Raises SceneError."""
    if text is None:
        return None
    names = [name.strip() for name in text.split(",")]
    try:
        refuse_unknown(names, SELECTABLE, added=option == "--also")
        return names
    except ValueError as error:
        raise SceneError("command line", option, text, str(error)) from None


def _read_optional_number(option: str, text: str | None, least: float, most: float, unit: str) -> float | None:
    """Return the value of an option that takes a number; None if it is not given. Raises SceneError."""
    return None if text is None else read_number(option, text, least, most, unit)
