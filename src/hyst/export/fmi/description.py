"""``modelDescription.xml`` and ``buildDescription.xml`` of an FMU."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, final
from xml.etree import ElementTree

import hyst
from hyst.export.fmi.units import base_unit
from hyst.export.fmi.variables import ParameterVariable, Rule

FmiVersion = Literal["2.0", "3.0"]
Element = ElementTree.Element

_CATEGORIES = {
    "logStatusWarning": "A sample was not finite",
    "logStatusError": "A call was wrong",
}
_SOURCE = "hyst_all.c"


@final
@dataclass(frozen=True)
class Signal:
    """An input or the output.

    Parameters
    ----------
    name
        Of the variable.
    meaning
        The user's name of the signal.
    unit
        The user's text, or "".
    """

    name: str
    meaning: str
    unit: str


@final
@dataclass(frozen=True)
class FmuDescription:
    """What an importer is told.

    Parameters
    ----------
    identifier
        The name of binary and functions, a C identifier.
    kind
        Of the model.
    token
        Hash of the content.
    inputs, output
        The signals.
    direct
        Of each input, whether the output depends on it in the same sample.
    parameters
        The constants that may be set.
    estimates
        Names of the parameters that are estimated.
    dt
        Sample time, seconds; None if any will do.
    """

    identifier: str
    kind: str
    token: str
    inputs: tuple[Signal, ...]
    output: Signal
    direct: tuple[bool, ...]
    parameters: tuple[ParameterVariable, ...]
    estimates: tuple[str, ...]
    dt: float | None


def xml_text(text: str) -> str:
    r"""Give a text as XML can carry it: one line, no control characters.

    Parameters
    ----------
    text
        Any.

    Returns
    -------
    str

    Examples
    --------
    >>> xml_text("V\n(peak)\x00")
    'V (peak)�'
    """
    one_line = re.sub(r"\s+", " ", text).strip()
    return re.sub("[\x00-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]", "\ufffd", one_line)


def model_description(about: FmuDescription, version: FmiVersion) -> bytes:
    """Give ``modelDescription.xml``.

    Parameters
    ----------
    about
        What it says.
    version
        Of FMI.

    Returns
    -------
    bytes
        UTF-8.
    """
    is_2 = version == "2.0"
    root = Element("fmiModelDescription", fmiVersion=version, modelName=about.identifier)
    root.set("guid" if is_2 else "instantiationToken", about.token)
    root.set("description", f"{about.kind}, exported for co-simulation")
    root.set("license", "sources of hyst: MIT")
    root.set("generationTool", f"hyst {hyst.__version__}")
    root.set("variableNamingConvention", "structured")
    _add_interface(root, about, is_2)
    _add_units(root, about)
    categories = ElementTree.SubElement(root, "LogCategories")
    for name, meaning in _CATEGORIES.items():
        ElementTree.SubElement(categories, "Category", name=name, description=meaning)
    if about.dt is not None:
        ElementTree.SubElement(root, "DefaultExperiment", stepSize=repr(about.dt))
    variables = ElementTree.SubElement(root, "ModelVariables")
    variables.extend(_variables_2(about) if is_2 else _variables_3(about))
    _add_structure(root, about, is_2)
    return _written(root)


def build_description(identifier: str) -> bytes:
    """Give ``buildDescription.xml`` of FMI 3.0.

    Parameters
    ----------
    identifier
        The name of the binary.

    Returns
    -------
    bytes
        UTF-8.
    """
    root = Element("fmiBuildDescription", fmiVersion="3.0")
    configuration = ElementTree.SubElement(root, "BuildConfiguration", modelIdentifier=identifier)
    sources = ElementTree.SubElement(configuration, "SourceFileSet", language="C99")
    ElementTree.SubElement(sources, "SourceFile", name=_SOURCE)
    ElementTree.SubElement(sources, "IncludeDirectory", name=".")
    return _written(root)


def _add_interface(root: Element, about: FmuDescription, is_2: bool) -> None:
    state = "FMUstate" if is_2 else "FMUState"
    interface = ElementTree.SubElement(
        root,
        "CoSimulation",
        {
            "modelIdentifier": about.identifier,
            "canHandleVariableCommunicationStepSize": "true" if about.dt is None else "false",
            f"canGetAndSet{state}": "true",
            f"canSerialize{state}": "true",
        },
    )
    if is_2:
        interface.set("canNotUseMemoryManagementFunctions", "true")  # it uses calloc and free
        files = ElementTree.SubElement(interface, "SourceFiles")
        ElementTree.SubElement(files, "File", name=_SOURCE)
    elif about.dt is not None:
        interface.set("fixedInternalStepSize", repr(about.dt))


def _add_units(root: Element, about: FmuDescription) -> None:
    names = {xml_text(signal.unit) for signal in (*about.inputs, about.output)} - {""}
    if names:
        units = ElementTree.SubElement(root, "UnitDefinitions")
        for name in sorted(names):
            unit = ElementTree.SubElement(units, "Unit", name=name)
            base = base_unit(name)
            if base:
                ElementTree.SubElement(unit, "BaseUnit", base)


def _unit(signal: Signal) -> dict[str, str]:
    unit = xml_text(signal.unit)
    return {"unit": unit} if unit else {}


def _variability(parameter: ParameterVariable) -> str:
    return "tunable" if parameter.rule is Rule.TUNABLE else "fixed"


def _references(about: FmuDescription) -> tuple[int, int, int]:
    """Value references of output, fault and first constant; those of the inputs start at 1."""
    output = 1 + len(about.inputs)
    return output, output + 1, output + 2


def _variables_2(about: FmuDescription) -> Sequence[Element]:
    output, fault, first = _references(about)
    found = [
        _scalar(signal.name, k, signal.meaning, "input", "continuous", start="0.0", **_unit(signal))
        for k, signal in enumerate(about.inputs, 1)
    ]
    found.append(
        _scalar(
            about.output.name, output, about.output.meaning, "output", "continuous",
            initial="calculated", **_unit(about.output),
        )
    )  # fmt: skip
    found.append(
        _scalar("fault", fault, _FAULT, "local", "discrete", "Integer", initial="calculated")
    )
    for each in about.parameters:
        kind, start = _variability(each), repr(each.value)
        found.append(
            _scalar(
                each.name, first + each.place, each.meaning, "parameter", kind,
                initial="exact", start=start,
            )
        )  # fmt: skip
    # An estimator has no parameters: its estimates follow the fault.
    for place, name in enumerate(about.estimates):
        found.append(
            _scalar(
                name, first + place, "estimated parameter", "local", "continuous",
                initial="calculated",
            )
        )  # fmt: skip
    return found


_FAULT = (
    "1 since an input, or a value on its way through the model, was not finite, 16 since a limited "
    "drive was held at its limits, 17 since both; else 0"
)


def _scalar(
    name: str, reference: int, meaning: str, causality: str, variability: str,
    kind: str = "Real", *, initial: str | None = None, **attributes: str,
) -> Element:  # fmt: skip
    variable = Element("ScalarVariable", name=name, valueReference=str(reference))
    variable.set("description", xml_text(meaning))
    variable.set("causality", causality)
    variable.set("variability", variability)
    if initial:
        variable.set("initial", initial)
    ElementTree.SubElement(variable, kind, attributes)
    return variable


def _variables_3(about: FmuDescription) -> Sequence[Element]:
    found = [_typed("Float64", "time", 0, "time", "independent", "continuous")]
    for variable in _variables_2(about):
        kind = "UInt32" if variable[0].tag == "Integer" else "Float64"
        found.append(Element(kind, variable.attrib | variable[0].attrib))
    return found


def _typed(
    kind: str, name: str, reference: int, meaning: str, causality: str, variability: str
) -> Element:
    variable = Element(kind, name=name, valueReference=str(reference), description=meaning)
    variable.set("causality", causality)
    variable.set("variability", variability)
    return variable


def _add_structure(root: Element, about: FmuDescription, is_2: bool) -> None:
    """Name the output's dependencies: by place among the variables in 2.0, by reference in 3.0."""
    structure = ElementTree.SubElement(root, "ModelStructure")
    output, _, first = _references(about)
    inputs = [place for place, is_direct in enumerate(about.direct, 1) if is_direct]
    if is_2:
        # Places and references of inputs and output agree; parameters follow the fault.
        settable: Sequence[int] = range(output + 2, output + 2 + len(about.parameters))
        outputs = ElementTree.SubElement(structure, "Outputs")
        unknowns = ElementTree.SubElement(structure, "InitialUnknowns")
        _add_unknown(outputs, "Unknown", {"index": str(output)}, inputs)
        _add_unknown(unknowns, "Unknown", {"index": str(output)}, [*inputs, *settable])
    else:
        settable = [first + each.place for each in about.parameters]
        reference = {"valueReference": str(output)}
        _add_unknown(structure, "Output", reference, inputs)
        _add_unknown(structure, "InitialUnknown", reference, [*inputs, *settable])


def _add_unknown(
    parent: Element, tag: str, which: dict[str, str], dependencies: Sequence[int]
) -> None:
    unknown = ElementTree.SubElement(parent, tag, which)
    unknown.set("dependencies", " ".join(map(str, dependencies)))
    unknown.set("dependenciesKind", " ".join("dependent" for _ in dependencies))


def _written(root: Element) -> bytes:
    ElementTree.indent(root)
    text = ElementTree.tostring(root, encoding="unicode")
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{text}\n'.encode()
