"""hyst learn: the next command of a motion that repeats."""
