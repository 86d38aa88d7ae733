"""Report section of the scaling test."""

from fractions import Fraction

from comparison.evidence.scaling.analysis import LOADING_SCALES, Scaling
from comparison.evidence.trend_feature import make_trend_feature

FEATURE = make_trend_feature(  # change of amplification, small to exact equations, as loading and friction shrink by s
    Scaling(),
    title="Scaling test",
    scenes="scenes with phases and without heated friction",
    meaning="the step from small to exact equations over a common scale of loading and friction",
    column="median size at each s",
    parameter="s",
    scales=list(map(Fraction, LOADING_SCALES)),
)
