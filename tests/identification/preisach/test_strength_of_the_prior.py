"""The prior of smoothness fills what the record leaves open, and bends nothing that it shows."""

import numpy as np
import pytest

import hyst


@pytest.mark.parametrize(("noise", "within"), [(0.0, 0.05), (0.002, 1.0)])
def test_a_density_that_jumps_at_the_diagonal_keeps_its_linear_part(noise, within):
    """Triangles twice as dense as squares: a strong prior made the jump a linear part of 1.8."""
    material = hyst.Preisach(np.tril(np.ones((6, 6))), np.linspace(-1.0, 1.0, 7), p0=0.1)
    u = hyst.signals.forc(dt=0.02, low=-1.0, high=1.0, rate=1.0, curves=12).u
    y = material(u)
    y += noise * np.ptp(y) * np.random.default_rng(3).standard_normal(y.size)
    found = hyst.identify(hyst.Record(u, y, 0.02), family="preisach", delay=0)
    p0 = dict(zip(found.parameter_names, found.parameter_values, strict=True))["preisach.p0"]
    # Of noise, a linear part of 1 is 5 % of the range: a thin row of relays is hardly told from it.
    assert p0 == pytest.approx(0.1, abs=0.1 * within if noise == 0.0 else within)
    left = (found.model(u) - material(u))[int(u.argmax()) :]
    # A third of the noise is what 100 combinations of 1300 samples carry, and 0.01 % is rounding.
    assert np.sqrt(np.mean(np.square(left))) < max(0.5 * noise, 1e-4) * np.ptp(y)
