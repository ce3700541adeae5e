# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""
Ten kinds of sources and more, each from its start to a tree that moves, without ROS.

Messages are written after the makers' pages, which the modules of the sources name.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
import json
import math
import struct
import time
from typing import Any
from urllib.parse import urlencode
from urllib.request import Request, urlopen

import numpy as np
import pytest

from test.live.conftest import Broker, Heard, in_a_loop
from tree_sway.core.scene.run import Run
from tree_sway.core.scene.scene_simulator import Simulator
from tree_sway.core.settings import Settings
from tree_sway.core.wind.intake import WindIntake
from tree_sway.errors import ParameterError
from tree_sway.files.trees.source import open_scene
from tree_sway.files.wind import Refusal, WindReading
from tree_sway.files.wind.sensor_line import checksum_of
from tree_sway.live.registry import open_source
from tree_sway.live.transports.transport import Message
from tree_sway.simulation.wind_source import blow

KNOT, MPH = 1852.0 / 3600.0, 0.44704


@pytest.fixture(scope='module')
def tree() -> Simulator:
    return open_scene('goldcrest', 0).simulator(Settings(), model='20')


@pytest.fixture
def sways(tree: Simulator) -> Callable[..., Any]:
    """Step the tree in a live wind, as a page does, until it leans; return the reading."""

    def until_it_leans(
        heard: Heard, meanwhile: Callable[[], object], towards: tuple[float, float]
    ) -> Any:
        tree.reset()
        run = Run(tree, 60.0, intake=WindIntake.of_velocities())
        rest = np.array(tree.place())
        ticks = [0]

        def leans() -> bool:
            for _ in range(6):
                ticks[0] += 1
                blow(run, heard.wind, ticks[0] * run.period)
            moved = (np.array(tree.place()) - rest)[:, :2]
            return bool(np.abs(moved).max() > 1e-3 and (moved @ towards).max() > 1e-3)

        heard.until(leans, meanwhile)
        assert heard.wind.state == 'live'
        assert heard.wind.newest is not None
        return heard.wind.newest

    return until_it_leans


def nmea(body: str) -> bytes:
    return f'${body}*{checksum_of(body)}\r\n'.encode()


GILL = '\x02Q,270,000.08,M,00,\x03'
LINES = [
    ('NMEA MWV', nmea('WIMWV,270.0,R,10.0,N,A'), 10.0 * KNOT),
    ('NMEA MWD', nmea('WIMWD,270.0,T,268.0,M,10.0,N,5.14,M'), 5.14),
    ('NMEA XDR', nmea('WIXDR,A,270,D,0,S,6.0,M,0'), 6.0),
    ('Gill', b'\x02Q,270,006.08,M,00,\x0302\r\n', None),
    ('Vaisala', b'0R1,Dn=236D,Dm=270D,Dx=300D,Sn=0.0M,Sm=6.5M,Sx=9.2M\r\n', 6.5),
    ('Vaisala, composite', b'0R0,Dm=270D,Sm=21.6K,Ta=20.1C,Ua=44.5P\r\n', 6.0),
    ('Young 81000', b'  6.00 270.0   0.0 346.70  25.14\r', 6.0),
    ('Young 85000', b'0 006.2 270 00*', 6.2),
    ('numbers', b'5.3,270\n', 5.3),
    ('a cup', b'5.3\n', 5.3),
    ('name=value', b'wind_speed=19.08 km/h; wind_direction=270\n', 5.3),
    ('compass', b'windSpeed: 5.3 m/s, windDir: W\n', 5.3),
    ('JSON', b'{"wind": {"wind_speed": 5.3, "wind_direction": 270}}\n', 5.3),
    ('OpenWeather', b'{"boat": {"speed": 9}, "wind": {"speed": 5.3, "deg": 270}}\n', 5.3),
    (
        'api.weather.gov',
        b'{"windSpeed": {"unitCode": "wmoUnit:km_h-1", "value": 19.08}, '
        b'"windDirection": {"unitCode": "wmoUnit:degree_(angle)", "value": 270}}\n',
        5.3,
    ),
    ('SDI-12 of Gill', b'0+270+005.30+00\r\n', 5.3),
]


