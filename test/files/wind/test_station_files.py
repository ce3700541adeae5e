# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Station files as their makers describe them: read as they are, or refused by what they lack.

Each is made anew from the maker's public pages, with the wind of `SPEEDS` from the west.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from datetime import datetime, timedelta
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tree_sway.errors import FormatError, ParameterError
from tree_sway.files.wind.compass import degrees_of
from tree_sway.files.wind.wind_file import read_wind

N = 6
HALF = timedelta(minutes=30)
SPEEDS = 4.0 + 0.5 * np.arange(N)
MILE, KNOT = 0.44704, 1852.0 / 3600.0
BEGIN = datetime(2024, 3, 1, 22, 0)
"""Two hours before midnight, so that dates and 12-hour clocks pass it."""


def rows(row: Callable[[datetime, float], str], minutes: int = 30) -> str:
    times = [BEGIN + timedelta(minutes=minutes * k) for k in range(N)]
    return '\n'.join(row(time, speed) for time, speed in zip(times, SPEEDS.tolist(), strict=True))


def twelve(time: datetime) -> str:
    """Date and time as WeatherLink.com writes them."""
    return f'{time.month}/{time.day}/{time:%y} {int(time.strftime("%I"))}:{time:%M} {time:%p}'


def records(make: Callable[[datetime, float], Any]) -> list[Any]:
    return [make(BEGIN + timedelta(minutes=30 * k), u) for k, u in enumerate(SPEEDS.tolist())]


def seconds(time: datetime) -> int:
    return int((time - datetime(1970, 1, 1)).total_seconds())


