"""Models whose constants follow a second signal, identified from records at several values of it."""
