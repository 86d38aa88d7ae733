"""Pictures of surfaces and budgets."""
