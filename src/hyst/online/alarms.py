"""Alarms that start once, end once, and do not flicker between."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from hyst.checks.numbers import whole_number
from hyst.errors import InputError


@dataclass(frozen=True)
class AlarmRule:
    """When an alarm starts and when it ends.

    It starts after ``starts_after`` values in a row of ``start`` or more, and ends after
    ``ends_after`` in a row of ``stop`` or less; between the two levels it stays as it is. That is
    the hysteresis of the alarm.

    Parameters
    ----------
    name
        What it is called.
    start, stop
        Levels, ``stop`` at most ``start``.
    starts_after, ends_after
        Values in a row, at least 1.

    Raises
    ------
    InputError
        If a level is not finite, they are upside down, or a count is below 1.

    Examples
    --------
    >>> AlarmRule("error", 1.0, 0.7, starts_after=2).ends_after
    1
    """

    name: str
    start: float = 1.0
    stop: float = 0.5
    starts_after: int = 1
    ends_after: int = 1

    def __post_init__(self) -> None:
        if not (math.isfinite(self.start) and math.isfinite(self.stop)) or self.stop > self.start:
            raise InputError(
                f"alarm {self.name!r} starts at {self.start} and ends at {self.stop}; give finite "
                "levels, the lower one for its end"
            )
        for name in ("starts_after", "ends_after"):
            whole_number(getattr(self, name), name, 1, more=" values")


@dataclass(frozen=True)
class AlarmEvent:
    """The start or the end of an alarm.

    Parameters
    ----------
    time
        Seconds, of the value that decided.
    name
        Of the alarm.
    starts
        Whether it starts; else it ends.
    sentence
        What is the matter, or for how long it was and how bad.
    value
        The value that decided, or at the end the largest there was.
    """

    time: float
    name: str
    starts: bool
    sentence: str
    value: float

    def __str__(self) -> str:
        return f"{'ALARM' if self.starts else 'ended'}: {self.name}: {self.sentence}"


class Alarm:
    """One alarm, fed with a value now and then.

    Parameters
    ----------
    rule
        When it starts and ends.

    Examples
    --------
    >>> alarm = Alarm(AlarmRule("error", 1.0, 0.5, starts_after=2))
    >>> [alarm.look(k, value, "large") is not None for k, value in enumerate((1, 0, 1, 2, 1, 0))]
    [False, False, False, True, False, True]
    """

    def __init__(self, rule: AlarmRule) -> None:
        self.rule = rule
        self.is_active = False
        """Whether it has started and not ended."""
        self._in_a_row = 0
        self._since = 0.0
        self._worst = 0.0

    def look(self, time: float, value: float, sentence: str) -> AlarmEvent | None:
        """Take in a value.

        Parameters
        ----------
        time
            Seconds, not falling.
        value
            NaN where nothing is known, which changes nothing.
        sentence
            What is the matter, for an alarm that starts here.

        Returns
        -------
        AlarmEvent or None
            None unless the alarm starts or ends here.
        """
        if math.isnan(value):
            return None
        if self.is_active:
            self._worst = max(self._worst, value)
        is_beyond = value <= self.rule.stop if self.is_active else value >= self.rule.start
        self._in_a_row = self._in_a_row + 1 if is_beyond else 0
        needed = self.rule.ends_after if self.is_active else self.rule.starts_after
        if self._in_a_row < needed:
            return None
        self.is_active, self._in_a_row = not self.is_active, 0
        if self.is_active:
            self._since, self._worst = time, value
            return AlarmEvent(time, self.rule.name, True, sentence, value)
        lasted = f"after {time - self._since:.6g} s"
        return AlarmEvent(time, self.rule.name, False, lasted, self._worst)


class Alarms:
    """Several alarms together.

    Parameters
    ----------
    rules
        One for each, of different names.

    Raises
    ------
    InputError
        If two have one name.

    Examples
    --------
    >>> alarms = Alarms([AlarmRule("error"), AlarmRule("drift")])
    >>> [str(each) for each in alarms.look(3.0, {"drift": (2.0, "4 % of the range")})]
    ['ALARM: drift: 4 % of the range']
    >>> alarms.active
    ('drift',)
    """

    def __init__(self, rules: Iterable[AlarmRule]) -> None:
        self._alarms: dict[str, Alarm] = {}
        for rule in rules:
            if rule.name in self._alarms:
                raise InputError(f"two alarms are called {rule.name!r}; give each its own name")
            self._alarms[rule.name] = Alarm(rule)

    @property
    def active(self) -> tuple[str, ...]:
        """Names of those that have started and not ended."""
        return tuple(name for name, each in self._alarms.items() if each.is_active)

    def look(self, time: float, values: Mapping[str, tuple[float, str]]) -> tuple[AlarmEvent, ...]:
        """Take in values.

        Parameters
        ----------
        time
            Seconds, not falling.
        values
            By name of the alarm: its value and the sentence of its start. Alarms that are not named
            stay as they are.

        Returns
        -------
        tuple of AlarmEvent
            Those that start or end here, in the order of the rules.

        Raises
        ------
        InputError
            If a name is unknown.
        """
        for name in values:
            if name not in self._alarms:
                raise InputError(f"no alarm is called {name!r}; there are {list(self._alarms)}")
        found = (
            alarm.look(time, *values[name])
            for name, alarm in self._alarms.items()
            if name in values
        )
        return tuple(event for event in found if event is not None)
