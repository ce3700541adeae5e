# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Each address on the page on live wind opens, and each kind of source is on it."""

from __future__ import annotations

from pathlib import Path
import re

import pytest

pytest.importorskip('aiohttp')
pytest.importorskip('serial')

from tree_sway.live.registry import open_source, SOURCE_KINDS  # noqa: E402

PAGE = Path(__file__).resolve().parents[2] / 'doc' / 'live_wind.md'
TEXT = PAGE.read_text(encoding='utf-8')
#: The first address of each row of the first table.
ADDRESSES = [
    found[1].strip('"')
    for row in TEXT.split('## Options')[0].splitlines()
    if (found := re.match(r'\| [^|]+ \| `([^`]+)`', row))
]


@pytest.mark.parametrize('address', ADDRESSES)
def test_an_address_of_the_page_opens(
    address: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path('token').write_text('secret-word')
    assert open_source(address).name


def test_every_kind_of_source_is_on_the_page() -> None:
    schemes = {re.split('[:?]', address)[0] for address in ADDRESSES}
    kinds = [kind['schemes'].split() for kind in SOURCE_KINDS]
    assert not [names for names in kinds if not {*names} & schemes]
    assert len(ADDRESSES) > 20
