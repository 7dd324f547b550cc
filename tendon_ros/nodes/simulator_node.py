"""The node behind ``simulator``."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
import time

from rcl_interfaces.msg import SetParametersResult
from rclpy.parameter import Parameter
from sensor_msgs.msg import JointState
from std_srvs.srv import SetBool, Trigger

from tendon_ros.base.errors import EffectError, SimulationError, TendonError
from tendon_ros.model.instrument import Instrument
from tendon_ros.model.instrument_file import load_instrument
from tendon_ros.model.simulation import Simulation
from tendon_ros.nodes.broadcast import Broadcast
from tendon_ros.nodes.conversions import wanted_positions
from tendon_ros.nodes.crtk import CrtkState
from tendon_ros.nodes.diagnostics import Level
from tendon_ros.nodes.effect_settings import effect_settings, effects_from
from tendon_ros.nodes.live_simulation import LiveSimulation
from tendon_ros.nodes.operating_state import OperatingState
from tendon_ros.nodes.settings import SettingError, Value
from tendon_ros.nodes.simulator import PROGRAM
from tendon_ros.nodes.tendon_node import TendonNode


class SimulatorNode(TendonNode):
    """
    Steps an instrument by elapsed time and publishes what it measures.

    Header stamps are the start plus simulated time. They come from the system's clock, also with
    ``use_sim_time``: this node is where time comes from.

    :param given: parameters that the command line sets.
    """

    def __init__(self, given: Mapping[str, Value]) -> None:
        super().__init__(PROGRAM.name, given)
        values = self.declare(PROGRAM.settings)
        instrument = load_instrument(str(values['instrument']))
        settings = effect_settings(instrument)
        self._effects = {name: float(value) for name, value in self.declare(settings).items()}
        self.refuse_unknown_parameters()
        self._simulated = instrument
        self._live = self._prepared(instrument, values)
        self._slipped = 0.0
        self._published = 0
        self._counted_at = time.monotonic()
        self._broadcast = Broadcast(self)
        self._state = OperatingState(lambda: self._live.failure is not None)
        self._crtk = CrtkState(self, self._state, lambda: self._live.is_busy, self._on_state)
        self.add_on_set_parameters_callback(self._on_parameters)
        for topic, act in (('servo_jp', self._live.servo), ('move_jp', self._live.move)):
            self.create_subscription(
                JointState, f'actuator/{topic}', self._commander(topic, act), 10
            )
        self.create_service(Trigger, 'reset', self._on_reset)
        self.create_service(SetBool, 'contact', self._on_contact)
        self.every(0.2, lambda: self._crtk.publish(always=True))

    def begin(self) -> None:
        """Start the clock of the physics."""
        # The first round is slow; it happens before time begins.
        samples = self._live.advance(time.monotonic())
        if samples is not None:
            self._broadcast.prepare(samples.values)
        self._live.reset(time.time_ns(), time.monotonic())
        self.work('physics', self._loop)

    def health(self) -> tuple[Level, str, Mapping[str, object]]:
        """Return how the simulation keeps up, and what is in force."""
        now = time.monotonic()
        rate = self._published / (now - self._counted_at)
        self._published, self._counted_at = 0, now
        behind = self._live.slipped
        level, text = Level.OK, f'simulating {self._live.instrument.name}'
        failure = self._live.failure
        if failure is not None:
            level, text = Level.ERROR, _told(failure)
        elif behind > self._slipped:
            level = Level.WARN
            text = (
                f'cannot keep up: {behind - self._slipped:.3f} s of simulated time were lost in '
                'the last second; lower the rate, or install numba'
            )
            self.get_logger().warning(text, throttle_duration_sec=5.0)
        self._slipped = behind
        effects = [f'{use.effect}@{use.place}' for use in self._live.instrument.effects]
        contacts = [c.name for c in self._live.instrument.contacts if c.enabled]
        return (
            level,
            text,
            {
                'published [Hz]': rate,
                'simulated time [s]': self._live.time,
                'behind [s]': behind,
                'state': self._state.name,
                'busy': self._live.is_busy,
                'contacts': ', '.join(contacts) or 'none',
                'effects': ', '.join(effects) or 'none',
            },
        )

    def _prepared(self, instrument: Instrument, values: Mapping[str, Value]) -> LiveSimulation:
        """Return the simulation, ready to step."""
        period = instrument.control_period
        every = max(round(1.0 / (float(values['rate']) * period)), 1)
        rate = 1.0 / (every * period)
        if abs(rate - float(values['rate'])) > 1e-6 * rate:
            self.get_logger().warning(
                f'rate: {values["rate"]:g} Hz is no whole number of controller periods of '
                f'{period:g} s; publishing at {rate:g} Hz'
            )
        contacts = tuple(
            replace(c, enabled=c.enabled and bool(values['contact'])) for c in instrument.contacts
        )
        ready = replace(
            instrument, effects=effects_from(instrument, self._effects), contacts=contacts
        )
        self.get_logger().info(
            f'preparing {instrument.name}; the first start of a network compiles for some '
            'twenty seconds'
        )
        start = time.monotonic()
        seed = int(values['seed'])
        simulation = Simulation(
            ready, seed=None if seed < 0 else seed, engine=str(values['engine'])
        )
        self.get_logger().info(
            f'{instrument.name} ready after {time.monotonic() - start:.1f} s, '
            f'{simulation.engine} engine, publishing at {rate:g} Hz'
        )
        return LiveSimulation(simulation, every=every, move_speed=float(values['move_speed']))

    def _loop(self) -> None:
        """Step and publish; a loop that sleeps jitters less than a timer and costs a tenth."""
        while not self.stopping.is_set():
            time.sleep(min(self._live.wait(time.monotonic()), 0.1))
            try:
                samples = self._live.advance(time.monotonic())
            except SimulationError as error:
                self.get_logger().error(_told(error))
                continue
            if samples is None:
                continue
            for stamp, row in samples.rows():
                self._broadcast.publish(stamp, row)
                self._published += 1
            self._crtk.publish()

    def _commander(
        self, topic: str, act: Callable[[Mapping[str, float]], None]
    ) -> Callable[[JointState], None]:
        """Return the callback of a topic of commands."""

        def on_command(message: JointState) -> None:
            try:
                self._state.require_motion()
                act(wanted_positions(message, self._live.joints))
            except TendonError as error:
                self.complain(f'refused {topic}', f'actuator/{topic}: {error}')
            self._crtk.publish()

        return on_command

    def _on_state(self, text: str) -> None:
        try:
            self._state.command(text)
        except TendonError as error:
            self.complain('refused state_command', str(error))
        if self._state.name != 'ENABLED':
            self._live.hold()
        self._crtk.publish(always=True)

    def _on_parameters(self, changed: Sequence[Parameter]) -> SetParametersResult:
        """Put changed effects in force, all or none."""
        new = {p.name: float(p.value) for p in changed if p.name in self._effects}
        if not new:
            return SetParametersResult(successful=True)
        effects = {**self._effects, **new}
        try:
            self._live.use_effects(effects_from(self._simulated, effects))
        except (EffectError, SettingError) as error:
            return SetParametersResult(successful=False, reason=str(error))
        self._effects = effects
        for name, value in new.items():
            self.get_logger().info(f'{name} = {value:g} {self.settings[name].unit}')
        return SetParametersResult(successful=True)

    def _on_reset(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        self._live.reset(time.time_ns(), time.monotonic())
        self._slipped = 0.0
        self._state.reset()
        self._crtk.publish(always=True)
        response.success = True
        response.message = f'{self._live.instrument.name} is at rest at zero'
        return response

    def _on_contact(
        self, request: SetBool.Request, response: SetBool.Response
    ) -> SetBool.Response:
        try:
            self._live.use_contact(enabled=bool(request.data))
        except TendonError as error:
            response.message = str(error)
            return response
        response.success = True
        response.message = 'in the way' if request.data else 'taken away'
        return response


def _told(failure: SimulationError) -> str:
    return f'{failure}; nothing is published until the service reset is called'
