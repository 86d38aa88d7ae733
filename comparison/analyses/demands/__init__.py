"""Demands on the building, such as peak displacement and base shear, over all phases."""
