"""CRTK's operating state: what commands do to it, and when motion is taken."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from tendon_ros.base.errors import listed, TendonError


class StateError(TendonError):
    """A command that does not exist or is not for this state, or a motion that it forbids."""


_ANY = ('DISABLED', 'ENABLED', 'PAUSED')
#: in which states CRTK takes each command, and what that makes of the state; None leaves it
_COMMANDS: Mapping[str, tuple[tuple[str, ...], str | None]] = {
    'enable': (('DISABLED', 'ENABLED'), 'ENABLED'),
    'disable': (_ANY, 'DISABLED'),
    'pause': (('ENABLED', 'PAUSED'), 'PAUSED'),
    'resume': (('PAUSED',), 'ENABLED'),
    'home': (_ANY, None),
    'unhome': (_ANY, None),
}
#: what to do so that motion is taken again
_WAYS_BACK = {
    'DISABLED': 'send state_command enable',
    'PAUSED': 'send state_command resume',
    'FAULT': 'call the service reset',
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
        :raises StateError: on another one, and on one that the state does not take; it stays.
        """
        if text not in _COMMANDS:
            raise StateError(
                f'state_command {text!r} does not exist; there are {listed(_COMMANDS)}'
            )
        name = self.name
        if name == 'FAULT':
            raise StateError(f'state_command {text!r} does nothing in FAULT; {_WAYS_BACK[name]}')
        states, then = _COMMANDS[text]
        if name not in states:
            taken = [command for command, (states, _) in _COMMANDS.items() if name in states]
            raise StateError(
                f'state_command {text!r} does nothing in {name}; send one of {listed(taken)}'
            )
        self._name = then or name
        if text in {'home', 'unhome'}:
            self.is_homed = text == 'home'

    def require_motion(self) -> None:
        """
        Raise where no motion is taken.

        :raises StateError: with the command that mends it.
        """
        name = self.name
        if name != 'ENABLED':
            raise StateError(f'motion refused in state {name}; {_WAYS_BACK[name]}')
