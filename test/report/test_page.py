"""Pages are self-contained, escaped and complete; figures do not write over themselves."""

import re

from matplotlib.figure import Figure
import pytest

from tendon_ros.base.errors import TendonError
from tendon_ros.report.page import (
    html,
    markdown,
    Page,
    Picture,
    Prose,
    ReportError,
    Section,
    Table,
    write,
)
from tendon_ros.report.style import dark, label_ends, panels, picture

TABLE = Table(
    ('a', 'b', 'c'), (('1', '<2>', 'ok'), ('3', '4|5', 'not')), 'both', ('good', 'bad'), 2
)
PAGE = Page(
    'A < B & C',
    ('first', 'second'),
    (
        Section('One', (Prose('text with <script>alert(1)</script>'), TABLE)),
        Section('Two', (Picture(b'\x89PNG', 'a "picture"', 'below'),)),
    ),
    'the end',
)


def test_texts_are_escaped():
    text = html(PAGE)
    assert '<title>A &lt; B &amp; C</title>' in text
    assert '<script' not in text
    assert '&lt;2&gt;' in text
    assert 'alt="a &#34;picture&#34;"' in text


def test_page_fetches_nothing_and_follows_the_reader():
    text = html(PAGE)
    assert re.findall(r'src="([^"]*)"', text) == ['data:image/png;base64,iVBORw==']
    assert not re.search(r'https?:|<link|@import|url\(', text)
    assert 'prefers-color-scheme: dark' in text
    assert 'name="viewport"' in text


def test_table_has_its_rows_and_marks():
    text = html(PAGE)
    assert text.count('<tr') == 3
    assert re.search(r'<tr class="bad">\s*<td data-title="a">3</td>', text)
    assert '<td class="mark" data-title="c">not</td>' in text
    assert 'class="cards"' not in text
    wide = Table(tuple('abcd'), (tuple('1234'),))
    assert 'class="cards"' in html(Page('wide', (), (Section('s', (wide,)),)))


def test_sections_are_linked_where_there_are_many():
    assert '<nav' not in html(PAGE)
    many = Page('many', (), tuple(Section(name, ()) for name in 'abc'))
    text = html(many)
    assert re.findall(r'href="#(s\d)"', text) == re.findall(r'<section id="(s\d)"', text)


def test_markdown_keeps_columns_apart():
    assert markdown(TABLE).splitlines() == [
        '| a | b | c |',
        '| --- | --- | --- |',
        '| 1 | <2> | ok |',
        '| 3 | 4\\|5 | not |',
    ]


def test_write_makes_folders_and_says_where_it_cannot(tmp_path):
    write(tmp_path / 'a' / 'b.txt', 'θ')
    assert (tmp_path / 'a' / 'b.txt').read_bytes() == 'θ'.encode()
    with pytest.raises(ReportError, match=r'b\.txt/c\.txt: cannot be written'):
        write(tmp_path / 'a' / 'b.txt' / 'c.txt', b'')
    assert issubclass(ReportError, TendonError)


def test_labels_do_not_overlap_and_keep_their_order():
    _, (axes,) = panels(2.5)
    axes.set_ylim(0.0, 1.0)
    label_ends(axes, [(0.5, 'b', '#000000'), (0.49, 'a', '#000000'), (0.9, 'c', '#000000')])
    heights = {text.get_text(): text.xy[1] for text in axes.texts}
    assert heights['a'] < heights['b'] < heights['c']
    assert 72 * 2.5 * (heights['b'] - heights['a']) > 10.0  # more than the letters' own height
    assert heights['c'] == pytest.approx(0.9)


def test_labels_follow_a_logarithmic_axis():
    _, (axes,) = panels(2.5)
    axes.set_yscale('log')
    axes.set_ylim(1.0, 100.0)
    label_ends(axes, [(10.0, 'middle', '#000000')])
    assert axes.texts[0].xy[1] == pytest.approx(0.5)


def test_picture_is_the_same_every_time():
    @picture
    def line() -> Figure:
        figure, (axes,) = panels(1.0)
        axes.plot([0, 1], [0, 1])
        return figure

    assert line() == line()
    assert line().startswith(b'\x89PNG')


def test_text_on_paper_is_readable():
    # WCAG's contrast of 4.5 to white, for the lightest colour in use
    parts = [int(dark('#E69F00')[k : k + 2], 16) / 255 for k in (1, 3, 5)]
    linear = [p / 12.92 if p <= 0.04045 else ((p + 0.055) / 1.055) ** 2.4 for p in parts]
    light = sum(w * p for w, p in zip((0.2126, 0.7152, 0.0722), linear, strict=True))
    assert 1.05 / (light + 0.05) > 4.4
