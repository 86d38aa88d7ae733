"""Contact of the platform: friction laws, the acceleration under each, and slip directions at a stop."""
