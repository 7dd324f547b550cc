"""
The names that the engine binds before it joins the kernel's files.

Only declared here, so that readers, editors and type checkers know them; the values are those of
the instrument at hand and are written by :mod:`tendon_ros.model.structure`. Everything numeric
that a fit may move (radii, inertias, curves) lies in the array ``m``, so that no fit recompiles.

The arrays of the kernel, all flat, pulleys in the kernel's own order (see ``layout``):

=====  ======  =====================================================================
name   type    holds
=====  ======  =====================================================================
``m``  float   the model's numbers, SI units
``d``  int     the model's choices: which law where, what is driven by what
``w``  float   scratch
``y``  float   state carried on: angles [rad], velocities [rad/s], auxiliary states
``c``  float   carried on besides: time, suggested step, controllers, sensors
``g``  int     carried on: friction mode of each pulley, contacts, counters
``s``  float   signals: smooth functions of time (prescribed motion, torques, references)
=====  ======  =====================================================================
"""

from __future__ import annotations

from collections.abc import MutableSequence, Sequence

Floats = MutableSequence[float]
Ints = MutableSequence[int]

# --- sizes -------------------------------------------------------------------
N: int  # pulleys
M: int  # cable loops and couplings
K: int  # contacts
U: int  # motors
Q: int  # room for sensors
WIDTH: int  # most pulleys that one loop or contact touches; shorter rows are padded with radius 0
BAND: int  # half bandwidth of the network's matrix, pulleys in kernel order
SPAN: int  # 2 * BAND + 1
STATES: int  # room for auxiliary states
DIM: int  # 2 * N + STATES
READINGS: int  # where they begin in a recorded row: 1 + 2 * N + 3 * U + M + K
RING: int  # remembered values of each sensor

# --- who touches whom --------------------------------------------------------
LOOP_PULLEY: Sequence[int]  # M * WIDTH
CONTACT_PULLEY: Sequence[int]  # K * WIDTH
MOTOR_PULLEY: Sequence[int]  # U

# --- places in m -------------------------------------------------------------
INERTIA: int
DAMPING: int
BREAKAWAY: int  # pre-sliding angle of the dry friction [rad]; 0: it sticks rigidly
DITHER: int  # speed of a trembling under which that friction lets go [rad/s]
LASH: int  # half of the play that friction holds, between a pulley and its cables [rad]
RADIUS: int  # M * WIDTH, signed: how an angle lengthens the loop [m]
ARM: int  # M * WIDTH, signed: how its tension turns the pulley [m]
PRELOAD: int  # elongation of each of a loop's two cables at rest [m]
SCALE: int  # factor on the curve
LOOP_DAMPING: int
PLAY: int  # width of the dead zone in the elongation [m]
CURVE_START: int
CURVE_RATE: int  # cells per metre
CURVE_BELOW: int  # slope below the first point: 0 for a cable, which goes slack
CONTACT_RATIO: int  # K * WIDTH
CONTACT_STIFFNESS: int
CONTACT_DAMPING: int
CONTACT_POSITION: int
CONTACT_ARM: int
MOTOR_GAIN: int
MOTOR_BIAS: int
MOTOR_LIMIT: int
MOTOR_KNEE: int
KP: int
KI: int
KD: int
AHEAD: int  # 1 where the derivative sees the command, too, not the reading alone
LIMIT: int
PERIOD: int
SENSOR_GAIN: int
SENSOR_OFFSET: int
SENSOR_DELAY: int
SENSOR_LAG: int  # time constant of its low-pass filter, in periods
SENSOR_KEPT: int  # part of what the filter held that is left a period later
SENSOR_RESOLUTION: int
SENSOR_NOISE: int
TOLERANCE: int  # of an angle in one step [rad]
STILL: int  # speed within which a prescribed pulley's dry friction is not at its limit [rad/s]

# --- places in d -------------------------------------------------------------
DRIVE: int  # N: 1 where motion is prescribed
MOTION: int  # N: row of s that prescribes the motion, or -1
PUSH: int  # N: row of s that adds a torque, or -1
REFERENCE: int  # U: row of s that is the reference of a continuous controller, or -1
ENCODER: int  # U: the sensor that each controller reads
INTEGRAL: int  # U: auxiliary state that integrates a continuous controller's error, or -1
BRISTLE: int  # N: auxiliary state of the pre-sliding friction, or -1
DRY: int  # N: 1 where dry friction sticks rigidly
GEARED: int  # N: 1 where no cable runs, and what passes through the pulley is its load
DRIVEN: int  # how many pulleys are prescribed, pushed by a signal, pre-sliding
PUSHED: int
BRISTLED: int
CURVE_CELLS: int  # M
CURVE_OFFSET: int  # M: where in m the four coefficients of each cell begin
CONTACT_LAW: int  # K: 0 spring and damper, 1 Hunt-Crossley
CONTACT_ON: int  # K
SENSORS: int  # how many there are
SENSOR_SOURCE: int  # Q: what each reads (see tendon_ros.model.sensed)
SENSOR_INDEX: int  # Q: pulley, motor, contact or entry of LOOP_PULLEY
SENSOR_RECTIFIED: int  # Q
REMEMBERS: int  # 1 where some sensor is delayed or filtered
ACTIVE: int  # number of auxiliary states in use
STATE_LOOP: int  # STATES: the loop that a state belongs to, or -1
STATE_PULLEY: int  # STATES: the pulley that a state belongs to, or -1
BREAKS: int  # their number; and where in m they begin
SWITCH: int
#: each hook's first entry and their number; an entry is law, place, first parameter in m, state
TORQUES: int
BUDGETS: int
ELONGATIONS: int
RELAXATIONS: int
TENSIONS: int
WINDINGS: int

