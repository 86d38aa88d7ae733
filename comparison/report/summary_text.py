"""summary.md: the verdicts, the limits and the two tables that a pull request should show."""

from __future__ import annotations

import re
from collections.abc import Sequence
from math import isnan

from comparison.analysis.surfaces import outcome_counts
from comparison.analysis.verdicts import bar, verdict
from comparison.report.findings import Findings
from comparison.study.models import models_of
from comparison.wording import degrees, percent
from reference.problem import Outcome

MARKS = re.compile(r"[\\|<>*_`\[\]#~$&!]")


def summary_text(findings: Findings) -> str:
    """GitHub's Markdown."""
    study, run = findings.study, findings.run
    count = len(study.scenes)
    kinds = [f"{study.grid} × {study.grid} phases"] if study.phased else []
    kinds += ["one value under each recorded motion"] if len(study.phased) < count else []
    heading = f"## Phase-resonance study: {count} scene{'' if count == 1 else 's'}, {', '.join(kinds)}"
    parts = [heading, _limits(findings), *_unanswered(findings), _verdicts(findings)]
    parts += _differences(findings) if "differences" not in findings.absent else []
    parts += _budget(findings) if "budget" not in findings.absent else []
    parts += _lost(findings)
    sections = [
        name
        for analysis, name in (
            ("surfaces", "surfaces to turn" if study.phased else ""),
            ("trajectories", "motions"),
            ("assumptions", "assumptions"),
        )
        if name and analysis not in findings.absent
    ]
    shown = ", ".join([*sections, "tables"]) + " and provenance"
    made = ", ".join(
        f"{name} {run['provenance'][name]}" for name in ("commit", "exudyn", "numba") if name in run["provenance"]
    )
    parts.append(
        "The two codes are cross-verified, not validated: no measurement is involved.  \n"
        f"{_code(run['command'])}: {run['seconds']} s with {run['jobs']} workers, began {run['began']}; {made}. "
        f"{shown[0].upper()}{shown[1:]}: `index.html` of the report."
    )
    return "\n\n".join(parts) + "\n"


def _unanswered(findings: Findings) -> list[str]:
    """Models without a value somewhere."""
    return ["\n".join(f"- {_plain(one.sentence)}" for one in findings.unanswered)] if findings.unanswered else []


def _limits(findings: Findings) -> str:
    broken = findings.broken
    if not findings.limits:
        return "No scene states acceptance limits: nothing was checked."
    if not broken:
        return "**Every acceptance limit holds.**"
    lines = "\n".join(f"- {_plain(line)}" for line in broken)
    return f"**{len(broken)} acceptance limit{'' if len(broken) == 1 else 's'} broken:**\n\n{lines}"


def _verdicts(findings: Findings) -> str:
    study = findings.study
    said = [(scene, verdict(study, findings.surfaces, scene)) for scene in study.scenes]
    return "\n".join(
        f"- **{_plain(scene.name)}** ({_plain(scene.title)}): {_plain(one.sentence.replace('mu_', 'μ_'))}"
        for scene, one in said
    )


def _differences(findings: Findings) -> list[str]:
    rows = [
        [
            row.scene,
            str(row.body),
            row.pair.replace("-", " "),
            *(percent(value) for value in (row.median, row.percentile95, row.maximum)),
            "none" if isnan(row.phases[0]) else f"({degrees(row.phases[0])}, {degrees(row.phases[1])})",
            percent(row.beyond_error),
            f"{row.unanswered} of {row.asked}",
        ]
        for row in findings.rows_of("differences", findings.rows)
    ]
    names = ["scene", "body", "difference", "median", "95 %", "maximum", "at (α₁, α₂)", "beyond u_D", "no value"]
    return ["### Differences", _table(names, rows, left=3)]


def _budget(findings: Findings) -> list[str]:
    study = findings.study
    models = [model for model in study.hierarchy[1:] if any(model.applies(scene) for scene in study.scenes)]
    rows = []
    for scene in findings.selection.study(study, "budget").scenes:
        for body in range(1, len(scene.bodies) + 1):
            one = bar(study, findings.surfaces, scene, body)
            sizes = {segment.model: percent(segment.size) for segment in one.segments}
            rows.append([scene.name, str(body), *(sizes.get(model.key, "") for model in models), percent(one.total)])
    names = ["scene", "body", *(model.title for model in models), "total"]
    return [
        "### What makes the difference",
        "Mean absolute size of every step, by the model it leads to; steps of opposite sign cancel in the total.",
        _table(names, rows, left=2),
    ]


def _lost(findings: Findings) -> list[str]:
    lines = [
        f"- {_plain(scene.name)}, {_plain(model.title)}: {count} × {outcome}"
        for scene in findings.study.scenes
        for model in models_of(scene, findings.study.hierarchy)
        for outcome, count in outcome_counts(findings.surfaces, scene.name, model.key).items()
        if outcome != Outcome.OK
    ]
    lines += [f"- {_plain(line)}" for line in findings.faults]
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