@pytest.mark.parametrize(
    ('line', 'speed'), [each[1:] for each in LINES], ids=[e[0] for e in LINES]
)
def test_lines_of_many_makers_sway_a_tree(hear, send, port, sways, line, speed):
    if line.startswith(b'\x02'):
        line = f'\x02Q,270,006.08,M,00,\x03{checksum_of("Q,270,006.08,M,00,")}\r\n'.encode()
        speed = 6.08
    if line.endswith(b'*'):
        line += checksum_of(line[:-1].decode()).encode() + b'\r'
    heard = hear(f'udp://127.0.0.1:{port}')
    newest = sways(heard, lambda: send(port, line), (1.0, 0.0))
    assert newest.speed == pytest.approx(speed, rel=1e-3)
    velocity = newest.velocity(heard.wind.bearing)
    assert velocity[:2] == pytest.approx((speed, 0.0), abs=1e-3 * speed)


def test_a_serial_port_sways_a_tree(hear, serial_port, sways):
    name, write = serial_port
    newest = sways(
        hear(f'serial:{name}:9600'), lambda: write(nmea('WIMWV,0.0,R,6.0,M,A')), (0.0, -1.0)
    )
    assert (newest.kind, newest.speed) == ('MWV R', 6.0)


def test_components_of_a_sonic_are_read_by_their_columns(hear, send, port, sways):
    heard = hear(f'udp:{port}?columns=u,v,w,-')
    newest = sways(heard, lambda: send(port, b'3.0 4.0 -0.2 21.5\n'), (0.6, 0.8))
    assert newest.velocity(0.0) == pytest.approx((3.0, 4.0, -0.2))


def test_a_cup_blows_from_the_direction_of_the_control(hear, send, port, sways):
    heard = hear(f'udp://127.0.0.1:{port}?from_degrees=180')
    sways(heard, lambda: send(port, b'6.0\n'), (0.0, 1.0))
    assert heard.wind.lacks_direction
    heard.wind.bearing = 0.0
    sways(heard, lambda: send(port, b'6.0\n'), (0.0, -1.0))


def test_a_tempest_sways_a_tree(hear, send, port, sways):
    def broadcast() -> None:
        rain = {'type': 'evt_precip', 'evt': [1493322445]}
        wind = {
            'serial_number': 'SK-00008453',
            'type': 'rapid_wind',
            'hub_sn': 'HB-00000001',
            'ob': [1493322445, 6.3, 128],
        }
        send(port, json.dumps(rain).encode())
        send(port, json.dumps(wind).encode())

    downwind = -math.sin(math.radians(128.0)), -math.cos(math.radians(128.0))
    heard = hear(f'tempest?port={port}')
    newest = sways(heard, broadcast, downwind)
    assert (newest.kind, newest.speed) == ('rapid_wind', 6.3)
    assert newest.bearing == pytest.approx(math.radians(128.0))


#: As a station of this kind posts it.
ECOWITT = (
    'PASSKEY=0123456789ABCDEF&stationtype=GW1100A_V2.1.4&dateutc=2026-11-25+11:31:57&tempf=47.8'
    '&humidity=91&winddir=270&windspeedmph=13.42&windgustmph=24.83&maxdailygust=31.70&freq=868M'
)


def test_an_ecowitt_station_sways_a_tree(hear, port, sways):
    heard = hear(f'ecowitt:{port}?host=127.0.0.1&name=garden')
    heard.until(lambda: heard.wind.link.is_up)

    def post() -> None:
        url = f'http://127.0.0.1:{port}/data/report/'
        with urlopen(Request(url, ECOWITT.encode()), timeout=5.0) as answer:
            assert answer.status == 200

    newest = sways(heard, post, (1.0, 0.0))
    assert newest.speed == pytest.approx(13.42 * MPH)
    assert newest.gust == pytest.approx(24.83 * MPH)
    assert heard.wind.source['name'] == 'garden, weather station'


