"""How far the paper's assumptions carry."""
