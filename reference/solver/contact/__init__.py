"""The contact of the platform: friction laws, its acceleration under each, slip directions at a stop."""
