# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Winds as stations, services and instruments of others write them, read as they are."""

from datetime import datetime, timedelta
from pathlib import Path
import tracemalloc

import numpy as np
import pytest
from tree_sway_lab.bench.bench_tree import bench_tree

from tree_sway.errors import FormatError, ParameterError
from tree_sway.files.wind.nmea import parse_nmea
from tree_sway.files.wind.reading import Refusal, WindReading
from tree_sway.files.wind.record import WindRecord
from tree_sway.files.wind.sensor_line import checksum_of
from tree_sway.files.wind.wind_file import read_wind
from tree_sway.simulation.rig import simulate
from tree_sway.simulation.wind.about_means import turbulence_about_means

N = 10
SPEEDS = 4.0 + np.sin(np.arange(N))


def stamped(pattern: str, minutes: int, row: str) -> str:
    begin = datetime(2024, 3, 1)
    times = (begin + timedelta(minutes=minutes * k) for k in range(N))
    rows = zip(times, SPEEDS, strict=True)
    return '\n'.join(
        row.format(
            t=t.strftime(pattern), u=u, g=2.0 * u, k=3.6 * u, m=u / 0.44704, n=2.0 * u / 0.44704
        )
        for t, u in rows
    )


STATIONS = {
    'minutes with gusts': 'time,speed,direction,gust\n'
    + stamped('%Y-%m-%dT%H:%M:%SZ', 1, '{t},{u:.3f},270,{g:.3f}'),
    'German service': 'STATIONS_ID;MESS_DATUM;QN;FF_10;DD_10;eor\n'
    + stamped('%Y%m%d%H%M', 10, '  44;{t};    3;   {u:.3f}; 270;eor'),
    'open weather service': 'latitude,longitude,elevation\n52.5,13.4,38.0\n\n'
    'time,wind_speed_10m (km/h),wind_direction_10m (°),wind_gusts_10m (km/h)\n'
    + stamped('%Y-%m-%dT%H:%M', 60, '{t},{k:.3f},270,'),
    'reanalysis': 'valid_time,u10,v10,i10fg\n'
    + stamped('%Y-%m-%d %H:%M:%S', 60, '{t},{u:.4f},0.0,{g:.4f}'),
    'date and time apart': 'Date;Time;Wind Speed [m/s];Wind Dir\n'
    + stamped('%d.%m.%Y;%H:%M', 10, '{t};{u:.2f};270')
    .replace('.', ',').replace(',03,2024', '.03.2024'),
    'logger with an array': '"TOA5","CR1000"\n"TIMESTAMP","u(1)","u(2)","WS","WindDir"\n'
    '"TS","volts","volts","meters/second","degrees"\n"","Smp","Smp","Avg","Smp"\n'
    + stamped('%Y-%m-%d %H:%M:%S', 1, '"{t}",0.1,0.2,{u:.3f},270'),
    'logger': '"TOA5","CR1000"\n"TIMESTAMP","RECORD","WS","WindDir","WS_Max"\n'
    '"TS","RN","m/s","deg","m/s"\n'
    '"","","Avg","Avg","Max"\n' + stamped('%Y-%m-%d %H:%M:%S', 10, '"{t}",1,{u:.3f},270,{g:.3f}'),
    'garden station': '"Date","Outdoor Temperature (°F)","Wind Speed (mph)","Wind Gust (mph)",'
    '"Wind Direction (°)"\n'
    + stamped('%Y-%m-%dT%H:%M:%S-05:00', 5, '"{t}","40","{m:.3f}","{n:.3f}","270"'),
    'climate and forecast names': 'sourceId,referenceTime,wind_speed,wind_from_direction,'
    'wind_speed_of_gust\n'
    + stamped('%Y-%m-%dT%H:%M:%S.000Z', 10, 'SN18700:0,{t},{u:.3f},270,{g:.3f}'),
    'slashes': 'date_time\twspd\twdir\n' + stamped('%Y/%m/%d %H:%M', 10, '{t}\t{u:.3f}\t270'),
}  # fmt: skip


