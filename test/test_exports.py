"""What the package exports is what a type checker sees, and costs nothing until it is used."""

import ast
from pathlib import Path
import subprocess
import sys

import pytest

import tendon_ros


def test_every_name_is_there():
    for name in tendon_ros.__all__:
        assert getattr(tendon_ros, name) is not None
    assert dir(tendon_ros) == sorted(tendon_ros.__all__)


def test_type_checkers_see_the_same_names():
    tree = ast.parse(Path(tendon_ros.__file__).read_text(encoding='utf-8'))
    [checked] = [n for n in tree.body if isinstance(n, ast.If)]
    seen = {a.name: n.module for n in checked.body for a in n.names}
    homes = {name: f'tendon_ros.{home}' for name, home in tendon_ros._HOME.items()}
    assert seen == homes
    assert {*tendon_ros.__all__} == {*homes, '__version__'}


def test_a_name_that_is_not_there_is_named():
    with pytest.raises(AttributeError, match="no attribute 'simulator'"):
        tendon_ros.simulator  # noqa: B018


def test_nothing_is_loaded_before_it_is_asked_for():
    code = 'import sys, tendon_ros; print([m for m in sys.modules if m in ("numpy", "scipy")])'
    out = subprocess.run([sys.executable, '-c', code], capture_output=True, text=True, check=True)
    assert out.stdout.strip() == '[]'
