"""Values read back from each model."""
