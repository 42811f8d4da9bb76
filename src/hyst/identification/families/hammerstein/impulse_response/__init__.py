"""The paper's steps: impulse response, realization, inverse, hysteresis behind it."""
