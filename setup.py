"""
The ament_python package: what is installed, where, and what it needs.

Tools are configured in ``pyproject.toml``. The metadata stands here because colcon reads it from
``setup.py``, and because setuptools of Ubuntu 24.04 (68.1) builds it.
"""

from collections import defaultdict
from pathlib import Path
import re

from setuptools import find_packages, setup

NAME = 'tendon_ros'
ROOT = Path(__file__).parent
VERSION = re.search(r"__version__ = '(.+)'", (ROOT / NAME / '__init__.py').read_text())[1]

#: lower bounds that ``make lowest`` runs the tests with
REQUIRES = [
    'jinja2>=3.1.2',
    'matplotlib>=3.8.0',
    'mcap>=1.1.1',
    'numpy>=1.26.0',
    'pint>=0.24.1',
    'pydantic>=2.5.0',
    'pyyaml>=6.0.1',
    'rich>=13.7.1',
    'rosbags>=0.11.9',
    'scipy>=1.11.4',
    'zstandard>=0.22.0',
]
FAST = ['numba>=0.59.0']
ROS = ['ros-jazzy-rclpy[fastrtps]>=7.1.6', 'ros-jazzy-common-interfaces>=5.3.6']
# setuptools 80 took the commands away that colcon calls.
COLCON = ['colcon-common-extensions>=0.3.0', 'setuptools>=68,<80']
TEST = ['hypothesis>=6.100', 'mcap-ros2-support>=0.5.3', 'pytest>=8.0', 'pytest-xdist>=3.5']
LINT = [
    'import-linter>=2.3',
    'mypy>=1.15',
    'ruff>=0.9',
    'scipy-stubs',
    'types-pyyaml',
]


def share(*folders: str) -> list[tuple[str, list[str]]]:
    """
    Return the files below folders as data files, each in the same sub-folder of share.

    :param folders: folders of the source tree.
    :return: pairs of a target folder and its files.
    """
    targets = defaultdict(list)
    for folder in folders:
        for path in sorted(ROOT.joinpath(folder).rglob('*')):
            if path.is_file() and '__pycache__' not in path.parts:
                inside = path.relative_to(ROOT)
                targets[f'share/{NAME}/{inside.parent.as_posix()}'].append(inside.as_posix())
    return list(targets.items())


setup(
    name=NAME,
    version=VERSION,
    description='Simulate, estimate and diagnose tendon-driven surgical instruments.',
    long_description='See README.md.',
    author='tendon_ros developers',
    author_email='tendon_ros@example.org',
    maintainer='tendon_ros developers',
    maintainer_email='tendon_ros@example.org',
    license='Apache-2.0',
    keywords=['ROS', 'simulation', 'surgical robotics', 'tendon', 'system identification'],
    classifiers=[
        'Intended Audience :: Science/Research',
        'Operating System :: POSIX :: Linux',
        'Programming Language :: Python :: 3.12',
        'Topic :: Scientific/Engineering',
        'Typing :: Typed',
    ],
    python_requires='>=3.12',
    packages=find_packages(include=[NAME, f'{NAME}.*']),
    package_data={'': ['py.typed', '*.css', '*.html', '*.j2', '*.js', '*.svg']},
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{NAME}']),
        (f'share/{NAME}', ['package.xml']),
        *share('config', 'launch'),
    ],
    zip_safe=False,
    install_requires=REQUIRES,
    extras_require={
        'fast': FAST,
        'ros': ROS,
        'colcon': COLCON,
        'test': TEST,
        'dev': FAST + ROS + COLCON + TEST + LINT,
    },
    entry_points={
        'console_scripts': [
            'tendon = tendon_ros.cli.main:main',
            'simulator = tendon_ros.nodes.simulator:main',
            'estimator = tendon_ros.nodes.estimator:main',
            'trajectory = tendon_ros.nodes.trajectory:main',
            'recorder = tendon_ros.nodes.recorder:main',
            'monitor = tendon_ros.nodes.monitor:main',
        ],
    },
)
