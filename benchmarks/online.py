"""Estimation while it runs: time and bytes of one update, and errors over the Cramer-Rao bound.

Prints, for one machine and one run,
- the time of one update of the joint estimator in C and from Python, and the bytes of its state,
- how many of 1000 random starts, radii up to 50 % and weights up to 30 % off, are not within 0.1 %
  after 3 periods without noise, with the search for a better minimum and without,
- root mean square errors of 50 runs of 100 s at 10, 20 and 30 dB over the Cramer-Rao bound, from
  radii and weights all too small or all too large, and at 10 and 20 dB each in its own direction,
- the same of 40 runs of 30 s at 20 to 60 dB, with the search and without,
- the same for the paper's law on sine and staircase, over the bound of the radii alone, with
  regimes from the noisy output and from the slope of the output before the noise,
- the share of radii within two standard errors of least squares whose regimes were told,
- the tracking error of the adaptive inverse over that of a frozen one, while a weight and a radius
  drift by 30 % in 60 s at 30 dB.
"""

from __future__ import annotations

import time

import numpy as np
from numpy.typing import NDArray

import hyst
from hyst.online import AdaptiveInverse, JointEstimator, RadiusEstimator
from hyst.studies.s2_adaptive_radii.over_bound import FILTER, slopes_of
from hyst.studies.s2_adaptive_radii.paper import GAIN, INPUTS
from hyst.studies.s2_adaptive_radii.printed_law import true_regimes

Array = NDArray[np.float64]

P = np.array([0.3, 0.5, 0.8, 0.3, 0.2])
R = np.array([0.4, 1.0, 1.5, 2.0, 3.6])
TRUTH = hyst.PrandtlIshlinskii(P, R)
DT = 1e-3
RUNS = 50
STARTS = 1000


def sine(seconds: float) -> Array:
    return np.asarray(30.0 * np.sin(2.0 * np.pi * np.arange(round(seconds / DT)) * DT))


def cost() -> None:
    print("CPU time. plays  search  ns an update: C  Python   bytes of state")
    for plays in (1, 5, 10):
        r = np.linspace(0.4, 3.6, plays)
        truth = hyst.PrandtlIshlinskii(np.full(plays, 2.0 / plays), r, 0.1)
        u = sine(100.0)
        record = hyst.Record(u, truth(u) + np.random.default_rng(0).normal(0.0, 1.0, u.size), DT)
        for search in (False, True):
            estimator = JointEstimator(truth, dt=DT, memory=10.0, search=search)
            begin = time.process_time()
            estimator.run(record, every=record.samples)
            in_c = (time.process_time() - begin) / u.size
            begin = time.process_time()
            for u_k, y_k in zip(
                record.u[:20_000].tolist(), record.y[:20_000].tolist(), strict=True
            ):
                estimator.update(u_k, y_k)
            in_python = (time.process_time() - begin) / 20_000
            size = estimator.state.nbytes
            print(f"{plays:14d} {search!s:>7} {1e9 * in_c:16.0f} {1e9 * in_python:7.0f} {size:12d}")


def any_start() -> None:
    u = sine(3.0)
    drive = hyst.Record(u, TRUTH(u), DT)
    for how in ("corners", "uniform"):
        for search in (True, False):
            rng = np.random.default_rng(0)
            worst = np.zeros(STARTS)
            for k in range(STARTS):
                estimator = JointEstimator(far_start(how, k, rng), dt=DT, search=search)
                estimator.run(drive, every=drive.samples)
                right = np.concatenate([P, R])
                worst[k] = np.abs(estimator.parameters[1:11] / right - 1.0).max()
            print(
                f"{STARTS} {how} starts, search {search}: {int((worst > 1e-3).sum())} beyond "
                f"0.1 %, worst {100.0 * worst.max():.3g} %"
            )


def over_bound() -> None:
    u = sine(100.0)
    names = JointEstimator(TRUTH).names
    for how, levels in (("common", (10.0, 20.0, 30.0)), ("corners", (10.0, 20.0))):
        for decibels in levels:
            ratios = joint_over_bound(u, decibels, how, RUNS)
            each = ", ".join(f"{name} {v:.2f}" for name, v in zip(names, ratios, strict=True))
            overall = float(np.sqrt(np.mean(ratios**2)))
            print(
                f"{decibels:g} dB, {RUNS} runs, {how} starts: rms error over bound {overall:.2f} "
                f"({each})"
            )


def starts_in_noise() -> None:
    u = sine(30.0)
    for how in ("uniform", "corners"):
        for decibels in (20.0, 30.0, 40.0, 50.0, 60.0):
            found = [
                float(np.sqrt(np.mean(joint_over_bound(u, decibels, how, 40, search) ** 2)))
                for search in (True, False)
            ]
            print(
                f"{decibels:g} dB, 30 s, 40 {how} starts: rms error over bound {found[0]:.2f}, "
                f"without search {found[1]:.2f}"
            )