def test_a_station_that_knows_weather_underground_sways_a_tree(hear, port, sways):
    heard = hear(f'ecowitt:{port}?host=127.0.0.1')
    heard.until(lambda: heard.wind.link.is_up)
    query = {'ID': 'IBERLIN1', 'PASSWORD': 'x', 'winddir': '270', 'windspeedmph': '12.0'}
    path = '/weatherstation/updateweatherstation.php'

    def upload() -> None:
        url = f'http://127.0.0.1:{port}{path}?{urlencode(query)}'
        with urlopen(url, timeout=5.0) as answer:
            assert answer.read() == b'success'

    assert sways(heard, upload, (1.0, 0.0)).speed == pytest.approx(12.0 * MPH)


MQTT = [
    # rtl_433, ChirpStack, Home Assistant and a bare number.
    ('rtl_433/+/events', b'{"model":"Fineoffset","wind_avg_km_h":21.6,"wind_dir_deg":270}', ''),
    ('application/1/up', b'{"object":{"wind_speed":6.0,"wind_direction":"270"}}', ''),
    ('weather', b'{"a":{"v":6.0,"from":270}}', '?field=a.v&direction=a.from'),
    ('wind/speed', b'6.0', '?direction_topic=wind/direction'),
]


@pytest.mark.parametrize(('topic', 'payload', 'options'), MQTT)
def test_topics_of_mqtt_sway_a_tree(hear, broker: Broker, sways, topic, payload, options):
    def publish() -> None:
        if 'wind/direction' in broker.topics:
            broker.publish('wind/direction', b'270')
        broker.publish(topic.replace('+', '9'), payload)

    heard = hear(f'mqtt://127.0.0.1:{broker.port}/{topic}{options}')
    newest = sways(heard, publish, (1.0, 0.0))
    assert newest.speed == pytest.approx(6.0)
    assert newest.bearing == pytest.approx(1.5 * math.pi)
    assert broker.topics[0] == topic


def test_a_broker_that_breaks_is_subscribed_again(hear, broker: Broker):
    heard = hear(f'mqtt://127.0.0.1:{broker.port}/wind')
    heard.until(lambda: heard.wind.accepted, lambda: broker.publish('wind', b'5.0'))
    broker.drop()
    heard.until(lambda: heard.wind.link.connections >= 2)
    before = heard.wind.accepted
    heard.until(lambda: heard.wind.accepted > before, lambda: broker.publish('wind', b'5.0'))


def test_the_state_of_home_assistant_sways_a_tree(hear, serve, sways, tmp_path):
    asked = []

    def answer(request: Any) -> bytes:
        asked.append((request.path, request.headers.get('Authorization')))
        attributes = {'wind_speed': 21.6, 'wind_bearing': 270, 'wind_speed_unit': 'km/h'}
        return json.dumps({'state': 'windy', 'attributes': attributes}).encode()

    token = tmp_path / 'token'
    token.write_text('secret\n')
    heard = hear(f'http://{serve(answer)}/api/states/weather.home?every=0.2&token_file={token}')
    newest = sways(heard, lambda: None, (1.0, 0.0))
    assert newest.speed == pytest.approx(6.0)
    assert asked[0] == ('/api/states/weather.home', 'Bearer secret')


def test_json_by_paths_and_a_query_of_the_server(hear, serve, sways):
    asked = []

    def answer(request: Any) -> bytes:
        asked.append(request.path)
        return b'{"stations": [{"v": "12", "from": "W"}]}'

    address = serve(answer)
    query = 'key=3&speed=stations[0].v&direction=$.stations[0].from&unit=kn&every=0.2'
    newest = sways(hear(f'http://{address}/now?{query}'), lambda: None, (1.0, 0.0))
    assert newest.speed == pytest.approx(12.0 * KNOT)
    assert asked[0] == '/now?key=3'


