"""Pictures of surfaces, for the report and for manuscripts."""
