"""
Simulate, estimate and diagnose tendon-driven surgical instruments.

What other programs build on is named here. A module is loaded when one of its names is first asked
for, so that a node or a verb loads no more than it needs.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tendon_ros.bags.reader import read_recording
    from tendon_ros.bags.writer import write_recording
    from tendon_ros.base.errors import TendonError
    from tendon_ros.base.recording import Channel, Recording
    from tendon_ros.diagnose.session import diagnose
    from tendon_ros.estimate import build_observer, estimate_recording, Measurement
    from tendon_ros.model.instrument import Instrument
    from tendon_ros.model.instrument_file import load_instrument, save_instrument
    from tendon_ros.model.session import simulate
    from tendon_ros.model.simulation import Simulation
    from tendon_ros.model.trajectory import Trajectory
    from tendon_ros.model.trajectory_choice import chosen_trajectory as chosen_trajectory

__version__ = '0.1.0'

#: by public name, the module that has it
_HOME = {
    'Channel': 'base.recording',
    'Instrument': 'model.instrument',
    'Measurement': 'estimate',
    'Recording': 'base.recording',
    'Simulation': 'model.simulation',
    'TendonError': 'base.errors',
    'Trajectory': 'model.trajectory',
    'build_observer': 'estimate',
    'chosen_trajectory': 'model.trajectory_choice',
    'diagnose': 'diagnose.session',
    'estimate_recording': 'estimate',
    'load_instrument': 'model.instrument_file',
    'read_recording': 'bags.reader',
    'save_instrument': 'model.instrument_file',
    'simulate': 'model.session',
    'write_recording': 'bags.writer',
}

__all__ = [
    'Channel',
    'Instrument',
    'Measurement',
    'Recording',
    'Simulation',
    'TendonError',
    'Trajectory',
    '__version__',
    'build_observer',
    'chosen_trajectory',
    'diagnose',
    'estimate_recording',
    'load_instrument',
    'read_recording',
    'save_instrument',
    'simulate',
    'write_recording',
]


def __getattr__(name: str) -> object:
    if name not in _HOME:
        raise AttributeError(f'module {__name__!r} has no attribute {name!r}')
    return getattr(import_module(f'{__name__}.{_HOME[name]}'), name)


def __dir__() -> list[str]:
    return sorted(__all__)