def test_a_weatherlink_live_sways_a_tree(hear, serve, sways):
    station = {
        'lsid': 48308,
        'data_structure_type': 1,
        'txid': 1,
        'temp': 62.7,
        'wind_speed_last': 13.4,
        'wind_dir_last': 270,
        'wind_speed_hi_last_2_min': 20,
    }
    bar = {'lsid': 48307, 'data_structure_type': 3, 'bar_sea_level': 30.008}
    data = {'did': '001D0A700002', 'ts': 1531754005, 'conditions': [bar, station]}
    address = serve(json.dumps({'data': data, 'error': None}).encode())
    newest = sways(hear(f'weatherlink:{address}?every=0.2'), lambda: None, (1.0, 0.0))
    assert newest.speed == pytest.approx(13.4 * MPH)


def test_a_station_of_cumulus_sways_a_tree(hear, serve, sways):
    fields = '26/11/26 16:03:45 8.4 84 5.8 24.2 33.0 270 0.0 1.0 999.7 W 6 mph C hPa mm'
    line = f'{fields} {"1 " * 23}36.0 10.3 10.5\n'
    asked = []

    def answer(request: Any) -> bytes:
        asked.append(request.path)
        return line.encode()

    heard = hear(f'cumulus:{serve(answer)}/wx/realtime.txt?every=0.2')
    newest = sways(heard, lambda: None, (1.0, 0.0))
    assert asked[0] == '/wx/realtime.txt'
    assert newest.speed == pytest.approx(24.2 * MPH)
    assert newest.gust == pytest.approx(36.0 * MPH)
    heard.until(lambda: any('a mean over 10 min: gusts' in text for text in heard.said))


def open_meteo(unit: str = 'm/s', speed: float = 6.4) -> bytes:
    stamp = time.strftime('%Y-%m-%dT%H:%M', time.gmtime(time.time() - 180.0))
    current = {
        'time': stamp,
        'interval': 900,
        'wind_speed_10m': speed,
        'wind_direction_10m': 270,
        'wind_gusts_10m': 2.0 * speed,
    }
    units = {'time': 'iso8601', 'interval': 'seconds', 'wind_speed_10m': unit}
    return json.dumps({'latitude': 52.52, 'current_units': units, 'current': current}).encode()


def test_open_meteo_sways_a_tree_by_gusts_about_its_mean(hear, serve, sways):
    asked = []

    def answer(request: Any) -> bytes:
        asked.append(request.path)
        return open_meteo('km/h', 23.04)

    address = f'open-meteo:52.52,13.41?name=Berlin&server=http://{serve(answer)}/v1/forecast'
    heard = hear(address)
    newest = sways(heard, lambda: None, (1.0, 0.0))
    assert newest.speed == pytest.approx(6.4)
    assert newest.gust == pytest.approx(12.8)
    assert 'latitude=52.52&longitude=13.41' in asked[0]
    source = heard.wind.source
    assert (source['name'], source['is_mean']) == ('Berlin, open-meteo', True)
    assert 120.0 <= float(str(source['age'])) <= 300.0
    # The mean counts before it is told.
    heard.until(lambda: any('a mean over 15 min: gusts' in text for text in heard.said))


def test_reports_of_an_airport_sway_a_tree(hear, serve, sways):
    report = {
        'icaoId': 'EDDB',
        'obsTime': int(time.time()) - 600,
        'wdir': 270,
        'wspd': 12,
        'wgst': 25,
        'rawOb': 'METAR EDDB 251920Z 27012G25KT 9999 FEW012 08/05 Q1012 NOSIG',
        'name': 'Berlin Brandenburg Arpt, BB, DE',
    }
    address = f'metar:eddb?server=http://{serve(json.dumps([report]).encode())}/api/data/metar'
    heard = hear(address)
    newest = sways(heard, lambda: None, (1.0, 0.0))
    assert newest.speed == pytest.approx(12.0 * KNOT)
    assert newest.gust == pytest.approx(25.0 * KNOT)
    assert heard.wind.source['name'] == 'Berlin Brandenburg Arpt, METAR EDDB'


