"""Demands under a suite of motions at many intensities."""
