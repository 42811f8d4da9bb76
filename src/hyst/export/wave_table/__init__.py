"""Waveform tables: a command as the numbers that a controller without code plays."""
