"""The engine: one file for each structure, compiled or plain, never stale."""

import ast
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
import fcntl
import sys
import time

import numpy as np
import pytest

from tendon_ros.base.errors import SimulationError
from tendon_ros.model import engine
from tendon_ros.model.instrument import EffectUse
from tendon_ros.model.layout import structure_of


@pytest.fixture
def structure(body):
    return structure_of(body())


def test_the_file_stands_alone(structure):
    # every name that a function uses is its own, the file's, or Python's
    tree = ast.parse(engine.joined_source(structure, compiled=False))
    known = set(dir(__builtins__)) | set(__builtins__ if isinstance(__builtins__, dict) else ())
    known |= {'math'}
    for node in tree.body:
        if isinstance(node, ast.FunctionDef):
            known.add(node.name)
        elif isinstance(node, ast.Assign):
            known |= {n.id for n in ast.walk(node) if isinstance(n, ast.Name)}
    for function in (node for node in tree.body if isinstance(node, ast.FunctionDef)):
        names = [n for n in ast.walk(function) if isinstance(n, ast.Name)]
        own = {n.id for n in names if isinstance(n.ctx, ast.Store)}
        own |= {a.arg for a in function.args.args}
        used = {n.id for n in names if isinstance(n.ctx, ast.Load)}
        assert used <= own | known, function.name


def test_no_name_of_the_file_means_two_things(body):
    # its parts are joined: a constant of one would silently be another's offset
    effects = (EffectUse('presliding_friction', 'pulley_body', {'torque': 0.1, 'angle': 1e-3}),)
    tree = ast.parse(engine.joined_source(structure_of(body(effects=effects)), compiled=False))
    names = [node.name for node in tree.body if isinstance(node, ast.FunctionDef)]
    for node in tree.body:
        if isinstance(node, ast.Assign):
            written = (n for target in node.targets for n in ast.walk(target))
            names += [n.id for n in written if isinstance(n, ast.Name)]
    assert not [name for name, count in Counter(names).items() if count > 1]


def test_an_engine_that_does_not_exist_is_none(structure):
    with pytest.raises(SimulationError, match="'complied'; give auto, compiled, plain"):
        engine.engine_for(structure, 'complied')


def test_a_changed_law_is_another_file(structure, monkeypatch, tmp_path):
    monkeypatch.setenv('XDG_CACHE_HOME', str(tmp_path))
    engine.engine_for.cache_clear()
    first = engine.engine_for(structure, 'plain').module.__file__
    monkeypatch.setattr(engine, '__version__', '99')
    engine.engine_for.cache_clear()
    second = engine.engine_for(structure, 'plain').module.__file__
    engine.engine_for.cache_clear()
    assert first != second
    assert len(list((tmp_path / 'tendon_ros').glob('kernel_*.py'))) == 2


def test_a_damaged_file_is_written_anew(structure, monkeypatch, tmp_path):
    monkeypatch.setenv('XDG_CACHE_HOME', str(tmp_path))
    monkeypatch.setattr(engine, '__version__', '98')
    engine.engine_for.cache_clear()
    module = engine.engine_for(structure, 'plain').module
    path = next((tmp_path / 'tendon_ros').glob('kernel_*.py'))
    whole = path.read_text()
    path.write_text('raise SystemExit')
    monkeypatch.delitem(sys.modules, module.__name__)
    engine.engine_for.cache_clear()
    engine.engine_for(structure, 'plain')
    engine.engine_for.cache_clear()
    assert path.read_text() == whole


def test_without_the_compiler(structure, monkeypatch):
    monkeypatch.setattr(engine, 'compiler_installed', lambda: False)
    engine.engine_for.cache_clear()
    assert engine.engine_for(structure, 'auto').name == 'plain'
    with pytest.raises(SimulationError, match='pip install numba'):
        engine.engine_for(structure, 'compiled')
    engine.engine_for.cache_clear()


def test_plain_arrays_are_lists(structure):
    plain = engine.engine_for(structure, 'plain')
    given = np.arange(3.0)
    assert plain.array(given) == [0.0, 1.0, 2.0]
    assert all(type(n) is int for n in plain.array(np.arange(3)))


def test_who_comes_while_another_process_compiles_waits_for_its_machine_code(tmp_path):
    kernel, known = tmp_path / 'kernel_new.py', tmp_path / 'kernel_known.py'
    for path in (kernel, known):
        path.write_text('ONE = 1')
    (tmp_path / '__pycache__').mkdir()
    (tmp_path / '__pycache__' / 'kernel_known.entered-1.py312.nbi').touch()
    with (
        ThreadPoolExecutor() as pool,
        kernel.open() as file,
        known.open() as other,
    ):
        for one in (file, other):
            fcntl.flock(one, fcntl.LOCK_EX)
        assert engine._load(known, ahead=True).ONE == 1
        waiting = pool.submit(engine._load, kernel, ahead=True)
        time.sleep(0.2)
        assert not waiting.done()
        fcntl.flock(file, fcntl.LOCK_UN)
        assert waiting.result().ONE == 1


@pytest.mark.skipif(not engine.compiler_installed(), reason='numba is not installed')
def test_no_process_runs_a_kernel_that_it_has_compiled_itself(structure):
    # it would round otherwise than the same code loaded
    stats = engine.engine_for(structure, 'compiled').module.entered.stats
    assert sum(stats.cache_hits.values()) == 1
    assert not stats.cache_misses


def test_a_file_that_no_other_process_can_import_tells_what_is_wrong(tmp_path):
    broken = tmp_path / 'kernel_broken.py'
    broken.write_text("raise LookupError('this law')")
    for _ in range(2):
        with pytest.raises(LookupError, match='this law'):
            engine._load(broken, ahead=True)
