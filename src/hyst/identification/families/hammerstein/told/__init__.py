"""What people are told of hysteresis with dynamics."""
