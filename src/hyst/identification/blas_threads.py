"""How many threads the linear algebra of a fit takes: one.

Matrices of a few dozen columns gain nothing from a second one, which costs more than it gives.
"""

from __future__ import annotations

import functools
from contextlib import AbstractContextManager
from typing import Any

from threadpoolctl import ThreadpoolController


def one_blas_thread() -> AbstractContextManager[Any]:
    """Give what holds linear algebra to one thread, and lets it go again."""
    held: AbstractContextManager[Any] = _libraries().limit(limits=1, user_api="blas")
    return held


@functools.cache
def _libraries() -> ThreadpoolController:
    """Look for the libraries once: it takes 2 ms, and NumPy and SciPy have loaded theirs."""
    return ThreadpoolController()
