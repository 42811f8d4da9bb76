"""Models whose constants follow a second signal, identified from records at its values."""
