"""The spec that ``hyst observer --template`` prints: the repaired example of S1."""

from __future__ import annotations

TEMPLATE = """\
# Disturbance observer around a hysteretic actuator.
#
#     hyst observer spec.toml -o out
#
# The loop: v = C (y_ref - y) - d_hat, u = inverse(v), w = hysteresis(u), y = P w. The observer
# estimates d = w - v, what the inverse leaves, from v and y, and takes it off.
#
# Systems are in the Laplace variable s, in rad/s: num and den, highest power first. Also read are
# zeros, poles (numbers, or [re, im] for a pair) and gain, or A, B, C, D. Time is in seconds.

[plant]  # nominal plant Pn, behind the hysteresis: one mode at 90 Hz, damping 0.8
num = [319775.1825952952]
den = [1.0, 904.7786842338605, 319775.1825952952]

[true_plant]  # optional: what the loop will really meet; a second mode at 2400 rad/s, damping 0.2
num = [1841905051748.9004]
den = [1.0, 1864.7786842338605, 6948362.719459801, 5518509396.478519, 1841905051748.9004]

[controller]  # C: 4 + 8/s (the paper prints 8 + 4/s, with which this loop is unstable)
num = [4.0, 8.0]
den = [1.0, 0.0]

[weights]
# Uncertainty of the plant, |P / Pn - 1| <= |Wu|: here exactly what the second mode makes.
Wu = { num = [-1.0, -960.0, 0.0], den = [1.0, 960.0, 5760000.0] }
# What is wanted of the observer, |1 - Q| < 1 / |Wp|: disturbances rejected up to about 50 Hz.
Wp = { num = [0.5, 201.06192982974676], den = [1.0, 0.2] }

[internal_model]  # disturbances that are constant for long; also "ramp", or A and C
kind = "integrator"
# sinusoids = [50.0]  # Hz, added to it: rejected without error

# [design]  # optional
# observer = "gain"      # the paper's; "q-filter", the classical one; or "none"
# time = "continuous"    # or "discrete": straight from the plant as the block samples it
# order = "auto"         # more than the paper's where it pays

# [limits]  # optional: the block keeps them, and nothing winds up
# drive = [-50.0, 50.0]
# rate = 5e4             # units a second

[hysteresis]  # a model file as hyst identify writes it, file = "model.json", or
p0 = 0.1
p = [0.0462, 0.069, 0.1029, 0.1535, 0.2291, 0.3417, 0.51, 0.761, 1.1, 1.7]
r = [4.0, 8.0, 12.0, 16.0, 20.0, 24.0, 28.0, 32.0, 36.0, 40.0]
# envelope = { weights = [0.65, 0.2], thresholds = [0.0, 7.56] }  # odd map before the plays

[inverse]  # "exact", "scaled" with factor, "reduced" with plays, "file" with file, or "none"
kind = "scaled"
factor = 0.7

[reference]  # sines of [amplitude, Hz], or file = "reference.csv" and column = "y_ref",
# sampled at dt of [simulation]
sines = [[18.0, 1.0], [28.0, 3.0]]
duration = 3.0

[simulation]
settle = 1.0        # left out of the errors
noise = 0.0         # of the measurement, standard deviation
disturbance = 0.0   # constant, before the hysteresis
seed = 0

[filter]  # the controller to implement: C, observer and inverse in one sampled block
dt = 1e-4
method = "tustin"   # or "zoh"
delay = 0.0         # s, from reading y to the drive that follows from it
"""
