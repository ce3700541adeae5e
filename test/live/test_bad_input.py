# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""What live sources get that is no wind: it is refused or told, and nothing ends by it."""

from __future__ import annotations

from contextlib import suppress
import json
import math
from pathlib import Path
import socket
import threading
import time
from typing import Any
from urllib.request import Request, urlopen

from hypothesis import given
from hypothesis import strategies as st
import pytest

from tree_sway.errors import ParameterError, TreeSwayError
from tree_sway.files.wind import Refusal, WindReading
from tree_sway.live import sources
from tree_sway.live.readers.instrument_lines import InstrumentLines
from tree_sway.live.readers.json_path import parse_json, steps_of
from tree_sway.live.readers.named_values import WindNames
from tree_sway.live.readers.signalk import SignalKWind
from tree_sway.live.readers.weatherlink import read_conditions
from tree_sway.live.registry import open_source, SOURCE_KINDS
from tree_sway.live.sources.ecowitt import read_upload
from tree_sway.live.transports.transport import Message

READERS = {
    'lines': lambda: InstrumentLines(),
    'named lines': lambda: InstrumentLines(columns=('direction', 'speed')),
    'upload': lambda: read_upload,
    'METAR': lambda: open_source('metar:EDDB').read,
    'Open-Meteo': lambda: open_source('open-meteo:52,13').read,
    'WeatherLink': lambda: read_conditions,
    'Signal K': lambda: SignalKWind(),
    'Tempest': lambda: open_source('tempest').read,
    'Modbus': lambda: open_source('modbus:host?speed=0&direction=3').read,
    'JSON': lambda: open_source('http://host/?speed=a.b').read,
}
#: Parts of messages, from which the wrong ones are put together.
PIECES = [
    '{', '}', '[', ']', '"', ':', ',', '&', '=', '$', '*', '\n', '\x02', '\x03', 'NaN', 'Infinity',
    'null', 'true', '-1', '1e999', '9' * 400, '270', '6.5', '"wind_speed"', '"wind_direction"',
    'windspeedmph', 'winddir', '"current"', '"updates"', '"values"', '"path"', '"value"',
    '"environment.wind.speedTrue"', '"type":"rapid_wind"', '"ob":[1,', 'WIMWV,', 'R,', 'M,A',
    '0R1,', 'Dm=', 'Sm=', 'D,', 'M', '#', '0+332+', 'METAR EDDB 251920Z ', 'VRB99KT', '///',
    '\ud83d\udca8', '\x00', '"rawOb"', '"data"', '"conditions"', '"data_structure_type":1',
    '"wind_speed_last"',
]  # fmt: skip
messages = st.one_of(
    st.binary(max_size=300),
    st.lists(st.sampled_from(PIECES), max_size=30).map(
        lambda pieces: ''.join(pieces).encode('utf-8', 'replace')
    ),
    st.recursive(
        st.none() | st.booleans() | st.floats() | st.text(max_size=5) | st.integers(),
        lambda inner: st.lists(inner, max_size=4)
        | st.dictionaries(
            st.sampled_from(
                ['current', 'wind_speed_10m', 'wind_speed', 'updates', 'values', 'path', 'value',
                 'data', 'conditions', 'ob', 'type', 'rawOb', 'time', 'interval', 'a', 'b']
            ),
            inner,
            max_size=6,
        ),
        max_leaves=20,
    ).map(lambda document: json.dumps(document).encode()),
)  # fmt: skip


@pytest.mark.parametrize('name', READERS)
@given(data=messages)
def test_no_message_breaks_a_reader(name: str, data: bytes) -> None:
    for reading in READERS[name]()(Message(data)):
        if isinstance(reading, WindReading):
            assert math.isfinite(reading.speed)
            assert reading.speed >= 0.0
            assert reading.bearing is None or math.isfinite(reading.bearing)
            assert all(map(math.isfinite, reading.velocity(0.0)))
        else:
            assert isinstance(reading, Refusal)
            assert reading.reason


