"""Measured peaks beside the models."""
