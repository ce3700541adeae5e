import pytest

from tree_sway_ros.errors import FormatError
from tree_sway_ros.files import text_file
from tree_sway_ros.files.text_file import finite, read_bytes, read_head, read_lines


@pytest.mark.parametrize(
    ("text", "value"),
    [("1", 1.0), (" -2.5e-3 ", -0.0025), (".5", 0.5), ("5.", 5.0), ("+1E2", 100.0)],
)
def test_plain_numbers(text, value):
    assert finite(text) == value


@pytest.mark.parametrize(
    "text", ["", " ", "nan", "INF", "1e999", "1_0", "0x1", "1,5", "1 m", "--1", "e5", ".", "\u0663"]
)
def test_all_else_is_none(text):
    assert finite(text) is None


def test_line_ends(tmp_path):
    (tmp_path / "a").write_bytes(b"\xef\xbb\xbfone\r\ntwo\rthree\nfour")
    assert read_lines(tmp_path / "a") == ["one", "two", "three", "four"]
    assert read_head(tmp_path / "a").startswith(b"one")


def test_a_huge_file_is_refused_before_it_is_read(tmp_path, monkeypatch):
    monkeypatch.setattr(text_file, "MAX_BYTES", 10)
    (tmp_path / "a").write_bytes(b"x" * 11)
    with pytest.raises(FormatError, match="larger than 0 MiB"):
        read_bytes(tmp_path / "a")
    assert len(read_bytes(tmp_path / "a", at_most=4)) == 4
