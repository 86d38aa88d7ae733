"""Assembled systems of the engine: the models of a scene, and what they are made of."""
