"""What a node does beside its callbacks does not end unseen: the node ends with it."""

import subprocess
import sys

import pytest

pytest.importorskip('rclpy')

#: how long a first start may take that compiles on a busy machine [s]
LONG = 180.0

#: run a node of which something that only its worker asks for is broken
BROKEN = """
import runpy

from {module} import {owner}


def torn(*_):
    raise RuntimeError('torn')


{owner}.{asked} = property(torn)
runpy.run_module('tendon_ros.nodes.{node}', run_name='__main__')
"""


@pytest.mark.parametrize(
    ('node', 'module', 'owner', 'asked'),
    [
        ('simulator', 'tendon_ros.nodes.live_simulation', 'LiveSimulation', 'wait'),
        ('monitor', 'tendon_ros.diagnose.watch', 'Watch', 'due'),
        ('in_one', 'tendon_ros.model.trajectory', 'Trajectory', 'at'),
    ],
)
def test_a_worker_that_fails_ends_its_node(domain, node, module, owner, asked):
    code = BROKEN.format(node=node, module=module, owner=owner, asked=asked)
    done = subprocess.run(
        [sys.executable, '-c', code, '--ros-args', '-r', '__ns:=/broken'],
        text=True,
        capture_output=True,
        timeout=LONG,
        check=False,
    )
    assert done.returncode == 1
    assert done.stderr.splitlines()[-1] == 'RuntimeError: torn'
    assert 'in thread' not in done.stderr
