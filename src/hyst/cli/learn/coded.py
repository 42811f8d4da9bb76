"""The next command as codes of a driver, and the output to expect of them."""

from __future__ import annotations

import numpy as np

import hyst
from hyst.cli.learn.replay import Replayed, Wish


def in_codes_of(
    driver: hyst.Driver | None, done: Replayed, model: hyst.Operator, wish: Wish
) -> hyst.compensation.CodedCommand | None:
    """Give the command as codes; what is expected changes by what the model says of their volts.

    Parameters
    ----------
    driver
        Whose codes are wanted; None for none.
    done
        Where the learning stands.
    model
        Learning started from.
    wish
        For limits, and the drive before the command.
    """
    if driver is None:
        return None
    u = done.learner.command
    codes = driver.codes(u, wish.input_range)
    volts = driver.volts(codes)
    before = list(wish.history or ())
    wanted, given = (np.concatenate([each, each]) if wish.periodic else each for each in (u, volts))
    change = hyst.compensation.change_of_output(model, wanted, given, before)[-u.size :]
    off = float(np.abs(volts - u).max())
    return hyst.compensation.CodedCommand(
        driver, codes, volts, done.learner.y_ref, done.expected + change, off
    )
