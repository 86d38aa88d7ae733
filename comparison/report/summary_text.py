"""summary.md: the sentences, the limits and the two tables that a pull request should show."""

from __future__ import annotations

import re
from collections.abc import Sequence
from math import isnan

from comparison.report.results import VALIDATED, Results
from comparison.surfaces.waterfall import WaterfallBar
from comparison.wording import degrees, percent, signed
from reference.problem import Outcome

MARKS = re.compile(r"[\\|<>*_`\[\]#~$&!]")


def summary_text(results: Results) -> str:
    """GitHub's Markdown."""
    run, phased = results.run, results.phased
    count = len(results.scenes)
    kinds = [f"{results.grid} × {results.grid} phases"] if phased else []
    kinds += ["one value under each recorded motion"] if len(phased) < count else []
    heading = f"## Phase-resonance study: {count} scene{'' if count == 1 else 's'}, {', '.join(kinds)}"
    parts = [heading, _limits(results), *_alerts(results), _headlines(results)]
    parts += _differences(results) if "differences" not in results.absent else []
    parts += _budget(results) if "budget" not in results.absent else []
    parts += _lost(results)
    shown = {"surfaces": "surfaces to turn" if phased else "", "motions": "motions", "assumptions": "assumptions"}
    names = [name for analysis, name in shown.items() if name and analysis not in results.absent]
    listed = f"{', '.join([*names, 'tables'])} and provenance".capitalize()
    made = ", ".join(
        f"{name} {run.provenance[name]}" for name in ("commit", "exudyn", "numba") if name in run.provenance
    )
    parts.append(
        f"The two codes are cross-verified. {VALIDATED}, and {results.measurements}.  \n"
        f"{_code(run.command)}: {run.took}, began {run.began}; {made}. "
        f"{listed}: `index.html` of the report."
    )
    return "\n\n".join(parts) + "\n"


def _alerts(results: Results) -> list[str]:
    """What a reader must know before trusting a number; broken limits have a list of their own."""
    kinds = ("refused", "lacking", "swing", "travel")
    lines = [f"- {_plain(alert.line)}" for alert in results.alerts if alert.kind in kinds]
    return ["\n".join(lines)] if lines else []


def _limits(results: Results) -> str:
    broken = results.broken
    if not results.limits:
        return "No scene states acceptance limits: nothing was checked."
    if not broken:
        return "**Every acceptance limit holds.**"
    lines = "\n".join(f"- {_plain(f'{alert.scene}: {alert.text}')}" for alert in broken)
    return f"**{len(broken)} acceptance limit{'' if len(broken) == 1 else 's'} broken:**\n\n{lines}"


def _headlines(results: Results) -> str:
    return "\n".join(
        f"- **{_plain(scene.name)}** ({_plain(scene.title)})\n"
        + "\n".join(f"  - {_plain(headline.statement)}" for headline in scene.headlines)
        for scene in results.scenes
    )


def _differences(results: Results) -> list[str]:
    rows = [
        [
            row.scene,
            str(row.body),
            row.pair.replace("-", " "),
            signed(row.mean),
            *(percent(value) for value in (row.spread, row.percentile95, row.maximum)),
            "none" if isnan(row.phases[0]) else f"({degrees(row.phases[0])}, {degrees(row.phases[1])})",
            percent(row.beyond_error),
            f"{row.unanswered} of {row.asked}",
        ]
        for scene in results.scenes_with("differences")
        for row in scene.differences
    ]
    names = ["scene", "body", "difference", "mean", "standard deviation", "95 %", "maximum", "at (α₁, α₂)"]
    names += ["beyond u_D", "no value"]
    note = (
        "Mean and standard deviation are signed, over the phase pairs that every model has; 95 % and maximum are sizes."
    )
    return ["### Differences", note, _table(names, rows, left=3)]


def _budget(results: Results) -> list[str]:
    models = [model for model in results.models[1:] if any(model.key in scene.models for scene in results.scenes)]
    rows = []
    for scene in results.scenes_with("budget"):
        for waterfall in scene.waterfalls:
            sizes = {bar.model: _signed(bar) for bar in waterfall.bars}
            total, points = _signed(waterfall.total), str(waterfall.points)
            cells = (sizes.get(model.key, "") for model in models)
            rows.append([scene.name, str(waterfall.body), *cells, total, points])
    names = ["scene", "body", *(model.title for model in models), "total", "phase pairs"]
    return [
        "### Causes of the difference",
        "Mean of every step with its sign, by the model it leads to, over the phase pairs that every model has. "
        "The steps add up to the total. In parentheses: not known to a fifth of itself.",
        _table(names, rows, left=2),
    ]


def _signed(bar: WaterfallBar) -> str:
    return signed(bar.size) if bar.real else f"({signed(bar.size)})"


def _lost(results: Results) -> list[str]:
    titles = {model.key: model.title for model in results.models}
    lines = [
        f"- {_plain(scene.name)}, {_plain(titles[key])}: {count} × {outcome}"
        for scene in results.scenes
        for key, model in scene.models.items()
        for outcome, count in model.outcomes.items()
        if outcome != Outcome.OK
    ]
    lines += [f"- {_plain(line)}" for line in results.faults]
    return ["### Points that are not ok", "\n".join(lines)] if lines else []


def _code(text: str) -> str:
    """A text as code, between more backticks than stand in it anywhere."""
    fence = "`" * (1 + max((len(ticks) for ticks in re.findall("`+", text)), default=0))
    space = " " if "`" in text else ""
    return f"{fence}{space}{text}{space}{fence}"


def _table(names: Sequence[str], rows: Sequence[Sequence[str]], left: int) -> str:
    rule = [":---" if index < left else "---:" for index in range(len(names))]
    return "\n".join("| " + " | ".join(_plain(cell) for cell in row) + " |" for row in [names, rule, *rows])


def _plain(text: str) -> str:
    """A text on one line in which nothing is read as Markdown, HTML or a formula."""
    shown = "".join(letter if letter.isprintable() else " " for letter in text)
    return MARKS.sub(r"\\\g<0>", shown)
