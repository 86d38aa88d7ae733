"""Assembled systems of the engine: the translational and the spatial model of a scene, and their parts."""
