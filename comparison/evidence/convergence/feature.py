"""Report section of the convergence of friction law and contact."""

from comparison.evidence.convergence.analysis import Convergence
from comparison.evidence.trend_feature import make_trend_feature

FEATURE = make_trend_feature(  # convergence of friction law and contact: result field, analysis, report section
    Convergence(),
    title="Convergence of friction law and contact",
    scenes="scenes with phases",
    meaning="what the steps of friction law and contact tend to",
    column="median size at each v_reg (m/s) or penetration (ρ)",
)
