"""What a study computes: scenes, the hierarchy of models, phases, batches, and their predicted cost."""
