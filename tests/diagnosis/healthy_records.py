"""Records in which every value is a measurement, of many kinds of plants and drives."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.io import loadmat
from scipy.signal import lfilter

import hyst

Array = NDArray[np.float64]
Plant = Callable[[Array], Array]

SAMPLES = 3000


def triangle_wave(samples: int, period: float, amplitude: float = 1.0) -> Array:
    """Give a triangle from -amplitude to amplitude whose corners fall between samples."""
    phase = (np.arange(samples) / period + 0.25) % 1.0
    return amplitude * (1.0 - 4.0 * np.abs(phase - 0.5))


def drives() -> dict[str, Array]:
    """Give drives within -50 to 50, in V."""
    t = np.arange(SAMPLES)
    random = np.random.default_rng(5)
    phases = random.uniform(0.0, 2.0 * np.pi, 12)
    waves = np.sin(2.0 * np.pi * np.outer(t, np.arange(1, 13)) * 2 / SAMPLES + phases).sum(axis=1)
    swept = np.sin(2.0 * np.pi * np.cumsum(np.geomspace(1.0 / SAMPLES * 3, 0.1, SAMPLES)))
    levels = np.repeat(random.uniform(-1.0, 1.0, SAMPLES // 100), 100)
    shrinking = triangle_wave(SAMPLES, 503.3) * np.linspace(1.0, 0.2, SAMPLES)
    steps_of_stairs = np.round(triangle_wave(SAMPLES, 1000.0) * 10.0) / 10.0
    given = {
        "triangle": triangle_wave(SAMPLES, 1000.0),
        "triangle_between": triangle_wave(SAMPLES, 333.7),
        "shrinking": shrinking,
        "sine": np.sin(2.0 * np.pi * t / 600.0),
        "sine_of_10_samples": np.sin(2.0 * np.pi * t / 10.0 + 0.1),
        "triangle_of_10_samples": triangle_wave(SAMPLES, 10.3),
        "multisine": waves / np.abs(waves).max(),
        "swept": swept,
        "random_levels": levels,
        "prbs": np.where(np.repeat(random.uniform(size=SAMPLES // 20), 20) > 0.5, 1.0, -1.0),
        "white": random.uniform(-1.0, 1.0, SAMPLES),
        "stairs": steps_of_stairs,
        "one_step": np.where(t < SAMPLES // 3, 0.0, 1.0),
        "sawtooth": 2.0 * ((t / 250.0) % 1.0) - 1.0,
        "rest_then_triangle": np.where(t < 2000, 0.0, triangle_wave(SAMPLES, 400.0)),
        "from_zero": 1.0 + triangle_wave(SAMPLES, 800.0),
    }
    return {name: 50.0 * each for name, each in given.items()}


def preisach(u: Array, relays: int = 600, seed: int = 3) -> Array:
    """Give a sum of relays that switch inside -45 to 45, of equal weight."""
    random = np.random.default_rng(seed)
    ends = np.sort(random.uniform(-45.0, 45.0, (2, relays)), axis=0)
    state = np.full(relays, -1.0)
    y = np.empty(u.size)
    for k, value in enumerate(u):
        state[value >= ends[1]] = 1.0
        state[value <= ends[0]] = -1.0
        y[k] = state.mean()
    return 30.0 * y


def bouc_wen(u: Array) -> Array:
    """Give a friction force z beside a spring, dz = du (1 - (0.6 sign(du z) + 0.4) |z|^1.5)."""
    z, force = 0.0, np.empty(u.size)
    steps = np.diff(u, prepend=u[0]) / 8.0
    for k, step in enumerate(steps):
        for _ in range(8):
            z += step / 8.0 * (1.0 - (0.6 * np.sign(step * z) + 0.4) * min(abs(z), 1.5) ** 1.5)
        force[k] = z
    return 0.05 * u + force


def dynamic(u: Array) -> Array:
    """Give plays followed by a lightly damped resonance of 12 samples a period."""
    pole = 0.93 * np.exp(2j * np.pi / 12.0)
    a = np.real(np.poly([pole, pole.conjugate()]))
    return lfilter([a.sum()], a, plays(u))


def plays(u: Array) -> Array:
    return hyst.PrandtlIshlinskii(p=[0.1, 0.06, 0.03], r=[4.0, 15.0, 30.0], p0=0.5)(u)


def delayed(plant: Plant, samples: int) -> Plant:
    """Give a plant whose output comes later."""
    return lambda u: np.concatenate((np.full(samples, plant(u)[0]), plant(u)[:-samples]))


def plants() -> dict[str, Plant]:
    """Give plants for drives within -50 to 50."""
    return {
        "plays": plays,
        "delayed_plays": delayed(plays, 5),
        "play_alone": lambda u: hyst.Play(8.0)(u),
        "delayed_play": delayed(lambda u: hyst.Play(8.0)(u), 3),
        "stop_alone": lambda u: hyst.Stop(8.0)(u),
        "one_relay": lambda u: 0.2 * u + 10.0 * np.sign(hyst.Play(12.0)(u) + 0.001),
        "softening": lambda u: 40.0 * np.tanh(plays(u) / 18.0),
        "stiffening": lambda u: plays(u) + 0.0004 * plays(u) ** 3,
        "dead_zone": lambda u: np.sign(u) * np.maximum(np.abs(u) - 10.0, 0.0),
        "butterfly": lambda u: hyst.Play(10.0)(u) ** 2 / 50.0,
        "preisach": preisach,
        "few_relays": lambda u: preisach(u, 12, 4),
        "dahl": lambda u: hyst.Dahl(2.0, 8.0, 1.0)(u) if hasattr(hyst, "Dahl") else u,
        "bouc_wen": bouc_wen,
        "dynamic": dynamic,
        "line": lambda u: 0.6 * u + 3.0,
        "friction": lambda u: 6.0 * np.sign(np.diff(u, prepend=u[0])) + 0.02 * u,
    }


def with_noise(y: Array, share: float, seed: int = 1) -> Array:
    return y + np.random.default_rng(seed).normal(0.0, share * np.ptp(y), y.size)


def converted(y: Array, bits: int) -> Array:
    """Give an output in the counts of a converter that has its whole range to itself."""
    step = np.ptp(y) / (2**bits - 2) or 1.0
    return np.round(y / step) * step


SENSORS: dict[str, Callable[[Array], Array]] = {
    "exact": lambda y: y,
    "quiet": lambda y: with_noise(y, 0.003),
    "noisy": lambda y: with_noise(y, 0.05),
    "12_bits": lambda y: converted(y, 12),
    "quiet_12_bits": lambda y: converted(with_noise(y, 0.003), 12),
}


@cache
def response(plant: str, drive: str) -> tuple[Array, Array]:
    """Give drive and exact output."""
    u = drives()[drive]
    return u, plants()[plant](u)


def healthy(plant: str, drive: str, sensor: str) -> hyst.Record:
    """Give one record."""
    u, y = response(plant, drive)
    return hyst.Record(u, SENSORS[sensor](y), 1e-3, input_unit="V", output_unit="um")


def measured_records(folder: Path) -> Iterator[tuple[str, hyst.Record]]:
    """Give records of the four kinds of measured data."""
    table = np.loadtxt(folder / "piezo-dbo" / "Model_Vi_Do.dat")
    yield "piezo", hyst.Record(table[:, 0], table[:, 4], 0.005)
    for file in sorted((folder / "mr-damper").glob("*.mat")):
        data = loadmat(file)
        yield file.name, hyst.Record(data["dist"].ravel(), data["forc"].ravel(), 0.01)
    for file in sorted((folder / "pneumatic-seal").glob("*.csv")):
        table = np.loadtxt(file, delimiter="\t")
        yield file.name, hyst.Record(table[:, 4], table[:, 6], 0.01)
    for file in sorted((folder / "magnetic-bh").glob("H_*.mat")):
        fields = loadmat(file)
        fluxes = loadmat(file.with_name("B" + file.name[1:]))
        h = next(value for name, value in fields.items() if name.startswith("H"))
        b = next(value for name, value in fluxes.items() if name.startswith("B"))
        for column in range(h.shape[1]):
            yield f"{file.name} {column}", hyst.Record(h[:, column], b[:, column], 1.0)
