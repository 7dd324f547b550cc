"""Estimate the operating force and the inner pulleys from motor-side signals."""

from tendon_ros.estimate.methods import build_observer, METHODS
from tendon_ros.estimate.observer import Estimate, Measurement, Observer
from tendon_ros.estimate.offline import estimate_recording
from tendon_ros.estimate.synchronise import Synchroniser

__all__ = [
    'METHODS',
    'Estimate',
    'Measurement',
    'Observer',
    'Synchroniser',
    'build_observer',
    'estimate_recording',
]
