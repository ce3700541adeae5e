# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Forms in which services and loggers give the wind: read in their units, or refused by cause."""

from __future__ import annotations

from collections.abc import Callable
import json
from pathlib import Path
from typing import cast

import numpy as np
import pytest

from tree_sway.errors import FormatError
from tree_sway.files.wind.table import read_table_wind
from tree_sway.files.wind.wind_file import read_wind

KNOT, MPH, KMH = 1852.0 / 3600.0, 0.44704, 1.0 / 3.6
TIMES = [f'2026-03-01 1{hour}:00' for hour in range(6)]
EPOCHS = [1772359200 + 3600 * hour for hour in range(6)]


def table(*head: str, row: Callable[[int], str]) -> str:
    """Lines of a head and six rows."""
    return '\n'.join([*head, *(row(k) for k in range(6))]) + '\n'


def records(of_row: Callable[[int], object]) -> list[object]:
    """Six records."""
    return [of_row(k) for k in range(6)]


def frost(k: int) -> object:
    """Observations of an hour as MET Norway's Frost gives them."""
    observations = [
        {'elementId': 'wind_speed', 'value': 10.0, 'unit': 'm/s', 'level': {'value': 10}},
        {'elementId': 'wind_from_direction', 'value': 240, 'unit': 'degrees'},
    ]
    hour = f'2026-03-01T1{k}:00:00.000Z'
    return {'sourceId': 'SN18700:0', 'referenceTime': hour, 'observations': observations}


def forecast(k: int) -> object:
    """One hour of MET Norway's Locationforecast."""
    details = {'wind_speed': 10.0, 'wind_from_direction': 240.0}
    return {'time': f'2026-03-01T1{k}:00:00Z', 'data': {'instant': {'details': details}}}


def of_time(value: float) -> list[float]:
    """Return six equal values."""
    return [value] * 6


