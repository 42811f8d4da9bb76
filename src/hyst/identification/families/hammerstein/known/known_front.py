"""Where the fit of dynamics starts whose hysteresis is known.

The signal behind the hysteresis is then known but for gain and offset, so the dynamics are found
as those between it and the output, without the distortion that a hysteresis adds.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hyst.identification.families.family import Start
from hyst.identification.families.hammerstein.joint import joint
from hyst.identification.families.hammerstein.known.held_front import HeldFront
from hyst.identification.record_use.overview import Overview
from hyst.identification.record_use.used_samples import Data
from hyst.models import LinearDynamics


def behind_known(front: HeldFront | None, overview: Overview) -> Overview:
    """Give the records with what is behind a known hysteresis as their drive, else as they are.

    Parameters
    ----------
    front
        The hysteresis; None where it is not known.
    overview
        The records.
    """
    if front is None:
        return overview
    return Overview(front.behind(overview.data), overview.delay, rates_matter=True)


def starts_behind_known(front: HeldFront, dynamics: LinearDynamics, data: Data) -> Sequence[Start]:
    """Give gain and offset of a known hysteresis before dynamics, all to be fitted together.

    Parameters
    ----------
    front
        The hysteresis.
    dynamics
        To start from, of gain 1 at rest.
    data
        The records.
    """
    pairs = zip(front.behind(data).records, data.windows(), strict=True)
    v = data.joined([dynamics(each.u - each.u[0])[window] + each.u[0] for each, window in pairs])
    return [joint(front.start_from(data, np.asarray(v)), dynamics)]
