"""CRTK's operating state: what commands do to it, and when motion is taken."""

from __future__ import annotations

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

    ``name`` is one of CRTK's: ENABLED, DISABLED, PAUSED, FAULT. Where it is not ENABLED, the
    motors hold their set-points.
    """

    def __init__(self) -> None:
        self.name = 'ENABLED'
        self.is_homed = True

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
        self.name = _COMMANDS[text] or self.name
        if text in {'home', 'unhome'}:
            self.is_homed = text == 'home'

    def fail(self) -> None:
        """Note that the simulation cannot go on."""
        self.name = 'FAULT'

    def reset(self) -> None:
        """Begin anew."""
        self.__init__()  # type: ignore[misc]

    def require_motion(self) -> None:
        """
        Raise where no motion is taken.

        :raises StateError: with the command that mends it.
        """
        if self.name != 'ENABLED':
            fault = self.name == 'FAULT'
            mend = 'call the service reset' if fault else 'send state_command enable'
            raise StateError(f'motion refused in state {self.name}; {mend}')
