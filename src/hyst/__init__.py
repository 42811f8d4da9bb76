"""hyst."""
