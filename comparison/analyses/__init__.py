"""What a study asks beside its surfaces: slips, scaling, convergence, effective values, motions."""
