"""What to export in the place of an object of MATLAB, and what signals in structs are called."""

from __future__ import annotations

from hyst.io.entries import Contents

_EXPORTS = {
    "timetable": (
        "t = seconds({name}.Properties.RowTimes - {name}.Properties.RowTimes(1)) and each of its "
        "columns, u = {name}.u"
    ),
    "table": "each of its columns, u = {name}.u",
    "timeseries": "t = {name}.Time and y = squeeze({name}.Data)",
    "datetime": "t = seconds({name} - {name}(1))",
    "duration": "t = seconds({name})",
    "Simulink.SimulationOutput": (
        "t = {name}.tout and y = {name}.yout, logged as array or structure with time, or "
        "y = squeeze({name}.logsout{{1}}.Values.Data)"
    ),
    "Simulink.SimulationData.Dataset": (
        "t = {name}{{1}}.Values.Time and y = squeeze({name}{{1}}.Values.Data)"
    ),
    "Simulink.SimulationData.Signal": "t = {name}.Values.Time and y = squeeze({name}.Values.Data)",
}
_LABELS, _UNITS, _DATA = ("label", "name"), ("unit", "units"), ("data", "values", "value")


def object_refused(path: str, kind: str) -> str:
    """Say why an object is no column, and what to save in its place.

    Parameters
    ----------
    path
        Its name.
    kind
        Its class; empty if that is not known.

    Examples
    --------
    >>> object_refused("run", "timeseries").split("; ")[1]
    'save t = run.Time and y = squeeze(run.Data) as vectors'
    """
    kind = kind or "unknown class"
    what = _EXPORTS.get(kind, "the vectors in it").format(name=path)
    vectors = "" if kind not in _EXPORTS else " as vectors"
    article = "an" if kind[0].lower() in "aeiou" else "a"
    return f"is {article} {kind}, an object that only MATLAB can open; save {what}{vectors}"


def label_signals(contents: Contents) -> None:
    """Call the data of a struct by the name and unit that stand beside them in it.

    So Simulink (label, values) and dSPACE ControlDesk (Name, Data, Unit) store signals. The path
    stays the full header.

    Parameters
    ----------
    contents
        What a file holds; gets ``labels`` and ``units``.

    Examples
    --------
    >>> import numpy as np
    >>> contents = Contents(texts={"run.Y(2).Name": "pos", "run.Y(2).Unit": "um"})
    >>> contents.add("run.Y(2).Data", np.arange(3.0))
    >>> label_signals(contents)
    >>> contents.labels, contents.units
    ({'run.Y(2).Data': 'pos'}, {'run.Y(2).Data': 'um'})
    """
    beside = {path.casefold(): text.strip() for path, text in contents.texts.items()}
    for path in contents.arrays:
        parent, _, leaf = path.casefold().rpartition(".")
        if not parent or leaf not in _DATA:
            continue
        label = next(filter(None, (beside.get(f"{parent}.{each}") for each in _LABELS)), "")
        unit = next(filter(None, (beside.get(f"{parent}.{each}") for each in _UNITS)), "")
        if label:
            contents.labels[path] = label
        if unit:
            contents.units[path] = unit
