"""Scaling test."""
