"""Where the models differ and by how much: steps of the ladder, budget, acceptance, verdicts."""
