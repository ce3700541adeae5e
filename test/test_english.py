# Copyright 2026 Tree Sway maintainers
# SPDX-License-Identifier: Apache-2.0
"""The words of the project are plain English and the field's own, in code and pages alike."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
import io
from pathlib import Path
import re
import tokenize

import pytest

ROOT = Path(__file__).resolve().parent.parent
SOURCES = sorted(
    path
    for folder in ('tree_sway', 'tree_sway_ros', 'lab/tree_sway_lab', 'launch', 'examples')
    for path in (ROOT / folder).rglob('*.py')
)
PAGES = sorted(
    [
        *(ROOT / name for name in ('README.md', 'CHANGELOG.rst', 'CONTRIBUTING.md')),
        *(ROOT / 'doc').rglob('*.md'),
    ]
)
#: Words that have a plainer one, and that one.
PLAINER = {
    r'told|tells?|telling': 'given, reports, returns, sent, described by',
    r'stands? (?:in|for|beside|so|itself)|stood': 'is, is in, is next to',
    r'so (?:many|long|far)(?! (?:as|that)\b)': 'a number, a time, a distance, with its unit',
    r'anew': 'again',
    r'(?-i:is none)': 'there is no',
    r'will do|would do': 'suffices',
    r'at rest all there is': 'no state',
    r'heirs?|stand_in|goes_on|doubts?|snares?|nonsense': 'continuation, merged_into, warnings',
}
#: Words that have a plainer one in the program, where pages for readers may use them.
PLAINER_IN_CODE = {
    r'hand(?:s|ed)? (?:on|down|over)': 'pass, forward, act on',
    r'feels?|felt': 'is loaded by, reads',
    r'go(?:es)? over to|gone over': 'is blended with, changes to',
    r'goes on|go on': 'continues',
    r'dies? (?:down|away)': 'decays',
    r'asked for': 'requested, expected, wanted',
    r'as of `': 'as in',
    r'aslant|lest|in vain|nothing but|dear(?:er)?': 'oblique, so that not, only, expensive',
    r'whoever|somebody|nobody': 'a program, a subscriber, no user',
    r'over and over|around and around|again and again': 'repeatedly',
    r'half a step on|sits? on|gives? way|mend(?:s|ed)?': 'middle, is at, buckles, correct',
    r'believe[sd]?|telling|dealt': 'accept, divide',
    r'_hold|_held|_asked|CalibratedTree|of_none': '_clamp, _equilibrium, values',
}
FINDER = re.compile(rf'\b(?:{"|".join(PLAINER)})\b', re.IGNORECASE)
IN_CODE = re.compile(
    rf'\b(?:{"|".join((*PLAINER, *PLAINER_IN_CODE))})(?:\b|(?<=`))', re.IGNORECASE
)
RUNTIME = [path for path in SOURCES if path.relative_to(ROOT).parts[0].startswith('tree_sway')]


def prose_of(source: str) -> Iterator[tuple[int, str]]:
    """Yield the comments and strings of a Python source, each with its line, and its names."""
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type in (tokenize.COMMENT, tokenize.STRING):
            yield token.start[0], token.string
        elif token.type == tokenize.NAME:
            yield token.start[0], token.string


@cache
def pieces_of(path: Path) -> list[tuple[int, str]]:
    """Return what of a file is words, each piece with its line."""
    text = path.read_text(encoding='utf-8')
    return list(prose_of(text) if path.suffix == '.py' else enumerate(text.splitlines(), 1))


def faults_of(path: Path, finder: re.Pattern[str] = FINDER) -> list[str]:
    """Return each word of a file that has a plainer one, with its line."""
    pieces = pieces_of(path)
    return [
        f'{path.relative_to(ROOT)}:{line + piece[: found.start()].count(chr(10))}: {found[0]!r}'
        for line, piece in pieces
        for found in finder.finditer(piece)
    ]


@pytest.mark.parametrize('path', [*SOURCES, *PAGES], ids=lambda path: str(path.relative_to(ROOT)))
def test_words_are_plain(path: Path) -> None:
    faults = faults_of(path)
    assert not faults, '\n'.join(faults)


@pytest.mark.parametrize('path', RUNTIME, ids=lambda path: str(path.relative_to(ROOT)))
def test_words_of_the_program_are_those_of_the_field(path: Path) -> None:
    faults = faults_of(path, IN_CODE)
    assert not faults, '\n'.join(faults)


@pytest.mark.parametrize(
    ('text', 'words'),
    [
        ('"""It tells the wind."""', ['tells']),
        ('told = 1', ['told']),
        ('x = y if y is None else 0  # begin anew', ['anew']),
        ('"so many samples, so that it is so long as it is"', ['so many']),
        ('"understands, standard, a stand of trees"', []),
    ],
)
def test_the_check_sees_what_it_looks_for(text: str, words: list[str]) -> None:
    found = [match[0] for _, piece in prose_of(text) for match in FINDER.finditer(piece)]
    assert found == words
