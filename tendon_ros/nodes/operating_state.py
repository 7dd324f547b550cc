"""CRTK's operating state: what commands do to it, and when motion is taken."""

from __future__ import annotations

from collections.abc import Callable

from tendon_ros.base.errors import listed, TendonError


class StateError(TendonError):
    """A command for the operating state that does not exist, or a motion that it forbids."""


#: what each command of CRTK makes of the state; None leaves it
_COMMANDS = {
    'enable': 'ENABLED',
    'disable': 'DISABLED',
    'pause': 'PAUSED',
    'resume': 'ENABLED',
    'home': None,
    'unhome': None,
}


class OperatingState:
    """
    A state that begins enabled and homed, because a simulator needs neither power nor a search.

    Where it is not ENABLED, the motors hold their set-points.

    :param has_failed: tells whether the simulation cannot go on. It is asked each time and not
        noted, because a note that comes late would undo a reset.
    """

    def __init__(self, has_failed: Callable[[], bool]) -> None:
        self._has_failed = has_failed
        self.reset()

    def reset(self) -> None:
        """Begin anew."""
        self._name = 'ENABLED'
        self.is_homed = True

    @property
    def name(self) -> str:
        """One of CRTK's: ENABLED, DISABLED, PAUSED, FAULT."""
        return 'FAULT' if self._has_failed() else self._name

    def command(self, text: str) -> None:
        """
        Take a command of CRTK.

        :param text: ``enable``, ``disable``, ``pause``, ``resume``, ``home`` or ``unhome``.
        :raises StateError: on another one; the state stays.
        """
        if text not in _COMMANDS:
            raise StateError(
                f'state_command {text!r} does not exist; there are {listed(_COMMANDS)}'
            )
        if self.name == 'FAULT':
            raise StateError(
                f'state_command {text!r} does nothing in FAULT; call the service reset'
            )
        self._name = _COMMANDS[text] or self._name
        if text in {'home', 'unhome'}:
            self.is_homed = text == 'home'

    def require_motion(self) -> None:
        """
        Raise where no motion is taken.

        :raises StateError: with the command that mends it.
        """
        name = self.name
        if name != 'ENABLED':
            fault = name == 'FAULT'
            mend = 'call the service reset' if fault else 'send state_command enable'
            raise StateError(f'motion refused in state {name}; {mend}')