CSV = {
    'FLUXNET, gap-filled': 'TIMESTAMP_START,TIMESTAMP_END,TA_F,WS_F,WS_F_QC,WD,USTAR\n'
    + rows(lambda t, u: f'{t:%Y%m%d%H%M},{t + HALF:%Y%m%d%H%M},3.1,{u:.4f},0,270,0.3'),
    'AmeriFlux and ICOS, by place': 'TIMESTAMP_START,TIMESTAMP_END,WS_1_1_1,WS_2_1_1,WD_1_1_1\n'
    + rows(lambda t, u: f'{t:%Y%m%d%H%M},{t + HALF:%Y%m%d%H%M},{u:.4f},{u / 2:.4f},270'),
    'Ecowitt in German': 'Zeit,Windgeschwindigkeit(km/h),Böe(km/h),Windrichtung(º)\n'
    + rows(lambda t, u: f'{t:%Y-%m-%d %H:%M},{3.6 * u:.4f},{7.2 * u:.4f},270'),
    'a French station': 'Date;Vent moyen (km/h);Direction du vent;Rafale max (km/h)\n'
    + rows(lambda t, u: f'{t:%d/%m/%Y %H:%M};{3.6 * u:.4f};270;{7.2 * u:.4f}'),
    'Davis, WeatherLink.com': '"Garden","Vantage Pro2"\n"Berlin"\n\n\n\n'
    '"Date & Time","Temp - °F","Avg Wind Speed - mph","Prevailing Wind Direction",'
    '"High Wind Speed - mph"\n'
    + rows(lambda t, u: f'"{twelve(t)}","41.2","{u / MILE:.4f}","W","{2 * u / MILE:.4f}"'),
    'Davis in km/h, calm without a direction': '"Date & Time","Avg Wind Speed - km/h",'
    '"Prevailing Dir","High Wind Speed - km/h"\n'
    + rows(lambda t, u: f'"{twelve(t)}","{3.6 * u:.4f}","W","{7.2 * u:.4f}"'),
    'Weather Underground': 'Time,Temperature,WindDirection,WindDirectionDegrees,WindSpeedMPH,'
    'WindSpeedGustMPH\n'
    + rows(lambda t, u: f'{t:%Y-%m-%d %H:%M:%S},41,West,270,{u / MILE:.4f},{2 * u / MILE:.4f}'),
    'Netatmo': 'Name;Long;Lat;ModuleName;ModuleType\nHome;13.4;52.5;Anemometer;Wind\n'
    'Timestamp;"Timezone : Europe/Berlin";WindStrength;WindAngle;GustStrength;GustAngle\n'
    + rows(lambda t, u: f'{seconds(t)};"{t:%Y/%m/%d %H:%M}";{3.6 * u:.4f};270;{7.2 * u:.2f};270'),
    'Ecowitt': 'Time,Outdoor Temperature(℃),Wind Speed(km/h),Wind Gust(km/h),Wind Direction(º)\n'
    + rows(lambda t, u: f'{t:%Y-%m-%d %H:%M},4.1,{3.6 * u:.4f},{7.2 * u:.4f},270'),
    'Ecowitt, knots, groups of columns': 'Time,Wind_Wind Speed(knots),Wind_Wind Gust(knots),'
    'Wind_Wind Direction(º)\n'
    + rows(lambda t, u: f'{t:%Y-%m-%d %H:%M},{u / KNOT:.4f},{2 * u / KNOT:.4f},270'),
    'Ambient Weather': '"Date","Simple Date","Wind Direction (°)","Wind Speed (mph)",'
    '"Wind Gust (mph)"\n'
    + rows(lambda t, u: f'"{t:%Y-%m-%dT%H:%M:%S}-05:00","{t:%Y-%m-%d %H:%M}",270,{u / MILE:.4f},'),
    'NOAA, ISD': '"STATION","DATE","SOURCE","WND","OC1"\n'
    + rows(
        lambda t, u: f'"10384099999","{t:%Y-%m-%dT%H:%M:%S}","4","270,1,N,{10 * u:04.0f},1",'
        f'"{20 * u:04.0f},1"'
    ),
    'NOAA, ISD-Lite': rows(
        lambda t, u: f'{t:%Y %m %d %H}    41    10 10200   270 {10 * u:5.0f}     8 -9999 -9999', 60
    ),
    'NOAA, buoys': '#YY  MM DD hh mm WDIR WSPD GST  WVHT\n#yr  mo dy hr mn degT m/s  m/s     m\n'
    + rows(lambda t, u: f'{t:%Y %m %d %H %M} 270 {u:.1f} {2 * u:.1f} 99.00'),
    'Home Assistant with its unit': 'entity_id,state,last_changed\n'
    + rows(
        lambda t, u: f'sensor.garden_wind_direction,270,{t:%Y-%m-%dT%H:%M:%S}.000Z\n'
        f'sensor.garden_wind_speed,{u:.3f},{t:%Y-%m-%dT%H:%M:%S}.000Z'
    ),
    'InfluxDB, annotated': '#group,false,false,false,false,true,true\n'
    '#datatype,string,long,dateTime:RFC3339,double,string,string\n#default,_result,,,,,\n'
    ',result,table,_time,_value,_field,_measurement\n'
    + rows(lambda t, u: f',,0,{t:%Y-%m-%dT%H:%M:%SZ},{u:.3f},wind_speed,weather')
    + '\n\n,result,table,_time,_value,_field,_measurement\n'
    + rows(lambda t, u: f',,1,{t:%Y-%m-%dT%H:%M:%SZ},270,wind_direction,weather'),
    'InfluxDB, command line': 'name,time,wind_dir_deg,wind_speed\n'
    + rows(lambda t, u: f'weather,{seconds(t)}000000000,270,{u:.3f}'),
    'DWD': 'STATIONS_ID;MESS_DATUM;QN_3;   F;   D;eor\n'
    + rows(lambda t, u: f'        403;{t:%Y%m%d%H};   10;   {u:.2f}; 270;eor', 60),
    'DWD, extreme wind': 'STATIONS_ID;MESS_DATUM;  QN;FF_10;DD_10;FX_10;eor\n'
    + rows(lambda t, u: f'403;{t:%Y%m%d%H%M};    3;  {u:.2f};  270; {2 * u:.2f};eor', 10),
    'IEM, airports': 'station,valid,drct,sknt,gust\n'
    + rows(lambda t, u: f'DSM,{t:%Y-%m-%d %H:%M},270.00,{u / KNOT:.4f},M'),
    'KNMI': '# BRON: KNMI\n# DD = Windrichting\n# STN,YYYYMMDD,   HH,   DD,   FH,   FF,   FX\n'
    + rows(
        lambda t, u: f'  260,{t:%Y%m%d},   {t.hour or 24},  270,   40, {10 * u:4.0f},   80'
        if t.hour
        else f'  260,{t - timedelta(days=1):%Y%m%d},   24,  270,   40, {10 * u:4.0f},   80',
        60,
    ),
    'NREL, MIDC': 'DATE (MM/DD/YYYY),MST,Avg Wind Speed @ 6ft [m/s],Avg Wind Direction @ 6ft '
    '[deg from N]\n' + rows(lambda t, u: f'{t:%m/%d/%Y,%H:%M},{u:.3f},270'),
    'HOBO': '"Plot Title: mast"\n"#","Date Time, GMT+00:00","Wind Speed, m/s (LGR S/N: 1)",'
    '"Gust Speed, m/s (LGR S/N: 1)","Wind Direction, ø (LGR S/N: 1)"\n'
    + rows(lambda t, u: f'1,{t:%m/%d/%y %I:%M:%S %p},{u:.3f},{2 * u:.2f},270'),
    'FLUXNET': 'TIMESTAMP_START,TIMESTAMP_END,WS,WD\n'
    + rows(lambda t, u: f'{t:%Y%m%d%H%M},{t:%Y%m%d%H%M},{u:.3f},270'),
    'Meteostat': 'date,hour,temp,wdir,wspd,wpgt\n'
    + rows(lambda t, u: f'{t:%Y-%m-%d},{t.hour},8,270,{3.6 * u:.4f},', 60),
    'Environment Canada': '"Station Name","Date/Time (LST)","Wind Dir (10s deg)",'
    '"Wind Spd (km/h)"\n'
    + rows(lambda t, u: f'"OTTAWA","{t:%Y-%m-%d %H:%M}","27","{3.6 * u:.4f}"'),
    'Météo-France': 'NUM_POSTE;NOM_USUEL;AAAAMMJJHH;FF;DD;FXI\n'
    + rows(lambda t, u: f'75114001;PARIS;{t:%Y%m%d%H};{u:.3f};270;{2 * u:.2f}', 60),
    'MeteoSwiss': 'station_abbr;reference_timestamp;fkl010z0;dkl010z0;fkl010z1\n'
    + rows(lambda t, u: f'BER;{t:%d.%m.%Y %H:%M};{u:.3f};270;{2 * u:.2f}', 10),
    'GeoSphere Austria': 'time,station,DD,FF,FFX\n'
    + rows(lambda t, u: f'{t:%Y-%m-%dT%H:%M}+00:00,11035,270.0,{u:.3f},{2 * u:.2f}', 10),
    'Weathercloud': 'Date (Europe/Berlin);Wind speed (m/s);Wind direction (°);Wind gust (m/s)\n'
    + rows(lambda t, u: f'{t:%Y-%m-%d %H:%M:%S};{u:.3f};270;{2 * u:.2f}', 10),
    'WeeWX': 'dateTime,usUnits,interval,windSpeed,windDir,windGust\n'
    + rows(lambda t, u: f'{seconds(t)},1,5,{u / MILE:.4f},270.0,{2 * u / MILE:.4f}', 5),
    'Synoptic, a row of units': '# STATION: BNDC1\n# ELEVATION [ft]: 2598\n'
    'Station_ID,Date_Time,air_temp_set_1,wind_speed_set_1,wind_direction_set_1,wind_gust_set_1\n'
    ',,Fahrenheit,Miles/hour,Degrees,Miles/hour\n'
    + rows(lambda t, u: f'BNDC1,{t:%m/%d/%Y %H:%M} UTC,60,{u / MILE:.4f},270.0,{2 * u:.2f}'),
    'NASA POWER': '-BEGIN HEADER-\nLocation: latitude  52.5   longitude 13.4\n'
    'WD10M     MERRA-2 Wind Direction at 10 Meters (Degrees)\n-END HEADER-\n'
    'YEAR,MO,DY,HR,WS10M,WD10M\n'
    + rows(lambda t, u: f'{t.year},{t.month},{t.day},{t.hour},{u:.3f},270', 60),
    'SMHI': 'Stationsnamn;Klimatnummer;Mäthöjd (meter över marken)\nStockholm;98230;10.0\n\n'
    'Datum;Tid (UTC);Vindriktning;Kvalitet;Vindhastighet;Kvalitet;;Tidsutsnitt:\n'
    + rows(lambda t, u: f'{t:%Y-%m-%d};{t:%H:%M:%S};270;G;{u:.3f};G;;', 60),
    'Met Éireann': 'Station Name: DUBLIN AIRPORT\n\nwdsp:   -  Mean Hourly Wind Speed (kt)\n\n'
    'date,ind,rain,ind,temp,ind,wdsp,ind,wddir,ww\n'
    + rows(lambda t, u: f'{t:%d-%b-%Y %H:%M},0,0,0,7,2,{u / KNOT:.4f},2,270,6'.lower(), 60),
    'Met Office, MIDAS': 'Conventions,G,BADC-CSV,1\ntitle,G,uk-hourly-weather-obs\n'
    'long_name,wind_speed,wind speed,knots\ntype,wind_speed,float\ndata\n'
    'ob_time,id,wind_speed_unit_id,wind_direction,wind_speed,temp\n'
    + rows(lambda t, u: f'{t:%Y-%m-%d %H:%M:%S},708,4,270,{u / KNOT:.4f},NA', 60)
    + '\nend data\n',
    'Campbell Scientific': '"TOA5","CR1000","CR1000","1","x","y","1","Table10"\n'
    '"TIMESTAMP","RECORD","WS_ms_S_WVT","WindDir_D1_WVT","WindDir_SD1_WVT","WS_ms_Max"\n'
    '"TS","RN","meters/second","Deg","Deg","meters/second"\n"","","WVc","WVc","WVc","Max"\n'
    + rows(lambda t, u: f'"{t:%Y-%m-%d %H:%M:%S}",1,{u:.3f},270,12,{2 * u:.2f}', 10),
    'CIMIS, California': 'Stn Id,Date,Hour (PST),Jul,Wind Speed (mph),qc,Wind Dir (0-360),qc\n'
    + rows(lambda t, u: f'2,{t:%m/%d/%Y},{t:%H%M},61,{u / MILE:.4f}, ,270, ', 60),
    'ISD as R reads it': 'USAFID,WBAN,year,month,day,hour,min,wind.dir,wind.dir.qc,wind.sp\n'
    + rows(lambda t, u: f'1,2,{t.year},{t.month},{t.day},{t.hour},0,270,5,{u:.3f}', 60),
    'EasyWeather': 'NO.,Time,Interval,Outdoor Temperature(°C),Wind Speed(m/s),Gust Speed(m/s),'
    'Wind Direction\n'
    + rows(lambda t, u: f'1,{t:%d-%m-%Y %H:%M},30,8.1,{u:.3f},{2 * u:.2f},W'),
    'Tempest': 'device_id,timestamp,wind_lull,wind_avg,wind_gust,wind_dir,wind_interval\n'
    + rows(lambda t, u: f'1,{seconds(t)},1,{u:.3f},{2 * u:.2f},270,3', 5),
    'Met Office, WOW': 'Id,Site Id,Report Date / Time,Wind Speed (Knots),Wind Direction (Deg)\n'
    + rows(lambda t, u: f'1,2,{t:%d/%m/%Y %H:%M:%S},{u / KNOT:.4f},270', 10),
    'AWEKAS, decimal commas': 'Datum;Uhrzeit;Windgeschwindigkeit (km/h);Windrichtung (°)\n'
    + rows(lambda t, u: f'{t:%d.%m.%Y};{t:%H:%M};{3.6 * u:.2f};270'.replace('.', ','), 10).replace(
        ',03,2024', '.03.2024'
    ),
    'Zurich, water police': 'timestamp_utc,timestamp_cet,wind_gust_max_10min,'
    'wind_speed_avg_10min,wind_force_avg_10min,wind_direction\n'
    + rows(
        lambda t, u: f'{t:%Y-%m-%dT%H:%M:%S}+00:00,{t + timedelta(hours=1):%Y-%m-%dT%H:%M:%S}'
        f'+01:00,{2 * u:.2f},{u:.3f},3,270',
        10,
    ),
    'NREL, TMY3': '724940,"SAN FRANCISCO INTL AP",CA,-8.0,37.62,-122.4,2\n'
    'Date (MM/DD/YYYY),Time (HH:MM),GHI (W/m^2),Wdir (degrees),Wspd (m/s)\n'
    + rows(lambda t, u: f'{t:%m/%d/%Y},{t:%H:%M},0,270,{u:.3f}', 60),
    'EnergyPlus': 'LOCATION,Berlin,-,DEU,IWEC Data,103840,52.47,13.40,1.0,49.0\n'
    'DESIGN CONDITIONS,0\nTYPICAL/EXTREME PERIODS,0\nGROUND TEMPERATURES,0\n'
    'HOLIDAYS/DAYLIGHT SAVINGS,No,0,0,0\nCOMMENTS 1,made\nCOMMENTS 2,up\n'
    'DATA PERIODS,1,1,Data,Friday,3/1,3/2\n'
    + rows(
        lambda t, u: f'{t - timedelta(hours=1):%Y,%m,%d},{(t.hour - 1) % 24 + 1},60,?9,8.1,5.0,80,'
        f'101325{",0" * 10},270,{u:.1f},5,5,20,7700,9,999999999,10,0,0,88',
        60,
    ),
    'CWA, Taiwan, with hours to 24 and a row of names below': 'ObsTime,StnPres,WS,WD,WSGust\n'
    '觀測時間(hour),測站氣壓(hPa),風速(m/s),風向(360degree),最大瞬間風(m/s)\n'
    + rows(
        lambda t, u: f'{t - timedelta(hours=1):%Y-%m-%d} {(t.hour - 1) % 24 + 1:02d}:00,1008.1,'
        f'{u:.2f},270,{2 * u:.2f}',
        60,
    ),
    'AEMET, points in words': 'Estación;Fecha y hora;Temperatura (ºC);'
    'Velocidad del viento (km/h);Dirección del viento;Racha (km/h)\n'
    + rows(lambda t, u: f'Madrid;{t:%d/%m/%Y %H:%M};8;{3.6 * u:.2f};Oeste;{7.2 * u:.1f}', 60),
    'INMET, Brazil': 'REGIAO:;SE\nESTACAO:;SAO PAULO - MIRANTE\nLATITUDE:;-23,49\n'
    'Data;Hora UTC;TEMPERATURA DO AR - BULBO SECO, HORARIA (°C);'
    'VENTO, DIREÇÃO HORARIA (gr) (° (gr));VENTO, RAJADA MAXIMA (m/s);'
    'VENTO, VELOCIDADE HORARIA (m/s);\n'
    + rows(
        lambda t, u: f'{t:%Y/%m/%d};{t:%H}00 UTC;8,1;270;{2 * u:.1f};{u:.1f};'.replace('.', ','),
        60,
    ),
    'Cumulus, realtime.txt': rows(
        lambda t, u: f'{t:%d/%m/%y %H:%M:%S} 8.4 84 5.8 {3.6 * u:.2f} {4 * u:.1f} 270 0.0 1.0 '
        f'999.7 W 3 km/h C hPa mm {"1 " * 23}{7.2 * u:.2f} 10.3 10.5'
    ),
    'a hash before the header': '# Time, Temp (C), Wind Speed (m/s), Wind Dir (deg)\n'
    + rows(lambda t, u: f'{t:%Y-%m-%d %H:%M:%S}, 20.1, {u:.3f}, 270', 5),
}  # fmt: skip

