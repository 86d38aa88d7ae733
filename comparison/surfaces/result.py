"""The difference of two models: its statistics, its causes, and where it is largest."""

from __future__ import annotations

from comparison.result_types import Number, Part, Phases, Text


class Difference(Part):
    """The difference of two models in one body: second minus first, relative to the first."""

    scene: Text
    """name of the scene"""
    pair: str
    """key of the pair: total, translational, like-for-like"""
    first: str
    """key of the first model"""
    second: str
    """key of the second model"""
    body: int
    """number of the body; 1 is the platform"""
    mean: Number
    """mean of the signed size over the phase pairs where every compared model has a value"""
    spread: Number
    """standard deviation of the signed size over the same phase pairs"""
    median: Number
    """median of the absolute size over the phase pairs where both have a value"""
    percentile95: Number
    """95 % of the absolute sizes are below this"""
    maximum: Number
    """largest absolute size"""
    phases: Phases
    """(alpha1, alpha2) of the largest, rad"""
    beyond_error: Number
    """fraction of the phase pairs where it exceeds u_D = sqrt(u_A^2 + u_B^2), the two error estimates together"""
    ratio: Number
    """largest absolute size in units of u_D"""
    asked: int
    """phase pairs that both models were asked for"""
    not_ok: int
    """phase pairs where either outcome is not ok"""
    unanswered: int
    """phase pairs where either has no value"""


class BudgetEntry(Part):
    """
    One step of the model hierarchy, or the total, in one body; relative to mu of the first model.

    Its signed mean is the bar in `waterfalls`.
    """

    scene: Text
    """name of the scene"""
    body: int
    """number of the body; 1 is the platform"""
    step: str
    """key of the model that the step leads to, or total"""
    first: str
    """key of the model before the step"""
    second: str
    """key of the model after the step"""
    median: Number
    """median of the absolute size"""
    rms: Number
    """root mean square of the size"""
    percentile95: Number
    """95 % of the absolute sizes are below this"""
    maximum: Number
    """largest absolute size"""
    phases: Phases
    """(alpha1, alpha2) of the largest, rad"""
    real: Number
    """fraction of the points where |D| > 5 u_D"""
    unresolved: Number
    """fraction of the points where u_D < |D| <= 5 u_D"""
    error_estimate: Number
    """median of u_D"""
    peak_moves: Number
    """how far the highest point of the surface moves at least on the periodic square, rad"""
    correlation: Number
    """Pearson's correlation of the two surfaces"""
    points: int
    """phase pairs where both models have a value"""
    asked: int
    """phase pairs that both models were asked for"""


class WaterfallBar(Part):
    """One step of the model hierarchy, or the total; relative to mu of the first model."""

    model: str
    """key of the model that the step leads to"""
    size: Number
    """signed size; null where a model has no value"""
    error: Number
    """error estimate of the size"""
    real: bool
    """whether the size exceeds five times its error estimate"""


class LargestDifference(Part):
    """The largest absolute difference of an engine model and the first model, taken apart at its phase pair."""

    bars: list[WaterfallBar]
    """one per step, up to the model that has the difference; they add up to the total"""
    total: WaterfallBar
    """the difference itself"""
    phases: Phases
    """(alpha1, alpha2), rad; null under a record"""
    phases_per_axis: int
    """of the grid of phase pairs that both models were asked for; 1 under a record, 0 without a difference"""


class Waterfall(Part):
    """The total difference of one body as signed bars that add up."""

    scene: Text
    """name of the scene"""
    body: int
    """number of the body; 1 is the platform"""
    bars: list[WaterfallBar]
    """one per step: means over the phase pairs where every compared model has a value"""
    total: WaterfallBar
    """mean of the total difference over the same phase pairs: the sum of the bars"""
    spread: Number
    """standard deviation of the total difference over the same phase pairs"""
    points: int
    """number of these phase pairs"""
    independent: int
    """of these, not related by a symmetry of the scene"""
    largest: LargestDifference
    """the same at the phase pair of the largest difference"""


class Cause(Part):
    """The models whose steps make a difference, from the bars of a waterfall."""

    models: list[str]
    """keys of the models whose real steps have the sign of the difference, largest first; empty where it is not real"""
    offset: list[str]
    """keys of the models whose real steps offset these, largest first"""


class Headline(Part):
    """The total difference of one body in numbers and in a plain sentence; relative to mu of the first model."""

    scene: Text
    """name of the scene"""
    body: int
    """number of the body; 1 is the platform"""
    name: str
    """name of the body"""
    first: str
    """key of the first model"""
    second: str
    """key of the last model"""
    mean: Number
    """mean of the signed difference over the phase pairs where every compared model has a value: the total of the
    waterfall"""
    mean_error: Number
    """error estimate of the mean"""
    spread: Number
    """standard deviation of the signed difference over the same phase pairs"""
    phases_per_axis: int
    """of the grid of phase pairs that every compared model was asked for; 1 under a record"""
    points: int
    """phase pairs of this grid where every compared model has a value"""
    independent: int
    """of these, not related by a symmetry of the scene"""
    real: Number
    """fraction of these where the difference exceeds five times its error estimate"""
    maximum: Number
    """signed; the largest absolute difference of the first and any engine model, at any phase pair where both have a
    value"""
    maximum_error: Number
    """error estimate of the maximum"""
    maximum_phases: Phases
    """(alpha1, alpha2) of the maximum, rad; null under a record"""
    maximum_model: str
    """key of the engine model that has the maximum"""
    maximum_phases_per_axis: int
    """of the grid of phase pairs that this model and the first were asked for"""
    cause: Cause
    """of the mean, from the bars of the means"""
    maximum_cause: Cause
    """of the maximum, from the bars at its phase pair"""
    like_for_like: Number
    """largest absolute difference of the two codes given the same equations and friction law"""
    sentence: Text
    """all that in words"""

    @property
    def statement(self) -> str:
        """The sentence below a heading that names the scene."""
        return self.sentence.removeprefix(f"{self.scene}, ")


class Completion(Part):
    """
    One body's surface of a model that is computed on fewer phases than the study has, completed through a finer model.

    It is the finer model plus the interpolated difference of the two. With the confidence stated at most a share of the
    phase pairs that were not computed is off by more than the error. The completed values are the variable `completed`
    of surfaces.nc.
    """

    scene: Text
    """name of the scene"""
    model: str
    """key of the model that is completed"""
    through: str
    """key of the finer model; empty without one"""
    body: int
    """number of the body; 1 is the platform"""
    computed: int
    """phase pairs where both models have a value"""
    held_out: int
    """phase pairs with a value that were chosen at random, computed and not used; 0 where nothing was interpolated"""
    error: Number
    """largest error at the held-out phase pairs, relative to the model's own mu; null where nothing was interpolated"""
    model_error: Number
    """largest error estimate of the model itself at these, relative"""
    share: float
    """at most so many of the phase pairs that were not computed are off by more than the error"""
    confidence: float
    """of this statement"""
    asked: float
    """largest error with which the surface may be drawn: the tolerance asked of the model"""
    difference: Number
    """95 % of the absolute differences of the completed surface from the first model are below this, relative to it"""
    accepted: bool
    """whether the surface may be drawn as completed: the error is at most what was asked"""
    difference_accepted: bool
    """whether its difference from the first model may be drawn as completed: the error is at most a fifth of it"""
    reason: Text
    """why the surface may not be drawn; empty where it may"""
