"""Plots of the folded sections and the words of the trade-off say what the results hold."""

from dataclasses import replace

from known_results import known_growth

from comparison.evidence.tradeoff import feature
from comparison.evidence.tradeoff.feature import make_tradeoff_panels, word_fastest_methods, word_trades
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
    """One without an estimate is the last resort; one that lacks values or has a model's error is not named."""
    slow, fast = replace(SLOW, most=(1e-7, 5e-7)), replace(FAST, most=(5e-4, 5e-3))
    quick = replace(FAST, method="quick", seconds=1.234e-3, controlled=False, most=(2e-4, 1e-4), unit="m/s")
    none = replace(SLOW, method="none", seconds=1e-4, answered=3)
    other = replace(none, answered=4, model_error=True)
    unknown = replace(SLOW, seconds=1e-4, most=(1e-9, None))
    of_slow = "; ".join(f"for {error} ask slow, tolerance 1e-07 (200 ms)" for error in ("1e-03", "1e-04", "1e-06"))
    of_fast = "for 1e-02 ask fast, tolerance 0.001 (10 ms)"
    of_quick = "for 1e-03 ask quick, tolerance 0.001 m/s (1.23 ms, no error estimate)"
    rest = replace(QUESTION, key="rest", title="the rest")
    for entries, answer in (
        ([none, slow, other, fast, quick, unknown], f"{of_fast}; {of_slow}."),
        ([fast, quick], f"{of_fast}; {of_quick}; for 1e-04 none; for 1e-06 none."),
    ):
        trade = replace(TRADE, questions=[QUESTION, rest], entries=[*entries, replace(slow, question="rest")])
        assert word_fastest_methods(trade) == [
            {"title": "exact equations", "text": answer},
            {"title": "the rest", "text": f"for 1e-02 ask slow, tolerance 1e-07 (200 ms); {of_slow}."},
        ]
    assert word_trades([TRADE]) == "2 settings measured in 1 scene; speed has no verdict"
    assert word_trades([TRADE, replace(TRADE, entries=[SLOW])]).startswith("3 settings measured in 2 scenes;")


def test_a_method_is_a_curve_of_the_platform_and_of_the_last_body() -> None:
    """Those with a model's error come last, and before them those with fewer settings on the front of the body."""
    front = {"pareto_front": (False, True, True), "most": (1e-2, 1e-3, 3e-4)}
    three = {"median": (1e-5,) * 3, "error_estimate": (None,) * 3}
    good, model, lost = (replace(each, **three, **front) for each in (FAST, SLOW, replace(FAST, answered=3)))
    model = replace(model, method="model", model_error=True, most=(None, 1e-3, 0.0))
    plain = replace(good, method="plain", seconds=0.5, unit="s", pareto_front=(True, False, False))
    entries = [model, plain, good, replace(lost, method="lost"), replace(good, value=1e-2)]
    trade = replace(TRADE, bodies=3, entries=entries)
    first, last = (panel["plot"] for panel in make_tradeoff_panels(trade))
    assert [line["name"] for line in first["series"]] == ["plain", "fast"]
    assert (first["bands"], last["bands"]) == ([{"from": 1e-30, "to": 1e-9}],) * 2, "below the reference's own error"
    many = [replace(good, method=f"method {number}") for number in range(9)]
    panels = make_tradeoff_panels(replace(trade, entries=many))
    assert [len(panel["plot"]["series"]) for panel in panels] == [MAX_CURVES] * 2, "more cannot be told apart"
    assert last["label"] == "fig3-I, exact equations, mu_3: relative error over processor time; fast, plain, model"
    assert (last["x"]["title"], last["y"]["title"]) == ("processor time per point, s", "relative error, 95 %")
    titles = [f"fast, tolerance {value}: 3.0e-04 in 10 ms" for value in ("0.001", "0.01")]
    assert last["series"] == [
        {"name": "fast", "x": [0.01] * 2, "y": [3e-4] * 2, "marks": True, "titles": titles, "color": 0},
        {"name": "plain", "x": [0.5], "y": [3e-4], "marks": True, "color": 1,
         "titles": ["plain, tolerance 0.001 s: 3.0e-04 in 500 ms"]},
        {"name": "model", "x": [0.2], "y": [1e-16], "marks": True, "color": 2, "dash": "5 3",
         "titles": ["model, tolerance 1e-07: 0.0e+00 in 200 ms"]},
    ]  # fmt: skip


def test_the_cost_is_drawn_by_what_grows_with_its_slopes() -> None:
    series = [*known_growth().series, replace(known_growth().series[2], quantity="duration", unit="s")]
    bodies, workers, duration = feature.make_growth_panels(series)
    names = ["engine: slope 2.00 ± 0.00", "slow engine"]
    assert bodies["plot"]["label"] == f"processor time, s over bodies; {'; '.join(names)}"
    assert [(line["name"], line["x"], line["y"], line["color"]) for line in bodies["plot"]["series"]] == [
        (names[0], [2.0, 4.0, 8.0], [1.0, 4.0, 16.0], 0), (names[1], [2.0, 4.0, 8.0], [1.0, None, 16.0], 1)
    ]  # fmt: skip
    assert [(each["title"], each["plot"]["x"], each["plot"]["y"]) for each in (bodies, workers, duration)] == [
        ("bodies", {"title": "bodies", "log": True}, {"title": "processor time, s", "log": True}),
        ("workers", {"title": "workers", "log": True}, {"title": "wall time, s", "range": [0.0, 2.2]}),
        ("duration", {"title": "duration, s", "log": True}, {"title": "processor time, s", "log": True}),
    ]
    assert workers["plot"]["series"][0]["color"] == 2, "that of its model"


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
