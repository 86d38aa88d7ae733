"""Report section of the scaling test."""

from fractions import Fraction

from comparison.evidence.scaling.analysis import LOADING_SCALES, Scaling
from comparison.evidence.trend_feature import make_trend_feature

FEATURE = make_trend_feature(  # change of amplification, small to exact equations, as loading and friction shrink by s
    Scaling(),
    "Scaling test",
    "scenes with phases and without heated friction",
    "the step from small to exact equations over a common scale of loading and friction",
    "median size at each s",  # column title: median of the change's size over phase pairs, at each factor s
    "s",  # axis title
    scales=list(map(Fraction, LOADING_SCALES)),
)
