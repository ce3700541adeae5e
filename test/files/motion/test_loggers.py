# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Forms in which loggers and phones give motion: read in their units, or refused by cause."""

from __future__ import annotations

from pathlib import Path
import zipfile

import numpy as np
import pytest

from tree_sway.errors import FormatError
from tree_sway.files.motion.motion_file import read_motion
from tree_sway.files.wind import read_csv_sway

GRAVITY = 9.80665
DEGREE = np.pi / 180.0
EPOCH = 1_772_359_200
COUNT = 40
STEP = 0.02


def table(head: str, row: str, *, below: str = '') -> str:
    """
    Return a header, maybe a line below it, and rows 0.02 s apart.

    In a row ``{s}``, ``{ms}``, ``{us}``, ``{ns}`` are its time, ``{unix}`` and ``{date}`` those of
    a clock, ``{a}`` an acceleration along x in [m/s^2], ``{g}`` in g, and ``{k}`` its number.
    """
    rows = []
    for k in range(COUNT):
        after = round(k * STEP, 3)
        rows.append(row.format(
            k=k, s=after, ms=20 * k, us=20_000 * k, ns=20_000_000 * k,
            unix=f'{EPOCH + after:.3f}', unix_ms=1000 * EPOCH + 20 * k,
            unix_ns=(1000 * EPOCH + 20 * k) * 1_000_000,
            date=f'2026-03-01 10:00:{after:06.3f}', day=f'01-Mar-2026 10:00:{after:06.3f}',
            a=0.1 * (k % 5), g=0.1 * (k % 5) / GRAVITY,
        ))  # fmt: skip
    return '\n'.join([head, *([below] if below else []), *rows]) + '\n'