JSON = {
    'Open-Meteo': {
        'latitude': 52.52, 'utc_offset_seconds': 0, 'timezone': 'GMT',
        'hourly_units': {'time': 'iso8601', 'wind_speed_10m': 'km/h', 'wind_direction_10m': '°'},
        'hourly': {
            'time': records(lambda t, u: f'{t:%Y-%m-%dT%H:%M}'),
            'wind_speed_10m': records(lambda t, u: 3.6 * u),
            'wind_direction_10m': [270] * N,
        },
    },
    'weather.com, stations': {
        'observations': records(lambda t, u: {
            'stationID': 'IBERLIN1', 'obsTimeUtc': f'{t:%Y-%m-%dT%H:%M:%SZ}', 'epoch': seconds(t),
            'winddirAvg': 270,
            'metric': {'windspeedAvg': 3.6 * u, 'windspeedHigh': 9 * u, 'windgustHigh': 7.2 * u},
        })
    },
    'weather.com, airports': {
        'metadata': {'units': 'e', 'status_code': 200},
        'observations': records(lambda t, u: {
            'valid_time_gmt': seconds(t), 'wdir': 270, 'wspd': u / MILE, 'gust': None,
        }),
    },
    'Ecowitt': {'code': 0, 'data': {'wind': {
        'wind_speed': {'unit': 'mph', 'list': dict(
            records(lambda t, u: (str(seconds(t)), f'{u / MILE:.4f}')))},
        'wind_direction': {'unit': 'º', 'list': dict(
            records(lambda t, u: (str(seconds(t)), '270')))},
    }}},
    'Home Assistant': [
        records(lambda t, u: {
            'entity_id': 'sensor.wind_speed', 'state': str(3.6 * u),
            'last_changed': f'{t:%Y-%m-%dT%H:%M:%S}+00:00',
            'attributes': {'unit_of_measurement': 'km/h'},
        }),
        records(lambda t, u: {
            'entity_id': 'sensor.wind_direction', 'state': '270',
            'last_changed': f'{t:%Y-%m-%dT%H:%M:%S}+00:00',
            'attributes': {'unit_of_measurement': '°'},
        }),
    ],
    'US weather service': {'features': records(lambda t, u: {'properties': {
        'timestamp': f'{t:%Y-%m-%dT%H:%M:%S}+00:00',
        'windSpeed': {'unitCode': 'wmoUnit:km_h-1', 'value': 3.6 * u},
        'windDirection': {'unitCode': 'wmoUnit:degree_(angle)', 'value': 270},
    }})},
    'Bureau of Meteorology': {'observations': {'data': records(lambda t, u: {
        'local_date_time_full': f'{t:%Y%m%d%H%M%S}', 'wind_dir': 'W', 'wind_spd_kmh': 3.6 * u,
        'gust_kmh': 7.2 * u,
    })}},
    'AEMET': records(lambda t, u: {
        'idema': '3195', 'fint': f'{t:%Y-%m-%dT%H:%M:%S}+0000', 'vv': u, 'dv': 270, 'vmax': 2 * u,
    }),
    'OpenWeather': {'list': records(lambda t, u: {
        'dt': seconds(t), 'wind': {'speed': u, 'deg': 270, 'gust': 2 * u},
    })},
}  # fmt: skip
LOCAL = {
    'Ambient Weather': 5.0,
    'Weathercloud': -1.0,
    'NREL, MIDC': 7.0,
    'CIMIS, California': 8.0,
    'EnergyPlus': -1.0,
    'New Zealand, CliFlo': -12.0,
}
"""Hours from the clock of a file to UTC, where the file says its zone."""