ISO = [time.replace(' ', 'T') for time in TIMES]
READ: dict[str, tuple[str, float]] = {
    'open-meteo json': (
        json.dumps({
            'hourly_units': {
                'time': 'iso8601', 'wind_speed_10m': 'km/h', 'wind_direction_10m': '°',
            },
            'hourly': {
                'time': ISO, 'wind_speed_10m': of_time(10.0), 'wind_direction_10m': of_time(240),
            },
        }), 10.0 * KMH,
    ),
    'open-meteo json in miles': (
        json.dumps({
            'hourly_units': {
                'time': 'iso8601', 'wind_speed_10m': 'mp/h', 'wind_direction_10m': '°',
            },
            'hourly': {
                'time': ISO, 'wind_speed_10m': of_time(10.0), 'wind_direction_10m': of_time(240),
            },
        }), 10.0 * MPH,
    ),
    'open-meteo csv': (
        table(
            'latitude,longitude,elevation,utc_offset_seconds,timezone,timezone_abbreviation',
            '52.52,13.41,38.0,0,GMT,GMT', '',
            'time,wind_speed_10m (kn),wind_direction_10m (°),wind_gusts_10m (kn)',
            row=lambda k: f'{ISO[k]},10.0,240,14.0',
        ), 10.0 * KNOT,
    ),
    'isd': (
        table('"STATION","DATE","SOURCE","WND"',
            row=lambda k: f'"72503014732","{ISO[k]}:00","7","240,1,N,0100,1"'),
        10.0,
    ),
    'isd-lite': (
        table(row=lambda k: f'2026 03 01 1{k}   100    50 10130   240   100     8     0 -9999'),
        10.0,
    ),
    'ghcnh': (
        table('STATION|DATE|wind_direction|wind_speed|wind_gust',
            row=lambda k: f'USW00014732|{ISO[k]}:00|240|10.0|14.0'),
        10.0,
    ),
    'weather underground v2': (
        json.dumps({'observations': records(lambda k: {
            'stationID': 'KNYNEW', 'obsTimeUtc': f'{ISO[k]}:00Z', 'epoch': EPOCHS[k],
            'winddirAvg': 240, 'imperial': {'windspeedAvg': 10.0, 'windgustHigh': 14.0},
        })}), 10.0 * MPH,
    ),
    'weather underground page': (
        table('Time,Temperature,Wind,Speed,Gust',
            row=lambda k: f'{k + 1}:04 AM,59.0 °F,WSW,10.0 mph,14.0 mph'),
        10.0 * MPH,
    ),
    'ecowitt csv': (
        table('Time,Outdoor Temperature(℃),Wind Speed(km/h),Wind Gust(km/h),Wind Direction(º)',
            row=lambda k: f'{TIMES[k]},12.1,10.0,14.0,240'),
        10.0 * KMH,
    ),
    'ecowitt sd card': (
        table('Time,Indoor Temperature(℉),Wind(mph),Gust(mph),Wind Direction(deg)',
            row=lambda k: f'{TIMES[k]},70.1,10.0,14.0,240'),
        10.0 * MPH,
    ),
    'ecowitt api': (
        json.dumps({'data': {'wind': {
            'wind_speed': {'unit': 'mph', 'list': {str(t): '10.0' for t in EPOCHS}},
            'wind_direction': {'unit': 'º', 'list': {str(t): '240' for t in EPOCHS}},
        }}}), 10.0 * MPH,
    ),
    'weatherlink csv': (
        table('"Weather Station","Garden"', '"Mar 1","2026"', '',
            '"Date & Time","Temp - °C","Avg Wind Speed - km/h","High Wind Speed - km/h",'
            '"Prevailing Wind Direction"',
            row=lambda k: f'"3/1/26 {k + 1}:00 AM","12.1","10.0","14.0","WSW"'),
        10.0 * KMH,
    ),
    'weatherlink v2': (
        json.dumps({'station_id': 1, 'sensors': [{'lsid': 1, 'data': records(lambda k: {
            'ts': EPOCHS[k], 'wind_speed_avg': 10.0, 'wind_speed_hi': 14.0,
            'wind_dir_of_prevail': 240, 'temp_avg': 55.1,
        })}]}), 10.0 * MPH,
    ),
    'tempest csv': (
        table('timestamp,wind_lull,wind_avg,wind_gust,wind_direction,wind_interval',
            row=lambda k: f'{EPOCHS[k]},6.0,10.0,14.0,240,3'),
        10.0,
    ),
    'netatmo csv': (
        table('Name;Long;Lat;ModuleName;ModuleType', '"Home";11.5;48.1;"Wind";"Wind"',
            'Timestamp;"Timezone : Europe/Berlin";WindStrength;WindAngle;GustStrength;GustAngle',
            row=lambda k: f'{EPOCHS[k]};"2026/03/01 1{k}:00:00";10;240;14;240'),
        10.0 * KMH,
    ),
    'ambient weather csv': (
        table('Date,Simple Date,Outdoor Temperature (°F),Wind Speed (mph),Wind Gust (mph),'
            'Max Daily Gust (mph),Wind Direction (°)',
            row=lambda k: f'"{ISO[k]}:00-05:00","{TIMES[k]}:00",58.1,10.0,14.0,18.0,240'),
        10.0 * MPH,
    ),
    'ambient weather api': (
        json.dumps(records(lambda k: {
            'dateutc': 1000 * EPOCHS[k], 'windspeedmph': 10.0, 'windgustmph': 14.0,
            'maxdailygust': 18.0, 'winddir': 240, 'date': f'{ISO[k]}:00.000Z',
        })), 10.0 * MPH,
    ),
    'frost': (json.dumps({'@type': 'ObservationResponse', 'data': records(frost)}), 10.0),
    'locationforecast': (
        json.dumps({'properties': {
            'meta': {'units': {'wind_speed': 'm/s', 'wind_from_direction': 'degrees'}},
            'timeseries': records(forecast),
        }}), 10.0,
    ),
    'seklima': (
        table('Navn;Stasjon;Tid(norsk normaltid);Middelvind;Vindretning',
            row=lambda k: f'Oslo;SN18700;01.03.2026 1{k}:00;10,0;240'),
        10.0,
    ),
    'dwd 10 minutes': (
        table('STATIONS_ID;MESS_DATUM;  QN;FF_10;DD_10;eor',
            row=lambda k: f'        433;202603011{k}00;    3;  10.0; 240;eor'),
        10.0,
    ),
    'dwd hours': (
        table('STATIONS_ID;MESS_DATUM;QN_3;   F;   D;eor',
            row=lambda k: f'        433;202603011{k};    3;  10.0; 240;eor'),
        10.0,
    ),
    'knmi': (
        table('# SOURCE: ROYAL NETHERLANDS METEOROLOGICAL INSTITUTE (KNMI)', '#',
            '# STN,YYYYMMDD,   HH,   DD,   FH,   FF,   FX', '#',
            row=lambda k: f'  260,20260301,   1{k},  240,   90,  100,  140'),
        10.0,
    ),
    'knmi json': (
        json.dumps(records(lambda k: {
            'station_code': 260, 'date': '2026-03-01T00:00:00.000Z', 'hour': k + 1, 'DD': 240,
            'FH': 90, 'FF': 100, 'FX': 140,
        })), 10.0,
    ),
    'meteo-france hours': (
        table('NUM_POSTE;NOM_USUEL;LAT;LON;ALTI;AAAAMMJJHH;RR1;FF;QFF;DD;QDD;FXI',
            row=lambda k: f'01089001;AMBERIEU;45.97;5.32;250;202603011{k};0.0;10.0;1;240;1;14.0'),
        10.0,
    ),
    'meteo-france synop': (
        table('numer_sta;date;pmer;tend;dd;ff;t;td;rafper',
            row=lambda k: f'07005;202603011{k}0000;101320;-10;240;10.0;283.1;278.1;14.0'),
        10.0,
    ),
    'aemet': (
        json.dumps(records(lambda k: {
            'idema': '3129', 'fint': f'{ISO[k]}:00+0000', 'vv': 10.0, 'dv': 240, 'vmax': 14.0,
        })), 10.0,
    ),
    'bom json': (
        json.dumps({'observations': {'header': [{'ID': 'IDN60901'}], 'data': records(lambda k: {
            'sort_order': k, 'local_date_time_full': f'202603011{k}0000', 'gust_kmh': 26,
            'gust_kt': 14, 'wind_dir': 'WSW', 'wind_spd_kmh': 19, 'wind_spd_kt': 10,
        })}}), 19.0 * KMH,
    ),
    'ndbc': (
        table('#YY  MM DD hh mm WDIR WSPD GST  WVHT',
            '#yr  mo dy hr mn degT m/s  m/s     m',
            row=lambda k: f'2026 03 01 1{k} 00 240 10.0 14.0   0.5'),
        10.0,
    ),
    'erddap': (
        table('station,time,wd,wspd,gst', ',UTC,degrees_true,m s-1,m s-1',
            row=lambda k: f'46026,{ISO[k]}:00Z,240,10.0,14.0'),
        10.0,
    ),
    'iem': (
        table('#DEBUG: Format Typ    -> onlycomma', 'station,valid,drct,sknt,gust',
            row=lambda k: f'JFK,{TIMES[k]},240.00,10.00,M'),
        10.0 * KNOT,
    ),
    'iem minutes': (
        table('station,station_name,valid(UTC),sknt,drct,gust_sknt,gust_drct',
            row=lambda k: f'JFK,New York,{TIMES[k]},10,240,14,240'),
        10.0 * KNOT,
    ),
    'toa5': (
        table('"TOA5","CR1000","CR1000","1","CR1000.Std","CPU:wind.CR1","1","Table1"',
            '"TIMESTAMP","RECORD","WS_mph_S_WVT","WindDir_D1_WVT","WindDir_SD1_WVT"',
            '"TS","RN","miles/hour","Deg","Deg"', '"","","WVc","WVc","WVc"',
            row=lambda k: f'"{TIMES[k]}:00",{k},10.0,240,12.1'),
        10.0 * MPH,
    ),
    'names of a logger without units': (
        table('TIMESTAMP,WS_mph_Avg,WindDir', row=lambda k: f'{TIMES[k]},10.0,240'),
        10.0 * MPH,
    ),
    'windy': (
        json.dumps({
            'ts': [1000 * each for each in EPOCHS],
            'units': {'wind_u-surface': 'm*s-1', 'wind_v-surface': 'm*s-1'},
            'wind_u-surface': of_time(10.0 * np.sin(np.radians(60.0))),
            'wind_v-surface': of_time(10.0 * np.cos(np.radians(60.0))),
        }), 10.0,
    ),
    'openweathermap': (
        json.dumps({'list': records(lambda k: {
            'dt': EPOCHS[k], 'main': {'temp': 283.1},
            'wind': {'speed': 10.0, 'deg': 240, 'gust': 14.0},
        })}), 10.0,
    ),
    'weatherapi.com': (
        json.dumps({'forecast': {'forecastday': [{'hour': records(lambda k: {
            'time_epoch': EPOCHS[k], 'time': TIMES[k], 'wind_mph': 10.0, 'wind_kph': 16.1,
            'wind_degree': 240, 'wind_dir': 'WSW', 'gust_mph': 14.0, 'gust_kph': 22.5,
        })}]}}), 10.0 * MPH,
    ),
    'weatherbit': (
        json.dumps({'data': records(lambda k: {
            'ts': EPOCHS[k], 'timestamp_utc': f'{ISO[k]}:00', 'wind_spd': 10.0, 'wind_dir': 240,
            'wind_gust_spd': 14.0,
        })}), 10.0,
    ),
    'met office': (
        json.dumps({'features': [{'properties': {'timeSeries': records(lambda k: {
            'time': f'{ISO[k]}Z', 'windSpeed10m': 10.0, 'windDirectionFrom10m': 240,
            'windGustSpeed10m': 14.0,
        })}}]}), 10.0,
    ),
    'nsrdb': (
        table('Source,Location ID,City,State', 'NSRDB,1005,-,-',
            'Year,Month,Day,Hour,Minute,GHI,Wind Direction,Wind Speed',
            row=lambda k: f'2026,3,1,1{k},0,200,240,10.0'),
        10.0,
    ),
    'pvgis': (
        table('Latitude (decimal degrees): 45.000', 'Longitude (decimal degrees): 8.000', '',
            'time(UTC),T2m,RH,G(h),WS10m,WD10m,SP',
            row=lambda k: f'20260301:1{k}00,8.1,70.0,100.0,10.0,240.0,101000.0'),
        10.0,
    ),
    'weathercloud': (
        table('Date (Europe/Madrid)\tTemperature (°C)\tAverage wind speed (km/h)\t'
            'Average wind direction (°)\tWind gust (km/h)',
            row=lambda k: f'{TIMES[k]}:00\t12.1\t10.0\t240\t14.0'),
        10.0 * KMH,
    ),
    'hobo': (
        table('"Plot Title: mast"',
            '"#","Date Time, GMT+01:00","Wind Speed, m/s (LGR S/N: 1, SEN S/N: 2)",'
            '"Gust Speed, m/s (LGR S/N: 1)","Wind Direction, ø (LGR S/N: 1)"',
            row=lambda k: f'{k},03/01/26 1{k}:00:00,10.0,14.0,240'),
        10.0,
    ),
    'canada': (
        table('"Longitude (x)","Date/Time (LST)","Wind Dir (10s deg)","Wind Spd (km/h)"',
            row=lambda k: f'"-75.67","{TIMES[k]}","24","10"'),
        10.0 * KMH,
    ),
    'us weather service': (
        json.dumps({'features': records(lambda k: {'properties': {
            'timestamp': f'{ISO[k]}:00+00:00',
            'windDirection': {'unitCode': 'wmoUnit:degree_(angle)', 'value': 240},
            'windSpeed': {'unitCode': 'wmoUnit:km_h-1', 'value': 10.0},
        }})}), 10.0 * KMH,
    ),
    'lines of json': (
        ''.join(
            json.dumps({'time': ISO[k], 'wind_speed_kmh': 10.0, 'wind_dir': 240}) + '\n'
            for k in range(6)
        ), 10.0 * KMH,
    ),
}  # fmt: skip
"""Texts of files, and their mean speed in [m/s]; the wind comes from 240 degrees or WSW."""

