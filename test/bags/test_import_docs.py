"""The page on importing says what is so: its mapping loads, its units convert, fields are all."""

from pathlib import Path
import re

import pytest

from tendon_ros.bags.mapping import load_mapping, Source
from tendon_ros.base.quantity import factor

PAGE = (Path(__file__).resolve().parents[2] / 'docs' / 'import.md').read_text(encoding='utf-8')


def test_the_mapping_of_the_page_loads(tmp_path):
    [example] = re.findall(r'```yaml\n(.*?)```', PAGE, re.DOTALL)
    path = tmp_path / 'map.yaml'
    path.write_text(example, encoding='utf-8')
    mapping = load_mapping(path)
    assert mapping.channels['actuator/pulley_axis/position'].wrap == '360 deg'


@pytest.mark.parametrize('field', sorted(Source.model_fields))
def test_every_field_of_a_channel_is_on_the_page(field):
    assert f'`{field}' in PAGE


@pytest.mark.parametrize(
    ('unit', 'target'),
    [
        (unit, 'N m' if 'N m' in unit else 'rad')
        for unit in re.findall(r'^\| [^|`]+ \| `([^`]+)` \|$', PAGE, re.M)
        if unit != 'unit'
    ],
)
def test_units_of_the_page_convert(unit, target):
    assert factor(unit, target) > 0.0