# --- places in w -------------------------------------------------------------
EPOCH: int  # a time within the present segment between switches [s]
INPUT: int  # N: torque of the motors on their pulleys [N m]
WOUND: int  # N: angle that the cable sees
TURN: int  # N: its derivative by the angle
CURL: int  # N: and the second one
FOLLOW: int  # 1 where the cables follow the pulley, 0 inside its play
ACCELERATION: int  # N: of prescribed pulleys
DELTA: int  # M: elongation
RATE: int  # M: its rate
SHIFT: int  # M: what laws add to the elongation
SHIFT_D: int
TENSION: int  # M: net force of the loop
TENSION_D: int
TENSION_R: int
TOTAL: int  # M: sum of the tensions of the loop's two cables
TOTAL_D: int
SLACK: int  # M: elongation left until one cable goes slack; negative: slack
TORQUE: int  # N: all torques but inertia and dry friction
TORQUE_T: int  # N: and its derivatives by the pulley's own angle and velocity
TORQUE_W: int
LOAD: int  # N: sum over the cables on the pulley of |radius| * tension, or what passes through
LOAD_T: int  # N: without cables, derivatives by the pulley's own angle and velocity
LOAD_W: int
LOAD_WAY: int  # N: without cables, the sign of what acts from outside; else 0
BUDGET: int  # N: largest dry friction
BUDGET_W: int
BUDGET_L: int
SIDE: int  # N: factor of the budget in the friction torque
GAP: int  # K: event function of each contact; positive: closed
FORCE: int  # K
FORCE_Q: int
FORCE_V: int
STATE_RATE: int  # STATES: derivative of each auxiliary state, and what it depends on
STATE_A: int  # by delta or angle
STATE_B: int  # by their rates
STATE_Z: int  # by itself
STATE_T: int  # how the tension or the torque depends on the state
STATE_S: int  # how the sum of tensions does
#: the derivatives at the start of a step, kept while its stages are evaluated
J_LOOP: int  # M: of the tension by delta
J_LOOP_RATE: int
J_TOTAL: int
J_RADIUS: int  # M * WIDTH: radii and arms as the pulleys stand
J_ARM: int
J_GRIP: int  # M * WIDTH: of the friction by the sum of tensions
J_ANGLE: int  # N: of the torque by the pulley's own angle and velocity
J_SPEED: int
J_CONTACT: int  # K: of the contact's torque at ratio 1
J_CONTACT_RATE: int
J_PRESS: int  # K * WIDTH: how that torque turns the pulleys
J_A: int  # STATES
J_B: int
J_Z: int
J_T: int
J_S: int
F: int  # DIM: the right-hand side
FIRST: int  # DIM: the right-hand side at the start of the step
START: int  # DIM: states
TRIAL: int
NEXT: int
STAGE: int  # 6 * DIM
RIGHT: int  # DIM
OUTER: int  # DIM: derivative of the right-hand side by time
KAPPA: int  # M
SIGMA: int  # M
CHI: int  # M
MATRIX: int  # N * SPAN
SLACK_START: int  # M
PENDING: int  # N + K + M: event functions at the end of a step

# --- places in c and g -------------------------------------------------------
CLOCK: int
STEP: int
TICK: int
COMMAND: int  # U: torque that each motor reports [N m]
SUM: int  # U
LAST: int  # U
READING: int  # Q
DRAWN: int  # tick of the first row of noise
ROW: int  # rows written in this call
ROOM: int  # rows that there is room for
NOISY: int  # 1 where the sensors' noise is on
DRUM: int  # N: angle of what lies behind a pulley's play [rad]
PAST: int  # Q * RING
SMOOTH: int  # Q: what low-pass filters hold
BEFORE: int  # Q: and what went into them last
MODE: int  # N: -1, 1 sliding, 0 stuck, 2 without dry friction or with pre-sliding
TOUCH: int  # K
COUNT: int  # steps, rejected steps, events


def torque_law(
    law: int, theta: float, omega: float, t: float, m: Floats, o: int
) -> tuple[float, float, float]:
    """Call torque law ``law``, its parameters from ``m[o]`` on (written by the engine)."""
    raise LookupError(law)


def budget_law(
    law: int, speed: float, side: float, load: float, m: Floats, o: int
) -> tuple[float, float, float]:
    """Call dry-friction law number ``law`` (written by the engine)."""
    raise LookupError(law)


def elongation_law(law: int, delta: float, t: float, m: Floats, o: int) -> tuple[float, float]:
    """Call elongation law number ``law`` (written by the engine)."""
    raise LookupError(law)


def relaxation_law(
    law: int, delta: float, z: float, m: Floats, o: int
) -> tuple[float, float, float, float, float, float, float]:
    """Call relaxation law number ``law`` (written by the engine)."""
    raise LookupError(law)


def tension_law(
    law: int, delta: float, rate: float, z: float, t: float, m: Floats, o: int
) -> tuple[float, float, float, float, float, float, float, float]:
    """Call tension law number ``law`` (written by the engine)."""
    raise LookupError(law)


def winding_law(law: int, theta: float, m: Floats, o: int) -> tuple[float, float, float]:
    """Call winding law number ``law`` (written by the engine)."""
    raise LookupError(law)
