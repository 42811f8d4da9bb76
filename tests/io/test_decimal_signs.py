"""Two decimal signs in a file: read where they can be nothing else, refused where they may be."""

from __future__ import annotations

from pathlib import Path

import pytest
from lab_files import cell, rows, signals, write

from hyst.errors import InputError
from hyst.io import read_record

T, U, Y = signals()


@pytest.mark.parametrize(
    ("cells", "message"),
    [
        (["1.234"] * 3, r"'1\.234' at line 7, which may be 1\.234 or 1234 where the file has the"),
        (["1.5", "2.5"], r"'1\.5' at line 7, while the decimal sign of the file is ','"),
        (["1.234,5", "0.5"], r"'0\.5' at line 8, while the decimal sign"),
        (["1.23,4"], r"'1\.23,4' at line 7, not a finite number"),
    ],
)
def test_two_decimal_signs_are_refused(tmp_path: Path, cells: list[str], message: str) -> None:
    y = [cell(v).replace(".", ",") for v in Y]
    y[5 : 5 + len(cells)] = cells
    u = [cell(v).replace(".", ",") for v in U]
    path = write(tmp_path, ["u;y", *rows((u, y), ";")])
    with pytest.raises(InputError, match=message):
        read_record(path, "u", "y", rate=200.0)


@pytest.mark.parametrize("digits", [2, 4, 6])
@pytest.mark.parametrize("signs", [",.", ".,"])
def test_a_column_with_a_decimal_sign_of_its_own(tmp_path: Path, digits: int, signs: str) -> None:
    t, u = ([f"{v:.4f}".replace(".", signs[0]) for v in x] for x in (T, U))
    printed = [f"{v:.{digits}f}" for v in 30.0 * Y]
    y = [text.replace(".", signs[1]) for text in printed]
    path = write(tmp_path, ["t;u;y", *rows((t, u, y), ";")])
    for repair in (False, True):
        record = read_record(path, "u", "y", time="t", repair=repair)
        assert record.y.tolist() == [float(text) for text in printed]
        assert record.notes == (
            f"'y': read with the decimal sign '{signs[1]}', where others in the file have "
            f"'{signs[0]}'",
        )


@pytest.mark.parametrize("signs", [",.", ".,"])
def test_a_column_that_may_hold_thousands_or_decimals(tmp_path: Path, signs: str) -> None:
    t, u = ([f"{v:.4f}".replace(".", signs[0]) for v in x] for x in (T, U))
    y = [f"{1.0 + v:.3f}".replace(".", signs[1]) for v in Y]
    path = write(tmp_path, ["t;u;y", *rows((t, u, y), ";")])
    for repair in (False, True):
        with pytest.raises(InputError, match=r"which may be|while the decimal sign"):
            read_record(path, "u", "y", time="t", repair=repair)