REFUSED = [
    ('lines', b'$WIMWV,270.0,R,10.0,N,V', 'status is'),
    ('lines', b'$WIMWV,270.0,R,10.0,N,A*00', 'wrong checksum'),
    ('lines', b'0R1,Dm=270D,Sm=000#', "speed is '000#'"),
    ('lines', b'0+999+999.9+04', 'status is 4'),
    ('lines', b'1.0 2.0 3.0', '3 numbers; say which'),
    ('lines', b'-5.0,270', "speed is '-5.0'"),
    ('lines', b'5.0,999', "direction is '999.0'"),
    ('lines', b'0 006.2 270 01*00', 'wrong checksum'),
    ('lines', b'{"wind_speed": null, "wind_direction": 270}', "speed is ''"),
    ('lines', b'{"wind_speed": {"value": 5, "unit": "bft"}}', "unknown unit 'bft'"),
    ('lines', b'{"wind_speed": NaN}', "speed is 'nan'"),
    ('lines', b'{"wind_speed": 5.0, "wind_direction": 400}', "direction is '400'"),
    ('upload', b'windspeedmph=-9999&winddir=270', "speed is '-9999'"),
    ('upload', b'&'.join(b'a=1' for _ in range(600)), 'too many fields'),
    ('METAR', b'[]', 'no report'),
    ('METAR', b'METAR EDDB 251920Z ///// 9999', None),
    ('METAR', b'[{"wdir": 270, "wspd": null}]', None),
    ('Open-Meteo', b'{"error": true, "reason": "Latitude must be in range"}', 'Latitude must be'),
    ('Open-Meteo', b'{"current": {"wind_speed_10m": null}}', None),
    ('Signal K', b'{"updates":[{"values":[{"path":"environment.wind.speedTrue","value":"x"}]}]}',
     'environment.wind.speedTrue is x'),
    ('Tempest', b'{"type":"rapid_wind","ob":[1493322445,null,128]}', "speed is 'None'"),
    ('Tempest', b'{"type":"rapid_wind","ob":[1493322445,2.0,361]}', "direction is '361'"),
    ('Modbus', b'\x00', '0 registers of 4'),
    ('Modbus', b'\xff\xff' * 4, 'no speed: the register is -1'),
    ('JSON', b'{"a": {"b": "calm"}}', "speed is 'calm'"),
    ('JSON', b'{"a": {"c": 5}}', None),
    ('JSON', b'<html>login</html>', None),
]  # fmt: skip


@pytest.mark.parametrize(('name', 'data', 'reason'), REFUSED)
def test_a_wind_that_cannot_be_used_is_refused_with_its_reason(
    name: str, data: bytes, reason: str | None
) -> None:
    readings = READERS[name]()(Message(data))
    if reason is None:
        assert not readings
        return
    (reading,) = readings
    assert isinstance(reading, Refusal)
    assert reason in reading.reason


def test_an_unknown_unit_is_refused() -> None:
    read = open_source('http://host/?speed=v&unit=u').read
    (reading,) = read(Message(b'{"v": 5, "u": "beaufort"}'))
    assert isinstance(reading, Refusal)
    assert 'beaufort' in reading.reason


def test_deep_and_wide_json_takes_no_time() -> None:
    begin = time.monotonic()
    assert parse_json(b'[' * 100_000) is None
    wide = json.dumps({f'wind_{i}_speed': [i] * 10 for i in range(20_000)}).encode()
    assert WindNames().read(parse_json(wide), 'JSON') == []
    assert time.monotonic() - begin < 5.0


@pytest.mark.parametrize('text', ['', '.', 'a.', '[x]', 'a[', 'a..b'])
def test_what_is_no_path_is_refused(text: str) -> None:
    with pytest.raises(ParameterError, match='is no path'):
        steps_of(text)


