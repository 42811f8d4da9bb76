"""FMUs of FMI 2.0 and 3.0: description, sources, binary and archive."""