ACCELERATION = 'acceleration'
RATE = 'rate'
BOTH = (ACCELERATION, RATE)
READ: dict[str, tuple[str, tuple[str, ...], str]] = {
    'phyphox': (
        'Raw Data.csv', (ACCELERATION,),
        table('"Time (s)","Linear Acceleration x (m/s^2)","Linear Acceleration y (m/s^2)",'
            '"Linear Acceleration z (m/s^2)","Absolute acceleration (m/s^2)"',
            '{s},{a},0.0,9.80665,9.9'),
    ),
    'phyphox with tabs and decimal commas': (
        'Raw Data.csv', (ACCELERATION,),
        table('"Time (s)"\t"Acceleration x (m/s^2)"\t"Acceleration y (m/s^2)"\t'
            '"Acceleration z (m/s^2)"', '{s}\t{a}\t0.0\t9.80665').replace('.', ','),
    ),
    'sensor logger': (
        'Accelerometer.csv', (ACCELERATION,),
        table('time,seconds_elapsed,z,y,x', '{unix_ns},{s},9.80665,0.0,{a}'),
    ),
    'sensor logger, gyroscope': (
        'Gyroscope.csv', (RATE,),
        table('time,seconds_elapsed,z,y,x', '{unix_ns},{s},0.0,0.5,0.0'),
    ),
    'sensor log of ios': (
        'motion.csv', BOTH,
        table('loggingTime(txt),loggingSample(N),accelerometerTimestamp_sinceReboot(s),'
            'accelerometerAccelerationX(G),accelerometerAccelerationY(G),'
            'accelerometerAccelerationZ(G),motionUserAccelerationX(G),'
            'motionUserAccelerationY(G),motionUserAccelerationZ(G),gyroRotationX(rad/s),'
            'gyroRotationY(rad/s),gyroRotationZ(rad/s)',
            '{date} +0100,{k},{s},-{g},0.0,-1.0,0.0,0.0,0.0,0.0,0.5,0.0'),
    ),
    'physics toolbox': (
        'motion.csv', (ACCELERATION,),
        table('time,gFx,gFy,gFz,TgF', '{s},{g},0.0,1.0,1.0'),
    ),
    'physics toolbox, linear': (
        'motion.csv', (ACCELERATION,),
        table('time,ax (m/s^2),ay (m/s^2),az (m/s^2),aT (m/s^2)', '{s},{a},0.0,9.80665,9.8'),
    ),
    'matlab mobile': (
        'motion.csv', (ACCELERATION,), table('Timestamp,X,Y,Z', '{day},{a},0.0,9.80665'),
    ),
    'metawear': (
        'motion.csv', (ACCELERATION,),
        table('epoch (ms),time (01:00),elapsed (s),x-axis (g),y-axis (g),z-axis (g)',
            '{unix_ms},2026-03-01T10.00.00,{s},{g},0.0,1.0'),
    ),
    'movella dot': (
        'motion.csv', (ACCELERATION,),
        'sep=,\nDeviceTag:,Dot1\nFirmwareVersion:,2.0.0\n' + table(
            'PacketCounter,SampleTimeFine,Quat_W,Quat_X,Quat_Y,Quat_Z,Acc_X,Acc_Y,Acc_Z,',
            '{k},{us},1.0,0.0,0.0,0.0,{a},0.0,9.80665,'),
    ),
    'witmotion': (
        'motion.txt', BOTH,
        'StartTime: 2026-03-01 10:00:00.000\n' + table('Address\tTime(s)\tax(g)\tay(g)\taz(g)\t'
            'wx(deg/s)\twy(deg/s)\twz(deg/s)\tAngleX(deg)\tT(°)',
            '0x50\t{s}\t{g}\t0.0\t1.0\t0.0\t28.64788975654116\t0.0\t0.0\t20.1'),
    ),
    'toa5 of an accelerometer': (
        'motion.dat', (ACCELERATION,),
        '"TOA5","CR6","CR6","1","CR6.Std","CPU:sway.CR6","1","Sway"\n'
        + table('"TIMESTAMP","RECORD","Accel_X","Accel_Y","Accel_Z"',
            '"{date}",{k},{g},0.0,1.0', below='"TS","RN","g","g","g"\n"","","Smp","Smp","Smp"'),
    ),
    'androsensor': (
        'motion.csv', BOTH,
        table('ACCELEROMETER X (m/s²);ACCELEROMETER Y (m/s²);ACCELEROMETER Z (m/s²);'
            'GYROSCOPE X (rad/s);GYROSCOPE Y (rad/s);GYROSCOPE Z (rad/s);'
            'Time since start in ms ;YYYY-MO-DD HH-MI-SS_SSS',
            '{a};0.0;9.80665;0.0;0.5;0.0;{ms};2026-03-01 10:00:00:000'),
    ),
    'plotjuggler': (
        'motion.csv', (ACCELERATION,),
        table('__time,/imu/data/linear_acceleration/x,/imu/data/linear_acceleration/y,'
            '/imu/data/linear_acceleration/z', '{unix},{a},0.0,9.80665'),
    ),
    'px4': (
        'motion.csv', BOTH,
        table('timestamp [us],gyro_rad[0],gyro_rad[1],gyro_rad[2],accelerometer_m_s2[0],'
            'accelerometer_m_s2[1],accelerometer_m_s2[2]', '{us},0.0,0.5,0.0,{a},0.0,9.80665'),
    ),
    'arduino with a header': (
        'motion.csv', (ACCELERATION,), table('millis,ax,ay,az', '{ms},{g},0.0,1.0'),
    ),
    'shimmer': (
        'motion.csv', (ACCELERATION,),
        'sep=\t\n' + table('Shimmer_8665_Timestamp_Unix_CAL\tShimmer_8665_Accel_LN_X_CAL\t'
            'Shimmer_8665_Accel_LN_Y_CAL\tShimmer_8665_Accel_LN_Z_CAL',
            '{unix_ms}\t{a}\t0.0\t9.80665', below='ms\tm/(s^2)\tm/(s^2)\tm/(s^2)'),
    ),
    'shimmer with a name for its time': (
        'motion.csv', (ACCELERATION,),
        'sep=\t\n' + table('time\tShimmer_8665_Accel_LN_X_CAL\tShimmer_8665_Accel_LN_Y_CAL\t'
            'Shimmer_8665_Accel_LN_Z_CAL', '{unix_ms}\t{a}\t0.0\t9.80665',
            below='ms\tm/(s^2)\tm/(s^2)\tm/(s^2)'),
    ),
    'units as words': (
        'motion.csv', (ACCELERATION,),
        table('t_ms,acc_x_mg,acc_y_mg,acc_z_mg', '{ms},{g}e3,0.0,1000.0'),
    ),
    'ros topic as csv': (
        'motion.csv', (ACCELERATION,),
        table('stamp,linear_acceleration.x,linear_acceleration.y,linear_acceleration.z',
            '{unix},{a},0.0,9.80665'),
    ),
}  # fmt: skip
"""Name of a file, what is in it, and its text."""

