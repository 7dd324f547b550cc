"""An interrupted diagnosis goes on where it was, and never with another's memory."""

from dataclasses import replace

import numpy as np
import pytest

from tendon_ros.base.recording import Channel
from tendon_ros.diagnose.memory import Memory
from tendon_ros.identify.candidate import Candidate
from tendon_ros.identify.explanation import Model
from tendon_ros.identify.magnitude import Magnitude
from tendon_ros.model.instrument_file import load_instrument


@pytest.fixture(scope='module')
def body():
    return load_instrument('single_body')


@pytest.fixture(scope='module')
def run(body, measured_on):
    return measured_on(
        body,
        ('gravity', 'pulley_body', {'torque': 0.3, 'phase': 0.3}),
        settings=(('duration', '6 s'), ('amplitude', '30 deg')),
    )


class Stopped(Exception):  # noqa: N818
    """Somebody pressed Ctrl-C."""


def stopping(at):
    """Return a report that interrupts when something that begins so is begun."""

    def report(what, _):
        if what.startswith(at):
            raise Stopped

    return report


@pytest.fixture
def interrupted(tmp_path, body, run, quick):
    """Return the file that an interrupted diagnosis leaves."""
    path = tmp_path / 'unfinished.json'
    with pytest.raises(Stopped):
        quick([run], body, memory=Memory(path, [run], body), report=stopping('challenging'))
    return path


def test_goes_on_and_comes_to_the_same(interrupted, body, run, quick):
    whole = quick([run], body).diagnosis
    told = []
    again = quick(
        [run], body, memory=Memory(interrupted, [run], body), report=lambda w, _: told.append(w)
    ).diagnosis
    assert 'looking for causes, round 1' not in told
    assert told
    assert [(c.effect, c.place) for c in again.causes] == [
        (c.effect, c.place) for c in whole.causes
    ]
    assert again.verdict == whole.verdict
    for one, other in zip(again.causes, whole.causes, strict=True):
        assert one.probability == pytest.approx(other.probability, abs=0.02)
        for name, fitted in one.parameters.items():
            assert fitted.value == pytest.approx(other.parameters[name].value, rel=0.02)


def test_a_stop_before_the_first_step_leaves_nothing(tmp_path, body, run, quick):
    path = tmp_path / 'unfinished.json'
    memory = Memory(path, [run], body)
    with pytest.raises(Stopped):
        quick([run], body, memory=memory, report=stopping('looking for causes, round 1'))
    assert memory.models() == []


def test_other_inputs_do_not_use_it(interrupted, body, run):
    assert Memory(interrupted, [run], body).models()
    torque = run['actuator/pulley_body/effort']
    other = run.with_channels([Channel(torque.name, torque.time, 1.0001 * torque.value)])
    heavier = replace(body, pulleys=tuple(replace(p, inertia=2e-3) for p in body.pulleys))
    assert Memory(interrupted, [other], body).models() == []
    assert Memory(interrupted, [run, other], body).models() == []
    assert Memory(interrupted, [run], heavier).models() == []
    # what happened in one recording is remembered by its name
    assert Memory(interrupted, [replace(run, name='other')], body).models() == []
    assert Memory(interrupted, [run], body, ['backlash']).models() == []


@pytest.mark.parametrize('text', ['', '{', '[]', '{"key": 1}', 'null'])
def test_a_spoilt_file_is_no_obstacle(tmp_path, body, run, text):
    path = tmp_path / 'unfinished.json'
    path.write_text(text)
    assert Memory(path, [run], body).models() == []


def test_a_disk_that_refuses_ends_no_diagnosis(tmp_path, body, run):
    memory = Memory(tmp_path / 'gone' / 'unfinished.json', [run], body)
    assert memory.refused == ''
    memory.keep([Model((), (), {}, np.zeros(0))])
    assert 'No such file' in memory.refused
    assert len(memory.models()) == 1


def test_what_channels_weigh_by_is_remembered(tmp_path, body, run):
    path = tmp_path / 'unfinished.json'
    memory = Memory(path, [run], body)
    assert memory.weighed() is None
    found = Model((), (), {}, np.array([0.5, -1.0]))
    memory.keep([found, found])
    memory.weigh(found)
    again = Memory(path, [run], body)
    assert again.models() == []
    assert again.weighed().moved.tolist() == [0.5, -1.0]
    again.keep([found])
    later = Memory(path, [run], body)
    assert len(later.models()) == 1
    assert later.weighed() is not None


def test_causes_come_back_as_they_were(tmp_path, body, run):
    causes = (
        Candidate('viscous_friction', 'pulley_body', stated=True, least=-0.02),
        Candidate('sensor_delay', 'speed_body', opened=('filtered',)),
        Candidate('cable_slip', 'cable_a', only='free', magnitude=Magnitude(2.0, 3.0, 4.0)),
    )
    model = Model(causes, ((1.0,), (2.0, 0.5), (3.0, 4.0)), {}, np.array([0.5]), ('pulley_body',))
    path = tmp_path / 'unfinished.json'
    Memory(path, [run], body).keep([model])
    [again] = Memory(path, [run], body).models()
    assert (again.causes, again.z, again.rubs) == (causes, model.z, model.rubs)


def test_forgetting_twice_is_fine(interrupted, body, run):
    memory = Memory(interrupted, [run], body)
    memory.forget()
    memory.forget()
    assert not interrupted.exists()
    assert memory.models() == []
