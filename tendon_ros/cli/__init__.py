"""The command line: one verb a file, found by its name."""

import os

# The matrices here are small: threads of the linear algebra library cost more than they give, and
# it counts them when numpy is first imported.
for _name in ('OMP_NUM_THREADS', 'OPENBLAS_NUM_THREADS', 'MKL_NUM_THREADS'):
    os.environ.setdefault(_name, '1')
