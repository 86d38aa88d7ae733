"""The question that other codes are asked, and the page of their answers."""

import json
from types import SimpleNamespace

import compare_engines
import numpy as np
from pages import ROOT

DOCS = ROOT / "docs"
QUESTION = json.loads((DOCS / "question.json").read_text(encoding="utf-8"))


def test_the_page_of_engines_and_the_question_are_as_measured_and_as_asked(monkeypatch):
    nothing = SimpleNamespace(mu=np.zeros((64, 2)), error=np.zeros((64, 2)))
    monkeypatch.setattr(compare_engines.reference, "amplification", lambda *rest, **law: nothing)
    asked = compare_engines.question()
    for made, kept in zip(asked["scenes"].values(), QUESTION["scenes"].values()):
        made.update(mu=kept["mu"], error=kept["error"])
    assert asked == QUESTION
    order = [engine.name for engine in compare_engines.ENGINES]
    rows = json.loads((DOCS / "engines.json").read_text(encoding="utf-8"))
    rows.sort(key=lambda row: (row["scene"], order.index(row["engine"]), row["seconds"]))
    text, page = compare_engines._page(rows), (DOCS / "engines.md").read_text(encoding="utf-8")
    assert text.split("\nMeasured with")[0] == page.split("\nMeasured with")[0]
