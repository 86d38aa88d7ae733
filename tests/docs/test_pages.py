"""The pages say what is so: links lead somewhere, examples run, and numbers are those that are recorded."""

import ast
import json
import re
import tomllib
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import compare_engines
import evidence_table
import gallery_pictures as gallery
import matplotlib.pyplot as plt
import measured_statements as statements
import numpy as np
import pytest
from pages import PAGES, ROOT
from PIL import Image
from stated_numbers import STATED, Stated, numbers_of

from comparison.evidence.benchmarks.table import word_page as benchmarks_page
from comparison.evidence.validation.table import load_record
from comparison.report.results import VALIDATED, VALIDATED_BRIEFLY
from comparison.report.verification import CHECKS
from reference.problem import Scene

DOCS = ROOT / "docs"
README = (ROOT / "README.md").read_text(encoding="utf-8")
LINK = re.compile(r"\]\((?!https?://|mailto:)([^)\s]+)\)")
CODE = re.compile(r"^```.*?^```$|`[^`\n]+`", flags=re.MULTILINE | re.DOTALL)
EXAMPLES = sorted([*(ROOT / "examples").glob("*.py"), *(ROOT / "examples").glob("*.ipynb")])
MAX_LINES = 60


def test_the_readme_is_short_and_has_two_commands_of_one_line() -> None:
    assert README.count("\n") <= 100
    assert README.count("![") == 1
    blocks = re.findall(r"^```sh\n(.*?)^```$", README, flags=re.MULTILINE | re.DOTALL)
    assert [block.count("\n") for block in blocks] == [1, 1]
    assert all(block.startswith("python3 -m venv .venv && .venv/bin/pip install ") for block in blocks)
    assert blocks[0].endswith("-m comparison.run\n")
    assert blocks[1].endswith("-m pytest -n auto --dist loadfile\n"), "by continuous integration"


def test_pages_name_extras_that_can_be_installed() -> None:
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["optional-dependencies"]
    for page in PAGES:
        named = re.findall(r"'\.\[([\w,]+)\]'", page.read_text(encoding="utf-8"))
        assert {part for words in named for part in words.split(",")} <= {*extras}, page.name


def test_the_keys_that_the_guide_shows_make_a_scene() -> None:
    page = (DOCS / "guide/building.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```toml\n(.*?)^```$", page, flags=re.MULTILINE | re.DOTALL)
    shown = next(tomllib.loads(block) for block in blocks if "bars" in block)
    box = {"size": [5.0, 5.0, 0.6]}
    scene = Scene.model_validate(
        {
            "title": "as shown",
            "duration": 5.0,
            "isolator": {**shown["isolator"], "sphere_radius": 0.1},
            "bodies": [{"mass": 3e4, "height": 0.5, **box}, {**shown["bodies"][0], "height": 3.5, **box}],
            "excitation": {"amplitudes": [[1.5, 0.0], [0.0, 1.5]], "periods": [1.1, 0.7], "decay": [0.3, 0.3]},
        }
    )
    assert scene.stiffness[0, 0] == pytest.approx(12 * 4 * 2e6 / 3.0**3)
    assert scene.isolator.travel == 0.3


def test_the_numbers_from_outside_are_those_of_their_record() -> None:
    page = (DOCS / "benchmarks.md").read_text(encoding="utf-8")
    assert page == benchmarks_page(evidence_table.published())
    rows = evidence_table.published_short()
    assert len(rows) == 2 + 5
    assert "\n".join(rows) in README
    assert "/" not in evidence_table.published().run["command"], "of no machine"


@pytest.mark.parametrize("page", evidence_table.BLOCKS, ids=lambda page: page.name)
def test_a_page_of_evidence_has_what_its_command_writes(page: Path) -> None:
    assert evidence_table.with_blocks(page) == page.read_text(encoding="utf-8")


def test_the_readme_has_the_measurements_of_their_record() -> None:
    assert evidence_table.with_readme_rows(README) == README
    assert all(row in README for row in statements.readme_rows(load_record()))


def test_what_is_said_to_be_validated_is_what_is_recorded() -> None:
    assert statements.word_what_is_validated(load_record()) == VALIDATED
    assert statements.word_what_is_validated_briefly(load_record()) == VALIDATED_BRIEFLY
    for page in (README, *(page.read_text(encoding="utf-8") for page in evidence_table.BLOCKS)):
        for line in re.findall(r".*\bvalidated\b.*", page, flags=re.IGNORECASE):
            allowed = ("Validated is one quantity", "what is validated, and what is not", "isolated")
            assert any(words in line or words in line.lower() for words in allowed), line


def test_every_check_of_the_evidence_is_met_within_the_limit_it_states() -> None:
    store = json.loads(evidence_table.STORE.read_text(encoding="utf-8"))
    for check in CHECKS:
        if (found := store.get(check.test)) is None:
            assert evidence_table.check_row(check).split(" | ")[4] == "not compared", check
            continue
        assert evidence_table.check_row(check).split(" | ")[4] == "met", check
        number = re.match(r"\d+(\.\d+)?(e-\d+)?", check.closeness)
        assert float(number[0]) == found["limit"] if number else found["limit"] == 1.0, check


