"""Analyses that a study makes besides the amplification surfaces: one folder for each; index.html shows the results."""
