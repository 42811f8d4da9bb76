"""All that a worker may be asked to do, loaded before it is."""

from __future__ import annotations

from hyst.studio.work.following import follow
from hyst.studio.work.identifying import find_model, overlay
from hyst.studio.work.looking import look
from hyst.studio.work.measuring import measure
from hyst.studio.work.saving import save

__all__ = ["find_model", "follow", "look", "measure", "overlay", "save"]
