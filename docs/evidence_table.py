"""
What the pages state from records: `python docs/evidence_table.py` writes it anew.

- evidence.json holds what the tests of the checks found: `python docs/evidence_table.py --measure [WORD]` runs them, or
  those whose names hold a word.
- recorded.json of comparison/evidence/validation holds the measured motions: `python docs/evidence_table.py --measured
  FOLDER` computes it from the published files.
- benchmarks.json is what `phase-resonance benchmarks --mastodon FILE` writes.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable, Sequence
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from tempfile import TemporaryDirectory
from xml.etree import ElementTree

import measured_statements as statements
import yielding_friction

from comparison.evidence.benchmarks.table import STORED as PUBLISHED
from comparison.evidence.benchmarks.table import Benchmarks, word_page
from comparison.evidence.sides import ENGINE, EQUATIONS
from comparison.evidence.validation.command import compare_folder
from comparison.evidence.validation.table import STORED as MEASURED
from comparison.evidence.validation.table import load_record, verdict_line
from comparison.report.verification import CHECKS, CodeCheck
from comparison.verdicts import NOT_COMPARED, NOT_MET, count_verdicts, judge_error, word_counts, word_verdict

DOCS = Path(__file__).parent
ROOT, STORE = DOCS.parent, DOCS / "evidence.json"
HEAD = "| claim | independent check | result | limit | met? | repeated by | at |\n|---|---|---|---|---|---|---|"
LEADING = (  # experiment and quantity of rows that lead the table
    *((f"frame, {run}, friction of the load", "half range") for run in ("350 g", "550 g")),
    *((f"frame, {run}", "half range") for run in ("350 g", "450 g", "550 g")),
    ("frame, 450 g", "rms about the mean"),
    *(("frame, 450 g", name) for name in statements.INSTANTS),
    ("pendulum, decay", "turning point 10"),
    ("pendulum, decay", "turning point 11"),
    ("pendulum, large angles", "half period at 1.5 rad"),
)
CLAIMS = {"reference": "the equations are solved", "engine": "the engine's model is solved"}
QUANTITIES = (
    "| quantity | use | D | u_D | u_input | E equations | u_num | E engine | u_num | u_val | verdict |\n"
    "|---|---|---|---|---|---|---|---|---|---|---|"
)


def published() -> Benchmarks:
    """Return the recorded numbers that are published elsewhere."""
    found = PUBLISHED.load(DOCS)
    assert found is not None
    return found


def measured_rows() -> list[str]:
    """Return one row for each quantity of LEADING: the comparison error of both codes against u_val."""
    stored = load_record()
    commit = stored.run["provenance"]["commit"][:7]
    known = {(each.experiment, each.name): each for each in stored.quantities}
    rows = []
    for key in LEADING:
        each = known[key]
        sides = [each.sides[name] for name in (EQUATIONS, ENGINE)]
        found = ", ".join("none" if side.error is None else f"{side.error:+.2g}" for side in sides)
        rows.append(
            f"| the {each.name} of the {each.experiment}, {each.measured:.4g} {each.unit} | measurement ({each.use}) "
            f"| E = {found} {each.unit} (equations, engine) | u<sub>val</sub> = {sides[0].validation:.2g} {each.unit} "
            f"| {each.word_both()} | `phase-resonance validation FOLDER` | {commit} |"
        )
    return rows


def published_rows() -> list[str]:
    """Return one row for each side: how many of the published numbers it meets."""
    table, rows = published(), []
    for side, name in ((EQUATIONS, "the equations give"), (ENGINE, "the engine gives")):
        numbers = [row.numbers[side] for each in table.benchmarks for row in each.rows]
        counts = count_verdicts(number.verdict for number in numbers)
        why = dict.fromkeys(number.explanation or "not explained" for number in numbers if number.verdict == NOT_MET)
        verdict = "met" if counts["met"] == len(numbers) else f"not met: {'; '.join(why)}"
        rows.append(
            f"| {name} numbers published elsewhere | closed forms and other programs, [all](benchmarks.md) "
            f"| {word_counts(counts, 'number')} | the error of both | {verdict} "
            f"| `phase-resonance benchmarks --mastodon FILE` | {table.run['provenance']['commit'][:7]} |"
        )
    return rows


def measure(word: str) -> None:
    """Run the tests of the checks and keep the value of each that is nearest to its limit, with commit and day."""
    chosen = [check for check in CHECKS if word in check.test]
    names = [f"{ROOT / 'tests' / check.file}::{check.test}" for check in chosen]
    with TemporaryDirectory() as folder:
        found = Path(folder, "found.xml")
        run = [sys.executable, "-m", "pytest", "-q", "-n0", "-m", "long or not long", f"--junitxml={found}"]
        subprocess.run([*run, "-o", "junit_family=xunit1", *names], check=True)
        cases = list(ElementTree.parse(found).iter("testcase"))
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], check=True, capture_output=True, text=True)
    at = {"commit": commit.stdout.strip(), "date": f"{datetime.now(UTC):%Y-%m-%d}"}
    store = json.loads(STORE.read_text(encoding="utf-8")) if STORE.exists() else {}
    for check in chosen:
        own = [case for case in cases if case.get("name", "").split("[")[0] == check.test]
        texts = [each.get("value", "") for case in own for each in case.iter("property")]
        value, limit = max(
            (tuple(map(float, text.split(" of "))) for text in texts), key=lambda pair: pair[0] / pair[1]
        )
        store[check.test] = {"value": value, "limit": limit, **at}
    STORE.write_text(json.dumps(store, indent=1) + "\n", encoding="utf-8")


def record_measured(folder: Path) -> None:
    """Compute the measured motions and keep all but the curves, which are of the files of others."""
    place = ROOT / "comparison/evidence/validation/recorded.json"
    place.write_bytes(MEASURED.as_json(replace(compare_folder(folder), curves=[])))


def check_row(check: CodeCheck) -> str:
    """Return one row; a limit of 1 is that of an error which each value states."""
    found = json.loads(STORE.read_text(encoding="utf-8")).get(check.test)
    if found is None:
        result, verdict, at = "no number is recorded", NOT_COMPARED, "every night"
    else:
        value, limit = found["value"], found["limit"]
        result = f"{value:.2g} of it" if limit == 1.0 else f"{value:.1e}"
        verdict = word_verdict(judge_error(value, limit), value, None)
        at = f"{found['commit']}, {found['date']}"
    test = f"`{check.file}::{check.test}`"
    return f"| {CLAIMS[check.side]} | {check.against} | {result} | {check.closeness} | {verdict} | {test} | {at} |"


def evidence() -> str:
    """Return the table of evidence."""
    return "\n".join([HEAD, *measured_rows(), *published_rows(), *map(check_row, CHECKS)])


def quantities() -> str:
    """Return the table of all measured quantities."""
    rows = []
    for each in load_record().quantities:
        sides = [each.sides[side] for side in (EQUATIONS, ENGINE)]
        errors = [number for side in sides for number in (side.error, side.numerical)]
        shown = ["none" if n is None else f"{n:.2g}" for n in (each.data, each.inputs, *errors, sides[0].validation)]
        title = f"{each.experiment}: {each.name}, {each.unit}"
        rows.append(f"| {' | '.join([title, each.use, f'{each.measured:.5g}', *shown, each.word_both()])} |")
    return "\n".join([QUANTITIES, *rows])


def explanations() -> str:
    """Return what is not met, by its explanation."""
    lines = []
    for cause, rows in load_record().explanations().items():
        lines.append(f"- {cause[0].upper()}{cause[1:]}.")
        lines += [f"  - {each.experiment}: {each.name}, {each.word_both()}" for each in rows]
    return "\n".join(lines)


def counts() -> str:
    """Return the counts of the verdicts on measured quantities."""
    return f"{verdict_line(load_record())}."


def facts() -> str:
    """Return inputs and facts, as recorded."""
    table = load_record()
    return "\n".join(f"- {text[0].upper()}{text[1:]}." for text in (*table.inputs, *table.facts))


def limits() -> str:
    """Return what the measured motions validate, and what they hide."""
    table = load_record()
    sentences = [statements.word_what_is_validated(table), statements.word_calibrated(table)]
    sentences += [f"{statements.word_fit(table, law)}: {statements.word_motions(table, law)}" for law in (True, False)]
    sentences += [statements.word_instants(table), statements.word_predicted_pendulum(table)]
    return "\n".join(f"- {text[0].upper()}{text[1:]}." for text in sentences)


def findings() -> str:
    """Return what the errors of several quantities have in common."""
    table = load_record()
    words = (statements.word_motions_farther_off, statements.word_last_swings, statements.word_large_angles)
    return "\n".join(f"- {text[0].upper()}{text[1:]}." for text in (word(table) for word in words))


def yielding() -> str:
    """Say what a yield displacement changes against measurements and against MASTODON."""
    found = json.loads(yielding_friction.STORED.read_text(encoding="utf-8"))
    states = (yielding_friction.state_frame, yielding_friction.state_pendulum, yielding_friction.state_mastodon)
    return "\n".join(f"- {state(found)}" for state in states)


BLOCKS: dict[Path, Sequence[Callable[[], str]]] = {
    DOCS / "evidence.md": (evidence, limits),
    DOCS / "theory.md": (yielding_friction.displacement_table,),
    DOCS / "validation.md": (limits, counts, quantities, explanations, findings, facts, yielding),
}


def with_blocks(file: Path) -> str:
    """Return the text of a page with what its records say in its places."""
    text = file.read_text(encoding="utf-8")
    for make in BLOCKS[file]:
        begin, end = f"<!-- {make.__name__}, by evidence_table.py -->\n", "<!-- end -->\n"
        before, rest = text.split(begin)
        text = before + begin + make() + "\n" + end + rest.split(end, 1)[1]
    return text


def with_readme_rows(text: str) -> str:
    """Return the text of README with the rows about measurements and the published numbers in their places."""
    lines = text.split("\n")
    measured = [k for k, line in enumerate(lines) if line.startswith("|") and "**measured**" in line]
    lines[measured[0] : measured[-1] + 1] = statements.readme_rows(load_record())
    begin = next(k for k, line in enumerate(lines) if line.startswith("| benchmark |"))
    lines[begin : lines.index("", begin)] = published_short()
    return "\n".join(lines)


def published_short() -> list[str]:
    """Return the table of five published numbers."""
    return [line for line in word_page(published()).split("\n## ")[0].splitlines() if line.startswith("|")]


if __name__ == "__main__":
    if "--measure" in sys.argv[1:2]:
        measure("".join(sys.argv[2:]))
    if "--measured" in sys.argv[1:2]:
        record_measured(Path(sys.argv[2]))
    for made in BLOCKS:
        made.write_text(with_blocks(made), encoding="utf-8")
    readme = ROOT / "README.md"
    readme.write_text(with_readme_rows(readme.read_text(encoding="utf-8")), encoding="utf-8")
    (DOCS / "benchmarks.md").write_text(word_page(published()), encoding="utf-8")