REFUSED: dict[str, tuple[str, str]] = {
    'axivity without a header': (table('{date},0.0,0.0,1.0', '{date},{g},0.0,1.0'), 'no header'),
    'serial monitor': (
        '10:00:00.000 -> 0.01,0.02,9.81\n10:00:00.020 -> 0.02,0.02,9.81\n', 'no header',
    ),
    'counts of a converter': (
        table('millis,ax,ay,az', '{ms},{k},0,16384'), 'without a unit is 1.638e',
    ),
    'degrees that are no radians': (
        table('millis,gx,gy,gz', '{ms},0,400,0'), 'which is no rad/s',
    ),
    'a magnetometer': (
        table('time,seconds_elapsed,z,y,x', '{unix_ns},{s},40.0,0.0,20.0'), 'no motion among',
    ),
    'ticks of 0.1 ms': (
        table('PacketCounter,SampleTimeFine,Acc_X,Acc_Y,Acc_Z', '{k},{ms}0,{a},0.0,9.80665'),
        'too many for a motion sensor',
    ),
}  # fmt: skip
"""Texts of files, and a part of the reason of their refusal."""


@pytest.mark.parametrize('name', READ)
def test_a_logger_is_read_in_its_units(name: str, tmp_path: Path) -> None:
    file, quantities, text = READ[name]
    path = tmp_path / file
    path.write_text(text, encoding='utf-8')
    record = read_motion(path)
    assert record.time[-1] - record.time[0] == pytest.approx(STEP * (COUNT - 1), abs=1e-6)
    assert (record.acceleration is not None) == (ACCELERATION in quantities)
    assert (record.rate is not None) == (RATE in quantities)
    if record.acceleration is not None:
        expected = [[0.1 * (k % 5), 0.0, GRAVITY] for k in range(COUNT)]
        np.testing.assert_allclose(record.acceleration, expected, atol=1e-9)
    if record.rate is not None:
        np.testing.assert_allclose(record.rate, [[0.0, 0.5, 0.0]] * COUNT, atol=1e-9)


@pytest.mark.parametrize('name', REFUSED)
def test_a_logger_is_refused_by_cause(name: str, tmp_path: Path) -> None:
    text, why = REFUSED[name]
    path = tmp_path / 'motion.csv'
    path.write_text(text.replace('{date}', '2026-03-01 09:59:59.980'), encoding='utf-8')
    with pytest.raises(FormatError, match=why) as caught:
        read_motion(path)
    assert caught.value.cure


def zipped(path: Path, **texts: str) -> Path:
    """Write texts into a zip under their names, in which `_` stands for the point."""
    with zipfile.ZipFile(path, 'w', zipfile.ZIP_DEFLATED) as archive:
        for name, text in texts.items():
            archive.writestr(name.replace('_', '.'), text)
    return path


PHONE = {
    'Accelerometer_csv': table('time,seconds_elapsed,z,y,x', '{unix_ns},{s},0.0,0.0,{a}'),
    'TotalAcceleration_csv': table('time,seconds_elapsed,z,y,x', '{unix_ns},{s},9.80665,0.0,{a}'),
    'Gravity_csv': table('time,seconds_elapsed,z,y,x', '{unix_ns},{s},9.80665,0.0,0.0'),
    'Gyroscope_csv': table('time,seconds_elapsed,z,y,x', '{unix_ns},{s},0.0,0.5,0.0'),
    'Magnetometer_csv': table('time,seconds_elapsed,z,y,x', '{unix_ns},{s},0.0,0.0,9.8'),
    'Annotation_csv': 'time,seconds_elapsed,text\n',
    'Metadata_csv': 'version,platform,standardisation\n3,android,false\n',
}


def test_the_tables_of_a_zip_are_one_record(tmp_path: Path) -> None:
    record = read_motion(zipped(tmp_path / 'phone.zip', **PHONE))
    assert record.acceleration is not None
    assert record.rate is not None
    np.testing.assert_allclose(np.diff(record.time), STEP, atol=1e-6)
    np.testing.assert_allclose(record.acceleration[:, 2], GRAVITY)
    np.testing.assert_allclose(record.acceleration[:3, 0], [0.0, 0.1, 0.2], atol=1e-9)
    np.testing.assert_allclose(record.rate[1:-1], [[0.0, 0.5, 0.0]] * (COUNT - 2), atol=1e-9)


