"""What is declared, what is imported and what gets installed agree."""

import ast
from importlib.metadata import distribution, requires
from pathlib import Path
import re
import shutil
import subprocess
import sys
from xml.etree import ElementTree

import pytest

import tendon_ros

ROOT = Path(__file__).parent.parent
PACKAGE = ROOT / 'tendon_ros'
XML = ElementTree.parse(ROOT / 'package.xml').getroot()
SCRIPTS = {
    entry.name: entry.value
    for entry in distribution('tendon_ros').entry_points
    if entry.group == 'console_scripts'
}
#: import names that are not the names in the index; pydantic brings its core
PIP_NAMES = {
    'yaml': 'pyyaml',
    'mcap_ros2': 'mcap-ros2-support',
    'pydantic_core': 'pydantic',
}
#: ROS packages that no rosdep key provides: imported where they are, done without where not
OPTIONAL_ROS = {'crtk_msgs'}


def imported(folder: Path) -> set[str]:
    """Return the top-level names outside of the standard library that modules import."""
    found = set()
    for path in folder.rglob('*.py'):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Import):
                found |= {alias.name.split('.')[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and not node.level:
                found.add((node.module or '').split('.')[0])
    return found - set(sys.stdlib_module_names) - {'tendon_ros'}


def pip_requirements(extra: str = '') -> set[str]:
    """Return the names that pip installs with the package, or with one of its extras."""
    return {
        re.match(r'[\w-]+', line)[0].lower()
        for line in requires('tendon_ros') or []
        if (f'extra == "{extra}"' in line) == bool(extra) and ('extra ==' in line) == bool(extra)
    }


def ros_names() -> set[str]:
    """Return the ROS packages that package.xml names."""
    names = {tag.text for tag in XML.iter('exec_depend')}
    return {name for name in names if not name.startswith('python3-')}


def test_one_version():
    assert XML.findtext('version') == tendon_ros.__version__
    assert distribution('tendon_ros').version == tendon_ros.__version__
    assert tendon_ros.__version__ in (ROOT / 'CHANGELOG.rst').read_text()


def test_package_xml_is_ament_python():
    assert XML.get('format') == '3'
    assert XML.findtext('export/build_type') == 'ament_python'
    assert XML.findtext('license') == 'Apache-2.0'


def test_every_import_is_required():
    outside_ros = imported(PACKAGE) - ros_names() - OPTIONAL_ROS
    wanted = {PIP_NAMES.get(name, name) for name in outside_ros}
    assert wanted <= pip_requirements() | pip_requirements('fast')


def test_everything_required_is_imported():
    wanted = {PIP_NAMES.get(name, name) for name in imported(PACKAGE)}
    assert pip_requirements() <= wanted


def test_every_ros_import_stands_in_package_xml():
    outside_pip = {
        name
        for name in imported(PACKAGE / 'nodes')
        if PIP_NAMES.get(name, name) not in pip_requirements()
    }
    assert outside_pip <= ros_names() | OPTIONAL_ROS


@pytest.mark.parametrize('name', SCRIPTS)
def test_script_has_its_function(name):
    module, function = SCRIPTS[name].split(':')
    path = ROOT / (module.replace('.', '/') + '.py')
    tree = ast.parse(path.read_text())
    assert function in {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}


def test_every_node_is_a_script():
    nodes = {path.stem for path in (PACKAGE / 'nodes').glob('*.py') if has_main(path)}
    assert set(SCRIPTS) == nodes | {'tendon'}


def has_main(path: Path) -> bool:
    """Tell whether a module can be started."""
    tree = ast.parse(path.read_text())
    return any(isinstance(node, ast.FunctionDef) and node.name == 'main' for node in tree.body)


@pytest.fixture(scope='module')
def prefix(tmp_path_factory):
    """Return a prefix into which pip has installed a copy of the sources, not editable."""
    pytest.importorskip('pip')
    source = tmp_path_factory.mktemp('source')
    for name in ('package.xml', 'pyproject.toml', 'setup.py', 'setup.cfg', 'LICENSE', 'README.md'):
        shutil.copy(ROOT / name, source)
    for name in ('tendon_ros', 'config', 'launch', 'resource'):
        shutil.copytree(ROOT / name, source / name, ignore=shutil.ignore_patterns('__pycache__'))
    target = tmp_path_factory.mktemp('prefix')
    arguments = ['--no-build-isolation', '--no-deps', '--no-index', '--ignore-installed', '-q']
    subprocess.run(
        [sys.executable, '-m', 'pip', 'install', *arguments, '--prefix', target, source],
        check=True,
    )
    return target


@pytest.mark.parametrize('folder', ['config', 'launch'])
def test_install_has_every_shared_file(prefix, folder):
    def below(root):
        files = (path for path in root.rglob('*') if path.is_file())
        return {path.relative_to(root) for path in files if '__pycache__' not in path.parts}

    assert below(ROOT / folder) == below(prefix / 'share/tendon_ros' / folder) != set()


def test_install_has_every_module_and_template(prefix):
    [site] = prefix.glob('lib/python*/site-packages')
    sources = {
        path.relative_to(ROOT)
        for path in PACKAGE.rglob('*')
        if path.is_file() and '__pycache__' not in path.parts
    }
    assert {path for path in sources if not (site / path).is_file()} == set()


def test_install_is_registered_with_ament(prefix):
    assert (prefix / 'share/ament_index/resource_index/packages/tendon_ros').is_file()
    assert (prefix / 'share/tendon_ros/package.xml').is_file()


def test_pip_puts_the_scripts_on_the_path(prefix):
    assert {path.name for path in (prefix / 'bin').iterdir()} == set(SCRIPTS)