REFUSED: dict[str, tuple[str, str]] = {
    'global summary of the day': (
        table('"STATION","DATE","WDSP","MXSPD","GUST"',
            row=lambda k: f'"7250301","2026-03-0{k + 1}","10.0","14.0","20.0"'),
        'no column for the direction',
    ),
    'tempest api': (
        json.dumps({'status': {}, 'obs': [[each, 6.0, 10.0, 14.0, 240, 3] for each in EPOCHS]}),
        'no table in the JSON',
    ),
    'meteostat without names': (
        table(row=lambda k: f'2026-03-01,{k},8.1,2.1,70,0.0,,240,10.0,14.0,1013.0,,3'),
        'no header',
    ),
    'bom minutes': (
        table('hm,Station Number,YYYY,MM,DD,HH24,MI format in Local standard time,'
            'Wind speed in km/h,Quality of wind speed,Wind direction in degrees true',
            row=lambda k: f'hm, 66062,2026,03,01,1{k},00, 10.0,N, 240'),
        'no column for the time',
    ),
    'signal k': (
        json.dumps({'updates': [{'timestamp': ISO[0], 'values': [
            {'path': 'environment.wind.speedApparent', 'value': 3.85},
            {'path': 'environment.wind.angleApparent', 'value': 0.52},
        ]}]}), 'no true wind among the paths angleApparent, speedApparent',
    ),
    'visual crossing': (
        table('name,datetime,windgust,windspeed,winddir,conditions',
            row=lambda k: f'Berlin,{ISO[k]}:00,14.0,10.0,240,Clear'),
        'does not say the unit',
    ),
}  # fmt: skip
"""Texts of files, and a part of the reason of their refusal."""


