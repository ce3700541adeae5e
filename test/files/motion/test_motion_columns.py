# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Laws of columns of motion: axes by words, scales above the header, units that values tell."""

from __future__ import annotations

from pathlib import Path
import zipfile

import numpy as np
import pytest

from tree_sway.errors import FormatError
from tree_sway.files.column_names import motion_of
from tree_sway.files.motion.motion_file import read_motion
from tree_sway.files.motion.motion_record import MotionRecord
from tree_sway.files.wind.sway_table import read_csv_sway, SwayRecord

GRAVITY = 9.80665
DEGREE = np.pi / 180.0
COUNT = 40
STEP = 0.02


def rows(form: str, first: int = 0) -> str:
    """Rows 0.02 s apart; ``s``, ``ms`` and ``us`` are their times, ``k`` their numbers."""
    return ''.join(
        form.format(k=k, s=f'{STEP * k:.2f}', ms=20 * k, us=20_000 * k + first) + '\n'
        for k in range(COUNT)
    )


def written(tmp_path: Path, text: str, name: str = 'a.csv') -> Path:
    path = tmp_path / name
    path.write_text(text, encoding='utf-8')
    return path


def moved(tmp_path: Path, text: str) -> MotionRecord:
    """Read a motion, whose samples are 0.02 s apart."""
    record = read_motion(written(tmp_path, text))
    np.testing.assert_allclose(np.diff(record.time), STEP, atol=1e-9)
    return record


def swayed(tmp_path: Path, text: str) -> SwayRecord:
    """Read a sway, whose samples are 0.02 s apart."""
    record = read_csv_sway(written(tmp_path, text))
    np.testing.assert_allclose(np.diff(record.time), STEP, atol=1e-9)
    return record


@pytest.mark.parametrize(
    'names',
    [
        'NS_tilt_degrees EW_tilt_degrees', 'tilt_NS_deg tilt_EW_deg',
        'TiltNorth[deg] TiltEast[deg]', 'Inclination-north-south(°) Inclination-east-west(°)',
        'East-West-Inclination[deg] North-South-Inclination[deg]', 'Neigung_NS[°] Neigung_OW[°]',
        'X-Tilt[deg] Y-Tilt[deg]', 'inclX_deg inclY_deg', 'INC01[deg] INC02[deg]',
        'roll_deg pitch_deg',
    ],
)  # fmt: skip
def test_a_tilt_is_known_by_its_axis_in_front_or_behind(tmp_path: Path, names: str) -> None:
    record = swayed(tmp_path, f'Time,{names.replace(" ", ",")}\n' + rows('{s},0.5,-{k}'))
    assert record.quantity == 'tilt'
    np.testing.assert_allclose(record.motion[3], [0.5 * DEGREE, -3.0 * DEGREE])
    with pytest.raises(FormatError, match='none of a sensor with its three axes') as caught:
        read_motion(tmp_path / 'a.csv')
    assert '--record' in caught.value.cure


@pytest.mark.parametrize(
    ('name', 'motion'),
    [
        ('rollspeed', ('rate', 'x')), ('yaw rate (deg/s)', ('rate', 'z')),
        ('Gyro_Pitch (deg/s)', ('rate', 'y')), ('acc_ns [gal]', ('acceleration', 'y')),
        ('UD acceleration (gal)', ('acceleration', 'z')), ('ACC01_z [g]', ('acceleration', 'z')),
        ('Acceleration - x (m/s²) Run #1', ('acceleration', 'x')),
        ('q[0]', ('orientation', 'w')), ('Quat_q3', ('orientation', 'z')),
        ('quatReal', ('orientation', 'w')), ('Quat_I', ('orientation', 'x')),
        ('FBG_2 [µε]', ('strain', '2')), ('displ_EW [mm]', ('displacement', 'x')),
    ],
)  # fmt: skip
def test_an_axis_is_told_by_a_word_a_number_or_a_letter(
    name: str, motion: tuple[str, str]
) -> None:
    found = motion_of(name)
    assert found is not None
    assert (found[0], found[2]) == motion


@pytest.mark.parametrize(
    'name', 'speed_x dew Rn year direction Absolute-Inclination delta_q_reset[0] AEST'.split()
)
def test_what_only_looks_like_an_axis_is_no_motion(name: str) -> None:
    assert motion_of(name) is None


SCALES = {
    'sizes of a count behind keys': 'tscale,.001\ngscale,0.001\nascale,0.0005\nt,{}\n',
    'counts in a unit behind keys': '"acc_1G",2000\n"gyroScale",1e-9\nloopIteration,time,{}\n',
    'sizes of a count in words': 'Accel: 0.0005 g/LSB, gyro: 0.05 dps/count\ntime [ms],{}\n',
    'counts in a unit in words': '# 2000 LSB/g, 20 LSB/(deg/s)\nmillis,{}\n',
    'sizes of a count with decimal commas': ('ACC;0,5 mg/LSB\nGyro;50,0 mdps/LSB\nZeit [ms];{}\n'),
    'counts in a unit behind words': 'LSB/g: 2000\nLSB/dps: 20\nmillis,{}\n',
}
RATES = [1e-3, 1e-3, *[0.05 * DEGREE] * 4]


