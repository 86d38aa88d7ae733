"""
A report with every section, of known results, as lines: headings, tables, plots and texts.

    PYTHONPATH=. python tests/comparison/recorded_report.py

writes report/recorded_report.txt anew. Read its difference before it is committed: each line is what a user sees.
"""

import io
import math
import re
from concurrent.futures import ThreadPoolExecutor
from contextlib import redirect_stdout
from dataclasses import replace
from html import unescape
from itertools import count
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from distinct_models import GRID, distinct_hierarchy
from fake_models import known_motions
from known_analyses import analyses_are, known_others
from known_results import FILES, MEASURED, SEARCHED, known_ensemble, leave_beside
from places import scene_text
from report_texts import data_of, page_of, summary_of, text_of
from runs import quick_figures

from comparison.analyses.ensemble import result as ensemble
from comparison.analyses.ensemble.analysis import FRACTILES
from comparison.analyses.errata.analysis import ERRATA, Effect
from comparison.run import main
from reference.measures.peak_demands import unit_of

RECORD = Path(__file__).parent / "report" / "recorded_report.txt"
HIDDEN = re.compile(r'<(script|style)\b.*?</\1>|<th scope="row">phase-resonance.*?</table>', re.DOTALL)
CHANGING = re.compile(  # from run to run and from machine to machine
    r"\.run\.|wall time|processor time in s|\d{4}-\d\d-\d\dT|\bnumpy|\bLinux|digest"
)
CLOSING = re.compile(r"/\w+>")
FEW = {"motions": 1, "places": 1, "demands": 2}  # items of long lists; 6 of others
PAGES = "index.html", "verification.html"
EFFECTS = Effect("fig3-I", 0, ((0.5, -0.25), (None, 0.125))), Effect("fig3-I", 1, error_message="it <broke>")
ERRATA_FOUND = [replace(each, effects=EFFECTS[:number]) for number, each in enumerate(ERRATA[:3])]
DEMANDS: list[tuple[str, int | None]] = [
    *((name, None) for name in ("displacement", "base_shear", "residual", "support_force_min", "uplift")),
    *((name, body) for name in ("acceleration", "drift", "torsion") for body in (1, 2)),
]
FAMILY = "friction = {range = [0.1, 0.2], steps = 2}"


def full_ensemble() -> ensemble.EnsembleResult:
    """Two structures of two bodies with every demand, profiles, floor spectra and a target; all numbers differ."""
    known, number = known_ensemble(), count(1)

    def next_number() -> ensemble.Statistic:
        return ensemble.Statistic(0.0137 * next(number), 0.0001 * next(number))

    def fractiles() -> list[ensemble.Fractile]:
        each = [next_number() for _ in FRACTILES]
        return [ensemble.Fractile(one.value, one.error, share) for one, share in zip(each, FRACTILES)]

    structures, stripes, spectra = [], [], []
    for name in ("tower", "office"):
        isolator = ensemble.Isolator(*(next_number().value for _ in range(4)))  # type: ignore[arg-type]
        structures.append(ensemble.Structure(name, f"The {name}", 2, 9.81e3, isolator))
        for quantity, body in DEMANDS:
            of = name, quantity, body, "exact", unit_of(quantity), 2.0, next(number)
            stripes.append(ensemble.Stripe(*of, next_number(), fractiles(), next_number(), next_number(), {"rim": 1}))
        for body in (1, 2):
            rows = [[next_number(), next_number()] for _ in range(5)]
            spectra.append(ensemble.Spectrum(name, body, 2.0, 0.05, (0.1, 1.0), rows[0], rows[1:4], rows[4]))
    motions = [ensemble.MatchedMotion(motion, 0.31 * next(number), (1.5, 2.5)) for motion in ("motion 1", "motion 2")]
    target = ensemble.Target(0.2, 1.7, (0.1, 1.0), (3.5, 4.5), motions)
    return replace(known, structures=structures, stripes=[*known.stripes, *stripes], spectra=spectra, target=target)


def lines_of(place: Path) -> list[str]:
    """What the report says, a line for each row, heading, plot and item."""
    lines = []
    for name in PAGES:
        shown = HIDDEN.sub("", unescape(page_of(place, name)).replace(str(place.parent), ""))
        parts = (" ".join(part.split()) for part in shown.split("<"))
        lines += [f"{name}: <{part}" for part in parts if part and not CLOSING.fullmatch(part)]
    lines += items("page", data_of(place)) + items("summary", summary_of(place))
    for name in ("summary.md", "junit.xml", "terminal"):
        lines += [f"{name}: {line}" for line in (place / name).read_text(encoding="utf-8").splitlines() if line.strip()]
    printed = re.sub(r"Computed \S+|Provenance.*", "", text_of(place / "report.pdf")[1])
    printed = re.sub(r"[\s-]", "", printed)  # a reader of the file adds them where lines break
    lines += [f"report.pdf: {part}" for part in re.split(r"(?<=[;:%])", printed)]
    return [line for line in lines if not CHANGING.search(line)]


def items(path: str, value: Any) -> list[str]:
    """A line for every text and number of nested data; numbers in six digits, long lists by a few of their items."""
    if isinstance(value, dict):
        return [line for key, inner in value.items() for line in items(f"{path}.{key}", inner)]
    if isinstance(value, list):
        if value and all(isinstance(each, int | float | None) and not isinstance(each, bool) for each in value):
            numbers = np.array([math.nan if each is None else each for each in value], dtype=float)
            seen = " ".join(f"{number:.6g}" for number in (*numbers[:8], *numbers[8::37]))
            return [f"{path}: {seen}"]
        few = value[: FEW.get(path.rsplit(".", 1)[-1], 6)]
        return [line for number, inner in enumerate(few) for line in items(f"{path}.{number}", inner)]
    return [f"{path}: {value:.6g}" if isinstance(value, float) else f"{path}: {value}"]


def report_in(place: Path) -> Path:
    """A report of pairwise different numbers, with what every other command leaves beside it."""
    with pytest.MonkeyPatch.context() as patch:
        quick_figures(patch)
        analyses_are(
            patch,
            motions=known_motions,
            worst_phases=SEARCHED,
            measured=MEASURED,
            errata=ERRATA_FOUND,
            **known_others(),
        )
        leave_beside(place, {**FILES, ensemble.FILE: ensemble.STORED.as_json(full_ensemble())}, "fig3-I")
        family = place.with_name("family.toml")
        family.write_text(scene_text().replace("friction = 0.1", FAMILY), encoding="utf-8")
        words = ["fig3-I", str(family), "synthetic-pair", "--grid", str(GRID), "--skip", "assumptions"]
        words += ["--out", str(place)]
        with redirect_stdout(io.StringIO()) as printed:
            assert main(words, distinct_hierarchy(), ThreadPoolExecutor) == 0
    (place / "terminal").write_text(printed.getvalue().replace(str(place.parent), ""), encoding="utf-8")
    return place


if __name__ == "__main__":
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        RECORD.write_text("\n".join(lines_of(report_in(Path(folder) / "report"))) + "\n", encoding="utf-8")
