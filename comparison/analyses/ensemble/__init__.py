"""Demands under many ground motions."""