@pytest.mark.parametrize(('name', 'rate'), zip(SCALES, RATES, strict=True))
def test_a_scale_above_the_header_is_that_of_counts(
    tmp_path: Path, name: str, rate: float
) -> None:
    sign = ';' if 'decimal commas' in name else ','
    head = SCALES[name].format(sign.join('gx gy gz ax ay az'.split()))
    clock = '{k},{us}' if 'loop' in head else '{ms}'
    text = head + rows((clock + ',0,{k},0,100,0,2000').replace(',', sign))
    record = moved(tmp_path, text)
    assert record.acceleration is not None
    assert record.rate is not None
    np.testing.assert_allclose(record.acceleration, [[GRAVITY / 20.0, 0.0, GRAVITY]] * COUNT)
    np.testing.assert_allclose(record.rate[:, 1], rate * np.arange(COUNT))
    assert any(', as of ' in note for note in record.notes)
    np.testing.assert_allclose(swayed(tmp_path, text).motion, record.acceleration)


def test_a_sensitivity_is_no_scale_of_fractions(tmp_path: Path) -> None:
    text = '# 2000 LSB/g\nmillis,ax,ay,az\n' + rows('{ms},0.05,0.0,1.0')
    record = moved(tmp_path, text)
    assert record.acceleration is not None
    np.testing.assert_allclose(record.acceleration[0], [0.05 * GRAVITY, 0.0, GRAVITY])


@pytest.mark.parametrize('number', ['0', '0.000', '1.2.3', '-', '9' * 400, '1e999', '1e-999'])
def test_a_scale_that_is_none_is_left(tmp_path: Path, number: str) -> None:
    text = f'acc_1G,{number}\nt,ax,ay,az\n' + rows('{s},0.0,0.0,9.81')
    assert read_motion(written(tmp_path, text)).acceleration is not None


def test_of_numbered_parts_of_a_quaternion_the_first_is_the_scalar(tmp_path: Path) -> None:
    head = 'timestamp,rollspeed,pitchspeed,yawspeed,q[0],q[1],q[2],q[3],delta_q_reset[0]\n'
    text = head + rows('{us},0.1,0.2,0.3,0.8,0.6,0.0,{k},1', first=112_560_013)
    record = moved(tmp_path, text)
    assert record.orientation is not None
    assert record.rate is not None
    np.testing.assert_allclose(record.orientation[3], [0.6, 0.0, 3.0, 0.8])
    np.testing.assert_allclose(record.rate[0], [0.1, 0.2, 0.3])
    assert 'q[1], q[2], q[3], q[0], the orientation as x, y, z, w' in record.notes[0]
    assert swayed(tmp_path, text).quantity == 'rate'


def test_times_of_a_sway_without_a_unit_are_in_that_of_usual_steps(tmp_path: Path) -> None:
    record = swayed(tmp_path, 'time,tilt_x [deg]\n' + rows('{us},{k}'))
    assert any('taken in us' in note for note in record.notes)
    slow = ''.join(f'{1000 * k},{k}\n' for k in range(9))
    with pytest.raises(FormatError, match='a sample every 1000 s, too few'):
        read_csv_sway(written(tmp_path, f'time,tilt_x [deg]\n{slow}'))


def test_tilts_without_a_unit_are_in_that_of_angles_beside_them(tmp_path: Path) -> None:
    head = 'Time;East-West-Inclination;North-South-Inclination;Inclination direction\n'
    text = head + rows('2026-03-01 10:00:{s:0>5};0,25;-0,5;98,85').replace(':0.', ':00.')
    record = swayed(tmp_path, text)
    np.testing.assert_allclose(record.motion[0], [0.25 * DEGREE, -0.5 * DEGREE])
    assert any('taken in deg, as it is up to 98.85' in note for note in record.notes)
    record = swayed(tmp_path, text.replace('98,85', '1,5'))
    np.testing.assert_allclose(record.motion[0], [0.25, -0.5])
    assert any('taken in rad; call it' in note for note in record.notes)


def test_a_few_rows_without_a_number_are_gaps_of_a_sway(tmp_path: Path) -> None:
    text = 'time,tilt_x [deg]\n' + rows('{s},{k}').replace('0.10,5\n', '0.10,NaN\n')
    record = read_csv_sway(written(tmp_path, text))
    assert len(record.time) == COUNT - 1
    assert '1 rows without a number are left out' in record.notes
    np.testing.assert_allclose(np.diff(record.time).max(), 2.0 * STEP)
    for k in range(6, 12):
        text = text.replace(f'{STEP * k:.2f},{k}\n', f'{STEP * k:.2f},\n')
    with pytest.raises(FormatError, match=r'a\.csv:7: tilt_x \[deg\] is'):
        read_csv_sway(written(tmp_path, text))