@pytest.mark.parametrize(
    ('address', 'message'),
    [
        ('', 'does not begin with a kind of source; give one such as udp:5006'),
        ('5006', 'give udp:5006'),
        ('/dev/ttyUSB0', 'give serial:/dev/ttyUSB0'),
        ('192.168.1.3:10110', 'give tcp://192.168.1.3:10110'),
        ('anemometer', 'is no source of wind'),
        ('mqqt://host/topic', "did you mean 'mqtt'"),
        ('mqtt://host', 'no host or topic'),
        ('udp:', 'port from 1 to 65535'),
        ('udp:wind', 'port from 1 to 65535'),
        ('udp://:0', 'port from 1 to 65535'),
        ('udp://:70000', 'port from 1 to 65535'),
        ('tcp://:10110', 'no host'),
        ('tcp://host', 'port from 1 to 65535'),
        ('serial:ttyUSB0', 'no serial port'),
        ('tempest?nam=Berlin', "did you mean 'name'"),
        ('open-meteo:Berlin', 'no latitude and longitude'),
        ('open-meteo:91,13', 'no latitude and longitude'),
        ('metar:Tegel', 'no code of an airport'),
        ('ecowitt:', 'port from 1 to 65535'),
        ('ecowitt:http', 'port from 1 to 65535'),
        ('http:///state.json', 'no host'),
        ('http://[::1/x', 'not an address'),
        ('http://host/?speed=a..b', 'is no path'),
        ('http://host/?every=never', "every is 'never'"),
        ('http://host/?token_file=/nowhere/token', 'not readable'),
        ('udp://:1?columns=height', 'columns are'),
        ('udp://:1?unit=beaufort', "unknown unit 'beaufort'"),
        ('udp://:1?sentence=GGA', "sentence is 'GGA'"),
        ('udp://:1?from_degrees=400', 'from_degrees is'),
        ('udp://:1?mean=-1', 'mean is'),
        ('modbus:host?kind=coil', 'kind is coil'),
        ('modbus:host?speed=0&direction=500', 'registers'),
        ('signalk:host', 'no host'),
        ('weatherlink:', 'no host'),
        ('weatherlink', 'no host'),
        ('modbus?speed=1', 'no host'),
        ('tempest:192.168.1.5', 'whole network; give tempest, without'),
        ('tempest://192.168.1.5', 'whole network; give tempest, without'),
        ('cumulus:', 'no host'),
    ],
)
def test_a_wrong_address_is_refused_in_words(address: str, message: str) -> None:
    with pytest.raises(TreeSwayError, match=message):
        open_source(address)


@given(st.text(max_size=60))
def test_no_text_breaks_the_registry(text: str) -> None:
    for kind in SOURCE_KINDS:
        scheme = kind['schemes'].split()[0]
        for address in (text, f'{scheme}:{text}', f'{scheme}://{text}'):
            with suppress(TreeSwayError):
                open_source(address)


def test_every_module_of_sources_is_in_their_table() -> None:
    modules = {each.stem for each in Path(sources.__file__).parent.glob('[!_]*.py')}
    assert modules == {kind['module'] for kind in SOURCE_KINDS}


def test_every_form_in_the_help_opens() -> None:
    for kind in SOURCE_KINDS:
        text = kind['form'].replace('PORT', '8080').replace(':port', ':8080')
        text = text.replace('PATH', 'a.b')
        text = text.replace('LAT,LON', '52.5,13.4').replace('ICAO', 'EDDB')
        assert open_source(text).name


def told(heard: Any, text: str) -> bool:
    return any(text in said for said in heard.said)


def test_lines_that_nobody_understands_are_told_within_five_seconds(hear, send, port) -> None:
    heard = hear(f'udp://127.0.0.1:{port}')
    heard.until(lambda: heard.wind.link.is_up)
    begin = time.monotonic()
    heard.until(
        lambda: told(heard, 'lines came, none was understood, the last: {"serial": "AB-1"'),
        lambda: send(port, b'{"serial": "AB-1", "temperature": 21.5}'),
    )
    assert time.monotonic() - begin < 5.0
    assert told(heard, 'NMEA 0183')
    assert heard.wind.state == 'unknown'


@pytest.mark.parametrize('noise', [b'\xf8\x80' * 40, b'\xf8\x80\n'])
def test_noise_of_a_wrong_baud_rate_is_told(hear, serial_port, noise: bytes) -> None:
    name, write = serial_port
    heard = hear(f'serial:{name}:2400')
    heard.until(lambda: heard.wind.link.is_up)
    heard.until(lambda: told(heard, 'baud rate'), lambda: write(noise))
    assert heard.wind.state == 'unknown'


