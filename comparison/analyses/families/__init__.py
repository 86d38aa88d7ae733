"""Families of scenes, which differ in the value of one key."""
