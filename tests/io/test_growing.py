"""Rows of a text file that is still being written."""

from __future__ import annotations

import numpy as np
import pytest

import hyst
from hyst.io.growing import GrowingRows, Rows, joined

ROLES = {"input": "u", "output": "y", "time": "t"}
ROWS = 30
PLAIN = "t [ms],u [V],y\n" + "".join(f"{k},{k * 0.5},{k * 0.25}\n" for k in range(ROWS))
DIALECTS = {
    "commas": PLAIN,
    "crlf": PLAIN.replace("\n", "\r\n"),
    "returns alone": PLAIN.replace("\n", "\r"),
    "semicolons": PLAIN.replace(",", ";").replace(".", ","),
    "tabs": PLAIN.replace(",", "\t"),
    "row of units": PLAIN.replace("t [ms],u [V],y\n", "t,u,y\nms,V,um\n"),
    "comments": "# by hand\n" + PLAIN.replace("10,5.0", "# a remark\n\n10,5.0"),
    "separator at the end": PLAIN.replace("\n", ",\n"),
    "header in a comment": "# " + PLAIN,
    "columns in another order": "y,t [ms],u [V]\n"
    + "".join(f"{k * 0.25},{k},{k * 0.5}\n" for k in range(ROWS)),
}
COUNT = np.arange(ROWS)


def read(text: bytes, cut: int, roles: dict[str, object] = ROLES) -> tuple[GrowingRows, Rows]:
    rows = GrowingRows("run.csv", roles)
    parts = [rows.feed(text[k : k + cut]) for k in range(0, len(text), cut)]
    return rows, joined([*parts, rows.finish()])


@pytest.mark.parametrize("cut", [1, 7, 100, 10**6])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le"])
@pytest.mark.parametrize("dialect", DIALECTS)
def test_every_dialect_is_read_wherever_it_is_cut(dialect: str, encoding: str, cut: int) -> None:
    reader, rows = read(DIALECTS[dialect].encode(encoding), cut)
    np.testing.assert_array_equal(rows.u, COUNT * 0.5)
    np.testing.assert_array_equal(rows.y, COUNT * 0.25)
    # Milliseconds as written times 0.001, one rounding.
    np.testing.assert_array_equal(rows.time, COUNT * 1e-3)
    assert reader.unreadable == 0
    assert not rows.unreadable.any()


def test_columns_by_index_without_a_header() -> None:
    _, rows = read(b"1 2\n3 4\n" * 6, 3, {"input": 0, "output": "1", "time": None})
    np.testing.assert_array_equal(rows.u, [1.0, 3.0] * 6)
    np.testing.assert_array_equal(rows.y, [2.0, 4.0] * 6)
    assert np.isnan(rows.time).all()


@pytest.mark.parametrize("cut", [1, 5, 10**6])
def test_stamps_go_on_past_midnight(cut: int) -> None:
    text = "time,u,y\n" + "".join(f"2026-11-29 23:59:{50 + k}.5,{k},1\n" for k in range(10))
    text += "2026-11-30 00:00:00.5,10,1\n"
    _, rows = read(text.encode(), cut, {"input": "u", "output": "y", "time": "time"})
    np.testing.assert_array_equal(rows.time, np.arange(11.0))


def test_a_date_and_the_clock_beside_it_are_one_stamp() -> None:
    text = "date,clock,u,y\n" + "".join(f"2026-11-29,23:59:{50 + k},{k},1\n" for k in range(10))
    text += "2026-11-30,00:00:00,10,1\n"
    _, rows = read(text.encode(), 9, {"input": "u", "output": "y", "time": "date"})
    np.testing.assert_array_equal(rows.time, np.arange(11.0))


def test_a_torn_line_waits_for_the_rest_of_it() -> None:
    rows = GrowingRows("run.csv", ROLES)
    whole = PLAIN.encode()
    first = rows.feed(whole + b"100,5")
    assert first.size == ROWS
    assert rows.feed(b"0.5,7").size == 0
    last = rows.feed(b".25\n")
    assert (last.u.tolist(), last.y.tolist()) == ([50.5], [7.25])


@pytest.mark.parametrize("cut", [1, 11, 10**6])
@pytest.mark.parametrize(
    "line", ["12,3", "1,2,3,4", "5,1.2.3,4", "over,load,now", "7,0x1f,2", "\x01\x02,3,4", '"1,2,3']
)
def test_a_line_that_is_no_row_is_counted_and_stands_for_a_sample(line: str, cut: int) -> None:
    text = PLAIN + line + "\n" + "40,20,10\n" + line + "\n"
    reader, rows = read(text.encode(), cut)
    assert rows.size == ROWS + 3
    assert reader.unreadable == 2
    number, quoted = reader.first_unreadable or (0, "")
    assert (number, quoted) == (ROWS + 2, line.strip())
    assert rows.unreadable.tolist() == [False] * ROWS + [True, False, True]
    assert np.isnan(rows.u[rows.unreadable]).all()
    assert rows.u[-2] == 20.0


