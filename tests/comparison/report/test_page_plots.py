"""Plots of the folded sections and the words of the trade-off say what the results hold."""

import re
from dataclasses import replace

import pytest

from comparison.analyses.panels import trend_panels
from comparison.analyses.tradeoff.feature import tradeoff_answers, tradeoff_panels
from comparison.analyses.tradeoff.trade import Answered, Entry, Trade
from comparison.analyses.trends import Trend
from comparison.report.glossary import GLOSSARY, emphasized, explained
from comparison.report.page import content_policy
from comparison.report.plots import MAX_CURVES


def _entry(method: str, seconds: float, error: float | None, value: float = 1e-3) -> Entry:
    sizes = (error, error)
    half = tuple(None if size is None else 1e-3 * size for size in sizes)  # of the points, within less
    return Entry(
        "exact", method, "tolerance", "", value, True, False, 4, 4, seconds, half, sizes, half, None, (True,) * 2
    )


QUESTION = Answered("exact", "exact equations", 4, "itself", 1e-9, [])
SLOW, FAST = _entry("slow", 0.2, 1e-7, 1e-7), _entry("fast", 0.01, 5e-4)
TRADE = Trade("fig3-I", "Case I", "0", 2, [QUESTION], [SLOW, FAST], {})


def test_the_answer_is_the_cheapest_method_within_the_error() -> None:
    (answer,) = tradeoff_answers(TRADE)
    assert "for 1e-03 ask fast, tolerance 0.001 (10 ms)" in answer["text"]
    assert "for 1e-06 ask slow, tolerance 1e-07 (200 ms)" in answer["text"]


def test_a_method_without_an_estimate_is_the_last_resort() -> None:
    quick = replace(FAST, method="quick", seconds=1e-3, controlled=False)
    (both,), (alone,) = (tradeoff_answers(replace(TRADE, entries=entries)) for entries in ([FAST, quick], [quick]))
    assert "for 1e-03 ask fast" in both["text"]
    assert "for 1e-03 ask quick, tolerance 0.001 (1 ms, no error estimate)" in alone["text"]


def test_a_method_that_lacks_values_is_not_asked() -> None:
    (answer,) = tradeoff_answers(replace(TRADE, entries=[replace(FAST, answered=3)]))
    assert answer["text"] == "for 1e-02 none; for 1e-03 none; for 1e-04 none; for 1e-06 none."


def test_no_panel_has_more_curves_than_can_be_told_apart() -> None:
    many = [_entry(f"method {number}", 0.1, 1e-3) for number in range(9)]
    panels = tradeoff_panels(replace(TRADE, entries=many))
    assert len(panels) == 2, "the platform and the last body"
    assert all(len(panel["plot"]["series"]) == MAX_CURVES for panel in panels)
    assert panels[1]["plot"]["bands"] == [{"from": 1e-30, "to": QUESTION.error}], "below the reference's own error"


def test_a_fitted_slope_is_in_the_legend() -> None:
    trend = Trend(
        scene="fig3-I", body=1, what="exact minus small, supremum", parameter=(1.0, 0.5), medians=(0.1, float("nan")),
        exponent=2.01, uncertainty=0.03, points=8, pairs=4, expected=2.0, verdict="",
    )  # fmt: skip
    (panel,) = trend_panels([trend], "s")
    (line,) = panel["plot"]["series"]
    assert line["name"] == "μ_1, exact minus small, supremum: slope 2.01 ± 0.03"
    assert line["y"] == [0.1, None]
    assert panel["plot"]["x"] == {"title": "s", "log": True}
    softer = replace(trend, what="engine, contact", exponent=float("nan"), parameter=(3e-3, 1e-3))
    other = replace(trend, scene="fig4-dry")
    first, second, third = trend_panels([other, trend, *[softer] * (MAX_CURVES + 1)], "")
    assert [each["title"] for each in (second, third)] == ["fig3-I", "fig4-dry"]
    assert first["title"] == f"fig3-I, {MAX_CURVES} of {MAX_CURVES + 1} differences: the table has all"
    assert [each["plot"]["x"]["title"] for each in (first, second)] == ["penetration, ρ", "v_reg, m/s"]
    assert first["plot"]["y"] == {"title": "median relative difference", "log": True}
    assert [line["name"] for line in first["plot"]["series"]] == ["μ_1, engine, contact: slope none"] * MAX_CURVES


@pytest.mark.parametrize("word", GLOSSARY)
def test_a_word_of_the_glossary_is_explained_where_it_is_first(word: str) -> None:
    text = str(explained(f"The {word} & the {word}."))
    assert text.count("data-tip") == 1
    assert "&amp;" in text


def test_the_policy_names_script_and_style_by_their_hash() -> None:
    """Of the empty text: the well-known digest of nothing."""
    policy = content_policy("", "")
    assert policy.count("'sha256-47DEQpj8HBSa+/TImW+5JCeuQeRkm5NMpJWZG3hSuFU='") == 2
    assert "default-src 'none'" in policy


def test_how_much_and_why_are_in_bold() -> None:
    text = "platform: it gives 0.07 % less (median over 4 pairs). Cause: springs, not rods. They agree to 0.02 %."
    bold = re.findall("<strong>(.*?)</strong>", str(emphasized(text)))
    assert bold == ["platform: it gives 0.07 % less", "Cause: springs, not rods."]
