# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
import pytest

from tree_sway.errors import ParameterError
from tree_sway.files.reading_options import reader_options


def test_words_become_options():
    assert reader_options('rate=20 topic=/wind columns=u,v,w taper=true up-to=y'.split()) == {
        'rate': 20.0,
        'topic': '/wind',
        'columns': ('u', 'v', 'w'),
        'taper': True,
        'up_to': 'y',
    }
    assert reader_options([]) == {}


@pytest.mark.parametrize('text', ['rate', '=20', 'rate='])
def test_what_is_no_option_is_refused(text):
    with pytest.raises(ParameterError, match='write NAME=VALUE'):
        reader_options([text])
