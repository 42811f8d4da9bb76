"""Robust control around a hysteresis: disturbance observer synthesis and closed-loop simulation."""