def test_of_what_one_sensor_measures_the_acceleration_is_the_sway(tmp_path: Path) -> None:
    head = 'time,roll,pitch,qw,qx,qy,qz,gx,gy,gz,ax [g],ay [g],az [g],X [s]\n'
    record = swayed(tmp_path, head + rows('{s},0,0,1,0,0,0,0,0,0,0,0.5,1,{s}'))
    assert record.quantity == 'acceleration'
    np.testing.assert_allclose(record.motion[0], [0.0, 0.5 * GRAVITY, GRAVITY])


def test_of_several_quantities_the_columns_are_named(tmp_path: Path) -> None:
    head = 'Time (-),ACC01_z [g],ACC02_z [g],DMS [um/m],FRC [kN],INC01 [deg]\n'
    path = written(tmp_path, head + rows('{s},0.1,0.2,3.0,4.0,0.5'))
    with pytest.raises(FormatError, match='acceleration and strain and tilt in one') as caught:
        read_csv_sway(path)
    assert 'ACC01_z [g], ACC02_z [g], DMS [um/m], INC01 [deg]' in caught.value.cure
    path = written(tmp_path, head.replace('DMS [um/m]', 'T [°C]') + rows('{s},0.1,0.2,3,4,0.5'))
    record = read_csv_sway(path)
    assert record.columns == ('ACC01_z [g]',)  # not those of another sensor with it
    np.testing.assert_allclose(record.motion, 0.1 * GRAVITY)


@pytest.mark.parametrize(
    ('name', 'quantity'), [('Gyroscope', 'rate'), ('TotalAcceleration', 'acceleration')]
)
def test_axes_of_a_phone_are_those_of_its_file(tmp_path: Path, name: str, quantity: str) -> None:
    text = 'time,seconds_elapsed,z,y,x\n' + rows('{us}000,{s},0.1,{k},0.3', first=10**15)
    record = read_csv_sway(written(tmp_path, text, f'{name}.csv'))
    assert record.quantity == quantity
    with pytest.raises(FormatError, match='no motion among'):
        read_csv_sway(written(tmp_path, text, 'Magnetometer.csv'))


def test_a_phones_zip_is_a_sway(tmp_path: Path) -> None:
    text = 'time,seconds_elapsed,z,y,x\n' + rows('{us}000,{s},9.81,{s},0.3', first=10**15)
    path = tmp_path / 'a.zip'
    with zipfile.ZipFile(path, 'w') as archive:
        archive.writestr('Gyroscope.csv', text.replace('9.81', '0.1'))
        archive.writestr('TotalAcceleration.csv', text)
        archive.writestr('Annotation.csv', 'time,seconds_elapsed,text\n')
    record = read_csv_sway(path)
    assert record.quantity == 'acceleration'
    np.testing.assert_allclose(record.motion[3], [0.3, 0.06, 9.81])


@pytest.mark.parametrize(
    ('text', 'what', 'cure'),
    [
        (
            'info;time;excel time;info text;info comment;\n1-13 (sensors);time;excel time;x;y;z\n'
            '01 accelerometer\n1;10:00:00.000;46082.4;0.1;0.2;9.8\n',
            'several sensors, line by line', '1 for the accelerometer',
        ),
        (
            'Origin Time       2016/04/16 01:25:00\nDir.              N-S\n'
            'Scale Factor      7845(gal)/8223790\n    -5760    -5689    -5738    -5697\n',
            'an earthquake in one direction', r'acc_ns \[gal\]',
        ),
    ],
)  # fmt: skip
@pytest.mark.parametrize('read', [read_motion, read_csv_sway])
def test_a_log_of_other_rows_is_refused_by_cause(
    tmp_path: Path, text: str, what: str, cure: str, read: object
) -> None:
    assert callable(read)
    with pytest.raises(FormatError, match=what) as caught:
        read(written(tmp_path, text))
    assert cure.replace('\\', '') in caught.value.cure


def test_the_unit_of_a_rate_is_told_by_its_range_above(tmp_path):
    path = tmp_path / 'box.csv'
    rows = '\n'.join(f'{0.02 * n:.2f},0,0,9.81,90,0,0' for n in range(40))
    head = '# gyro_range = 250.0 dps, acc_range = 4 g'
    path.write_text(f'{head}\ntime [s],ax,ay,az,gx,gy,gz\n{rows}\n', encoding='utf-8')
    record = read_motion(path)
    assert record.rate is not None
    assert record.rate[0, 0] == pytest.approx(np.pi / 2.0)
    assert 'gx is in dps, as of the lines above' in record.notes
