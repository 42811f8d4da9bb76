"""Linear dynamics that a broadband drive shows: phase that grows with frequency, a resonance."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.diagnosis.evidence import Evidence
from hyst.diagnosis.finding import Finding
from hyst.diagnosis.wording import of_record
from hyst.signals import Record

Array = NDArray[np.float64]

NAME = "dynamics"
_BANDS = 40
_FEWEST_BINS = 6  # of a band
_LEAST_POWER = 1e-4  # of the strongest bin of the drive
_LEAST_COHERENCE = 0.8
_LEAST_SPREAD = 4.0  # highest over lowest frequency
_LEAST_PHASE = 20.0  # degrees
_LEAST_GAIN_RATIO = 1.4
_FEWEST_BANDS = 4
_LONGEST = 1 << 18


@dataclass(frozen=True, eq=False)
class Response:
    """Transfer from input to output in bands of frequency.

    Parameters
    ----------
    frequency
        Hz, shape (m,), rising.
    gain
        Magnitude over that of the lowest bands.
    phase
        Degrees, against the lowest bands.
    """

    frequency: Array
    gain: Array
    phase: Array


def find(evidence: Evidence) -> Iterator[Finding]:
    """Warn where phase or gain change with frequency by more than hysteresis can make them."""
    for number, record in evidence.numbered():
        response = _response(record.slice(0, min(record.samples, _LONGEST)))
        if response is None:
            continue
        lag = float(-response.phase[-_FEWEST_BANDS // 2 :].mean())
        peak = int(np.argmax(response.gain))
        highest, lowest = float(response.gain[peak]), float(response.gain.min())
        turned = abs(lag) > _LEAST_PHASE
        if not turned and highest < _LEAST_GAIN_RATIO and lowest > 1.0 / _LEAST_GAIN_RATIO:
            continue
        frequency = float(response.frequency[peak])
        resonant = highest > _LEAST_GAIN_RATIO
        words = (
            f"rises {highest:.3g}-fold up to a resonance near {frequency:.3g} Hz"
            if resonant
            else f"is {float(response.gain[-1]):.3g}-fold at {response.frequency[-1]:.3g} Hz"
        )
        yield Finding(
            NAME,
            "warning",
            f"{of_record(evidence, number)}the output is not a matter of hysteresis alone: from "
            f"{response.frequency[0]:.3g} to {response.frequency[-1]:.3g} Hz it falls behind by "
            f"{lag:.3g} degrees more, and the gain {words}.",
            "Models without dynamics draw this as hysteresis: try --family hammerstein.",
            record=number,
            amounts={"phase": lag, "gain": highest}
            | ({"resonance": frequency} if resonant else {}),
        )


def _response(record: Record) -> Response | None:
    """Smooth cross spectrum over power of the drive, in bands that it fills; None if too few."""
    window = np.hanning(record.samples)
    u = np.fft.rfft(window * (record.u - record.u.mean()))
    y = np.fft.rfft(window * (record.y - record.y.mean()))
    power = u.real**2 + u.imag**2
    driven = power > _LEAST_POWER * float(power.max())
    driven[:2] = False
    edges = np.unique(np.geomspace(2, u.size, _BANDS + 1).astype(np.intp))
    frequency, transfer = [], []
    for low, high in zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True):
        inside = np.flatnonzero(driven[low:high]) + low
        # Bands of a few lines, as a triangle has, tell nothing of how output follows input.
        if inside.size < max(_FEWEST_BINS, 0.5 * (high - low)):
            continue
        cross = np.vdot(u[inside], y[inside])
        energy = float(power[inside].sum())
        own = float(np.sum(np.abs(y[inside]) ** 2))
        if own == 0.0 or abs(cross) ** 2 < _LEAST_COHERENCE * energy * own:
            continue
        frequency.append(float(inside.mean()) / (record.samples * record.dt))
        transfer.append(complex(cross) / energy)
    if len(frequency) < _FEWEST_BANDS or frequency[-1] < _LEAST_SPREAD * frequency[0]:
        return None
    relative = np.array(transfer) / np.mean(transfer[:2])
    phase = np.degrees(np.unwrap(np.angle(relative)))
    return Response(np.array(frequency), np.abs(relative), phase)
