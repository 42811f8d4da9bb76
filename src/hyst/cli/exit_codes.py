"""How the program ends: its exit codes."""

from __future__ import annotations

DONE, FAILURE, BAD_INPUT, UNFIT = 0, 1, 2, 3
