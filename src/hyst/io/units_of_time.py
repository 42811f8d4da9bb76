"""Seconds in a unit of time, in the spellings that files have."""

from __future__ import annotations

_SECOND_WORDS = (
    *("second", "seconds", "sekunde", "sekunden", "seconde", "secondes", "seconden"),
    *("segundo", "segundos", "secondo", "secondi"),
)
_PREFIX_WORDS = {
    **dict.fromkeys(("milli", "mili"), 1e-3),
    **dict.fromkeys(("micro", "mikro"), 1e-6),
    "nano": 1e-9,
    **dict.fromkeys(("pico", "piko"), 1e-12),
}
_SPELLINGS = {
    1.0: ("s", "sec", "secs", "sek", "seg", *_SECOND_WORDS),
    1e-3: ("ms", "msec", "msecs", "msek", "millisec", "millis"),
    # Case folding makes the micro sign the Greek mu.
    1e-6: (
        *("us", "usec", "usecs", "microsec", "micros"),
        *("\N{GREEK SMALL LETTER MU}s", "\N{GREEK SMALL LETTER MU}sec"),
    ),
    1e-9: ("ns", "nsec", "nsecs", "nanosec", "nanos"),
    1e-12: ("ps", "psec", "picosec", "picos"),
    60.0: ("min", "mins", "minute", "minutes", "minuten", "minuto", "minutos", "minuti"),
    3600.0: (
        *("h", "hr", "hrs", "hour", "hours", "std", "stunde", "stunden", "heure", "heures"),
        *("hora", "horas"),
    ),
    # The letter alone is more often a name.
    86400.0: ("day", "days"),
}
_SECONDS = {
    **{spelling: seconds for seconds, all_of in _SPELLINGS.items() for spelling in all_of},
    **{f"{p}{word}": value for p, value in _PREFIX_WORDS.items() for word in _SECOND_WORDS},
}


def seconds_per_unit(unit: str) -> float | None:
    """Give the seconds in a unit of time, 1 for no unit, None if it is unknown.

    Examples
    --------
    >>> seconds_per_unit("ms"), seconds_per_unit("msec."), seconds_per_unit("Mikrosekunden")
    (0.001, 0.001, 1e-06)
    >>> seconds_per_unit(""), seconds_per_unit("furlong")
    (1.0, None)
    """
    spelling = unit.strip().rstrip(".").casefold()
    return 1.0 if not spelling else _SECONDS.get(spelling)