@pytest.mark.parametrize(('told', 'sign'), [('ios,false', -1.0), ('ios,true', 1.0)])
@pytest.mark.parametrize('is_packed', [True, False])
def test_the_signs_of_apple_are_turned(
    tmp_path: Path, told: str, sign: float, is_packed: bool
) -> None:
    about = f'version,platform,standardisation\n3,{told}\n'
    text = PHONE['Accelerometer_csv']
    path = tmp_path / 'Accelerometer.csv'
    if is_packed:
        path = zipped(tmp_path / 'a.zip', Accelerometer_csv=text, Metadata_csv=about)
    else:
        path.write_text(text, encoding='utf-8')
        (tmp_path / 'Metadata.csv').write_text(about, encoding='utf-8')
    record = read_motion(path)
    assert record.acceleration is not None
    np.testing.assert_allclose(record.acceleration[1, 0], sign * 0.1)
    assert any('Apple' in note for note in record.notes) == (sign < 0.0)


BROKEN = {
    'no table': ({'film_mp4': 'x'}, 'a zip of 1 files, 0 of them tables'),
    'no motion': ({'a_csv': 'time,text\n0,a\n1,b\n'}, 'no motion among time, text'),
    'no end': ({'a_csv': '0' * (70 << 20)}, 'tables of more than 64 MiB in a zip'),
    'too many': ({f'{k}_csv': '' for k in range(300)}, 'a zip of 300 files'),
}


@pytest.mark.parametrize('name', BROKEN)
def test_a_zip_is_refused_by_cause(name: str, tmp_path: Path) -> None:
    texts, why = BROKEN[name]
    path = zipped(tmp_path / 'a.zip', **texts)
    with pytest.raises(FormatError, match=why):
        read_motion(path)


@pytest.mark.parametrize('cut', [30, 90, -30, -8])
def test_a_zip_that_is_cut_is_refused(cut: int, tmp_path: Path) -> None:
    path = zipped(tmp_path / 'a.zip', **PHONE)
    path.write_bytes(path.read_bytes()[:cut])
    with pytest.raises(FormatError, match=r'a zip that cannot be read|a compressed file'):
        read_motion(path)


DOT = 'sep=,\nDeviceTag:,D1\nOutputRate:,60Hz\nStartTime: ,2026-06-01_12:00:00_086 CEST\n\n'
MTW = '// Start Time: Unknown\n// Update Rate: 50.0Hz\n// Firmware Version: 4.0.2\n'


def test_a_movella_dot_measures_degrees_in_its_own_frame_and_in_that_of_the_earth(
    tmp_path: Path,
) -> None:
    path = tmp_path / 'dot.csv'
    head = 'PacketCounter,SampleTimeFine,Acc_X,Acc_Y,Acc_Z,Gyr_X,Gyr_Y,Gyr_Z'
    path.write_text(DOT + table(head, '{k},{us},{a},0.0,9.80665,0.0,0.5,0.0'))
    record = read_motion(path)
    assert record.rate is not None
    np.testing.assert_allclose(record.rate[:, 1], 0.5 * DEGREE)
    np.testing.assert_allclose(np.diff(record.time), STEP)
    half = np.sqrt(0.5)
    head = 'PacketCounter,SampleTimeFine,Quat_W,Quat_X,Quat_Y,Quat_Z,FreeAcc_X,FreeAcc_Y,FreeAcc_Z'
    path.write_text(DOT + table(head, f'{{k}},{{us}},{half},0,0,{half},0.0,{{a}},0.0'))
    turned = read_motion(path).acceleration  # its x points north
    assert turned is not None
    np.testing.assert_allclose(turned[:3], [[0, 0, 0], [0.1, 0, 0], [0.2, 0, 0]], atol=1e-6)


def test_an_xsens_counts_packets_and_tenths_of_milliseconds(tmp_path: Path) -> None:
    path = tmp_path / 'mtw.txt'
    head = 'PacketCounter\tSampleTimeFine\tAcc_X\tAcc_Y\tAcc_Z\tGyr_X\tGyr_Y\tGyr_Z'
    lines = table(head, '{k}\t{t}\t{a}\t0.0\t9.80665\t0.0\t0.5\t0.0'.replace('{t}', ''))
    rows = lines.splitlines()
    for k in range(1, COUNT + 1):  # the counter begins anew
        rows[k] = rows[k].replace(f'{k - 1}\t', f'{(65520 + k) % 65536}\t', 1)
    path.write_text(MTW + '\n'.join(rows))
    record = read_motion(path)
    assert record.rate is not None
    np.testing.assert_allclose(record.rate[:, 1], 0.5)
    np.testing.assert_allclose(np.diff(record.time), STEP)
    assert 'times are by the rate of 50 Hz' in record.notes
    rows[1:] = [row.replace('\t\t', f'\t{200 * k}\t', 1) for k, row in enumerate(rows[1:])]
    path.write_text(MTW + '\n'.join(rows))
    np.testing.assert_allclose(np.diff(read_motion(path).time), STEP)


