# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Tables of strain gauges in the forms of published records."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tree_sway.errors import FormatError
from tree_sway.files.motion.strain_table import read_strain

STRAIN = np.array([[1e-4, -2e-4, 5e-6, 1e-6], [2e-4, -1e-4, np.nan, 2e-6], [0.0, 3e-5, 1e-6, 0.0]])


def rows(times: list[str], separator: str, factor: float = 1.0) -> str:
    lines = []
    for time, row in zip(times, factor * STRAIN, strict=True):
        lines.append(separator.join([time, *(f'{x:.9g}' for x in row)]))
    return '\n'.join(lines) + '\n'


DATES = [f'2016-10-05 12:00:00.{part}' for part in ('000', '250', '500')]
DAYS = [f'{736608.5 + part / 86400.0:.9f}' for part in (0.0, 0.25, 0.5)]
FORMS = {
    'tabs with names': 'time\tSG1_N\tSG1_E\tSG2_N\tSG2_E\n' + rows(DATES, '\t'),
    'dates without names': rows(DATES, ','),
    'days of MATLAB': rows(DAYS, ' '),
    'units': 'time,north [microstrain],east [microstrain],n,e\n' + rows(DATES, ',', 1e6),
}


@pytest.mark.parametrize('form', FORMS)
def test_a_published_form_is_read(tmp_path: Path, form: str) -> None:
    path = tmp_path / 'T1_NE.txt'
    path.write_text(FORMS[form], encoding='utf-8')
    record = read_strain(path)
    np.testing.assert_allclose(record.time - record.time[0], [0.0, 0.25, 0.5], atol=2e-4)
    np.testing.assert_allclose(record.strain.reshape(3, 4), STRAIN, rtol=1e-6)
    assert record.epoch is not None
    assert '2 pairs of strain' in record.notes[0]
    assert record.motion(0).orientation is not None


@pytest.mark.parametrize(
    ('text', 'what'),
    [
        ('', '0 columns beside the time'),
        ('time,n\n0,1e-4\n', '1 columns beside the time'),
        ('time,n,e\n0,1.5,2\n1,-40,8\n2,9,1\n', 'no strain of wood'),
        ('time,n [mV],e [mV]\n0,1e-4,2e-4\n', "unknown unit 'mV'"),
        ('time,n,e\nx,1e-4,2e-4\n', 'no time in'),
        ('time,n,e\n', 'no header and rows'),
        ('foo,bar,baz\n', 'no time in'),
        ('time,n,e\n0,,2e-4\n1,,1e-4\n', 'a column without numbers'),
    ],
)
def test_what_is_no_strain_is_refused(tmp_path: Path, text: str, what: str) -> None:
    path = tmp_path / 'strain.csv'
    path.write_text(text, encoding='utf-8')
    with pytest.raises(FormatError, match=what):
        read_strain(path)
