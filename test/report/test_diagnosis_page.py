"""The report says everything a diagnosis says, for every verdict, and stands on its own."""

from dataclasses import replace
from html.parser import HTMLParser
import re

from tendon_ros.diagnose.result import Judged
from tendon_ros.report.diagnosis_evidence import evidence_sections
from tendon_ros.report.diagnosis_page import diagnosis_page
from tendon_ros.report.diagnosis_verdict import headline, LABELS
from tendon_ros.report.diagnosis_words import channel_words, effect_words


class Text(HTMLParser):
    """Collects the text of a page, and checks that what opens also closes."""

    VOID = ('meta', 'img', 'source')

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.parts: list[str] = []

    def handle_starttag(self, tag, attrs):
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if 'style' not in self.open:
            self.parts.append(data)


def text_of(page: str) -> str:
    """Return what a reader sees of a page, blanks made even."""
    parser = Text()
    parser.feed(page)
    assert parser.open == []
    return ' '.join(' '.join(parser.parts).split())


def test_page_says_all_that_the_diagnosis_says(case, page, any_name):
    diagnosis, evidence = case(any_name)
    text = text_of(page(any_name))
    assert LABELS[diagnosis.verdict] in text
    assert ' '.join(headline(diagnosis).split()) in text
    for gap in (*diagnosis.gap, *diagnosis.closed_loop):
        assert channel_words(gap.channel) in text
    for cause in diagnosis.causes:
        assert effect_words(cause.effect, cause.place) in text
        assert all(f'{name}: ' in text for name in cause.parameters)
    for judged in diagnosis.candidates:
        assert judged.why_not in text
    for step in diagnosis.next_experiment:
        assert step.do in text
        assert step.add_channel in text
    for line in (*diagnosis.left_out, *evidence.recordings):
        assert line in text
    for floor in evidence.floors:
        assert floor.how in text
    for moved in evidence.moved:
        assert moved.quantity in text


def test_verdict_comes_before_everything_else(page):
    made = page('three_causes')
    assert made.index('class="headline"') < made.index('class="tiles"') < made.index('<main>')
    order = [made.index(f'id="{name}"') for name in ('where', 'which', 'how-far', 'traces')]
    assert order == sorted(order)


def test_a_doubt_stands_with_the_verdict_and_takes_its_green(case):
    diagnosis, evidence = case('one_cause')
    sure = diagnosis_page(diagnosis, evidence)
    doubt = 'a torque reaches 28 times what its motor can'
    made = diagnosis_page(diagnosis.model_copy(update={'doubts': (doubt,)}), evidence)
    assert 'class="banner good"' in sure
    assert 'class="banner fair"' in made
    assert made.index('class="headline"') < made.index(f'But {doubt}.') < made.index('<main>')


def test_page_fetches_nothing(page, any_name):
    made = page(any_name)
    assert not re.search(r'https?:|<link|@import|url\(|<script', made)
    addresses = re.findall(r'(?:src|srcset)="([^"]{0,22})', made)
    assert addresses
    assert set(addresses) == {'data:image/png;base64,'}


def test_every_link_leads_somewhere(page, any_name):
    made = page(any_name)
    links = set(re.findall(r'href="#([^"]+)"', made))
    anchors = re.findall(r'<section id="([^"]+)"', made)
    assert len(anchors) == len(set(anchors))
    assert links <= set(anchors)


def test_no_gap_names_no_cause_and_sends_nobody_looking(page):
    text = text_of(page('no_gap'))
    assert 'None is named as a cause.' in text
    for heading in (
        'Where it lies',
        'What is left',
        'Next experiment',
        'Closed loop',
        'What each is worth',
    ):
        assert heading not in text


def test_equals_are_named_with_the_cause(page):
    text = text_of(page('three_causes'))
    sentence = 'These channels cannot tell it from pretension of cable 12 and cable L3 stiffness.'
    assert sentence in text
    assert '× 0.900' in text
    assert '0.884 … 0.917' in text


def test_unknown_place_is_told_only_when_something_unknown_is_likely(case, page):
    rest = 'What remains lies most likely at pulley 2, else at cable 12 (fast motion).'
    assert rest in text_of(page('partly'))
    diagnosis, evidence = case('three_causes')
    rest = diagnosis.unexplained.model_copy(update={'where': ('pulley_2',)})
    bare = replace(evidence, traces=(), closed_loop=())
    known = diagnosis_page(diagnosis.model_copy(update={'unexplained': rest}), bare)
    assert 'What remains lies' not in text_of(known)


def test_many_traces_are_chosen_from_and_said_to_be(page):
    made = page('unexplained')
    assert made.count('<picture>') == 6
    text = text_of(made)
    assert 'Of 48 traces, the 6 that show most' in text
    assert 'run_23 motor L torque' in text


def test_pictures_come_for_dark_pages_too(page):
    made = page('one_cause')
    assert made.count('media="screen and (prefers-color-scheme: dark)"') == 1


def test_candidates_that_cannot_show_are_grouped_by_reason(page):
    text = text_of(page('three_causes'))
    assert 'Inertia pulley M, pulley L, pulley 1 leaves no trace at these speeds' in text


def test_reasons_are_given_in_words(case):
    diagnosis, evidence = case('three_causes')
    alike = tuple(
        Judged(
            effect='coulomb_friction',
            place=place,
            probability=0.4,
            identifiable=False,
            why_not=f'the data cannot tell it from coulomb_friction at {other}',
        )
        for place, other in (('pulley_1', 'pulley_12'), ('pulley_12', 'pulley_1'))
    )
    told = diagnosis.model_copy(update={'candidates': alike})
    text = text_of(diagnosis_page(told, replace(evidence, traces=(), closed_loop=())))
    for other in ('1', '12'):
        assert f'the data cannot tell it from Coulomb friction on pulley {other}' in text


def test_what_only_holds_is_no_cause_and_said_to_be_none(page):
    said = text_of(page('unexplained'))
    assert 'None is named as a cause' in said
    assert 'may stand in for something else' in said
    assert 'Used, though not named.' in said
    assert '31 %' in said
    assert 'Used, though not named.' not in text_of(page('partly'))


def of_recordings(case, count: int):
    """Return the table of what each of some recordings tells."""
    diagnosis, evidence = case('three_causes')
    told = [replace(evidence.told[0], recording=f'run_{k}', value=0.1 * k) for k in range(count)]
    sections = evidence_sections(diagnosis, replace(evidence, told=tuple(told)))
    (section,) = (s for s in sections if s.anchor == 'recordings')
    return section.blocks[-1]


def test_sizes_of_few_recordings_stand_side_by_side(case):
    table = of_recordings(case, 3)
    assert table.header == ('size', 'run_0', 'run_1', 'run_2')
    (row,) = table.rows
    assert row[0].endswith(': coefficient')
    assert [cell.split()[0] for cell in row[1:]] == ['0.000', '0.100', '0.200']


def test_sizes_of_many_recordings_stand_below_each_other(case):
    table = of_recordings(case, 12)
    assert [row[0] for row in table.rows] == [f'run_{k}' for k in range(12)]
    assert table.header[0] == 'recording'
    assert len({row[1] for row in table.rows}) == 12