@pytest.mark.parametrize('name', [*CSV, *(f'{name}: JSON' for name in JSON)])
def test_a_station_file_is_read_as_it_is(name: str, tmp_path: Path) -> None:
    if name.endswith(': JSON'):
        name = name.removesuffix(': JSON')
        path = tmp_path / 'station.json'
        path.write_text(json.dumps(JSON[name]), encoding='utf-8')
    else:
        path = tmp_path / 'station.csv'
        path.write_text(CSV[name], encoding='utf-8')
    options = {'speed_unit': 'm/s'} if name == 'Home Assistant with its unit' else {}
    record = read_wind(path, turbulence=False, **options)
    assert record.refused == 0, record.first_refused
    assert len(record.time) == N
    np.testing.assert_allclose(record.velocity[:, 0], SPEEDS, atol=0.06)
    np.testing.assert_allclose(record.velocity[:, 1:], 0.0, atol=1e-9)
    steps = np.diff(record.time)
    np.testing.assert_allclose(steps, steps[0])
    assert steps[0] in (300.0, 600.0, 1800.0, 3600.0)
    begin = seconds(BEGIN) + 3600.0 * LOCAL.get(name, 0.0)
    assert record.epoch == pytest.approx(begin)


REFUSED = {
    'Home Assistant': (
        CSV['Home Assistant with its unit'],
        'Home Assistant does not say the unit of the speed; give it: --wind-option speed_unit',
    ),
    'NOAA, local data': (
        'STATION,DATE,HourlyWindDirection,HourlyWindSpeed\n1,2024-03-01T00:00,270,9\n',
        'Local Climatological Data does not say the unit of the speed; give it: --wind-option',
    ),
    'NOAA, days': (
        'STATION,DATE,WDSP,MXSPD,GUST\n10384099999,2024-03-01,8.1,14.0,22.9\n',
        'no column for the direction among STATION',
    ),
    'a cup anemometer': (
        'time,wind speed (m/s)\n2024-03-01T00:00,4\n2024-03-01T00:01,5\n',
        r'no column for the direction among .*; call it direction \[deg\].*direction=270',
    ),
    'JSON without wind': ('{"hourly": {"time": ["2024-03-01T00:00"], "wind": [3]}}', 'direction'),
    'JSON that is cut': ('{"hourly": {"time": ["2024-03-01T00:00"], "wind": [3', 'not JSON'),
    'another unit': (
        'time,wind speed (Bft),direction\n2024-03-01T00:00,4,270\n',
        "unknown unit 'Bft'; use m/s",
    ),
}


