"""Runs of an assemble model: adaptive steps, levels of accuracy, peaks, error estimates and the work limit."""
