"""Disturbance observers in discrete time, straight from a sampled plant."""