@pytest.mark.parametrize('name', REFUSED)
def test_what_a_file_lacks_is_named(name: str, tmp_path: Path) -> None:
    text, reason = REFUSED[name]
    path = tmp_path / ('a.json' if text.startswith('{') else 'a.csv')
    path.write_text(text, encoding='utf-8')
    with pytest.raises(FormatError, match=reason):
        read_wind(path)


STATE = {'entity_id': 'sensor.wind_speed', 'state': '3', 'last_changed': '2024-03-01T00:00:00Z'}


@pytest.mark.parametrize('damaged', [[[STATE, 5]], [7, [STATE]], [[{**STATE, 'entity_id': {}}]]])
def test_states_that_are_damaged_are_refused(damaged: list, tmp_path: Path) -> None:
    path = tmp_path / 'states.json'
    path.write_text(json.dumps(damaged), encoding='utf-8')
    with pytest.raises(FormatError, match='direction'):
        read_wind(path)


def test_a_speed_alone_blows_from_where_it_is_told(tmp_path: Path) -> None:
    path = tmp_path / 'cup.csv'
    path.write_text('time,wind speed (km/h)\n0,36\n1,18\n')
    record = read_wind(path, direction=180.0)
    np.testing.assert_allclose(record.velocity, [[0, 10, 0], [0, 5, 0]], atol=1e-12)
    with pytest.raises(ParameterError, match='direction is 400 degrees; give 0 to 360'):
        read_wind(path, direction=400.0)


