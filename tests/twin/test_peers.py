"""Other people's programs, where they are installed: none is needed to run hyst."""

from __future__ import annotations

import importlib
import warnings
from types import ModuleType

import numpy as np
import pytest
from numpy.typing import NDArray

from hyst import Play, PrandtlIshlinskii, Stop

Array = NDArray[np.float64]


def peer(name: str) -> ModuleType:
    """Import a peer, or skip with what it says is missing."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # theirs, not ours
        try:
            return importlib.import_module(name)
        except (ImportError, RuntimeError) as error:
            causes = [str(error)]
            while (error := error.__context__) is not None:  # type: ignore[assignment]
                causes.append(str(error))
            pytest.skip(f"{name} cannot be used: {causes[-1]}")


def wandering(seed: int, samples: int = 8000) -> Array:
    return np.cumsum(np.random.default_rng(seed).standard_normal(samples))


@pytest.mark.parametrize("width", [0.0, 0.5, 2.0, 13.0])
def test_backlash_of_python_control_is_a_play_of_half_its_width(width: float) -> None:
    backlash = peer("control").friction_backlash_nonlinearity(width)
    u = wandering(1)
    # The same comparisons on the same roundings, b/2 = r being exact.
    assert (np.array([backlash(value) for value in u]) == Play(width / 2.0)(u)).all()


def test_a_bank_is_a_sum_of_backlashes() -> None:
    control = peer("control")
    p, r, p0 = [0.5, -0.2, 0.7], [0.25, 1.0, 4.0], 0.3
    u = wandering(2)
    total = p0 * u
    for weight, threshold in zip(p, r, strict=True):
        backlash = control.friction_backlash_nonlinearity(2.0 * threshold)
        total += weight * np.array([backlash(value) for value in u])
    # The same products added in the same order.
    assert (PrandtlIshlinskii(p, r, p0)(u) == total).all()


def describing_function(y: Array, amplitude: float) -> complex:
    """First harmonic of a steady output for the input A sin(phase), over one period."""
    phase = 2.0 * np.pi * np.arange(y.size) / y.size
    return complex(2.0 / (amplitude * y.size) * (y @ (np.sin(phase) + 1j * np.cos(phase))))


def test_describing_function_of_a_play() -> None:
    n, amplitude = 20_000, 3.0
    u = amplitude * np.sin(2.0 * np.pi * np.arange(2 * n) / n)
    found = describing_function(Play(1.0)(u)[n:], amplitude)
    # Known for r = 1, A = 3; two corners of the output are missed by at most a step of
    # A (2 pi / n)^2 / 2 = 1.5e-7 at the turns.
    assert found == pytest.approx(0.7082085942 - 0.2829421211j, abs=2e-7)
    # By hand, with x = 1 - 2 r/A: real part 1/2 + (asin x + x sqrt(1 - x^2))/pi and imaginary part
    # -4 r (A - r)/(pi A^2), the loop's area over pi A^2.
    x = 1.0 / 3.0
    real = 0.5 + (np.arcsin(x) + x * np.sqrt(1.0 - x * x)) / np.pi
    assert found == pytest.approx(complex(real, -8.0 / (9.0 * np.pi)), abs=2e-7)


def test_describing_function_of_python_control() -> None:
    backlash = peer("control").friction_backlash_nonlinearity(2.0)
    assert backlash.describing_function(3.0) == pytest.approx(
        0.7082085942 - 0.2829421211j,
        abs=5e-11,  # the digits given
    )


def test_stops_are_elastic_plastic_springs_of_opensees() -> None:
    """A parallel of ElasticPP materials: stress sum E_i Stop_{r_i}(strain)."""
    ops = peer("openseespy.opensees")
    stiffness, r = [1.0, 2.0, 0.5, 3.0], [0.3, 0.8, 1.5, 2.5]
    # The materials need some steps with strain increments, so a smooth path with inner loops.
    t = np.linspace(0.0, 1.0, 2000)
    u = 2.0 * np.sin(6.0 * np.pi * t) + 1.2 * np.sin(34.0 * np.pi * t)
    ops.wipe()
    ops.model("basic", "-ndm", 1, "-ndf", 1)
    for tag, (modulus, limit) in enumerate(zip(stiffness, r, strict=True), start=1):
        ops.uniaxialMaterial("ElasticPP", tag, modulus, limit)
    ops.uniaxialMaterial("Parallel", 9, 1, 2, 3, 4)
    ops.testUniaxialMaterial(9)
    stress = []
    for strain in u.tolist():
        ops.setStrain(strain)
        stress.append(ops.getStress())
    ops.wipe()
    expected = sum(modulus * Stop(limit)(u) for modulus, limit in zip(stiffness, r, strict=True))
    # ElasticPP keeps a plastic strain, as the play does; each is rounded a few times per sample and
    # stresses go up to sum(E r) = 10.15. Where a stop yields, ElasticPP puts it on the limit anew.
    assert np.abs(np.array(stress) - expected).max() <= 20.0 * np.finfo(np.float64).eps * 10.15


def test_loop_area_of_the_hysteresis_package() -> None:
    hysteresis = peer("hysteresis")
    amplitude, r, n = 1.0, 0.3, 4000
    u = amplitude * np.sin(2.0 * np.pi * (np.arange(2 * n + 1) / n + 0.25))
    y = Play(r)(u)[n:]
    loop = hysteresis.Hysteresis(np.column_stack([u[n:], y]))
    loop.setArea()
    # 4 r (A - r) = 0.84, negative since the output lags; corners are missed by less than a step of
    # A (2 pi / n)^2 / 2 = 1.2e-6 at the turns.
    assert loop.getNetArea() == pytest.approx(-0.84, abs=1.2e-6)
