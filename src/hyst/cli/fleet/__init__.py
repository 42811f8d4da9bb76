"""hyst fleet: many records, one model each, in one table."""