def test_a_speed_without_a_unit_is_told_once(hear, send, port) -> None:
    heard = hear(f'udp://127.0.0.1:{port}')
    heard.until(
        lambda: heard.wind.accepted > 3,
        lambda: send(port, b'{"wind_speed": 5.3, "wind_direction": 270}'),
    )
    assert sum('taken in m/s' in said and 'unit=km/h' in said for said in heard.said) == 1
    read = open_source('udp:5006?unit=m/s').read
    (reading,) = read(Message(b'{"wind_speed": 5.3, "wind_direction": 270}'))
    assert isinstance(reading, WindReading)
    assert not reading.assumed


def test_silence_is_told(hear, port) -> None:
    heard = hear(f'udp://127.0.0.1:{port}')
    heard.until(lambda: told(heard, 'nothing has come yet'))


def test_a_name_is_one_line() -> None:
    assert open_source('udp:5006?name=a%0Ab%1B%5B2J').name.startswith('a b\\x1b[2J, ')


def test_a_fast_instrument_is_not_told_as_a_mean(hear, send, port) -> None:
    heard = hear(f'udp://127.0.0.1:{port}')
    heard.until(
        lambda: heard.wind.accepted > 2,
        lambda: send(port, b'{"wind_speed": 6.0, "wind_dir": 270}'),
    )
    assert not any('a mean over' in text for text in heard.said), heard.said
    assert any(text.endswith('the wind of instants') for text in heard.said), heard.said


def test_refused_winds_are_told_with_their_reasons(hear, send, port) -> None:
    heard = hear(f'udp://127.0.0.1:{port}')
    heard.until(
        lambda: told(heard, 'all were refused: status is'),
        lambda: send(port, b'$WIMWV,270.0,R,10.0,N,V'),
    )


@pytest.mark.parametrize('speed', ['400', '1e300', 'inf'])
def test_an_impossible_speed_is_refused(hear, send, port, speed: str) -> None:
    heard = hear(f'udp://127.0.0.1:{port}')
    heard.until(
        lambda: heard.wind.refused or heard.wind.other > 3,
        lambda: send(port, f'{speed},270'.encode()),
    )
    assert not heard.wind.accepted


def test_a_server_that_fails_is_asked_again(hear, serve) -> None:
    answers = [b'{', b'[]', b'{"wind_speed": 5.0, "wind_direction": 270}']
    heard = hear(
        f'http://{serve(lambda _request: answers.pop(0) if len(answers) > 1 else answers[0])}'
        '/?every=0.2'
    )
    heard.until(lambda: heard.wind.accepted)
    assert heard.wind.other == 2


def test_a_status_of_http_is_told(hear, serve) -> None:
    heard = hear(f'http://{serve(b"no", status=503)}/')
    heard.until(lambda: any('HTTP 503' in text for text in heard.said))
    assert 'HTTP 503' in heard.wind.problem


def test_an_endless_answer_is_cut(hear, serve) -> None:
    heard = hear(f'http://{serve(b"9" * 3_000_000)}/')
    heard.until(lambda: any('more than' in text for text in heard.said))


def test_an_upload_of_megabytes_is_refused(hear, port) -> None:
    heard = hear(f'ecowitt:{port}?host=127.0.0.1')
    heard.until(lambda: heard.wind.link.is_up)
    url = f'http://127.0.0.1:{port}/'
    with pytest.raises(OSError, match=r'413|reset|[Bb]roken'):  # an HTTPError is one
        urlopen(Request(url, b'x' * 1_000_000), timeout=5.0)
    with urlopen(Request(url, b'windspeedmph=10&winddir=270'), timeout=5.0) as answer:
        assert answer.status == 200
    heard.until(lambda: heard.wind.accepted)


