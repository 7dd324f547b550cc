"""`tendon reproduce` writes what it says, and docs/paper.md says what it writes."""

import csv
from pathlib import Path
import re
import struct

import pytest

from tendon_ros.cli.main import main
from tendon_ros.model.paper.statement import Use
from tendon_ros.report import paper_page
from tendon_ros.report.paper_page import HEADER, reproduce
from tendon_ros.report.paper_parts import profile_part

DOCS = Path(__file__).parent.parent.parent / 'docs'

FIGURES = {
    'fig07.png',
    'fig10.png',
    'fig11.png',
    'fig12.png',
    'fig13.png',
    'fig15.png',
    'fig15_where.png',
    'equation6.png',
}


@pytest.fixture(scope='module')
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp('paper')
    done = []
    statements = reproduce(folder, lambda title, part: done.append((title, part)))
    return folder, statements, done


def test_figures_are_pictures(made):
    folder, _, _ = made
    assert {path.name for path in folder.glob('*.png')} == FIGURES
    for name in FIGURES:
        png = (folder / name).read_bytes()
        assert png.startswith(b'\x89PNG')
        width, height = struct.unpack('>II', png[16:24])
        assert width == 936  # 5.2 in at 180 dots
        assert height > 400
        # an empty frame with its labels takes some 10 kB
        assert 20_000 < len(png) < 150_000


def test_progress_reaches_its_end(made):
    _, _, done = made
    parts = [part for _, part in done]
    assert parts == sorted(parts)
    assert parts[-1] == 1.0


def test_table_is_the_statements(made):
    folder, statements, _ = made
    rows = list(csv.reader((folder / 'table.csv').read_text(encoding='utf-8').splitlines()))
    assert tuple(rows[0]) == HEADER
    assert len(rows) - 1 == len(statements) > 40
    for row, statement in zip(rows[1:], statements, strict=True):
        assert row[:3] == [statement.figure, statement.what, statement.said]
        assert row[3] == statement.found_text
        assert row[4:6] == [statement.use, 'ok' if statement.holds else 'not']
    lines = (folder / 'table.md').read_text(encoding='utf-8').splitlines()
    assert len(lines) == len(statements) + 2


def test_page_shows_every_figure_and_number(made):
    folder, statements, _ = made
    text = (folder / 'index.html').read_text(encoding='utf-8')
    assert text.count('src="data:image/png;base64,') == len(FIGURES)
    assert text.count('<td class="mark"') == len(statements)
    checks = [s for s in statements if s.use is Use.CHECK]
    held = sum(s.holds for s in checks)
    assert f'{held} of {len(checks)} statements' in text


def _rows(text):
    """Return the cells of the statements' table in Markdown."""
    table = text.partition(f'| {" | ".join(HEADER)} |\n')[2]
    lines = re.match(r'(\|.*\n)+', table)[0].splitlines()[1:]
    return [[cell.strip() for cell in line.strip('|').split(' | ')] for line in lines]


def test_docs_show_the_table_as_it_is(made):
    folder, _, _ = made
    stored = _rows((DOCS / 'paper.md').read_text(encoding='utf-8'))
    fresh = _rows((folder / 'table.md').read_text(encoding='utf-8'))
    assert len(stored) == len(fresh), 'run: tendon reproduce --out DIR, copy table.md to the docs'
    for old, new in zip(stored, fresh, strict=True):
        assert old[:3] + old[4:] == new[:3] + new[4:]
        (old_number, old_unit), (number, unit) = (
            cell[3].partition(' ')[::2] for cell in (old, new)
        )
        assert old_unit == unit
        # figures may move in their last digits with the integrator
        assert float(number) == pytest.approx(float(old_number), rel=0.02, abs=0.01)


def test_docs_show_the_figures():
    text = (DOCS / 'paper.md').read_text(encoding='utf-8')
    shown = set(re.findall(r'\]\(figures/([^)]+)\)', text))
    assert shown == FIGURES
    for name in shown:
        assert (DOCS / 'figures' / name).stat().st_size < 150_000


def test_command_prints_the_table_and_the_reasons(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(paper_page, 'PARTS', (profile_part,))
    assert main(['reproduce', '--out', str(tmp_path / 'new' / 'folder')]) == 0
    out = capsys.readouterr().out
    assert out.startswith('Figs. 12 and 13: the operating force\n')
    assert re.search(r'Fig\. 13 +force at the first 5 deg +about 18 N +17\.\d+ N +identif', out)
    assert re.search(r'change from first .* not\n +cannot be: .* without friction', out)
    assert re.search(r'\d+ statements hold, 1 do not: .*index\.html\n', out)
    assert (tmp_path / 'new' / 'folder' / 'index.html').is_file()


def test_command_without_a_place_to_write_runs_nothing(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(paper_page, 'PARTS', (pytest.fail,))
    (tmp_path / 'file').write_text('')
    assert main(['reproduce', '--out', str(tmp_path / 'file')]) == 2
    assert 'file, not a folder' in capsys.readouterr().err
