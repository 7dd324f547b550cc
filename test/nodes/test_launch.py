"""The launch file, where ROS's launch is installed."""

from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

import pytest

FILE = Path(__file__).parents[2] / 'launch' / 'rig.launch.py'


def test_the_launch_file_describes_the_nodes():
    pytest.importorskip('launch_ros')
    spec = spec_from_file_location('rig_launch', FILE)
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    assert len(module.generate_launch_description().entities) == 7
