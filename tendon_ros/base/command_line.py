"""What the command ``tendon`` and the nodes share: exit statuses, and how mistakes are told."""

from __future__ import annotations

import argparse
from typing import NoReturn

#: exit status: done; anything that is neither; the user's arguments or input are at fault
DONE, FAILED, MISTAKE = 0, 1, 2


class Parser(argparse.ArgumentParser):
    """Says what is wrong in one line instead of printing the usage first."""

    def error(self, message: str) -> NoReturn:
        """
        Leave with :data:`MISTAKE`.

        :param message: what is wrong with the arguments.
        """
        self.exit(MISTAKE, f'{self.prog}: {message}; see `{self.prog} --help`\n')
