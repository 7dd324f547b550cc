"""The node behind ``estimator``."""

from __future__ import annotations

from collections.abc import Callable, Mapping
import math
import time

from std_srvs.srv import Trigger

from tendon_ros.bags.topics import JOINT_TOPICS
from tendon_ros.base.errors import TendonError
from tendon_ros.base.names import names_in
from tendon_ros.estimate import build_observer, Estimate, Measurement, Observer, Synchroniser
from tendon_ros.model.instrument import Instrument
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.joints import joint_names
from tendon_ros.nodes.arrivals import STALE
from tendon_ros.nodes.broadcast import Broadcast
from tendon_ros.nodes.conversions import from_stamp, Message, values_of
from tendon_ros.nodes.diagnostics import Level
from tendon_ros.nodes.estimator import PROGRAM
from tendon_ros.nodes.measurements import hear
from tendon_ros.nodes.settings import Value
from tendon_ros.nodes.tendon_node import TendonNode

#: part of the time spent on estimates above which measurements pile up
FULL = 0.9


class EstimatorNode(TendonNode):
    """
    Publishes an estimate for every measurement, with the measurement's stamp.

    :param given: parameters that the command line sets.
    """

    def __init__(self, given: Mapping[str, Value]) -> None:
        super().__init__(PROGRAM.name, given)
        values = self.declare(PROGRAM.settings)
        self.refuse_unknown_parameters()
        instrument = load_instrument(str(values['instrument']))
        self._method = str(values['method'])
        self.get_logger().info(
            f'preparing {self._method} for {instrument.name}; the first start of a network may '
            'compile for some twenty seconds'
        )
        start = time.monotonic()
        channels = names_in(str(values['channels']))
        self._observer: Observer = build_observer(
            instrument,
            self._method,
            channels=channels or None,
            wander=float(values['wander']) or None,
            engine=str(values['engine']),
        )
        self._together = Synchroniser(self._observer.needs)
        self._broadcast = Broadcast(self)
        self._last_ns: int | None = None
        self._arrived = -math.inf
        self._estimated = 0
        self._busy = 0.0
        self._counted_at = time.monotonic()
        self._warm_up()
        topics = hear(self, self._observer.needs, lambda topic: self._hearer(topic, instrument))
        self.create_service(Trigger, '~/reset', self._on_reset)
        self.get_logger().info(
            f'ready after {time.monotonic() - start:.1f} s, listening to {", ".join(topics)}'
        )

    def health(self) -> tuple[Level, str, Mapping[str, object]]:
        """Return whether measurements come, and how late they are."""
        now = time.monotonic()
        passed = now - self._counted_at
        rate, load = self._estimated / passed, self._busy / passed
        self._estimated, self._busy, self._counted_at = 0, 0.0, now
        details: dict[str, object] = {
            'method': self._method,
            'estimates [Hz]': rate,
            'load': load,
            'incomplete measurements': self._together.dropped,
        }
        if self._last_ns is not None:
            details['age of the last stamp [s]'] = time.time_ns() * 1e-9 - self._last_ns * 1e-9
        if now - self._arrived > STALE:
            ever = 'no measurement yet' if self._last_ns is None else 'no measurement any more'
            return Level.STALE, f'{ever}; it needs {", ".join(self._observer.needs)}', details
        if load > FULL:
            text = (
                f'{self._method} cannot keep up with the measurements, some get lost; choose '
                'another method, or lower the rate of the measurements'
            )
            self.get_logger().warning(text, throttle_duration_sec=5.0)
            return Level.WARN, text, details
        return Level.OK, f'estimating by {self._method}', details

    def _hearer(self, topic: str, instrument: Instrument) -> Callable[[Message], None]:
        """Return the callback of a topic of measurements."""
        joints = joint_names(instrument).get(JOINT_TOPICS.get(topic, ''), ())

        def on_message(message: Message) -> None:
            begin = time.monotonic()
            try:
                values = values_of(topic, message, joints)
                bad = [n for n in values if n in self._observer.needs and not _finite(values[n])]
                if bad:
                    self.complain('values not finite', f'{bad[0]} is {values[bad[0]]}; left out')
                    return
                measurement = self._together.add(from_stamp(message.header.stamp), values)
                if measurement is not None:
                    self._take(measurement)
            except TendonError as error:
                self.complain('measurements left out', f'{topic}: {error}')
            self._busy += time.monotonic() - begin

        return on_message

    def _warm_up(self) -> None:
        """Make the first estimate before it counts: it is slow, and shows what to publish."""
        rest = Measurement(0, dict.fromkeys(self._observer.needs, 0.0))
        self._broadcast.prepare(self._observer.update(rest).values)
        self._observer.reset()

    def _take(self, measurement: Measurement) -> None:
        """Publish what a measurement says; the observer refuses stamps that step back."""
        if self._last_ns is not None and measurement.stamp_ns <= self._last_ns:
            back = (self._last_ns - measurement.stamp_ns) * 1e-9
            self.complain(
                'stamps that step back',
                f'stamp {measurement.stamp_ns} ns lies {back:.6f} s before the last one; left '
                f'out; call {self.get_fully_qualified_name()}/reset to begin anew',
            )
            return
        estimate = self._observer.update(measurement)
        self._last_ns = measurement.stamp_ns
        self._arrived = time.monotonic()
        self._publish(estimate)

    def _publish(self, estimate: Estimate) -> None:
        finite = {name: value for name, value in estimate.values.items() if _finite(value)}
        for name in estimate.values.keys() - finite.keys():
            self.complain('estimates not finite', f'{name} is not a finite number; not published')
        self._broadcast.publish(estimate.stamp_ns, finite)
        self._estimated += 1

    def _on_reset(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        # the stamp lets a bag be estimated from the very measurement that was the first here
        response.message = f'begins anew after stamp {self._last_ns or 0} ns'
        response.success = True
        self._observer.reset()
        self._together = Synchroniser(self._observer.needs)
        self._last_ns = None
        return response


def _finite(value: float) -> bool:
    return math.isfinite(value)
