"""The numbers that are told of every device, and what they are worth knowing for."""

from __future__ import annotations

from dataclasses import dataclass

PARAMETER, ERROR = "parameter ", "standard error "
"""What names of columns of parameters and of their standard errors begin with."""


@dataclass(frozen=True)
class Quantity:
    """A number that every device has.

    Parameters
    ----------
    unit
        ``"input"``, ``"output"``, ``"output/input"``, or as it is written.
    meaning
        In a few words.
    """

    unit: str
    meaning: str


QUANTITIES = {
    "samples": Quantity("", "samples of the record"),
    "rms_error": Quantity("output", "rms of model minus record"),
    "rms_percent": Quantity("%", "the same, of the range of the output"),
    "max_error": Quantity("output", "largest error at a sample"),
    "noise": Quantity("output", "noise from sample to sample, standard deviation"),
    "input_range": Quantity("input", "highest minus lowest input"),
    "output_range": Quantity("output", "highest minus lowest output: the stroke"),
    "gain": Quantity("output/input", "rise of the modelled loop from end to end, over its drive"),
    "hysteresis_percent": Quantity("%", "widest opening of the modelled loop, of its height"),
    "bend_percent": Quantity(
        "%", "largest distance of the middle of the loop from a straight line, of its height"
    ),
    "delay": Quantity("samples", "samples by which the output lags"),
}


def unit_of(name: str, input_unit: str, output_unit: str) -> str:
    """Give the unit of a quantity, empty where it is not known.

    Parameters
    ----------
    name
        Of the quantity; one that is not listed has none.
    input_unit, output_unit
        Of the records.
    """
    unit = QUANTITIES[name].unit if name in QUANTITIES else ""
    if unit == "output/input":
        known = input_unit and output_unit and input_unit != output_unit
        return f"{output_unit}/{input_unit}" if known else ""
    return {"input": input_unit, "output": output_unit}.get(unit, unit)
