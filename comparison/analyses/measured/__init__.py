"""Measured peaks compared with the models."""
