"""Blocks of hyst as systems of python-control, for loops that users build there themselves."""

from __future__ import annotations

from hyst.control.python_control.loop import closed_loop_system
from hyst.control.python_control.nonlinear_system import to_nlsys

__all__ = ["closed_loop_system", "to_nlsys"]


def __dir__() -> list[str]:
    return __all__
