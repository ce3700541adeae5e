import time
from math import pi
from pathlib import Path

import numpy as np
import pytest

from tree_sway_ros.errors import FormatError, ParameterError
from tree_sway_ros.files.wind.toa5 import read_toa5_wind

DATA = Path(__file__).parents[1] / "data"
SONIC = DATA / "sonic.toa5.dat"
RECORDED = Path(__file__).parents[4] / "shared/data/wind/sonic_20hz_1245.toa5.dat"


def test_samples_across_midnight_with_a_gap():
    record = read_toa5_wind(SONIC)
    np.testing.assert_allclose(record.time, [0, 0.05, 0.1, 0.2, 0.4, 0.6], atol=1e-12)
    np.testing.assert_allclose(record.velocity[0], [2.0, 0.5, -0.1])
    np.testing.assert_allclose(record.velocity[-1], [2.8, -0.3, -0.26])
    assert record.epoch == pytest.approx(1709337599.9, abs=1e-5)


def test_bad_rows_are_counted_and_the_first_is_named():
    record = read_toa5_wind(SONIC)
    assert record.refused == 6
    assert record.first_refused == "line 8: Ux is 'NAN'"


def test_axes_of_the_sonic():
    turned = read_toa5_wind(SONIC, yaw=pi / 2).velocity
    np.testing.assert_allclose(turned[0], [-0.5, 2.0, -0.1], atol=1e-15)
    against = read_toa5_wind(SONIC, direction_convention="from").velocity
    np.testing.assert_allclose(against[0], [-2.0, -0.5, 0.1])
    with pytest.raises(ParameterError, match="blows to, as ROS"):
        read_toa5_wind(SONIC, direction_convention="north")


def test_columns_by_name():
    record = read_toa5_wind(SONIC, columns=("Uy", "Ux", "Uz"))
    np.testing.assert_allclose(record.velocity[0], [0.5, 2.0, -0.1])
    with pytest.raises(FormatError, match="no column 'Vx' among TIMESTAMP, RECORD, Ux"):
        read_toa5_wind(SONIC, columns=("Vx", "Uy", "Uz"))


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("TOA5", "TOB1", ":1: not TOA5"),
        ("Ux", "wind", ":2: no columns Ux, Uy, Uz"),
        ("cm/s", "furlong", ":3: unknown unit 'furlong'"),
        ("2024-", "2024/", "no good row of wind, 12 refused; first line 5"),
    ],
)
def test_not_what_it_promises(tmp_path, old, new, message):
    broken = tmp_path / "broken.dat"
    broken.write_text(SONIC.read_text().replace(old, new))
    with pytest.raises(FormatError, match=message):
        read_toa5_wind(broken)


@pytest.mark.skipif(not RECORDED.exists(), reason="recorded data is not at ../shared/data")
def test_recorded_quarter_of_an_hour():
    begin = time.perf_counter()
    record = read_toa5_wind(RECORDED)
    assert time.perf_counter() - begin < 1.0
    assert (len(record.time), record.refused) == (18000, 0)
    assert record.duration == pytest.approx(899.95, abs=1e-6)
    assert record.period == pytest.approx(0.05, abs=1e-9)
    assert np.linalg.norm(record.velocity.mean(axis=0)[:2]) == pytest.approx(1.48, abs=0.01)
    assert np.linalg.norm(record.velocity[:, :2], axis=1).max() == pytest.approx(5.9, abs=0.06)


def test_good_and_damaged_rows_are_read_alike(tmp_path):
    """One row that numpy does not take must not change how the others are read."""
    whole = read_toa5_wind(SONIC)
    for damage in ('"2024-03-02 00:00:09",1\n', '"2024-03-02 00:00:09,1,2,3\n', "\n\n", "\x00,\n"):
        (tmp_path / "a.dat").write_text(SONIC.read_text() + damage)
        record = read_toa5_wind(tmp_path / "a.dat")
        np.testing.assert_array_equal(record.time, whole.time)
        np.testing.assert_array_equal(record.velocity, whole.velocity)
        assert record.refused == whole.refused + (damage != "\n\n")