def test_a_report_that_is_too_old_is_stale(hear, serve):
    report = {'obsTime': int(time.time()) - 86_400, 'wdir': 'VRB', 'wspd': 12}
    heard = hear(f'metar:EDDB?server=http://{serve(json.dumps([report]).encode())}/')
    heard.until(lambda: heard.wind.accepted)
    assert heard.wind.state == 'stale'
    assert heard.wind.drain() == []


def test_a_signal_k_server_sways_a_tree(hear, port, sways):
    web = pytest.importorskip('aiohttp').web
    subscriptions = []

    async def stream(request: Any) -> Any:
        socket = web.WebSocketResponse()
        await socket.prepare(request)
        await socket.send_json({'name': 'signalk-server', 'version': '1.7.0', 'self': 'vessels.x'})
        subscriptions.append(await socket.receive_json())
        while not socket.closed:
            values = [
                {'path': 'navigation.headingTrue', 'value': math.pi},
                {'path': 'environment.wind.angleApparent', 'value': 0.5 * math.pi},
                {'path': 'environment.wind.speedApparent', 'value': 6.2},
            ]
            await socket.send_json({'context': 'vessels.self', 'updates': [{'values': values}]})
            await asyncio.sleep(0.05)
        return socket

    async def start() -> Any:
        application = web.Application()
        application.router.add_get('/signalk/v1/stream', stream)
        runner = web.AppRunner(application, shutdown_timeout=0.1)
        await runner.setup()
        await web.TCPSite(runner, '127.0.0.1', port).start()
        return runner.cleanup

    with in_a_loop(start):
        heard = hear(f'signalk://127.0.0.1:{port}')
        newest = sways(heard, lambda: None, (1.0, 0.0))
        heard.wind.stop()
    assert newest.kind == 'Signal K speedApparent'
    assert newest.bearing == pytest.approx(1.5 * math.pi)
    assert subscriptions[0]['subscribe'][0]['path'] == 'environment.wind.*'


@pytest.mark.parametrize('words', [(0x7FFF, 270), (0x8000, 270), (0xFFFF, 270), (53, 0x7FFF)])
def test_a_register_without_a_value_is_no_wind(words: tuple[int, int]) -> None:
    """Scales may bring the word of no value to a wind, and to degrees."""
    options = 'speed=0&direction=1&scale=0.001&direction_scale=0.01'
    source = open_source(f'modbus:127.0.0.1?{options}')
    (found,) = source.read(Message(struct.pack('>HH', *words)))
    assert isinstance(found, Refusal)
    (good,) = source.read(Message(struct.pack('>HH', 5300, 27000)))
    assert isinstance(good, WindReading)
    assert good.speed == pytest.approx(5.3)


def test_registers_of_modbus_sway_a_tree(hear, modbus, sways):
    """A wind speed of 6.5 m/s in tenths, and 270 degrees, three registers apart."""
    place = modbus({0x1F4: 65, 0x1F5: 6, 0x1F6: 0, 0x1F7: 270})
    options = 'speed=0x1F4&direction=0x1F7&scale=0.1&every=0.1'
    heard = hear(f'modbus:{place}?{options}')
    newest = sways(heard, lambda: None, (1.0, 0.0))
    assert newest.speed == pytest.approx(6.5)


@pytest.mark.parametrize(
    ('query', 'guess'), [('units=km/h', 'unit'), ('speeds=a.b', 'speed'), ('every_=3', 'every')]
)
def test_a_misspelt_option_of_ours_is_not_left_to_the_server(query: str, guess: str) -> None:
    with pytest.raises(ParameterError, match=f"did you mean '{guess}'"):
        open_source(f'http://127.0.0.1/state.json?{query}')
    open_source(f'http://127.0.0.1/state.json?{query}#every=60')
    open_source('http://127.0.0.1/state.json?units=metric&appid=3')
