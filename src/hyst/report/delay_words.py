"""The delay in words: how much, how sure, and what follows from it, if anything does."""

from __future__ import annotations

from hyst.operators import ModelDescription

Interval = tuple[float, float] | None

_A_SAMPLE = 0.5  # where an interval goes beyond half a sample, another whole number is in it


def delay_sentence(delay: float, dt: float | None, interval: Interval = None) -> str:
    """Say by how much the output lags, how sure that is, and what to do if it is known.

    Parameters
    ----------
    delay
        Samples; may be a fraction, and is negative where the output is ahead of the input.
    dt
        Sample time, s, if known.
    interval
        Lowest and highest delay that the records do not exclude, samples; None if not known, both
        the delay itself if it was given.

    Returns
    -------
    str

    Examples
    --------
    >>> delay_sentence(0, 0.01, (0.0, 5.0))
    'No delay is taken; the records would also bear 0 to 5 samples (0 to 50 ms).'
    >>> delay_sentence(2, None, (0.0, 3.0))[:54]
    'The recorded output lags the model by 2 samples (0 to '
    """
    if delay == 0:
        return _no_delay(dt, interval)
    if delay < 0:
        return _ahead(delay, dt, interval)
    lag = f"The recorded output lags the model by {lag_in_words(delay, dt, interval)}"
    if interval is not None and interval[0] <= 0.0 < interval[1]:
        return (
            f"{lag}, but the records would also bear no delay. The model itself has none; do not "
            "act on a delay that is not sure."
        )
    return (
        f"{lag}. The model itself has no delay; the lag is kept in the model file and cannot be "
        "compensated, only anticipated, by giving the command that much earlier."
    )


def lag_in_words(delay: float, dt: float | None, interval: Interval = None) -> str:
    """Give a delay in samples with its interval, and in time.

    Parameters
    ----------
    delay, dt, interval
        As of ``delay_sentence``.

    Returns
    -------
    str

    Examples
    --------
    >>> lag_in_words(4, 0.005, (3.8, 4.2)), lag_in_words(1, None), lag_in_words(1.42, 1e-3)
    ('4 samples (3.8 to 4.2), 20 ms', '1 sample', '1.42 samples, 1.42 ms')
    """
    plural = "" if delay == 1 else "s"
    open_to = f" ({_span(interval)})" if _is_open(interval) else ""
    time = "" if dt is None else f", {_time(delay * dt)}"
    return f"{_digits(delay)} sample{plural}{open_to}{time}"


def delay_to_act_on(about: ModelDescription) -> str:
    """Give the delay in words where it is known, and nothing where records would bear none.

    Parameters
    ----------
    about
        Of the model.

    Returns
    -------
    str
        Empty where there is no delay, or none to act on.
    """
    low, high = about.delay_interval or (about.delay, about.delay)
    if about.delay <= 0 or (low <= 0.0 <= high):
        return ""
    return lag_in_words(about.delay, about.dt, about.delay_interval)


def _no_delay(dt: float | None, interval: Interval) -> str:
    if interval is None or interval == (0.0, 0.0):
        return "No delay is taken; the records were not asked, or are too short to show one."
    low, high = interval
    if max(abs(low), abs(high)) < _A_SAMPLE:
        return f"The output does not lag (the records bear {_span(interval)} samples)."
    time = "" if dt is None else f" ({_digits(low * dt * 1e3)} to {_digits(high * dt * 1e3)} ms)"
    return f"No delay is taken; the records would also bear {_span(interval)} samples{time}."


def _ahead(delay: float, dt: float | None, interval: Interval) -> str:
    known = [] if interval is None else [_span((-interval[1], -interval[0]))]
    known = [*known[: _is_open(interval)], *([] if dt is None else [_time(-delay * dt)])]
    more = f" ({', '.join(known)})" if known else ""
    plural = "" if delay == -1 else "s"
    sentence = (
        f"The recorded output is {_digits(-delay)} sample{plural} AHEAD of the input{more}, which "
        "no actuator is: the channels are not aligned. "
    )
    if interval is not None and interval[1] >= 0.0:
        return f"{sentence}The records would also bear none; check the alignment of the channels."
    return f"{sentence}Align them, or exchange the columns if they are, and identify again."


def _is_open(interval: Interval) -> bool:
    return interval is not None and _digits(interval[0]) != _digits(interval[1])


def _span(interval: Interval) -> str:
    assert interval is not None
    return f"{_digits(interval[0])} to {_digits(interval[1])}"


def _digits(value: float) -> str:
    return f"{value if value else 0.0:.3g}"  # no minus before a zero


def _time(seconds: float) -> str:
    """Give a time with the unit that a person would take."""
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("us", 1e-6)):
        if abs(seconds) >= size:
            return f"{_digits(seconds / size)} {unit}"
    return f"{_digits(seconds * 1e9)} ns"