def test_a_speed_without_a_unit_is_said(tmp_path: Path) -> None:
    path = tmp_path / 'a.csv'
    path.write_text('time,speed,direction\n0,10,270\n1,10,270\n')
    assert 'taken in m/s' in read_wind(path).notes[0]
    given = read_wind(path, speed_unit='kn')
    assert given.velocity[0, 0] == pytest.approx(10.0 * KNOT)
    with pytest.raises(ParameterError, match="speed_unit is 'Bft'"):
        read_wind(path, speed_unit='Bft')


def test_the_old_text_of_weatherlink(tmp_path: Path) -> None:
    def row(time: datetime, speed: float) -> str:
        half = 'a' if time.hour < 12 else 'p'
        date = f'{time.month}/{time.day:02d}/{time:%y}'
        at = f'{int(time.strftime("%I"))}:{time:%M}{half}'
        wind = f'{speed / MILE:.4f}\tW\t12.00\t{2 * speed / MILE:.3f}\tW'
        return f'{date}\t{at}\t41.2\t{wind}\t29.9'

    path = tmp_path / 'download.txt'
    names = (
        '\t\tTemp\tWind\tWind\tWind\tHi\tHi\t\nDate\tTime\tOut\tSpeed\tDir\tRun\tSpeed\tDir\tBar\n'
    )
    path.write_text(names + rows(row, 30))
    with pytest.raises(FormatError, match='WeatherLink for Windows does not say the unit'):
        read_wind(path)
    record = read_wind(path, speed_unit='mph', turbulence=False)
    np.testing.assert_allclose(record.velocity[:, 0], SPEEDS, atol=0.01)
    assert record.duration == 1800.0 * (N - 1)


@pytest.mark.parametrize('separator', [',', ';'])
def test_the_log_of_cumulus(separator: str, tmp_path: Path) -> None:
    def row(time: datetime, speed: float) -> str:
        wind = [f'{speed / MILE:.4f}', f'{2 * speed / MILE:.3f}', '270']
        cells = ['8.4', '84', '5.8', *wind, *['0.0'] * 15]
        if separator == ';':
            cells = [cell.replace('.', ',') for cell in cells]
        return separator.join([f'{time:%d/%m/%y}', f'{time:%H:%M}', *cells])

    path = tmp_path / 'Mar24log.txt'
    path.write_text(f'{rows(row, 10)}\n01/03/24 broken\n')
    with pytest.raises(FormatError, match='a file of Cumulus does not say the unit of the speed'):
        read_wind(path)
    record = read_wind(path, speed_unit='mph', turbulence=False)
    np.testing.assert_allclose(record.velocity[:, 0], SPEEDS, atol=0.01)
    np.testing.assert_allclose(record.velocity[:, 1:], 0.0, atol=1e-9)
    assert record.time.tolist() == [600.0 * k for k in range(N)]
    assert record.epoch == seconds(BEGIN)
    assert record.refused == 1


@pytest.mark.parametrize('encoding', ['cp1252', 'utf-16', 'utf-8-sig'])
def test_encodings_of_spreadsheets(encoding: str, tmp_path: Path) -> None:
    path = tmp_path / 'a.csv'
    text = 'Time;Wind Speed(m/s);Wind Direction(°)\n2024-03-01 00:00;4,5;270\n'
    path.write_bytes((text + '2024-03-01 00:00:01;5,5;270\n').encode(encoding))
    np.testing.assert_allclose(read_wind(path).velocity[:, 0], [4.5, 5.5])


@pytest.mark.parametrize(
    ('points', 'expected'),
    [
        (['N', 'nnw', 'West', 'north-east'], [0, 337.5, 270, 45]),
        (['NO', 'SSW', 'O'], [45, 202.5, 90]),
        (['NO', 'SE', 'OSO'], [315, 135, 247.5]),
        (['NO', 'SO'], [np.nan, np.nan]),
        (['---', '', 'VRB'], [np.nan] * 3),
        (['270', '90°'], [270, 90]),
        (['Noroeste', 'Sur', 'Este', 'Nord-Ouest', 'Südwest'], [315, 180, 90, 315, 225]),
    ],
)
def test_points_of_the_compass(points: list[str], expected: list[float]) -> None:
    np.testing.assert_allclose(degrees_of(points), expected)


def test_a_calm_needs_no_direction(tmp_path: Path) -> None:
    path = tmp_path / 'a.csv'
    path.write_text('time,speed,dir\n0,0,---\n1,3,W\n2,3,---\n')
    record = read_wind(path)
    np.testing.assert_allclose(record.velocity[:, 0], [0, 3])
    assert (
        record.first_refused == "line 4: dir is '---', neither degrees nor a point of the compass"
    )


