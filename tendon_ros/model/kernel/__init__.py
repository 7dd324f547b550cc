"""
The scalar kernel: forces, integration and rollouts of one network of pulleys and cables.

The three source files here and the laws of the effects are joined by
:mod:`tendon_ros.model.engine` into ONE file for each network structure, whose constants replace
those of :mod:`tendon_ros.model.kernel.structure`. That one file is compiled where numba is
installed and imported as plain Python where it is not. So a law is written once, and every user of
the physics (live node, batch, observer, fits) runs the same lines.

What may stand in these files is what both ways of running understand: scalars, flat arrays, loops.
"""
