"""Find creep beside hysteresis: whether records show it, and its weights and time constants."""
