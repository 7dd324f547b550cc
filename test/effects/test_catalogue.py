"""Every effect is well-formed, and the catalogue holds what the contract promises."""

import ast
import inspect
import math
from pathlib import Path

import pint
import pytest

from tendon_ros import effects
from tendon_ros.base.effect import HOOKS
from tendon_ros.base.errors import EffectError
from tendon_ros.effects import catalogue, data_sheet, find

CATALOGUE = catalogue()
EFFECTS = list(CATALOGUE.values())
UNITS = pint.UnitRegistry()
KINDS = {'pulley', 'cable', 'coupling', 'motor', 'sensor', 'contact'}
SENSORS = {'angle', 'velocity', 'motor_torque', 'contact_force', 'contact_torque', 'loop_torque'}
#: what a law of each hook is called with before its parameters
STATE = {
    'torque': ['theta', 'omega', 't'],
    'budget': ['speed', 'side', 'load'],
    'elongation': ['delta', 't'],
    'relaxation': ['delta', 'z'],
    'tension': ['delta', 'rate', 'z', 't'],
    'winding': ['theta'],
}
#: effect ids that other programs rely on, and where they act
CONTRACT = {
    'coulomb_friction': {'pulley'},
    'tension_friction': {'pulley'},
    'stribeck_friction': {'pulley'},
    'presliding_friction': {'pulley'},
    'asymmetric_friction': {'pulley'},
    'viscous_friction': {'pulley'},
    'pretension': {'cable'},
    'cable_stiffness': {'cable', 'coupling'},  # the contract has cables; a shaft yields as well
    'cable_hysteresis': {'cable'},
    'cable_creep': {'cable'},
    'cable_slip': {'cable', 'coupling'},
    'backlash': {'motor', 'coupling'},
    'eccentricity': {'pulley'},
    'inertia': {'pulley'},
    'gravity': {'pulley'},
    'joint_spring': {'pulley'},
    'torque_gain': {'motor'},
    'torque_bias': {'motor'},
    'torque_ripple': {'motor'},
    'torque_saturation': {'motor'},
    'encoder_offset': {'sensor'},
    'encoder_gain': {'sensor'},
    'sensor_delay': {'sensor'},
    'sensor_rectified': {'sensor'},
    'load_cell_gain': {'sensor'},
    'load_cell_bias': {'sensor'},
    'contact_stiffness': {'contact'},
    'contact_position': {'contact'},
    'disturbance': {'pulley'},
}

over_effects = pytest.mark.parametrize('effect', EFFECTS, ids=lambda e: e.id)
over_laws = pytest.mark.parametrize('effect', [e for e in EFFECTS if e.law], ids=lambda e: e.id)


def arguments(function):
    """Return the names of a function's arguments, all of them plain."""
    parameters = inspect.signature(function).parameters.values()
    assert all(p.kind is p.POSITIONAL_OR_KEYWORD and p.default is p.empty for p in parameters), (
        function
    )
    return [p.name for p in parameters]


def test_every_file_is_found():
    files = {path.stem for path in Path(effects.__file__).parent.glob('*.py')} - {'__init__'}
    assert set(CATALOGUE) == files != set()


def test_a_new_file_is_found_without_a_register(tmp_path, monkeypatch):
    source = Path(effects.__file__).with_name('inertia.py').read_text()
    (tmp_path / 'added_effect.py').write_text(source.replace("id='inertia'", "id='added_effect'"))
    monkeypatch.setattr(effects, '__path__', [*effects.__path__, str(tmp_path)])
    found = catalogue.__wrapped__()
    assert set(found) - set(CATALOGUE) == {'added_effect'}
    assert list(found) == sorted(found)


def test_the_catalogue_cannot_be_changed():
    with pytest.raises(TypeError):
        CATALOGUE['new'] = EFFECTS[0]


def test_find():
    assert find('gravity') is CATALOGUE['gravity']
    with pytest.raises(EffectError, match=r"no effect 'gravitty'; there are .*gravity, inertia"):
        find('gravitty')


@pytest.mark.parametrize('name', CONTRACT)
def test_contract(name):
    assert set(find(name).kinds) == CONTRACT[name]


@over_effects
def test_declaration(effect):
    assert CATALOGUE[effect.id] is effect
    assert effect.title
    assert set(effect.kinds) <= KINDS
    assert effect.kinds
    assert effect.parameters
    assert effect.law or effect.modify, 'does nothing'
    assert bool(effect.law) == bool(effect.hook)
    assert ('sensor' in effect.kinds) == bool(effect.sensors)
    assert set(effect.sensors) <= SENSORS
    if effect.stateful:
        assert effect.hook in ('relaxation', 'tension')


@over_effects
def test_parameters(effect):
    names = [p.name for p in effect.parameters]
    assert len(set(names)) == len(names)
    for p in effect.parameters:
        assert p.name.isidentifier()
        assert p.meaning
        assert math.isfinite(p.low)
        assert math.isfinite(p.high)
        assert p.low < p.high
        assert p.low <= p.typical <= p.high
        if not p.shapes_only:
            assert p.low <= p.neutral <= p.high
            assert p.typical != p.neutral
    assert any(not p.shapes_only for p in effect.parameters), 'cannot be switched off'


@over_effects
def test_units_are_si(effect):
    for p in effect.parameters:
        assert UNITS.Quantity(1.0, p.unit).to_base_units().magnitude == pytest.approx(1.0)


@over_effects
def test_neutral_and_typical_are_complete(effect):
    names = [p.name for p in effect.parameters]
    assert list(effect.neutral) == list(effect.typical) == names
    assert all(math.isfinite(value) for value in effect.neutral.values())


@over_effects
def test_data_sheet(effect):
    sheet = data_sheet(effect.id)
    title, colon, meaning = sheet.partition('\n')[0].partition(': ')
    assert title
    assert colon
    assert meaning.endswith('.')
    assert '\n\nEquation' in sheet
    assert '\n\nSource: ' in sheet


@over_effects
def test_functions_take_the_declared_parameters(effect):
    names = [p.name for p in effect.parameters]
    if effect.law:
        assert effect.hook in HOOKS
        # the name of the first is free: a law may call its speed omega
        given = arguments(effect.law)
        assert len(given) == len(set(given))
        assert given[len(STATE[effect.hook]) :] == names
    if effect.modify:
        assert arguments(effect.modify) == ['numbers', 'index', *names]
    if effect.switches:
        assert arguments(effect.switches) == names


@over_effects
def test_what_is_alike_exists(effect):
    if effect.alike:
        sizes = effect.alike(**effect.typical)
        assert arguments(effect.alike) == [p.name for p in effect.parameters]
        assert all(find(name).parameters[0].low <= size for name, size in sizes.items())


@over_laws
def test_law_stands_alone(effect):
    """The kernel joins the laws' sources into one file, where nothing else of theirs exists."""
    source = inspect.getsource(effect.law)
    [function] = ast.parse(source).body
    assert function.name == f'{effect.id}_law'
    assert not function.decorator_list
    assert not {'exp', 'tanh'} & {
        node.attr for node in ast.walk(function) if isinstance(node, ast.Attribute)
    }, 'too slow for the kernel'
    here = {'math': math, '__builtins__': {'abs': abs, 'min': min, 'max': max}}
    function.returns = None
    for argument in function.args.args:
        argument.annotation = None
    exec(compile(ast.unparse(function), effect.id, 'exec', dont_inherit=True), here)
    given = [0.3, 1.0, 0.5, 7.0][: len(STATE[effect.hook])] + list(effect.typical.values())
    assert here[function.name](*given) == effect.law(*given)
