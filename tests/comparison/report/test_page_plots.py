"""Plots of the folded sections and the words of the trade-off say what the results hold."""

from dataclasses import replace

from comparison.evidence.tradeoff.feature import make_tradeoff_panels, word_fastest_methods
from comparison.evidence.tradeoff.trade import MeasuredSetting, SceneTrade, SolvedQuestion
from comparison.evidence.trend_feature import make_trend_panels
from comparison.evidence.trends import Trend
from comparison.report.glossary import GLOSSARY, explain_words
from comparison.report.page import make_content_policy
from comparison.report.panels import MAX_CURVES


def _entry(method: str, seconds: float, error: float, value: float = 1e-3) -> MeasuredSetting:
    most, half = (error,) * 2, (1e-3 * error,) * 2
    return MeasuredSetting(
        "exact", method, "tolerance", "", value, True, False, 4, 4, seconds, half, most, half, None, (True,) * 2
    )


QUESTION = SolvedQuestion("exact", "exact equations", 4, "itself", 1e-9, [])
SLOW, FAST = _entry("slow", 0.2, 1e-7, 1e-7), _entry("fast", 0.01, 5e-4)
TRADE = SceneTrade("fig3-I", "Case I", "0", 2, [QUESTION], [SLOW, FAST], {})


def test_the_answer_is_the_cheapest_method_within_the_error() -> None:
    """One without an estimate is the last resort, one that lacks values is not named."""
    quick, none = replace(FAST, method="quick", seconds=1e-3, controlled=False), replace(FAST, answered=3)
    for entries, answers in (
        ([SLOW, FAST], ["for 1e-03 ask fast, tolerance 0.001 (10 ms)", "for 1e-06 ask slow, tolerance 1e-07 (200 ms)"]),
        ([FAST, quick], ["for 1e-03 ask fast"]),
        ([quick], ["for 1e-03 ask quick, tolerance 0.001 (1 ms, no error estimate)"]),
        ([none], ["for 1e-02 none; for 1e-03 none; for 1e-04 none; for 1e-06 none."]),
    ):
        [answer] = word_fastest_methods(replace(TRADE, entries=entries))
        assert [text for text in answers if text not in answer["text"]] == [], answer


def test_no_panel_has_more_curves_than_can_be_told_apart() -> None:
    many = [_entry(f"method {number}", 0.1, 1e-3) for number in range(9)]
    panels = make_tradeoff_panels(replace(TRADE, entries=many))
    assert [len(panel["plot"]["series"]) for panel in panels] == [MAX_CURVES] * 2, "the platform and the last body"
    lines = [line for each in panels for line in each["plot"]["series"]]
    assert all(line["y"] == [1e-3] for line in lines), "what 95 % of the points meet"
    assert panels[1]["plot"]["bands"] == [{"from": 1e-30, "to": QUESTION.error}], "below the reference's own error"


def test_trends_of_a_scene_and_parameter_share_a_panel() -> None:
    trend = Trend(
        scene="fig3-I", body=1, what="exact minus small, supremum", parameter=(1.0, 0.5), medians=(0.1, float("nan")),
        exponent=2.01, uncertainty=0.03, points=8, pairs=4, expected=2.0, verdict="",
    )  # fmt: skip
    softer = replace(trend, what="engine, contact", exponent=float("nan"), parameter=(3e-3, 1e-3))
    other = replace(trend, scene="fig4-dry")
    first, second, third = make_trend_panels([other, trend, *[softer] * (MAX_CURVES + 1)], "")
    assert [each["title"] for each in (second, third)] == ["fig3-I", "fig4-dry"]
    assert first["title"] == f"fig3-I, {MAX_CURVES} of {MAX_CURVES + 1} differences: the table has all"
    assert [each["plot"]["x"]["title"] for each in (first, second)] == ["penetration, ρ", "v_reg, m/s"]
    (line,) = second["plot"]["series"]
    assert (line["name"], line["y"]) == ("μ_1, exact minus small, supremum: slope 2.01 ± 0.03", [0.1, None])
    assert [line["name"] for line in first["plot"]["series"]] == ["μ_1, engine, contact: slope none"] * MAX_CURVES


def test_a_word_of_the_glossary_is_explained_where_it_is_first() -> None:
    for word in GLOSSARY:
        text = str(explain_words(f"The {word} & the {word}."))
        assert (text.count("data-tip"), text.count("&amp;")) == (1, 1), word


def test_the_policy_names_script_and_style_by_their_hash() -> None:
    policy = make_content_policy("", "")  # of the empty text: the well-known digest of nothing
    assert policy.count("'sha256-47DEQpj8HBSa+/TImW+5JCeuQeRkm5NMpJWZG3hSuFU='") == 2
    assert "default-src 'none'" in policy