@pytest.mark.parametrize('address', ['tcp', 'http', 'signalk', 'mqtt', 'modbus'])
def test_a_peer_that_accepts_and_is_silent_does_not_keep_a_source_from_ending(
    hear, address: str
) -> None:
    """The fixture measures that the thread ends."""
    with socket.create_server(('127.0.0.1', 0)) as server:
        host = f'127.0.0.1:{server.getsockname()[1]}'
        place = {'mqtt': f'mqtt://{host}/t', 'modbus': f'modbus:{host}'}
        heard = hear(place.get(address, f'{address}://{host}'))
        server.settimeout(10.0)
        connection, _ = server.accept()
        with connection:
            threading.Event().wait(0.2)
            heard.wind.stop()


def test_a_peer_that_never_ends_a_line_takes_no_memory(hear) -> None:
    with socket.create_server(('127.0.0.1', 0)) as server:
        heard = hear(f'tcp://127.0.0.1:{server.getsockname()[1]}')
        connection, _ = server.accept()
        with connection:
            for _ in range(200):
                connection.sendall(b'7' * 65_536)
            connection.sendall(b'\n5.0,270\n')
            heard.until(lambda: heard.wind.accepted)
        assert heard.wind.link.messages == 1


def test_a_password_is_in_no_text(hear) -> None:
    opened = open_source('mqtt://me:secret@127.0.0.1:1/t')
    texts: list[Any] = [opened.transport, repr(opened.transport), opened.name]
    opened = open_source('http://me:secret@127.0.0.1:1/x?key=secret')
    texts += [opened.transport, opened.name]
    assert not [text for text in texts if 'secret' in str(text)]


def _redirect(place: str) -> str:
    return f'HTTP/1.1 302 Found\r\nLocation: {place}\r\nConnection: close\r\n\r\n'


@pytest.mark.parametrize(
    ('answer', 'said'),
    [
        ('SSH-2.0-OpenSSH_9.6\r\n', 'is not HTTP (Bad status line'),
        ('HTTP/1.1 200 OK\r\nno header\r\n\r\n', 'is not HTTP ('),
        (_redirect('/x?key=secret'), 'redirects again and again; give the final address'),
        (_redirect('ftp://other/?key=secret'), 'redirect'),
    ],
)
def test_a_key_in_the_address_is_in_no_failure(hear, serve, answer: str, said: str) -> None:
    server = serve(lambda request: bytes(request.wfile.write(answer.encode()) * 0))
    heard = hear(f'http://{server}/x?key=secret&every=0.2')
    heard.until(lambda: said in heard.wind.problem)
    assert 'secret' not in f'{heard.said} {heard.wind.problem}'


@pytest.mark.parametrize(
    ('options', 'line', 'words'),
    [
        ('', b'5.3,270', ['taken as speed and direction in degrees', 'taken in m/s']),
        ('?unit=kn', b'5.3,270', ['taken as speed and direction in degrees']),
        ('?columns=speed,direction', b'5.3,270', ['taken in m/s']),
        ('', b'5.3', ['taken in m/s']),
        ('', b'5.3 m/s', []),
        ('?columns=u,v', b'5.3,2.0', ['taken in m/s']),
        ('?columns=direction,speed&unit=m/s', b'270,5.3', []),
    ],
)
def test_what_is_assumed_of_numbers_is_told_with_its_option(
    options: str, line: bytes, words: list[str]
) -> None:
    (reading,) = open_source(f'udp:5006{options}').read(Message(line))
    assert isinstance(reading, WindReading)
    assert all(each in reading.assumed for each in words)
    assert reading.assumed.count('taken') == len(words)


def test_numbers_by_order_are_told_once(hear, send, port) -> None:
    heard = hear(f'udp://127.0.0.1:{port}')
    heard.until(lambda: heard.wind.accepted > 3, lambda: send(port, b'5.3,270'))
    assert sum('columns=direction,speed' in said for said in heard.said) == 1


def test_fewer_numbers_than_columns_are_refused() -> None:
    read = open_source('udp:5006?columns=-,speed,-').read
    assert [each.kind for each in read(Message(b'1,5.3')) if isinstance(each, WindReading)]
    (refusal,) = read(Message(b'5.3'))
    assert isinstance(refusal, Refusal)
    assert refusal.reason == '1 numbers for 3 columns'
