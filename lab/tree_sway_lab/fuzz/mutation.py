# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""Bytes that are damaged: a token put in, a piece lost, twice there, flipped or cut off."""

from __future__ import annotations

from collections.abc import Iterable
import random

TOKENS = [b'nan', b'inf', b'-1', b'0', b'1e308', b'-1e999', b'99999999999999999999', b'', b'\n',
          b'\t',
          b',', b'[', b'{', b'&a [*a]', b'- ', b'\x00', b'\xff\xfe', b'"', b'1e-320', b'.5',
          b'1_0', '\u0663'.encode(), b'$', b'*', b'<S1', b'+A1', b'segment: 3', b'parent: stem',
          b'at: 0']  # fmt: skip
"""What readers of text stumble over."""
KINDS = ('token', 'replace', 'delete', 'copy', 'flip', 'cut', 'number')
"""Kinds of damage."""
Mutation = tuple[str, float, float, bytes]
"""Its kind, where and how much of all, from 0 to 1, and a token."""
_ENDS = (b',', b'\t', b' ', b'\n')


def mutated(content: bytes, mutations: Iterable[Mutation]) -> bytes:
    """Return the content with damage of all kinds that are named, one after the other."""
    for kind, where, much, token in mutations:
        at = int(where * len(content))
        span = 1 + int(much**4 * len(content))
        if kind == 'token':
            content = content[:at] + token + content[at:]
        elif kind == 'replace':
            content = content[:at] + token + content[at + len(token) :]
        elif kind == 'delete':
            content = content[:at] + content[at + span :]
        elif kind == 'copy':
            content = content[:at] + content[at : at + span] + content[at:]
        elif kind == 'flip' and content:
            flipped = content[at] ^ (1 << int(8 * much))
            content = content[:at] + bytes([flipped]) + content[at + 1 :]
        elif kind == 'cut':
            content = content[: max(at, 1)]
        elif kind == 'number':  # a cell, as a whole
            begin = max((content.rfind(c, 0, at) for c in _ENDS), default=0) + 1
            ends = [e for c in (*_ENDS, b']') if (e := content.find(c, begin)) > 0]
            content = content[:begin] + token + content[min(ends, default=begin) :]
    return content


def drawn(rng: random.Random, most: int = 6) -> list[Mutation]:
    """Draw one to some mutations."""
    return [(rng.choice(KINDS), rng.random(), rng.random(), rng.choice(TOKENS))
            for _ in range(rng.randint(1, most))]  # fmt: skip
