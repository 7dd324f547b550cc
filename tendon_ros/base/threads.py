"""Threads of the linear algebra libraries: one."""

from __future__ import annotations

import os


def use_one_thread() -> None:
    """
    Keep linear algebra to one thread, unless the user has said otherwise.

    The matrices here are small, and their threads cost more than they give: ten times the time of
    an estimate on two busy cores. The libraries read this when numpy is first imported, so
    programs call it before.
    """
    for name in ('OMP_NUM_THREADS', 'OPENBLAS_NUM_THREADS', 'MKL_NUM_THREADS'):
        os.environ.setdefault(name, '1')