def test_a_check_beyond_its_limit_is_not_met(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    check = CHECKS[0]
    for value, verdict in ((2e-7, "not met (by +2e-07)"), (1e-8, "met")):
        store = tmp_path / "evidence.json"
        store.write_text(json.dumps({check.test: {"value": value, "limit": 1e-7, "commit": "a", "date": "b"}}))
        monkeypatch.setattr(evidence_table, "STORE", store)
        assert evidence_table.check_row(check).split(" | ")[4] == verdict
    assert evidence_table.check_row(CHECKS[1]).split(" | ")[4] == "not compared"


@pytest.mark.parametrize("stated", STATED, ids=lambda stated: stated.what)
def test_one_thing_has_one_number_on_all_pages(stated: Stated) -> None:
    found = numbers_of(stated, {page: page.read_text(encoding="utf-8") for page in PAGES})
    assert {page.relative_to(ROOT).as_posix() for page, _ in found} >= set(stated.pages), "where it stands"
    for page, number in found:
        assert number == stated.value, page


@pytest.mark.parametrize("stated", STATED, ids=lambda stated: stated.what)
def test_a_second_number_for_one_thing_is_seen(stated: Stated) -> None:
    text = (ROOT / stated.pages[0]).read_text(encoding="utf-8")
    place = next(re.finditer(stated.words, text))
    digit = next(k for k in range(*place.span(1)) if text[k] in "123456789")
    other = text[:digit] + str(int(text[digit]) % 9 + 1) + text[digit + 1 :]
    [(_, number), *_] = numbers_of(stated, {DOCS: other})
    assert number != stated.value


def anchors(page: Path) -> set[str]:
    """Names of the headings, as GitHub and the pages make them."""
    headings = re.findall(
        r"^#+ (.*)$", CODE.sub(lambda m: m[0] if m[0][:3] != "```" else "", page.read_text("utf-8")), re.M
    )
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_the_links_of_a_page_lead_to_files_and_headings(page: Path) -> None:
    text = CODE.sub("", page.read_text(encoding="utf-8"))
    for target in LINK.findall(text):
        file, _, heading = target.partition("#")
        place = (page.parent / file).resolve() if file else page
        assert place.exists(), target
        if heading:
            assert heading in anchors(place), target
    for path in re.findall(r"`((?:comparison|reference|tests|\.github)/[\w/.]+)`", page.read_text(encoding="utf-8")):
        assert page.parent != ROOT or (ROOT / path).exists(), path


@pytest.mark.long
@pytest.mark.parametrize("example", EXAMPLES, ids=lambda example: example.name)
def test_an_example_runs_and_draws_its_picture(example: Path, tmp_path: Path) -> None:
    with Image.open(gallery.run(example, tmp_path)) as drawn:
        assert np.unique(np.asarray(drawn.convert("RGB")).reshape(-1, 3), axis=0).shape[0] > 20  # not an empty page


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda example: example.name)
def test_an_example_has_its_picture_in_the_gallery(example: Path) -> None:
    script = gallery.script_of(example)
    ast.parse(script)
    assert len(script.splitlines()) < MAX_LINES
    page = (DOCS / "gallery.md").read_text(encoding="utf-8")
    assert f"(gallery/{example.stem}.png)" in page
    assert f"../examples/{example.name}" in page
    assert (DOCS / "gallery" / f"{example.stem}.png").stat().st_size > 5000


def test_every_cell_of_the_notebook_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plt, "show", lambda: None)
    names: dict[str, Any] = {}
    for cell in json.loads((DOCS / "tour.ipynb").read_text(encoding="utf-8"))["cells"]:
        if cell["cell_type"] == "code":
            exec("".join(cell["source"]), names)
    plt.close("all")
    result, worst = names["result"], names["worst"]
    assert result.mu.shape == (12, 12, 2)
    assert worst.value >= result.mu[..., 1].max() - worst.error
    assert names["demands"].status == "ok"


def test_the_page_of_engines_and_the_question_are_as_measured_and_as_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    kept_question = json.loads((DOCS / "question.json").read_text(encoding="utf-8"))
    nothing = SimpleNamespace(mu=np.zeros((64, 2)), error=np.zeros((64, 2)))
    monkeypatch.setattr(compare_engines.reference, "amplification", lambda *rest, **law: nothing)
    asked = compare_engines.question()
    for made, kept in zip(asked["scenes"].values(), kept_question["scenes"].values()):
        made.update(mu=kept["mu"], error=kept["error"])
    assert asked == kept_question
    order = [engine.name for engine in compare_engines.ENGINES]
    rows = json.loads((DOCS / "engines.json").read_text(encoding="utf-8"))
    rows.sort(key=lambda row: (row["scene"], order.index(row["engine"]), row["seconds"]))
    text, page = compare_engines._page(rows), (DOCS / "engines.md").read_text(encoding="utf-8")
    assert text.split("\nMeasured with")[0] == page.split("\nMeasured with")[0]