@pytest.mark.parametrize('name', READ)
def test_a_service_is_read_in_its_units(name: str, tmp_path: Path) -> None:
    text, speed = READ[name]
    path = tmp_path / ('wind.json' if text[0] in '{[' else 'wind.csv')
    path.write_text(text, encoding='utf-8')
    record = read_wind(path, format='csv', turbulence=False)
    assert len(record.time) == 6
    assert record.duration == pytest.approx(5.0 * 3600.0)
    bearing = np.radians(247.5 if 'WSW' in text and ' 240' not in text else 240.0)
    expected = [-speed * np.sin(bearing), -speed * np.cos(bearing), 0.0]
    np.testing.assert_allclose(record.velocity[0], expected, atol=1e-6)
    if record.gust is not None and np.isfinite(record.gust).all():
        assert record.gust[0] == pytest.approx(1.4 * speed, rel=0.03)


@pytest.mark.parametrize('name', REFUSED)
def test_a_service_is_refused_by_cause(name: str, tmp_path: Path) -> None:
    text, why = REFUSED[name]
    path = tmp_path / ('wind.json' if text[0] in '{[' else 'wind.csv')
    path.write_text(text, encoding='utf-8')
    with pytest.raises(FormatError, match=why) as caught:
        read_wind(path, turbulence=False)
    assert caught.value.cure


def test_of_two_series_of_one_name_it_says_which_value_is_taken(tmp_path: Path) -> None:
    hours = [cast('dict[str, list[object]]', frost(k)) for k in range(6)]
    for each in hours:
        each['observations'].append({'elementId': 'wind_speed', 'value': 8.0, 'unit': 'm/s'})
    path = tmp_path / 'wind.json'
    path.write_text(json.dumps({'@type': 'ObservationResponse', 'data': hours}))
    found = read_table_wind(path, turbulence=False)
    np.testing.assert_allclose(np.linalg.norm(found.velocity, axis=1), 8.0)
    assert 'of several values the last is taken: wind_speed.value at record 6' in found.notes
