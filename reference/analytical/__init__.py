"""Surfaces that follow from a closed form, without a run: frictionless small vibration."""