@pytest.mark.parametrize('name', STATIONS)
def test_the_means_of_a_station_stay_and_turbulence_is_about_them(
    name: str, tmp_path: Path
) -> None:
    path = tmp_path / 'station.csv'
    path.write_text(STATIONS[name], encoding='utf-8')
    plain, filled = read_wind(path, turbulence=False), read_wind(path)
    assert len(plain.time) == N
    np.testing.assert_allclose(plain.velocity[:, 0], SPEEDS, atol=0.006)
    np.testing.assert_allclose(plain.velocity[:, 1:], 0.0, atol=1e-9)
    assert 'the wind between them is interpolated' in plain.notes[-1]
    assert 'turbulence is simulated about them' in filled.notes[-1]
    assert filled.period <= 0.5
    assert filled.duration == pytest.approx(plain.duration, abs=0.5)
    own = np.interp(filled.time, plain.time, plain.velocity[:, 0])
    assert filled.velocity[:, 0].std() > 1.1 * own.std()
    np.testing.assert_allclose(filled.velocity.mean(axis=0), [own.mean(), 0, 0], atol=0.05)
    again = read_wind(path, seed=0)
    np.testing.assert_array_equal(again.velocity, filled.velocity)
    assert (read_wind(path, seed=1).velocity != filled.velocity).any()
    with pytest.raises(ParameterError, match='seed is'):
        read_wind(path, seed=-1)


