"""
Simulator, estimator and trajectory; each a process of its own, or all in one; a monitor beside.

ros2 launch tendon_ros rig.launch.py in_one:=true params:=/path/to/rig.yaml namespace:=instrument
ros2 launch tendon_ros rig.launch.py monitor:=true
"""

import sys

from launch.actions import DeclareLaunchArgument, ExecuteProcess, GroupAction
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

from launch import LaunchDescription
from tendon_ros.base.resources import config_path


def generate_launch_description() -> LaunchDescription:
    """Return what to start."""
    params = LaunchConfiguration('params')
    namespace = LaunchConfiguration('namespace')
    in_one = LaunchConfiguration('in_one')
    nodes, [monitor] = (
        [
            Node(
                package='tendon_ros',
                executable=name,
                name=name,
                namespace=namespace,
                parameters=[params],
                output='screen',
            )
            for name in names
        ]
        for names in (('simulator', 'estimator', 'trajectory'), ('monitor',))
    )
    together = ExecuteProcess(
        cmd=[
            *(sys.executable, '-m', 'tendon_ros.nodes.in_one', '--ros-args'),
            *('--params-file', params, '-r', ['__ns:=/', namespace]),
        ],
        output='screen',
        condition=IfCondition(in_one),
    )
    return LaunchDescription(
        [
            DeclareLaunchArgument(
                'params',
                default_value=str(config_path('nodes/rig.yaml')),
                description='file with the parameters of the nodes',
            ),
            DeclareLaunchArgument(
                'namespace', default_value='instrument', description='of the instrument'
            ),
            DeclareLaunchArgument(
                'in_one', default_value='false', description='run the nodes in one process'
            ),
            DeclareLaunchArgument(
                'monitor', default_value='false', description='watch measurement and model too'
            ),
            GroupAction(nodes, condition=UnlessCondition(in_one)),
            GroupAction([monitor], condition=IfCondition(LaunchConfiguration('monitor'))),
            together,
        ]
    )
