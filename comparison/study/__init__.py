"""What a study computes: scenes, the model hierarchy, phases, batches, and their predicted cost."""
