"""How far the paper's assumptions hold."""
