"""The node behind ``monitor``."""

from __future__ import annotations

from collections.abc import Callable, Mapping
import math
from pathlib import Path
import threading
import time

from std_srvs.srv import Trigger

from tendon_ros.bags.topics import JOINT_TOPICS
from tendon_ros.base.errors import TendonError
from tendon_ros.diagnose.watch import Watch, WatchReport, WatchSettings
from tendon_ros.diagnose.watch_gap import gap_after
from tendon_ros.diagnose.watch_stream import StampError
from tendon_ros.estimate import Measurement
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.joints import joint_names
from tendon_ros.nodes.arrivals import Arrivals
from tendon_ros.nodes.conversions import from_stamp, Message, values_of
from tendon_ros.nodes.diagnostics import Level
from tendon_ros.nodes.measurements import hear
from tendon_ros.nodes.monitor import PROGRAM
from tendon_ros.nodes.monitor_status import channels, whole
from tendon_ros.nodes.settings import SettingError, Value
from tendon_ros.nodes.tendon_node import TendonNode

#: how often the thread that compares looks whether a window is full [s]
NAP = 0.05


class MonitorNode(TendonNode):
    """
    Compares what is measured with the model, in a thread beside the callbacks.

    :param given: parameters that the command line sets.
    """

    def __init__(self, given: Mapping[str, Value]) -> None:
        super().__init__(PROGRAM.name, given)
        values = self.declare(PROGRAM.settings)
        self.refuse_unknown_parameters()
        instrument = load_instrument(str(values['instrument']))
        self._watch = Watch(instrument, _watch_settings(values))
        self._screen_period = float(values['screen_period'])
        self.get_logger().info(
            f'preparing {instrument.name}; the first start of a network may compile for some '
            'twenty seconds'
        )
        start = time.monotonic()
        self._watch.rehearse()
        for note in self._watch.notes:
            self.get_logger().warning(note)
        self._anew = threading.Event()
        self._screened_at = -math.inf
        self._warned = False
        self._busy = 0.0
        self._counted_at = time.monotonic()
        measured = {sensor.channel for sensor in instrument.sensors}
        self._arrivals = Arrivals(measured)
        self._joints = joint_names(instrument)
        topics = hear(self, measured, self._hearer)
        self.create_service(Trigger, '~/reset', self._on_reset)
        self.get_logger().info(
            f'ready after {time.monotonic() - start:.1f} s, listening to {", ".join(topics)}'
        )

    def begin(self) -> None:
        """Start to compare."""
        self.work('watch', self._compare)

    def health(self) -> tuple[Level, str, Mapping[str, object]]:
        """Return what the last look showed, and publish what it showed of each channel."""
        now = time.monotonic()
        load, self._busy = self._busy / (now - self._counted_at), 0.0
        self._counted_at = now
        report = self._watch.report
        silent = self._arrivals.silent(now)
        name = self.get_fully_qualified_name().lstrip('/')
        self._diagnostics.publish(channels(report, silent, name, time.time_ns()))
        level, text, details = whole(report)
        details['load of comparing'] = load
        if self._watch.strangers:
            details['unknown joints'] = ', '.join(self._watch.strangers)
        missing = self._watch.missing
        if missing:
            level = Level.ERROR
            text = (
                f'no measurement of {", ".join(missing)} yet; the model of '
                f'{self._watch.instrument.name} is driven with it'
            )
        elif silent:
            level, text = Level.ERROR, next(iter(silent.values()))
        return level, text, details

    def _hearer(self, topic: str) -> Callable[[Message], None]:
        """Return the callback of a topic; it only keeps what it is given."""
        joints = self._joints.get(JOINT_TOPICS.get(topic, ''), ())

        def on_message(message: Message) -> None:
            values: Mapping[str, float] = {}
            try:
                values = values_of(topic, message, joints)
                self._watch.update(Measurement(from_stamp(message.header.stamp), values))
            except StampError as error:
                values = {}  # none of them was kept
                mend = f'call {self.get_fully_qualified_name()}/reset to begin anew'
                self.complain('stamps that step back', f'{topic}: {error}; {mend}')
            except TendonError as error:
                self.complain('measurements left out', f'{topic}: {error}')
            self._arrivals.note(values, time.monotonic())

        return on_message

    def _compare(self) -> None:
        """Compare whenever a window is full."""
        while not self.stopping.wait(NAP):
            if self._anew.is_set():
                self._anew.clear()
                self._watch.reset()
                self._warned = False  # nothing is compared yet, so no gap is small again
            if self._watch.due:
                self._look()

    def _look(self) -> None:
        begin = time.thread_time()
        report = self._watch.look()
        if report.grown and time.monotonic() - self._screened_at > self._screen_period:
            report = self._watch.suspect()
            self._screened_at = time.monotonic()
        if not report.grown:
            self._screened_at = -math.inf
        self._busy += time.thread_time() - begin
        self._say(report)

    def _say(self, report: WatchReport) -> None:
        """Log when a gap grows, and when it is small again."""
        grown = bool(report.grown)
        if grown and not self._warned:
            self.get_logger().warning(whole(report)[1])
        elif self._warned and not grown:
            self.get_logger().info('the gap is again no more than what is explained')
        self._warned = grown

    def _on_reset(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        # by the thread that compares, which may be in the middle of it
        self._anew.set()
        self._arrivals.clear()
        response.success = True
        response.message = 'begins anew'
        return response


def _watch_settings(values: Mapping[str, Value]) -> WatchSettings:
    """Return how to watch, by the node's parameters."""
    window, warm_up = float(values['window']), float(values['warm_up'])
    if warm_up > 0.7 * window:
        raise SettingError(
            f'parameter warm_up: {warm_up:g} s leave nothing of a window of {window:g} s; give at '
            f'most {0.7 * window:g}'
        )
    path = str(values['diagnosis'])
    return WatchSettings(
        window=window,
        warm_up=warm_up,
        period=float(values['period']),
        warn_ratio=float(values['warn_ratio']),
        learn=float(values['learn']),
        explained=gap_after(Path(path)) if path else {},
    )
