"""
MuJoCo: a sphere that slides on a plane under a chain, held back by springs. Needs `pip install mujoco`.

    python -m comparison.run fig3-I --grid 4 --model MuJoCo=examples.engines.mujoco_slider:amplification@small-resolved

What it cannot express: a sphere inside a sphere (the restoring force is that of springs, m_sum g x/R, as in the small
equations), and friction linear in the velocity. Its contacts are soft constraints, whose own smoothing decides what
happens within a few ms of a stop, and with it mu_1.
"""

from __future__ import annotations

import math

import mujoco
import numpy as np

from reference.problem import GRAVITY, ground_acceleration, ground_peak

# stiffness, 1/s^2, and damping, 1/s, of a contact, and how hard it is. A harder one, or one that is damped more, lifts
# off as it slides: friction in a cone that is solved as a convex one also pushes upward, in proportion to the velocity
CONTACT = 'solref="-1e5 -300" solimp="0.3 0.3 1e-3"'
SETTLING = 1000  # steps at rest, in which the sphere sinks into the plane
MODEL = """
<mujoco>
 <option timestep="{step}" integrator="implicitfast" cone="elliptic" impratio="1000" iterations="200" tolerance="1e-14">
  <flag energy="disable"/>
 </option>
 <worldbody>
  <geom type="plane" size="0 0 1" friction="{friction} 0 0" condim="3" {contact}/>
  <body pos="0 0 1">
   <joint type="slide" axis="1 0 0" stiffness="{restoring}"/>
   <joint type="slide" axis="0 1 0" stiffness="{restoring}"/>
   <joint type="slide" axis="0 0 1"/>
   <geom type="sphere" size="1" mass="{mass}" friction="{friction} 0 0" condim="3" {contact}/>
   {upper}
  </body>
 </worldbody>
</mujoco>
"""
LINK = """<body>
 <joint type="slide" axis="1 0 0" stiffness="{0[0]}" damping="{1[0]}"/>
 <joint type="slide" axis="0 1 0" stiffness="{0[1]}" damping="{1[1]}"/>
 <geom type="sphere" size="0.1" mass="{2}" contype="0" conaffinity="0"/>
 {3}</body>
"""


def amplification(scene, phases, step=1e-3):
    upper = ""
    for stiffness, damping, mass in reversed(list(zip(scene.stiffness, scene.damping, scene.masses[1:]))):
        upper = LINK.format(stiffness, damping, mass, upper)
    restoring = 0.0 if scene.flat else scene.total_mass * GRAVITY / scene.radius
    parts = {"step": step, "contact": CONTACT, "friction": scene.friction_coefficient, "restoring": restoring}
    model = mujoco.MjModel.from_xml_string(MODEL.format(**parts, mass=scene.masses[0], upper=upper))
    mu = np.array([_peaks(model, scene, phase, step) for phase in phases])
    return mu / ground_peak(scene, phases)[:, None]


def _peaks(model, scene, phase, step):
    """Largest absolute acceleration of every body, m/s^2."""
    data, count = mujoco.MjData(model), len(scene.masses)
    ground = ground_acceleration(scene, phase, step * np.arange(math.ceil(scene.duration / step)))
    absolute = np.empty((len(ground), count, 3))
    model.opt.gravity[:] = 0.0, 0.0, -GRAVITY
    mujoco.mj_step(model, data, nstep=SETTLING)
    for n, acceleration in enumerate(ground):  # in the frame of the ground, whose acceleration is a change of gravity
        model.opt.gravity[:] = -acceleration
        model.opt.gravity[2] -= GRAVITY
        mujoco.mj_step(model, data)
        absolute[n, 0] = data.qacc[:3]
        absolute[n, 1:, :2] = data.qacc[3:].reshape(-1, 2)
    absolute[:, :, :2] = absolute[:, :, :2].cumsum(axis=1)  # every body moves relative to the one below
    absolute[:, :, 2] = absolute[:, :1, 2]
    return np.linalg.norm(absolute + ground[:, None, :], axis=2).max(axis=0)
