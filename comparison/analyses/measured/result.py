"""Peaks that an experiment measured, beside the models."""

from __future__ import annotations
