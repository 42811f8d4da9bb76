"""Every text file of the table in docs/records.md is read, with the options that stand there."""

from __future__ import annotations

import gzip
from pathlib import Path

import numpy as np
import pytest
from lab_files import DT, write
from text_tools import TEXT_TOOLS, U, Y

from hyst.io import read_record

DOCS = Path(__file__).resolve().parents[2] / "docs" / "records.md"


@pytest.mark.parametrize("packed", [False, True])
@pytest.mark.parametrize("tool", TEXT_TOOLS)
def test_the_file_of_a_tool_is_read(tmp_path: Path, tool: str, packed: bool) -> None:
    file = TEXT_TOOLS[tool]()
    content = file.content.encode() if isinstance(file.content, str) else file.content
    data = gzip.compress(content) if packed else content
    path = write(tmp_path, data, file.name + ".gz" * packed)
    record = read_record(path, **file.how)
    assert record.dt == pytest.approx(DT, rel=1e-9)
    assert (record.input_unit, record.output_unit) == file.units
    assert np.allclose(record.u, U, rtol=0.0, atol=1e-6)
    gain = 1e4 if tool == "spreadsheet, German" else 1.0
    # What a code replaced is interpolated: compared where nothing was left out.
    good = np.abs(record.y - gain * Y) <= 1e-6 * gain
    assert good.sum() >= U.size - 2 * ("repair" in file.how)
    assert len(record.notes) == file.notes, record.notes


def test_the_table_in_the_documentation_names_every_tool() -> None:
    listed = [line.split("|")[1].strip() for line in DOCS.read_text().splitlines() if "|" in line]
    assert not set(TEXT_TOOLS) - set(listed)
