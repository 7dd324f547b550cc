"""docs/effects.md says what the catalogue is."""

from pathlib import Path

import pytest

from tendon_ros.base.errors import TendonError
from tendon_ros.effects import catalogue
from tendon_ros.report.effects_page import page, PageError, section, write_page

DOCS = Path(__file__).parent.parent.parent / 'docs'


def test_page_is_current():
    stored = (DOCS / 'effects.md').read_text(encoding='utf-8')
    assert stored == page(), 'run: tendon effects --markdown docs/effects.md --overwrite'


def test_page_has_every_effect():
    text = page()
    for name, effect in catalogue().items():
        assert text.count(f'\n## {name}\n') == 1
        assert f'[`{name}`](#{name})' in text
        for parameter in effect.parameters:
            assert f'| `{parameter.name}` | {parameter.unit} |' in section(name)


def test_section_shows_the_equation_as_a_block():
    lines = section('coulomb_friction').split('\n')
    at = lines.index('Equation:')
    assert lines[at + 1] == ''
    assert lines[at + 2].startswith('    |tau| <= torque')
    assert '``' not in section('cable_hysteresis')


def test_section_tells_neutral_from_shape():
    rows = [line for line in section('stribeck_friction').split('\n') if line.startswith('| `')]
    assert rows[0].endswith('| 0 | 0 | 100000 | 0.1 |')
    assert rows[2].endswith('| – | 0.001 | 1000 | 0.1 |')


def test_write(tmp_path):
    write_page(tmp_path / 'effects.md')
    assert (tmp_path / 'effects.md').read_text(encoding='utf-8') == page()


def test_unwritable_place_is_a_users_mistake(tmp_path):
    with pytest.raises(PageError, match=r'effects\.md: cannot be written .*folder that exists'):
        write_page(tmp_path / 'missing' / 'effects.md')
    assert issubclass(PageError, TendonError)
