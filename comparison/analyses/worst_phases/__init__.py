"""Search for the largest amplifications and displacements over all phases."""
