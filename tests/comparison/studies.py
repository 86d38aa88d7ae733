"""Studies that are solved here, batch after batch, and surfaces with a planted difference."""

import xarray as xr
from fake_models import errors_in

from comparison.study.batches import execute_batch
from comparison.study.study import Study
from comparison.surfaces.body_comparison import BodyComparison, compare_bodies
from comparison.surfaces.differences import Difference
from comparison.surfaces.surfaces import label_surfaces
from reference.problem import load_scene

GRID = 8
KEYS = ("resolved", "regularised", "translational", "spatial")  # of the chain, after its first model


def solved(study: Study) -> xr.Dataset:
    """The surfaces of a study."""
    batches = study.batches()
    return label_surfaces(study, batches, [execute_batch(batch) for batch in batches])


def body_comparisons(study: Study, surfaces: xr.Dataset) -> list[BodyComparison]:
    """One for every body of every scene, in their order."""
    return [each for scene in study.scenes for each in compare_bodies(study, surfaces, scene)]


def difference_rows(study: Study, surfaces: xr.Dataset) -> list[Difference]:
    """The rows of the pairs that answer the question, in the order of bodies and pairs."""
    bodies = body_comparisons(study, surfaces)
    return [comparison.rows[pair.key] for comparison in bodies for pair in comparison.pairs]


def planted_study(
    gaps: dict[str, float], errors: dict[str, float] | None = None, scene: str = "fig3-I", tolerance: float = 1e-3
) -> tuple[Study, xr.Dataset]:
    """Surfaces of the smooth fake model, every model `gaps` above it."""
    study = Study((load_scene(scene),), GRID, tolerance, errors_in(gaps, errors))
    return study, solved(study)
