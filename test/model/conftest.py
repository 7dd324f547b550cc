"""The measured rig and the independent reference, which the bench shares with these tests."""

from dataclasses import replace
import importlib.util
from pathlib import Path

import numpy as np
import pytest

from tendon_ros.model.instrument import (
    Controller,
    Curve,
    Instrument,
    Loop,
    Motor,
    Pulley,
    Sensor,
)  # fmt: skip

BENCH = Path(__file__).resolve().parents[2] / 'bench'


def _module(name):
    spec = importlib.util.spec_from_file_location(f'bench_{name}', BENCH / f'{name}.py')
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope='session')
def bench_rig():
    """Return the module with the five-pulley rig, chains and the motion that is measured."""
    return _module('rig')


@pytest.fixture(scope='session')
def reference():
    """Return the class of the independent reference."""
    return _module('reference').Reference


@pytest.fixture(scope='session')
def FixedStep():
    """Return the class of the check at a fixed step."""
    return _module('fixed_step').FixedStep


@pytest.fixture(scope='session')
def press():
    """Return half a second in which the tip meets the wall, sticks, slides back and lets go."""
    t = 1e-3 * np.arange(500)
    degrees = np.interp(t, [0.0, 0.02, 0.12, 0.2, 0.35, 0.5], [0.0, 0.0, 5.0, 5.0, -2.0, -2.0])
    return np.deg2rad(np.stack([degrees, 2.0 * np.sin(12.0 * t)], axis=1))


@pytest.fixture(scope='session')
def body():
    """Return a maker of a single driven body without a cable, its motor off: inertia 0.01."""

    def make(**changes):
        off = Controller(kp=0.0, ki=0.0, kd=0.0, limit=1.0)
        plain = Instrument(
            name='body',
            pulleys=(Pulley('body', 0.01, 0.0),),
            motors=(Motor('body', 'body', off),),
            sensors=(Sensor('encoder', 'angle', 'body', 'actuator/pulley_body/position'),),
        )
        return replace(plain, **changes)

    return make


@pytest.fixture(scope='session')
def linear():
    """Return a maker of the rig with straight cables of a stiffness [N/m], motors and wall off."""

    def make(rig, stiffness=17.5e3, damping=None):
        curve = Curve('cable', (0.0, 0.02), (0.0, 0.01 * stiffness))
        off = Controller(kp=0.0, ki=0.0, kd=0.0, limit=1.0)
        return replace(
            rig,
            loops=tuple(replace(loop, pretension=20.0) for loop in rig.loops),
            curves=(curve,),
            pulleys=tuple(
                replace(p, damping=p.damping if damping is None else damping) for p in rig.pulleys
            ),
            motors=tuple(replace(motor, controller=off) for motor in rig.motors),
            contacts=tuple(replace(c, enabled=False) for c in rig.contacts),
            effects=(),
        )

    return make


@pytest.fixture(scope='session')
def chained():
    """Return a maker of a tree of pulleys, each on a loop with one or two that come before it."""

    def make(parents, couplings=(), seed=0):
        rng = np.random.default_rng(seed)
        names = [f'p{n}' for n in range(len(parents) + 1)]
        loops = []
        for n, parent in enumerate(parents):
            route = {names[n + 1]: -0.03, names[parent % (n + 1)]: float(rng.uniform(0.01, 0.04))}
            if n > 1:
                route.setdefault(names[(parent + 1) % (n + 1)], -0.02)
            loops.append(Loop(f'c{n}', route, 'cable', float(rng.uniform(2.0, 8.0))))
        x = np.linspace(0.0, 4.0, 60)
        return Instrument(
            name='tree',
            pulleys=tuple(Pulley(n, float(rng.uniform(1e-4, 1e-2)), 0.02) for n in names),
            motors=(Motor('m', 'p0', Controller(kp=10.0, ki=50.0, kd=0.02, limit=2.0)),),
            loops=tuple(loops),
            couplings=tuple(couplings),
            curves=(Curve('cable', tuple(1e-3 * x), tuple(8.0 * x + x**4)),),
            sensors=(Sensor('encoder', 'angle', 'p0', 'actuator/pulley_p0/position'),),
        )

    return make
