"""Learning from repetition: the command of a repeated motion from what it has led to."""