def joint_over_bound(u: Array, decibels: float, how: str, runs: int, search: bool = True) -> Array:
    """Root mean square errors over the Cramer-Rao bound, one for each parameter."""
    y = TRUTH(u)
    jacobian = np.column_stack([TRUTH.jacobian(u), np.ones(u.size)])
    normal = np.sqrt(np.diag(np.linalg.inv(jacobian.T @ jacobian)))
    right = np.concatenate([[0.0], P, R, [0.0]])
    sigma = float(np.std(y)) * 10.0 ** (-decibels / 20.0)
    errors, rng = [], np.random.default_rng(0)
    for seed in range(runs):
        noise = sigma * np.random.default_rng(seed).standard_normal(u.size)
        estimator = JointEstimator(far_start(how, seed, rng), dt=DT, search=search)
        estimator.run(hyst.Record(u, y + noise, DT), every=1000)
        errors.append((estimator.parameters - right) / (sigma * normal))
    return np.asarray(np.sqrt(np.mean(np.square(errors), axis=0)))


def far_start(how: str, seed: int, rng: np.random.Generator) -> hyst.PrandtlIshlinskii:
    """Radii up to 50 % and weights up to 30 % off, in common or each in its own direction."""
    if how == "common":
        return hyst.PrandtlIshlinskii((0.7, 1.3)[seed % 2] * P, (0.5, 1.5)[seed // 2 % 2] * R)
    far = rng.choice([-1.0, 1.0], 10) if how == "corners" else rng.uniform(-1.0, 1.0, 10)
    p, r = P * (1.0 + 0.3 * far[:5]), R * (1.0 + 0.5 * far[5:])
    order = np.argsort(r)
    return hyst.PrandtlIshlinskii(p[order], r[order])


def paper_law_over_bound() -> None:
    for name, give in INPUTS.items():
        u = give(100.0)
        y, radii = TRUTH(u), TRUTH.jacobian(u)[:, 6:]
        normal = np.sqrt(np.diag(np.linalg.inv(radii.T @ radii)))
        for decibels in (10.0, 20.0):
            sigma = float(np.std(y)) * 10.0 ** (-decibels / 20.0)
            for how, slopes in (("measured", None), ("before the noise", slopes_of(u, y))):
                ratios = law_over_bound(u, y, sigma, slopes) / (sigma * normal)
                each = ", ".join(f"r[{i}] {ratio:.3g}" for i, ratio in enumerate(ratios, start=1))
                print(
                    f"paper's law, {name}, {decibels:g} dB, slope {how}, {RUNS} runs: rms error "
                    f"over bound {np.sqrt(np.mean(ratios**2)):.3g} ({each})"
                )


def law_over_bound(u: Array, y: Array, sigma: float, slopes: Array | None) -> Array:
    """Root mean square errors of the radii after the whole record."""
    errors = []
    for seed in range(RUNS):
        noise = sigma * np.random.default_rng(seed).standard_normal(u.size)
        options = FILTER if slopes is None else {}
        law = RadiusEstimator(P, np.zeros(5), GAIN, DT, **options)  # type: ignore[arg-type]
        law.run(hyst.Record(u, y + noise, DT), every=u.size, slopes=slopes)
        errors.append(law.radii - R)
    return np.asarray(np.sqrt(np.mean(np.square(errors), axis=0)))


def bands_of_told_regimes() -> None:
    for name, give in INPUTS.items():
        u = give(20.0)
        y, regimes = TRUTH(u), true_regimes(u, R)
        for decibels in (10.0, 20.0, 40.0):
            sigma = float(np.std(y)) * 10.0 ** (-decibels / 20.0)
            inside = []
            for seed in range(40):
                noise = sigma * np.random.default_rng(seed).standard_normal(u.size)
                law = RadiusEstimator(P, 0.5 * R, 100.0 / sigma**2, DT, method="least-squares")
                law.run(hyst.Record(u, y + noise, DT), every=u.size, regimes=regimes)
                inside += (np.abs(law.radii - R) <= 2.0 * law.standard_errors).tolist()
            print(
                f"least squares, told regimes, {name}, {decibels:g} dB, 20 s, 40 runs: "
                f"{np.mean(inside):.3f} of the radii within two standard errors"
            )


def drift() -> None:
    samples = 60_000
    growth = 1.0 + 0.3 * np.arange(samples) / samples
    p, r = np.tile(P, (samples, 1)), np.tile(R, (samples, 1))
    p[:, 2] *= growth
    r[:, 3] *= growth
    y_ref = 50.0 * np.sin(2.0 * np.pi * np.arange(samples) * DT)
    start = hyst.PrandtlIshlinskii(P, R, 0.3)
    noise = float(np.std(y_ref)) * 10.0 ** (-30.0 / 20.0)
    scatter = noise * np.random.default_rng(0).standard_normal(samples)
    estimator = JointEstimator(start, dt=DT, memory=5.0, radius_spread=0.3, noise=noise)
    inverse, frozen = AdaptiveInverse(estimator, window=2.0), start.inverse().stepper()
    errors, z = np.zeros((2, samples)), np.zeros((2, 5))
    for k in range(samples):
        for way, u in enumerate((inverse.command(y_ref[k]), frozen(y_ref[k]))):
            z[way] = np.clip(z[way], u - r[k], u + r[k])
            y = 0.3 * u + float(p[k] @ z[way])
            errors[way, k] = y - y_ref[k]
            if way == 0:
                inverse.update(u, y + scatter[k])
    adaptive, fixed = np.sqrt(np.mean(errors**2, axis=1))
    print(f"drift: adaptive {adaptive:.3f}, frozen {fixed:.3f}, ratio {adaptive / fixed:.3f}")


def main() -> None:
    cost()
    any_start()
    over_bound()
    starts_in_noise()
    paper_law_over_bound()
    bands_of_told_regimes()
    drift()


if __name__ == "__main__":
    main()
