"""What the table of a README says of a model: signals, errors, verdict, lag, origin."""

from __future__ import annotations

from hyst.export.c.block import Block
from hyst.export.c.example import meanings
from hyst.export.c.names import plain_text
from hyst.export.c.readme_start import history_said
from hyst.operators import ModelDescription

_LONGEST_SENTENCE = 400


def signals(block: Block, about: ModelDescription) -> dict[str, tuple[str, str]]:
    """Give name and unit of the signals of a ``block`` by what C calls them, if ``about`` tells."""
    if block.is_estimator:
        return {role: meant for role, meant in meanings(block, about).items() if role != "y_ref"}
    told = len(block.inputs) == 1 or block.second
    return meanings(block, about) if told else {}


def signal_rows(block: Block, about: ModelDescription, variable: dict[str, str]) -> dict[str, str]:
    """Give a row for every signal: what it means, its unit, and its range in the record.

    Parameters
    ----------
    block, about
        What is exported, and what its numbers mean.
    variable
        What the example calls the signals.
    """
    ranges = {
        block.inputs[0]: (about.input_low, about.input_high),
        block.inputs[1] if block.is_estimator else block.output: (
            about.output_low,
            about.output_high,
        ),
    }
    rows = {}
    for role, (name, unit) in signals(block, about).items():
        low, high = ranges.get(role, (None, None))
        said = plain_text(name)
        said += f" in {plain_text(unit)}" if unit else ""
        said += "" if low is None or high is None else f", {low:.6g} to {high:.6g} in the record"
        called = f"{role}, `{variable[role]}`" if variable[role] != role else f"`{role}`"
        rows[called] = said
    return rows


def drive_rows(block: Block, name: str) -> dict[str, str]:
    """Give the rows that say what the drive may be, and which drives the memory comes after.

    Parameters
    ----------
    block, name
        What is exported, and its prefix.
    """
    said = plain_text(block.drive.said(), _LONGEST_SENTENCE)
    if block.drive.limits is not None:
        said = f"`{name.upper()}_U_MIN` to `{name.upper()}_U_MAX`: {said}"
    rows = {"limits of the drive": said}
    if block.history:
        rows["start"] = f"after drives of {history_said(block)}"
    return rows


def error_rows(about: ModelDescription) -> dict[str, str]:
    """Give a row for every record the model was compared with, as far as ``about`` tells."""
    told = about.input_unit if about.is_inverse else about.output_unit
    unit = f" {plain_text(told)}" if told else ""
    of = " of the model it inverts" if about.is_inverse else ""
    rows = {}
    for record, errors in about.errors.items():
        said = []
        if "rms" in errors:
            said.append(f"rms {errors['rms']:.3g}{unit}")
        if "rms_percent" in errors:
            said.append(f"{errors['rms_percent']:.3g} % of the range")
        if "max_abs" in errors:
            said.append(f"at most {errors['max_abs']:.3g}{unit}")
        rows[f"error{of}, {plain_text(record)}"] = ", ".join(said) or "not known"
    return rows


def verdict_row(about: ModelDescription, *, all_levels: bool = False) -> dict[str, str]:
    """Give the row of a table that says how far to trust what ``about`` tells of.

    Parameters
    ----------
    about
        Of the model.
    all_levels
        Whether it is also said where commands may come from it.
    """
    if about.verdict is None or not (about.is_unfit or all_levels):
        return {}
    parts = about.verdict.sentences[0][:_LONGEST_SENTENCE].split("'")
    said = "'".join(plain_text(each, _LONGEST_SENTENCE) for each in parts)
    return {"verdict": f"{about.verdict.level}: {said}"}


def lag_row(about: ModelDescription) -> dict[str, str]:
    """Give the row of a table that says what lag ``about`` tells of, which no code contains."""
    if about.delay == 0:
        return {}
    time = "" if about.dt is None else f" of {about.dt!r} s"
    if about.delay < 0:
        ahead = f"the recorded output was {-about.delay} sample(s){time} ahead of the input, which"
        return {"lag": f"{ahead} no actuator is: its channels were not aligned"}
    low, _ = about.delay_interval or (about.delay, about.delay)
    if low <= 0.0:
        return {}  # the records would bear none
    return {"lag": f"the recorded output lagged {about.delay} sample(s){time}; this code does not"}


def provenance_row(about: ModelDescription) -> dict[str, str]:
    """Give the row that says where the model comes from, as far as ``about`` tells."""
    origin = about.provenance
    if origin is None:
        return {"origin": "not identified by hyst, or not told"}
    family = f" as {plain_text(about.family)}" if about.family else ""
    said = [
        f"identified{family} on {plain_text(origin.date)}",
        f"hyst {plain_text(origin.versions.get('hyst', 'of a version not told'))}",
        f"data SHA-256 {origin.data_sha256[:16]}...",
    ]
    if origin.command:
        said.append(f"command: {plain_text(origin.command, _LONGEST_SENTENCE)}")
    return {"origin": "; ".join(said)}
