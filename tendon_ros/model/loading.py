"""
Imports a file of functions by its path, under a name that is the same in every process.

As a program it does just that with the file that it is given, and so compiles what the file asks
for: a process that has compiled a kernel runs other machine code than one that finds it compiled.
Functions that are compiled on the way stand alone there, and what calls them keeps to these
instead of the ones that were optimised with it; sums are rounded otherwise. A trajectory that
sticks and slips makes something of the last digit. So compiling is left to a process of its own,
and the first run gives what all later ones give.
"""

from __future__ import annotations

import importlib.util
from pathlib import Path
import sys
from types import ModuleType


def imported(path: Path) -> ModuleType:
    """
    Import a file, once in a process.

    :param path: of the file.
    :return: its module.
    """
    name = f'tendon_ros_{path.stem}'
    if name in sys.modules:
        return sys.modules[name]
    spec = importlib.util.spec_from_file_location(name, path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    try:
        spec.loader.exec_module(module)
    except BaseException:
        del sys.modules[name]
        raise
    return module


if __name__ == '__main__':
    imported(Path(sys.argv[1]))
