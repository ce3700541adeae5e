# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Two winds of which one would be used, and options that change nothing, are refused."""

from __future__ import annotations

import pytest

from tree_sway.commands.cli import main

WIND = ('--wind', 'canopy')
SPEED = ('--speed', '4')
OPTION = ('--wind-option', 'rate=20')


@pytest.mark.parametrize(
    ('command', 'options', 'words'),
    [
        ('simulate', (*WIND, *SPEED), 'both --wind and --speed; give one of the two'),
        ('simulate', ('--sensor', 'udp://:1', *SPEED), 'both --sensor and --speed'),
        ('simulate', ('--sensor', 'udp://:1', *WIND), 'both --sensor and --wind'),
        ('simulate', OPTION, '--wind-option: it would change nothing; add --wind FILE'),
        ('plot', (*WIND, *SPEED), 'both --wind and --speed'),
        ('plot', ('--strength', *WIND), '--wind: --strength draws no recording; give --speed'),
        ('plot', ('--portrait', *WIND), '--wind: --portrait draws no recording'),
        ('render', (*WIND, *SPEED), 'both --wind and --speed'),
        ('convert', WIND, '--wind: it would change nothing; add --at SECONDS'),
        ('convert', SPEED, '--speed: it would change nothing; add --at SECONDS'),
        (
            'convert',
            (*SPEED, '-o', 'bare.xml'),
            '--speed: it would change nothing; add --at SECONDS',
        ),
        (
            'convert',
            (*WIND, '-o', 'gust.glb'),
            '--wind: it would change nothing; add --at SECONDS',
        ),
        ('convert', (*SPEED, '--sway', 'skin', '-o', 'joints.glb'), '--speed: it would change'),
        ('convert', (*WIND, *SPEED, '--at', '3'), 'both --wind and --speed'),
        ('simulate', ('--seconds', '1e6'), '1e+06 s at 60 Hz are 6e+07 steps; give at most'),
    ],
)
def test_what_would_be_ignored_is_refused(command, options, words, tmp_path, capsys, installed):
    installed(command)
    suffix = {'convert': '.obj', 'plot': '.png', 'render': '.gif', 'simulate': '.csv'}[command]
    output = tmp_path / f'out{suffix}'
    if '-o' not in options:
        options = (*options, '-o', str(output))
    assert main([command, 'goldcrest', *options]) == 2
    assert words in capsys.readouterr().err
    assert not output.exists()


def test_show_refuses_two_winds(capsys):
    assert main(['show', 'goldcrest', *WIND, *SPEED]) == 2
    assert 'both --wind and --speed' in capsys.readouterr().err