def test_a_serial_monitor_is_read_with_its_clock(tmp_path: Path) -> None:
    path = tmp_path / 'serial.txt'
    rows = [f'10:00:{STEP * k:06.3f} -> 0.5,0.0,9.81' for k in range(COUNT)]
    path.write_text('\n'.join(['10:00:00.000 -> ax,ay,az', *rows, '']))
    np.testing.assert_allclose(np.diff(read_motion(path).time), STEP, atol=1e-9)
    pairs = [row.replace('0.5,', 'ax:0.5,ay:').replace(',9', ',az:9') for row in rows]
    path.write_text('\n'.join([*pairs, '']))
    record = read_motion(path)
    assert record.acceleration is not None
    np.testing.assert_allclose(record.acceleration, [[0.5, 0.0, 9.81]] * COUNT)


@pytest.mark.parametrize('sign', [' \t', ', '])
def test_a_sketch_may_have_a_line_for_each_quantity(tmp_path: Path, sign: str) -> None:
    """As those of Adafruit, which say first what is set."""
    path = tmp_path / 'serial.txt'
    lines = [f'10:00:00.000 -> {each}' for each in ('LSM6DSOX found!', 'rate set to: 104 Hz')]
    for k in range(COUNT):
        clock = f'10:00:{STEP * k:06.3f} -> '
        lines += [f'{clock}\t\tTemperature 18.40 deg C', clock]
        lines += [f'{clock}\t\tAccel X: 0.5{sign}Y: 0.0{sign}Z: 9.81 m/s^2 ']
        lines += [f'{clock}\t\tGyro X: 0.01{sign}Y: -0.02{sign}Z: {k} radians/s ']
    path.write_text('\n'.join(lines))
    record = read_motion(path)
    np.testing.assert_allclose(np.diff(record.time), STEP, atol=1e-9)
    np.testing.assert_allclose(record.acceleration, [[0.5, 0.0, 9.81]] * COUNT)
    assert record.rate is not None
    np.testing.assert_allclose(record.rate[:, 2], np.arange(COUNT))
    path.write_text('\n'.join(line.partition(' -> ')[2] for line in lines))
    with pytest.raises(FormatError, match='no time among Accel X'):
        read_motion(path)


def test_a_sketch_may_have_its_quantities_in_brackets(tmp_path: Path) -> None:
    """As those of SparkFun."""
    path = tmp_path / 'serial.txt'
    lines = ['10:00:00.000 -> Initialization returned: All is well.']
    for k in range(COUNT):
        values = 'Acc (mg) [  00050.00, -00003.00,  01000.00 ], Gyr (DPS) [  00090.00,  00002.64, '
        lines.append(
            f'10:00:{STEP * k:06.3f} -> Scaled. {values} 00000.17 ], Tmp (C) [  00023.90 ]'
        )
    path.write_text('\n'.join(lines))
    record = read_motion(path)
    np.testing.assert_allclose(np.diff(record.time), STEP, atol=1e-9)
    assert record.acceleration is not None
    np.testing.assert_allclose(record.acceleration[:, 0], 0.05 * 9.80665)
    assert record.rate is not None
    np.testing.assert_allclose(record.rate[:, 0], np.pi / 2.0)


def test_a_rate_above_the_header_counts_for_calibration_too(tmp_path: Path) -> None:
    path = tmp_path / 'serial.txt'
    rows = ''.join(f'0.0{k % 7}\t0.03\t0.99\n' for k in range(50))
    path.write_text(f'Accelerometer sample rate = 100.00 Hz\nX\tY\tZ\n{rows}')
    np.testing.assert_allclose(read_csv_sway(path).time, np.arange(50) / 100)


