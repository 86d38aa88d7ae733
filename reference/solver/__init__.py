"""The paper's equations and their integration, compiled."""
