"""Imports run downward, each outside dependency has one home, and only cli prints."""

import ast
from pathlib import Path
import shutil
import subprocess
import sys

import pytest

ROOT = Path(__file__).parent.parent
PACKAGE = ROOT / 'tendon_ros'

#: a line that breaks a wall, the module that it would stand in, and the contract that must object
BREACHES = [
    ('base/errors.py', 'import tendon_ros.model', 'imports run downward only'),
    ('base/__init__.py', 'from rclpy.node import Node', 'rclpy and messages live in nodes'),
    ('model/__init__.py', 'def late():\n    import rosbags', 'bag libraries live in bags'),
    ('cli/__init__.py', 'import matplotlib.pyplot', 'plotting and templates live in report'),
    ('estimate/__init__.py', 'from numba import njit', 'the compiler lives in model.engine'),
    ('bags/__init__.py', 'import argparse', 'argparse lives in cli and nodes'),
]


def lint_imports(folder: Path) -> subprocess.CompletedProcess[str]:
    """Check the walls of the package that stands in a folder."""
    code = 'import sys; from importlinter.cli import lint_imports as run; sys.exit(run())'
    return subprocess.run(
        [sys.executable, '-c', code], cwd=folder, text=True, capture_output=True, check=False
    )


def test_walls_stand():
    pytest.importorskip('importlinter')
    done = lint_imports(ROOT)
    assert done.returncode == 0, done.stdout + done.stderr


def test_each_wall_notices_a_breach(tmp_path):
    pytest.importorskip('importlinter')
    shutil.copytree(PACKAGE, tmp_path / 'tendon_ros')
    shutil.copy(ROOT / 'pyproject.toml', tmp_path)
    for module, line, _ in BREACHES:
        with (tmp_path / 'tendon_ros' / module).open('a') as file:
            file.write(f'\n{line}\n')
    one, two = effect_files(tmp_path / 'tendon_ros')[:2]
    one.write_text(f'import tendon_ros.effects.{two.stem}\n')
    done = lint_imports(tmp_path)
    for contract in [contract for _, _, contract in BREACHES] + ['effects do not know each other']:
        assert f'{contract} BROKEN' in done.stdout, done.stdout + done.stderr


def effect_files(package: Path) -> list[Path]:
    """Return the modules of the catalogue."""
    return sorted(path for path in (package / 'effects').glob('*.py') if path.stem != '__init__')


def printing(path: Path) -> list[int]:
    """Return the lines of a module that print."""
    return [
        node.lineno
        for node in ast.walk(ast.parse(path.read_text()))
        if isinstance(node, ast.Call)
        and isinstance(node.func, ast.Name)
        and node.func.id in {'print', 'pprint'}
    ]


def test_only_the_command_line_prints():
    modules = [path for path in PACKAGE.rglob('*.py') if path.parent.name != 'cli']
    assert modules
    assert {str(path): printing(path) for path in modules if printing(path)} == {}
