"""The exceptions hyst raises; every message says what, which value, what to do."""

from __future__ import annotations


class HystError(Exception):
    """Base of every error raised on purpose by hyst."""


class InputError(HystError, ValueError):
    """Data, a file or an argument that cannot be used as it is."""


class NotInvertibleError(HystError, ValueError):
    """An operator without an exact inverse; the message names the failing condition."""


class NotIdentifiableError(HystError, ValueError):
    """A record that cannot determine what was asked of it."""


class SolverError(HystError, RuntimeError):
    """A numerical method that did not converge."""


class MissingExtraError(HystError, ImportError):
    """An optional dependency that is not installed; the message names the extra."""