@pytest.mark.parametrize("sign", ["nan", "NaN", "", "n/a", "inf", "-inf", "1e999"])
def test_a_value_that_is_missing_is_no_unreadable_line(sign: str) -> None:
    reader, rows = read((PLAIN + f"40,{sign},10\n41,20,{sign}\n").encode(), 8)
    assert reader.unreadable == 0
    assert np.isnan(rows.u[-2])
    assert rows.y[-2] == 10.0
    assert np.isnan(rows.y[-1])


def test_the_header_again_is_no_row_and_one_in_another_order_moves_the_columns() -> None:
    text = PLAIN + "t [ms],u [V],y\n40,20,10\n" + DIALECTS["columns in another order"]
    for cut in (1, 13, 10**6):
        reader, rows = read(text.encode(), cut)
        assert reader.unreadable == 0
        assert rows.size == 2 * ROWS + 1
        np.testing.assert_array_equal(rows.u, [*COUNT * 0.5, 20.0, *COUNT * 0.5])
        np.testing.assert_array_equal(rows.y, [*COUNT * 0.25, 10.0, *COUNT * 0.25])


def test_another_file_has_its_own_head_or_none() -> None:
    rows = GrowingRows("run.csv", ROLES)
    parts = [rows.feed(PLAIN.encode()), rows.feed(b"40,20,1"), rows.restart()]
    parts.append(rows.feed(DIALECTS["semicolons"].encode()))
    parts.append(rows.restart())
    bare = "\n".join(DIALECTS["semicolons"].split("\n")[1:])
    parts += [rows.feed(bare.encode()), rows.finish()]
    # The torn line of the first file reads as a row: nothing can tell that more should have come.
    np.testing.assert_array_equal(joined(parts).u, [*COUNT * 0.5, 20.0, *COUNT * 0.5, *COUNT * 0.5])


def test_a_line_without_end_is_given_up_and_kept_nowhere() -> None:
    rows = GrowingRows("run.csv", ROLES)
    rows.feed(PLAIN.encode())
    found = joined([rows.feed(b"5" * 50_000) for _ in range(20)])
    assert found.unreadable.tolist() == [True]
    assert rows.feed(b"5\n40,20,10\n").u.tolist() == [20.0]


def test_what_cannot_be_watched_is_refused() -> None:
    with pytest.raises(hyst.InputError, match="no column 'u'; there are"):
        read(PLAIN.replace("u [V]", "drive").encode(), 50)
    with pytest.raises(hyst.InputError, match="no rows of numbers"):
        read(b"words and words\n" * 100_000, 10**5)
    with pytest.raises(hyst.InputError, match="not a text file"):
        read(b"\x7fELF\x01\x02\x03\n" * 20, 1000)
    with pytest.raises(hyst.InputError, match="LabVIEW"):
        read(("LabVIEW Measurement\t\n" + PLAIN).encode(), 50)
    with pytest.raises(hyst.InputError, match="unit"):
        read(PLAIN.replace("[ms]", "[furlong]").encode(), 1000)
    with pytest.raises(hyst.InputError, match="time_unit"):
        GrowingRows("run.csv", ROLES, "furlong")


def test_few_rows_are_read_at_the_end_only() -> None:
    rows = GrowingRows("run.csv", ROLES)
    assert rows.feed(b"t,u,y\n0,1,2\n1,2,3").size == 0
    assert rows.finish().u.tolist() == [1.0, 2.0]


@pytest.mark.parametrize("seed", range(6))
def test_random_bytes_depend_on_no_cut(seed: int) -> None:
    """Whatever comes after the head: the same rows, however it is cut, and no crash."""
    rng = np.random.default_rng(seed)
    pool = np.frombuffer(b'0123456789.,;-+eE \t\r\n\n\n#"nauy\xb5\xff', dtype=np.uint8)
    junk = rng.choice(pool, 3000).tobytes()
    text = PLAIN.encode() + junk + b"\n50,25,12\n"
    found = []
    for cut in (1, 17, 10**6):
        reader, rows = read(text, cut)
        found.append((rows.u.tobytes(), rows.y.tobytes(), reader.unreadable, reader.lines))
    assert found[0] == found[1] == found[2]
    assert rows.u[-1] == 25.0