def test_tilts_below_a_title_in_brackets_are_no_wind(tmp_path: Path) -> None:
    """As of pulling tests."""
    path = tmp_path / 'pull.txt'
    rows = ''.join(f'{51727 + 0.12 * k:.2f}\t{k}\t0.{k:02d}\t-0.01\n' for k in range(50))
    path.write_text(
        f'[tree]\nnumber\t3\n\n[Data]\nTime\tForce(100)\tInclino(80)X\tInclino(80)Y\n{rows}'
    )
    assert read_csv_sway(path).quantity == 'tilt'
    with pytest.raises(FormatError, match='tilts, strains and single axes'):
        read_motion(path)


def test_an_error_names_the_line_of_the_header(tmp_path: Path) -> None:
    path = tmp_path / 'a.csv'
    path.write_text('made by a program\n\ntime,colour,ax\n0,red,1\n0.02,blue,2\n')
    with pytest.raises(FormatError, match=r'a\.csv:3: no motion among time, colour, ax'):
        read_motion(path)


@pytest.mark.parametrize('name', ['physics toolbox', 'arduino with a header'])
def test_a_unit_that_gravity_tells_is_said(name: str, tmp_path: Path) -> None:
    path = tmp_path / 'motion.csv'
    path.write_text(READ[name][2].replace('gFx,gFy,gFz', 'ax,ay,az'), encoding='utf-8')
    assert any('taken in g, as gravity is in it' in note for note in read_motion(path).notes)


@pytest.mark.parametrize('largest', [41.5, 300.25])
def test_a_rate_beyond_any_in_radians_is_in_degrees_however_small_it_mostly_is(
    tmp_path: Path, largest: float
) -> None:
    """A stem turns by a few degrees per second, and in one gust faster."""
    path = tmp_path / 'motion.csv'
    rows = [largest if 40 <= k < 44 else 2.25 for k in range(200)]
    text = ''.join(f'{20 * k},0,{rate},0\n' for k, rate in enumerate(rows))
    path.write_text(f'millis,gx,gy,gz\n{text}', encoding='utf-8')
    record = read_motion(path)
    assert record.rate is not None
    np.testing.assert_allclose(record.rate[:, 1], np.radians(rows))
    assert any('taken in deg/s, as it is up to' in note for note in record.notes)
    path.write_text(f'millis,gx,gy,gz\n{text.replace(".25", "").replace(".5", "")}')
    with pytest.raises(FormatError, match=r'at most, which is no rad/s'):
        read_motion(path)  # whole numbers may be counts of a converter


def test_one_fault_among_small_rates_tells_no_unit(tmp_path: Path) -> None:
    path = tmp_path / 'motion.csv'
    rows = [99.5 if k == 40 else 0.25 for k in range(200)]
    text = ''.join(f'{20 * k},0,{rate},0\n' for k, rate in enumerate(rows))
    path.write_text(f'millis,gx,gy,gz\n{text}', encoding='utf-8')
    record = read_motion(path)
    assert record.rate is not None
    assert record.rate[0, 1] == 0.25
    assert any('taken in rad/s; call it gx [deg/s] if it is' in note for note in record.notes)


OWN_TIMES = (
    'X[s],EMG 1,X[s],Acc 1.X (IM) [g],Acc 1.Y (IM) [g],Acc 1.Z (IM) [g],'
    'X[s],Gyro 1.X (IM) [deg/sec],Gyro 1.Y (IM) [deg/sec],Gyro 1.Z (IM) [deg/sec]'
)


def test_channels_have_times_of_their_own(tmp_path: Path) -> None:
    """As of Delsys: a muscle at 1,000 Hz fills more rows than an accelerometer at 100 Hz."""
    path = tmp_path / 'trigno.csv'
    rows = [
        f'{k / 1000},0.1,' + (f'{k / 100},0,0,1,{k / 100},2,0,{k}' if k < 20 else ',,,,,,,')
        for k in range(200)
    ]
    path.write_text('\n'.join([OWN_TIMES, *rows]), encoding='utf-8')
    record = read_motion(path)
    assert record.rate is not None
    np.testing.assert_allclose(record.time, np.arange(20) / 100)
    np.testing.assert_allclose(record.rate[:, 2], np.radians(np.arange(20)))
    np.testing.assert_allclose(read_csv_sway(path).time, record.time)
    path.write_text('\n'.join([OWN_TIMES, *rows]).replace('0.01,2,0,1', '0.016,2,0,1'))
    with pytest.raises(FormatError, match=r"several times 'X\[s\]', which differ"):
        read_motion(path)