@pytest.mark.parametrize(
    ('stamps', 'step'),
    [
        (('1/2/24 11:30 PM', '1/3/24 12:00 AM'), 1800),
        (('13/1/2024 23:00', '14/1/2024 00:00'), 3600),
        (('2024-02-28 24:00', '2024-02-29 24:00'), 86400),
        (('3/1/2024 12:00 AM', '3/1/2024 12:00 PM'), 43200),
        (('31.12.2023 23:59:59', '01.01.2024 00:00:00'), 1),
        (('01-Mar-2024 00:00', '01-Mar-2024 00:10'), 600),
        (('Mar 1, 2024 9:00 a.m.', 'Mar 1, 2024 9:05 a.m.'), 300),
        (('2024-03-01T00:00+01:00', '2024-03-01T00:00+00'), 3600),
        (('1709251200', '1709251800'), 600),
        (('1709251200000', '1709251800000'), 600),
    ],
)
def test_dates_of_all_kinds(stamps: tuple[str, str], step: float, tmp_path: Path) -> None:
    path = tmp_path / 'a.csv'
    path.write_text('\n'.join(['time;u;v', *(f'{stamp};1;2' for stamp in stamps)]))
    record = read_wind(path, turbulence=False)
    assert record.time.tolist() == [0.0, step]


def test_a_column_called_wind_has_points_or_a_speed(tmp_path: Path) -> None:
    """As on the page of a station at Weather Underground, with units in the cells."""
    path = tmp_path / 'station.csv'
    path.write_text(
        'Time,Temperature,Dew Point,Humidity,Wind,Speed,Gust,Pressure\n'
        '12:04 AM,50.1 °F,45.3 °F,84 %,West,4.2 mph,6.5 mph,29.91 in\n'
        '12:09 AM,50.0 °F,45.3 °F,84 %,WSW,5.1 mph,7.8 mph,29.91 in\n',
        encoding='utf-8',
    )
    record = read_wind(path, turbulence=False)
    assert record.velocity[0] == pytest.approx([4.2 * MILE, 0.0, 0.0], abs=1e-6)
    assert record.time.tolist() == [0.0, 300.0]


def test_a_clock_without_dates_begins_anew_at_midnight(tmp_path: Path) -> None:
    path = tmp_path / 'station.csv'
    clocks = ('11:55 PM', '11:58 PM', '12:01 AM', '12:04 AM')
    lines = [f'{clock},5,270' for clock in clocks]
    path.write_text('\n'.join(['time,speed [m/s],direction', *lines]) + '\n')
    record = read_wind(path, turbulence=False)
    assert record.time.tolist() == [0.0, 180.0, 360.0, 540.0]
    assert record.epoch is None
    assert 'no date' in ' '.join(record.notes)


def test_rows_may_be_newest_first(tmp_path: Path) -> None:
    path = tmp_path / 'station.csv'
    lines = [f'2026-11-01 00:{m:02d}:00,{m},270' for m in (10, 5, 0)]
    path.write_text('\n'.join(['time,speed [m/s],direction', *lines]) + '\n')
    record = read_wind(path, turbulence=False)
    assert record.time.tolist() == [0.0, 300.0, 600.0]
    assert record.velocity[:, 0] == pytest.approx([0.0, 5.0, 10.0])
    assert record.refused == 0
    forward = tmp_path / 'forward.csv'
    forward.write_text('\n'.join(['time,speed [m/s],direction', *lines[::-1]]) + '\n')
    assert record.epoch == read_wind(forward, turbulence=False).epoch