def test_turbulence_has_the_gusts_that_were_reported() -> None:
    time, mean = 600.0 * np.arange(50), np.tile([0.0, 8.0, 0.0], (50, 1))
    for gust in (10.0, 14.0):
        rng = np.random.default_rng(1)
        fine, wind = turbulence_about_means(time, mean, np.full(50, gust), rng)
        seconds = np.hypot(wind[:, 0], wind[:, 1]).reshape(-1)[: len(fine) // 30 * 30]
        largest = seconds.reshape(-1, 30).mean(axis=1)  # over 3 s
        of_each = largest[: len(largest) // 200 * 200].reshape(-1, 200).max(axis=1)
        assert of_each.mean() - 8.0 == pytest.approx(gust - 8.0, rel=0.15)


def test_reports_of_airports(tmp_path: Path) -> None:
    lines = [
        'METAR EDDF 312220Z 24010KT 9999 FEW040 12/08 Q1015',
        'EDDF 312250Z 27020G32KT 9999',
        'METAR EDDF 312320Z VRB02KT CAVOK',
        'SPECI EDDF 010020Z 00000KT CAVOK',
        'UUEE 010050Z 09005MPS 9999',
    ]
    path = tmp_path / 'reports.txt'
    path.write_text('\n'.join(lines))
    record = read_wind(path, turbulence=False)
    assert record.time.tolist() == [0.0, 1800.0, 7200.0, 9000.0]
    path.write_text('\n'.join([f'{lines[4]},2026-04-01T00:50:00Z', *lines[3::-1]]))
    newest_first = read_wind(path, turbulence=False)
    assert newest_first.time.tolist() == record.time.tolist()
    np.testing.assert_array_equal(newest_first.velocity, record.velocity)
    path.write_text('EDDF 312350Z 24015KT\nEDDF 010020Z 25015KT\n')
    assert read_wind(path, turbulence=False).time.tolist() == [0.0, 1800.0]
    np.testing.assert_allclose(record.velocity[1], [20 * 1852 / 3600, 0, 0], atol=1e-9)
    np.testing.assert_allclose(record.velocity[3], [-5, 0, 0], atol=1e-9)
    assert record.gust is not None
    assert record.gust[1] == pytest.approx(32 * 1852 / 3600)
    assert record.first_refused == "line 3: no direction or speed in 'VRB02'"


@pytest.mark.parametrize(
    ('body', 'expected'),
    [
        ('WIMDA,29.9,I,1.01,B,12.0,C,,,40.0,,1.0,C,270.0,T,268.0,M,19.4,N,10.0,M', (10, 0, 0)),
        ('WIXDR,A,260,D,0,A,270,D,1,A,280,D,2,S,4.0,M,0,S,5.0,M,1,S,6.0,M,2', (5, 0, 0)),
        ('WIXDR,A,180.0,D,WDIR,S,3.0,M,WSPD', (0, 3, 0)),
        ('WIVWR,90.0,L,10.0,N,5.144,M,18.5,K', (5.1444, 0, 0)),
    ],
)
def test_further_sentences_of_weather_stations(body: str, expected: tuple[float, ...]) -> None:
    said = parse_nmea(f'${body}*{checksum_of(body)}')
    assert isinstance(said, WindReading)
    np.testing.assert_allclose(said.velocity(0.0), expected, atol=1e-3)


def test_other_transducers_are_no_wind() -> None:
    assert parse_nmea('$WIXDR,C,20.5,C,TEMP,P,1.01,B,BARO') is None
    assert isinstance(parse_nmea('$WIMDA,29.9,I,1.01,B'), Refusal)


def test_a_direction_that_is_none_costs_its_row(tmp_path: Path) -> None:
    path = tmp_path / 'a.csv'
    path.write_text('time,speed,direction\n0,1,270\n1,2,-999\n2,-999,90\n3,1,90\n')
    record = read_wind(path)
    assert (len(record.time), record.refused) == (2, 2)
    assert record.first_refused == 'line 3: direction is -999 degrees'


def test_what_is_not_a_wind_says_what_to_name(tmp_path: Path) -> None:
    path = tmp_path / 'rain.csv'
    path.write_text('time,rain\n0,1\n1,2\n')
    with pytest.raises(FormatError, match='no column for the speed and none for the direction'):
        read_wind(path)


def test_one_report_of_an_airport_is_ten_minutes_of_wind(tmp_path: Path) -> None:
    path = tmp_path / 'one.metar'
    path.write_text('METAR EDDF 312250Z 27020G32KT 9999')
    plain, filled = read_wind(path, turbulence=False), read_wind(path)
    knots = 1852.0 / 3600.0
    assert plain.duration == filled.duration == 600.0
    np.testing.assert_allclose(plain.velocity, [[20.0 * knots, 0.0, 0.0]] * 2, atol=1e-9)
    assert 'ten minutes' in plain.notes[0]
    assert filled.velocity[:, 0].mean() == pytest.approx(20.0 * knots, rel=0.02)


@pytest.mark.parametrize('apart', ['20', '108', 'means'])
def test_a_tree_sways_in_means_however_far_apart(apart: str, tmp_path: Path) -> None:
    path = tmp_path / 'wind'
    if apart == 'means':  # too long for turbulence
        rows = (f'{3600 * k},{5 + k % 2},270' for k in range(24 * 40))
        path.write_text('\n'.join(['time,speed,direction', *rows]))
    else:
        later = 60 + int(apart)
        hour, minute = 12 + later // 60, later % 60
        path.write_text(f'EDDF 221300Z 27010KT\nEDDF 22{hour}{minute:02d}Z 27014KT\n')
    for turbulence in (True, False):
        record = read_wind(path, turbulence=turbulence)
        swayed = simulate(bench_tree(), record, seconds=2.0, rate=30.0, model=12)
        expected = np.interp(swayed.time, record.time, record.velocity[:, 0])
        np.testing.assert_allclose(swayed.wind[15:, 0], expected[15:], atol=0.3)


def test_a_few_seconds_of_a_long_record_take_little_memory() -> None:
    time = 0.05 * np.arange(1_000_000)
    record = WindRecord(time, np.tile([6.0, 0.0, 0.0], (len(time), 1)), 'a record')
    tree = bench_tree()
    simulate(tree, record, seconds=0.1, model=12)
    tracemalloc.start()
    simulate(tree, record, seconds=0.1, model=12)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 2 * record.velocity.nbytes
