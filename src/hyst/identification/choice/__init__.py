"""Choose delay, family and size."""
