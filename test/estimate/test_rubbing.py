"""How uncertain angles are that no encoder of the estimate reads."""

from dataclasses import replace

import pytest

from tendon_ros.estimate.rigid import Rigid
from tendon_ros.estimate.rubbing import unsure_angles
from tendon_ros.model.instrument_file import load_instrument


def test_a_joint_is_as_uncertain_as_a_diagnosis_left_it():
    grasper = load_instrument('davinci_grasper')
    index = {name: grasper.index(name) for name in ('motor', 'gear', 'spindle', 'drum', 'jaw')}
    free = [i for name, i in index.items() if name != 'motor']
    rigid = Rigid(grasper, free)
    plain = unsure_angles(grasper, rigid, {index['motor']: 1e-4})
    # the drum turns by 2.7 / 3 of the spindle
    assert plain[index['spindle']] == pytest.approx(1e-4)
    assert plain[index['jaw']] == pytest.approx(0.9e-4)
    sensors = tuple(
        replace(s, misfit={'spindle': 3e-3, 'jaw': 4.5e-3}[s.of])
        if s.kind == 'angle' and s.of in ('spindle', 'jaw')
        else s
        for s in grasper.sensors
    )
    missed = unsure_angles(replace(grasper, sensors=sensors), rigid, {index['motor']: 1e-4})
    assert missed[index['motor']] == pytest.approx(1e-4)
    assert missed[index['spindle']] == pytest.approx(3e-3, rel=0.01)
    assert missed[index['jaw']] == pytest.approx(4.5e-3, rel=0.01)
    # no encoder there: like the worst of the others, by how far each turns
    assert missed[index['drum']] == pytest.approx(4.5e-3, rel=0.01)
    assert missed[index['gear']] == pytest.approx(5e-3, rel=0.01)