#: Hours of 4, 4.5 and 5 m/s from the west, from `BEGIN` on.
HOURS = {
    'Korea': (
        '지점,지점명,일시,기온(°C),풍속(m/s),풍향(16방위)\n108,서울,2024-03-01 22:00,3.1,4.0,270\n'
        '108,서울,2024-03-01 23:00,3.0,4.5,270\n108,서울,2024-03-02 00:00,3.0,5.0,270\n'
    ),
    'Finland': (
        'Havaintoasema,Vuosi,Kuukausi,Päivä,Aika [Paikallinen aika],Keskituulen nopeus [m/s],'
        'Tuulen suunnan keskiarvo [°]\nHelsinki Kaisaniemi,2024,3,1,22:00,4.0,270\n'
        'Helsinki Kaisaniemi,2024,3,1,23:00,4.5,270\nHelsinki Kaisaniemi,2024,3,2,00:00,5.0,270\n'
    ),
    'Norway, with a remark below': (
        'Navn;Stasjon;Tid(norsk normaltid);Middelvind;Vindretning\n'
        'Oslo - Blindern;SN18700;01.03.2024 22:00;4,0;270\n'
        'Oslo - Blindern;SN18700;01.03.2024 23:00;4,5;270\n'
        'Oslo - Blindern;SN18700;02.03.2024 00:00;5,0;270\n'
        'Data er gyldig per 05.03.2024 (CC BY 4.0), Meteorologisk institutt (MET);;;;\n'
    ),
    'New Zealand, CliFlo': (
        'Station information:\nName,Agent Number,Latitude (dec.deg),Longitude (dec.deg)\n'
        'Wellington Aero,3445,-41.322,174.804\n\nSurface Wind: Hourly\n'
        'Station,Date(NZST),Dir(DegT),Speed(m/s),Dir StdDev,Spd StdDev,Period(Hrs),Freq\n'
        'Wellington Aero,20240301:2200,270,4.0,10,1.0,1,H\n'
        'Wellington Aero,20240301:2300,270,4.5,10,1.0,1,H\n'
        'Wellington Aero,20240302:0000,270,5.0,10,1.0,1,H\n\nUserName is = x\n'
    ),
    'Spain, SIAR': (
        'IdProvincia;IdEstacion;Fecha;HoraMin;VelViento (m/s);DirViento (º)\n'
        '28;1;01/03/2024;2200;4,0;270\n28;1;01/03/2024;2300;4,5;270\n28;1;02/03/2024;0;5,0;270\n'
    ),
    'meteoblue, in km/h': (
        'location,Basel,Basel,Basel\nlat,47.56,47.56,47.56\nvariable,Wind Speed,Wind Direction,'
        'Wind Gust\nunit,km/h,°,km/h\nlevel,10 m,10 m,sfc\nresolution,hourly,hourly,hourly\n'
        'timestamp,Basel Wind Speed [10 m],Basel Wind Direction [10 m],Basel Wind Gust\n'
        '20240301T2200,14.4,270,30\n20240301T2300,16.2,270,33\n20240302T0000,18.0,270,36\n'
    ),
    'Kestrel': (
        'FORMATTED DATE_TIME,Temperature,Wind Speed,Compass Magnetic Direction,'
        'Compass True Direction,Crosswind\nyyyy-mm-dd hh:mm:ss,°C,km/h,Deg,Deg,km/h\n'
        '2024-03-01 10:00:00 PM,3,14.4,266,270,0\n2024-03-01 11:00:00 PM,3,16.2,266,270,0\n'
        '2024-03-02 12:00:00 AM,3,18.0,266,270,0\n'
    ),
    'METER ZL6': (
        'z6-1234,ATMOS 41,ATMOS 41,ATMOS 41\n'
        'Timestamp, m/s Wind Speed,° Wind Direction, m/s Gust Speed\n'
        '2024-03-01 22:00:00,4.0,270,8\n'
        '2024-03-01 23:00:00,4.5,270,8\n2024-03-02 00:00:00,5.0,270,8\n'
    ),
}


@pytest.mark.parametrize('name', HOURS)
def test_hours_of_more_services_are_read(name: str, tmp_path: Path) -> None:
    path = tmp_path / 'a.csv'
    path.write_text(HOURS[name], encoding='utf-8')
    record = read_wind(path, turbulence=False)
    np.testing.assert_allclose(record.time, [0.0, 3600.0, 7200.0])
    assert record.epoch == seconds(BEGIN) + 3600.0 * LOCAL.get(name, 0.0)
    expected = [[4.0, 0.0], [4.5, 0.0], [5.0, 0.0]]
    np.testing.assert_allclose(record.velocity[:, :2], expected, atol=1e-9)
    assert record.refused <= 1


def test_hours_of_korea_are_read_in_their_code_page(tmp_path: Path) -> None:
    path = tmp_path / 'a.csv'
    path.write_bytes(HOURS['Korea'].encode('cp949'))
    assert read_wind(path, turbulence=False).velocity[:, 0].tolist() == [4.0, 4.5, 5.0]


JMA_HEAD = (
    'ダウンロードした時刻：2024/03/05 10:20:49\n\n{stations}\n'
    '年月日時,気温(℃),気温(℃),気温(℃),風速(m/s),風速(m/s),風速(m/s),風速(m/s),風速(m/s)\n'
    ',,,,,,風向,風向,\n,,品質情報,均質番号,,品質情報,,品質情報,均質番号\n'
)


def jma(tmp_path: Path, rows: Sequence[str], *stations: str) -> Path:
    """Write hours of JMA in its code page."""
    path = tmp_path / 'data.csv'
    cells = [each for each in stations or ('東京',) for _ in range(8 // len(stations or ('',)))]
    text = JMA_HEAD.format(stations=',' + ','.join(cells)) + '\n'.join(rows) + '\n'
    path.write_bytes(text.replace('\n', '\r\n').encode('cp932'))
    return path


def test_hours_of_japan_are_read_in_their_code_page(tmp_path: Path) -> None:
    """The quality of the second row says that it is missing, a calm has no direction."""
    rows = [
        '2024/3/1 23:00:00,9.1,8,1,4.0,8,西,8,1',
        '2024/3/2 0:00:00,9.0,8,1,7.7,1,西,1,1',
        '2024/3/2 1:00:00,8.8,8,1,3.0,8,北北西,8,1',
        '2024/3/2 2:00:00,8.8,8,1,0.0,8,静穏,8,1',
    ]
    record = read_wind(jma(tmp_path, rows), turbulence=False)
    np.testing.assert_allclose(record.time, [0.0, 7200.0, 10800.0])
    assert record.epoch == seconds(datetime(2024, 3, 1, 14, 0))
    angle = np.radians(337.5)
    expected = [[4.0, 0.0], [-3.0 * np.sin(angle), -3.0 * np.cos(angle)], [0.0, 0.0]]
    np.testing.assert_allclose(record.velocity[:, :2], expected, atol=1e-9)
    assert record.refused == 1


def test_several_stations_of_japan_are_told(tmp_path: Path) -> None:
    row = '2024/3/1 23:00:00,9.1,8,1,4.0,8,西,8,1'
    with pytest.raises(FormatError, match=r'several stations: 東京, 横浜; download one at a time'):
        read_wind(jma(tmp_path, [row], '東京', '横浜'))
