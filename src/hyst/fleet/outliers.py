"""Which devices are odd against their fleet, and in what.

Compared are quantities without scale: gain, opening and bend of the loop at a quarter, the half and
three quarters of the drive, and the error, by two rules:

- against the whole fleet: |x - median| / (1.4826 MAD) of each quantity, the limit such that normal
  scatter exceeds it 0.05 times in a fleet;
- against the devices most like it, for what lies between several kinds: twice as far from its
  nearest as they are from theirs (the k-th nearest, in units of the scatter between nearest), 4.5
  deviations away from them in one quantity, and 4 away in one from the devices that are most like
  it in the others; or three times as far, and 8 away from the nearest. In simulated fleets of one
  to twelve kinds, 30 to 1000 devices, 0 to 0.5 ordinary ones are.

A device whose output falls where others rise, or whose record has samples that are no measurements
(a sensor at its end) where others have none, is odd whatever its numbers are.

What more than a few devices have in common is a kind of its own and no outlier.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hyst.fleet.device import Device
from hyst.fleet.loop_of_model import POINTS

Array = NDArray[np.float64]

FALSE_ALARMS = 0.05
"""Devices that the first rule names by mistake in a whole fleet that scatters normally."""

FALSE_ALARMS_NEAR = 0.5
"""The same of the second rule, at most, among up to a thousand devices."""

APART, NEAR, UNLIKE = 2.2, 4.5, 4.0
"""Of the second rule: times as far as others are from theirs, robust deviations from them, and from
the devices that are alike in all but one of gain, opening and bend."""

FAR_APART, FAR = 3.15, 8.0
"""Times as far, and deviations, that are odd by themselves."""

LIKE = 30
"""Devices that are compared with as alike in all else, at most; an eighth of a small fleet."""

FEWEST, FEWEST_NEAR = 8, 30
"""Devices below which nothing can be judged, and below which none is compared with its like."""

SHARE_OF_A_KIND, LEAST_OF_A_KIND = 0.02, 3
"""More devices than this share of the fleet, and this number, that are odd alike are a kind."""

MOST_REASONS = 3
"""That are told of one device."""

_QUARTERS = tuple((POINTS - 1) * k // 4 for k in (1, 2, 3))
_TO_DEVIATION = 1.4826
_EFFICIENCY = 0.37
"""Of the median absolute deviation: how many of the devices it is as good as a deviation of."""


@dataclass(frozen=True)
class Outlier:
    """A device that is odd against its fleet.

    Parameters
    ----------
    identifier
        The device.
    distance
        Robust deviations of what is oddest in it.
    reasons
        Which quantities are odd, and how far, the oddest first.
    """

    identifier: str
    distance: float
    reasons: tuple[str, ...]


@dataclass(frozen=True)
class _Compared:
    """A quantity that is compared: its words, and the scatter that is never worth a word."""

    words: str
    floor: float
    factor: bool = False
    upper_only: bool = False


_COMPARED = (
    _Compared("gain", 0.005, factor=True),
    *(_Compared(f"opening of the loop at {where} of the drive", 0.003) for where in ("1/4", "1/2")),
    _Compared("opening of the loop at 3/4 of the drive", 0.003),
    *(_Compared(f"bend of the loop at {where} of the drive", 0.003) for where in ("1/4", "1/2")),
    _Compared("bend of the loop at 3/4 of the drive", 0.003),
    _Compared("error of the model", 0.1, factor=True, upper_only=True),
)


_Reason = tuple[int, float, str]
"""Which quantity is odd, by how many robust deviations, and the same in words."""


@dataclass(frozen=True, eq=False)
class Judged:
    """What the comparison of a fleet gave.

    Parameters
    ----------
    distances
        Largest robust deviation by identifier; NaN where nothing can be compared.
    outliers
        The odd ones, the oddest first.
    sentence
        How it was judged.
    """

    distances: dict[str, float]
    outliers: tuple[Outlier, ...]
    sentence: str


def judge_fleet(devices: Sequence[Device]) -> Judged:
    """Compare the devices of a fleet that have a model.

    Parameters
    ----------
    devices
        All devices.
    """
    compared = [each for each in devices if not each.failure]
    nothing = {each.identifier: math.nan for each in devices}
    if len(compared) < FEWEST:
        return Judged(
            nothing,
            (),
            f"{len(compared)} devices have a model: too few to say which is odd, for which it "
            f"takes {FEWEST}.",
        )
    x = np.array([_features(each) for each in compared])
    odd, reasons = _against_all(x)
    near, near_reasons = _against_like(x)
    turned, found = _against_sign(compared), _against_findings(compared)
    outliers, distances = [], dict(nothing)
    for k, each in enumerate(compared):
        distances[each.identifier] = float(max(odd[k], near[k]))
        told = (*turned[k], *found[k], *_oddest((*reasons[k], *near_reasons[k])))
        if told:
            outliers.append(Outlier(each.identifier, distances[each.identifier], told))
    outliers.sort(key=lambda each: -each.distance)
    return Judged(distances, tuple(outliers), _sentence(len(compared), len(outliers)))


def _sentence(count: int, odd: int) -> str:
    near = FALSE_ALARMS_NEAR * max(1.0, count / 1000) if count >= FEWEST_NEAR else 0.0
    false = FALSE_ALARMS + near
    what = "No device is" if not odd else f"{odd} device{'s are' if odd > 1 else ' is'}"
    return (
        f"{what} odd among the {count} with a model; of devices that only scatter normally "
        f"at most about {false:.1g} in a whole fleet would be named by mistake."
    )


def _oddest(reasons: Sequence[_Reason]) -> tuple[str, ...]:
    """Give the oddest quantities in words, each once."""
    ordered = sorted(reasons, key=lambda each: -each[1])
    return tuple({q: text for q, _, text in reversed(ordered)}[q] for q in _first(ordered))


def _first(ordered: Sequence[_Reason]) -> list[int]:
    return list(dict.fromkeys(q for q, _, _ in ordered))[:MOST_REASONS]


def _features(device: Device) -> list[float]:
    rising, falling = np.array(device.rising), np.array(device.falling)
    middle = 0.5 * (rising + falling)
    bend = middle - np.linspace(middle[0], middle[-1], POINTS)
    width = (falling - rising) * math.copysign(1.0, middle[-1] - middle[0])
    gain, error = abs(device.numbers["gain"]), device.numbers["rms_percent"]
    return [
        math.log(max(gain, 1e-300)),
        *width[list(_QUARTERS)],
        *bend[list(_QUARTERS)],
        # An error of a hundredth of a percent is none that a device could be odd by.
        math.log(error + 0.01),
    ]


def _against_all(x: Array) -> tuple[Array, list[tuple[_Reason, ...]]]:
    count = len(x)
    floors = np.array([each.floor for each in _COMPARED])
    center = np.median(x, axis=0)
    off = x - center
    scale = np.maximum(_TO_DEVIATION * np.median(np.abs(off), axis=0), floors)
    size = _sized(off / scale)
    limit = _limit(count)
    odd = size > limit
    reasons: list[tuple[_Reason, ...]] = []
    for k in range(count):
        found = [q for q in np.argsort(-size[k]) if odd[k, q] and _is_alone(x, k, q, odd, scale)]
        reasons.append(
            tuple(_reason(q, x[k, q], center[q], size[k, q], "of the fleet") for q in found)
        )
    return size.max(axis=1), reasons


def _is_alone(x: Array, k: int, q: int, odd: NDArray[np.bool_], scale: Array) -> bool:
    """Tell whether no more devices than of a few are odd in the same way by about as much."""
    own = odd[:, q] & (np.abs(x[:, q] - x[k, q]) < 3.0 * scale[q])
    return bool(own.sum() <= _most_alike(len(x)))


def _most_alike(count: int) -> int:
    return max(LEAST_OF_A_KIND, math.ceil(SHARE_OF_A_KIND * count))


def _against_like(x: Array) -> tuple[Array, list[tuple[_Reason, ...]]]:
    count = len(x)
    if count < FEWEST_NEAR:
        return np.zeros(count), [()] * count
    from scipy.spatial import cKDTree  # slow to import, and for large fleets only

    scale = _scatter_between_nearest(x)
    alike = _most_alike(count) + 2
    distances, nearest = cKDTree(x / scale).query(x / scale, k=2 * alike)
    far = np.log(np.maximum(distances[:, alike - 1], 1e-12))
    apart = far - np.median(far[nearest[:, 1:alike]], axis=1)
    unlike, usual = _unlike(x, scale)
    size, reasons = np.zeros(count), list[tuple[_Reason, ...]]()
    for k in range(count):
        near, center = _from_nearest(x[k], x[nearest[k, 1:]], scale)
        size[k] = max(near.max(), unlike[k].max())
        reasons.append(
            _told(x[k], unlike[k], usual[k], UNLIKE, "of the devices like it in all else")
            if math.exp(apart[k]) > APART and near.max() > NEAR
            else ()
        )
        if not reasons[-1] and math.exp(apart[k]) > FAR_APART and near.max() > FAR:
            reasons[-1] = _told(x[k], near, center, FAR, "of the devices most like it")
    return size, reasons


def _told(own: Array, size: Array, center: Array, least: float, whose: str) -> tuple[_Reason, ...]:
    """Give the two oddest quantities beyond a limit, in words."""
    odd = [q for q in np.argsort(-size)[:2] if size[q] > least]
    return tuple(_reason(q, own[q], center[q], size[q], whose) for q in odd)


_ALIKE_IN = ((0,), (1, 2, 3), (4, 5, 6), (7,))
"""Gain, opening, bend and error: what is left out of the likeness when one is compared."""


def _unlike(x: Array, scale: Array) -> tuple[Array, Array]:
    """Give how far each quantity is from those of the devices alike in the others, and theirs."""
    from scipy.spatial import cKDTree  # as above

    floors = np.array([each.floor for each in _COMPARED])
    most = max(10, min(LIKE, len(x) // 8))
    usual, spread = np.empty_like(x), np.empty_like(x)
    for own in _ALIKE_IN:
        # An error says of which kind a device is only where it is a bad one.
        others = [q for q in range(x.shape[1] - 1) if q not in own]
        z = x[:, others] / scale[others]
        nearest = cKDTree(z).query(z, k=most + 1)[1][:, 1:]
        for q in own:
            usual[:, q] = np.median(x[nearest, q], axis=1)
            off = np.abs(x[nearest, q] - usual[:, q, None])
            spread[:, q] = _TO_DEVIATION * np.median(off, axis=1)
    off = x - usual
    whole = np.maximum(_TO_DEVIATION * np.median(np.abs(off), axis=0), floors)
    return _sized(off / np.maximum(spread, whole)), usual


def _sized(deviations: Array) -> Array:
    """Give sizes of deviations; of an error only what is above counts."""
    size = np.abs(deviations)
    upper = [each.upper_only for each in _COMPARED]
    size[..., upper] = np.maximum(deviations[..., upper], 0.0)
    return np.asarray(size)


def _scatter_between_nearest(x: Array) -> Array:
    """Give the scatter of each quantity between devices that are most alike."""
    from scipy.spatial import cKDTree  # as above

    floors = np.array([each.floor for each in _COMPARED])
    scale = np.maximum(_TO_DEVIATION * np.median(np.abs(x - np.median(x, axis=0)), axis=0), floors)
    for _ in range(2):
        _, nearest = cKDTree(x / scale).query(x / scale, k=2)
        between = np.abs(x - x[nearest[:, 1]])
        scale = np.maximum(_TO_DEVIATION * np.median(between, axis=0) / math.sqrt(2.0), floors)
    return np.asarray(scale)


def _from_nearest(own: Array, others: Array, scale: Array) -> tuple[Array, Array]:
    """Give how far a device is from those most like it, in each quantity, and their median."""
    center = np.median(others, axis=0)
    scatter = np.maximum(_TO_DEVIATION * np.median(np.abs(others - center), axis=0), scale)
    return _sized((own - center) / scatter), center


def _reason(q: int, value: float, center: float, size: float, whose: str) -> _Reason:
    each = _COMPARED[q]
    if each.factor:
        what = f"{math.exp(value - center):.3g} times the median {whose}"
    else:
        what = f"{100 * value:.3g} % of its height, the median {whose} {100 * center:.3g} %"
    return int(q), float(size), f"{each.words}: {what} ({size:.3g} robust deviations)"


def _against_sign(devices: Sequence[Device]) -> list[tuple[str, ...]]:
    """Name the devices that fall where most others rise."""
    falls = np.array([each.numbers["gain"] < 0.0 for each in devices])
    fewer = falls if falls.mean() < 0.5 else ~falls
    if not 0 < fewer.sum() <= _most_alike(len(devices)):
        return [()] * len(devices)
    what = "falls where that of the others rises" if falls.mean() < 0.5 else "rises, others fall"
    return [(f"its output {what}",) if each else () for each in fewer]


def _against_findings(devices: Sequence[Device]) -> list[tuple[str, ...]]:
    """Name the devices whose record has samples left out for what hardly any other record has."""
    often = Counter(name for each in devices for name in each.left_out)
    return [
        tuple(
            f"{sentence.rstrip('.')}; hardly any other record has that"
            for name, sentence in each.left_out.items()
            if often[name] <= _most_alike(len(devices))
        )
        for each in devices
    ]


def _limit(count: int) -> float:
    """Give the deviations that a fleet of this size exceeds by chance as seldom as is wanted.

    A median absolute deviation of a few devices is itself not known well: Student's t.
    """
    from scipy.special import stdtrit  # as above

    freedom = max(_EFFICIENCY * (count - 1), 1.0)
    return float(-stdtrit(freedom, FALSE_ALARMS / (2 * len(_COMPARED) * count)))
